//! The built-in procedural shaders, called by number: of each its name, its WGSL, how bright it can be, and a second
//! version in Rust over any number type, which decides what the WGSL leaves in doubt.
//!
//! Stands below the scene's parser, which takes its numbers' limit from here, below the CPU's tracer and below the text
//! of the shader. The table is made by `build.rs` from the list of `shaders/procedural/`: adding a shader is adding
//! `shaders/procedural/pplane_3_name.wgsl` and `src/procedural/pplane_3_name.rs`, each with a function `pplane_3_name`;
//! the latter also with `brightest`. A gap in the numbers or a missing file fails the build.

mod color_wheel;
#[cfg(test)]
mod tests;

use std::collections::BTreeSet;

use crate::real::{Real, Undecided, V3};
use color_wheel::color_wheel;

/// What a procedural plane's shader is told about the hit.
pub trait PlanePoint<R: Real> {
    /// The material's ambient reflectivity.
    fn ambient(&self) -> V3<R>;

    /// Parity of floor(2·H.x + 1000), floor(2·H.y + 1000) or floor(2·H.z + 1000): 0 or 1.
    ///
    /// # Errors
    /// If the number type cannot tell the floor.
    fn odd(&self, axis: usize) -> Result<u32, Undecided>;

    /// Components x and y of H − point, in world units.
    fn offset_from_point(&self) -> [R; 2];
}

/// What a procedural sphere's shader is told about the hit.
#[derive(Debug, Clone, Copy)]
pub struct SpherePoint<R> {
    /// H − center, in units of 2^scale.
    pub from_center: V3<R>,
    /// The material's ambient reflectivity.
    pub ambient: V3<R>,
}

/// A built-in shader.
#[derive(Debug, Clone, Copy)]
pub struct Shader {
    /// Its name, which is its function's in WGSL.
    pub name: &'static str,
    /// Its WGSL.
    pub wgsl: &'static str,
    /// The brightest channel that it gives, for a material whose brightest ambient channel is this. What is farther
    /// away than where that becomes a byte of 0 is black for certain.
    pub brightest: fn(f64) -> f64,
}

impl Shader {
    /// What it is in a word, which ends its name: `tiles`.
    pub fn word(&self) -> &'static str {
        self.name.rsplit('_').next().unwrap_or_default()
    }
}

/// A family of shaders, numbered from 0.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Family {
    /// Of planes.
    Pplane,
    /// Of spheres.
    Psphere,
}

impl Family {
    /// Its shaders, by number.
    pub fn shaders(self) -> &'static [Shader] {
        match self {
            Self::Pplane => PPLANE,
            Self::Psphere => PSPHERE,
        }
    }
}

/// Shaders of a family by number, and those that they call, in the order of their numbers.
pub fn with_called(family: Family, used: BTreeSet<u32>) -> Vec<&'static Shader> {
    let table = family.shaders();
    let mut chosen: BTreeSet<usize> = used.into_iter().map(|n| n as usize).collect();
    let calls =
        |a: usize, b: usize| a != b && table[a].wgsl.contains(&format!("{}(", table[b].name));
    loop {
        let called: Vec<usize> = (0..table.len())
            .filter(|&i| !chosen.contains(&i) && chosen.iter().any(|&c| calls(c, i)))
            .collect();
        if called.is_empty() {
            return chosen.into_iter().map(|i| &table[i]).collect();
        }
        chosen.extend(called);
    }
}

/// Whether a shader, or one that it calls, names `helper`.
pub fn asks(family: Family, shader: u32, helper: &str) -> bool {
    with_called(family, BTreeSet::from([shader]))
        .iter()
        .any(|shader| shader.wgsl.contains(helper))
}

include!(concat!(env!("OUT_DIR"), "/procedural.rs"));
