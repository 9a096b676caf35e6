//! The window of `plumb preview` as a user meets it: a real one on a display of its own, with keys and mouse, seen by
//! screenshots.
//!
//! ```text
//! x11::Display: Xvfb ─ x11::Window: pixels, title, keys, mouse ─ program::Program: a process with a window, waited for
//! ```

#![cfg(target_os = "linux")]
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

mod clipboard;
#[path = "../common/mod.rs"]
mod common;
mod edits;
mod follows;
mod hands;
mod harness;
mod monkey;
mod opening;
mod panels;
mod program;
mod shots;
mod times;
mod window;
mod x11;
