//! The colours of eight hits: `ray_trace`, `tplane_foreground` and `camera_setpix` of the shaders.

use super::{Closest, Constants, Eight, LANES, Lane, Lanes};
use crate::shader::kind::SurfaceKind;
use crate::shader::records::TiledPlane;

impl Lanes {
    /// The colours of the closest hits: `ray_trace` and `camera_setpix`.
    pub(super) fn shade(&self, at: &(Lane, f32), closest: &Closest) -> Eight {
        let packed = &self.packed;
        let camera = &packed.camera.numbers;
        let wy = at.1 * camera.step[1] + camera.offset[1];
        let rest = wy * wy + camera.distance * camera.distance;
        let mut rays = Rays {
            wx: [0.0; LANES],
            wy,
            w2: [0.0; LANES],
            inverse_length: [0.0; LANES],
        };
        // Hits that the color depends on must be known to the first order where it is modulated.
        let coarse = if self.modulated {
            self.constants.first_order
        } else {
            0.0
        };
        let (mut dark, mut sure) = ([false; LANES], [false; LANES]);
        let (mut value, mut value_error) = ([0.0; LANES], [0.0; LANES]);
        for i in 0..LANES {
            rays.wx[i] = at.0[i] * camera.step[0] + camera.offset[0];
            rays.w2[i] = rays.wx[i] * rays.wx[i] + rest;
            rays.inverse_length[i] = 1.0 / rays.w2[i].sqrt();
            let (inverse, error, rival) = (closest.inverse[i], closest.error[i], closest.rival[i]);
            let most = if inverse + error > rival {
                inverse + error
            } else {
                rival
            };
            dark[i] = most * rays.inverse_length[i] < packed.dark;
            sure[i] = (inverse - rival > error) & (inverse > coarse * error);
            let share = camera.gain * rays.inverse_length[i];
            value[i] = share * inverse;
            value_error[i] = share
                * (self.constants.second_order * error + self.constants.value_error * inverse);
        }
        let mut ambient = [[0.0; LANES]; 3];
        let mut tiles: Option<(u32, TileHits)> = None;
        for i in 0..LANES {
            let number = closest.object[i];
            let object = &packed.objects[number as usize];
            let mut color = &object.ambient;
            if object.kind & 255 == SurfaceKind::Tiled.code() {
                let plane = &packed.tiled_planes[(object.kind >> 8) as usize];
                let known = tiles.take().filter(|(of, _)| *of == number);
                let (_, here) = tiles
                    .insert(known.unwrap_or_else(|| (number, self.tiles(plane, &rays, closest))));
                sure[i] &= here.certain[i];
                if here.odd[i] {
                    color = &plane.altmaterial;
                }
            } else if object.kind != 0 {
                sure[i] = false;
            }
            for (ambient, color) in ambient.iter_mut().zip(color) {
                ambient[i] = *color;
            }
        }
        let mut bytes = [[0_u8; LANES]; 3];
        for (bytes, ambient) in bytes.iter_mut().zip(&ambient) {
            for i in 0..LANES {
                let (color, error) = (ambient[i] * value[i], ambient[i] * value_error[i]);
                let above = if color > 0.5 { color } else { 0.5 };
                let within = if above < 255.5 { above } else { 255.5 };
                let nearest = (within + WHOLE) - WHOLE;
                let beside = within - nearest;
                sure[i] &= (beside.abs() > error) | (color - error > 255.5);
                let below = if beside < 0.0 { nearest - 1.0 } else { nearest };
                let byte = if below < 255.0 { below } else { 255.0 };
                bytes[i] = (byte + WHOLE).to_bits() as u8;
            }
        }
        let [red, green, blue] = bytes;
        let mut eight = Eight::default();
        for i in 0..LANES {
            eight.sure[i] = sure[i] | dark[i];
            if !dark[i] {
                eight.bytes[i] = [red[i], green[i], blue[i]];
            }
        }
        eight
    }

    /// Which tiles the rays hit that meet a tiled plane: `locate` and `tplane_foreground`.
    fn tiles(&self, plane: &TiledPlane, rays: &Rays, closest: &Closest) -> TileHits {
        let Constants {
            u,
            index_roundings,
            second_order,
            hit_roundings,
            ..
        } = self.constants;
        let camera = &self.packed.camera;
        let rows = [
            (&plane.row_0, plane.fraction_0),
            (&plane.row_1, plane.fraction_1),
        ];
        let mut tiles = TileHits {
            certain: [true; LANES],
            odd: [false; LANES],
        };
        for i in 0..LANES {
            let s = 1.0 / closest.inverse[i];
            let [x, y, z] = [rays.wx[i] * s, rays.wy * s, -camera.numbers.distance * s];
            let length = rays.w2[i] * rays.inverse_length[i];
            let error = second_order
                * s
                * (camera.w_error + length * (s * closest.error[i] + hit_roundings * u));
            let error = error + index_roundings * u * (x.abs() + y.abs() + z.abs());
            let mut sum = plane.parity;
            for (axis, (row, fraction)) in rows.into_iter().enumerate() {
                let index = row[0] * x + row[1] * y + row[2] * z + fraction;
                let nearest = (index + WHOLE) - WHOLE;
                let beside = index - nearest;
                // A NaN fails this comparison, and so is not certain.
                let small = index.abs() < 4_194_304.0;
                tiles.certain[i] &=
                    small & (beside.abs() > plane.row_lengths[axis] * error + plane.errors[axis]);
                sum += if beside < 0.0 { nearest - 1.0 } else { nearest };
            }
            tiles.odd[i] = (sum + WHOLE).to_bits() & 1 == 1;
        }
        tiles
    }
}

/// What is added to a number from −2²² to 2²² and taken away again to leave the nearest whole number. In between that
/// number stands in the lowest bits.
const WHOLE: f32 = 12_582_912.0;

/// The rays of the lanes.
struct Rays {
    wx: Lane,
    wy: f32,
    w2: Lane,
    inverse_length: Lane,
}

/// Which tiles the lanes' rays hit.
struct TileHits {
    /// Whether that is certain.
    certain: [bool; LANES],
    /// Whether their indices add up to an odd number.
    odd: [bool; LANES],
}
