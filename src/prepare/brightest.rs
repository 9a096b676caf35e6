//! How much a ray can bring at most, whatever it meets: known from the scene alone. For tracers that do not follow what
//! cannot count.
//!
//! With X the most that a ray brings for a unit of its weight, times the length of the path before it: at a hit on an
//! object there are the object's own light, which is bounded, and at most `gain` times what rays that leave it bring,
//! which meet other surfaces first. The least X that keeps all of these inequalities is a bound (docs/NUMERICS.md,
//! section 8).

use std::collections::HashMap;

use super::World;
use crate::real::rational::two_to;
use crate::real::{Bounded, Real, V3};
use crate::scene::{Material, Object, Scene, Surface};

/// The bound, by channels, for rays that leave no surface or the one that brings most, and for the others.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Brightest {
    channels: [Top; 3],
}

/// The most that any object makes of a ray, and the most that others do.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
struct Top {
    most: f64,
    /// The surface that all objects lie on for which that is so, if it is one.
    group: Option<u32>,
    second: f64,
    /// Where rays lose nothing, so that these are infinite: what each mirror or pane of a path may add to that of the
    /// last.
    each: Option<f64>,
}

/// Objects of the same material.
#[derive(Debug, Clone)]
struct Stuff {
    /// What their own light comes to at most, times the distance.
    own: [f64; 3],
    /// What is left at most of the weight of rays that leave them.
    gain: [f64; 3],
    /// The surface that they lie on, if it is one.
    group: Option<u32>,
}

/// The brightest of the colours that procedural surfaces have of their own: 6·(1 + cos).
const WHEEL: f64 = 12.0;
/// More than all roundings of these bounds, which are sums of products of few numbers, none of them negative.
const SLACK: f64 = 1.0 + 1e-9;
/// Steps towards the least X, for all materials together.
const MOST_STEPS: usize = 1_000_000;
/// Two surfaces one after another lose nothing if they leave no more than this of a weight: 1, and its roundings.
const LOSSLESS: f64 = 1.0 + 1e-8;
/// So many mirrors and panes of a path may be lossless, and what all their gains are then at most: more than
/// LOSSLESS^(2²³).
const MOST_LOSSLESS: u32 = 1 << 24;
const LOSSLESS_GROWTH: f64 = 1.1;

impl Brightest {
    /// For the objects of a lit scene.
    pub(super) fn new<R: Real>(
        scene: &Scene,
        world: &World<R>,
        scale: i32,
        hidden: &[bool],
    ) -> Self {
        let mut all: HashMap<[usize; 2], Stuff> = HashMap::new();
        for (index, object) in scene.objects.iter().enumerate().filter(|o| !hidden[o.0]) {
            let group = Some(world.groups[index]);
            let stuff = stuff(scene, object, group, &nearness(world, index, scale));
            all.entry([object.material, other_material(object)])
                .and_modify(|known| known.join(&stuff))
                .or_insert(stuff);
        }
        let all: Vec<Stuff> = all.into_values().collect();
        Self {
            channels: [0, 1, 2].map(|channel| top(&all, channel)),
        }
    }

    /// The bound for a ray that leaves a surface of this group, and goes by so many mirrors and panes at most.
    pub fn leaving(&self, last: Option<u32>, longest: u32) -> [f64; 3] {
        self.channels.map(|top| match (top.each, top.group) {
            (Some(each), _) if longest <= MOST_LOSSLESS => {
                times(each, LOSSLESS_GROWTH * (f64::from(longest) + 2.0))
            }
            (None, Some(group)) if Some(group) == last => top.second,
            _ => top.most,
        })
    }
}

impl Stuff {
    fn join(&mut self, other: &Self) {
        for i in 0..3 {
            self.own[i] = self.own[i].max(other.own[i]);
            self.gain[i] = self.gain[i].max(other.gain[i]);
        }
        if self.group != other.group {
            self.group = None;
        }
    }
}

/// The other material of tiles.
fn other_material(object: &Object) -> usize {
    match object.surface {
        Surface::Tiled { altmaterial, .. } => altmaterial,
        _ => object.material,
    }
}

/// The product, or somewhat more: 0 just if one of them is 0, however large the other is.
fn times(a: f64, b: f64) -> f64 {
    if a == 0.0 || b == 0.0 {
        0.0
    } else {
        (a * b).max(f64::MIN_POSITIVE)
    }
}

