//! f64, on the GPU and on the CPU's lanes: pixels decided by the same text with other numbers. They are held to the
//! oracle with all others (`certified`, `random_scenes`); here is how they come about, what of them is left, and that a
//! bound that is missing is noticed.

use plumb::certify::lanes::OPEN;
use plumb::certify::lanes::doubles::DoubleLanes;
use plumb::certify::trust;
use plumb::cpu::pixel::ExactTracer;
use plumb::gpu::adapters;
use plumb::gpu::bands;
use plumb::gpu::double::{DoubleStage, can_be};
use plumb::gpu::pipeline::Pipeline;
use plumb::jitter::Sampling;
use plumb::render::{Backend, Settings};
use plumb::scene::Scene;
use plumb::shader::compose::{Entry, compose};
use plumb::shader::feature_set::FeatureSet;
use plumb::shader::pack::Packed;

use crate::common;

/// What f64 made of a picture.
#[derive(Debug, Default)]
pub(crate) struct Doubled {
    /// Places, from the top left, and bytes.
    pub(crate) decided: Vec<(usize, [u8; 3])>,
    /// How many pixels are left to the CPU.
    pub(crate) left: usize,
}

/// Renders with the device's f32 and what f64 makes of its doubts; none where the picture has no such stage.
pub(crate) fn doubled(scene: &Scene, settings: &Settings) -> Option<Doubled> {
    doubled_by(scene, settings, &mut |text| text)
}

/// The same with another text of the shader.
fn doubled_by(
    scene: &Scene,
    settings: &Settings,
    change: &mut dyn FnMut(String) -> String,
) -> Option<Doubled> {
    let gpu = adapters::shared(None).unwrap_or_else(|error| panic!("{error}"));
    if !trust::has_doubles(&gpu, None) {
        // Others of our drivers have no f64; lavapipe has.
        assert!(!gpu.name.contains("llvmpipe"), "{} has f64", gpu.name);
        return None;
    }
    let packed = Packed::new(scene, settings);
    let features = FeatureSet::new(&packed, settings, gpu.lanes);
    let features = features.for_a_file(gpu.software).with_a_list();
    let in_f64 = Packed::in_f64(scene, settings);
    if !features.is_listed() || packed.unprovable.is_some() || !can_be(&packed, &in_f64) {
        return None;
    }
    let wgsl = compose(&packed, &features, Entry::Picture);
    let pipeline = Pipeline::new(&gpu, &packed, &features, &wgsl).unwrap();
    let double = DoubleStage::default();
    let listed = features.for_the_list();
    let text = change(compose(&in_f64, &listed, Entry::Listed));
    let second = Pipeline::new(&gpu, &in_f64, &listed, &text).unwrap();
    double.set(second, u32::MAX);
    double.judge(true);
    let [width, height] = scene.camera.pixeldim;
    let frame = bands::Frame {
        width,
        rows: 0..height,
        tests: packed.tests(),
        jitter: &settings.sampling(width, height),
        band_rows: None,
        dispatch_seconds: bands::DISPATCH_SECONDS,
        double: Some(&double),
        canvas: None,
    };
    let mut all = Doubled::default();
    common::bands_of(&gpu, &pipeline, &frame, |rendered| {
        let first = ((height - rendered.band.rows.end) * width) as usize;
        let rgb = rendered.band.rgb.as_chunks().0;
        let decided = rendered.doubled.iter().map(|place| *place as usize);
        all.decided
            .extend(decided.map(|place| (first + place, rgb[place])));
        all.left += rendered.doubtful.len();
    });
    Some(all)
}

/// A picture with the bytes that f64 is sure of.
pub(crate) fn with_doubles(scene: &Scene, settings: &Settings, rgb: &[u8]) -> Option<Vec<u8>> {
    let mut rgb = rgb.to_vec();
    for (place, bytes) in doubled(scene, settings)?.decided {
        rgb.as_chunks_mut().0[place] = bytes;
    }
    Some(rgb)
}

