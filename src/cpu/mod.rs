//! The reference tracer on the CPU, over any [`Real`](crate::real::Real): the independent referee of what `shaders/`
//! compute.
//!
//! It decides what f32 leaves in doubt, and computes again some of what f32 is sure of ([`certify`](crate::certify)).
//! So it must share no formula with what it checks: a mistake that stood in both would never show. A function that
//! answers the same question as one in `shaders/` has its name (`plane_hits`, `getdiff`, `light_term`), and comes to
//! the answer by a way of its own, from docs/SCENE.md: whoever changes one of the two has nothing to carry over to the
//! other. Both start from [`Prepared`](crate::prepare::Prepared), which is exact or knows its errors, and is the same
//! for both.
//!
//! Twins, which do share their formulas and are changed together, are the WGSL and
//! [`certify::lanes`](crate::certify::lanes).
//!
//! `render` calls it for whole bands, `probe` and `--debug` for single pixels.

pub mod bvh;
pub mod camera;
pub mod debug;
pub mod fault;
pub mod hit_point;
pub mod light;
pub mod observer;
pub mod pixel;
pub mod plane;
pub mod quadric;
mod sample;
pub mod sphere;
pub mod surface;
pub mod trace;
mod tree;
mod waiting;
pub mod world;
