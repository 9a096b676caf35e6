//! Draws the picture on the host, as `screen.wgsl` does it on a GPU: pixel by pixel, or the mean of those that a pixel
//! of the window covers; what decided each of them, and outlines, over it. It is drawn once, and copied into the frame
//! as often as something moves over it.

use std::ops::Range;

use super::tiles::mix;
use super::{Frame, Part};
use crate::frame::DecidedBy;
use crate::preview::draw::{BORDER, Draw, OUTLINE, Outlined, TAPS, shown_as};

/// The picture as it was drawn last.
#[derive(Debug, Default)]
pub(super) struct Cached {
    /// What was drawn, within which part of a window.
    last: Option<(Draw, Part)>,
    /// What of it is seen.
    area: Part,
    /// Its pixels, rows from the top.
    pixels: Vec<u32>,
    /// How often it was drawn.
    count: u64,
}

impl Cached {
    /// Draws the picture as far as it is seen within `clip`, unless that was drawn last; a number that another look
    /// does not have.
    pub(super) fn update(&mut self, draw: &Draw, clip: Part, window: [u32; 2]) -> u64 {
        let is_last =
            matches!(&self.last, Some((last, within)) if *within == clip && last.is_as(draw));
        if !is_last {
            let [left, top, width, height] = draw.covers(window);
            let covered = Part {
                from: [left, top],
                to: [left + width, top + height],
            };
            self.area = covered.and(clip);
            self.pixels = drawn(draw, self.area);
            self.count += 1;
            self.last = Some((draw.clone(), clip));
        }
        mix(2, self.count)
    }

    /// Copies what lies within.
    pub(super) fn paint(&self, frame: &mut Frame, within: Part) {
        let part = self.area.and(within);
        if part.is_empty() {
            return;
        }
        let width = (self.area.to[0] - self.area.from[0]) as usize;
        for y in part.from[1]..part.to[1] {
            let row = (y - self.area.from[1]) as usize * width;
            let [from, to] = [part.from[0], part.to[0]].map(|x| (x - self.area.from[0]) as usize);
            frame
                .row(y, part)
                .copy_from_slice(&self.pixels[row + from..row + to]);
        }
    }
}

/// The pixels of a part of the window that the picture covers.
pub(super) fn drawn(draw: &Draw, area: Part) -> Vec<u32> {
    let [across, down] = [0, 1].map(|axis| -> Vec<Taps> {
        let along = area.from[axis]..area.to[axis];
        along.map(|at| Taps::new(draw, axis, at as i32)).collect()
    });
    let mut pixels = Vec::with_capacity(across.len() * down.len());
    // The columns of the picture that are seen. Taps lie in the order of the window's columns.
    let first = across.iter().map(|tap| tap.of[0].0).min().unwrap_or(0) as usize;
    let last = across.iter().flat_map(|tap| tap.of.last());
    let end = last.map(|(x, _)| x + 1).max().unwrap_or(0) as usize;
    let columns = draw.pixels.size[0] as usize;
    let mut means = vec![0.0_f32; 3 * (end - first)];
    let mut last: &[(u32, f32)] = &[];
    for line in &down {
        // Where the picture has fewer rows than the window, many of these are alike.
        if line.of == last {
            pixels.extend_from_within(pixels.len() - across.len()..);
            continue;
        }
        last = &line.of;
        // First the mean down each column of the picture, then along the row.
        means.fill(0.0);
        for &(y, weight) in &line.of {
            let start = y as usize * columns;
            add(draw, start + first..start + end, weight, &mut means);
        }
        let means = means.as_chunks::<3>().0;
        pixels.extend(across.iter().map(|tap| {
            let mut sum = [0.5; 3];
            for &(x, weight) in &tap.of {
                let mean = means[x as usize - first];
                for i in 0..3 {
                    sum[i] += weight * mean[i];
                }
            }
            let [r, g, b] = sum.map(|sum| sum as u8);
            u32::from_le_bytes([r, g, b, 255])
        }));
    }
    if let Some(outlined) = &draw.outlined {
        outline(draw, outlined, area, &mut pixels);
    }
    pixels
}

