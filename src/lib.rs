//! plumb: a ray tracer on the GPU for the scene language of a university course.
//!
//! The modules, in the order in which data flows through them:
//!
//! ```text
//! scene text ── scene ─► Scene ── prepare ─► Prepared    decided exactly, then rounded
//!                                     │
//!                    ┌────────────────┴────────┐
//!                 shader: records, WGSL       cpu: the referee, over any number type
//!                    │                         │
//!                   gpu ── verdicts ──► certify: doubtful pixels, and some of the sure ones
//!                                         │
//!                                      render: bands of rows ─► image: PPM, PNG, EXR
//! ```
//!
//! [`edit`] stands beside the first line: changes on top of a scene, and into its text.
//!
//! [`render::render`] runs the whole of it, [`mod@bench`] measures it, [`probe`] explains a pixel of it, `preview`
//! shows it in a window; `src/cli/` only turns arguments into such calls.

pub mod bench;
pub mod certify;
pub mod cores;
pub mod cpu;
pub mod diagnostic;
pub mod edit;
pub mod files;
pub mod frame;
pub mod gpu;
pub mod image;
pub mod jitter;
#[cfg(test)]
mod lower;
pub mod parts;
mod ppm;
pub mod prepare;
#[cfg(feature = "preview")]
pub mod preview;
pub mod probe;
pub mod procedural;
pub mod real;
pub mod render;
pub mod scene;
pub mod settings;
pub mod shader;
pub mod stopwatch;
pub mod vector;
