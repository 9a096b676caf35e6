//! Tables of what is exactly known of a surface's indices along the columns and rows of pixels (docs/NUMERICS.md,
//! section 9): where floor(index) is a fact of a column or row, the shader takes it from here for the pixels' own rays.

use dashu_int::IBig;

use crate::prepare::index::{Index, indices};
use crate::prepare::{Prepared, Surface};
use crate::procedural::{self, Family};
use crate::real::Real;
use crate::real::rational::parity;
use crate::scene::Scene;
use crate::settings::Settings;

/// What `index_table` in `shaders/surface.wgsl` reads, in the order in which it stands there behind the objects.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Tables {
    /// For each object the place of its first entry, 0 for none; then the entries: of each object one for each column
    /// of the picture, then one for each row from the bottom. What the entries of a pixel's column and row say together
    /// is known at the pixel.
    ///
    /// Of tiles and blocks bit 2·i + 1 says that index i is known, and bit 2·i whether its floor, less the index's own
    /// parity, is odd. Of texels bits 15 and 31 say that column and row are known; they are in the bits below.
    pub words: Vec<u32>,
    /// Columns of the picture.
    pub columns: u32,
}

/// Most entries: a scene that has more surfaces than that would spend longer on them than they save.
const MOST: usize = 1 << 18;

/// Textures have tables up to this side.
const MOST_TEXELS: u32 = 0x7fff;

impl Tables {
    /// The tables of the planes that a primary ray can hit; none where pixels are not certified, or rays pass beside
    /// their middles.
    pub(super) fn new(scene: &Scene, prepared: &Prepared<impl Real>, settings: &Settings) -> Self {
        let mut tables = Self::default();
        if !settings.has_gpu_bounds() || settings.supersampling().is_some() {
            return tables;
        }
        let pixels = scene.camera.pixeldim;
        let room = pixels[0] as usize + pixels[1] as usize;
        for plane in &prepared.planes {
            let object = plane.object;
            if tables.words.len() + room > MOST + scene.objects.len() {
                continue;
            }
            let Some(entries) = entries(scene, object, &prepared.surfaces[object]) else {
                continue;
            };
            if tables.words.is_empty() {
                tables.words = vec![0; scene.objects.len()];
                tables.columns = pixels[0];
            }
            tables.words[object] = tables.words.len() as u32;
            tables.words.extend(entries);
        }
        tables
    }
}

/// The entries of a surface; None if nothing is known.
fn entries(scene: &Scene, object: usize, surface: &Surface<impl Real>) -> Option<Vec<u32>> {
    // For index number i, the bits that stand for its floor.
    let bits: &dyn Fn(usize, &IBig) -> u32 = match surface {
        Surface::Tiled(tiled) => &|i, floor| parity_bits(i, parity(floor) ^ tiled.index[i].parity),
        Surface::Pplane(pplane)
            if procedural::asks(Family::Pplane, pplane.shader, "pplane_odd(") =>
        {
            &|i, floor| parity_bits(i, parity(floor) ^ pplane.index[i].parity)
        }
        Surface::Textured(textured) if textured.size.iter().all(|s| *s <= MOST_TEXELS) => {
            &|i, floor| texel_bits(i, floor, textured.size[i], textured.repeats)
        }
        _ => return None,
    };
    let pixels = scene.camera.pixeldim;
    let mut words = vec![0; pixels[0] as usize + pixels[1] as usize];
    let mut known = false;
    let indices = indices(scene, &scene.objects[object]);
    let same = |i: usize| match surface {
        Surface::Tiled(tiled) => tiled.index[i].per_unit.to_f64() == 0.0,
        Surface::Pplane(pplane) => pplane.index[i].per_unit.to_f64() == 0.0,
        _ => false,
    };
    for (i, index) in (0..).zip(&indices) {
        // An index along a coordinate that all points of the plane share stands in the plane's record.
        let Some(index) = index.as_ref().filter(|_: &&Index| !same(i)) else {
            continue;
        };
        for (axis, first) in [(0, 0), (1, pixels[0] as usize)] {
            let floors = index.floors(axis, pixels[axis]);
            for (word, floor) in words[first..].iter_mut().zip(&floors) {
                if let Some(floor) = floor {
                    *word |= bits(i, floor);
                    known = true;
                }
            }
        }
    }
    known.then_some(words)
}

fn parity_bits(i: usize, odd: u32) -> u32 {
    (2 | odd) << (2 * i)
}

fn texel_bits(i: usize, floor: &IBig, size: u32, repeats: bool) -> u32 {
    let size = IBig::from(size);
    let place = if repeats {
        (floor % &size + &size) % &size
    } else {
        floor.clone().clamp(IBig::ZERO, size - IBig::ONE)
    };
    // It is below 2¹⁵.
    let place = u32::try_from(place).unwrap_or(0);
    (0x8000 | place) << (16 * i)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::load;
    use crate::settings::Precision;
    use crate::shader::pack::Packed;

    #[test]
    fn texels_are_repeated_or_clamped() {
        let place = |floor: IBig, repeats| {
            let bits = texel_bits(1, &floor, 5, repeats);
            assert_eq!(bits & 0x8000_ffff, 0x8000_0000);
            bits >> 16 & 0x7fff
        };
        let huge = IBig::ONE << 100;
        for (floor, repeated, clamped) in [
            (IBig::from(-6), 4, 0),
            (IBig::from(-5), 0, 0),
            (IBig::from(3), 3, 3),
            (IBig::from(5), 0, 4),
            // 2¹⁰⁰ = 4⁵⁰ = 1 modulo 5.
            (huge.clone(), 1, 4),
            (-huge, 4, 0),
        ] {
            assert_eq!(place(floor.clone(), true), repeated, "{floor}");
            assert_eq!(place(floor.clone(), false), clamped, "{floor}");
        }
    }

    fn scene() -> Scene {
        let path = concat!(env!("CARGO_MANIFEST_DIR"), "/scenes/hard/tied_lines.txt");
        load(path.as_ref()).unwrap()
    }

    #[test]
    fn only_rays_through_the_middles_of_pixels_have_tables() {
        let words = |settings: Settings| Packed::new(&scene(), &settings).tables.words.len();
        // Seven objects, each with 17 columns and 13 rows.
        assert_eq!(words(Settings::default()), 7 + 7 * 30);
        for samples in [4, 16] {
            let settings = Settings {
                samples,
                ..Settings::default()
            };
            assert_eq!(words(settings), 0);
        }
        let settings = Settings {
            precision: Precision::Fast,
            ..Settings::default()
        };
        assert_eq!(words(settings), 0);
    }

    #[test]
    fn tables_are_no_longer_than_allowed() {
        let mut scene = scene();
        scene.camera.pixeldim = [40_000, 30_000];
        let tables = Packed::new(&scene, &Settings::default()).tables;
        assert!(tables.words.len() <= 7 + MOST);
        let with = tables.words[..7].iter().filter(|first| **first != 0);
        assert_eq!(with.count(), MOST / 70_000);
        // If not even one table has room, there are none.
        scene.camera.pixeldim = [300_000, 2];
        assert_eq!(
            Packed::new(&scene, &Settings::default()).tables,
            Tables::default()
        );
    }
}
