//! egui's textures on the host: the letters, above all.

use std::collections::HashMap;

use eframe::egui::{Color32, Pos2, TextureId};
use eframe::epaint::ImageData;
use eframe::epaint::textures::TexturesDelta;

/// Premultiplied colours, rows from the top; it is sampled between its texels, and beyond its edge as at the edge.
#[derive(Debug, Default)]
pub(super) struct Texture {
    size: [usize; 2],
    texels: Vec<Color32>,
}

/// Closer to the middle of a texel than this, in texels, it alone counts: less than a byte's half.
const MIDDLE: f32 = 1.0 / 512.0;

impl Texture {
    fn texel(&self, x: isize, y: isize) -> Color32 {
        let [width, height] = self.size;
        let clamp = |at: isize, size: usize| at.clamp(0, size as isize - 1) as usize;
        self.texels[clamp(y, height) * width + clamp(x, width)]
    }

    /// The colour at a place, whose coordinates are from 0 to 1; channels from 0 to 255.
    pub(super) fn at(&self, uv: Pos2) -> [f32; 4] {
        let [u, v] = [
            uv.x * self.size[0] as f32 - 0.5,
            uv.y * self.size[1] as f32 - 0.5,
        ];
        let [x, y] = [u.round(), v.round()];
        if (u - x).abs() < MIDDLE && (v - y).abs() < MIDDLE {
            return self.texel(x as isize, y as isize).to_array().map(f32::from);
        }
        let [x, y] = [u.floor(), v.floor()];
        let [right, below] = [u - x, v - y];
        let mut mean = [0.0; 4];
        for (i, weight) in [
            (1.0 - right) * (1.0 - below),
            right * (1.0 - below),
            (1.0 - right) * below,
            right * below,
        ]
        .into_iter()
        .enumerate()
        {
            let texel = self.texel(
                x as isize + (i & 1) as isize,
                y as isize + (i >> 1) as isize,
            );
            for (sum, channel) in mean.iter_mut().zip(texel.to_array()) {
                *sum += weight * f32::from(channel);
            }
        }
        mean
    }
}

/// All that there are.
#[derive(Debug, Default)]
pub(super) struct Textures(HashMap<TextureId, Texture>);

impl Textures {
    pub(super) fn get(&self, id: TextureId) -> Option<&Texture> {
        self.0.get(&id)
    }

    /// Takes changes; whether there are any, so that what was painted may look otherwise now.
    pub(super) fn update(&mut self, delta: &mut TexturesDelta) -> bool {
        let is_other = !delta.is_empty();
        for (id, images) in delta.set.drain() {
            for image in images {
                let ImageData::Color(colors) = &image.image;
                let Some([left, top]) = image.pos else {
                    let texels = colors.pixels.clone();
                    let size = colors.size;
                    self.0.insert(id, Texture { size, texels });
                    continue;
                };
                let Some(texture) = self.0.get_mut(&id) else {
                    continue;
                };
                let rows = colors.pixels.chunks_exact(colors.size[0].max(1));
                for (y, row) in rows.enumerate() {
                    let first = (top + y) * texture.size[0] + left;
                    texture.texels[first..first + row.len()].copy_from_slice(row);
                }
            }
        }
        for id in delta.free.drain() {
            self.0.remove(&id);
        }
        is_other
    }
}
