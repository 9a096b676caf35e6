//! Facts by hand, and that what a probe keeps changes nothing.

use std::path::Path;
use std::sync::Arc;
use std::thread;

use super::why::ExactRay;
use super::*;
use crate::frame::DecidedBy;
use crate::gpu::adapters;
use crate::scene;
use crate::settings::SamplePattern;

fn load(name: &str) -> Scene {
    let path = Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("scenes")
        .join(name);
    scene::load(&path).unwrap()
}

fn near(found: [f64; 3], expected: [f64; 3], tolerance: f64) {
    for (found, expected) in found.into_iter().zip(expected) {
        assert!((found - expected).abs() <= tolerance, "{found} {expected}");
    }
}

/// The notes' walls, by hand. Column 0 is x = 0, row 0 is y = 0, steps are 8/639 and 6/479; the viewpoint is (4, 3, 6).
#[test]
fn facts_are_those_found_by_hand() {
    let scene = load("notes/walls.txt");
    let gpu = adapters::shared(None).unwrap();
    let probe = Probe::new(&scene, &Settings::default(), Ok(&gpu));
    let root = 61.0_f64.sqrt();
    let off: f64 = 4.0 / 639.0;
    let floor = 16.0 / 15.0 * (45.0 + off * off).sqrt();
    // Pixel, world point, object, t, hit point, value, bytes.
    let cases = [
        (
            [0, 0],
            [0.0, 0.0, 0.0],
            0,
            root,
            [0.0, 0.0, 0.0],
            [0.0, 5.0 / root, 0.0],
            [0, 163, 0],
        ),
        (
            [639, 479],
            [8.0, 6.0, 0.0],
            1,
            root,
            [8.0, 6.0, 0.0],
            [5.0 / root, 4.0 / root, 0.0],
            [163, 130, 0],
        ),
        // The floor, 0.2 below the screen: 3 − 3s = −0.2, so s = 16/15. 2/t = 0.2795, times 255: 71.27.
        (
            [320, 0],
            [4.0 + off, 0.0, 0.0],
            2,
            floor,
            [4.0 + off * 16.0 / 15.0, -0.2, -0.4],
            [2.0 / floor; 3],
            [71; 3],
        ),
    ];
    for (pixel, world_point, object, t, at, value, bytes) in cases {
        let facts = probe.facts(pixel, AskGpu::ValueAndVerdict).unwrap();
        assert_eq!(facts.pixel, pixel);
        assert_eq!(facts.viewpoint, [4.0, 3.0, 6.0]);
        near(facts.world_point, world_point, 1e-15);
        let w = [0, 1, 2].map(|i| world_point[i] - facts.viewpoint[i]);
        let length = (w[0] * w[0] + w[1] * w[1] + w[2] * w[2]).sqrt();
        near(facts.direction, w.map(|w| w / length), 1e-15);
        let hit = facts.hit.unwrap().unwrap();
        assert_eq!(hit.object, object);
        // The value here is off by a few roundings itself; the bound is a few dozen.
        assert!((hit.t.value - t).abs() <= hit.t.error + 4e-15, "{hit:?}");
        assert!(hit.t.error < 1e-13, "{hit:?}");
        near(hit.at.to_array(), at, 1e-14);
        let decided = facts.decided.unwrap();
        assert_eq!(decided.bytes, bytes);
        near(decided.value.map(f64::from), value, 1e-7);
        let enclosure = facts.enclosure.map(|v| v.map(|c| c.value));
        if decided.by == DecidedBy::Bounded {
            near(enclosure.unwrap(), value, 1e-14);
        }
        let single = facts.single.unwrap();
        for ((value, single), error) in value.iter().zip(single.value).zip(single.error) {
            let off = (f64::from(single) - 255.0 * value).abs();
            assert!(off <= f64::from(error) + 1e-12, "{single} ± {error}");
            assert!(error < 1e-2, "{single} ± {error}");
        }
        match facts.verdict {
            Some(GpuVerdict::Sure(sure)) => assert_eq!(sure, bytes),
            verdict => assert_eq!(verdict, Some(GpuVerdict::Doubtful)),
        }
    }
    // What is not asked for is not there.
    let facts = probe.facts([320, 0], AskGpu::Value).unwrap();
    assert_eq!((facts.verdict, facts.single.is_some()), (None, true));
    let facts = probe.facts([320, 0], AskGpu::Nothing).unwrap();
    assert_eq!((facts.verdict, facts.single), (None, None));
}

#[test]
fn there_are_no_facts_of_pixels_that_are_not_there() {
    let scene = load("notes/walls.txt");
    let probe = Probe::new(&scene, &Settings::default(), Err(&GpuError::NoAdapter));
    for [x, y] in [[640, 0], [0, 480]] {
        let outside = Unexplained::NoSuchPixel { x, y };
        assert_eq!(probe.facts([x, y], AskGpu::Nothing), Err(outside));
        let ended = probe.write("walls", [x, y], Options::default(), &mut Vec::new());
        assert_eq!(ended.unwrap(), Err(outside));
    }
    let facts = probe.facts([0, 0], AskGpu::ValueAndVerdict).unwrap();
    let why = GpuVerdict::Unknown("no GPU adapter found".into());
    assert_eq!((facts.verdict, facts.single), (Some(why), None));
}

