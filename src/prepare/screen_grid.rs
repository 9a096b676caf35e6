//! Which of many spheres and triangles a primary ray may hit, by the cell of the screen that it passes through. For
//! both tracers.
//!
//! A sphere or triangle stands in the list of every cell that its outline's box touches. The lists run from the nearest
//! sphere on, so that a ray asks them only until what is left must lie behind what it has hit. The boxes come from f64
//! and are padded by far more than that errs: they only ever say "may be hit".

use std::collections::HashSet;

use glam::DVec3;
use rayon::prelude::*;

use super::camera::Camera;
use super::plane::Plane;
use super::sphere::Sphere;
use crate::real::Real;
use crate::real::rational::two_to;
use crate::scene::{Scene, Shape};
use crate::settings::ViewParameters;

/// From so many objects on a ray does not ask every sphere. (Fewer stand in the text of the GPU's shader.)
pub const WORTHWHILE: usize = 33;

/// Columns and rows of a cell, unless there would be too many cells: a driver that is a CPU runs 8 pixels of a row as
/// one vector, and they should share a list.
const SIDES: [u32; 2] = [8, 4];

/// Most cells.
const MOST_CELLS: u64 = 1 << 20;

/// Most entries of all lists, beside eight for each sphere or triangle.
const ENTRIES: u64 = 1 << 20;

/// Spheres are seen from outside by a ray that is not parallel to the screen if their depth is more than their radius
/// by this share; the others are seen anywhere.
const CLEARANCE: f64 = 1.0 + 1e-5;

/// How far the end of an outline may be off: relatively, and in pixels.
const PAD: f64 = 1e-9;
const PAD_PIXELS: f64 = 1e-3;
/// The same, for a unit of |w| + |o|: the way from there to pixels.
const PAD_WAY: f64 = 1e-13;

/// What the largest 1/s of a sphere is multiplied by.
const INVERSE_GROWTH: f64 = 1.0 + 1e-6;

/// Pixels nearer together than this are beyond what is known of outlines: then a sphere is in every list.
const LEAST_STEP: f64 = 1e-100;

/// The lists.
#[derive(Debug, Clone)]
pub struct ScreenGrid {
    /// Columns and rows of a cell.
    pub sides: [u32; 2],
    /// Number of cells side by side, and one above the other.
    pub count: [u32; 2],
    /// The list of cell i, counted by rows from the bottom left, is `members[starts[i]..starts[i + 1]]`.
    pub starts: Vec<u32>,
    /// Places of the prepared spheres, and after all of them those of the prepared triangles; in each list the nearest
    /// first.
    pub members: Vec<u32>,
    /// For each of them: its hits' 1/s are no larger.
    pub max_inverse: Vec<f32>,
}

/// The pixels that a sphere or triangle may cover: first and last column and row.
type Covered = [[u32; 2]; 2];

/// The largest 1/s of its hits, and the pixels that it may cover.
type Seen = (f32, Covered);

impl ScreenGrid {
    /// The places of what a ray through this point of the screen may hit, in pixels from the bottom left.
    /// The nearest come first.
    pub fn at(&self, pixel: [f64; 2]) -> &[u32] {
        let [column, row] = [0, 1].map(|i| {
            let pixel = pixel[i].round().max(0.0) as u32;
            (pixel / self.sides[i]).min(self.count[i] - 1)
        });
        let cell = (row * self.count[0] + column) as usize;
        &self.members[self.starts[cell] as usize..self.starts[cell + 1] as usize]
    }

    /// The spheres and triangles that are seen somewhere, prepared, and where that is.
    pub fn sorted<R: Real>(
        scene: &Scene,
        camera: &Camera<R>,
        view: ViewParameters,
        hidden: &[bool],
    ) -> (Vec<Sphere<R>>, Vec<Plane<R>>, Self) {
        let ball = |object: usize| match scene.objects[object].shape {
            Shape::Sphere { center, radius } => Some((center, radius)),
            Shape::Plane { .. } | Shape::Triangle(_) | Shape::Quadric(_) => None,
        };
        let outline = Outlines::new(scene, camera, view);
        let seen_sphere = |object: usize| {
            let (center, radius) = ball(object).filter(|_| !hidden[object])?;
            let seen = outline.of(center, radius)?;
            let sphere = Sphere::new(scene.camera.viewpoint, camera, object, center, radius)?;
            Some((sphere, seen))
        };
        let seen_triangle = |object: usize| {
            let triangle = match &scene.objects[object].shape {
                Shape::Triangle(triangle) if !hidden[object] => triangle,
                _ => return None,
            };
            let seen = outline.of_triangle(&triangle.vertices)?;
            let plane = Plane::of_triangle(&scene.camera, camera, view, object, triangle)?;
            Some((plane, seen))
        };
        let objects = || (0..scene.objects.len()).into_par_iter();
        let (spheres, mut seen): (Vec<Sphere<R>>, Vec<Seen>) =
            objects().filter_map(seen_sphere).unzip();
        let (triangles, seen_too): (Vec<Plane<R>>, Vec<Seen>) =
            objects().filter_map(seen_triangle).unzip();
        seen.extend(seen_too);
        let (max_inverse, covered): (Vec<f32>, Vec<Covered>) = seen.into_iter().unzip();
        let ball = |place: usize| ball(spheres.get(place)?.object);
        let screen_grid = Self::of(scene.camera.pixeldim, max_inverse, &covered, ball);
        (spheres, triangles, screen_grid)
    }

