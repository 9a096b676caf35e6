//! Error bounds for f32 on the GPU: the model of its arithmetic, the constants named in `shaders/`, and the literal
//! bounds that the host derives for forms over the pixel. Each constant is derived in docs/NUMERICS.md under its name.

use crate::prepare::plane::Step;
use crate::real::Bounded;
use crate::real::rational::ratio;

macro_rules! named {
    ($($(#[doc = $doc:literal])+ $name:ident = $value:expr;)+) => {
        $($(#[doc = $doc])+ pub const $name: f64 = $value;)+

        /// The constants that the shader's text refers to by name.
        pub const NAMED: &[(&str, f64)] = &[$((stringify!($name), $name)),+];
    };
}

named! {
    /// What + − × may be off by, relatively: the results are faithfully rounded.
    U = 1.0 / 8_388_608.0;
    /// What a square root is taken of is at least this.
    TINY_SQUARE = 1.0 / (1_u128 << 110) as f64;
    /// Secondary hits farther than this are left to the CPU.
    FARTHEST = (1_u64 << 40) as f64;
    /// Primary hits whose 1/s is no more than this are left to the CPU.
    LEAST_INVERSE = 1.0 / (1_u64 << 40) as f64;
    /// Directions that are known less well than this are not followed: the bounds are first order there.
    DIR_LIMIT = 1.0 / 128.0;
    /// Hits whose 1/s is less than this many times its bound are left to the CPU where their error goes on: the bounds
    /// that follow are first order.
    FIRST_ORDER = 128.0;
    /// What a bound of the first order is multiplied by: products of two errors are below a hundredth of it.
    SECOND_ORDER = 1.01;
    /// The error of a root is at most this times the square's over the root.
    ROOT_NEAR = 1.01;
    /// The same where the square is above `ROOT_FAR_FROM` times its error.
    ROOT_FAR = 0.54;
    /// See `ROOT_FAR`.
    ROOT_FAR_FROM = 4.0;
    /// Roundings of the position of a primary hit, for a unit of its distance.
    HIT_ROUNDINGS = 5.0;
    /// The least and the largest biased exponent that a ray's weight may have in f32: it is from 2⁻⁸⁶ up to 2⁵.
    WEIGHT_LEAST = 127.0 - 86.0;
    /// See `WEIGHT_LEAST`.
    WEIGHT_MOST = 127.0 + 4.0;
    /// What products that f32 flushes may take from a lit pixel's value, where 255 is a full byte.
    FLUSHED = 1.0 / (1_u64 << 26) as f64;
    /// Roundings of a dot product with a plane, of its sum with an offset.
    PLANE_ROUNDINGS = 6.0;
    /// Roundings of base + t·dir.
    POSITION_ROUNDINGS = 5.0;
    /// Roundings of the perpendicular from a ray to a center.
    PERPENDICULAR_ROUNDINGS = 12.0;
    /// Roundings of r² − |perpendicular|².
    DISC_ROUNDINGS = 12.0;
    /// Roundings of a root by `inverseSqrt`, and what is added to it.
    ROOT_ROUNDINGS = 10.0;
    /// Roundings of a unit normal.
    NORMAL_ROUNDINGS = 5.0;
    /// Roundings of a vector divided by its length.
    DIRECTION_ROUNDINGS = 8.0;
    /// Roundings of a dot product of unit vectors.
    DOT_ROUNDINGS = 5.0;
    /// Roundings of a height and its quotient by a distance, but for the distance's.
    HEIGHT_ROUNDINGS = 2.0;
    /// Roundings of a mirrored direction.
    MIRROR_ROUNDINGS = 18.0;
    /// Roundings of where a plane's mirror image of a ray starts, off its line and along it.
    BOUNCE_ROUNDINGS = 30.0;
    /// Shininess above this is left to the CPU.
    MOST_SHININESS = (1_u64 << 20) as f64;
    /// Roundings of the distance of two unit vectors, for a unit of it.
    APART_ROUNDINGS = 9.0;
    /// Roundings of a power, for a unit of its logarithm to base 2.
    LOG_ROUNDINGS = 12.0;
    /// The same, whatever its logarithm is; and those of the products that make a glint of it.
    POWER_ROUNDINGS = 20.0;
    /// Roundings of an index of tiles, blocks or texels.
    INDEX_ROUNDINGS = 5.0;
    /// Roundings of the colours of `color_wheel`.
    WHEEL_ROUNDINGS = 20.0;
}

/// Added to every literal bound: what flushed subnormals may amount to.
const FLOOR: f64 = 1.0 / (1_u128 << 100) as f64;

/// No number that goes to the GPU may be larger: then no product of those that meet there overflows.
pub const LARGEST: f64 = (1_u64 << 40) as f64;

/// Roundings that a form c₀X + c₁Y + c₂ and its comparison go through.
const LINEAR_ROUNDINGS: [f64; 2] = [6.0, 8.0];
/// The same for a quadratic form with six coefficients.
const QUADRATIC_ROUNDINGS: [f64; 2] = [9.0, 18.0];
/// What an offset that was rounded to f32 may be off by, in pixels.
const OFFSET_ERROR: f64 = 1.0 / 33_554_432.0;

/// Roundings of |W|, of W/|W| and of an ambient value, for a unit of κ.
pub const LENGTH_ROUNDINGS: f64 = 20.0;
/// See [`LENGTH_ROUNDINGS`].
pub const DIR_ROUNDINGS: f64 = 12.0;
/// See [`LENGTH_ROUNDINGS`].
pub const VALUE_ROUNDINGS: f64 = 13.0;

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

    fn sampled(&self) -> usize {
        usize::from(self.margin > 0.0)
    }

    /// What a coordinate's own rounding adds to the error of a form, for a unit of its coefficient.
    pub fn offset_error(&self) -> f64 {
        if self.margin > 0.0 && self.lattice == 0.0 {
            OFFSET_ERROR
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

/// A form's coefficients in f32, and the bound of its error.
pub type Form<const N: usize> = ([f32; N], f32);

/// A linear form over (X, Y, 1), where |X| and |Y| are at most `reach`.
pub fn linear(form: [Bounded; 3], reach: [f64; 2], screen: &Screen) -> Form<3> {
    let most = [reach[0], reach[1], 1.0];
    let moved = [screen.offset_error(), screen.offset_error(), 0.0];
    let mut error = FLOOR;
    for i in 0..3 {
        error += bound(form[i], most[i], LINEAR_ROUNDINGS[screen.sampled()])
            + form[i].value.abs() * moved[i];
    }
    (form.map(|c| c.value as f32), round_up(error))
}

/// A quadratic form over (X², XY, Y², X, Y, 1).
pub fn quadratic(form: [Bounded; 6], reach: [f64; 2], screen: &Screen) -> Form<6> {
    let [x, y] = reach;
    let most = [x * x, x * y, y * y, x, y, 1.0];
    let slope = screen.offset_error();
    let moved = [2.0 * x, x + y, 2.0 * y, 1.0, 1.0, 0.0].map(|m| m * slope);
    let mut error = FLOOR;
    for i in 0..6 {
        error += bound(form[i], most[i], QUADRATIC_ROUNDINGS[screen.sampled()])
            + form[i].value.abs() * moved[i];
    }
    (form.map(|c| c.value as f32), round_up(error))
}

/// What one term adds to a form's error.
fn bound(coefficient: Bounded, most: f64, roundings: f64) -> f64 {
    most * (roundings * U * coefficient.value.abs() + coefficient.error) * (1.0 + 1e-6)
}

/// An upper bound of |value|, as an f64.
pub fn upper_bound(value: Bounded) -> f64 {
    (value.value.abs() + value.error) * Bounded::GROW
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
    let room = screen.lattice * 4_194_304.0;
    // A border outside the picture is as good anywhere outside.
    let border = border.clamp(-reach[axis] - 1.0, reach[axis] + 1.0);
    if reach[axis] + 2.0 > room {
        return None;
    }
    let sign = if step.rising { 1.0 } else { -1.0 };
    let mut form = [0.0; 3];
    form[axis] = sign as f32;
    form[2] = (-sign * border) as f32;
    Some((form, (screen.lattice / 8.0) as f32))
}

/// No factor of a colour may be nearer to 0 than this, unless it is 0: then products of a few of them neither vanish
/// nor lose their relative accuracy below f32's normal numbers.
pub const SMALLEST: f64 = 1.0 / LARGEST;

/// Whether a factor is 0, or far enough from it.
pub fn not_tiny(value: f32) -> bool {
    value == 0.0 || f64::from(value.abs()) >= SMALLEST
}

/// Whether f32 can hold the number with room to spare; 0 is as good as any small number.
pub fn fits(value: f32) -> bool {
    f64::from(value.abs()) <= LARGEST
}
