//! Finished pixels on their way: what the tracers hand on, and what takes it.

use std::io;
use std::ops::Range;

/// Finished rows, on their way into a picture. Bands come from the top of the picture downwards, without gaps.
#[derive(Debug, Clone, PartialEq)]
pub struct Band {
    /// Which rows, counted from the bottom.
    pub rows: Range<u32>,
    /// Red, green, blue of every pixel, the band's top row first: 3 · width · rows bytes.
    pub rgb: Vec<u8>,
    /// The values before quantising (1.0 is byte 255), in the same order, if they were asked for.
    pub values: Option<Vec<[f32; 3]>>,
}

/// Takes finished bands; an error ends the rendering.
pub type Emit<'a> = dyn FnMut(&Band) -> io::Result<()> + Send + 'a;

/// Value and bytes of a pixel.
pub type Pixel = ([f32; 3], [u8; 3]);

/// A pixel that needs more rays than allowed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[error(
    "pixel ({x}, {y}) needs more than {max_rays} rays for one sample: mirrors and transparent surfaces multiply them; --max-rays allows more, --max-path fewer"
)]
pub struct PixelFault {
    /// Column, from the left.
    pub x: u32,
    /// Row, from the bottom.
    pub y: u32,
    /// How many were allowed.
    pub max_rays: u32,
}
