//! Pictures rendered for a window: on a device that is open, onto a canvas on the GPU, given up when nobody wants them.
//! Needs an adapter, and fails without one.

use std::sync::atomic::{AtomicU32, Ordering};
use std::sync::{Arc, Mutex, mpsc};

use plumb::certify::DecidedBy;
use plumb::gpu::adapters;
use plumb::gpu::bands::DISPATCH_SECONDS;
use plumb::gpu::canvas::{Canvas, Scatter};
use plumb::gpu::device::Gpu;
use plumb::gpu::pipeline::Compiled;
use plumb::render::{Backend, Band, Error, Live, Precision, Settings, render, render_live};
use plumb::scene::Scene;

use crate::common;

/// Scenes of different kinds, some of whose pixels are hard.
const SCENES: &[&str] = &[
    "notes/walls.txt",
    "gallery/procedural_all.txt",
    "hard/tied_lines.txt",
    "lit/mirror_and_glass.txt",
];

fn scene(name: &str, pixeldim: [u32; 2]) -> Scene {
    let mut scene = common::read(&common::scenes().join(name));
    scene.camera.pixeldim = pixeldim;
    scene
}

fn open() -> Arc<Gpu> {
    adapters::shared(None).unwrap_or_else(|error| panic!("{error}"))
}

/// The words of a canvas.
fn read(gpu: &Gpu, canvas: &Canvas) -> Vec<u32> {
    let size = canvas.pixels.size();
    let staging = gpu.device.create_buffer(&wgpu::BufferDescriptor {
        label: None,
        size,
        usage: wgpu::BufferUsages::MAP_READ | wgpu::BufferUsages::COPY_DST,
        mapped_at_creation: false,
    });
    let mut encoder = gpu.device.create_command_encoder(&Default::default());
    encoder.copy_buffer_to_buffer(&canvas.pixels, 0, &staging, 0, size);
    let index = gpu.submit(encoder);
    staging.map_async(wgpu::MapMode::Read, .., |_| ());
    gpu.wait(index).unwrap();
    let view = staging.get_mapped_range(..).unwrap();
    bytemuck::pod_collect_to_vec(&view)
}

/// What a canvas should hold of a band.
fn words(band: &Band) -> impl Iterator<Item = u32> + '_ {
    let verdicts = band.verdicts.as_ref().unwrap();
    let pixels = band.rgb.as_chunks::<3>().0.iter().zip(verdicts);
    pixels.map(|([r, g, b], by)| u32::from_le_bytes([*r, *g, *b, *by as u8]))
}

/// Renders onto a canvas; what the canvas holds, and what it should.
fn on_canvas(
    gpu: &Gpu,
    scene: &Scene,
    settings: &Settings,
    dispatch_seconds: f64,
    scatter: Option<&Scatter>,
) -> (Vec<u32>, Vec<u32>) {
    let canvas = Canvas::new(gpu, scene.camera.pixeldim).unwrap();
    let mut expected = Vec::new();
    let live = Live {
        canvas: Some(&canvas),
        dispatch_seconds,
        ..Live::on(gpu)
    };
    let rendered = render_live(scene, settings, &live, &mut |band| {
        if let Some(scatter) = scatter {
            scatter.put(gpu, &canvas, band).unwrap();
        }
        expected.extend(words(band));
        Ok(())
    });
    rendered.unwrap_or_else(|error| panic!("{error}"));
    (read(gpu, &canvas), expected)
}

