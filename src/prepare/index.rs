//! Indices of tiles, blocks and texels as primary rays see them, exactly: quotients of linear forms over the pixel.
//!
//! On most planes of most scenes such an index depends on the pixel's column alone, or on its row alone: the z of a
//! floor, x and y of a wall that faces the viewer, x and z of a wall that stands upright. There floor(index) is an
//! exact fact of the column or row, and no pixel need be in doubt about it, tied or not. `shader::pack` makes tables of
//! these facts.

use dashu_int::IBig;
use glam::DVec3;

use super::camera::over_pixels;
use super::extent::along_sides;
use super::surface::{PPLANE_SHIFT, PPLANE_TILE, TILE_SHIFT};
use super::triangle::exact_normal;
use crate::real::rational::{Ratio, abs, dot, is_positive, is_zero, ratio, ratio3, root, sub};
use crate::real::{Bounded, Real};
use crate::scene::{self, Extent, Object, Scene, Shape, TextureMode};

/// An index before its floor is taken: top·(x, y, 1) / bottom·(x, y, 1) at the pixel (x, y), where the plane is met if
/// the divisor is > 0.
#[derive(Debug, Clone, PartialEq)]
pub struct Index {
    top: [Ratio; 3],
    /// 1/s, up to a positive factor.
    bottom: [Ratio; 3],
}

/// The plane that an index is on, and the camera that sees it.
struct ViewedPlane<'a> {
    camera: &'a scene::Camera,
    normal: [Ratio; 3],
    point: [Ratio; 3],
}

/// The indices that the surface of an object asks for, in the order in which its shader names them; None for one whose
/// direction is not rational. Empty for surfaces that ask for none.
pub fn indices(scene: &Scene, object: &Object) -> Vec<Option<Index>> {
    let (normal, point, extent) = match &object.shape {
        Shape::Plane {
            normal,
            point,
            extent,
        } => (ratio3(*normal), point, extent),
        Shape::Triangle(triangle) => (
            exact_normal(triangle),
            &triangle.vertices[0],
            &Extent::Unbounded,
        ),
        // Their hits are no quotients of linear forms.
        Shape::Sphere { .. } | Shape::Quadric(_) => return Vec::new(),
    };
    let viewed = ViewedPlane {
        camera: &scene.camera,
        normal,
        point: ratio3(*point),
    };
    let axes = [DVec3::X, DVec3::Y, DVec3::Z].map(ratio3);
    match object.surface {
        scene::Surface::Tiled {
            dimension, xdir, ..
        } => {
            let [x, _, z] = axes;
            let rows = match xdir {
                None => [Some(x), Some(z)],
                Some(xdir) => viewed.rows(xdir),
            };
            let sizes = [dimension.x, dimension.y].map(ratio);
            rows.iter()
                .zip(&sizes)
                .map(|(row, size)| viewed.index(row.as_ref()?, &ratio(TILE_SHIFT), size))
                .collect()
        }
        scene::Surface::Procedural { .. } => {
            let (shift, size) = (ratio(PPLANE_SHIFT), ratio(PPLANE_TILE));
            axes.iter()
                .map(|row| viewed.index(row, &shift, &size))
                .collect()
        }
        scene::Surface::Textured { texture, mode } => {
            let rectangle = match extent {
                Extent::Rectangle(rectangle) => rectangle,
                // A picture is on nothing else.
                Extent::Unbounded => return Vec::new(),
            };
            let texels = &scene.textures[texture].texels;
            let counts = [texels.width, texels.height].map(|n| ratio(f64::from(n)));
            let camera = &scene.camera;
            let sizes = match mode {
                TextureMode::Fit => [
                    ratio(rectangle.dimensions.x) / &counts[0],
                    ratio(rectangle.dimensions.y) / &counts[1],
                ],
                TextureMode::Tile => [
                    ratio(camera.worlddim.x) / ratio(f64::from(camera.pixeldim[0])),
                    ratio(camera.worlddim.y) / ratio(f64::from(camera.pixeldim[1])),
                ],
            };
            viewed
                .rows(rectangle.xdir)
                .iter()
                .zip(&sizes)
                .map(|(row, size)| {
                    let row = row.as_ref()?;
                    viewed.index(row, &-dot(row, &viewed.point), size)
                })
                .collect()
        }
        scene::Surface::Plain => Vec::new(),
    }
}

