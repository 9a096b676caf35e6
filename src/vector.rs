//! The notes' vector operations that glam lacks, on glam's f64 vectors. Beside the flow: the tracer works on its own
//! number types; this is the notes' library as they define it, for whoever uses plumb as one.
//!
//! Everything goes by value, so an operation may overwrite its own input: `v = project(n, v)`. A rotation's rows are
//! what becomes X, Y and Z: glam stores columns, so read them with [`DMat3::row`]; `matrix * v` and
//! `matrix.transpose()` are glam's.

use glam::{DMat3, DVec3};

/// The projection of `v` onto the plane with the unit normal `n`: P = V − (N·V)N.
pub fn project(n: DVec3, v: DVec3) -> DVec3 {
    v - n.dot(v) * n
}

/// The direction in which a ray that comes along `unitin` leaves a surface with the normal `unitnorm`, both of length
/// 1: V = 2N(U·N) − U, with U = −unitin.
pub fn reflect(unitin: DVec3, unitnorm: DVec3) -> DVec3 {
    let u = -unitin;
    2.0 * unitnorm * u.dot(unitnorm) - u
}

/// The rotation that takes `v` to X and `w` to Z; both of length 1, at a right angle.
pub fn rotation_of_axes(v: DVec3, w: DVec3) -> DMat3 {
    let y = w.cross(v);
    // What becomes X, Y, Z are the rows, and glam takes columns.
    DMat3::from_cols(v, y, w).transpose()
}

/// The rotation that takes `w` to the direction of Z, and `v` into the half of the Y–Z plane where y is positive; of
/// any length but 0. Parallel ones leave the rotation open: what comes back then is none.
pub fn rotation(v: DVec3, w: DVec3) -> DMat3 {
    let (v, w) = (v.normalize(), w.normalize());
    rotation_of_axes(v.cross(w).normalize(), w)
}
