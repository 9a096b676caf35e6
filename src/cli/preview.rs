//! `plumb preview`: a scene in a window that follows its file. Without the feature `preview`: how to get it.

use std::path::PathBuf;

use anyhow::Result;
use clap::builder::NonEmptyStringValueParser;

use super::Answer;
use super::args::PictureOptions;

/// What `plumb preview` takes.
#[derive(Debug, clap::Args)]
#[command(after_long_help = "\
The window shows the picture that `plumb render` makes of the scene: at once in
fast precision, then, when nothing has moved for a moment, certified. Whenever
the file is written, the picture follows; a file with a mistake leaves the last
good picture, with the mistake over it.

  drag, wheel    move the viewpoint: x and y, z
  Ctrl+wheel     zoom, up to the bytes of single pixels
  click          select what is hit: its numbers, its lines, its handles
  Ctrl+Z, Ctrl+S undo (with Shift redo), save
  F1             all keys

What is changed in the window (any number of the scene) lies on top of the
file; Ctrl+S writes the numbers into the file and touches nothing else in it.
Closing asks before changes are lost.

EXAMPLES
  plumb preview                a page to open a scene from, or to begin one
  plumb preview scene.txt
  plumb preview scene.txt --size 1280x960 --samples 16")]
pub(crate) struct Args {
    /// The scene file; without, the window says how to come to one
    pub(crate) scene: Option<PathBuf>,
    #[command(flatten)]
    pub(crate) picture: PictureOptions,
    /// Part of the name of the GPU adapter to use, in any case of letters (see `plumb doctor`); without it
    /// PLUMB_ADAPTER says it
    #[arg(long, value_name = "PART", value_parser = NonEmptyStringValueParser::new())]
    pub(crate) adapter: Option<String>,
}

/// Shows the scene until the window is closed.
#[cfg(feature = "preview")]
pub(crate) fn run(args: &Args) -> Result<Answer> {
    use anyhow::bail;
    use plumb::preview::{Options, run};
    use plumb::render::Settings;

    use super::{SOFTWARE, cache, source};

    let usual = args.picture.size.unwrap_or([640, 480]);
    // What cannot be read now is told here, where it is asked for; mistakes in it are shown in the window.
    let room = match args.scene.as_deref().map(plumb::scene::load) {
        _ if args.scene.as_deref().is_some_and(source::is_stdin) => {
            bail!("a window follows a file, and stdin is none: save the scene, and name its file")
        }
        None => usual,
        Some(Ok(mut scene)) => {
            args.picture.apply(&mut scene);
            args.picture.check(&scene)?;
            scene.camera.pixeldim
        }
        Some(Err(plumb::scene::LoadError::Scene(_))) => usual,
        Some(Err(error)) => return Err(error.into()),
    };
    run(Options {
        path: args.scene.clone(),
        recent: cache::state().map(|folder| folder.join("recent")),
        size: args.picture.size,
        room,
        settings: Settings {
            adapter: args.adapter.clone(),
            cache: cache::folder(),
            ..args.picture.settings()
        },
        software: SOFTWARE,
    })?;
    Ok(Answer::Yes)
}

/// Says how to get the window.
#[cfg(not(feature = "preview"))]
pub(crate) fn run(_args: &Args) -> Result<Answer> {
    anyhow::bail!(
        "this plumb was built without its window: `cargo build --release --features preview` builds one with it \
         (it takes twice as long); `plumb render SCENE -o picture.png` makes the picture without a window"
    )
}