    /// The lists of spheres and triangles that cover these pixels; `ball` is what a sphere is.
    fn of(
        pixels: [u32; 2],
        max_inverse: Vec<f32>,
        covered: &[Covered],
        ball: impl Fn(usize) -> Option<(DVec3, f64)>,
    ) -> Self {
        let order = nearest_first(&max_inverse, ball);
        let mut sides = SIDES;
        while !few_enough(pixels, sides, covered) {
            sides = sides.map(|side| 2 * side);
        }
        let count = counts(pixels, sides);
        let cells = count[0] as usize * count[1] as usize;
        let mut starts = vec![0_u32; cells + 2];
        let each = |place: usize, then: &mut dyn FnMut(usize)| {
            let [x, y] = covered[place];
            for row in y[0] / sides[1]..=y[1] / sides[1] {
                for column in x[0] / sides[0]..=x[1] / sides[0] {
                    then(row as usize * count[0] as usize + column as usize);
                }
            }
        };
        for &place in &order {
            each(place as usize, &mut |cell| starts[cell + 2] += 1);
        }
        let mut total = 0;
        for start in &mut starts {
            total += *start;
            *start = total;
        }
        // Now starts[i + 1] is where cell i's list goes on; filled, it is where it ends.
        let mut members = vec![0; total as usize];
        for &place in &order {
            each(place as usize, &mut |cell| {
                members[starts[cell + 1] as usize] = place;
                starts[cell + 1] += 1;
            });
        }
        starts.pop();
        Self {
            sides,
            count,
            starts,
            members,
            max_inverse,
        }
    }
}

fn counts(pixels: [u32; 2], sides: [u32; 2]) -> [u32; 2] {
    [0, 1].map(|i| pixels[i].div_ceil(sides[i]))
}

/// Whether cells of this size are not too many, nor their lists too long.
fn few_enough(pixels: [u32; 2], sides: [u32; 2], covered: &[Covered]) -> bool {
    let count = counts(pixels, sides).map(u64::from);
    if count == [1, 1] {
        return true;
    }
    let entries = |covered: &Covered| {
        let [columns, rows] = [0, 1].map(|i| {
            let [first, last] = covered[i];
            u64::from(last / sides[i] - first / sides[i] + 1)
        });
        columns * rows
    };
    let total: u64 = covered.par_iter().map(entries).sum();
    count[0] * count[1] <= MOST_CELLS && total <= ENTRIES + 8 * covered.len() as u64
}

/// The places of the spheres and triangles, nearest first. Of equal spheres only the first in the file is there: it is
/// the one that counts.
fn nearest_first(max_inverse: &[f32], ball: impl Fn(usize) -> Option<(DVec3, f64)>) -> Vec<u32> {
    // Positive floats are ordered as their bits.
    let key = |(place, max_inverse): (usize, &f32)| {
        u64::from(!max_inverse.to_bits()) << 32 | place as u64
    };
    let mut keys: Vec<u64> = max_inverse.par_iter().enumerate().map(key).collect();
    keys.par_sort_unstable();
    let mut order = Vec::with_capacity(keys.len());
    for alike in keys.chunk_by(|a, b| a >> 32 == b >> 32) {
        let places = alike.iter().map(|key| *key as u32);
        if alike.len() == 1 {
            order.extend(places);
            continue;
        }
        let mut seen = HashSet::new();
        order.extend(places.filter(|place| {
            let Some((center, radius)) = ball(*place as usize) else {
                return true;
            };
            // Adding 0 makes −0 and 0 the same.
            let [x, y, z] = center.to_array().map(|c| c + 0.0);
            seen.insert([x, y, z, radius].map(f64::to_bits))
        }));
    }
    order
}

/// Where spheres are seen.
struct Outlines {
    viewpoint: DVec3,
    unit: f64,
    distance: f64,
    step: [f64; 2],
    offset: [f64; 2],
    anchor: [f64; 2],
    pixels: [u32; 2],
    margin: f64,
}

