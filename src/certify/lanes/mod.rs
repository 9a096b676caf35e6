//! The GPU's arithmetic on the CPU: eight pixels of a row at once, in f32 with the GPU's error bounds
//! (docs/NUMERICS.md).
//!
//! For scenes without lights, a ray a pixel. Every operation of IEEE arithmetic keeps what the bounds ask of a GPU's,
//! so a pixel that is sure here has its exact bytes; the others, and surfaces that are not plain or tiled, are left to
//! [`ExactTracer`](crate::cpu::pixel::ExactTracer). What is computed is that of `shaders/` with `certified`, in loops
//! that a compiler makes vectors of: here the closest hits, in `shade` their colours. So this is the WGSL's twin: a
//! formula or a bound that changes in one of the two changes in the other. [`cpu`](crate::cpu) is the referee of both.

mod shade;

use std::sync::Arc;

use crate::prepare::Prepared;
use crate::real::Bounded;
use crate::settings::Settings;
use crate::shader::bounds::{self, U};
use crate::shader::kind::SurfaceKind;
use crate::shader::pack::Packed;
use crate::shader::records::{Plane, Polygon, Sphere};

/// Pixels at once.
pub const LANES: usize = 8;

type Lane = [f32; LANES];

/// A scene for eight pixels at once.
#[derive(Debug)]
pub struct Lanes {
    packed: Arc<Packed>,
    constants: Constants,
    /// Whether they do all surfaces of the scene.
    whole: bool,
    /// Whether some object is modulated: then hits must be known well enough for bounds of the first order.
    modulated: bool,
}

/// The constants that the shader has by name.
#[derive(Debug)]
struct Constants {
    u: f32,
    first_order: f32,
    second_order: f32,
    root_near: f32,
    root_far: f32,
    root_far_from: f32,
    hit_roundings: f32,
    root_roundings: f32,
    index_roundings: f32,
    value_error: f32,
}

/// The closest hits of the lanes' rays so far, as `Hit` in `shaders/closest.wgsl`.
struct Closest {
    inverse: Lane,
    error: Lane,
    rival: Lane,
    object: [u32; LANES],
    group: [u32; LANES],
}

impl Closest {
    fn new() -> Self {
        Self {
            inverse: [0.0; LANES],
            error: [0.0; LANES],
            rival: [0.0; LANES],
            object: [0; LANES],
            group: [0; LANES],
        }
    }

    /// `nearer` in `shaders/closest.wgsl`, for an object that shares its surface with none.
    #[inline(always)]
    fn nearer(
        &mut self,
        inverse: &Lane,
        error: &Lane,
        hit: &[bool; LANES],
        possible: &[bool; LANES],
        object: u32,
    ) {
        for i in 0..LANES {
            let takes = hit[i] & (inverse[i] > self.inverse[i]);
            let high = if possible[i] {
                inverse[i] + error[i]
            } else {
                0.0
            };
            let other = if takes {
                self.inverse[i] + self.error[i]
            } else {
                high
            };
            self.rival[i] = if other > self.rival[i] {
                other
            } else {
                self.rival[i]
            };
            self.error[i] = if takes { error[i] } else { self.error[i] };
            self.inverse[i] = if takes { inverse[i] } else { self.inverse[i] };
            self.object[i] = if takes { object } else { self.object[i] };
            self.group[i] = if takes { 0 } else { self.group[i] };
        }
    }

    /// The same for one of several objects on a surface: of these the first hit counts.
    fn nearer_in_group(
        &mut self,
        inverse: &Lane,
        error: &Lane,
        hit: [bool; LANES],
        possible: [bool; LANES],
        object: u32,
        group: u32,
    ) {
        let before = self.inverse;
        let fresh = self.group.map(|g| g != group);
        let both = |a: [bool; LANES]| std::array::from_fn(|i| a[i] & fresh[i]);
        self.nearer(inverse, error, &both(hit), &both(possible), object);
        for (i, before) in before.into_iter().enumerate() {
            if self.inverse[i] != before {
                self.group[i] = group;
            }
        }
    }
}

