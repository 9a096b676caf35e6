//! What a record of the GPU is: one list of fields from which its Rust struct, its WGSL struct, its literal, the check
//! of its numbers' range and its layout follow. The lists stand in [`records`](super::records).

use std::fmt::Debug;

use bytemuck::{Pod, Zeroable};

use super::bounds::{fits, not_tiny};
use super::literal::{literal, vector};

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
        }
    )+};
}

pads! {
    Pad1, 1;
    Pad2, 2;
    Pad3, 3;
}

impl Field for f32 {
    const WGSL: &'static str = "f32";

    fn literal(&self) -> String {
        literal(*self)
    }

    fn fits(&self) -> bool {
        fits(*self)
    }

    fn not_tiny(&self) -> bool {
        not_tiny(*self)
    }
}

impl Field for u32 {
    const WGSL: &'static str = "u32";

    fn literal(&self) -> String {
        format!("{self}u")
    }

    fn fits(&self) -> bool {
        true
    }
}

macro_rules! vector_fields {
    ($($scalar:ty, $count:literal, $wgsl:literal, $literal:expr;)+) => {$(
        impl Field for [$scalar; $count] {
            const WGSL: &'static str = $wgsl;

            fn literal(&self) -> String {
                $literal(self)
            }

            fn fits(&self) -> bool {
                self.iter().all(Field::fits)
            }

            fn not_tiny(&self) -> bool {
                self.iter().all(Field::not_tiny)
            }
        }
    )+};
}

vector_fields! {
    f32, 2, "vec2f", vector;
    f32, 3, "vec3f", vector;
    f32, 4, "vec4f", vector;
    u32, 2, "vec2u", |v: &[u32; 2]| format!("vec2u({}, {})", v[0], v[1]);
    i32, 2, "vec2i", |v: &[i32; 2]| format!("vec2i({}, {})", v[0], v[1]);
}

impl Field for i32 {
    const WGSL: &'static str = "i32";

    fn literal(&self) -> String {
        format!("{self}i")
    }

    fn fits(&self) -> bool {
        true
    }
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
pub trait Record: Pod + Debug {
    /// Its fields and how they are laid out.
    const LAYOUT: Layout;

    /// Its fields' names and values in WGSL.
    fn literals(&self) -> Vec<(&'static str, String)>;

    /// The record as a WGSL expression.
    fn literal(&self) -> String {
        let values: Vec<String> = self
            .literals()
            .into_iter()
            .map(|(_, value)| value)
            .collect();
        format!("{}({})", Self::LAYOUT.wgsl, values.join(", "))
    }

    /// Whether every number in it is of moderate size, but for those fields that say why they need not be.
    fn fits(&self) -> bool;
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

            impl $crate::shader::record::Record for $name {
                const LAYOUT: $crate::shader::record::Layout = $crate::shader::record::Layout {
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
                    fits: |bytes| $crate::shader::record::Record::fits(&::bytemuck::pod_read_unaligned::<Self>(bytes)),
                };

                fn literals(&self) -> Vec<(&'static str, String)> {
                    use $crate::shader::record::Field;
                    let values = [$((stringify!($field), Field::literal(&self.$field))),+];
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
            }
        )+

        /// The layouts of these records.
        pub(super) const LAYOUTS: &[$crate::shader::record::Layout] =
            &[$(<$name as $crate::shader::record::Record>::LAYOUT),+];
    };
    (@why) => { None };
    (@why $why:literal) => { Some($why) };
    (@fits $field:expr, [], []) => { $crate::shader::record::Field::fits(&$field) };
    (@fits $field:expr, [$why:literal], []) => { true };
    (@fits $field:expr, [], [$factor:literal]) => {
        $crate::shader::record::Field::fits(&$field) && $crate::shader::record::Field::not_tiny(&$field)
    };
}
pub(crate) use records;
