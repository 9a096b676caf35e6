//! The procedural shaders' CPU twins, one file a shader, called by number.
//!
//! The table is made by `build.rs` from the list of `shaders/procedural/`: adding a shader is adding
//! `shaders/procedural/pplane_3_name.wgsl` and `src/cpu/procedural/pplane_3_name.rs`, each with a function
//! `pplane_3_name`. A gap in the numbers or a missing twin fails the build.

use super::surface::{PlanePoint, SpherePoint};
use crate::real::{Real, Undecided, V3};

include!(concat!(env!("OUT_DIR"), "/procedural.rs"));