/// The picture once more for each kind of vectors that hold four f64 or more, with the bytes of all pixels that the
/// CPU's f64 is sure of, not only of those that f32 leaves in doubt.
pub(crate) fn with_lanes(scene: &Scene, settings: &Settings, rgb: &[u8]) -> Vec<(String, Vec<u8>)> {
    if !DoubleLanes::may_be(scene, settings) {
        return Vec::new();
    }
    let [width, height] = scene.camera.pixeldim;
    let places: Vec<[u32; 2]> = (0..height)
        .rev()
        .flat_map(|y| (0..width).map(move |x| [x, y]))
        .collect();
    let exact_tracer = ExactTracer::new(scene, settings.view());
    let picture = |(name, lanes): (&str, DoubleLanes)| {
        let words = common::words_in_f64(&lanes, &exact_tracer, settings, &places, [width, height]);
        let mut rgb = rgb.to_vec();
        for (pixel, word) in rgb.chunks_mut(3).zip(&words) {
            if *word < OPEN {
                pixel.copy_from_slice(&word.to_le_bytes()[..3]);
            }
        }
        (format!("f64 with {name}"), rgb)
    };
    let all = DoubleLanes::new(scene, settings).into_iter();
    all.flat_map(DoubleLanes::with_each_vector)
        .map(picture)
        .collect()
}

/// A scene of a folder, at this size or its own; and how it is rendered, with so many samples a pixel.
fn scene(name: &str, pixeldim: Option<[u32; 2]>, samples: u32) -> (Scene, Settings) {
    let mut scene = common::read(&common::scenes().join(name));
    scene.camera.pixeldim = pixeldim.unwrap_or(scene.camera.pixeldim);
    let settings = Settings {
        samples,
        ..common::on(Backend::Gpu)
    };
    (scene, settings)
}

/// Most of what f32 leaves, f64 decides, and every byte of that is right; of several samples too.
#[test]
fn little_is_left_behind_f64() {
    for (name, samples, left_of_a_hundred) in [
        ("lit/mirror_and_glass.txt", 1, 10),
        ("lit/glint.txt", 1, 10),
        ("lit/hall_of_mirrors.txt", 1, 10),
        ("gallery/quadric_chess.txt", 1, 10),
        ("lit/procedural_lit.txt", 1, 10),
        ("lit/magic_lantern.txt", 1, 10),
        ("gallery/procedural_all.txt", 1, 20),
        ("gallery/quadric_chess.txt", 3, 10),
        // Of these bits take two words.
        ("lit/glint.txt", 40, 10),
    ] {
        let size = if samples > 1 { [120, 90] } else { [320, 240] };
        let (scene, settings) = scene(name, Some(size), samples);
        let Some(all) = doubled(&scene, &settings) else {
            return;
        };
        // The CPU's own picture has pixels in it that the same text decided.
        let tracer = ExactTracer::new(&scene, settings.view());
        let limits = settings.sample_limits();
        for (place, bytes) in &all.decided {
            let [x, row] = [place % size[0] as usize, place / size[0] as usize].map(|i| i as u32);
            let y = size[1] - 1 - row;
            let sampling = match samples {
                1 => Sampling::Once,
                samples => Sampling::Hash(samples),
            };
            let right = tracer.trace(&limits, sampling, x, y).unwrap().bytes;
            assert_eq!(right, *bytes, "{name}, {samples} samples, {place}");
        }
        println!(
            "{name}, {samples} samples: {} decided, {} left",
            all.decided.len(),
            all.left
        );
        assert!(all.decided.len() > 20, "{name}, {samples} samples");
        let listed = all.decided.len() + all.left;
        assert!(
            all.left * 100 <= left_of_a_hundred * listed,
            "{name}, {samples} samples"
        );
    }
}

