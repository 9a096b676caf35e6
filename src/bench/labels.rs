//! Where the labels of a plot's points stand, so that none covers another.

/// Half the height of a line of text.
pub(super) const LINE: f64 = 7.0;
/// About the width of a character.
const LETTER: f64 = 6.4;

/// About the width of a text.
pub(super) fn text_width(text: &str) -> f64 {
    LETTER * text.chars().count() as f64
}

/// Where the labels of points stand (left, top, right, bottom): the first place around its point where a label covers
/// neither another one nor a marker, or else one that covers no label.
///
/// `sizes` are half those of the markers.
pub(super) fn labels(
    texts: &[String],
    places: &[(f64, f64)],
    sizes: &[f64],
    frame: [f64; 4],
) -> Vec<[f64; 4]> {
    let mark = |((x, y), size): (&(f64, f64), &f64)| {
        let half = size + 1.0;
        [x - half, y - half, x + half, y + half]
    };
    let marks: Vec<[f64; 4]> = places.iter().zip(sizes).map(mark).collect();
    let overlap =
        |a: &[f64; 4], b: &[f64; 4]| a[0] < b[2] && b[0] < a[2] && a[1] < b[3] && b[1] < a[3];
    let mut taken: Vec<[f64; 4]> = Vec::new();
    for ((text, &(x, y)), size) in texts.iter().zip(places).zip(sizes) {
        let width = text_width(text) + 4.0;
        let label = |dx: f64, dy: f64| {
            // Kept inside the panel, where there is room for it.
            let left = (x + dx).min(frame[2] - width - 1.0).max(frame[0] + 1.0);
            let top = (y + dy - LINE)
                .min(frame[3] - 2.0 * LINE)
                .max(frame[1] + 1.0);
            [left, top, left + width, top + 2.0 * LINE]
        };
        let around = (0..40).flat_map(|ring| {
            let far = f64::from(ring) * 2.0 * LINE;
            // Beside the point and a line up or down: whiskers and the front run level with it.
            let (right, left) = (*size, -size - width);
            let near = LINE + 4.0 + far;
            [
                (right, -near),
                (right, near),
                (left, -near),
                (left, near),
                (-width / 2.0, -near - size),
                (-width / 2.0, near + size),
            ]
        });
        let candidates: Vec<[f64; 4]> = around.map(|(dx, dy)| label(dx, dy)).collect();
        let free = |label: &&[f64; 4]| !taken.iter().any(|other| overlap(label, other));
        let is_free =
            |label: &&[f64; 4]| free(label) && !marks.iter().any(|mark| overlap(label, mark));
        let chosen = candidates
            .iter()
            .find(is_free)
            .or_else(|| candidates.iter().find(free))
            .unwrap_or(&candidates[0]);
        taken.push(*chosen);
    }
    taken
}

#[cfg(test)]
mod tests {
    use super::super::markers::MARK;
    use super::super::ways::Way;
    use super::*;

    #[test]
    fn labels_do_not_overlap_even_where_points_coincide() {
        let frame = [0.0, 0.0, 400.0, 300.0];
        let texts: Vec<String> = Way::ALL
            .map(|way| format!("{}, 12.3 ms", way.name()))
            .into();
        for places in [
            [(200.0, 150.0); 6],
            [(0.0, 300.0); 6],
            [(399.0, 1.0); 6],
            [
                (200.0, 280.0),
                (204.0, 280.0),
                (208.0, 280.0),
                (390.0, 280.0),
                (10.0, 280.0),
                (11.0, 20.0),
            ],
        ] {
            let labels = labels(&texts, &places, &[MARK; 6], frame);
            for (i, a) in labels.iter().enumerate() {
                assert!(
                    a[0] >= 0.0 && a[2] <= 400.0 && a[1] >= 0.0 && a[3] <= 300.0,
                    "{a:?}"
                );
                for b in &labels[..i] {
                    let apart = a[0] >= b[2] || b[0] >= a[2] || a[1] >= b[3] || b[1] >= a[3];
                    assert!(apart, "{a:?} {b:?}");
                }
            }
        }
    }
}
