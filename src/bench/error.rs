//! How far a way's picture is from the true one, and its distances from the true ones.

use serde::Serialize;

use super::statistics::{quantile, sorted};
use super::truth::{FirstObject, PixelHit};
use crate::image::{Comparison, Picture, SizesDiffer, compare};

/// How far a picture is from the true one.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct PictureError {
    /// Pixels that are wrong in some channel.
    pub wrong: u64,
    /// The same in percent of all.
    pub wrong_percent: f64,
    /// The largest difference of a channel: 0 to 255.
    pub worst: u8,
    /// Column, and row from the bottom, of that.
    pub worst_at: Option<[u32; 2]>,
    /// Root of the mean square of the differences of all channels, in bytes.
    pub rms: f64,
}

impl PictureError {
    /// Compares a picture with the true one.
    ///
    /// # Errors
    /// If their sizes differ.
    pub fn new(truth: &Picture, picture: &Picture) -> Result<Self, SizesDiffer> {
        let Comparison {
            different,
            percent,
            worst,
            rms,
            ..
        } = compare(truth, picture)?;
        Ok(Self {
            wrong: different,
            wrong_percent: percent,
            worst: worst.map_or(0, |worst| worst.difference),
            worst_at: worst.map(|worst| [worst.x, worst.y]),
            rms,
        })
    }
}

/// How far the distances t along primary rays are from the true ones, in units in the last place of f32 at the true t.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct TError {
    /// Half are as near as this.
    pub median: f64,
    /// Ninety-nine in a hundred are nearer than this.
    pub percentile_99: f64,
    /// None is farther.
    pub worst: f64,
    /// Pixels compared: they see the object that they should see.
    pub compared: u64,
    /// Pixels that see another object, or something instead of nothing or the other way round; they have no error of t.
    pub other_object: u64,
    /// Pixels left out: which object is seen takes more than f64 with bounds, or the GPU leaves them to the CPU.
    pub left_out: u64,
}

impl TError {
    /// Compares first hits with the true ones, of which each comes with how far its t may be off; both are of the same
    /// pixels, in the same order. That is added to the error, which is never more than said. None where not one is hit
    /// in both.
    #[must_use]
    pub fn new(truth: &[(PixelHit, f64)], hits: &[PixelHit]) -> Option<Self> {
        let mut errors = Vec::new();
        let mut other_object = 0;
        let mut left_out = 0;
        for ((truth, off), hit) in truth.iter().zip(hits) {
            match (truth.object, hit.object) {
                (FirstObject::Unsure, _) | (_, FirstObject::Unsure) => left_out += 1,
                (FirstObject::Nothing, FirstObject::Nothing) => {}
                (FirstObject::Object(a), FirstObject::Object(b)) if a == b => {
                    errors.push(((hit.t - truth.t).abs() + off) / ulp(truth.t));
                }
                _ => other_object += 1,
            }
        }
        let errors = sorted(errors);
        Some(Self {
            median: quantile(&errors, 0.5)?,
            percentile_99: quantile(&errors, 0.99)?,
            worst: quantile(&errors, 1.0)?,
            compared: errors.len() as u64,
            other_object,
            left_out,
        })
    }
}

/// The distance between the f32 around a number of that size, were there no largest and no smallest of them.
#[must_use]
pub fn ulp(t: f64) -> f64 {
    // The exponent's bits: t is neither 0 nor subnormal in f64.
    let exponent = (t.abs().to_bits() >> 52) as i32 - 1023;
    2f64.powi(exponent - 23)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn picture(rgb: &[u8]) -> Picture {
        Picture {
            width: 2,
            height: rgb.len() as u32 / 6,
            rgb: rgb.to_vec(),
        }
    }

    fn seen(object: u32, t: f64) -> PixelHit {
        PixelHit {
            object: FirstObject::Object(object),
            t,
        }
    }

    #[test]
    fn a_unit_in_the_last_place_is_that_of_f32() {
        for t in [1.0f32, 1.5, 1.999_999_9, 2.0, 3.3, 1e-20, 7e30] {
            let next = f64::from(f32::from_bits(t.to_bits() + 1));
            assert_eq!(ulp(f64::from(t)), next - f64::from(t), "{t}");
        }
    }

    #[test]
    fn pictures_with_known_differences() {
        let truth = picture(&[10, 20, 30, 40, 50, 60, 70, 80, 90, 100, 110, 120]);
        let same = PictureError::new(&truth, &truth).unwrap();
        assert_eq!((same.wrong, same.worst, same.rms), (0, 0, 0.0));
        let mut other = truth.clone();
        other.rgb[4] += 3;
        other.rgb[9] -= 4;
        let error = PictureError::new(&truth, &other).unwrap();
        assert_eq!((error.wrong, error.wrong_percent), (2, 50.0));
        assert_eq!((error.worst, error.worst_at), (4, Some([1, 0])));
        assert_eq!(error.rms, (25.0f64 / 12.0).sqrt());
        assert!(PictureError::new(&truth, &picture(&[0; 6])).is_err());
    }

    #[test]
    fn distances_with_known_errors() {
        let step = 2f64.powi(-23);
        let nothing = PixelHit {
            object: FirstObject::Nothing,
            t: 0.0,
        };
        let unsure = PixelHit {
            object: FirstObject::Unsure,
            t: 0.0,
        };
        let truth = [
            seen(0, 1.0),
            seen(0, 1.0),
            seen(1, 2.0),
            nothing,
            nothing,
            unsure,
            seen(2, 4.0),
        ];
        let hits = [
            seen(0, 1.0 + step),
            seen(0, 1.0 - 3.0 * step),
            seen(1, 2.0 + 4.0 * step),
            nothing,
            seen(1, 1.0),
            seen(1, 1.0),
            seen(0, 4.0),
        ];
        let truth = truth.map(|seen| (seen, 0.0));
        let error = TError::new(&truth, &hits).unwrap();
        assert_eq!(
            (error.compared, error.other_object, error.left_out),
            (3, 2, 1)
        );
        assert_eq!((error.median, error.worst), (2.0, 3.0));
        assert!(error.percentile_99 > 2.9 && error.percentile_99 < 3.0);
        assert_eq!(TError::new(&truth[3..4], &hits[3..4]), None);
        // What is not known of the truth counts as error.
        let unsure = truth.map(|(seen, _)| (seen, step));
        assert_eq!(TError::new(&unsure, &hits).unwrap().worst, 4.0);
    }
}
