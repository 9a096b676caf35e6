//! The types that fields of records may have: how WGSL calls them, writes them and lays them out, and which f64 stands
//! for which f32. The records stand in [`records`](super::records).

use std::fmt::Debug;

use bytemuck::{Pod, Zeroable};

use super::bounds::{fits, not_tiny};
use super::literal::{literal, literal_of_f64};

/// A type that a field of a record may have.
pub trait Field {
    /// Its name in WGSL; empty for [`Pad1`] and the like, which WGSL leaves out by itself.
    const WGSL: &'static str;

    /// The value as a WGSL expression that means exactly it.
    fn literal(&self) -> String;

    /// Whether every f32 in it is of moderate size: see [`fits`].
    fn fits(&self) -> bool;

    /// Whether every f32 in it is 0 or not tiny: see [`not_tiny`].
    fn not_tiny(&self) -> bool {
        true
    }

    /// What its place in a buffer is a multiple of, in bytes.
    const ALIGN: usize;

    /// Appends its bytes as WGSL has them.
    fn write(&self, bytes: &mut Vec<u8>);
}

/// A field of f32, or of what f64 leaves as it is.
pub trait Narrow: Field + Copy {
    /// The same with f64 in it.
    type Wide: Field + Copy + Debug + PartialEq + Default;

    /// Every number as an f64.
    fn widen(self) -> Self::Wide;

    /// Every number rounded to the nearest f32.
    fn narrow(wide: Self::Wide) -> Self;
}

/// Appends what WGSL leaves unused before what is aligned so.
pub(super) fn align(bytes: &mut Vec<u8>, to: usize) {
    bytes.resize(bytes.len().next_multiple_of(to), 0);
}

/// The largest of alignments.
pub(super) const fn largest(aligns: &[usize]) -> usize {
    let mut largest = 1;
    let mut i = 0;
    while i < aligns.len() {
        if aligns[i] > largest {
            largest = aligns[i];
        }
        i += 1;
    }
    largest
}

macro_rules! pads {
    ($($name:ident, $words:literal;)+) => {$(
        /// Words that WGSL's alignment leaves unused between or behind the fields.
        #[repr(transparent)]
        #[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Pod, Zeroable)]
        pub struct $name([u32; $words]);

        impl Field for $name {
            const WGSL: &'static str = "";

            fn literal(&self) -> String {
                String::new()
            }

            fn fits(&self) -> bool {
                true
            }

            const ALIGN: usize = 1;

            fn write(&self, _: &mut Vec<u8>) {}
        }
    )+};
}

pads! {
    Pad1, 1;
    Pad2, 2;
    Pad3, 3;
}

macro_rules! number_fields {
    ($($scalar:ident, $literal:expr, $fits:expr, $not_tiny:expr;)+) => {$(
        impl Field for $scalar {
            const WGSL: &'static str = stringify!($scalar);

            fn literal(&self) -> String {
                $literal(*self)
            }

            fn fits(&self) -> bool {
                $fits(f64::from(*self))
            }

            fn not_tiny(&self) -> bool {
                $not_tiny(f64::from(*self))
            }

            const ALIGN: usize = size_of::<Self>();

            fn write(&self, bytes: &mut Vec<u8>) {
                bytes.extend(self.to_le_bytes());
            }
        }
    )+};
}

number_fields! {
    f32, literal, fits, not_tiny;
    f64, literal_of_f64, fits, not_tiny;
    u32, |value| format!("{value}u"), |_| true, |_| true;
    i32, |value| format!("{value}i"), |_| true, |_| true;
}

macro_rules! vector_fields {
    ($($scalar:ident, $count:literal, $wgsl:literal;)+) => {$(
        impl Field for [$scalar; $count] {
            const WGSL: &'static str = $wgsl;

            fn literal(&self) -> String {
                let list: Vec<String> = self.iter().map(Field::literal).collect();
                format!("{}({})", $wgsl, list.join(", "))
            }

            fn fits(&self) -> bool {
                self.iter().all(Field::fits)
            }

            fn not_tiny(&self) -> bool {
                self.iter().all(Field::not_tiny)
            }

            const ALIGN: usize = size_of::<$scalar>() * usize::next_power_of_two($count);

            fn write(&self, bytes: &mut Vec<u8>) {
                self.iter().for_each(|number| number.write(bytes));
            }
        }
    )+};
}

vector_fields! {
    f32, 2, "vec2f";
    f32, 3, "vec3f";
    f32, 4, "vec4f";
    f64, 2, "vec2<f64>";
    f64, 3, "vec3<f64>";
    f64, 4, "vec4<f64>";
    u32, 2, "vec2u";
    i32, 2, "vec2i";
}

impl Narrow for f32 {
    type Wide = f64;

    fn widen(self) -> f64 {
        f64::from(self)
    }

    fn narrow(wide: f64) -> Self {
        wide as Self
    }
}

macro_rules! unchanged {
    ($($type:ty),+) => {$(
        impl Narrow for $type {
            type Wide = Self;

            fn widen(self) -> Self {
                self
            }

            fn narrow(wide: Self) -> Self {
                wide
            }
        }
    )+};
}

unchanged!(u32, [u32; 2], [i32; 2], Pad1, Pad2, Pad3);

macro_rules! narrow_vectors {
    ($($count:literal),+) => {$(
        impl Narrow for [f32; $count] {
            type Wide = [f64; $count];

            fn widen(self) -> Self::Wide {
                self.map(Narrow::widen)
            }

            fn narrow(wide: Self::Wide) -> Self {
                wide.map(Narrow::narrow)
            }
        }
    )+};
}

narrow_vectors!(2, 3, 4);
