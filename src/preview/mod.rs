//! `plumb preview`: a scene in a window that follows its file.
//!
//! ```text
//! watch ─ text ─► session ◄─ what the user changes ─ app: picture, side, inspector, status
//!                    │ scene + changes                   ▲
//!                    ▼                                   │
//!                 worker ─ render::render_live ─ canvas ─┴─ screen: drawn where it was made
//! ```
//!
//! Above `render`, `probe` and `edit`, which know nothing of it. Only compiled with the feature `preview`.

mod adaptive_resolution;
mod app;
mod arenas;
mod blit;
mod canvases;
mod chooser;
mod display;
mod draw;
mod entities;
mod handles;
mod hints;
mod input;
mod inspect;
mod inspector;
mod keys;
mod latest;
mod legend;
mod overlay;
mod painter;
mod panels;
mod picture;
mod priority;
mod progress;
mod properties;
mod recent;
mod rendering;
mod save;
mod scene_watch;
mod screen;
mod selection;
mod session;
mod shared_session;
mod shell;
mod side;
mod start;
mod status;
mod undo;
mod values;
mod viewport;
mod wanted;
mod watch;
mod worker;

use std::path::PathBuf;
use std::sync::{Arc, Mutex, PoisonError};

use eframe::egui;
use eframe::egui_wgpu;

use crate::cores;
use crate::gpu::GpuError;
use crate::gpu::adapters::{self, Opened};
use crate::gpu::device::Gpu;
use crate::settings::Settings;
use app::App;
use shell::Shell;
use winit::event_loop::EventLoop;

/// What to show.
#[derive(Debug, Clone)]
pub struct Options {
    /// The scene's file; without, the window says how to come to one.
    pub path: Option<PathBuf>,
    /// The file that keeps which scenes were opened last.
    pub recent: Option<PathBuf>,
    /// Columns and rows of the picture, in place of the file's.
    pub size: Option<[u32; 2]>,
    /// Columns and rows that the window has room for at first.
    pub room: [u32; 2],
    /// How it is rendered; precision, backend, rows, values and verdicts are the window's own affair.
    pub settings: Settings,
    /// What saved pictures name as the software that made them.
    pub software: &'static str,
}

/// Why there is no window, or no longer one.
#[derive(Debug, thiserror::Error)]
pub enum PreviewError {
    /// No display, or none that can be used.
    #[error(
        "no window can be opened: {reason}; without a display `plumb render SCENE -o picture.png` makes the picture"
    )]
    NoDisplay {
        /// What the system says.
        reason: String,
    },
    /// The window needs a GPU, a software one at least.
    #[error(
        "{0}, and a window needs one: {hint}; without, \
         `plumb render SCENE -o picture.png` makes the picture on the CPU",
        hint = crate::render::install_hint()
    )]
    NoGpu(GpuError),
    /// The device failed while the window was open.
    #[error(transparent)]
    Gpu(#[from] GpuError),
    /// The window could not be set up.
    #[error("the window cannot be shown: {0}")]
    Window(String),
}