#[test]
fn of_a_pixel_with_too_many_rays_the_hit_is_told() {
    let mut scene = load("lit/facing_mirrors.txt");
    scene.camera.pixeldim = [80, 60];
    let mut settings = Settings::default();
    settings.limits.max_rays = 1;
    let probe = Probe::new(&scene, &settings, Err(&GpuError::NoAdapter));
    let of_pixel = |x, y| {
        let facts = probe.facts([x, y], AskGpu::ValueAndVerdict).unwrap();
        let ended = probe.write("mirrors", [x, y], Options::default(), &mut Vec::new());
        (facts, ended.unwrap())
    };
    let faulty = (0..80).find_map(|x| {
        let (facts, ended) = of_pixel(x, 30);
        facts.decided.is_err().then_some((facts, ended))
    });
    let (facts, ended) = faulty.unwrap();
    assert_eq!(ended, facts.decided.map(|_| ()).map_err(Into::into));
    assert!(facts.hit.unwrap().is_some());
    assert_eq!((facts.verdict, facts.single), (None, None));
}

/// Where f64 decides a tangent or an edge wrongly the hit is the exact one.
#[test]
fn hits_are_exact() {
    let mut wrong = 0;
    for name in [
        "hard/tangent_rays.txt",
        "hard/sphere_by_a_hair.txt",
        "hard/spheres_touching.txt",
        "hard/coincident_slanted.txt",
    ] {
        let mut scene = load(name);
        scene.camera.pixeldim = scene.camera.pixeldim.map(|n| n.min(81));
        let probe = Probe::new(&scene, &Settings::default(), Err(&GpuError::NoAdapter));
        let [width, height] = scene.camera.pixeldim;
        for (x, y) in (0..height).flat_map(|y| (0..width).map(move |x| (x, y))) {
            let [px, py] = [x, y].map(f64::from);
            let hit = probe.exact_tracer.first_hit([px, py]).unwrap();
            let ray = ExactRay::new(&scene.camera, px, py);
            let is_hit = |object| ray.ask(&scene, object, 0.0) == answer::HitOrMiss::Hit;
            match hit {
                Some(hit) => {
                    assert!(is_hit(hit.object), "{name} ({x}, {y}): {hit:?}");
                    assert!(
                        hit.t.error < 1e-8 * hit.t.value,
                        "{name} ({x}, {y}): {hit:?}"
                    );
                    let from = (hit.at - scene.camera.viewpoint).length();
                    let off = (from - hit.t.value).abs();
                    assert!(off < 1e-8 * from, "{name} ({x}, {y}): {hit:?}");
                }
                None => assert!(!(0..scene.objects.len()).any(is_hit), "{name} ({x}, {y})"),
            }
            let plain = crate::cpu::trace::find_closest_object(
                probe.exact_tracer.plain(),
                &crate::cpu::camera::camera_getdir(&probe.exact_tracer.plain().camera, px, py),
            );
            let plain = plain.unwrap().map(|hit| hit.object);
            wrong += usize::from(plain != hit.map(|hit| hit.object));
        }
    }
    // Otherwise f64 would have done, and the test shows nothing.
    assert!(wrong > 0);
}

/// What is kept from one pixel to the next changes nothing.
#[test]
fn a_probe_says_the_same_whatever_it_was_asked_before() {
    let gpu = adapters::shared(None).unwrap();
    let pixels = [[3, 5], [60, 40], [0, 0], [3, 6], [79, 59], [40, 30], [3, 5]];
    for (name, samples, jitter) in [
        ("notes/walls.txt", 1, SamplePattern::Hash),
        ("notes/walls.txt", 3, SamplePattern::Course),
        ("gallery/spheres_over_tiles.txt", 4, SamplePattern::Hash),
        ("lit/glass_balls.txt", 1, SamplePattern::Hash),
    ] {
        let mut scene = load(name);
        scene.camera.pixeldim = [80, 60];
        let settings = Settings {
            samples,
            jitter,
            ..Settings::default()
        };
        let options = Options {
            gpu: AskGpu::Value,
            ..Options::default()
        };
        let told = |probe: &Probe<'_>, pixel| {
            let mut text = Vec::new();
            let ended = probe.write(name, pixel, options, &mut text);
            assert_eq!(ended.unwrap(), Ok(()));
            let facts = probe.facts(pixel, options.gpu).unwrap();
            (String::from_utf8(text).unwrap(), facts)
        };
        let probe = Probe::new(&scene, &settings, Ok(&gpu));
        for pixel in pixels {
            let fresh = Probe::new(&scene, &settings, Ok(&gpu));
            let (text, facts) = told(&probe, pixel);
            assert_eq!(
                (&text, &facts),
                (&told(&fresh, pixel).0, &told(&fresh, pixel).1)
            );
            assert_eq!(samples == 1, text.contains("\nGPU's f32"), "{text}");
            assert!(!text.contains("\nGPU  "), "{text}");
        }
    }
}

#[test]
fn a_thread_may_own_scene_and_probe() {
    let scene = Arc::new(load("notes/walls.txt"));
    let answered = thread::spawn(move || {
        let probe = Probe::new(&scene, &Settings::default(), Err(&GpuError::NoAdapter));
        let facts = probe.facts([0, 0], AskGpu::Nothing);
        facts.unwrap().decided.unwrap().bytes
    });
    assert_eq!(answered.join().unwrap(), [0, 163, 0]);
    fn goes_to_another_thread<T: Send>() {}
    goes_to_another_thread::<Probe<'_>>();
}