#[test]
fn the_canvas_holds_the_picture() {
    let gpu = open();
    let scatter = Scatter::new(&gpu).unwrap();
    for name in SCENES {
        // A width that is no multiple of anything.
        let scene = scene(name, [93, 71]);
        for (precision, backend, samples) in [
            (Precision::Certified, Backend::Gpu, 1),
            (Precision::Certified, Backend::Gpu, 5),
            (Precision::Certified, Backend::Cpu, 1),
            (Precision::Fast, Backend::Gpu, 1),
        ] {
            let settings = Settings {
                precision,
                backend,
                samples,
                verdicts: true,
                ..Settings::default()
            };
            // The second makes dispatches so small that rows are cut.
            for seconds in [DISPATCH_SECONDS, 1e-7] {
                let (found, expected) = on_canvas(&gpu, &scene, &settings, seconds, Some(&scatter));
                assert!(
                    found == expected,
                    "{name}, {precision:?} {backend:?} {samples}"
                );
            }
        }
    }
}

#[test]
fn without_the_cpus_pixels_the_canvas_is_wrong() {
    let gpu = open();
    let scene = scene("hard/tied_lines.txt", [93, 71]);
    let settings = Settings {
        backend: Backend::Gpu,
        verdicts: true,
        ..Settings::default()
    };
    let (found, expected) = on_canvas(&gpu, &scene, &settings, DISPATCH_SECONDS, None);
    let mut doubtful = 0;
    for (found, expected) in found.iter().zip(&expected) {
        let sure = expected >> 24 == DecidedBy::Gpu as u32;
        assert_eq!(sure, found >> 24 == 0);
        assert_eq!(sure, found == expected);
        doubtful += u32::from(!sure);
    }
    assert!(doubtful > 0, "the scene has no pixel that the CPU decides");
}

#[test]
fn an_open_device_gives_the_same_bytes() {
    let gpu = open();
    let scene = scene("lit/mirror_and_glass.txt", [93, 71]);
    let settings = Settings {
        backend: Backend::Gpu,
        ..Settings::default()
    };
    let mut pictures = [Vec::new(), Vec::new()];
    let [own, lent] = &mut pictures;
    render(&scene, &settings, &mut |band| {
        own.extend_from_slice(&band.rgb);
        Ok(())
    })
    .unwrap();
    let report = render_live(&scene, &settings, &Live::on(&gpu), &mut |band| {
        lent.extend_from_slice(&band.rgb);
        Ok(())
    });
    assert_eq!(report.unwrap().adapter.as_deref(), Some(&*gpu.name));
    assert_eq!(pictures[0], pictures[1]);
}

#[test]
fn a_picture_that_nobody_wants_is_given_up() {
    let gpu = open();
    let scene = scene("lit/mirror_and_glass.txt", [320, 240]);
    for backend in [Backend::Gpu, Backend::Cpu] {
        let settings = Settings {
            backend,
            band_rows: Some(8),
            ..Settings::default()
        };
        let asked = AtomicU32::new(0);
        let stop = || asked.fetch_add(1, Ordering::Relaxed) >= 5;
        let live = Live {
            stop: &stop,
            ..Live::on(&gpu)
        };
        let mut rows = 0;
        let ended = render_live(&scene, &settings, &live, &mut |band| {
            rows += band.rows.len();
            Ok(())
        });
        assert!(matches!(ended, Err(Error::Stopped)), "{ended:?}");
        assert!(rows < 240, "{backend:?}: {rows} rows");
    }
}

