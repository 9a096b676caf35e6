//! Changes on top of a scene file, and how they get into its text: what lies below sliders and a dragged viewpoint.
//!
//! ```text
//! scene text ── scene::parse ──► Scene ── Changes::apply ──► Scene as it is shown
//!      │                           │
//!      │                         Changes ◄── rebase: the file was edited elsewhere
//!      └───────────────────────────┴──── Changes::write ──► the same text with other numbers
//! ```
//!
//! [`Changes`] holds what differs from the file; [`Changes::set`] is the one place where a value is held against the
//! limits of the scene language, so that a changed scene keeps them all.

mod changes;
mod rebase;
mod spell;
mod target;
#[cfg(test)]
mod tests;
mod write;

pub use changes::{Changes, Refused};
pub use rebase::Dropped;
pub use spell::camera_block;
pub use target::{Target, Value};
pub use write::EditError;
