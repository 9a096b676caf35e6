//! What the shader is bound to: one table of number, name, type, condition and contents. The declarations in WGSL, the
//! upload, `plumb dump --stage buffers`, the check of the numbers' range and the tests read it.

use std::borrow::Cow;
use std::fmt::Write as _;

use super::feature::{Feature, Features};
use super::format::{Format, Single};
use super::pack::{Lit, Packed};
use super::record::Record;
use super::records::wide::{LitObject, Object};

/// A binding of group 0, of a shader for numbers of a format.
pub struct Binding<F: Format = Single> {
    /// Its number. Of those with the same number at most one holds.
    pub number: u32,
    /// Its name in WGSL.
    pub name: &'static str,
    /// `var<…>` in WGSL.
    access: &'static str,
    /// Its type in WGSL.
    wgsl: &'static str,
    /// What it holds.
    doc: &'static [&'static str],
    /// What it holds, for people.
    pub what: &'static str,
    /// Whether the shader has it.
    pub holds: fn(&Features) -> bool,
    /// What the scene puts into it; None where a dispatch does.
    pub contents: Option<fn(&Packed<F>) -> Contents<'_>>,
}

/// The number of the dispatch's binding.
pub const DISPATCH: u32 = 0;
/// The number of the pixels' binding.
pub const PIXELS: u32 = 1;
/// The number of the binding of the samples' offsets.
pub const OFFSETS: u32 = 16;

/// What a buffer of the scene holds.
pub type Contents<'a> = Box<dyn Elements + 'a>;

/// The elements of a buffer.
pub trait Elements {
    /// How they are uploaded.
    fn bytes(&self) -> Cow<'_, [u8]>;

    /// Whether all their numbers are of moderate size, as error bounds ask.
    fn fit(&self) -> bool;

    /// A line for the whole and one for each, if there are any.
    fn describe(&self, name: &str, text: &mut String);
}

/// Elements of one type.
struct List<'a, T: Clone>(Cow<'a, [T]>);

impl<T: Record> Elements for List<'_, T> {
    fn bytes(&self) -> Cow<'_, [u8]> {
        T::bytes(&self.0)
    }

    fn fit(&self) -> bool {
        self.0.iter().all(T::fits)
    }

    fn describe(&self, name: &str, text: &mut String) {
        if self.0.is_empty() {
            return;
        }
        let (records, bytes) = (self.0.len(), self.bytes().len());
        let size = bytes / records;
        writeln!(
            text,
            "{name}: {records} records of {size} bytes, {bytes} in all"
        )
        .unwrap_or_default();
        for (i, record) in self.0.iter().enumerate() {
            writeln!(text, "  {i}: {record:?}").unwrap_or_default();
        }
    }
}

fn records<'a, T: Record>(records: impl Into<Cow<'a, [T]>>) -> Contents<'a> {
    Box::new(List(records.into()))
}

fn words<'a>(words: impl Into<Cow<'a, [u32]>>) -> Contents<'a> {
    Box::new(List(words.into()))
}

/// Records that only lit scenes have.
fn of_lit<F: Format, T: Record>(packed: &Packed<F>, of: fn(&Lit<F>) -> &Vec<T>) -> Contents<'_> {
    records(packed.lit.as_ref().map_or(&[][..], |lit| of(lit)))
}

/// What `objects` holds in a scene without lights; nothing in others. The tables of indices stand behind the objects,
/// in the field `kind`.
pub(crate) fn objects<F: Format>(packed: &Packed<F>) -> Vec<F::Record<Object>> {
    if packed.lit.is_some() {
        return Vec::new();
    }
    let rows = packed.tables.words.iter().map(|&kind| Object {
        kind,
        ..Object::default()
    });
    let objects = packed.objects.iter().copied();
    objects.chain(rows.map(F::record)).collect()
}

