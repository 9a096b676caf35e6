//! Saves the picture that is shown, certified, beside the window: the same file that `plumb render` writes.

use std::path::PathBuf;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use crate::edit::Changes;
use crate::gpu::device::Gpu;
use crate::image::{Format, Metadata, Output, Target};
use crate::render::{self, Backend, Live, Precision, Settings, render_live};
use crate::scene::Scene;

/// A picture to be saved.
pub(super) struct SaveTask {
    /// The device, if the GPU is to render.
    pub(super) gpu: Arc<Gpu>,
    /// The scene, and what is changed on top of it.
    pub(super) scene: Arc<Scene>,
    pub(super) changes: Changes,
    pub(super) settings: Settings,
    /// The scene's file.
    pub(super) file: PathBuf,
    /// The picture's.
    pub(super) to: PathBuf,
    pub(super) software: &'static str,
    /// Set once nobody wants the picture any more.
    pub(super) stop: Arc<AtomicBool>,
}

impl SaveTask {
    /// Renders and writes. What was done, or why not, in a sentence.
    pub(super) fn run(&self) -> Result<String, String> {
        self.save()
            .map_err(|why| format!("not saved: {why}"))
            .map(|sha256| {
                let name = self.to.display();
                format!(
                    "saved {name}, certified; SHA-256 of its bytes {}…",
                    &sha256[..16]
                )
            })
    }

    fn save(&self) -> Result<String, String> {
        let format = Format::from_path(&self.to).map_err(|error| error.to_string())?;
        let scene = self.changes.apply(&self.scene);
        if let Some(what) = scene.is_made_from(Some(&self.file), &self.to) {
            return Err(format!("{} is {what}", self.to.display()));
        }
        let mut settings = Settings {
            precision: Precision::Certified,
            backend: Backend::Auto,
            values: format.wants_values(),
            verdicts: false,
            ..self.settings.clone()
        };
        loop {
            match self.write(&scene, format, &settings)? {
                Some(sha256) => return Ok(sha256),
                None => settings.backend = Backend::Cpu,
            }
        }
    }

    /// None if the GPU was wrong, and the CPU has to begin anew.
    fn write(
        &self,
        scene: &Scene,
        format: Format,
        settings: &Settings,
    ) -> Result<Option<String>, String> {
        let [width, height] = scene.camera.pixeldim;
        let name = self.file.file_name().unwrap_or(self.file.as_os_str());
        let metadata = Metadata::of(self.software, &name.to_string_lossy(), scene, settings);
        let target = Target::Path(self.to.clone());
        let mut output = Output::open(target, format, width, height, metadata)
            .map_err(|error| error.to_string())?
            .hashing();
        let stop = || self.stop.load(Ordering::Relaxed);
        let live = Live {
            stop: &stop,
            ..Live::on(&self.gpu)
        };
        let rendered = render_live(scene, settings, &live, &mut |band| output.write(band));
        match rendered {
            Ok(_) => {
                let finished = output.finish().map_err(|error| error.to_string())?;
                Ok(Some(finished.sha256.unwrap_or_default()))
            }
            Err(render::Error::Revoked(_)) if settings.backend == Backend::Auto => Ok(None),
            Err(error) => Err(error.to_string()),
        }
    }
}