/// Shows the scene until the window is closed.
///
/// # Errors
/// Any [`PreviewError`].
pub fn run(options: Options) -> Result<(), PreviewError> {
    arenas::share();
    let (gpu, drawn_with) = open(options.settings.adapter.as_deref())?;
    let window = drawn_with.gpu;
    let setup = egui_wgpu::WgpuSetupExisting {
        instance: drawn_with.instance,
        adapter: drawn_with.adapter,
        device: window.device.clone(),
        queue: window.queue.clone(),
    };
    let status = Arc::clone(&window);
    let defaults = egui_wgpu::WgpuConfiguration::default();
    let on_surface_status = Arc::clone(&defaults.on_surface_status);
    let native = eframe::NativeOptions {
        viewport: egui::ViewportBuilder::default()
            .with_app_id("plumb")
            .with_title("plumb")
            .with_inner_size(window_size(&options))
            .with_min_inner_size([320.0, 240.0]),
        wgpu_options: egui_wgpu::WgpuConfiguration {
            wgpu_setup: setup.into(),
            on_surface_status: Arc::new(move |surface| {
                let action = on_surface_status(surface);
                if matches!(action, egui_wgpu::SurfaceErrorAction::Reconfigure) {
                    // That is done at once; the shell opens this again.
                    status.submit_gate.close();
                }
                action
            }),
            ..defaults
        },
        // Dithering would be the only thing on the screen that is not what it says.
        dithering: false,
        ..Default::default()
    };
    let no_display = |error: winit::error::EventLoopError| PreviewError::NoDisplay {
        reason: plain(&error.to_string()).to_owned(),
    };
    let mut builder = EventLoop::<eframe::UserEvent>::with_user_event();
    display::choose(&mut builder);
    let events = builder.build().map_err(no_display)?;
    let started = Arc::new(Mutex::new(Err(String::from("no window was made"))));
    let start = Arc::clone(&started);
    let devices = Devices {
        gpu: Arc::clone(&gpu),
        window: Arc::clone(&window),
    };
    let inner = eframe::create_native(
        "plumb",
        native,
        Box::new(move |context| {
            let app = App::new(context, devices, options);
            let mut start = start.lock().unwrap_or_else(PoisonError::into_inner);
            match app {
                Ok(app) => {
                    *start = Ok(());
                    Ok(Box::new(app))
                }
                Err(error) => {
                    *start = Err(error.to_string());
                    Err(error.into())
                }
            }
        }),
        &events,
    );
    let mut shell = Shell {
        inner,
        window: Arc::clone(&window),
        resized: None,
    };
    events.run_app(&mut shell).map_err(no_display)?;
    drop(shell);
    let started = started.lock().unwrap_or_else(PoisonError::into_inner);
    started.clone().map_err(PreviewError::Window)?;
    gpu.check()?;
    Ok(window.check()?)
}

/// The devices of a preview.
struct Devices {
    /// Renders.
    gpu: Arc<Gpu>,
    /// Draws the window; perhaps the same.
    window: Arc<Gpu>,
}

impl Devices {
    /// Whether one does both; else the host draws the window, and the device copies it there.
    fn are_one(&self) -> bool {
        Arc::ptr_eq(&self.gpu, &self.window)
    }
}

/// The device that renders, and that which draws the window.
fn open(wanted: Option<&str>) -> Result<(Arc<Gpu>, Opened), PreviewError> {
    let window = |why: std::io::Error| PreviewError::Window(why.to_string());
    std::thread::scope(|scope| {
        // A driver that computes on the CPU starts its threads here: they are to give way to the window.
        let renderer = std::thread::Builder::new()
            .name("open".into())
            .spawn_scoped(scope, || {
                priority::lower();
                // So are those that plumb's own work shares, whoever starts them. If there are none, each picture says
                // why.
                if cores::start(None).is_ok() {
                    rayon::broadcast(|_| priority::lower());
                }
                adapters::open_for_window(wanted)
            })
            .map_err(window)?
            .join();
        let renderer = match renderer {
            Ok(renderer) => renderer.map_err(PreviewError::NoGpu)?,
            Err(panic) => std::panic::resume_unwind(panic),
        };
        let window = adapters::open_beside(&renderer, wanted).map_err(PreviewError::NoGpu)?;
        Ok((renderer.gpu, window))
    })
}

/// What a library says without where in its source it says so: `os error at /…/mod.rs:7: no display` is `no display`.
fn plain(told: &str) -> &str {
    told.split_once(".rs:")
        .and_then(|(_, place)| {
            place
                .trim_start_matches(|c: char| c.is_ascii_digit())
                .strip_prefix(": ")
        })
        .unwrap_or(told)
        .trim_end_matches('.')
}

/// Room for the picture as it is, the panels beside it and below, within reason.
fn window_size(options: &Options) -> [f32; 2] {
    let [width, height] = options.room.map(|pixels| pixels as f32);
    [
        (width + side::WIDTH + 24.0).clamp(800.0, 1500.0),
        (height + inspector::HEIGHT + 56.0).clamp(600.0, 950.0),
    ]
}

#[cfg(test)]
mod tests {
    use super::plain;

    #[test]
    fn no_path_of_the_build_is_told() {
        let told =
            "os error at /home/a/registry/winit/linux/mod.rs:765: no DISPLAY is set: really.";
        assert_eq!(plain(told), "no DISPLAY is set: really");
        assert_eq!(plain("Exit Failure: 1"), "Exit Failure: 1");
    }
}
