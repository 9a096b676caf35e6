//! What a record of the GPU is: one list of fields from which its Rust structs, its WGSL struct, its literal, the check
//! of its numbers' range and its layout follow. The lists stand in [`records`](super::records).
//!
//! A record is filled in with f64, as its *wide* twin, and rounded to f32 as a whole where it is for f32
//! ([`format`](super::format)).

use std::borrow::Cow;
use std::fmt::Debug;

use bytemuck::Pod;

pub use super::field::{Field, Narrow, Pad1, Pad2, Pad3};
pub(super) use super::field::{align, largest};

/// Records one after the other, as WGSL has them in an array.
pub(super) fn written<T: Record + Field>(records: &[T]) -> Cow<'_, [u8]> {
    let mut bytes = Vec::new();
    records.iter().for_each(|record| record.write(&mut bytes));
    bytes.into()
}

/// A field as WGSL and the test of the layout need it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct FieldLayout {
    /// Its name, in Rust and in WGSL.
    pub name: &'static str,
    /// Its WGSL type; empty for words that are only there to fill up.
    pub wgsl: &'static str,
    /// Bytes before it.
    pub offset: usize,
    /// Why its numbers may be of any size, if they may.
    pub any_size: Option<&'static str>,
    /// Why its numbers must not be tiny, if they must not.
    pub factor: Option<&'static str>,
    /// What it says, line by line.
    pub doc: &'static [&'static str],
}

/// A record as WGSL and the test of the layout need it.
#[derive(Debug, Clone, Copy)]
pub struct Layout {
    /// Its name in Rust, by which `//#insert struct NAME` asks for it.
    pub name: &'static str,
    /// Its name in WGSL.
    pub wgsl: &'static str,
    /// What it is, line by line.
    pub doc: &'static [&'static str],
    /// Its fields, those that only fill up included.
    pub fields: &'static [FieldLayout],
    /// Its size in bytes.
    pub size: usize,
    /// [`Record::fits`] of the record that stands in these bytes.
    pub fits: fn(&[u8]) -> bool,
    /// The bytes of that record with f64 for f32, as WGSL has them.
    pub widened: fn(&[u8]) -> Vec<u8>,
}

impl Layout {
    /// The fields that WGSL knows.
    pub fn members(&self) -> impl Iterator<Item = &FieldLayout> {
        self.fields.iter().filter(|field| !field.wgsl.is_empty())
    }

    /// The struct in WGSL.
    pub fn definition(&self) -> String {
        let doc: String = self.doc.iter().map(|line| format!("//{line}\n")).collect();
        let members = self.member_lines("");
        format!("{doc}struct {} {{\n{members}}}\n", self.wgsl)
    }

    /// Its members in WGSL, the names with `prefix` before them.
    pub fn member_lines(&self, prefix: &str) -> String {
        let member = |field: &FieldLayout| {
            let doc: String = field
                .doc
                .iter()
                .map(|line| format!("    //{line}\n"))
                .collect();
            format!("{doc}    {prefix}{}: {},\n", field.name, field.wgsl)
        };
        self.members().map(member).collect()
    }
}

/// A record of the GPU.
pub trait Record: Pod + Debug + PartialEq + Send + Sync {
    /// Its name in WGSL.
    const WGSL: &'static str;

    /// How records are uploaded.
    fn bytes(records: &[Self]) -> Cow<'_, [u8]>;

    /// Its fields' names and values in WGSL.
    fn literals(&self) -> Vec<(&'static str, String)>;

    /// The record as a WGSL expression.
    fn literal(&self) -> String {
        let values: Vec<String> = self
            .literals()
            .into_iter()
            .map(|(_, value)| value)
            .collect();
        format!("{}({})", Self::WGSL, values.join(", "))
    }

    /// Whether every number in it is of moderate size, but for those fields that say why they need not be.
    fn fits(&self) -> bool;
}

/// Words are elements of buffers as records are.
impl Record for u32 {
    const WGSL: &'static str = "u32";

    fn bytes(records: &[Self]) -> Cow<'_, [u8]> {
        bytemuck::cast_slice(records).into()
    }

    fn literals(&self) -> Vec<(&'static str, String)> {
        vec![("", Field::literal(self))]
    }

    fn fits(&self) -> bool {
        true
    }
}

/// A record with f64 in it.
pub trait Wide: Record {
    /// The same with f32.
    type Narrow: Record;

    /// Every number rounded to the nearest f32.
    fn narrow(self) -> Self::Narrow;

    /// Every number as an f64.
    fn widen(narrow: Self::Narrow) -> Self;
}

