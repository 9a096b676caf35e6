//! Paints egui's triangles: colours and places in a texture at three corners, and what is between them.
//!
//! A pixel is painted where its middle lies within, so pixels on a side that two triangles share are painted once. What
//! is painted is what egui's shader makes of it: the corner's colour times the texel's, over what is there, all of it
//! premultiplied and in bytes as they are.

use eframe::egui::{Color32, Pos2};
use eframe::epaint::{Mesh, Vertex};

use super::textures::Texture;
use super::tiles::{Seen, mix};
use super::{Frame, Part};

/// The triangles of a mesh, in pixels of the window.
pub(super) struct Triangles<'a> {
    texture: &'a Texture,
    triangles: Vec<Triangle>,
}

struct Triangle {
    corners: [Vertex; 3],
    /// Where it may be seen.
    part: Part,
}

impl<'a> Triangles<'a> {
    /// Those of a mesh that is seen within `clip`.
    pub(super) fn new(mesh: &Mesh, texture: &'a Texture, clip: Part, scale: f32) -> Self {
        let triangles = mesh
            .indices
            .as_chunks::<3>()
            .0
            .iter()
            .filter_map(|indices| {
                let corners = indices.map(|i| {
                    let vertex = mesh.vertices[i as usize];
                    Vertex {
                        pos: (vertex.pos.to_vec2() * scale).to_pos2(),
                        ..vertex
                    }
                });
                let is_nothing = corners.iter().all(|c| c.color == Color32::TRANSPARENT);
                let part = around(&corners).and(clip);
                (!part.is_empty() && !is_nothing).then_some(Triangle { corners, part })
            });
        Self {
            texture,
            triangles: triangles.collect(),
        }
    }

    /// Says what is going to be painted where.
    pub(super) fn see(&self, seen: &mut Seen) {
        for Triangle { corners, part } in &self.triangles {
            // The part is what the clip makes of it.
            let edges = [part.from, part.to].into_iter().flatten().map(u64::from);
            let mut number = edges.fold(1, mix);
            for Vertex { pos, uv, color } in corners {
                let pair = |a: f32, b: f32| u64::from(a.to_bits()) << 32 | u64::from(b.to_bits());
                number = mix(number, pair(pos.x, pos.y));
                number = mix(number, pair(uv.x, uv.y));
                number = mix(number, u32::from_le_bytes(color.to_array()).into());
            }
            seen.add(*part, number);
        }
    }

    /// Paints what lies within.
    pub(super) fn paint(&self, frame: &mut Frame, within: Part) {
        for triangle in &self.triangles {
            let part = triangle.part.and(within);
            if !part.is_empty() {
                triangle.paint(self.texture, frame, part);
            }
        }
    }
}

/// The pixels around a triangle.
fn around(corners: &[Vertex; 3]) -> Part {
    let [a, b, c] = corners.each_ref().map(|corner| corner.pos);
    // What is no number, or negative, becomes 0.
    let floor = |at: Pos2| [at.x.floor() as u32, at.y.floor() as u32];
    let ceil = |at: Pos2| [at.x.ceil() as u32, at.y.ceil() as u32];
    Part {
        from: floor(a.min(b).min(c)),
        to: ceil(a.max(b).max(c)),
    }
}

/// What is the same, or changes evenly, over a triangle: red, green, blue, opacity from 0 to 255.
type Channels = [f32; 4];

/// A quantity over a triangle: at a point, and how it changes to the right and down.
struct Plane {
    at: Pos2,
    value: Channels,
    right: Channels,
    down: Channels,
}

impl Plane {
    fn new(at: [Pos2; 3], values: [Channels; 3]) -> Option<Self> {
        let [b, c] = [at[1] - at[0], at[2] - at[0]];
        let area = b.x * c.y - b.y * c.x;
        let plane = |f: &dyn Fn(f32, f32) -> f32| {
            std::array::from_fn(|i| f(values[1][i] - values[0][i], values[2][i] - values[0][i]))
        };
        (area != 0.0).then(|| Self {
            at: at[0],
            value: values[0],
            right: plane(&|to_b, to_c| (to_b * c.y - to_c * b.y) / area),
            down: plane(&|to_b, to_c| (to_c * b.x - to_b * c.x) / area),
        })
    }

    fn value(&self, at: Pos2) -> Channels {
        let by = at - self.at;
        std::array::from_fn(|i| self.value[i] + by.x * self.right[i] + by.y * self.down[i])
    }
}

