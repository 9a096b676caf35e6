//! What the library says and computes without a GPU: the texts of complaints, the notes' known answers, pictures in
//! files, and shaders as texts.

#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

mod boxes;
#[path = "../common/mod.rs"]
mod common;
mod image_output;
mod known_answers;
mod listing;
mod other_shaders;
mod premises;
mod quadrics;
mod scene_errors;
mod scene_fuzz;
mod shaders;
mod stages;
mod vectors;
