//! f64 as a [`Real`]: the reference for the GPU's f32, and the fallback where there is no GPU.

use std::cmp::Ordering;

use dashu_ratio::Relaxed as Ratio;

use super::{Real, Undecided};

impl Real for f64 {
    #[inline]
    fn exact(value: f64) -> Self {
        value
    }

    fn ratio(value: &Ratio) -> Self {
        value.to_f64().value()
    }

    #[inline]
    fn sqrt(self) -> Self {
        Self::sqrt(self)
    }

    #[inline]
    fn pow(self, exponent: f64) -> Self {
        self.powf(exponent)
    }

    fn cos_degrees(angle: f64) -> Self {
        // The angles whose cosines are rational have them exactly.
        match angle {
            60.0 => 0.5,
            90.0 => 0.0,
            120.0 => -0.5,
            180.0 => -1.0,
            _ => angle.to_radians().cos(),
        }
    }

    #[inline]
    fn sign(self) -> Result<Ordering, Undecided> {
        self.partial_cmp(&0.0).ok_or(Undecided)
    }

    #[inline]
    fn floor(self) -> Result<f64, Undecided> {
        Ok(Self::floor(self))
    }

    #[inline]
    fn approx(self) -> f64 {
        self
    }
}