impl Triangle {
    /// The columns of a row whose middles lie within: from the first to before the last.
    fn columns(&self, y: u32, part: Part) -> [u32; 2] {
        let middle = y as f32 + 0.5;
        let [mut left, mut right] = [f32::INFINITY, f32::NEG_INFINITY];
        for i in 0..3 {
            let [a, b] = [self.corners[i].pos, self.corners[(i + 1) % 3].pos];
            // The same way round for both triangles at a side, so that they agree about it.
            let [a, b] = if a.y <= b.y { [a, b] } else { [b, a] };
            if a.y <= middle && middle < b.y {
                let x = a.x + (b.x - a.x) * ((middle - a.y) / (b.y - a.y));
                left = left.min(x);
                right = right.max(x);
            }
        }
        [left, right].map(|x| {
            let column = (x - 0.5).ceil();
            column.clamp(part.from[0] as f32, part.to[0] as f32) as u32
        })
    }

    /// Paints a part of it that is not empty.
    fn paint(&self, texture: &Texture, frame: &mut Frame, part: Part) {
        let [a, b, c] = &self.corners;
        let flat = a.uv == b.uv && a.uv == c.uv;
        let texel = texture.at(a.uv);
        let painted = |color: Channels, texel: Channels| -> Channels {
            std::array::from_fn(|i| color[i] * texel[i] / 255.0)
        };
        let [ca, cb, cc] = self
            .corners
            .map(|corner| corner.color.to_array().map(f32::from));
        if flat && ca == cb && ca == cc {
            let color = painted(ca, texel);
            for y in part.from[1]..part.to[1] {
                let [from, to] = self.columns(y, part);
                if from < to {
                    let run = Part {
                        from: [from, y],
                        to: [to, y + 1],
                    };
                    paint_evenly(frame.row(y, run), color);
                }
            }
            return;
        }
        let at = [a.pos, b.pos, c.pos];
        let uv = |corner: &Vertex| [corner.uv.x, corner.uv.y, 0.0, 0.0];
        let planes = (
            Plane::new(at, [ca, cb, cc]),
            Plane::new(at, [uv(a), uv(b), uv(c)]),
        );
        let (Some(colors), Some(places)) = planes else {
            return;
        };
        for y in part.from[1]..part.to[1] {
            let [from, to] = self.columns(y, part);
            if from >= to {
                continue;
            }
            let run = Part {
                from: [from, y],
                to: [to, y + 1],
            };
            for (x, pixel) in (from..).zip(frame.row(y, run)) {
                let middle = Pos2::new(x as f32 + 0.5, y as f32 + 0.5);
                let texel = if flat {
                    texel
                } else {
                    let [u, v, ..] = places.value(middle);
                    texture.at(Pos2::new(u, v))
                };
                *pixel = over(*pixel, painted(colors.value(middle), texel));
            }
        }
    }
}

/// A pixel with a premultiplied colour over it.
fn over(pixel: u32, color: Channels) -> u32 {
    if color[3] <= 0.0 && color.iter().all(|channel| *channel <= 0.0) {
        return pixel;
    }
    let through = 1.0 - color[3] / 255.0;
    let mut bytes = pixel.to_le_bytes();
    for (byte, channel) in bytes.iter_mut().zip(color) {
        // Out of range where the middle of a pixel lies on a side, by an error of rounding: the cast keeps it within.
        *byte = (f32::from(*byte) * through + channel + 0.5) as u8;
    }
    u32::from_le_bytes(bytes)
}

