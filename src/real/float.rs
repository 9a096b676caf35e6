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
