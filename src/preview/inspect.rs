//! The thread that explains pixels, as `plumb probe` does, and finds out which object each pixel shows.
//!
//! Between the window, which asks, and `probe`. The newest question wins.

use std::sync::Arc;
use std::thread::JoinHandle;

use rayon::prelude::*;

use super::latest::{LatestReceiver, LatestSender, latest};
use super::priority;
use super::rendering::Rendering;
use crate::cpu::camera::camera_getdir;
use crate::cpu::trace::find_closest_object;
use crate::gpu::device::Gpu;
use crate::prepare::Prepared;
use crate::probe::{self, AskGpu, Probe};
use crate::scene::{Places, Scene, lines_of, remarks};
use crate::settings::Settings;

/// What the window wants to know of a picture.
#[derive(Debug, Clone)]
pub(super) struct Question {
    /// The number of the picture's wish.
    pub(super) number: u64,
    /// The scene that it shows.
    pub(super) scene: Arc<Scene>,
    /// How it is rendered.
    pub(super) rendering: Rendering,
    /// What to call it.
    pub(super) name: String,
    /// A pixel to be explained: column, and row from the bottom.
    pub(super) pixel: Option<[u32; 2]>,
    /// Whether the picture is one that stays for a moment.
    pub(super) still: bool,
    /// Whether that pixel was clicked, and what it shows is to be selected.
    pub(super) clicked: bool,
    /// Whether to find out what all pixels show.
    pub(super) objects: bool,
    /// Whether to say what may surprise: the text that the scene comes from, and where everything stands there.
    pub(super) remarks: Option<(Arc<Vec<u8>>, Arc<Places>)>,
}

/// What it is told.
#[derive(Debug)]
pub(super) enum Answer {
    /// A pixel, explained.
    Pixel {
        number: u64,
        pixel: [u32; 2],
        text: String,
    },
    /// Which object a pixel that was clicked shows, if any.
    Clicked {
        pixel: [u32; 2],
        object: Option<usize>,
    },
    /// What may surprise in the picture, by a text.
    Remarks {
        number: u64,
        of: Arc<Vec<u8>>,
        remarks: Vec<String>,
    },
    /// What all pixels show: numbers of objects from 1, 0 is nothing; rows from the top.
    Objects {
        number: u64,
        size: [u32; 2],
        objects: Vec<u32>,
    },
}

/// The thread, as the window has it. Dropped, it ends soon.
#[derive(Debug)]
pub(super) struct Inspector {
    questions: Option<LatestSender<Question>>,
    thread: Option<JoinHandle<()>>,
}

impl Inspector {
    /// Starts it. `tell` is called on its thread.
    ///
    /// # Errors
    /// If the thread cannot be started.
    pub(super) fn new(
        gpu: Arc<Gpu>,
        settings: Settings,
        mut tell: impl FnMut(Answer) + Send + 'static,
    ) -> std::io::Result<Self> {
        let (questions, receiver) = latest::<Question>();
        let thread = std::thread::Builder::new()
            .name("inspect".into())
            .spawn(move || {
                priority::lower();
                let mut next = receiver.take();
                while let Some(question) = next {
                    next = about(&gpu, &settings, &receiver, question, &mut tell);
                }
            })?;
        Ok(Self {
            questions: Some(questions),
            thread: Some(thread),
        })
    }

    /// Asks; what was asked before is forgotten, unless it is being answered.
    pub(super) fn ask(&self, question: Question) {
        if let Some(questions) = &self.questions {
            questions.put(question);
        }
    }

    /// Waits until it does not use the device any more. The gate for submissions has to be open, since it may wait
    /// there.
    pub(super) fn end(&mut self) {
        self.questions = None;
        if let Some(thread) = self.thread.take() {
            // A panic of the thread was printed when it happened.
            let _ = thread.join();
        }
    }
}

impl Drop for Inspector {
    fn drop(&mut self) {
        self.end();
    }
}

