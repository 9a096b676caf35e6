//! What is to be drawn of a picture, whoever draws it: [`screen`](super::screen) where the window is drawn by a GPU,
//! [`painter`](super::painter) where the host draws it.

use std::sync::Arc;

use super::viewport::Placed;
use crate::certify::verdict;
use crate::frame::DecidedBy;

/// The pixels of a picture on the host, rows from the top.
#[derive(Debug)]
pub(super) struct Pixels {
    /// Columns and rows.
    pub(super) size: [u32; 2],
    /// Their bytes.
    pub(super) rgb: Vec<u8>,
    /// What decided them.
    pub(super) verdicts: Vec<DecidedBy>,
}

/// What each pixel of a picture sees.
#[derive(Debug)]
pub(super) struct ObjectMap {
    /// Columns and rows.
    pub(super) size: [u32; 2],
    /// Numbers of objects, from 1; 0 is nothing. Rows from the top.
    pub(super) objects: Vec<u32>,
}

/// Objects to be outlined.
#[derive(Debug, Clone)]
pub(super) struct Outlined {
    /// What each pixel sees.
    pub(super) seen: Arc<ObjectMap>,
    /// A bit for each number of an object, from the lowest up.
    pub(super) chosen: Arc<Vec<u32>>,
}

/// Outlines have this colour.
pub(super) const OUTLINE: [u8; 3] = [255, 140, 0];
/// Half as wide as an outline, in pixels of the window.
pub(super) const BORDER: u32 = 2;

/// Where a picture is made smaller, the mean of so many of its pixels in a direction is taken at most for each of the
/// window's: of more, evenly spread ones stand for the others.
pub(super) const TAPS: u32 = 8;

/// A picture to be drawn.
#[derive(Debug, Clone)]
pub(super) struct Draw {
    /// The picture, perhaps of fewer pixels than it is drawn as.
    pub(super) pixels: Arc<Pixels>,
    /// As large as this.
    pub(super) size: [u32; 2],
    /// Where.
    pub(super) placed: Placed,
    /// Whether to paint what decided each pixel.
    pub(super) verdicts: bool,
    /// What to outline.
    pub(super) outlined: Option<Outlined>,
}

impl Draw {
    /// Whether it would look the same.
    pub(super) fn is_as(&self, other: &Self) -> bool {
        let outlined = match (&self.outlined, &other.outlined) {
            (None, None) => true,
            (Some(a), Some(b)) => {
                Arc::ptr_eq(&a.seen, &b.seen) && Arc::ptr_eq(&a.chosen, &b.chosen)
            }
            _ => false,
        };
        outlined
            && Arc::ptr_eq(&self.pixels, &other.pixels)
            && (self.size, self.placed, self.verdicts) == (other.size, other.placed, other.verdicts)
    }

    /// The part of the window that the picture covers: left, top, width, height.
    pub(super) fn covers(&self, window: [u32; 2]) -> [u32; 4] {
        let end = |i: usize| {
            let length = (f64::from(self.size[i]) * self.placed.zoom).ceil();
            (f64::from(self.placed.origin[i]) + length).clamp(0.0, f64::from(window[i])) as u32
        };
        let start = |i: usize| (self.placed.origin[i].max(0) as u32).min(end(i));
        [start(0), start(1), end(0) - start(0), end(1) - start(1)]
    }
}

/// How a pixel looks that was decided by that, where verdicts are painted: so much of its bytes, and these on top.
/// Sure pixels step back; the others have the colour of what decided them, as `plumb render --verdicts` paints it.
pub(super) fn shown_as(by: DecidedBy) -> (f32, [f32; 3]) {
    let color = verdict::color(by).map(f32::from);
    match by {
        DecidedBy::Gpu | DecidedBy::Single => (0.3, color.map(|byte| 0.3 * byte)),
        _ => (0.0, color),
    }
}
