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

mod app;
mod inspect;
mod inspector;
mod keys;
mod ladder;
mod look;
mod newest;
mod overlay;
mod picture;
mod save;
mod screen;
mod session;
mod side;
mod status;
mod values;
mod watch;
mod worker;

use std::path::PathBuf;
use std::sync::{Arc, Mutex, PoisonError};

use eframe::egui;
use eframe::egui_wgpu;

use crate::gpu::{GpuError, device};
use crate::settings::Settings;
use app::App;

/// What to show.
#[derive(Debug, Clone)]
pub struct Options {
    /// The scene's file.
    pub path: PathBuf,
    /// Columns and rows of the picture, in place of the file's.
    pub size: Option<[u32; 2]>,
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
        "{0}, and a window needs one: {hint}; without, `plumb render SCENE -o picture.png` makes the picture on the CPU",
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
    let opened = device::open_for_window(options.settings.adapter.as_deref());
    let opened = opened.map_err(PreviewError::NoGpu)?;
    let gpu = Arc::new(opened.gpu);
    let setup = egui_wgpu::WgpuSetupExisting {
        instance: opened.instance,
        adapter: opened.adapter,
        device: gpu.device.clone(),
        queue: gpu.queue.clone(),
    };
    let native = eframe::NativeOptions {
        viewport: egui::ViewportBuilder::default()
            .with_app_id("plumb")
            .with_title("plumb")
            .with_inner_size(window_size(&options))
            .with_min_inner_size([480.0, 320.0]),
        wgpu_options: egui_wgpu::WgpuConfiguration {
            wgpu_setup: setup.into(),
            ..Default::default()
        },
        // Dithering would be the only thing on the screen that is not what it says.
        dithering: false,
        ..Default::default()
    };
    let failed = Arc::new(Mutex::new(None));
    let failure = Arc::clone(&failed);
    let device = Arc::clone(&gpu);
    let ran = eframe::run_native(
        "plumb",
        native,
        Box::new(move |context| match App::new(context, device, options) {
            Ok(app) => Ok(Box::new(app)),
            Err(error) => {
                *failure.lock().unwrap_or_else(PoisonError::into_inner) = Some(error.to_string());
                Err(error.into())
            }
        }),
    );
    if let Some(reason) = failed.lock().unwrap_or_else(PoisonError::into_inner).take() {
        return Err(PreviewError::Window(reason));
    }
    ran.map_err(|error| match error {
        eframe::Error::Winit(_) | eframe::Error::WinitEventLoop(_) => PreviewError::NoDisplay {
            reason: error.to_string(),
        },
        error => PreviewError::Window(error.to_string()),
    })?;
    Ok(gpu.check()?)
}

/// Room for the picture as it is, the panels beside it and below, within reason.
fn window_size(options: &Options) -> [f32; 2] {
    let size = options.size.or_else(|| {
        let scene = crate::scene::load(&options.path).ok()?;
        Some(scene.camera.pixeldim)
    });
    let [width, height] = size.unwrap_or([640, 480]).map(|pixels| pixels as f32);
    [
        (width + side::WIDTH + 24.0).clamp(800.0, 1500.0),
        (height + inspector::HEIGHT + 56.0).clamp(600.0, 950.0),
    ]
}