/// What f32 made of a pixel's samples is a part of its mean: its sum, and how far that may be off.
#[test]
fn parts_count_with_their_errors() {
    let (scene, settings) = scene("lit/mirror_and_glass.txt", Some([120, 90]), 5);
    let changed = |from: &str, to: &str| {
        let mut count = 0;
        let all = doubled_by(&scene, &settings, &mut |text| {
            count += text.matches(from).count();
            text.replace(from, to)
        });
        assert_eq!(count, usize::from(all.is_some()), "{from}");
        all
    };
    let Some(honest) = doubled(&scene, &settings) else {
        return;
    };
    // Off by half of all bytes nothing is certain, but what is brighter than all bytes.
    let error = "traced.error = known(first + 5u)";
    let coarse = changed(error, "traced.error = vec3<f64>(128lf) + known(first + 5u)").unwrap();
    assert!(coarse.decided.len() * 20 < honest.decided.len());
    // And a sum that is off shows in the bytes.
    let sum = "traced.color = known(first + 2u)";
    let off = changed(sum, "traced.color = vec3<f64>(1lf) + known(first + 2u)").unwrap();
    let kept = |other: &Doubled| -> usize {
        let same = honest
            .decided
            .iter()
            .filter(|one| other.decided.contains(one));
        same.count()
    };
    assert!(kept(&off) * 2 < honest.decided.len());
    // Each sample that is missing is traced, and none that is not.
    let bits = "& 1u) == 0u";
    let others = changed(bits, "& 1u) != 0u").unwrap();
    assert!(kept(&others) * 2 < honest.decided.len());
}

/// Through the whole of a rendering, where the stage is on trial at first, of several samples: a megapixel of these.
#[test]
fn a_stage_on_trial_changes_no_byte() {
    let (scene, settings) = scene("lit/mirror_and_glass.txt", Some([300, 225]), 16);
    let (gpu, report) = common::picture(&scene, &settings);
    assert_eq!(report.revoked, None);
    let alone = Settings {
        backend: Backend::Cpu,
        ..settings
    };
    assert!(gpu == common::picture(&scene, &alone).0);
}

/// Where f64 takes its bounds for nothing, it decides what it must not, and the bytes show it.
#[test]
fn bounds_of_nothing_are_noticed() {
    let without_bounds = |text: String| {
        let lines = text.lines().map(|line| {
            if line.starts_with("const U = ") {
                "const U = 0lf;"
            } else {
                line
            }
        });
        lines.collect::<Vec<_>>().join("\n")
    };
    let (mut wrong, mut fewer) = (0, 0);
    for name in [
        "hard/lit_bright_mirrors.txt",
        "hard/lit_faint_mirrors.txt",
        "hard/lit_panes_coplanar.txt",
        "hard/lit_painting_under_lamp.txt",
        "hard/lit_projector_tied.txt",
        "hard/lit_quadric_ties.txt",
        "hard/lit_spot_45.txt",
        "hard/lit_tied_lines.txt",
        "hard/tile_edges.txt",
    ] {
        // As it is: at another size rays do not meet borders exactly.
        let (scene, settings) = scene(name, None, 1);
        let Some(honest) = doubled(&scene, &settings) else {
            return;
        };
        let bold = doubled_by(&scene, &settings, &mut { without_bounds }).unwrap();
        fewer += honest.left.saturating_sub(bold.left);
        let (cpu, _) = common::picture(&scene, &common::on(Backend::Cpu));
        let right = cpu.as_chunks::<3>().0;
        let is_wrong = |(place, bytes): &&(usize, [u8; 3])| right[*place] != *bytes;
        assert_eq!(honest.decided.iter().filter(is_wrong).count(), 0, "{name}");
        let here = bold.decided.iter().filter(is_wrong).count();
        println!(
            "{name}: {} left, {} without bounds, {here} wrong",
            honest.left, bold.left
        );
        wrong += here;
    }
    assert!(wrong > 0 && fewer > 0, "{wrong} wrong, {fewer} fewer left");
}