/// Eight pixels, decided as far as they are sure.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Eight {
    /// Their bytes, where they are sure.
    pub bytes: [[u8; 3]; LANES],
    /// Whether they are.
    pub sure: [bool; LANES],
}

impl Lanes {
    /// The scene as the GPU would get it, asked for only where it may do; None where it takes more than there is here.
    pub fn new(
        prepared: &Prepared<Bounded>,
        settings: &Settings,
        packed: impl FnOnce() -> Arc<Packed>,
    ) -> Option<Self> {
        if prepared.world.is_some() || settings.supersampling().is_some() || settings.values {
            return None;
        }
        Self::of(packed())
    }

    /// A packed scene without lights, for a ray a pixel.
    pub fn of(packed: Arc<Packed>) -> Option<Self> {
        let here = |kind: &SurfaceKind| matches!(kind, SurfaceKind::Plain | SurfaceKind::Tiled);
        if packed.unprovable.is_some()
            || !packed.quadrics.is_empty()
            || !packed.kinds.iter().any(here)
        {
            return None;
        }
        let condition = f64::from(packed.camera.condition);
        let constants = Constants {
            u: U as f32,
            first_order: bounds::round_up(bounds::FIRST_ORDER),
            second_order: bounds::round_up(bounds::SECOND_ORDER),
            root_near: bounds::round_up(bounds::ROOT_NEAR),
            root_far: bounds::round_up(bounds::ROOT_FAR),
            root_far_from: bounds::round_up(bounds::ROOT_FAR_FROM),
            hit_roundings: bounds::round_up(bounds::HIT_ROUNDINGS),
            root_roundings: bounds::round_up(bounds::ROOT_ROUNDINGS),
            index_roundings: bounds::round_up(bounds::INDEX_ROUNDINGS),
            value_error: bounds::round_up(bounds::VALUE_ROUNDINGS * condition * U),
        };
        Some(Self {
            constants,
            whole: packed.kinds.iter().all(here),
            modulated: packed.kinds.iter().any(|kind| *kind != SurfaceKind::Plain),
            packed,
        })
    }

    /// Whether all surfaces of the scene are made here, so that few pixels are left to be traced one by one.
    pub fn are_whole(&self) -> bool {
        self.whole
    }

    /// The eight pixels of row `y` from column `x` on, which is a multiple of eight.
    pub fn row(&self, x: u32, y: u32) -> Eight {
        let packed = &self.packed;
        let from = |anchor: [i32; 2]| -> (Lane, f32) {
            let first = x as i32 - anchor[0];
            let across = std::array::from_fn(|i| (first + i as i32) as f32);
            (across, (y as i32 - anchor[1]) as f32)
        };
        let at = from(packed.camera.numbers.anchor);
        let mut closest = Closest::new();
        for polygon in &packed.polygons[..packed.loose_polygons()] {
            polygon_hits(polygon, &at, polygon.group, &mut closest);
        }
        for plane in &packed.planes {
            plane_hits(plane, &at, &mut closest);
        }
        match &packed.screen_grid {
            None => {
                for sphere in &packed.spheres {
                    self.sphere_hits(sphere, &from(sphere.anchor), &mut closest);
                }
            }
            Some(screen_grid) => {
                for &place in screen_grid.at([f64::from(x), f64::from(y)]) {
                    let place = place as usize;
                    let max_inverse = screen_grid.max_inverse[place];
                    let behind = |i: usize| max_inverse < closest.inverse[i] - closest.error[i];
                    if (0..LANES).all(behind) {
                        break;
                    }
                    match packed.spheres.get(place) {
                        Some(sphere) => {
                            self.sphere_hits(sphere, &from(sphere.anchor), &mut closest)
                        }
                        None => {
                            let polygon = packed.grid_polygon(place);
                            polygon_hits(polygon, &at, 0, &mut closest);
                        }
                    }
                }
            }
        }
        self.shade(&at, &closest)
    }

