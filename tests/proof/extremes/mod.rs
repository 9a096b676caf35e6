//! Scenes of extreme numbers against the oracle, on the CPU and the GPU: from the least subnormal to 10^300, mixed in
//! one scene; chains of mirrors and panes, thin gaps, the course's jitter, spotlights near 0 and 180 degrees.
//!
//! `faults` has one scene for each way in which such numbers once made a wrong byte; `random` makes thousands, and
//! `drivers` shows some to a second driver; `same` needs no oracle: what must not change a picture does not.
mod chance;
mod drivers;
mod faults;
mod kinds;
mod lamps;
mod random;
mod same;
mod trees;
mod work;

use crate::common;
use plumb::render::{Backend, Settings, render};
use plumb::scene::{Scene, parse};

/// A scene from its text.
fn scene(text: &str) -> Scene {
    parse("extreme", text.as_bytes(), &common::scenes())
        .unwrap_or_else(|error| panic!("{error}\n{text}"))
}

fn cpu() -> Settings {
    common::on(Backend::Cpu)
}

/// The picture of a scene by the CPU, or why there is none.
fn picture(scene: &Scene, settings: &Settings) -> Result<Vec<u8>, String> {
    let mut rgb = Vec::new();
    render(scene, settings, &mut |band| {
        rgb.extend_from_slice(&band.rgb);
        Ok(())
    })
    .map_err(|error| error.to_string())?;
    Ok(rgb)
}
