//! The thread that keeps a device busy: it compiles the shader, then renders the rows that its worker orders, two
//! dispatches ahead, and sends them back as they are.
//!
//! It owns all that it needs, so that nobody has to wait for a device that is not needed any more, or does not answer:
//! whoever wants no more rows of it hangs up.

use std::ops::{ControlFlow, Range};
use std::panic::{self, AssertUnwindSafe};
use std::sync::Arc;
use std::sync::atomic::{AtomicU32, Ordering};
use std::sync::mpsc::{Receiver, Sender, TryRecvError};
use std::thread;

use super::devices::Found;
use crate::frame::StopRequested;
use crate::gpu::GpuError;
use crate::gpu::bands::{self, Order, Rendered};
use crate::gpu::canvas::Canvas;
use crate::gpu::device::Gpu;
use crate::gpu::double::DoubleStage;
use crate::gpu::pipeline::{Compiled, Pipeline, SceneBuffers};
use crate::jitter::Jitter;
use crate::settings::Settings;
use crate::shader::compose::{Entry, compose};
use crate::shader::feature_set::FeatureSet;
use crate::shader::form::Form;
use crate::shader::pack::Packed;
use crate::stopwatch::{Phase, Phases, Stopwatch};

/// What a worker hears.
#[derive(Debug)]
pub(super) enum News {
    /// The devices that were asked for.
    Found(Found),
    /// The shader is compiled.
    Ready,
    /// The device rendered a band.
    Rendered(Box<Rendered>),
    /// The device's thread ends.
    Ended(Result<Phases, GpuError>),
    /// The rendering is over.
    Over,
}

impl News {
    /// Tells what came of asking for devices.
    pub(super) fn of_devices(sender: Sender<Self>) -> impl Fn(Found) + Clone + Send + 'static {
        // Nobody may listen any more.
        move |found| drop(sender.send(Self::Found(found)))
    }
}

/// What a device is to render.
pub(super) struct DeviceTask {
    pub(super) packed: Arc<Packed>,
    pub(super) settings: Settings,
    pub(super) jitter: Arc<Jitter>,
    pub(super) width: u32,
    /// The rows of which it will be told some.
    pub(super) rows: Range<u32>,
}

/// How a device is used.
#[derive(Clone, Copy)]
pub(super) struct Use<'a> {
    pub(super) gpu: &'a Gpu,
    pub(super) compiled: Option<&'a Compiled>,
    /// Whether fast shaders are those of a camera that moves.
    pub(super) moving: bool,
    pub(super) canvas: Option<&'a Canvas>,
    /// What decides in f64 what f32 leaves open, if anything is to.
    pub(super) double: Option<&'a DoubleStage>,
    pub(super) dispatch_seconds: f64,
    pub(super) stop: &'a StopRequested<'a>,
}

/// How many rows bands may have for a device, as its thread knows once it is ready.
#[derive(Debug, Default)]
pub(super) struct Heights {
    /// The next one should have so many.
    pub(super) wish: AtomicU32,
    /// Those that others cut may have so many.
    pub(super) most: AtomicU32,
}

/// The thread's end of the line to its worker.
pub(super) struct Line {
    pub(super) orders: Receiver<Range<u32>>,
    pub(super) heights: Arc<Heights>,
    pub(super) news: Sender<News>,
}

/// The thread, from its start to its end.
pub(super) fn run(task: &DeviceTask, device: Use<'_>, line: &Line) {
    let mut watch = Stopwatch::start();
    // Drivers, and what stands on them, panic now and then: others make the picture then.
    let ended = panic::catch_unwind(AssertUnwindSafe(|| render(task, device, line, &mut watch)));
    let ended = ended.unwrap_or_else(|_| Err(device.gpu.lost(&"its thread panicked")));
    watch.lap(Phase::Release);
    let phases = watch.phases();
    // Nobody may listen any more.
    let _ = line.news.send(News::Ended(ended.map(|()| phases)));
}

fn render(
    task: &DeviceTask,
    device: Use<'_>,
    line: &Line,
    watch: &mut Stopwatch,
) -> Result<(), GpuError> {
    let pipeline = pipeline(task, device, watch)?;
    let frame = bands::Frame {
        width: task.width,
        rows: task.rows.clone(),
        tests: task.packed.tests() * task.settings.samples as usize,
        jitter: &task.jitter,
        band_rows: task.settings.band_rows,
        dispatch_seconds: device.dispatch_seconds,
        double: device.double,
        canvas: device.canvas,
    };
    let most = bands::tallest(device.gpu, &pipeline, &frame);
    line.heights.most.store(most, Ordering::Relaxed);
    let mut is_ready = false;
    let next_rows = &mut |wish, wait| {
        line.heights.wish.store(wish, Ordering::Relaxed);
        if !std::mem::replace(&mut is_ready, true) && line.news.send(News::Ready).is_err() {
            return Order::End;
        }
        if wait {
            return line.orders.recv().map_or(Order::End, Order::Rows);
        }
        match line.orders.try_recv() {
            Ok(rows) => Order::Rows(rows),
            Err(TryRecvError::Empty) => Order::Later,
            Err(TryRecvError::Disconnected) => Order::End,
        }
    };
    #[cfg(test)]
    let mut fault = super::tests::device_fault();
    let hand_on = &mut |rendered| {
        #[cfg(test)]
        if super::tests::breaks(&mut fault) {
            return ControlFlow::Break(());
        }
        match line.news.send(News::Rendered(Box::new(rendered))) {
            Ok(()) => ControlFlow::Continue(()),
            Err(_) => ControlFlow::Break(()),
        }
    };
    let ended = bands::run(
        device.gpu,
        &pipeline,
        &frame,
        next_rows,
        device.stop,
        watch,
        hand_on,
    );
    #[cfg(test)]
    super::tests::fail(&fault, device.gpu, line)?;
    ended
}

/// The shader for the packed scene, compiled and bound to it.
fn pipeline(
    task: &DeviceTask,
    device: Use<'_>,
    watch: &mut Stopwatch,
) -> Result<Pipeline, GpuError> {
    let (gpu, packed) = (device.gpu, &*task.packed);
    let mut features = FeatureSet::new(packed, &task.settings, gpu.lanes);
    if device.moving && !features.certified {
        features = features.while_moving();
    }
    if device.canvas.is_none() {
        features = features.for_a_file(gpu.software);
    }
    if device.double.is_some() {
        features = features.with_a_list();
    }
    let wgsl = compose(packed, &features, Entry::Picture);
    watch.lap(Phase::Pack);
    let buffers = SceneBuffers::new(gpu, packed, &features)?;
    watch.lap(Phase::Upload);
    let form = Form::of(&features);
    let shader = thread::scope(|scope| {
        // Where there can be no thread, the buffers are made when they are needed.
        let buffers = || bands::prepare(gpu, &form, task.width, &task.rows);
        let _ = thread::Builder::new()
            .name("buffers".into())
            .spawn_scoped(scope, buffers);
        let shader = match device.compiled {
            Some(compiled) => compiled.get(gpu, &wgsl),
            None => gpu.compile(&wgsl, "main"),
        };
        watch.lap(Phase::Compile);
        shader
    })?;
    watch.lap(Phase::Buffers);
    Ok(Pipeline::of(shader, buffers, packed, &features))
}
