//! The band under way: rectangles of pixels come in, a finished band goes out, undecided pixels decided by the CPU.

use rayon::prelude::*;

use super::plan::Rectangle;
use super::{BandTimes, Refine};
use crate::frame::{Band, PixelFault};

/// The band under way, put together from its rectangles.
#[derive(Debug)]
pub(super) struct Assembly {
    width: usize,
    values: bool,
    band: Option<Band>,
    /// Places in the band that the CPU has to decide.
    undecided: Vec<usize>,
    complete: bool,
}

impl Assembly {
    pub(super) fn new(width: u32, values: bool) -> Self {
        Self {
            width: width as usize,
            values,
            band: None,
            undecided: Vec::new(),
            complete: false,
        }
    }

    /// Copies a rectangle's pixels to their place.
    pub(super) fn take(&mut self, rectangle: &Rectangle, bytes: &[u8]) {
        let rows = (rectangle.band.end - rectangle.band.start) as usize;
        let pixels = rows * self.width;
        let band = self.band.get_or_insert_with(|| Band {
            rows: rectangle.band.clone(),
            rgb: vec![0; 3 * pixels],
            values: self.values.then(|| vec![[0.0; 3]; pixels]),
        });
        let columns = rectangle.columns.start as usize..rectangle.columns.end as usize;
        let pixel_bytes = if self.values { 16 } else { 4 };
        for (row, line) in bytes.chunks_exact(columns.len() * pixel_bytes).enumerate() {
            let place = row * self.width + columns.start..row * self.width + columns.end;
            let rgb = &mut band.rgb[3 * place.start..3 * place.end];
            let mut verdicts = 0;
            for (pixel, to) in line.chunks_exact(pixel_bytes).zip(rgb.chunks_exact_mut(3)) {
                to.copy_from_slice(&pixel[pixel_bytes - 4..pixel_bytes - 1]);
                verdicts |= pixel[pixel_bytes - 1];
            }
            if verdicts != 0 {
                let pixels = line.chunks_exact(pixel_bytes).enumerate();
                self.undecided.extend(
                    pixels
                        .filter(|(_, p)| p[pixel_bytes - 1] != 0)
                        .map(|(i, _)| place.start + i),
                );
            }
            if let Some(values) = &mut band.values {
                for (pixel, to) in line.chunks_exact(pixel_bytes).zip(&mut values[place]) {
                    let channel = |i: usize| -> f32 {
                        let word = pixel[4 * i..4 * i + 4]
                            .try_into()
                            .map_or(0, u32::from_le_bytes);
                        f32::from_bits(word) / 255.0
                    };
                    *to = [channel(0), channel(1), channel(2)];
                }
            }
        }
        self.complete = rectangle.last;
    }

    /// The band, if all its rectangles have come, with what the CPU had to decide.
    pub(super) fn finished(
        &mut self,
        refine: &Refine<'_>,
        times: &mut BandTimes,
    ) -> Result<Option<Band>, PixelFault> {
        if !std::mem::take(&mut self.complete) {
            return Ok(None);
        }
        let Some(mut band) = self.band.take() else {
            return Ok(None);
        };
        times.refined += self.undecided.len() as u64;
        let (width, top) = (self.width, band.rows.end - 1);
        let decided: Vec<(usize, _)> = std::mem::take(&mut self.undecided)
            .into_par_iter()
            .map(|place| {
                refine((place % width) as u32, top - (place / width) as u32)
                    .map(|done| (place, done))
            })
            .collect::<Result<_, _>>()?;
        for (place, (value, bytes)) in decided {
            band.rgb[3 * place..3 * place + 3].copy_from_slice(&bytes);
            if let Some(values) = &mut band.values {
                values[place] = value;
            }
        }
        Ok(Some(band))
    }
}
