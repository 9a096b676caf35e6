//! Where the picture is in the window, which pixel is under the cursor, and how the viewpoint moves. No window is
//! needed.

use glam::DVec3;

use super::values;
use crate::scene::Camera;

/// The largest zoom: pixels of the window for each of the picture, in each direction.
pub(super) const MOST: f64 = 64.0;
/// The smallest.
const LEAST: f64 = 1.0 / 64.0;
/// The zooms that steps lead to.
const STEPS: [f64; 17] = [
    0.0625, 0.125, 0.25, 0.5, 0.75, 1.0, 2.0, 3.0, 4.0, 6.0, 8.0, 12.0, 16.0, 24.0, 32.0, 48.0,
    MOST,
];
/// The viewpoint comes no nearer to the screen than this share of its distance in the file.
const NEAREST: f64 = 1e-3;

/// How the picture is laid into its area of the window.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(super) enum Viewport {
    /// As large as fits, in whole steps if it is enlarged.
    #[default]
    Fit,
    /// So large, with this place of the picture in the middle: columns from the left, rows from the top.
    At {
        /// Pixels of the window for each of the picture.
        zoom: f64,
        /// What is in the middle.
        middle: [f64; 2],
    },
}

/// Where the picture is, in pixels of the window.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Placed {
    /// Its top left corner.
    pub(super) origin: [i32; 2],
    /// Pixels of the window for each of its own.
    pub(super) zoom: f64,
}

/// The area for the picture, in pixels of the window.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Area {
    /// Its top left corner.
    pub(super) corner: [f64; 2],
    /// Its width and height.
    pub(super) size: [f64; 2],
}

impl Area {
    fn middle(&self) -> [f64; 2] {
        [0, 1].map(|i| self.corner[i] + 0.5 * self.size[i])
    }
}

impl Viewport {
    /// Where a picture of `size` columns and rows is.
    pub(super) fn place(&self, area: Area, size: [u32; 2]) -> Placed {
        let pixels = size.map(f64::from);
        let (zoom, middle) = match *self {
            Self::Fit => {
                let fitting = (area.size[0] / pixels[0]).min(area.size[1] / pixels[1]);
                // Enlarged in whole steps, so that all pixels are equally large.
                let zoom = if fitting < 1.0 {
                    fitting
                } else {
                    fitting.floor().min(MOST)
                };
                (zoom, pixels.map(|pixels| 0.5 * pixels))
            }
            Self::At { zoom, middle } => (zoom, middle),
        };
        let screen = area.middle();
        let origin = [0, 1].map(|i| screen[i] - zoom * middle[i]);
        let origin = match self {
            // What fits is in its area, down to the last pixel.
            Self::Fit => [0, 1].map(|i| origin[i].floor().max(area.corner[i])),
            Self::At { .. } => origin.map(f64::round),
        };
        Placed {
            origin: origin.map(|at| at as i32),
            zoom,
        }
    }

    /// Changes the zoom, so that what is at `at` (in pixels of the window) stays there.
    pub(super) fn zoom_to(&mut self, zoom: f64, at: [f64; 2], area: Area, size: [u32; 2]) {
        // A picture that fits may be smaller than the smallest step.
        let least = LEAST.min(self.place(area, size).zoom);
        let zoom = zoom.clamp(least, MOST);
        let kept = self.place(area, size).at(at);
        let screen = area.middle();
        let middle = [0, 1].map(|i| kept[i] + (screen[i] - at[i]) / zoom);
        *self = Self::At { zoom, middle }.kept(size);
    }

    /// One step larger or smaller.
    pub(super) fn step(&mut self, larger: bool, at: [f64; 2], area: Area, size: [u32; 2]) {
        let now = self.place(area, size).zoom;
        let step = if larger {
            STEPS.iter().find(|step| **step > now * 1.001)
        } else {
            STEPS.iter().rev().find(|step| **step < now / 1.001)
        };
        if let Some(step) = step {
            self.zoom_to(*step, at, area, size);
        }
    }

    /// Moves the picture by so many pixels of the window.
    pub(super) fn pan(&mut self, by: [f64; 2], area: Area, size: [u32; 2]) {
        let placed = self.place(area, size);
        let middle = placed.at(area.middle());
        let middle = [0, 1].map(|i| middle[i] - by[i] / placed.zoom);
        let zoom = placed.zoom;
        *self = Self::At { zoom, middle }.kept(size);
    }

    /// The same with something of the picture in the middle.
    fn kept(self, size: [u32; 2]) -> Self {
        match self {
            Self::Fit => self,
            Self::At { zoom, middle } => Self::At {
                zoom,
                middle: [0, 1].map(|i| middle[i].clamp(0.0, f64::from(size[i]))),
            },
        }
    }
}

