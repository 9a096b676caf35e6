//! The rays of a sample as a tree: how `plumb probe` shows where a colour comes from.
//!
//! A [`TraceObserver`] that writes as the tracer goes: a tree of any size takes no memory but for the rays above the
//! one at hand.

use std::io::{self, Write};

use crate::cpu::light::Lit;
use crate::cpu::surface::{Point, texel_place, tile_material};
use crate::cpu::trace::{Branch, RayKind, TraceObserver, Unmet};
use crate::prepare::{Prepared, Surface};
use crate::real::V3;
use crate::real::rational::two_to;
use crate::scene::Scene;

use super::digits::{components, count, short, short_triple};

/// More rays than this are only counted.
const SHOWN_RAYS: usize = 200;
/// Of more lights than this only those that light the point are listed, and no more than so many.
const SHOWN_LIGHTS: usize = 50;
/// Rays that are deeper in the tree are not moved farther to the right: they say which ray they come from.
const DEEPEST: usize = 12;

/// Writes the tree of one sample.
pub(super) struct Tree<'a> {
    scene: &'a Scene,
    prepared: &'a Prepared<f64>,
    max_path: f64,
    all: bool,
    to: &'a mut dyn Write,
    /// Whether writing succeeded; the tracer does not see such errors.
    written: io::Result<()>,
    /// Numbers of the rays from the first to the one at hand, each from the one before.
    ancestors: Vec<u32>,
    /// Whether the ray at hand is one of those shown.
    showing: bool,
    /// The columns that lines about it begin with.
    indent: String,
    /// Length of the longest name of a light.
    widest_light: usize,
    counts: Counts,
    lights: LightCounts,
}

/// How many rays came to which end.
#[derive(Debug, Default)]
struct Counts {
    met: usize,
    nothing: usize,
    too_long: usize,
    weightless: usize,
    faint: usize,
    full: usize,
    hidden: usize,
}

/// What lights that are not listed do at a point.
#[derive(Debug, Default)]
struct LightCounts {
    listed: usize,
    lit: usize,
    at_light: usize,
    faces_away: usize,
    outside: usize,
    outside_picture: usize,
    shadowed: usize,
}

impl<'a> Tree<'a> {
    /// For a tree of rays in `scene`, of which `prepared` is what the tracer has; `all` shows all of it.
    pub(super) fn new(
        scene: &'a Scene,
        prepared: &'a Prepared<f64>,
        max_path: f64,
        all: bool,
        to: &'a mut dyn Write,
    ) -> Self {
        let widest = scene.lights.iter().map(|light| light.name.chars().count());
        Self {
            scene,
            prepared,
            max_path,
            all,
            to,
            written: Ok(()),
            ancestors: Vec::new(),
            showing: false,
            indent: String::new(),
            widest_light: widest.max().unwrap_or(0).min(24),
            counts: Counts::default(),
            lights: LightCounts::default(),
        }
    }

    /// Ends the tree: how many rays there were, and how many of them are not shown.
    pub(super) fn finish(mut self) -> io::Result<()> {
        let Counts {
            met,
            nothing,
            too_long,
            weightless,
            faint,
            full,
            hidden,
        } = self.counts;
        self.indent.clear();
        if hidden > 0 {
            self.line(&format!("  … and {hidden} more (--all shows them)"));
        }
        let mut parts = vec![
            format!("{met} met something"),
            format!("{nothing} found nothing"),
        ];
        let mut not_followed = |count: usize, why: String| {
            if count > 0 {
                parts.push(format!("{count} not followed: {why}"));
            }
        };
        not_followed(
            too_long,
            format!("their paths are longer than {}", self.max_path),
        );
        not_followed(weightless, "their weight is 0".to_owned());
        not_followed(faint, "nothing that they bring can count".to_owned());
        not_followed(
            full,
            "the colour is full in all channels without them".to_owned(),
        );
        self.line(&format!(
            "in all       {}: {}",
            count(met + nothing, "ray"),
            parts.join(", ")
        ));
        self.written
    }

    fn line(&mut self, text: &str) {
        if self.written.is_ok() {
            self.written = writeln!(self.to, "{}{text}", self.indent);
        }
    }

    /// Takes its place in the tree for a ray that comes from ray `parent`, and decides whether it is shown.
    fn place(&mut self, ray: &Branch<f64>) {
        if ray.kind == RayKind::Primary {
            self.ancestors.clear();
        } else {
            while self.ancestors.last().is_some_and(|&n| n != ray.parent) {
                self.ancestors.pop();
            }
        }
        let Counts {
            met,
            nothing,
            too_long,
            weightless,
            faint,
            ..
        } = self.counts;
        self.showing = self.all || met + nothing + too_long + weightless + faint < SHOWN_RAYS;
        self.counts.hidden += usize::from(!self.showing);
        self.indent = "  ".repeat(self.ancestors.len().min(DEEPEST) + 1);
    }

    /// The ray with its kind and origin, and what it met.
    fn headed(&mut self, number: Option<u32>, ray: &Branch<f64>, met: &str) {
        let number = number.map_or("–".to_owned(), |number| number.to_string());
        let origin = match ray.kind {
            RayKind::Primary => "primary".to_owned(),
            RayKind::Through => format!("through {}", ray.parent),
            RayKind::Mirror => format!("mirror in {}", ray.parent),
        };
        self.line(&format!("{number} {origin}: {met}"));
        self.indent += "    ";
    }

    /// A length in world units.
    fn length(&self, units: f64) -> f64 {
        units * two_to(self.prepared.camera.scale)
    }

