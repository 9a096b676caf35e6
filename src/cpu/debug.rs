//! The notes' debugging output: for every pixel what its ray hit, and the colour on its way to the picture.
//!
//! Beside the data flow: `--debug` runs the reference tracer over the rows again and prints, it changes no picture.
//! The formats are those of the course notes, one part for each of their symbols `DBG_PIX`, `DBG_HIT`, `DBG_DRGB`,
//! `DBG_IRGB`, `DBG_OFFSET`, so that a listing can be laid beside one of a program written after the notes. Only
//! `DBG_PIX` begins a line, and nothing ends one, as there. Column comes before row (the notes' sample; their code has
//! it the other way round), and rows count from the bottom.
//!
//! `IRGB` are the bytes that the picture holds. The notes print what comes out of `scale_and_clamp` with no decimals
//! and leave open where the fraction goes; a listing that says 255 of a byte that is 254 would help nobody.

use std::io;
use std::ops::Range;

use glam::DVec3;

use super::hit_point::hit_point;
use super::pixel::ExactTracer;
use super::trace::{Fault, Limits, Unobserved, ray_trace};
use crate::frame::PixelFault;
use crate::jitter::Sampling;
use crate::prepare::Prepared;
use crate::scene::Scene;

/// Which parts are listed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Shown {
    /// A new line with column and row.
    pub pix: bool,
    /// The closest object and where it was hit.
    pub hit: bool,
    /// The closest object and the colour before it is scaled: 1 is full brightness.
    pub drgb: bool,
    /// The bytes.
    pub irgb: bool,
    /// The number of the pixel in the picture, counted from the top left.
    pub offset: bool,
}

/// Lists the pixels of `rows`, counted from the bottom: the bottom row first, columns from the left.
///
/// `prepared` is `scene` made ready; the scene has nothing in it that the tracer does not render.
///
/// # Errors
/// When `to` fails, or a pixel cannot be computed in f64.
pub fn list_pixels(
    scene: &Scene,
    prepared: &Prepared<f64>,
    exact_tracer: &ExactTracer<'_>,
    limits: &Limits,
    rows: Range<u32>,
    shown: Shown,
    to: &mut dyn io::Write,
) -> io::Result<()> {
    let [width, height] = scene.camera.pixeldim;
    for y in rows {
        for x in 0..width {
            let fault = |fault: Fault| match fault {
                Fault::Undecided => {
                    io::Error::other(format!("pixel ({x}, {y}) is out of f64's range"))
                }
                Fault::TooManyRays => io::Error::other(PixelFault {
                    x,
                    y,
                    max_rays: limits.max_rays,
                }),
            };
            let traced = ray_trace(
                prepared,
                limits,
                f64::from(x),
                f64::from(y),
                &mut Unobserved,
            )
            .map_err(fault)?;
            if shown.pix {
                write!(to, "\nPIX {x:4} {y:4} - ")?;
            }
            let Some(hit) = traced.hit else { continue };
            let name = &scene.objects[hit.object].name;
            if shown.hit {
                let point = hit_point(scene, prepared, &traced.ray, &hit);
                write!(to, "{name:<12} HIT:{}", triple(point, 1))?;
            }
            if shown.drgb {
                write!(to, "{name:<12} DRGB:{}", triple(traced.color.to_f64(), 2))?;
            }
            if shown.irgb {
                let decided = exact_tracer
                    .trace(limits, Sampling::Once, x, y)
                    .map_err(io::Error::other)?;
                let [r, g, b] = decided.bytes;
                write!(to, " IRGB:({r:5}, {g:5}, {b:5})")?;
            }
            if shown.offset {
                let offset = u64::from(height - 1 - y) * u64::from(width) + u64::from(x);
                write!(to, "OFF: {offset:7}")?;
            }
        }
    }
    Ok(())
}

/// `(%5.1f, %5.1f, %5.1f)`, with as many decimals as asked for.
fn triple(v: DVec3, decimals: usize) -> String {
    let [x, y, z] = v.to_array().map(|value| fixed(value, decimals));
    format!("({x:>5}, {y:>5}, {z:>5})")
}

/// C's `%.Nf`, exact ties to even, but never "-0.0".
fn fixed(value: f64, decimals: usize) -> String {
    let text = format!("{value:.decimals$}");
    match text.strip_prefix('-') {
        Some(zero) if zero.bytes().all(|byte| matches!(byte, b'0' | b'.')) => zero.to_owned(),
        _ => text,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_printed_as_by_c_but_never_minus_zero() {
        let cases = [
            (0.0, "0.0"),
            (-0.0, "0.0"),
            (-0.04, "0.0"),
            (-0.05, "-0.1"),
            (0.25, "0.2"),
            (0.75, "0.8"),
            (-8.5, "-8.5"),
            (12345.67, "12345.7"),
        ];
        for (value, text) in cases {
            assert_eq!(fixed(value, 1), text, "{value}");
        }
        assert_eq!(fixed(-0.004, 2), "0.00");
        assert_eq!(
            triple(DVec3::new(1.25, -0.01, -4.0), 1),
            "(  1.2,   0.0,  -4.0)"
        );
    }
}
