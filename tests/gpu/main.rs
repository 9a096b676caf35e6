//! What the GPU computes, beside the CPU, beside another driver, and against what its bounds promise. Without an
//! adapter all of these tests fail; `sh scripts/test.sh` sees to one.

#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

mod bands;
#[path = "../common/mod.rs"]
mod common;
#[cfg(target_os = "linux")]
mod drivers;
mod gpu_bounds;
mod gpu_vs_cpu;
mod limits;
mod live;
mod vectors_gpu;