impl ViewedPlane<'_> {
    /// The unit vectors along the sides, where they are rational.
    fn rows(&self, xdir: DVec3) -> [Option<[Ratio; 3]>; 2] {
        along_sides(&self.normal, &ratio3(xdir)).map(|row| {
            let length = root(&dot(&row, &row))?;
            Some(row.map(|c| c / &length))
        })
    }

    /// (row·H + shift)/size at the hit H; None if the viewpoint lies on the plane.
    fn index(&self, row: &[Ratio; 3], shift: &Ratio, size: &Ratio) -> Option<Index> {
        let v = ratio3(self.camera.viewpoint);
        let n = &self.normal;
        let k = dot(n, &sub(&self.point, &v));
        if is_zero(&k) {
            return None;
        }
        // H = V + s·W, with 1/s = N·W/k and W.z = −V.z: the index is ((row·V + shift)·(1/s) + row·W)/size, over 1/s.
        let over = |form: &[Ratio; 3]| {
            let [a, b, c] = form;
            over_pixels(self.camera, &[a.clone(), b.clone(), -(c * &v[2])])
        };
        let mut bottom = over(&n.clone().map(|c| c / &k));
        // As good as any positive factor, and within the range of f64.
        let largest = bottom
            .iter()
            .cloned()
            .map(abs)
            .fold(Ratio::ZERO, |a, b| if b > a { b } else { a });
        if is_zero(&largest) {
            return None;
        }
        let base = (dot(row, &v) + shift) / size;
        let step = over(row);
        let mut top = [0, 1, 2].map(|i| &base * &bottom[i] + &step[i] / size);
        bottom = bottom.map(|c| c / &largest);
        top = top.map(|c| c / &largest);
        Some(Index { top, bottom })
    }
}

impl Index {
    /// floor(index) for each column (`axis` 0) or row (1) of `pixels`, where that is the same for all its pixels that
    /// meet the plane; None where it is not, or none of them does. Nothing at all if that is so everywhere.
    pub fn floors(&self, axis: usize, pixels: u32) -> Vec<Option<IBig>> {
        let other = 1 - axis;
        let (top, bottom) = (&self.top[other], &self.bottom[other]);
        if is_zero(top) && is_zero(bottom) {
            return self.line(axis, pixels);
        }
        // The lines on which an index is constant meet in one point, and one of them runs along a column (or row). On
        // it the quotient of the forms is the quotient of their slopes.
        if is_zero(bottom) {
            return Vec::new();
        }
        let cross = |i: usize| top * &self.bottom[i] - bottom * &self.top[i];
        let (slope, constant) = (cross(axis), cross(2));
        if is_zero(&slope) {
            return Vec::new();
        }
        let at = -constant / slope;
        let whole = at.floor();
        let place = usize::try_from(whole.clone()).ok();
        match place.filter(|p| *p < pixels as usize && at == Ratio::from(whole)) {
            Some(place) => {
                let mut floors = vec![None; pixels as usize];
                floors[place] = Some((top / bottom).floor());
                floors
            }
            None => Vec::new(),
        }
    }

    /// The floors where the index is a function of one coordinate.
    fn line(&self, axis: usize, pixels: u32) -> Vec<Option<IBig>> {
        let forms = [
            &self.top[axis],
            &self.top[2],
            &self.bottom[axis],
            &self.bottom[2],
        ];
        let bounded = forms.map(Bounded::ratio);
        (0..pixels)
            .map(|n| {
                let at = f64::from(n);
                let bottom = bounded[2].times(at) + bounded[3];
                let index = (bounded[0].times(at) + bounded[1]) / bottom;
                match (bottom.positive(), index.floor()) {
                    (Ok(false), _) => None,
                    (Ok(true), Ok(floor)) if floor.abs() < WHOLE => Some(IBig::from(floor as i64)),
                    _ => {
                        let at = ratio(at);
                        let bottom = forms[2] * &at + forms[3];
                        is_positive(&bottom).then(|| ((forms[0] * &at + forms[1]) / bottom).floor())
                    }
                }
            })
            .collect()
    }
}

