//! The certificate held to: every byte against an oracle that shares nothing with plumb but the parsed scene. Half of
//! these tests need an adapter, and fail without one.
//!
//! ```text
//! scenes of ours (certified), random ones (random_scenes) ─► oracle, itself tested (oracle_numbers) ─► 0 differing bytes
//! ```

#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

mod certified;
#[path = "../common/mod.rs"]
mod common;
mod doubles;
mod extremes;
mod oracle;
mod oracle_numbers;
mod random_scenes;