impl Outlines {
    fn new<R: Real>(scene: &Scene, camera: &Camera<R>, view: ViewParameters) -> Self {
        Self {
            viewpoint: scene.camera.viewpoint,
            unit: two_to(-camera.scale),
            distance: camera.distance.to_f64(),
            step: camera.step.map(R::to_f64),
            offset: camera.offset.map(R::to_f64),
            anchor: camera.anchor.map(f64::from),
            pixels: scene.camera.pixeldim,
            margin: view.margin,
        }
    }

    /// The same of a triangle: the box of its projected vertices.
    fn of_triangle(&self, vertices: &[DVec3; 3]) -> Option<Seen> {
        let from = vertices.map(|vertex| (vertex - self.viewpoint) * self.unit);
        let (d, depth) = (self.distance, from.map(|v| -v.z));
        // All rays go towards negative z.
        if depth.iter().all(|depth| *depth < 0.0) {
            return None;
        }
        let reach = from.iter().map(|v| v.abs().max_element());
        let reach = reach.fold(0.0, f64::max);
        // A NaN fails these comparisons.
        let ahead = |depth: &f64| *depth > 1e-50 && *depth > 1e-5 * reach;
        let mut covered = self.pixels.map(|n| [0, n - 1]);
        if !(reach < 1e100 && depth.iter().all(ahead)) {
            return Some((f32::MAX, covered));
        }
        // H.z = −d·s is at most that of the nearest vertex.
        let nearest = depth.iter().copied().fold(f64::INFINITY, f64::min);
        let nearest = (d / nearest * INVERSE_GROWTH).min(f64::from(f32::MAX) * 0.9);
        for (i, covered) in covered.iter_mut().enumerate() {
            let at = |k: usize| d * from[k][i] / depth[k];
            let ends = (at(0).min(at(1)).min(at(2)), at(0).max(at(1)).max(at(2)));
            let pad = PAD * (ends.0.abs() + ends.1.abs());
            *covered = self.pixels_between(i, ends.0 - pad, ends.1 + pad)?;
        }
        Some(((nearest as f32).next_up(), covered))
    }

    /// The columns (`i` = 0) or rows (1) whose rays' W is between these; None if there are none.
    fn pixels_between(&self, i: usize, low: f64, high: f64) -> Option<[u32; 2]> {
        let pixel = |w: f64, sign: f64| {
            let pad = PAD_WAY * (w.abs() + self.offset[i].abs());
            let at = self.anchor[i] + (w - self.offset[i] + sign * pad) / self.step[i];
            at + sign * (self.margin + PAD_PIXELS)
        };
        let (low, high) = (pixel(low, -1.0).ceil(), pixel(high, 1.0).floor());
        let last = f64::from(self.pixels[i] - 1);
        if !(self.step[i] > LEAST_STEP && low.is_finite() && high.is_finite()) {
            return Some([0, self.pixels[i] - 1]);
        }
        if low > last || high < 0.0 || low > high {
            return None;
        }
        Some([low.max(0.0) as u32, high.min(last) as u32])
    }

    /// The largest 1/s of the sphere's hits, and the pixels that it may cover; None if it covers none.
    fn of(&self, center: DVec3, radius: f64) -> Option<Seen> {
        let c = (center - self.viewpoint) * self.unit;
        let r = radius * self.unit;
        let (depth, d) = (-c.z, self.distance);
        let everywhere = self.pixels.map(|n| [0, n - 1]);
        // A NaN fails these comparisons. The squares of depths between these limits stay in range. What underflow takes
        // from a product
        // moves an outline by less than 10⁻²⁰⁰ then.
        let outside = depth > r * CLEARANCE && depth > 1e-50 && depth < 1e100;
        if !outside {
            return Some((f32::MAX, everywhere));
        }
        // H.z = −d·s is at most that of the sphere's nearest point.
        let nearest = (d / (depth - r) * INVERSE_GROWTH).min(f64::from(f32::MAX) * 0.9);
        let max_inverse = (nearest as f32).next_up();
        // The planes through the viewpoint and a column's or row's rays touch the sphere at W_i = d·(c·z ± r·√(c² + z²
        // − r²))/ (z² − r²), z the depth: docs/NUMERICS.md.
        let square = (depth - r) * (depth + r);
        let mut covered = everywhere;
        for (i, covered) in covered.iter_mut().enumerate() {
            let side = if i == 0 { c.x } else { c.y };
            let root = r * (side * side + square).sqrt();
            let middle = side * depth;
            let pad = PAD * (middle.abs() + root);
            let at = |w: f64| d * w / square;
            *covered = self.pixels_between(i, at(middle - root - pad), at(middle + root + pad))?;
        }
        Some((max_inverse, covered))
    }
}

#[cfg(test)]
mod tests;