    /// What the surface is made of at a point, where that is more than the object's name says.
    fn surface(&self, point: &Point<f64>) -> String {
        let material = tile_material(self.prepared, point)
            .map_or("?", |index| &self.scene.materials[index].name);
        let mut text = format!("material {material}");
        match &self.prepared.surfaces[point.object] {
            Surface::Textured(textured) => {
                if let Ok([column, row]) = texel_place(textured, point.position) {
                    let texture = &self.scene.textures[textured.texture].name;
                    text += &format!(
                        ", texture {texture} at column {column}, row {row} from the bottom"
                    );
                }
            }
            Surface::Plain | Surface::Tiled(_) | Surface::Pplane(_) | Surface::Psphere(_) => {}
        }
        text
    }
}

impl TraceObserver<f64> for Tree<'_> {
    fn met(
        &mut self,
        number: u32,
        ray: &Branch<f64>,
        t: f64,
        point: &Point<f64>,
        ambient: V3<f64>,
    ) {
        self.place(ray);
        self.ancestors.push(number);
        self.counts.met += 1;
        self.lights = LightCounts::default();
        if !self.showing {
            return;
        }
        let object = &self.scene.objects[point.object];
        let from_viewpoint = point.position.to_f64() * two_to(self.prepared.camera.scale);
        let at = self.scene.camera.viewpoint + from_viewpoint;
        let met = format!(
            "{} ({}) at {}, t = {}",
            object.name,
            object.entity(),
            short_triple(at.to_array()),
            short(self.length(t))
        );
        self.headed(Some(number), ray, &met);
        self.line(&format!(
            "weight {}, path {}, {}, ambient {}",
            short_triple(components(ray.weight)),
            short(self.length(ray.total + t)),
            self.surface(point),
            short_triple(components(ambient))
        ));
    }

    fn missed(&mut self, number: u32, ray: &Branch<f64>, why: Unmet) {
        self.place(ray);
        let before = short(self.length(ray.total));
        let (count, numbered, text) = match why {
            Unmet::Nothing => (&mut self.counts.nothing, true, "nothing".to_owned()),
            Unmet::TooLong => (
                &mut self.counts.too_long,
                false,
                format!(
                    "not followed, the path to there is {before}, longer than {}",
                    self.max_path
                ),
            ),
            Unmet::Weightless => (
                &mut self.counts.weightless,
                false,
                "not followed, its weight is 0".to_owned(),
            ),
            Unmet::Faint => (
                &mut self.counts.faint,
                false,
                "not followed, nothing that it brings can count".to_owned(),
            ),
        };
        *count += 1;
        if self.showing {
            self.headed(numbered.then_some(number), ray, &text);
        }
    }

    fn light(&mut self, light: usize, lit: &Lit<f64>) {
        if !self.showing {
            return;
        }
        let lights = &self.scene.lights;
        let few = self.all || lights.len() <= SHOWN_LIGHTS;
        let does = matches!(lit, Lit::Lit { .. });
        let listed = few || (does && self.lights.listed < SHOWN_LIGHTS);
        if !listed {
            let counts = &mut self.lights;
            *match lit {
                Lit::AtLight => &mut counts.at_light,
                Lit::FacesAway => &mut counts.faces_away,
                Lit::OutsideCone => &mut counts.outside,
                Lit::OutsidePicture => &mut counts.outside_picture,
                Lit::Shadowed(_) => &mut counts.shadowed,
                Lit::Lit { .. } => &mut counts.lit,
            } += 1;
            return;
        }
        self.lights.listed += 1;
        let text = match lit {
            Lit::AtLight => "nothing: the light is at this very point".to_owned(),
            Lit::FacesAway => "nothing: the surface faces away from it".to_owned(),
            Lit::OutsideCone => "nothing: the point is outside its cone".to_owned(),
            Lit::OutsidePicture => "nothing: the point is outside its picture".to_owned(),
            Lit::Shadowed(blocker) => {
                let blocker = &self.scene.objects[*blocker];
                format!("nothing: in the shadow of {}", blocker.name)
            }
            Lit::Lit {
                diffuse,
                glint,
                transmittance,
            } => {
                let mut text = format!("diffuse {}", short_triple(components(*diffuse)));
                if components(*glint) != [0.0; 3] {
                    text += &format!(", glint {}", short_triple(components(*glint)));
                }
                if components(*transmittance) != [1.0; 3] {
                    text += &format!(", filter {}", short_triple(components(*transmittance)));
                }
                text
            }
        };
        let width = self.widest_light;
        self.line(&format!("{:<width$}  {text}", lights[light].name));
    }

    fn adds(&mut self, share: V3<f64>) {
        if !self.showing {
            return;
        }
        let LightCounts {
            lit,
            at_light,
            faces_away,
            outside,
            outside_picture,
            shadowed,
            ..
        } = self.lights;
        let parts: Vec<String> = [
            (lit, "light the point"),
            (at_light, "are at this very point"),
            (faces_away, "are faced away from"),
            (outside, "have it outside their cones"),
            (outside_picture, "have it outside their pictures"),
            (shadowed, "are in the shadow of something"),
        ]
        .into_iter()
        .filter(|(count, _)| *count > 0)
        .map(|(count, what)| format!("{count} {what}"))
        .collect();
        if !parts.is_empty() {
            self.line(&format!(
                "lights not listed: {} (--all lists them)",
                parts.join(", ")
            ));
        }
        self.line(&format!("adds {}", short_triple(components(share))));
    }

    fn full(&mut self, waiting: usize) {
        self.counts.full += waiting;
    }
}