    fn sphere_hits(&self, sphere: &Sphere, at: &(Lane, f32), closest: &mut Closest) {
        let (across, up) = (&at.0, at.1);
        let [xx, xy, yy] = sphere.square;
        let [x, y, one] = sphere.affine;
        let slope = xy * up + x;
        let rest = (yy * up + y) * up + one;
        let disc: Lane = std::array::from_fn(|i| (xx * across[i] + slope) * across[i] + rest);
        if disc.iter().all(|d| *d <= -sphere.disc_error) {
            return;
        }
        let rest = sphere.along[1] * up + sphere.along[2];
        let along: Lane = std::array::from_fn(|i| sphere.along[0] * across[i] + rest);
        let hit = std::array::from_fn(|i| {
            (disc[i] > sphere.disc_error) & (along[i] > sphere.along_error)
        });
        let possible = std::array::from_fn(|i| {
            (disc[i] > -sphere.disc_error) & (along[i] > -sphere.along_error)
        });
        let (mut inverse, mut error) = ([0.0; LANES], [0.0; LANES]);
        for i in 0..LANES {
            let least = if disc[i] > sphere.disc_error {
                disc[i]
            } else {
                sphere.disc_error
            };
            let root = least.sqrt();
            let share = if least > self.constants.root_far_from * sphere.disc_error {
                self.constants.root_far
            } else {
                self.constants.root_near
            };
            inverse[i] = sphere.gain * (along[i] + root);
            error[i] = sphere.gain * (sphere.along_error + share * (sphere.disc_error / root))
                + self.constants.root_roundings * self.constants.u * inverse[i].abs();
        }
        closest.nearer(&inverse, &error, &hit, &possible, sphere.object);
    }
}

fn linear(form: &[f32; 3], at: &(Lane, f32)) -> Lane {
    let rest = form[1] * at.1 + form[2];
    std::array::from_fn(|i| form[0] * at.0[i] + rest)
}

fn plane_hits(plane: &Plane, at: &(Lane, f32), closest: &mut Closest) {
    let inverse = linear(&plane.inverse, at);
    let (mut hit, mut possible) = ([true; LANES], [true; LANES]);
    if plane.front != ALWAYS {
        let side = linear(&plane.front, at);
        for i in 0..LANES {
            hit[i] = side[i] > plane.front_error;
            possible[i] = side[i] > -plane.front_error;
        }
    }
    takes(
        closest,
        &inverse,
        plane.inverse_error,
        hit,
        possible,
        plane.object,
        plane.group,
    );
}

/// A form that is 1 everywhere.
const ALWAYS: [f32; 3] = [0.0, 0.0, 1.0];

fn polygon_hits(polygon: &Polygon, at: &(Lane, f32), group: u32, closest: &mut Closest) {
    let inverse = linear(&polygon.inverse, at);
    let (mut hit, mut possible) = ([true; LANES], [true; LANES]);
    let r = polygon;
    let sides = [&r.side_0, &r.side_1, &r.side_2, &r.side_3];
    for (side, error) in sides
        .into_iter()
        .zip(r.side_errors)
        .chain([(&r.front, r.front_error)])
    {
        let side = linear(side, at);
        for i in 0..LANES {
            hit[i] &= side[i] > error;
            possible[i] &= side[i] > -error;
        }
    }
    takes(
        closest,
        &inverse,
        r.inverse_error,
        hit,
        possible,
        r.object,
        group,
    );
}

#[inline(always)]
fn takes(
    closest: &mut Closest,
    inverse: &Lane,
    error: f32,
    hit: [bool; LANES],
    possible: [bool; LANES],
    object: u32,
    group: u32,
) {
    let error = [error; LANES];
    if group == 0 {
        closest.nearer(inverse, &error, &hit, &possible, object);
    } else {
        closest.nearer_in_group(inverse, &error, hit, possible, object, group);
    }
}