/// The same over a run of pixels.
fn paint_evenly(pixels: &mut [u32], color: Channels) {
    if color[3] >= 255.0 {
        pixels.fill(over(0, color));
        return;
    }
    // Pixels beside each other are mostly the same.
    let mut last = None;
    for pixel in pixels {
        let (before, after) = match last {
            Some(known) => known,
            None => (*pixel, over(*pixel, color)),
        };
        let after = if *pixel == before {
            after
        } else {
            over(*pixel, color)
        };
        last = Some((*pixel, after));
        *pixel = after;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use eframe::egui::{Rect, pos2};
    use eframe::epaint::ImageDelta;
    use eframe::epaint::textures::{TextureOptions, TexturesDelta};

    use crate::preview::painter::textures::Textures;

    const SIZE: [u32; 2] = [16, 12];

    /// A texture of two texels beside each other: white, and half of it.
    fn textures() -> Textures {
        let texels = vec![
            Color32::WHITE,
            Color32::from_rgba_premultiplied(0, 0, 0, 128),
        ];
        let image = eframe::egui::ColorImage::new([2, 1], texels);
        let delta = ImageDelta::full(image, TextureOptions::LINEAR);
        let mut deltas = TexturesDelta::default();
        deltas
            .set
            .entry(Default::default())
            .or_default()
            .push(delta);
        let mut textures = Textures::default();
        assert!(textures.update(&mut deltas));
        textures
    }

    fn painted(mesh: &Mesh, scale: f32) -> Frame {
        let mut frame = Frame {
            size: SIZE,
            pixels: vec![0; (SIZE[0] * SIZE[1]) as usize],
            fresh: Vec::new(),
        };
        let textures = textures();
        let texture = textures.get(Default::default()).unwrap();
        let clip = Part::whole(SIZE);
        Triangles::new(mesh, texture, clip, scale).paint(&mut frame, clip);
        frame
    }

    /// Corners at these places, in the first texel.
    fn mesh(corners: &[[f32; 2]], color: Color32) -> Mesh {
        let vertices = corners.iter().map(|[x, y]| Vertex {
            pos: pos2(*x, *y),
            uv: pos2(0.25, 0.5),
            color,
        });
        let mut mesh = Mesh::default();
        mesh.vertices.extend(vertices);
        mesh
    }

    #[test]
    fn a_pixel_is_painted_where_its_middle_lies_within_and_only_once() {
        // Two triangles that share a side; what both painted would be less than half through.
        let color = Color32::from_rgba_premultiplied(100, 0, 0, 128);
        let corners = [[1.2, 0.7], [13.6, 2.1], [11.3, 10.9], [2.9, 8.2]];
        let mut mesh = mesh(&corners, color);
        mesh.indices.extend([0, 1, 2, 0, 2, 3]);
        let frame = painted(&mesh, 1.0);
        let is_within = |x: f32, y: f32| {
            (0..4).all(|i| {
                let ([ax, ay], [bx, by]) = (corners[i], corners[(i + 1) % 4]);
                (bx - ax) * (y - ay) - (by - ay) * (x - ax) > 0.0
            })
        };
        let once = over(0, [100.0, 0.0, 0.0, 128.0]);
        for y in 0..SIZE[1] {
            for x in 0..SIZE[0] {
                let wanted = if is_within(x as f32 + 0.5, y as f32 + 0.5) {
                    once
                } else {
                    0
                };
                let found = frame.pixels[(y * SIZE[0] + x) as usize];
                assert_eq!(found, wanted, "({x}, {y})");
            }
        }
    }

    #[test]
    fn points_are_so_many_pixels() {
        let mut mesh = mesh(&[], Color32::WHITE);
        mesh.add_colored_rect(
            Rect::from_min_max(pos2(1.0, 2.0), pos2(4.0, 5.0)),
            Color32::RED,
        );
        for vertex in &mut mesh.vertices {
            vertex.uv = pos2(0.25, 0.5);
        }
        let frame = painted(&mesh, 2.0);
        let red = u32::from_le_bytes([255, 0, 0, 255]);
        let count = frame.pixels.iter().filter(|pixel| **pixel == red).count();
        assert_eq!(count, 6 * 6);
        assert_eq!(frame.pixels[4 * SIZE[0] as usize + 2], red);
    }

    #[test]
    fn colours_change_evenly_and_are_blended() {
        let mut mesh = mesh(
            &[[0.0, 0.0], [16.0, 0.0], [0.0, 12.0], [16.0, 12.0]],
            Color32::BLACK,
        );
        for (vertex, red) in mesh.vertices.iter_mut().zip([0, 160, 0, 160]) {
            vertex.color = Color32::from_rgb(red, 0, 0);
        }
        mesh.indices.extend([0, 1, 2, 1, 3, 2]);
        let frame = painted(&mesh, 1.0);
        for x in 0..16_u32 {
            // The middle of a column is half a column to the right.
            let red = 10 * x as u8 + 5;
            let wanted = u32::from_le_bytes([red, 0, 0, 255]);
            assert_eq!(frame.pixels[x as usize], wanted, "{x}");
            assert_eq!(frame.pixels[11 * 16 + x as usize], wanted, "{x}");
        }
        let white = u32::from_le_bytes([255; 4]);
        assert_eq!(
            over(white, [0.0, 0.0, 0.0, 127.5]),
            u32::from_le_bytes([128, 128, 128, 255])
        );
        assert_eq!(over(white, [0.0; 4]), white);
    }

    #[test]
    fn a_texture_is_sampled_between_its_texels() {
        let textures = textures();
        let texture = textures.get(Default::default()).unwrap();
        assert_eq!(texture.at(pos2(0.25, 0.5)), [255.0; 4]);
        assert_eq!(texture.at(pos2(0.75, 0.5)), [0.0, 0.0, 0.0, 128.0]);
        assert_eq!(texture.at(pos2(0.5, 0.5)), [127.5, 127.5, 127.5, 191.5]);
        // Beyond the edge it is as at the edge.
        assert_eq!(texture.at(pos2(-0.5, 2.0)), [255.0; 4]);
    }
}