/// Makes records of lists of fields: `NAME as "WGSL name" { … }`. A field whose numbers may be of any size says why in
/// `#[any_size = "…"]`; all others are checked before error bounds are relied on. A field whose numbers must be 0 or
/// not tiny says why in `#[factor = "…"]`.
macro_rules! records {
    ($(
        $(#[doc = $doc:literal])+
        $name:ident as $wgsl:literal {
            $(
                $(#[doc = $field_doc:literal])*
                $(#[any_size = $why:literal])?
                $(#[factor = $factor:literal])?
                $field:ident: $type:ty,
            )+
        }
    )+) => {
        $(
            $(#[doc = $doc])+
            #[repr(C)]
            #[derive(Debug, Clone, Copy, PartialEq, ::bytemuck::Pod, ::bytemuck::Zeroable)]
            pub struct $name {
                $(
                    $(#[doc = $field_doc])*
                    $(#[doc = concat!("\n\nOf any size: ", $why, ".")])?
                    $(#[doc = concat!("\n\nNot tiny: ", $factor, ".")])?
                    pub $field: $type,
                )+
            }

            impl $name {
                /// Its fields and how they are laid out.
                pub const LAYOUT: $crate::shader::record::Layout = $crate::shader::record::Layout {
                    name: stringify!($name),
                    wgsl: $wgsl,
                    doc: &[$($doc),+],
                    fields: &[$($crate::shader::record::FieldLayout {
                        name: stringify!($field),
                        wgsl: <$type as $crate::shader::record::Field>::WGSL,
                        offset: ::std::mem::offset_of!($name, $field),
                        any_size: records!(@why $($why)?),
                        factor: records!(@why $($factor)?),
                        doc: &[$($field_doc),*],
                    }),+],
                    size: size_of::<$name>(),
                    widened: |bytes| {
                        let record: Self = ::bytemuck::pod_read_unaligned(bytes);
                        $crate::shader::record::written(&[$crate::shader::record::Narrow::widen(record)]).into_owned()
                    },
                    fits: |bytes| $crate::shader::record::Record::fits(&::bytemuck::pod_read_unaligned::<Self>(bytes)),
                };
            }

            records!(@record $name, $wgsl, |records| ::bytemuck::cast_slice(records).into(), $(
                $field, $type, [$($why)?], [$($factor)?]
            ),+);
            records!(@record wide::$name, $wgsl, $crate::shader::record::written, $(
                $field, <$type as $crate::shader::record::Narrow>::Wide, [$($why)?], [$($factor)?]
            ),+);

            impl $crate::shader::record::Narrow for $name {
                type Wide = wide::$name;

                fn widen(self) -> wide::$name {
                    use $crate::shader::record::Narrow;
                    wide::$name { $($field: Narrow::widen(self.$field)),+ }
                }

                fn narrow(wide: wide::$name) -> Self {
                    use $crate::shader::record::Narrow;
                    Self { $($field: Narrow::narrow(wide.$field)),+ }
                }
            }

            impl $crate::shader::record::Wide for wide::$name {
                type Narrow = $name;

                #[inline]
                fn narrow(self) -> $name {
                    $crate::shader::record::Narrow::narrow(self)
                }

                #[inline]
                fn widen(narrow: $name) -> Self {
                    $crate::shader::record::Narrow::widen(narrow)
                }
            }
        )+

        /// The same records with f64 for f32.
        pub(in crate::shader) mod wide {
            use super::*;

            $(
                $(#[doc = $doc])+
                // Words one after the other, with nothing in between, so that lanes can read each its own.
                #[repr(C, packed(4))]
                #[derive(Debug, Clone, Copy, PartialEq, Default, ::bytemuck::Pod, ::bytemuck::Zeroable)]
                pub struct $name {
                    $(
                        $(#[doc = $field_doc])*
                        pub $field: <$type as $crate::shader::record::Narrow>::Wide,
                    )+
                }

                // A record within a record is named without saying that it is a wide one.
                impl $crate::shader::record::Narrow for $name {
                    type Wide = Self;

                    fn widen(self) -> Self {
                        self
                    }

                    fn narrow(wide: Self) -> Self {
                        wide
                    }
                }
            )+
        }

        /// The layouts of these records.
        pub(super) const LAYOUTS: &[$crate::shader::record::Layout] = &[$($name::LAYOUT),+];
    };
    (@record $name:path, $wgsl:literal, $bytes:expr,
        $($field:ident, $type:ty, [$($why:literal)?], [$($factor:literal)?]),+) => {
        impl $crate::shader::record::Record for $name {
            const WGSL: &'static str = $wgsl;

            fn bytes(records: &[Self]) -> ::std::borrow::Cow<'_, [u8]> {
                let bytes: fn(&[Self]) -> ::std::borrow::Cow<'_, [u8]> = $bytes;
                bytes(records)
            }

            fn literals(&self) -> Vec<(&'static str, String)> {
                use $crate::shader::record::Field;
                let values = [$((stringify!($field), Field::literal(&{ self.$field }))),+];
                values.into_iter().filter(|(_, value)| !value.is_empty()).collect()
            }

            fn fits(&self) -> bool {
                [$(records!(@fits self.$field, [$($why)?], [$($factor)?])),+].into_iter().all(|fits| fits)
            }
        }

        impl $crate::shader::record::Field for $name {
            const WGSL: &'static str = $wgsl;

            fn literal(&self) -> String {
                $crate::shader::record::Record::literal(self)
            }

            fn fits(&self) -> bool {
                $crate::shader::record::Record::fits(self)
            }

            const ALIGN: usize = $crate::shader::record::largest(&[
                $(<$type as $crate::shader::record::Field>::ALIGN),+
            ]);

            fn write(&self, bytes: &mut Vec<u8>) {
                use $crate::shader::record::{Field, align};
                $(
                    align(bytes, <$type as Field>::ALIGN);
                    { self.$field }.write(bytes);
                )+
                align(bytes, <Self as Field>::ALIGN);
            }
        }
    };
    (@why) => { None };
    (@why $why:literal) => { Some($why) };
    (@fits $field:expr, [], []) => { $crate::shader::record::Field::fits(&{ $field }) };
    (@fits $field:expr, [$why:literal], []) => { true };
    (@fits $field:expr, [], [$factor:literal]) => {
        $crate::shader::record::Field::fits(&{ $field }) && $crate::shader::record::Field::not_tiny(&{ $field })
    };
}
pub(crate) use records;
