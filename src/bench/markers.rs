//! The markers of a plot's points, one for each way: told apart by shape and fill, so that black and white will do, and
//! one inside the other where points are in one place.
//!
//! Below `plot`, on `svg`; `labels` keeps clear of them.

use super::svg::Svg;
use super::ways::Way;

/// Half a marker.
pub(super) const MARK: f64 = 5.0;
/// How much larger half of one is that stands around another.
const NEST: f64 = 4.5;

/// Half the size of each marker: those that would hide each other stand one inside the other.
pub(super) fn nested(places: &[(f64, f64)]) -> Vec<f64> {
    let mut sizes: Vec<f64> = Vec::new();
    for (i, (x, y)) in places.iter().enumerate() {
        let hides = |&j: &usize| {
            let (other_x, other_y) = places[j];
            let near = 2.0 * MARK;
            (x - other_x).abs() < near && (y - other_y).abs() < near
        };
        let around = (0..i).filter(hides).map(|j| sizes[j]).fold(0.0, f64::max);
        sizes.push(if around > 0.0 { around + NEST } else { MARK });
    }
    sizes
}

/// A way's marker, with a white edge that tells it from what is behind it.
pub(super) fn mark(svg: &mut Svg, way: Way, place: (f64, f64), size: f64) {
    let white = "fill='white' stroke='white' stroke-width='4.4'";
    shape(svg, way, place, size, [white; 2]);
    let (black, white) = (
        "fill='black' stroke='black' stroke-width='1.4'",
        "fill='white' stroke='black' stroke-width='1.4'",
    );
    shape(svg, way, place, size, [black, white]);
}

/// A way's marker, filled as the first of two if it is a full one.
fn shape(svg: &mut Svg, way: Way, (x, y): (f64, f64), m: f64, [black, white]: [&str; 2]) {
    let square = [x - m, y - m, 2.0 * m, 2.0 * m];
    let circle = format!(
        "M{:.1},{y:.1} a{m},{m} 0 1 0 {:.1},0 a{m},{m} 0 1 0 {:.1},0 z",
        x - m,
        2.0 * m,
        -2.0 * m
    );
    match way {
        Way::GpuCertified => svg.rectangle(square, black),
        Way::GpuFast => svg.rectangle(square, white),
        Way::CpuCertified => svg.path(&circle, black),
        Way::CpuPlain => svg.path(&circle, white),
        Way::F32Quadratic => {
            let triangle = format!(
                "M{x:.1},{:.1} l{m:.1},{:.1} h{:.1} z",
                y - 1.2 * m,
                2.2 * m,
                -2.0 * m
            );
            svg.path(&triangle, white);
        }
        Way::F32Naive => {
            let (a, b, c, d) = (x - m, x + m, y - m, y + m);
            let cross = format!("M{a:.1},{c:.1} L{b:.1},{d:.1} M{a:.1},{d:.1} L{b:.1},{c:.1}");
            svg.path(&cross, white);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn points_in_one_place_are_told_apart() {
        let sizes = nested(&[(10.0, 10.0), (90.0, 10.0), (12.0, 8.0), (10.0, 10.0)]);
        assert_eq!(sizes, [MARK, MARK, MARK + NEST, MARK + 2.0 * NEST]);
    }
}
