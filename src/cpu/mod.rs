//! The tracer on the CPU, over any [`Real`](crate::real::Real): file by file and function by function the twin of `shaders/`.
//!
//! Runs on a [`Prepared`](crate::prepare::Prepared) scene; `render` calls it for whole bands, `probe` and `--debug` for single pixels.

pub mod bvh;
pub mod camera;
pub mod debug;
pub mod hit_point;
pub mod light;
pub mod pixel;
pub mod plane;
pub mod procedural;
pub mod sphere;
pub mod surface;
pub mod trace;
pub mod watch;
pub mod world;
