//! What decided each pixel, as a picture: `plumb render --verdicts`.

use crate::frame::{Band, DecidedBy};

/// The colour of what decided a pixel. Grey needed no second look; the brighter, the more it took.
pub fn color(by: DecidedBy) -> [u8; 3] {
    match by {
        DecidedBy::Gpu => [40, 40, 40],
        DecidedBy::Double => [40, 80, 110],
        DecidedBy::Single => [80, 80, 80],
        DecidedBy::Bounded => [60, 110, 200],
        DecidedBy::Pairs => [70, 180, 120],
        DecidedBy::Multiprecision => [240, 228, 66],
        DecidedBy::Exact => [240, 240, 240],
        DecidedBy::Presumed => [230, 30, 30],
    }
}

/// What decided a pixel, for people.
pub fn meaning(by: DecidedBy) -> &'static str {
    match by {
        DecidedBy::Gpu => "the GPU, which is sure",
        DecidedBy::Double => "the GPU in f64, which is sure",
        DecidedBy::Single => "f32 with error bounds, on the CPU",
        DecidedBy::Bounded => "f64 with error bounds",
        DecidedBy::Pairs => "two f64 for a number, with error bounds",
        DecidedBy::Multiprecision => "intervals of many bits",
        DecidedBy::Exact => "exact arithmetic: it lies on a border exactly",
        DecidedBy::Presumed => "nothing: so near a border that it is presumed to lie on it",
    }
}

/// The verdicts of a band, painted; none if the band has none.
pub fn paint(band: &Band) -> Option<Band> {
    let verdicts = band.verdicts.as_ref()?;
    Some(Band {
        rows: band.rows.clone(),
        rgb: verdicts.iter().flat_map(|by| color(*by)).collect(),
        values: None,
        verdicts: None,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_stage_has_a_colour_of_its_own() {
        let colors: std::collections::BTreeSet<_> = DecidedBy::ALL.into_iter().map(color).collect();
        assert_eq!(colors.len(), DecidedBy::ALL.len());
    }

    #[test]
    fn a_band_is_painted_pixel_by_pixel() {
        let mut band = Band {
            rows: 3..4,
            rgb: vec![9; 6],
            values: None,
            verdicts: None,
        };
        assert_eq!(paint(&band), None);
        band.verdicts = Some(vec![DecidedBy::Gpu, DecidedBy::Presumed]);
        let painted = paint(&band).unwrap();
        assert_eq!(painted.rows, 3..4);
        assert_eq!(
            painted.rgb,
            [color(DecidedBy::Gpu), color(DecidedBy::Presumed)].concat()
        );
    }
}