impl Placed {
    /// The zoom if it is a whole number, else 0.
    pub(super) fn times(&self) -> u32 {
        if self.zoom >= 1.0 && self.zoom.fract() == 0.0 {
            self.zoom as u32
        } else {
            0
        }
    }

    /// The place of the picture at a place of the window: columns from the left, rows from the top, with fractions.
    pub(super) fn at(&self, at: [f64; 2]) -> [f64; 2] {
        [0, 1].map(|i| (at[i] - f64::from(self.origin[i])) / self.zoom)
    }

    /// The pixel there: column, and row from the bottom; none beside the picture.
    pub(super) fn pixel(&self, at: [f64; 2], [width, height]: [u32; 2]) -> Option<[u32; 2]> {
        let [x, y] = self.at(at);
        let inside = x >= 0.0 && y >= 0.0 && x < f64::from(width) && y < f64::from(height);
        inside.then(|| [x as u32, height - 1 - y as u32])
    }
}

/// The viewpoint after a drag by so many pixels of the picture, to the right and down: it follows the mouse.
pub(super) fn dragged(camera: &Camera, viewpoint: DVec3, by: [f64; 2]) -> DVec3 {
    let [width, height] = camera.pixeldim.map(f64::from);
    let world = DVec3::new(
        by[0] * camera.worlddim.x / width,
        -by[1] * camera.worlddim.y / height,
        0.0,
    );
    neat(viewpoint + world, camera)
}

/// The viewpoint so many steps to the right and up, a step being a fortieth of the screen's width.
pub(super) fn stepped(camera: &Camera, viewpoint: DVec3, steps: [f64; 2]) -> DVec3 {
    let step = camera.worlddim.x / 40.0;
    neat(
        viewpoint + DVec3::new(steps[0] * step, steps[1] * step, 0.0),
        camera,
    )
}

/// The viewpoint farther from the screen, by so many steps of a twentieth each; nearer where they are negative.
pub(super) fn moved_away(camera: &Camera, viewpoint: DVec3, steps: f64) -> DVec3 {
    let nearest = (camera.viewpoint.z * NEAREST).max(f64::MIN_POSITIVE);
    let z = (viewpoint.z * 1.05_f64.powf(steps)).max(nearest);
    let neat = neat(DVec3 { z, ..viewpoint }, camera);
    DVec3 {
        z: if neat.z > 0.0 { neat.z } else { z },
        ..neat
    }
}

