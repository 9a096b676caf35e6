//! Vectors over any [`Real`]; glam's are for f32 and f64 only.

use std::ops::{Add, Mul, Neg, Sub};

use super::Real;

/// Three numbers: a point, a direction, or a colour.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct V3<R> {
    /// First component, or red.
    pub x: R,
    /// Second component, or green.
    pub y: R,
    /// Third component, or blue.
    pub z: R,
}

impl<R: Real> V3<R> {
    /// The vector of three numbers.
    #[inline(always)]
    pub fn new(x: R, y: R, z: R) -> Self {
        Self { x, y, z }
    }

    /// The vector that glam's is, exactly.
    #[inline(always)]
    pub fn exact(v: glam::DVec3) -> Self {
        Self::new(R::exact(v.x), R::exact(v.y), R::exact(v.z))
    }

    /// The inner product.
    #[inline(always)]
    pub fn dot(self, other: Self) -> R {
        self.x * other.x + self.y * other.y + self.z * other.z
    }

    /// The outer product.
    #[inline(always)]
    pub fn cross(self, other: Self) -> Self {
        Self::new(
            self.y * other.z - self.z * other.y,
            self.z * other.x - self.x * other.z,
            self.x * other.y - self.y * other.x,
        )
    }

    /// The vector of unit length in the same direction; the vector is not zero.
    #[inline(always)]
    pub fn unit(self) -> Self {
        // One division: it is the dearest operation of a number that knows its error.
        self * (R::exact(1.0) / self.dot(self).sqrt())
    }

    /// The product by components: a colour through a filter.
    #[inline(always)]
    pub fn each(self, other: Self) -> Self {
        Self::new(self.x * other.x, self.y * other.y, self.z * other.z)
    }

    /// The component along an axis.
    #[inline(always)]
    pub fn axis(self, axis: usize) -> R {
        [self.x, self.y, self.z][axis]
    }

    /// The vector with one component replaced.
    #[inline(always)]
    pub fn with_axis(mut self, axis: usize, value: R) -> Self {
        *[&mut self.x, &mut self.y, &mut self.z][axis] = value;
        self
    }

    /// f64 values near the components.
    pub fn to_f64(self) -> glam::DVec3 {
        glam::DVec3::new(self.x.to_f64(), self.y.to_f64(), self.z.to_f64())
    }
}

impl<R: Real> Add for V3<R> {
    type Output = Self;
    #[inline(always)]
    fn add(self, o: Self) -> Self {
        Self::new(self.x + o.x, self.y + o.y, self.z + o.z)
    }
}

impl<R: Real> Sub for V3<R> {
    type Output = Self;
    #[inline(always)]
    fn sub(self, o: Self) -> Self {
        Self::new(self.x - o.x, self.y - o.y, self.z - o.z)
    }
}

impl<R: Real> Mul<R> for V3<R> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, k: R) -> Self {
        Self::new(self.x * k, self.y * k, self.z * k)
    }
}

impl<R: Real> Neg for V3<R> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        Self::new(-self.x, -self.y, -self.z)
    }
}
