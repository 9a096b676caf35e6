//! `plumb check`: every error of every scene file; reads and checks, and touches no GPU.

use std::path::{Path, PathBuf};

use anyhow::Result;
use plumb::diagnostic::visible_text;
use plumb::probe::digits::count;
use plumb::render::Settings;
use plumb::scene::{LoadError, Scene};
use serde_json::{Value, json};

use super::{Answer, say, source};

/// What `plumb check` takes.
#[derive(Debug, clap::Args)]
#[command(after_help = "\
Every error of every file is told, with its place and what would mend it. Good files are listed on stdout, and behind \
several files how many are good and bad; errors go to stderr; exit 2 if any file is bad. --json lists both on stdout.")]
pub(crate) struct Args {
    /// Scene files; `-` is stdin
    #[arg(required = true, value_name = "SCENE")]
    scenes: Vec<PathBuf>,
    /// Print one JSON array on stdout, an object for each file
    #[arg(long)]
    json: bool,
}

/// Checks the files one after the other.
pub(crate) fn run(args: &Args) -> Result<Answer> {
    let mut reports = Vec::new();
    let mut bad = 0;
    let mut after_errors = false;
    for (place, path) in args.scenes.iter().enumerate() {
        let name = source::name(path);
        let loaded = load(path);
        bad += usize::from(loaded.is_err());
        if args.json {
            reports.push(report(&name, &loaded));
            continue;
        }
        // What is wrong with a file takes several lines, which an empty one tells from those of the next.
        if after_errors || (loaded.is_err() && place > 0) {
            say::talk("\n");
        }
        after_errors = loaded.is_err();
        match loaded {
            Ok((scene, remarks)) => {
                let mut lines = vec![format!("{name}: ok ({})", summary(&scene))];
                lines.extend(remarks.iter().map(|remark| format!("  note: {remark}")));
                for line in lines {
                    // Names of files and materials hold what they like.
                    say::data(&format!("{}\n", visible_text(&line)))?;
                }
            }
            Err(error) => say::error(&error),
        }
    }
    if args.json {
        say::data(&format!("{:#}\n", Value::Array(reports)))?;
    } else if args.scenes.len() > 1 {
        if after_errors {
            say::talk("\n");
        }
        let (files, good) = (args.scenes.len(), args.scenes.len() - bad);
        say::data(&format!("{files} files: {good} good, {bad} bad\n"))?;
    }
    if bad == 0 {
        Ok(Answer::Yes)
    } else {
        Ok(Answer::Bad)
    }
}

/// A scene, and what may surprise in its picture.
fn load(path: &Path) -> Result<(Scene, Vec<String>)> {
    let (scene, text) = source::load_with_text(path)?;
    let tolerance = Settings::default().screen_tolerance;
    let remarks = source::remarks(&scene, &text, tolerance);
    Ok((scene, remarks))
}

/// `3 objects, 0 lights, 640×480`.
fn summary(scene: &Scene) -> String {
    let [width, height] = scene.camera.pixeldim;
    let (objects, lights) = (
        count(scene.objects.len(), "object"),
        count(scene.lights.len(), "light"),
    );
    format!("{objects}, {lights}, {width}×{height}")
}

/// One file's entry in the array.
fn report(name: &str, loaded: &Result<(Scene, Vec<String>)>) -> Value {
    match loaded {
        Ok((scene, remarks)) => json!({
            "file": name,
            "ok": true,
            "objects": scene.objects.len(),
            "lights": scene.lights.len(),
            "materials": scene.materials.len(),
            "textures": scene.textures.len(),
            "pixeldim": scene.camera.pixeldim,
            "notes": remarks,
            "errors": [],
        }),
        Err(error) => {
            let errors = match error.downcast_ref::<LoadError>() {
                Some(LoadError::Scene(diagnostics)) => diagnostics.to_json(),
                // The file could not be read, so the message has no place in it.
                _ => json!([{
                    "file": name,
                    "line": null,
                    "column": null,
                    "message": say::causes(error),
                    "help": null,
                }]),
            };
            json!({ "file": name, "ok": false, "errors": errors })
        }
    }
}