/// What it holds in a scene with lights; nothing in others. Third sides of triangles stand behind the tables.
pub(crate) fn lit_objects<F: Format>(packed: &Packed<F>) -> Vec<F::Record<LitObject>> {
    let rows = packed.tables.words.iter().map(|&kind| LitObject {
        kind,
        ..LitObject::default()
    });
    let all = |lit: &Lit<F>| -> Vec<F::Record<LitObject>> {
        let objects = lit.objects.iter().copied();
        let objects = objects.chain(rows.map(F::record));
        objects.chain(lit.third_sides()).collect()
    };
    packed.lit.as_ref().map(all).unwrap_or_default()
}

const READ: &str = "storage, read";
const WRITE: &str = "storage, read_write";

macro_rules! bindings {
    ($(
        $(#[doc = $doc:literal])*
        binding $number:expr, $name:literal, $access:expr, $wgsl:literal, $what:literal, $holds:expr, $contents:expr;
    )+) => {
        impl<F: Format> Binding<F> {
            /// All bindings.
            pub const ALL: &'static [Self] = &[$(Self {
                number: $number,
                name: $name,
                access: $access,
                wgsl: $wgsl,
                doc: &[$($doc),*],
                what: $what,
                holds: $holds,
                contents: $contents,
            }),+];
        }

        /// All bindings of a shader for f32.
        pub const BINDINGS: &[Binding] = Binding::ALL;
    };
}

/// Whether pixels are more or less than a word each.
fn others(features: &Features) -> bool {
    let kinds = [Feature::Values, Feature::Quad, Feature::Packed];
    kinds.iter().any(|feature| features.contains(feature))
}

