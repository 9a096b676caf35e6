//! The program as it is used: what it reads, what it prints where, which exit code it ends with, what it leaves behind.

#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

mod bad_light;
mod basics;
mod bench;
mod certified;
#[cfg(target_os = "linux")]
mod cluster;
mod desk;
mod endings;
mod errors;
#[cfg(target_os = "linux")]
mod examples;
mod files;
mod gpu;
mod inspect;
mod lit;
mod many;
mod options;
mod parts;
#[cfg(unix)]
mod resume;
#[cfg(target_os = "linux")]
mod slurm;