/// The shader with the camera and all objects in buffers is the same shader: what it makes differs from the certified
/// picture no more than fast pictures do.
#[test]
fn pictures_of_a_moving_camera_are_right() {
    let gpu = open();
    let compiled = Compiled::default();
    for name in SCENES {
        let mut scene = scene(name, [160, 120]);
        for moved in 0..3 {
            scene.camera.viewpoint.x += 0.05 * f64::from(moved);
            let picture = |precision, compiled| {
                let settings = Settings {
                    precision,
                    backend: Backend::Gpu,
                    ..Settings::default()
                };
                let live = Live {
                    compiled,
                    ..Live::on(&gpu)
                };
                let mut rgb = Vec::new();
                let report = render_live(&scene, &settings, &live, &mut |band| {
                    rgb.extend_from_slice(&band.rgb);
                    Ok(())
                });
                (rgb, report.unwrap())
            };
            let (fast, report) = picture(Precision::Fast, Some(&compiled));
            assert_eq!(report.backend, Backend::Gpu);
            let (right, _) = picture(Precision::Certified, None);
            let wrong = |picture: &[u8]| {
                let pairs = picture
                    .as_chunks::<3>()
                    .0
                    .iter()
                    .zip(right.as_chunks::<3>().0);
                let far =
                    |a: &[u8; 3], b: &[u8; 3]| a.iter().zip(b).any(|(a, b)| a.abs_diff(*b) > 1);
                pairs.filter(|(a, b)| far(a, b)).count()
            };
            // Along edges, where objects meet; of some scenes every pixel is one.
            let (plain, _) = picture(Precision::Fast, None);
            let (moving, plain) = (wrong(&fast), wrong(&plain));
            assert!(
                moving <= 2 * plain + 20,
                "{name}: {moving} pixels, {plain} else"
            );
        }
    }
}

/// Takes a driver that computes on the CPU seconds, in one dispatch.
const LONG: &str = "
@group(0) @binding(0) var<storage, read_write> results: array<u32>;

@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3u) {
    var x = id.x;
    for (var i = 0u; i < 60000u; i++) {
        x = (x ^ (x >> 7u)) * 1664525u + 1013904223u;
    }
    results[id.x % 64u] = x;
}
";

/// Where a driver works off what it is given in order, on the CPU, the window is drawn by a device of its own: frames
/// come to their end while a dispatch is under way. Elsewhere it is the same device, and pictures stay on it.
#[test]
fn frames_of_a_window_do_not_wait_for_a_dispatch_on_the_cpu() {
    let renderer = adapters::open_for_window(None).unwrap();
    let window = adapters::open_beside(&renderer, None).unwrap();
    let shared = Arc::ptr_eq(&renderer.gpu, &window.gpu);
    let on_cpu = renderer.adapter.get_info().device_type == wgpu::DeviceType::Cpu;
    assert_eq!(shared, !on_cpu);
    assert_eq!(renderer.gpu.identity, window.gpu.identity);
    if shared {
        return;
    }
    let results = |gpu: &Gpu| {
        gpu.device.create_buffer(&wgpu::BufferDescriptor {
            label: None,
            size: 256,
            usage: wgpu::BufferUsages::STORAGE
                | wgpu::BufferUsages::COPY_SRC
                | wgpu::BufferUsages::COPY_DST,
            mapped_at_creation: false,
        })
    };
    let order = Mutex::new(Vec::new());
    let (began, begins) = mpsc::channel();
    std::thread::scope(|scope| {
        scope.spawn(|| {
            let gpu = &renderer.gpu;
            let pipeline = gpu.compile(LONG, "main").unwrap();
            let results = results(gpu);
            let group = gpu.bind(&pipeline, &[(0, &results)]);
            // The driver compiles when the first dispatch comes.
            gpu.run_once(&pipeline, &group, [1, 1], &results).unwrap();
            began.send(()).unwrap();
            gpu.run_once(&pipeline, &group, [2_000, 1], &results)
                .unwrap();
            order.lock().unwrap().push("rendered");
        });
        begins.recv().unwrap();
        // The dispatch is in the driver by then.
        std::thread::sleep(std::time::Duration::from_millis(100));
        let gpu = &window.gpu;
        let drawn = results(gpu);
        for _ in 0..3 {
            let mut encoder = gpu.device.create_command_encoder(&Default::default());
            encoder.clear_buffer(&drawn, 0, None);
            let index = gpu.submit(encoder);
            gpu.wait(index).unwrap();
            order.lock().unwrap().push("a frame");
        }
    });
    assert_eq!(
        order.into_inner().unwrap(),
        ["a frame", "a frame", "a frame", "rendered"]
    );
}
