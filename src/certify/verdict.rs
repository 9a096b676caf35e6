//! What decided each pixel, as a picture: `plumb render --verdicts`.

use crate::frame::{Band, Stage};

/// The colour of a stage. Grey is what needed no second look; the brighter, the more it took.
pub fn color(stage: Stage) -> [u8; 3] {
    match stage {
        Stage::Gpu => [40, 40, 40],
        Stage::Single => [80, 80, 80],
        Stage::Bounded => [60, 110, 200],
        Stage::Multiprecision => [240, 228, 66],
        Stage::Exact => [240, 240, 240],
        Stage::Presumed => [230, 30, 30],
    }
}

/// What a stage is, for people.
pub fn meaning(stage: Stage) -> &'static str {
    match stage {
        Stage::Gpu => "the GPU, which is sure",
        Stage::Single => "f32 with error bounds, on the CPU",
        Stage::Bounded => "f64 with error bounds",
        Stage::Multiprecision => "intervals of many bits",
        Stage::Exact => "exact arithmetic: it lies on a border exactly",
        Stage::Presumed => "nothing: so near a border that it is presumed to lie on it",
    }
}

/// The verdicts of a band, painted; none if the band has none.
pub fn paint(band: &Band) -> Option<Band> {
    let verdicts = band.verdicts.as_ref()?;
    Some(Band {
        rows: band.rows.clone(),
        rgb: verdicts.iter().flat_map(|stage| color(*stage)).collect(),
        values: None,
        verdicts: None,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_stage_has_a_colour_of_its_own() {
        let colors: std::collections::BTreeSet<_> = Stage::ALL.into_iter().map(color).collect();
        assert_eq!(colors.len(), Stage::ALL.len());
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
        band.verdicts = Some(vec![Stage::Gpu, Stage::Presumed]);
        let painted = paint(&band).unwrap();
        assert_eq!(painted.rows, 3..4);
        assert_eq!(
            painted.rgb,
            [color(Stage::Gpu), color(Stage::Presumed)].concat()
        );
    }
}
