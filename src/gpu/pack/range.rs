//! The proof that no number on the GPU overflows: all numbers of the records are of moderate size (docs/NUMERICS.md,
//! section 9, "Ranges").

use super::{Lit, Packed};
use crate::gpu::bounds::{LARGEST, fits};

/// Whether products of these numbers with such numbers stay within range.
fn fine(numbers: &[f32]) -> bool {
    numbers.iter().all(|n| fits(*n))
}

impl Packed {
    /// Why no bound is to be relied on: a number so large that products of such numbers might overflow.
    pub(super) fn doubtful_numbers(&self) -> Option<&'static str> {
        let camera = &self.camera.numbers;
        let far = f64::from(self.camera.spread) <= 64.0
            && fine(&camera.offset)
            && camera.step.iter().all(|s| f64::from(*s) < 1024.0)
            && fine(&[camera.gain, 1.0 / camera.gain])
            && f64::from(self.dark) > 1.0 / LARGEST / LARGEST;
        if !far {
            return Some("the camera's numbers are too large or too small");
        }
        let planes = self
            .planes
            .iter()
            .all(|p| fine(&p.inverse) && fine(&p.front) && fine(&[p.inverse_error, p.front_error]));
        let rectangles = self.rectangles.iter().all(|r| {
            let sides = [
                &r.inverse, &r.front, &r.side_0, &r.side_1, &r.side_2, &r.side_3,
            ];
            sides.into_iter().all(|s| fine(s))
                && fine(&r.side_errors)
                && fine(&[r.inverse_error, r.front_error])
        });
        let spheres = self.spheres.iter().all(|s| {
            fine(&s.along)
                && fine(&s.square)
                && fine(&s.affine)
                && fine(&[s.gain, s.along_error, s.disc_error])
        });
        let points = self.sphere_points.iter().all(|p| {
            fine(&p.form_x)
                && fine(&p.form_y)
                && fine(&p.form_z)
                && fine(&[p.form_error, p.center_size])
        });
        let surfaces = self
            .tiled_planes
            .iter()
            .all(|t| fine(&t.spread) && fine(&t.errors))
            && self.pplanes.iter().all(|p| {
                fine(&p.per_unit)
                    && fine(&p.from_point)
                    && fine(&[p.index_error, p.from_point_error])
            })
            && self
                .texplanes
                .iter()
                .all(|t| fine(&t.spread) && fine(&t.errors) && fine(&[t.origin_0, t.origin_1]));
        if !(planes && rectangles && spheres && points && surfaces) {
            return Some("an object's numbers are too large");
        }
        self.lit.as_ref().and_then(Lit::doubtful_numbers)
    }
}

impl Lit {
    /// Why no bound is to be relied on, as that of the scene.
    fn doubtful_numbers(&self) -> Option<&'static str> {
        if self.late_level {
            return Some("a light after the first 32 lies on a surface");
        }
        let planes = self
            .planes
            .iter()
            .all(|p| fine(&[p.offset, p.origin_0, p.origin_1, p.sides_error]) && fine(&p.lengths));
        let spheres = self
            .spheres
            .iter()
            .all(|s| fine(&[s.size, s.radius, s.inverse_radius]));
        let lights = self
            .lights
            .iter()
            .all(|l| fine(&[l.size]) && fine(&l.emissivity));
        let materials = self
            .materials
            .iter()
            .all(|m| fine(&m.ambient) && fine(&m.diffuse) && fine(&m.specular));
        (!(planes && spheres && lights && materials))
            .then_some("an object's or light's numbers are too large")
    }
}
