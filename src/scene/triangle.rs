//! What the vertices of a triangle have to keep, decided exactly: they are no line, and the normal that is given beside
//! them is not in their plane.
//!
//! The `table` asks; `prepare` takes the normal from here too.

use crate::real::rational::{Ratio, cross, dot, is_zero, ratio, sub};

/// (v2 − v1) × (v3 − v1), exactly.
pub(crate) fn normal(vertices: &[[f64; 3]; 3]) -> [Ratio; 3] {
    let [v1, v2, v3] = vertices.map(|vertex| vertex.map(ratio));
    cross(&sub(&v2, &v1), &sub(&v3, &v1))
}

/// Do the vertices lie in a line?
pub(super) fn in_line(vertices: &[[f64; 3]; 3]) -> bool {
    !is_surely_wide(vertices) && normal(vertices).iter().all(is_zero)
}

/// Does a direction lie in the plane of the vertices?
pub(super) fn is_in_plane(direction: &[f64; 3], vertices: &[[f64; 3]; 3]) -> bool {
    is_zero(&dot(&direction.map(ratio), &normal(vertices)))
}

/// Whether f64 is enough to tell that a component of the normal is not 0: there may be a million triangles.
///
/// Differences have a relative error of u = 2⁻⁵³, products one of 3u and 4u², and what is subtracted last another u, so
/// 8u times the sum of the products' sizes bounds the error where nothing is subnormal or infinite.
fn is_surely_wide(vertices: &[[f64; 3]; 3]) -> bool {
    let [v1, v2, v3] = vertices;
    let side = |v: &[f64; 3]| [v[0] - v1[0], v[1] - v1[1], v[2] - v1[2]];
    let (a, b) = (side(v2), side(v3));
    [(0, 1), (1, 2), (2, 0)].into_iter().any(|(i, j)| {
        let (left, right) = (a[i] * b[j], a[j] * b[i]);
        let (difference, sum) = ((left - right).abs(), left.abs() + right.abs());
        (1e-280..1e280).contains(&sum) && difference > 4.0 * f64::EPSILON * sum
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_are_told_exactly() {
        assert!(in_line(&[[0.0; 3], [1.0, 1.0, 1.0], [3.0, 3.0, 3.0]]));
        assert!(in_line(&[[0.0; 3], [0.0; 3], [3.0, 1.0, 2.0]]));
        // 0.1 and 0.3 are not in a line with 0.7 and 2.1, but nearly.
        let nearly = [[0.0; 3], [0.1, 0.3, 0.0], [0.7, 2.1, 0.0]];
        assert!(!in_line(&nearly) && !is_surely_wide(&nearly));
        assert!(in_line(&[
            [0.0; 3],
            [0.125, 0.375, 0.0],
            [0.875, 2.625, 0.0]
        ]));
        let tiny = 5e-324;
        assert!(!in_line(&[[0.0; 3], [tiny, 0.0, 0.0], [0.0, tiny, 0.0]]));
        let huge = f64::MAX;
        assert!(!in_line(&[[-huge; 3], [huge, 0.0, 0.0], [0.0, huge, 0.0]]));
        assert!(is_surely_wide(&[
            [0.0; 3],
            [1.0, 0.0, 0.0],
            [0.0, 1.0, 0.0]
        ]));
    }

    #[test]
    fn a_direction_in_the_plane_is_no_side() {
        let vertices = [[0.0, 1.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, -1.0]];
        assert!(is_in_plane(&[3.0, 0.0, 0.1], &vertices));
        assert!(!is_in_plane(&[3.0, 1e-300, 0.1], &vertices));
    }
}
