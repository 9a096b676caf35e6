//! f64 as a [`Real`]: what people read, and what a pixel is presumed to be that no other number type decides.

use std::cmp::Ordering;

use super::rational::Ratio;
use super::{Bounded, Real, Undecided};

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

    fn versine_degrees(angle: f64) -> Option<Self> {
        // Below a degree the cosine loses digits against 1.
        (angle < 1.0).then(|| 2.0 * (0.5 * angle.to_radians()).sin().powi(2))
    }

    #[inline]
    fn sign(self) -> Result<Ordering, Undecided> {
        self.partial_cmp(&0.0).ok_or(Undecided)
    }

    #[inline]
    fn floor(self) -> Result<f64, Undecided> {
        Ok(whole_below(self))
    }

    fn up_to(self, _: f64) -> Option<Self> {
        Some(self)
    }

    #[inline]
    fn to_f64(self) -> f64 {
        self
    }

    fn nearest_f32(self) -> Result<f32, Undecided> {
        Ok(self as f32)
    }

    #[inline]
    fn byte(self) -> Result<u8, Undecided> {
        // The conversion clamps and truncates.
        Ok((255.0 * self) as u8)
    }
}

/// The floor, without the library call that a processor of 2003 takes for it.
#[inline(always)]
pub(super) fn whole_below(value: f64) -> f64 {
    let whole = value as i64 as f64;
    if value.abs() < (1_u64 << 52) as f64 {
        whole - f64::from(u8::from(whole > value))
    } else {
        value
    }
}

/// The f32 nearest to a number, of two the even one, where its enclosure need not tell: next to the middle between two
/// of them its side of the middle decides.
pub(super) fn nearest_f32_by_middle<R: Real>(
    number: R,
    enclosure: Bounded,
) -> Result<f32, Undecided> {
    if let Ok(value) = enclosure.nearest_f32() {
        return Ok(value);
    }
    let margin = enclosure.error * Bounded::GROW;
    let (low, high) = (
        (enclosure.value - margin).next_down() as f32,
        (enclosure.value + margin).next_up() as f32,
    );
    let (low, high) = if low < high {
        (low, high)
    } else {
        (low.next_down(), low)
    };
    if low <= 0.0 && high >= 0.0 && number.sign()? == Ordering::Equal {
        // Around 0 there are as many f32 as elsewhere in all.
        return Ok(0.0);
    }
    if high != low.next_up() {
        return Err(Undecided);
    }
    let middle = middle(low, high);
    Ok(match (number - R::exact(middle)).sign()? {
        Ordering::Less => low,
        Ordering::Greater => high,
        Ordering::Equal => middle as f32,
    })
}

/// The number halfway between two neighbouring f32, the second of which may be infinite.
fn middle(low: f32, high: f32) -> f64 {
    // Where f32 ends, the next step is as wide as the last.
    let wide = |x: f32| {
        if x.is_infinite() {
            2_f64.powi(128).copysign(f64::from(x))
        } else {
            f64::from(x)
        }
    };
    0.5 * (wide(low) + wide(high))
}