bindings! {
    binding DISPATCH, "dispatch", "uniform", "Dispatch", "dispatch", |_| true, None;
    /// Red, green, blue as f32 (255 is a full byte), then the packed bytes: red, green, blue from the lowest byte up,
    /// and in the highest UNDECIDED where the CPU has to decide, else 0.
    binding PIXELS, "pixels", WRITE, "array<vec4u>", "pixels", |f| f.contains(&Feature::Values), None;
    /// Packed bytes of four pixels side by side, rows filled up: red, green, blue from the lowest byte up, and in the
    /// highest UNDECIDED where the CPU has to decide, else 0.
    binding PIXELS, "pixels", WRITE, "array<vec4u>", "pixels",
        |f| f.contains(&Feature::Quad) && !f.contains(&Feature::Packed) && !f.contains(&Feature::Values), None;
    /// Rows of groups of 16 pixels, filled up: of each group twelve words with red, green, blue of one pixel after the
    /// other, from the lowest byte up. Behind all rows a word for each group: a bit for each pixel, from the lowest up,
    /// that is set where the CPU has to decide.
    binding PIXELS, "pixels", WRITE, "array<u32>", "pixels",
        |f| f.contains(&Feature::Packed) && !f.contains(&Feature::Records), None;
    /// The words are rows of groups of 16 pixels, filled up: of each group twelve with red, green, blue of one pixel
    /// after the other, from the lowest byte up. Behind all rows a word for each group: a bit for each pixel, from the
    /// lowest up, that is set where the CPU has to decide.
    binding PIXELS, "pixels", WRITE, "Pixels", "pixels",
        |f| f.contains(&Feature::Packed) && f.contains(&Feature::Records), None;
    /// The words hold red, green, blue from the lowest byte up, and in the highest UNDECIDED where the CPU has to
    /// decide.
    binding PIXELS, "pixels", WRITE, "Pixels", "pixels", |f| f.contains(&Feature::Records) && !others(f), None;
    /// Red, green, blue from the lowest byte up, and in the highest UNDECIDED where the CPU has to decide, else 0.
    binding PIXELS, "pixels", WRITE, "array<u32>", "pixels", |f| !f.contains(&Feature::Records) && !others(f), None;
    /// One for each object of the scene, in file order; after them, if there are any, come the tables that
    /// `index_table` reads.
    binding 2, "objects", READ, "array<Object>", "objects", |f| f.contains(&Feature::AmbientOnly), Some(|p| records(objects(p)));
    /// One for each object of the scene, in file order; after them, if there are any, come the tables that
    /// `index_table` reads, and the third sides of triangles, which `third_side` reads.
    binding 2, "objects", READ, "array<Object>", "objects", |f| f.contains(&Feature::Lit), Some(|p| records(lit_objects(p)));
    binding 3, "planes", READ, "array<Plane>", "planes",
        |f| f.contains(&Feature::PlaneLoop), Some(|p| records(&p.planes));
    binding 4, "polygons", READ, "array<Polygon>", "finite planes",
        |f| f.contains(&Feature::PolygonLoop) || f.contains(&Feature::GridTriangles), Some(|p| records(&p.polygons));
    binding 5, "spheres", READ, "array<Sphere>", "spheres",
        |f| f.contains(&Feature::SphereBuffer) && !f.contains(&Feature::SpherePoint), Some(|p| records(&p.spheres));
    binding 5, "spheres", READ, "array<SphereAndHit>", "spheres",
        |f| f.contains(&Feature::SpherePoint), Some(|p| records(p.sphere_records()));
    /// Where the list of each cell of the screen starts here, by rows from the bottom left, and where the last one
    /// ends; then the lists: indices into `spheres`, the nearest first.
    binding 6, "screen_grid", READ, "array<u32>", "lists of spheres by tiles of the screen",
        |f| f.contains(&Feature::ScreenGrid), Some(|p| words(p.cell_lists()));
    binding 7, "bvh", READ, "array<BvhNode>", "tree nodes", |f| f.contains(&Feature::Bvh), Some(|p| records(&p.bvh));
    binding 8, "tiled_planes", READ, "array<Tiled>", "tiled planes",
        |f| f.contains(&Feature::Tiled), Some(|p| records(&p.tiled_planes));
    binding 9, "pplanes", READ, "array<Pplane>", "procedural planes",
        |f| f.contains(&Feature::Pplane), Some(|p| records(&p.pplanes));
    binding 10, "texplanes", READ, "array<Texplane>", "texplanes",
        |f| f.contains(&Feature::Textured), Some(|p| records(&p.texplanes));
    /// Red, green, blue from the lowest byte up; all textures one after the other, bottom rows first.
    binding 11, "texels", READ, "array<u32>", "texels", |f| f.contains(&Feature::Texels), Some(|p| words(&p.texels));
    binding 12, "materials", READ, "array<Material>", "materials",
        |f| f.contains(&Feature::Lit), Some(|p| of_lit(p, |lit| &lit.materials));
    binding 13, "lights", READ, "array<Light>", "lights",
        |f| f.contains(&Feature::Lit), Some(|p| of_lit(p, |lit| &lit.lights));
    /// The planes, rectangles and triangles for rays from anywhere; each object of the scene knows its place here or
    /// among the spheres.
    binding 14, "world_planes", READ, "array<WorldPlane>", "planes for all rays",
        |f| f.contains(&Feature::WorldPlanes), Some(|p| of_lit(p, |lit| &lit.planes));
    binding 15, "world_spheres", READ, "array<WorldSphere>", "spheres for all rays",
        |f| f.contains(&Feature::WorldSpheres), Some(|p| of_lit(p, |lit| &lit.spheres));
    binding 17, "projectors", READ, "array<Projector>", "projectors",
        |f| f.contains(&Feature::Projector), Some(|p| of_lit(p, |lit| &lit.projectors));
    binding 18, "quadrics", READ, "array<Quadric>", "quadrics",
        |f| f.contains(&Feature::QuadricBuffer), Some(|p| records(&p.quadrics));
    /// The offsets of the samples in their pixels: those of a pixel together, pixels as in `pixels`.
    binding OFFSETS, "offsets", READ, "array<vec2f>", "offsets of samples", |f| f.contains(&Feature::Course), None;
}

/// The declarations of the bindings that these features ask for.
pub fn declarations(features: &Features) -> String {
    let mut text = String::new();
    for binding in BINDINGS.iter().filter(|binding| (binding.holds)(features)) {
        for line in binding.doc {
            writeln!(text, "//{line}").unwrap_or_default();
        }
        let Binding {
            number,
            name,
            access,
            wgsl,
            ..
        } = binding;
        writeln!(
            text,
            "@group(0) @binding({number}) var<{access}> {name}: {wgsl};"
        )
        .unwrap_or_default();
    }
    text
}