fn stuff(scene: &Scene, object: &Object, group: Option<u32>, near: &[f64]) -> Stuff {
    let material = &scene.materials[object.material];
    let other = &scene.materials[other_material(object)];
    let wheel = match object.surface {
        Surface::Procedural { .. } => WHEEL,
        _ => 0.0,
    };
    let kept = 1.0 - material.transparency;
    let own = |i: usize| {
        let ambient = material.ambient[i].max(other.ambient[i]).max(wheel);
        let diffuse = material.diffuse[i].max(other.diffuse[i]);
        let glint = if material.shininess == 0.0 {
            0.0
        } else {
            material.specular[i]
        };
        let reach = scene
            .lights
            .iter()
            .zip(near)
            .filter(|(_, near)| **near > 0.0);
        let lit =
            reach.map(|(light, near)| times(light.emissivity[i], times(diffuse, *near) + glint));
        times(kept, ambient + lit.sum::<f64>()) * SLACK
    };
    let gain = |i: usize| {
        let tint = tint_of(material, i).max(tint_of(other, i));
        (material.specular[i] + times(material.transparency, tint)) * SLACK
    };
    Stuff {
        own: [own(0), own(1), own(2)],
        gain: [gain(0), gain(1), gain(2)],
        group,
    }
}

/// K/max(K) of the diffuse reflectivity.
fn tint_of(material: &Material, i: usize) -> f64 {
    let largest = material.diffuse.max_element();
    match material.diffuse[i] {
        _ if largest == 0.0 => 1.0,
        0.0 => 0.0,
        part => (part / largest).max(f64::MIN_POSITIVE),
    }
}

/// For each light the most that c/dist can be on an object, c the cosine: the inverse of the light's distance from its
/// surface, and 0 if the light is behind that or in it.
fn nearness<R: Real>(world: &World<R>, object: usize, scale: i32) -> Vec<f64> {
    let unit = two_to(scale);
    let place = world.places[object];
    let plane = world.planes.get(place).filter(|p| p.object == object);
    let sphere = world.spheres.get(place).filter(|s| s.object == object);
    let quadric = world.quadrics.get(place).filter(|q| q.object == object);
    if let Some(quadric) = quadric {
        let lights = world.lights.iter().map(|light| {
            let distance = quadric.distance(light.location);
            if distance > 0.0 {
                times(1.0 / distance, 1.0 / unit) * SLACK
            } else {
                f64::INFINITY
            }
        });
        return lights.collect();
    }
    let height = |location: V3<R>| match (plane, sphere) {
        (Some(plane), _) => plane.normal.dot(location) - plane.offset,
        (_, Some(sphere)) => {
            let from = location - sphere.center;
            from.dot(from).sqrt() - sphere.radius
        }
        _ => R::zero(),
    };
    let lights_on_surface = match (plane, sphere) {
        (Some(plane), _) => &plane.lights_on_surface[..],
        (_, Some(sphere)) => &sphere.lights_on_surface[..],
        _ => &[],
    };
    let lights = world.lights.iter().enumerate();
    let near = lights.map(|(number, light)| {
        let Bounded { value, error } = height(light.location).enclosure();
        let margin = error * Bounded::GROW;
        if lights_on_surface.binary_search(&number).is_ok() || value + margin < 0.0 {
            0.0
        } else if value - margin > 0.0 {
            times(1.0 / (value - margin), 1.0 / unit) * SLACK
        } else {
            f64::INFINITY
        }
    });
    near.collect()
}

/// The least X of each material, or somewhat more, and what of it is needed.
fn top(all: &[Stuff], channel: usize) -> Top {
    let least = |x: &[f64]| -> Vec<f64> {
        let own = all.iter().zip(others(all, x));
        own.map(|(stuff, others)| stuff.own[channel] + times(stuff.gain[channel], others))
            .collect()
    };
    // What grows by somewhat more at each step, and settles, ends above what it is to be at least: which is then asked.
    let mut x = vec![0.0; all.len()];
    for _ in 0..(MOST_STEPS / all.len().max(1)).clamp(8, 2000) {
        let next: Vec<f64> = least(&x).iter().map(|x| x * (1.0 + 1e-5)).collect();
        let settled = x
            .iter()
            .zip(&next)
            .all(|(x, next)| *next <= x * (1.0 + 1e-6));
        x = next;
        if settled {
            break;
        }
    }
    let holds = |(x, least): (&f64, &f64)| *x >= *least * SLACK;
    let mut each = None;
    if !x.iter().zip(&least(&x)).all(holds) {
        x.fill(f64::INFINITY);
        each = lossless(all, channel);
    }
    let (most, first) = largest(&x);
    let group = all.get(first).and_then(|stuff| stuff.group);
    let second = without(&x, first);
    Top {
        most,
        group,
        second,
        each,
    }
}

/// What every second mirror or pane of a path may add where two, one after the other, leave no more of a weight than
/// there was, halved.
fn lossless(all: &[Stuff], channel: usize) -> Option<f64> {
    let gains: Vec<f64> = all.iter().map(|stuff| stuff.gain[channel]).collect();
    let two = all
        .iter()
        .zip(others(all, &gains))
        .map(|(stuff, others)| times(stuff.gain[channel], others));
    let own = all
        .iter()
        .map(|stuff| stuff.own[channel])
        .fold(0.0, f64::max);
    let most = gains.iter().copied().fold(0.0, f64::max);
    let lossless = two.fold(0.0, f64::max) <= LOSSLESS;
    lossless.then(|| 0.5 * times(own, 1.0 + most) * SLACK)
}