/// In numbers that a person would write, to about a ten-thousandth of the screen's width.
fn neat(viewpoint: DVec3, camera: &Camera) -> DVec3 {
    let neat = viewpoint
        .to_array()
        .map(|number| values::neat(number, camera.worlddim.x));
    DVec3::from_array(neat)
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec2;

    const AREA: Area = Area {
        corner: [10.0, 20.0],
        size: [800.0, 600.0],
    };

    fn camera() -> Camera {
        Camera {
            name: "cam".into(),
            pixeldim: [640, 480],
            worlddim: DVec2::new(8.0, 6.0),
            viewpoint: DVec3::new(4.0, 3.0, 6.0),
        }
    }

    #[test]
    fn a_picture_fits_without_being_blurred() {
        let placed = |size| Viewport::Fit.place(AREA, size);
        assert_eq!(
            (placed([640, 480]).zoom, placed([640, 480]).origin),
            (1.0, [90, 80])
        );
        assert_eq!(
            (placed([200, 200]).zoom, placed([200, 200]).times()),
            (3.0, 3)
        );
        assert_eq!(placed([1600, 480]).zoom, 0.5);
        assert_eq!(placed([1600, 480]).times(), 0);
        assert_eq!(placed([1, 1]).zoom, MOST);
        assert_eq!(placed([1_000_000, 1]).zoom, 0.0008);
    }

    #[test]
    fn what_fits_is_whole() {
        for (width, height) in [(420.0, 300.0), (421.0, 301.0), (799.0, 600.0), (3.0, 900.0)] {
            let area = Area {
                corner: [10.0, 21.0],
                size: [width, height],
            };
            for size in [[640, 480], [641, 479], [100, 100], [16384, 1], [7, 100_000]] {
                let Placed { origin, zoom } = Viewport::Fit.place(area, size);
                for i in 0..2 {
                    let (first, last) = (f64::from(origin[i]), zoom * f64::from(size[i]));
                    let end = area.corner[i] + area.size[i];
                    assert!(
                        first >= area.corner[i] && first + last <= end + 1e-9,
                        "{size:?} {area:?}"
                    );
                }
            }
        }
    }

    #[test]
    fn from_a_picture_below_the_smallest_step_steps_lead_up() {
        let mut viewport = Viewport::Fit;
        let size = [1_000_000, 1];
        viewport.step(false, [400.0, 320.0], AREA, size);
        assert_eq!(viewport, Viewport::Fit);
        viewport.step(true, [400.0, 320.0], AREA, size);
        assert_eq!(viewport.place(AREA, size).zoom, STEPS[0]);
    }

    #[test]
    fn the_pixel_under_the_cursor_counts_from_the_bottom_left() {
        let size = [640, 480];
        let placed = Viewport::Fit.place(AREA, size);
        assert_eq!(placed.pixel([90.0, 80.0], size), Some([0, 479]));
        assert_eq!(placed.pixel([90.99, 80.99], size), Some([0, 479]));
        assert_eq!(placed.pixel([729.5, 559.5], size), Some([639, 0]));
        assert_eq!(placed.pixel([89.9, 80.0], size), None);
        assert_eq!(placed.pixel([730.0, 100.0], size), None);
    }

    #[test]
    fn zooming_keeps_what_is_under_the_cursor() {
        let size = [640, 480];
        for at in [[100.0, 100.0], [400.5, 300.5], [700.0, 500.0]] {
            let mut viewport = Viewport::Fit;
            let pixel = viewport.place(AREA, size).pixel(at, size);
            let mut zooms = vec![1.0];
            for _ in 0..20 {
                viewport.step(true, at, AREA, size);
                zooms.push(viewport.place(AREA, size).zoom);
                assert_eq!(
                    viewport.place(AREA, size).pixel(at, size),
                    pixel,
                    "{viewport:?}"
                );
            }
            assert_eq!(zooms.last(), Some(&MOST));
            assert!(zooms.contains(&2.0) && zooms.is_sorted());
            viewport.step(false, at, AREA, size);
            assert_eq!(viewport.place(AREA, size).zoom, 48.0);
        }
    }

    #[test]
    fn panning_moves_the_picture_with_the_mouse_and_does_not_lose_it() {
        let size = [640, 480];
        let mut viewport = Viewport::At {
            zoom: 4.0,
            middle: [100.0, 100.0],
        };
        let before = viewport.place(AREA, size);
        viewport.pan([30.0, -12.0], AREA, size);
        let after = viewport.place(AREA, size);
        assert_eq!(
            [
                after.origin[0] - before.origin[0],
                after.origin[1] - before.origin[1]
            ],
            [30, -12]
        );
        viewport.pan([1e9, 1e9], AREA, size);
        let Viewport::At { middle, .. } = viewport else {
            panic!("{viewport:?}");
        };
        assert_eq!(middle, [0.0, 0.0]);
    }

    #[test]
    fn the_viewpoint_follows_the_mouse() {
        let camera = camera();
        // 80 pixels are a unit of the world; y goes up, rows of the window go down.
        let moved = dragged(&camera, camera.viewpoint, [80.0, 160.0]);
        assert_eq!(moved, DVec3::new(5.0, 1.0, 6.0));
        let one = dragged(&camera, camera.viewpoint, [1.0, 0.0]);
        assert_eq!(one, DVec3::new(4.0125, 3.0, 6.0));
        assert_eq!(
            stepped(&camera, camera.viewpoint, [1.0, -2.0]),
            DVec3::new(4.2, 2.6, 6.0)
        );
    }

    #[test]
    fn the_viewpoint_stays_before_the_screen() {
        let camera = camera();
        let mut viewpoint = camera.viewpoint;
        for _ in 0..2000 {
            viewpoint = moved_away(&camera, viewpoint, -3.0);
            assert!(viewpoint.z > 0.0 && viewpoint.is_finite());
        }
        assert!(viewpoint.z < 0.01);
        assert_eq!(moved_away(&camera, camera.viewpoint, 1.0).z, 6.3);
    }

    #[test]
    fn numbers_stay_short_whatever_the_units() {
        for scale in [1e-6, 1.0, 1e9] {
            let camera = Camera {
                worlddim: DVec2::new(8.0, 6.0) * scale,
                viewpoint: DVec3::new(4.0, 3.0, 6.0) * scale,
                ..camera()
            };
            let mut viewpoint = camera.viewpoint;
            for _ in 0..100 {
                viewpoint = dragged(&camera, viewpoint, [1.0, 1.0]);
            }
            let moved = (viewpoint - camera.viewpoint) / scale;
            assert!(
                (moved.x - 1.25).abs() < 0.02 && (moved.y + 1.25).abs() < 0.02,
                "{moved}"
            );
            let text = format!("{:e}", viewpoint.x);
            assert!(text.len() <= 10, "{text}");
        }
    }
}
