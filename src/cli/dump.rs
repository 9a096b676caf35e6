//! `plumb dump`: a scene at one of the stations on its way from text to the GPU. Opens no device.

use std::path::PathBuf;

use anyhow::Result;
use clap::ValueEnum;
use plumb::scene::list_model;
use plumb::shader::describe;

use super::args::PictureOptions;
use super::{Answer, say, source};

/// What `plumb dump` takes.
#[derive(Debug, clap::Args)]
pub(crate) struct Args {
    /// The scene file; `-` is stdin
    scene: PathBuf,
    /// Where to look
    #[arg(long, value_name = "STAGE", value_enum, default_value_t)]
    stage: Stage,
    #[command(flatten)]
    picture: PictureOptions,
}

/// The stations, in the order of the flow.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, ValueEnum)]
enum Stage {
    /// The model as it was read, in the notes' listing
    #[default]
    Model,
    /// Which parts of the shader the scene needs
    Features,
    /// The records that are uploaded
    Buffers,
    /// The shader, composed for this scene
    Wgsl,
}

/// Prints the stage.
pub(crate) fn run(args: &Args) -> Result<Answer> {
    let mut scene = source::load(&args.scene)?;
    args.picture.apply(&mut scene);
    let settings = args.picture.settings();
    match args.stage {
        Stage::Model => say::stream(|to| list_model(&scene, to))?,
        Stage::Features => say::data(&describe::features(&scene, &settings))?,
        Stage::Buffers => say::data(&describe::buffers(&scene, &settings))?,
        Stage::Wgsl => say::data(&describe::wgsl(&scene, &settings))?,
    }
    Ok(Answer::Yes)
}
