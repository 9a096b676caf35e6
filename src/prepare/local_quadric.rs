//! A quadric's equation about a point next to it, which f32 has exactly: what `shaders/quadric.wgsl` starts from.

use super::quadric::Moved;
use crate::real::Real;
use crate::real::rational::{Ratio, dot, is_zero, power_of_two, ratio};
use crate::scene::{Scene, Shape};

/// The equation about a point near the surface, for f32: p·Ap + 2·slope·p + constant, p from that point. Matrices are
/// symmetric: their diagonal, then yz, xz, xy.
#[derive(Debug, Clone)]
pub struct Local<R> {
    /// The point, from the viewpoint in units of 2^scale.
    pub center: [f32; 3],
    /// A.
    pub square: [R; 6],
    /// The adjoint of A.
    pub adjoint: [R; 6],
    /// Half the gradient at the point.
    pub slope: [R; 3],
    /// The left side there.
    pub constant: R,
}

/// The equation of a curved quadric about its center; about a point of its axis or near its vertex where it has none.
pub fn local<R: Real>(scene: &Scene, scale: i32, object: usize) -> Local<R> {
    let coefficients = match &scene.objects[object].shape {
        Shape::Quadric(quadric) => &quadric.coefficients,
        _ => &[0.0; 10],
    };
    let moved = Moved::new(&scene.camera, scale, coefficients);
    let half = ratio(0.5);
    let [a, b, c, d, e, f] = &moved.square;
    let matrix = [
        a.clone(),
        b.clone(),
        c.clone(),
        f * &half,
        e * &half,
        d * &half,
    ];
    let slope = moved.slope.each_ref().map(|c| c * &half);
    let exact = Symmetric(matrix);
    let adjoint = exact.adjoint();
    // Any point near it will do, as all that follows is exact.
    let center = exact.center(&adjoint, &slope);
    let center = center.map(|c| c.to_f64().value() as f32);
    let center = if center.iter().all(|c| c.is_finite()) {
        center
    } else {
        [0.0; 3]
    };
    let center = vertex(&exact, &slope, &moved.constant, center);
    let at = center.map(|c| ratio(f64::from(c)));
    let turned = exact.times(&at);
    let local_slope = [0, 1, 2].map(|i| &turned[i] + &slope[i]);
    let both = [0, 1, 2].map(|i| &local_slope[i] + &slope[i]);
    let constant = dot(&at, &both) + &moved.constant;
    Local {
        center,
        square: exact.0.each_ref().map(R::ratio),
        adjoint: adjoint.0.each_ref().map(R::ratio),
        slope: local_slope.each_ref().map(R::ratio),
        constant: R::ratio(&constant),
    }
}

/// A symmetric matrix: its diagonal, then yz, xz, xy.
struct Symmetric([Ratio; 6]);

impl Symmetric {
    fn times(&self, v: &[Ratio; 3]) -> [Ratio; 3] {
        let [a, b, c, yz, xz, xy] = &self.0;
        [
            a * &v[0] + xy * &v[1] + xz * &v[2],
            xy * &v[0] + b * &v[1] + yz * &v[2],
            xz * &v[0] + yz * &v[1] + c * &v[2],
        ]
    }

    fn adjoint(&self) -> Self {
        let [a, b, c, yz, xz, xy] = &self.0;
        Self([
            b * c - yz * yz,
            a * c - xz * xz,
            a * b - xy * xy,
            xz * xy - a * yz,
            xy * yz - b * xz,
            xz * yz - c * xy,
        ])
    }

    fn determinant(&self, adjoint: &Self) -> Ratio {
        &self.0[0] * &adjoint.0[0] + &self.0[5] * &adjoint.0[5] + &self.0[4] * &adjoint.0[4]
    }

    /// Where the gradient, of which `slope` is half at 0, is 0; or as small as it gets, near 0.
    fn center(&self, adjoint: &Self, slope: &[Ratio; 3]) -> [Ratio; 3] {
        let determinant = self.determinant(adjoint);
        if !is_zero(&determinant) {
            return adjoint.times(slope).map(|c| -c / &determinant);
        }
        // (A·A + λ)⁻¹·(−A·slope) with a tiny λ.
        let rows = [0, 1, 2].map(|i| {
            let axis = [0, 1, 2].map(|j| ratio(if i == j { 1.0 } else { 0.0 }));
            self.times(&self.times(&axis))
        });
        let tiny = power_of_two(-80);
        let square = Self([
            &rows[0][0] + &tiny,
            &rows[1][1] + &tiny,
            &rows[2][2] + &tiny,
            rows[1][2].clone(),
            rows[0][2].clone(),
            rows[0][1].clone(),
        ]);
        let adjoint = square.adjoint();
        let determinant = square.determinant(&adjoint);
        let aim = self.times(slope);
        adjoint.times(&aim).map(|c| -c / &determinant)
    }
}

/// A point where a gradient is left, moved along it to the surface: a paraboloid's vertex.
fn vertex(square: &Symmetric, slope: &[Ratio; 3], constant: &Ratio, center: [f32; 3]) -> [f32; 3] {
    let at = center.map(|c| ratio(f64::from(c)));
    let turned = square.times(&at);
    let gradient = [0, 1, 2].map(|i| &turned[i] + &slope[i]);
    let steep = dot(&gradient, &gradient);
    if steep < power_of_two(-20) {
        return center;
    }
    let both = [0, 1, 2].map(|i| &gradient[i] + &slope[i]);
    let left = dot(&at, &both) + constant;
    let step = left / (ratio(2.0) * steep);
    [0, 1, 2].map(|i| (&at[i] - &gradient[i] * &step).to_f64().value() as f32)
}