/// For each material the most of the others: of itself too, if there are other surfaces of it.
fn others<'a>(all: &'a [Stuff], x: &[f64]) -> impl Iterator<Item = f64> + use<'a> {
    let (most, first) = largest(x);
    let second = without(x, first);
    all.iter().enumerate().map(move |(i, stuff)| {
        if i == first && stuff.group.is_some() {
            second
        } else {
            most
        }
    })
}

fn largest(x: &[f64]) -> (f64, usize) {
    let numbered = x.iter().copied().zip(0..);
    numbered.fold(
        (0.0, 0),
        |best, next| if next.0 > best.0 { next } else { best },
    )
}

fn without(x: &[f64], index: usize) -> f64 {
    let others = x.iter().enumerate().filter(|(i, _)| *i != index);
    others.map(|(_, x)| *x).fold(0.0, f64::max)
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::*;
    use crate::prepare::Prepared;
    use crate::scene::load_from;

    /// The bound for the first channel from any surface, and from the brightest.
    fn bounds(text: &str) -> [f64; 2] {
        let text = format!("camera c {{ pixeldim 9 7 worlddim 8 6 viewpoint 4 3 4 }} {text}");
        let scene = load_from("test", text.as_bytes(), Path::new(".")).unwrap();
        let world = Prepared::<Bounded>::new(&scene, 0.0).world.unwrap();
        let top = world.brightest.channels[0];
        let from_top = world.brightest.leaving(top.group, 1 << 16);
        [world.brightest.leaving(None, 1 << 16)[0], from_top[0]]
    }

    fn near(is: f64, least: f64) {
        assert!(
            is >= least && is <= least * 1.001 + 1e-9,
            "{is} for {least}"
        );
    }

    const DARK: &str = "light l { location 4 3 -1 emissivity 0 0 0 }";

    #[test]
    fn mirrors_add_what_the_others_bring() {
        let [most, other] = bounds(&format!(
            "material a {{ ambient 1 0 0 specular 0.5 }} material b {{ ambient 2 0 0 specular 0.25 }}
             plane p {{ material a normal 0 1 0 point 0 -1 0 }} plane q {{ material b normal 0 -1 0 point 0 7 0 }} {DARK}"
        ));
        near(most, 18.0 / 7.0);
        near(other, 16.0 / 7.0);
        // A third surface may be met in between.
        let [most, other] = bounds(&format!(
            "material a {{ ambient 1 0 0 specular 0.5 }}
             plane p {{ material a normal 0 1 0 point 0 -1 0 }} plane q {{ material a normal 0 -1 0 point 0 7 0 }} {DARK}"
        ));
        near(most, 2.0);
        near(other, 2.0);
    }

    #[test]
    fn mirrors_that_lose_nothing_bring_as_much_each() {
        let text = |specular: &str| {
            format!(
                "material a {{ ambient 1 0 0 specular {specular} }}
                 material b {{ ambient 2 0 0 transparency 0.5 specular 0.5 }}
                 plane p {{ material a normal 0 1 0 point 0 -1 0 }} plane q {{ material b normal 0 -1 0 point 0 7 0 }}
                 {DARK}"
            )
        };
        // b keeps half of its own light, 1, and so there are 2 of two in a row.
        let [most, other] = bounds(&text("1"));
        assert_eq!(most, other);
        assert!((65_536.0..1.2 * 65_536.0).contains(&most), "{most}");
        // One alone is not met twice in a row; but two that gain have no bound.
        near(bounds(&text("0.9"))[0], 20.0);
        assert_eq!(bounds(&text("1.001"))[0], f64::INFINITY);
    }

    #[test]
    fn lights_count_by_their_distance_from_the_surface() {
        let plane = "material a { diffuse 3 0 0 specular 0.5 shininess 2 } plane p { material a normal 0 2 0 point 0 -1 0 }";
        let light = |y: f64| format!("{plane} light l {{ location 9 {y:?} -5 emissivity 2 2 2 }}");
        near(bounds(&light(3.0))[0], 1.5 + 1.0);
        near(bounds(&light(-1.0))[0], 0.0);
        near(bounds(&light(-2.0))[0], 0.0);
        let ball = "material a { diffuse 3 0 0 } sphere p { material a center 0 0 -9 radius 2 }";
        let light = |z: f64| format!("{ball} light l {{ location 0 0 {z:?} emissivity 2 2 2 }}");
        near(bounds(&light(-5.0))[0], 3.0);
        near(bounds(&light(-7.0))[0], 0.0);
        near(bounds(&light(-8.0))[0], 0.0);
    }
}
