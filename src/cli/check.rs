//! `plumb check`: every error of every scene file; reads and checks, and touches no GPU.

use std::path::PathBuf;

use anyhow::Result;
use plumb::probe::digits::count;
use plumb::scene::{LoadError, Scene, remarks};
use serde_json::{Value, json};

use super::{Answer, say, source};

/// What `plumb check` takes.
#[derive(Debug, clap::Args)]
#[command(after_help = "\
Every error of every file is told, with its place and what would mend it. Good files are listed on stdout, errors go \
to stderr; exit 2 if any file is bad. --json lists both on stdout.")]
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
    for path in &args.scenes {
        let name = source::name(path);
        let loaded = source::load(path);
        bad += usize::from(loaded.is_err());
        if args.json {
            reports.push(report(&name, &loaded));
            continue;
        }
        match loaded {
            Ok(scene) => {
                say::data(&format!("{name}: ok ({})\n", summary(&scene)))?;
                for remark in remarks(&scene) {
                    say::data(&format!("  note: {remark}\n"))?;
                }
            }
            Err(error) => say::error(&error),
        }
    }
    if args.json {
        say::data(&format!("{:#}\n", Value::Array(reports)))?;
    }
    if bad == 0 {
        Ok(Answer::Yes)
    } else {
        Ok(Answer::Bad)
    }
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
fn report(name: &str, loaded: &Result<Scene>) -> Value {
    match loaded {
        Ok(scene) => json!({
            "file": name,
            "ok": true,
            "objects": scene.objects.len(),
            "lights": scene.lights.len(),
            "materials": scene.materials.len(),
            "textures": scene.textures.len(),
            "pixeldim": scene.camera.pixeldim,
            "notes": remarks(scene),
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
