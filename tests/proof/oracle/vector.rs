//! Points and directions in exact reals: what `hits` and `trace` compute with.

use std::ops::{Add, Sub};

use glam::DVec3;

use super::real::Real;

/// A point, a direction or a colour.
#[derive(Debug, Clone)]
pub(crate) struct Vector(pub(crate) [Real; 3]);

impl Vector {
    /// Exactly the three f64.
    pub(crate) fn from_f64(v: DVec3) -> Self {
        Self(v.to_array().map(Real::from_f64))
    }

    pub(crate) fn all(number: i64) -> Self {
        let number = Real::integer(number);
        Self([number.clone(), number.clone(), number])
    }

    pub(crate) fn dot(&self, other: &Self) -> Real {
        let [x, y, z] = self.times(other).0;
        &(&x + &y) + &z
    }

    pub(crate) fn cross(&self, other: &Self) -> Self {
        let ([a, b, c], [x, y, z]) = (&self.0, &other.0);
        Self([
            &(b * z) - &(c * y),
            &(c * x) - &(a * z),
            &(a * y) - &(b * x),
        ])
    }

    pub(crate) fn scale(&self, factor: &Real) -> Self {
        Self([0, 1, 2].map(|i| factor * &self.0[i]))
    }

    /// Coordinate by coordinate.
    pub(crate) fn times(&self, other: &Self) -> Self {
        Self([0, 1, 2].map(|i| &self.0[i] * &other.0[i]))
    }

    /// With its rational coordinates known outright.
    pub(crate) fn settled(self) -> Self {
        Self(self.0.map(Real::settled))
    }
}

impl Add for &Vector {
    type Output = Vector;
    fn add(self, other: Self) -> Vector {
        Vector([0, 1, 2].map(|i| &self.0[i] + &other.0[i]))
    }
}

impl Sub for &Vector {
    type Output = Vector;
    fn sub(self, other: Self) -> Vector {
        Vector([0, 1, 2].map(|i| &self.0[i] - &other.0[i]))
    }
}
