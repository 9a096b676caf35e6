//! Error bounds for f32 on the GPU: the model of its arithmetic, the constants named in `shaders/`, and the literal
//! bounds that the host derives for forms over the pixel. Each constant is derived in docs/NUMERICS.md under its name.

use super::format::{Format, Known};
use crate::prepare::plane::Step;
use crate::real::Bounded;
use crate::real::rational::ratio;

/// A constant of an error bound.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Constant {
    /// Its name here, in the shader's text and in docs/NUMERICS.md.
    pub name: &'static str,
    /// What it is.
    pub value: f64,
    /// What it has to be at least, by its derivation; of limits that are chosen, and of what is a fact, the same.
    pub least: f64,
}

macro_rules! named {
    (
        $(#[doc = $about:literal])+
        $list:ident:
        $($(#[doc = $doc:literal])+ $name:ident = $value:expr $(, at least $least:expr)?;)+
    ) => {
        $($(#[doc = $doc])+ pub const $name: f64 = $value;)+

        $(#[doc = $about])+
        pub const $list: &[Constant] = &[$(Constant {
            name: stringify!($name),
            value: $name,
            least: named!(@least $name $($least)?),
        }),+];
    };
    (@least $name:ident) => { $name };
    (@least $name:ident $least:expr) => { $least };
}

named! {
    /// The constants that the shader's text refers to by name.
    NAMED:
    /// What a bound is larger by, for the roundings of itself and of the bounds and tests that it goes into: fewer than
    /// 800, of 838.
    GROWTH = 1.0001, at least 1.0;
    /// What + − × may be off by, relatively (`ROUNDING`), and what bounds' own roundings may take.
    U = ROUNDING * GROWTH, at least ROUNDING;
    /// What a square root is taken of is at least this.
    TINY_SQUARE = 1.0 / (1_u128 << 110) as f64;
    /// Secondary hits farther than this are left to the CPU.
    FARTHEST = (1_u64 << 40) as f64;
    /// Primary hits whose 1/(s·|W|) is no more than this are left to the CPU: they are farther away than `FARTHEST`.
    LEAST_INVERSE = 1.0 / (1_u64 << 40) as f64;
    /// Directions that are known less well than this are not followed: the bounds are first order there.
    DIR_LIMIT = 1.0 / 128.0;
    /// What is less than this many times its bound is left to the CPU where its error goes on: the bounds that follow
    /// are first order.
    FIRST_ORDER = 128.0;
    /// What a bound of the first order is multiplied by: products of two errors are below a hundredth of it.
    SECOND_ORDER = 1.01, at least 128.0 / 127.0;
    /// The error of a root is at most this times the square's over the root.
    ROOT_NEAR = 1.01, at least 1.0;
    /// The same where the square is above `ROOT_FAR_FROM` times its error.
    ROOT_FAR = 0.54, at least 0.5359;
    /// See `ROOT_FAR`.
    ROOT_FAR_FROM = 4.0;
    /// Roundings of the position of a primary hit, for a unit of its distance.
    HIT_ROUNDINGS = 7.5, at least 7.0;
    /// The least and the largest biased exponent that a ray's weight may have in f32: it is from 2⁻⁸⁶ up to 2⁵.
    WEIGHT_LEAST = 127.0 - 86.0;
    /// See `WEIGHT_LEAST`.
    WEIGHT_MOST = 127.0 + 4.0;
    /// What products that f32 flushes may take from a lit pixel's value, where 255 is a full byte.
    FLUSHED = 1.0 / (1_u64 << 26) as f64, at least 1.0 / (1_u64 << 27) as f64;
    /// Roundings of a dot product with a plane, of its sum with an offset.
    PLANE_ROUNDINGS = 6.5, at least 6.0;
    /// A plane is not seen edge-on where the cosine is more than this many times its bound.
    STEEP = 2.0;
    /// 1/(1 − x) is at most 1 + this times x, for x up to 1/`STEEP`.
    STEEP_SLOPE = 2.0, at least 2.0;
    /// Roundings of the distance of a plane.
    DISTANCE_ROUNDINGS = 12.5, at least 12.0;
    /// What a bound from below is multiplied by, for the roundings of a sum, a quotient and the tests it goes into.
    LOWERED = 0.999999, at least 1.0 - 12.0 * ROUNDING;
    /// Roundings of the distances that are compared with that of the closest hit.
    RIVAL_ROUNDINGS = 4.0, at least 3.0;
    /// Roundings of base + t·dir.
    POSITION_ROUNDINGS = 5.5, at least 5.0;
    /// Roundings of the normal of a plane.
    PLANE_NORMAL_ROUNDINGS = 1.5, at least 1.42;
    /// How far the perpendicular from a ray to a center turns with the direction, to the first order.
    TURN = 1.02, at least 1.0;
    /// The same, to the second order.
    TURN_MORE = 2.0;
    /// Roundings of the perpendicular from a ray to a center.
    PERPENDICULAR_ROUNDINGS = 18.5, at least 18.2;
    /// x² − y² is at most |x − y|·(this·x + |x − y|).
    SQUARE_SLOPE = 2.01, at least 2.0;
    /// Roundings of r² − |perpendicular|².
    DISC_ROUNDINGS = 11.5, at least 11.0;
    /// Roundings of a root by `inverseSqrt`, and what is added to it.
    ROOT_ROUNDINGS = 14.5, at least 14.0;
    /// The 1-norm of a perpendicular and what is along the ray, by this, is no less than the way from the ray's base,
    /// whatever the perpendicular is off by.
    FAR_GROWTH = 1.04, at least 1.02;
    /// Roundings of a matrix times a vector, of its sum with another.
    GRADIENT_ROUNDINGS = 7.5, at least 7.0;
    /// Roundings of the terms of a quadric's discriminant and of the quadratic's coefficients.
    MOMENT_ROUNDINGS = 15.0, at least 14.0;
    /// Roundings of a border, and of its difference from a position.
    BORDER_ROUNDINGS = 2.5, at least 2.0;
    /// A quotient is known where its divisor is more than this many times the divisor's bound.
    QUOTIENT_FROM = 8.0;
    /// 1/(1 − 1/`QUOTIENT_FROM`), and roundings.
    QUOTIENT_GROWTH = 1.15, at least 8.0 / 7.0;
    /// What is added to the bounds of divisors, so that no quotient overflows.
    LEAST_SLOPE = 1.0 / (1_u64 << 40) as f64;
    /// Primary hits on quadrics nearer than this times |W| are left to the CPU.
    NEAREST = 1.0 / (1_u64 << 40) as f64;
    /// 1/s of what may be so near: larger than that of anything else.
    CLOSEST = (1_u128 << 100) as f64;
    /// What is flushed of a quadric's numbers, for a unit of what its discriminant has for them at most.
    QUADRIC_FLUSHED = 1.0 / (1_u128 << 122) as f64, at least 1.0 / (1_u128 << 123) as f64;
    /// Roundings of a unit normal.
    NORMAL_ROUNDINGS = 7.5, at least 7.0;
    /// Roundings of a vector after a step towards unit length, which it nearly had; of its length alone one less.
    UNIT_ROUNDINGS = 5.0, at least 4.6;
    /// Roundings of the direction to a light.
    AIM_ROUNDINGS = 6.0, at least 5.6;
    /// Roundings of a vector divided by its length.
    DIRECTION_ROUNDINGS = 10.0, at least 9.5;
    /// Roundings of a dot product of unit vectors.
    DOT_ROUNDINGS = 5.5, at least 5.0;
    /// Roundings of a height and its quotient by a distance, but for the distance's.
    HEIGHT_ROUNDINGS = 2.5, at least 2.25;
    /// Lights, and what else a direction leads to, are farther away than this many times the bound of that.
    CLOSE_FROM = 4.0;
    /// 1/(1 − x) for x up to 1/`CLOSE_FROM`.
    CLOSE = 1.4, at least 4.0 / 3.0;
    /// 1/(1 − x)² is at most 1 + (this + `CLOSE`)·x for x up to 1/`CLOSE_FROM`.
    HEIGHT_SLOPE = 1.75, at least 28.0 / 9.0 - CLOSE;
    /// Roundings of the difference of two positions.
    TOWARD_ROUNDINGS = 1.5, at least 1.0;
    /// Roundings of the distance of a light, which ends a shadow ray, and of what is compared with it.
    LIMIT_ROUNDINGS = 13.0, at least 12.5;
    /// Roundings of how far a direction is inside of a cone.
    CONE_ROUNDINGS = 7.5, at least 7.0;
    /// Roundings of how far a way goes along a projector's normal.
    BEYOND_ROUNDINGS = 4.5, at least 4.0;
    /// Roundings of where a way crosses a projector's picture, for a unit of its length.
    PICTURE_ROUNDINGS = 13.5, at least 13.0;
    /// Roundings of what a light brings.
    LIGHT_ROUNDINGS = 17.0, at least 16.5;
    /// Roundings that a pane adds to the light that it lets through.
    PANE_ROUNDINGS = 4.5, at least 4.07;
    /// Roundings of the difference of two directions.
    HALF_ROUNDINGS = 2.5, at least 2.0;
    /// Shininess above this is left to the CPU.
    MOST_SHININESS = (1_u64 << 20) as f64;
    /// Roundings of the distance of two unit vectors, for a unit of it.
    APART_ROUNDINGS = 14.0, at least 13.5;
    /// Roundings of a power, for a unit of its logarithm to base 2.
    LOG_ROUNDINGS = 16.5, at least 16.0;
    /// The same, whatever its logarithm is; and those of the products that make a glint of it.
    POWER_ROUNDINGS = 25.0, at least 24.6;
    /// Roundings of a sum of colours.
    SUM_ROUNDINGS = 3.0, at least 3.0;
    /// Roundings of the share of a colour that a ray brings.
    SHARE_ROUNDINGS = 13.5, at least 13.0;
    /// Half of what a ray may bring is within this share of both ends.
    HALF_OPEN = 0.51, at least 0.5001;
    /// How much a mirrored direction turns with the normal.
    MIRROR_TURN = 2.04, at least 2.02;
    /// What a mirrored direction was off by before, by this, is what it is off by for that afterwards.
    MIRROR_GROWTH = 1.00001, at least 1.000_008_1;
    /// Roundings of the bounds of a ray's line and of its path's length, at each mirror and pane.
    LINE_ROUNDINGS = 6.0, at least 5.0;
    /// Roundings that a mirror adds to a branch's weight.
    WEIGHT_ROUNDINGS = 2.5, at least 2.0;
    /// Roundings that a pane adds to it.
    PANE_WEIGHT_ROUNDINGS = 5.0, at least 4.0;
    /// What a mirror or pane adds to the bound of a weight, for a unit of it: its own roundings, and those of the
    /// bound.
    WEIGHT_GROWTH = 8.0, at least 7.0;
    /// Roundings of what is left of the longest path.
    PATH_ROUNDINGS = 2.5, at least 2.0;
    /// Roundings of a mirrored direction.
    MIRROR_ROUNDINGS = 14.0, at least 13.6;
    /// Roundings of where a plane's mirror image of a ray starts, off its line and along it.
    BOUNCE_ROUNDINGS = 36.0, at least 35.3;
    /// Roundings of an index of tiles, blocks or texels.
    INDEX_ROUNDINGS = 5.5, at least 5.0;
    /// Indices of texels are certain up to this: there their remainder is.
    MOST_INDEX = (1_u64 << 20) as f64;
    /// The colour wheel's place is to be farther from its middle than the root of this many times its bound.
    WHEEL_FAR = 1024.0;
    /// How much the colours of `color_wheel` change with the place, in units of its distance.
    WHEEL_SLOPE = 3.0, at least 2.96;
    /// Roundings of the colours of `color_wheel`.
    WHEEL_ROUNDINGS = 24.0, at least 22.5;
    /// Roundings that widen the tree's boxes.
    BOX_ROUNDINGS = 4.0, at least 3.0;
    /// What a sample's error is multiplied by: the roundings of up to 2¹⁶ samples' bounds.
    SAMPLE_GROWTH = 1.01, at least 1.008;
    /// Roundings of a sum of samples.
    SAMPLE_ROUNDINGS = 3.5, at least 3.03;
}

/// The results of + − × are rounded to nearest: off by no more than this, relatively.
pub const ROUNDING: f64 = 1.0 / 16_777_216.0;

named! {
    /// The constants of the bounds that the host computes.
    LITERAL:
    /// Added to every literal bound: what flushed subnormals may amount to.
    FLOOR = 1.0 / (1_u128 << 100) as f64, at least 1.0 / (1_u128 << 104) as f64;
    /// What a result that is flushed to 0, or a coefficient that f32 cannot hold, is off by at most.
    LEAST_NORMAL = 1.0 / (1_u128 << 126) as f64;
    /// No number that goes to the GPU may be larger: then no product of those that meet there overflows.
    LARGEST = (1_u64 << 40) as f64;
    /// No factor of a colour may be nearer to 0 than this, unless it is 0: then products of a few of them neither
    /// vanish nor lose their relative accuracy below f32's normal numbers.
    SMALLEST = 1.0 / LARGEST;
    /// Products of a light's numbers, and those of a ray's weight with what a path's length makes of it, stay below 2
    /// to the power of this.
    MOST_PRODUCT = 32.0;
    /// Roundings that a form c₀X + c₁Y + c₂ and its comparison go through.
    LINEAR_ROUNDINGS = 8.5, at least 8.0;
    /// The same with several samples a pixel.
    SAMPLED_LINEAR_ROUNDINGS = 10.5, at least 10.0;
    /// The same for a quadratic form with six coefficients.
    QUADRATIC_ROUNDINGS = 9.5, at least 9.0;
    /// The same with several samples a pixel.
    SAMPLED_QUADRATIC_ROUNDINGS = 18.0, at least 18.0;
    /// What an offset that was rounded to f32 may be off by, in pixels.
    OFFSET_ERROR = 1.0 / 33_554_432.0;
    /// Roundings of W.
    W_ROUNDINGS = 7.0, at least 6.5;
    /// Roundings of |W| and of a primary hit's distance, for a unit of κ.
    LENGTH_ROUNDINGS = 28.0, at least 27.5;
    /// The same with several samples a pixel.
    SAMPLED_LENGTH_ROUNDINGS = 40.0, at least 39.5;
    /// Roundings of W/|W|, likewise.
    DIR_ROUNDINGS = 9.0, at least 8.6;
    /// The same with several samples a pixel.
    SAMPLED_DIR_ROUNDINGS = 10.5, at least 10.1;
    /// Roundings of an ambient value, likewise.
    VALUE_ROUNDINGS = 20.0, at least 19.5;
    /// κ may be no larger.
    MOST_CONDITION = 64.0;
    /// Roundings of the fraction that is added to an index.
    FRACTION_ROUNDINGS = 8.5, at least 8.0;
    /// Roundings of what is subtracted from a position for H − point.
    FROM_POINT_ROUNDINGS = 3.0, at least 2.0;
    /// Roundings of the coordinates on a rectangle.
    SIDES_ROUNDINGS = 8.5, at least 8.0;
    /// Beyond a sphere's box the discriminant is below minus this share of what it would be for a circle.
    OUTLINE_SHARE = 0.1;
    /// So many roundings of all its terms lie between it and 0 there.
    OUTLINE_ROUNDINGS = 64.0, at least 46.0;
    /// The bound of a form whose border runs midway between rays, in steps of their lattice.
    STEP_ERROR = 1.0 / 8.0, at least 0.0;
    /// So many steps such a form may have.
    MOST_STEPS = (1_u64 << 22) as f64;
    /// 255 times the value below which a byte is 0 whatever was rounded.
    DARKNESS = 0.9;
    /// What may be as near as `CLOSEST` is never dark: `dark` is no more than this.
    MOST_DARK = (1_u64 << 58) as f64;
    /// What the brightest value that a ray may bring is multiplied by, for the roundings of its own.
    BRIGHT_GROWTH = 1.001, at least 1.0001;
}

/// Roundings of |W| and of W/|W| for a unit of κ, with a ray a pixel or with several.
pub fn direction_roundings(several: bool) -> [f64; 2] {
    if several {
        [SAMPLED_LENGTH_ROUNDINGS, SAMPLED_DIR_ROUNDINGS]
    } else {
        [LENGTH_ROUNDINGS, DIR_ROUNDINGS]
    }
}

/// The pixels of the picture, and how rays pass through them.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Screen {
    /// Columns and rows.
    pub pixels: [u32; 2],
    /// How far from its pixel's center a ray may pass: 0 or ½.
    pub margin: f64,
    /// Rays pass at whole multiples of this share of a pixel; 0 where they pass anywhere.
    pub lattice: f64,
}

impl Screen {
    /// The largest |X| and |Y|, counted from `anchor`.
    pub fn reach(&self, anchor: [i32; 2]) -> [f64; 2] {
        [0, 1].map(|i| {
            let first = -f64::from(anchor[i]);
            let last = f64::from(self.pixels[i] - 1) + first;
            first.abs().max(last.abs()) + self.margin
        })
    }

    /// What holds with a ray a pixel, or with several.
    fn either(&self, one: f64, several: f64) -> f64 {
        if self.margin > 0.0 { several } else { one }
    }

    /// What a coordinate's own rounding adds to the error of a form, for a unit of its coefficient.
    pub fn offset_error<F: Format>(&self) -> f64 {
        if self.margin > 0.0 && self.lattice == 0.0 {
            F::OFFSET_ERROR
        } else {
            0.0
        }
    }
}

/// The f32 next above.
pub fn round_up(value: f64) -> f32 {
    let near = value as f32;
    if f64::from(near) >= value || !near.is_finite() {
        near
    } else {
        near.next_up()
    }
}

/// A form's coefficients, before they are rounded to the format, and the bound of its error.
pub type Form<const N: usize> = ([f64; N], f64);

/// A linear form over (X, Y, 1), where |X| and |Y| are at most `reach`.
pub fn linear<F: Format>(form: [F::Number; 3], reach: [f64; 2], screen: &Screen) -> Form<3> {
    let most = [reach[0], reach[1], 1.0];
    let moved = [screen.offset_error::<F>(), screen.offset_error::<F>(), 0.0];
    let roundings = screen.either(LINEAR_ROUNDINGS, SAMPLED_LINEAR_ROUNDINGS);
    (
        form.map(Known::nearest),
        bound::<F>(&form, &most, &moved, roundings),
    )
}

/// A quadratic form over (X², XY, Y², X, Y, 1).
pub fn quadratic<F: Format>(form: [F::Number; 6], reach: [f64; 2], screen: &Screen) -> Form<6> {
    let [x, y] = reach;
    let most = [x * x, x * y, y * y, x, y, 1.0];
    let slope = screen.offset_error::<F>();
    let moved = [2.0 * x, x + y, 2.0 * y, 1.0, 1.0, 0.0].map(|m| m * slope);
    let roundings = screen.either(QUADRATIC_ROUNDINGS, SAMPLED_QUADRATIC_ROUNDINGS);
    (
        form.map(Known::nearest),
        bound::<F>(&form, &most, &moved, roundings),
    )
}

/// The bound of a form whose terms are at most `most` for a unit of their coefficients, and `moved` more where the
/// pixel is off. A rounding takes a share of the term, or all of what is flushed.
fn bound<F: Format>(form: &[F::Number], most: &[f64], moved: &[f64], roundings: f64) -> f64 {
    let terms = form.iter().zip(most).zip(moved);
    let errors = terms.map(|((c, most), moved)| {
        let size = c.nearest().abs();
        most * (roundings * (F::ROUNDING * size + LEAST_NORMAL) + c.off()) + size * moved
    });
    F::round_up((FLOOR + errors.sum::<f64>()) * GROWTH)
}

/// An upper bound of |value|, as an f64.
pub fn upper_bound(value: impl Known) -> f64 {
    (value.nearest().abs() + value.off()) * Bounded::GROW
}

/// The border `at` of a half-plane of pixels, x ≥ at or x ≤ at for one coordinate, as a form whose sign no rounding can
/// change: it runs midway between two rays that are neighbours. None where the pixels are too far from the anchor for
/// that.
pub fn step(step: &Step, anchor: [i32; 2], screen: &Screen) -> Option<Form<3>> {
    let axis = step.axis;
    if screen.lattice == 0.0 {
        return None;
    }
    let steps = (&step.at - ratio(f64::from(anchor[axis]))) / ratio(screen.lattice);
    let border = if step.rising {
        f64::try_from(steps.ceil()).ok()? - 0.5
    } else {
        f64::try_from(steps.floor()).ok()? + 0.5
    } * screen.lattice;
    let reach = screen.reach(anchor);
    // The half step must have a bit in every sum.
    let room = screen.lattice * MOST_STEPS;
    // A border outside the picture is as good anywhere outside.
    let border = border.clamp(-reach[axis] - 1.0, reach[axis] + 1.0);
    if reach[axis] + 2.0 > room {
        return None;
    }
    let sign = if step.rising { 1.0 } else { -1.0 };
    let mut form = [0.0; 3];
    form[axis] = sign;
    form[2] = -sign * border;
    Some((form, screen.lattice * STEP_ERROR))
}

/// Whether a factor is 0, or far enough from it.
pub fn not_tiny(value: f64) -> bool {
    value == 0.0 || value.abs() >= SMALLEST
}

/// Whether f32 can hold the number with room to spare; 0 is as good as any small number.
pub fn fits(value: f64) -> bool {
    value.abs() <= LARGEST
}

#[cfg(test)]
mod tests;
