//! The event loop: hands winit's events to eframe, and keeps the other threads' work from the device while the surface
//! changes its size.

use std::sync::Arc;
use std::time::{Duration, Instant};

use eframe::{EframeWinitApplication, UserEvent};
use winit::application::ApplicationHandler;
use winit::event::{DeviceEvent, DeviceId, StartCause, WindowEvent};
use winit::event_loop::ActiveEventLoop;
use winit::window::WindowId;

use crate::gpu::device::Gpu;

/// eframe's window, with what it does not know: that others may use its device.
pub(super) struct Shell<'a> {
    pub(super) inner: EframeWinitApplication<'a>,
    /// The device that draws the window.
    pub(super) window: Arc<Gpu>,
    /// When the size changed last.
    pub(super) resized: Option<Instant>,
}

/// So long after a change of the size frames may set the surface up anew.
const SETTLES: Duration = Duration::from_secs(1);

impl Shell<'_> {
    /// Lets the others go on: not only if an event told that the size changes, since a surface that turns out to be
    /// outdated while it is drawn keeps them away too.
    fn done(&self) {
        self.window.submit_gate.open();
    }
}

impl ApplicationHandler<UserEvent> for Shell<'_> {
    fn window_event(&mut self, active: &ActiveEventLoop, window: WindowId, event: WindowEvent) {
        let resizes = matches!(
            event,
            WindowEvent::Resized(_) | WindowEvent::ScaleFactorChanged { .. }
        );
        if resizes {
            self.resized = Some(Instant::now());
        }
        // A surface that is not quite right any more is set up anew in one of the next frames.
        let settles = matches!(event, WindowEvent::RedrawRequested)
            && self.resized.is_some_and(|when| when.elapsed() < SETTLES);
        if resizes || settles {
            self.window.submit_gate.close();
        }
        self.inner.window_event(active, window, event);
        self.done();
    }

    fn resumed(&mut self, active: &ActiveEventLoop) {
        self.inner.resumed(active);
    }

    fn suspended(&mut self, active: &ActiveEventLoop) {
        self.inner.suspended(active);
    }

    fn new_events(&mut self, active: &ActiveEventLoop, cause: StartCause) {
        self.inner.new_events(active, cause);
        self.done();
    }

    fn user_event(&mut self, active: &ActiveEventLoop, event: UserEvent) {
        self.inner.user_event(active, event);
        self.done();
    }

    fn device_event(&mut self, active: &ActiveEventLoop, device: DeviceId, event: DeviceEvent) {
        self.inner.device_event(active, device, event);
    }

    fn about_to_wait(&mut self, active: &ActiveEventLoop) {
        self.inner.about_to_wait(active);
        self.done();
    }

    fn exiting(&mut self, active: &ActiveEventLoop) {
        self.inner.exiting(active);
    }

    fn memory_warning(&mut self, active: &ActiveEventLoop) {
        self.inner.memory_warning(active);
    }
}
