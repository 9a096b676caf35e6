//! The shader for exactly one scene: its records and its text. Nothing here knows wgpu.
//!
//! In the order of the flow: [`pack`] rounds the prepared scene to f32 [`records`], with [`bounds`] of their errors;
//! [`feature_set`] says which [`feature`]s of `shaders/` that asks for, [`binding`] what the shader is bound to,
//! [`compose`] writes the WGSL. [`describe`] prints each stage. [`record`] is what makes a list of fields a record,
//! [`kind`] tells kinds of surface apart, [`literal`] writes numbers.

pub mod binding;
pub mod bounds;
pub mod compose;
pub mod constants;
pub mod describe;
pub mod double;
pub mod feature;
pub mod feature_set;
pub mod field;
pub mod form;
pub mod format;
pub mod kind;
pub mod literal;
pub mod pack;
pub mod preprocess;
pub mod record;
pub mod records;