/// Answers questions about one scene, the first of which was taken; returns the first about another one, if there is
/// one.
fn about(
    gpu: &Gpu,
    settings: &Settings,
    receiver: &LatestReceiver<Question>,
    (mut number, mut question): (u64, Question),
    tell: &mut impl FnMut(Answer),
) -> Option<(u64, Question)> {
    let scene = Arc::clone(&question.scene);
    let rendering = question.rendering;
    let settings = &rendering.over(settings);
    let probe = Probe::new(&scene, settings, Ok(gpu));
    loop {
        if let (Some(pixel), true) = (question.pixel, question.clicked) {
            let object = object_at(&scene, settings, pixel);
            tell(Answer::Clicked { pixel, object });
        }
        if let Some(pixel) = question.pixel {
            let options = probe::Options {
                // Its shader is compiled for the scene: not while that changes many times a second.
                gpu: if question.still {
                    AskGpu::Value
                } else {
                    AskGpu::Nothing
                },
                ..probe::Options::default()
            };
            tell(Answer::Pixel {
                number: question.number,
                pixel,
                text: explain(&probe, &question.name, pixel, options),
            });
        }
        if let Some((text, places)) = question.remarks.take() {
            let lines = lines_of(&text, &places);
            let remarks = remarks(&scene, settings.screen_tolerance, &lines);
            tell(Answer::Remarks {
                number: question.number,
                of: Arc::clone(&text),
                remarks,
            });
        }
        if question.objects
            && let Some(objects) = objects(&scene, settings, || receiver.is_old(number))
        {
            tell(Answer::Objects {
                number: question.number,
                size: scene.camera.pixeldim,
                objects,
            });
        }
        (number, question) = receiver.take()?;
        if !Arc::ptr_eq(&question.scene, &scene) || question.rendering != rendering {
            return Some((number, question));
        }
    }
}

/// What `plumb probe` prints, less the name of the scene.
fn explain(probe: &Probe<'_>, name: &str, pixel: [u32; 2], options: probe::Options) -> String {
    let mut text = Vec::new();
    let ended = probe.write(name, pixel, options, &mut text);
    let mut text = String::from_utf8_lossy(&text).into_owned();
    match ended {
        Ok(Ok(())) => {}
        // What could be told comes first.
        Ok(Err(why)) => text.push_str(&format!("{why}\n")),
        Err(why) => text.push_str(&format!("{why}\n")),
    }
    text
}

/// The object that a pixel shows, as f64 has it.
fn object_at(scene: &Scene, settings: &Settings, [x, y]: [u32; 2]) -> Option<usize> {
    let prepared = Prepared::<f64>::new(scene, settings.view());
    let ray = camera_getdir(&prepared.camera, f64::from(x), f64::from(y));
    let hit = find_closest_object(&prepared, &ray).ok().flatten();
    hit.map(|hit| hit.object)
}

/// What each pixel of the scene's picture shows, as f64 has it: numbers of objects from 1, 0 is nothing; rows from the
/// top. None if it is to be given up.
fn objects(scene: &Scene, settings: &Settings, stop: impl Fn() -> bool + Sync) -> Option<Vec<u32>> {
    let prepared = Prepared::<f64>::new(scene, settings.view());
    let [width, height] = scene.camera.pixeldim;
    let mut objects = vec![0; width as usize * height as usize];
    let rows = objects.par_chunks_mut(width as usize);
    rows.enumerate()
        .try_for_each(|(row, line)| {
            if stop() {
                return None;
            }
            let y = f64::from(height - 1 - row as u32);
            for (x, object) in line.iter_mut().enumerate() {
                let ray = camera_getdir(&prepared.camera, x as f64, y);
                // f64 decides everything, if not always rightly.
                let hit = find_closest_object(&prepared, &ray).ok().flatten();
                *object = hit.map_or(0, |hit| hit.object as u32 + 1);
            }
            Some(())
        })
        .map(|()| objects)
}