/// What fits into an i64, with room.
const WHOLE: f64 = (1_u64 << 52) as f64;

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::load;

    /// What docs/SCENE.md ("What a surface reflects") says an index is, at the hit of the ray through a pixel; None
    /// where that misses.
    fn directly(scene: &Scene, object: &Object, which: usize, pixel: [u32; 2]) -> Option<Ratio> {
        let Shape::Plane {
            normal,
            point,
            extent,
        } = &object.shape
        else {
            panic!("no plane")
        };
        let camera = &scene.camera;
        let (n, q, v) = (ratio3(*normal), ratio3(*point), ratio3(camera.viewpoint));
        let world = |i: usize, side: f64| {
            let (at, pixels) = (f64::from(pixel[i]), f64::from(camera.pixeldim[i]));
            if pixels > 1.0 {
                ratio(side) * ratio(at) / ratio(pixels - 1.0)
            } else {
                ratio(side) / ratio(2.0)
            }
        };
        let screen = [
            world(0, camera.worlddim.x),
            world(1, camera.worlddim.y),
            Ratio::ZERO,
        ];
        let w = sub(&screen, &v);
        let (ahead, along) = (dot(&n, &sub(&q, &v)), dot(&n, &w));
        if is_zero(&along) || !is_positive(&(&ahead / &along)) {
            return None;
        }
        let s = ahead / along;
        let h = [0, 1, 2].map(|i| &v[i] + &s * &w[i]);
        // A side of a rectangle, of length 1: the scenes here have only such as are rational.
        let side = |xdir: DVec3| {
            let x = ratio3(xdir);
            let (nn, nx) = (dot(&n, &n), dot(&n, &x));
            let first = [0, 1, 2].map(|i| &x[i] - &n[i] * &nx / &nn);
            let row = if which == 0 {
                first
            } else {
                let [a, b, c] = &n;
                let [d, e, f] = &first;
                [b * f - c * e, c * d - a * f, a * e - b * d]
            };
            let length = root(&dot(&row, &row)).unwrap();
            row.map(|c| c / &length)
        };
        Some(match object.surface {
            scene::Surface::Tiled {
                dimension, xdir, ..
            } => {
                let along = match xdir {
                    None => h[2 * which].clone(),
                    Some(xdir) => dot(&side(xdir), &h),
                };
                (along + ratio(10_000.0)) / ratio(dimension[which])
            }
            scene::Surface::Procedural { .. } => ratio(2.0) * &h[which] + ratio(1000.0),
            scene::Surface::Textured { texture, mode } => {
                let Extent::Rectangle(rectangle) = extent else {
                    panic!("no rectangle")
                };
                let p = dot(&side(rectangle.xdir), &sub(&h, &q));
                let texels = &scene.textures[texture].texels;
                let count = [texels.width, texels.height][which];
                match mode {
                    TextureMode::Fit => {
                        p / ratio(rectangle.dimensions[which]) * ratio(f64::from(count))
                    }
                    TextureMode::Tile => {
                        let pixels = f64::from(camera.pixeldim[which]);
                        p / (ratio(camera.worlddim[which]) / ratio(pixels))
                    }
                }
            }
            scene::Surface::Plain => panic!("no index"),
        })
    }

    /// Compares all that is known of a scene's indices with each pixel's own; returns how many columns and rows are
    /// known.
    fn known(path: &str, pixeldim: [u32; 2]) -> usize {
        let mut scene = load(path.as_ref()).unwrap();
        scene.camera.pixeldim = pixeldim;
        let mut count = 0;
        for object in &scene.objects {
            for (which, index) in indices(&scene, object).into_iter().enumerate() {
                let Some(index) = index else { continue };
                for axis in [0, 1] {
                    let floors = index.floors(axis, pixeldim[axis]);
                    assert!(floors.is_empty() || floors.len() == pixeldim[axis] as usize);
                    for (place, floor) in (0..).zip(floors) {
                        let Some(floor) = floor else { continue };
                        count += 1;
                        for other in 0..pixeldim[1 - axis] {
                            let pixel = if axis == 0 {
                                [place, other]
                            } else {
                                [other, place]
                            };
                            if let Some(truth) = directly(&scene, object, which, pixel) {
                                assert_eq!(floor, truth.floor(), "{}: {which}", object.name);
                            }
                        }
                    }
                }
            }
        }
        count
    }

    #[test]
    fn what_is_known_of_a_column_or_row_holds_for_its_pixels() {
        let scenes = concat!(env!("CARGO_MANIFEST_DIR"), "/scenes");
        for (name, pixeldim, least) in [
            // Floor and ceiling in six rows each; pictures, frieze and wall in all columns and rows; …
            ("hard/tied_lines", [17, 13], 150),
            ("hard/tied_lines", [1, 13], 50),
            ("hard/tied_lines", [16, 1], 50),
            ("hard/tied_lines", [23, 11], 150),
            ("hard/tile_edges_tenth", [9, 7], 3),
            ("hard/millimetres", [21, 16], 1),
            ("hard/light_years", [21, 16], 1),
            ("gallery/tiles_back_wall", [20, 15], 30),
            ("gallery/tiles_side_wall", [20, 15], 15),
            ("lit/texture_repeated", [20, 15], 30),
        ] {
            let count = known(&format!("{scenes}/{name}.txt"), pixeldim);
            assert!(count >= least, "{name}: {count}");
        }
    }

    #[test]
    fn one_column_may_be_known_where_others_are_not() {
        // On a floor x is the viewpoint's own along the column under it; V.x = 4 is in column 8 of 17.
        let scene = concat!(env!("CARGO_MANIFEST_DIR"), "/scenes/hard/tied_lines.txt");
        let scene = load(scene.as_ref()).unwrap();
        let floor = &indices(&scene, &scene.objects[0]);
        let x = floor[0].as_ref().unwrap().floors(0, 17);
        let want: Vec<_> = (0..17)
            .map(|n| (n == 8).then(|| IBig::from(10_004)))
            .collect();
        assert_eq!(x, want);
        assert!(floor[0].as_ref().unwrap().floors(1, 13).is_empty());
    }
}
