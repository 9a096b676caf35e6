//! From WGSL to Rust: the functions of `shaders/` for the lanes of a vector of the processor, as text that is checked
//! in (`text.rs` in `certify/lanes/ambient`, `lit` and `lit_double`). So one text says what a GPU computes and what the
//! CPU does in f32, and in f64 for lit scenes.
//!
//! [`module`] reads naga's IR of a composed shader. Numbers that all lanes share are told from those of each lane in
//! [`kinds`]. [`expression`], [`place`], [`operator`], [`call`] and [`statement`] write them, [`variables`] says where
//! variables belong to, [`control`] makes masks of branches and loops, [`signature`] says what functions and structs
//! look like. [`texts`] has what the lowering is told and writes a text as a whole; [`upkeep`] has the shaders, and the
//! test that says when what is checked in is out of date. What has no meaning for lanes is an error that names the
//! function.
//! Premises: docs/NUMERICS.md, "The same on the CPU".

mod call;
mod control;
mod expression;
mod kinds;
mod module;
mod operator;
mod place;
mod signature;
mod statement;
mod tests;
mod texts;
mod upkeep;
mod variables;