/// Adds so much of the look of some pixels of a row to sums, three a pixel.
fn add(draw: &Draw, pixels: Range<usize>, weight: f32, sums: &mut [f32]) {
    let bytes = &draw.pixels.rgb[3 * pixels.start..3 * pixels.end];
    if !draw.verdicts {
        for (sum, byte) in sums.iter_mut().zip(bytes) {
            *sum += weight * f32::from(*byte);
        }
        return;
    }
    let looks = DecidedBy::ALL.map(shown_as);
    let pixels = bytes.chunks_exact(3).zip(&draw.pixels.verdicts[pixels]);
    for (sums, (bytes, by)) in sums.chunks_exact_mut(3).zip(pixels) {
        let (keep, color) = looks[*by as usize];
        for i in 0..3 {
            sums[i] += weight * (keep * f32::from(bytes[i]) + color[i]);
        }
    }
}

/// Which columns (or rows) of the picture make one of the window's, and what share of it each is.
struct Taps {
    of: Vec<(u32, f32)>,
}

impl Taps {
    /// Of a column or row that the picture covers.
    fn new(draw: &Draw, axis: usize, at: i32) -> Self {
        let (size, has) = (draw.size[axis], draw.pixels.size[axis]);
        let mut of: Vec<(u32, f32)> = Vec::new();
        if draw.placed.zoom >= 1.0 {
            let pixel = pixel_at(draw, axis, at).unwrap_or(size - 1);
            of.push((place(pixel, size, has), 1.0));
            return Self { of };
        }
        let (zoom, size_f) = (draw.placed.zoom as f32, size as f32);
        let first = (at - draw.placed.origin[axis]) as f32 / zoom;
        let last = (first + 1.0 / zoom).min(size_f);
        let start = first.floor();
        let stride = ((last.ceil() - start) / TAPS as f32).ceil().max(1.0);
        let mut weights = 0.0;
        let mut from = start;
        while from < last {
            let weight = last.min(from + stride) - first.max(from);
            let pixel = ((from + (0.5 * stride).floor()) as u32).min(size - 1);
            let place = place(pixel, size, has);
            match of.last_mut() {
                Some((last, all)) if *last == place => *all += weight,
                _ => of.push((place, weight)),
            }
            weights += weight;
            from += stride;
        }
        if of.is_empty() {
            // The last pixel of the window may cover nothing but a rounding error of the picture.
            of.push((has - 1, 1.0));
            weights = 1.0;
        }
        of.iter_mut().for_each(|(_, weight)| *weight /= weights);
        Self { of }
    }
}

/// The column (or row) of the picture, as large as it is drawn, at one of the window; none beside it.
fn pixel_at(draw: &Draw, axis: usize, at: i32) -> Option<u32> {
    let offset = at - draw.placed.origin[axis];
    let pixel = match draw.placed.times() {
        0 => ((offset as f32 + 0.5) / draw.placed.zoom as f32).floor() as i64,
        times => i64::from(offset.div_euclid(times as i32)),
    };
    (offset >= 0 && pixel < i64::from(draw.size[axis])).then_some(pixel as u32)
}

/// A column (or row) where there are perhaps fewer of them.
fn place(pixel: u32, size: u32, has: u32) -> u32 {
    if has == size {
        return pixel;
    }
    (((pixel as f32 + 0.5) * has as f32 / size as f32) as u32).min(has - 1)
}

/// Paints a border around what is chosen.
fn outline(draw: &Draw, Outlined { seen, chosen }: &Outlined, area: Part, pixels: &mut [u32]) {
    let border = BORDER as usize;
    let places = [0, 1].map(|axis| {
        let along = area.from[axis] as i32 - BORDER as i32..area.to[axis] as i32 + BORDER as i32;
        along
            .map(|at| {
                let pixel = pixel_at(draw, axis, at)?;
                Some(place(pixel, draw.size[axis], seen.size[axis]) as usize)
            })
            .collect::<Vec<_>>()
    });
    let is_chosen = |x: usize, y: usize| {
        let (Some(x), Some(y)) = (places[0][x], places[1][y]) else {
            return false;
        };
        let object = seen.objects[y * seen.size[0] as usize + x];
        chosen
            .get(object as usize / 32)
            .is_some_and(|word| word >> (object % 32) & 1 != 0)
    };
    let [r, g, b] = OUTLINE;
    let color = u32::from_le_bytes([r, g, b, 255]);
    let width = (area.to[0] - area.from[0]) as usize;
    for (i, pixel) in pixels.iter_mut().enumerate() {
        let (x, y) = (i % width + border, i / width + border);
        let inside = is_chosen(x, y);
        let around = [
            (x + border, y),
            (x - border, y),
            (x, y + border),
            (x, y - border),
        ];
        if around.iter().any(|&(x, y)| is_chosen(x, y) != inside) {
            *pixel = color;
        }
    }
}
