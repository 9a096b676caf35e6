//! The scene language: from a file, a stream or code to a [`Scene`] that keeps every limit, and back to a listing.
//!
//! ```text
//! file ─ load ─ bytes ─ encoding, lex ─ parse, values (by the rows of table), check ─ draft ─► Scene ─ listing ─► text
//!                                       build (a scene built in code) ────────────────┘
//! ```
//!
//! Beside it, `places` tells where in the text what is in the scene stands.

mod attributes;
mod build;
mod bulk;
mod bytes;
mod check;
mod common_mistakes;
mod draft;
mod encoding;
mod errors;
mod kind;
mod lex;
mod limit;
mod listing;
mod load;
pub mod model;
mod names;
mod number;
mod numbers;
mod parse;
mod parser;
mod places;
mod recover;
mod remarks;
pub mod table;
#[cfg(test)]
mod tests;
mod texture;
pub(crate) mod triangle;
mod values;

pub(crate) use attributes::{fault, put};
pub(crate) use numbers::MOST_NUMBERS;
pub(crate) use parse::parse_text;
pub(crate) use places::number_at;

pub use attributes::{Bounds, NumberRow, Quantity, number_rows, numbers_of};
pub use build::{BuildError, BuildErrors, MaterialId, SceneBuilder, TextureId};
pub use listing::list_model;
#[cfg(feature = "preview")]
pub(crate) use load::read_file;
pub use load::{LoadError, MAX_FILE, load, load_from, load_from_with_text, load_with_text};
pub use model::{
    Beam, Camera, Cone, Extent, Light, Material, Object, ProjectorPicture, Quadric, Rectangle,
    Scene, Shape, Surface, Texels, Texture, TextureMode, Triangle,
};
pub use parse::parse;
pub use places::{EntityId, Given, Place, Places, line, places};
pub use remarks::{lines_of, remarks};
pub use table::{MAX_PIXELDIM, PPLANE_SHADERS, PSPHERE_SHADERS};
