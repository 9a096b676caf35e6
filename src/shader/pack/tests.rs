//! What the camera's numbers say of rays in f32.

use std::path::Path;

use super::*;
use crate::jitter::{Jitter, Sampling};
use crate::real::Real;
use crate::real::rational::ratio;
use crate::scene::load_from;
use crate::shader::bounds::U;
use crate::shader::bounds::{DIR_ROUNDINGS, MOST_PRODUCT};

/// W and its direction as the shader has them from an offset in f32, against those from the course's place: pixels far
/// apart, seen from next to the middle one, show what the offset's rounding is.
#[test]
fn offsets_of_the_course_are_within_the_bounds_of_rays() {
    let text = "camera c { pixeldim 3 3 worlddim 1600 1600 viewpoint 800 800 1 }";
    let scene = load_from("test", text.as_bytes(), Path::new(".")).unwrap();
    let settings = Settings {
        samples: 4096,
        jitter: SamplePattern::Course,
        ..Settings::default()
    };
    let packed = Packed::new(&scene, &settings);
    let PackedCamera {
        numbers,
        w_error,
        condition,
    } = packed.camera;
    let exact = prepare::Camera::<Bounded>::new(&scene.camera);
    let jitter: Jitter = settings.sampling(3, 3);
    let (mut worst_w, mut worst_dir) = (0.0_f64, 0.0_f64);
    for y in 0..3 {
        let row = jitter.row(y).unwrap();
        for x in 0..3 {
            let Sampling::Given(offsets) = jitter.pixel(Some(&row), 3, x as usize) else {
                panic!("the course's offsets are given")
            };
            for offset in offsets {
                let component = |i: usize, pixel: u32| {
                    let steps = (pixel as i32 - numbers.anchor[i]) as f32 + offset[i] as f32;
                    let shader = steps * numbers.step[i] + numbers.offset[i];
                    let place =
                        ratio(f64::from(pixel) + offset[i]) - ratio(f64::from(exact.anchor[i]));
                    let want = Bounded::ratio(&place) * exact.step[i] + exact.offset[i];
                    (f64::from(shader), want.value)
                };
                let (a, b) = (component(0, x), component(1, y));
                let d = exact.distance.value;
                let length = |x: f64, y: f64| (x * x + y * y + d * d).sqrt();
                let (is, ought) = (length(a.0, b.0), length(a.1, b.1));
                let off = |a: f64, b: f64, c: f64| (a * a + b * b + c * c).sqrt();
                worst_w = worst_w.max(off(a.0 - a.1, b.0 - b.1, 0.0));
                worst_dir = worst_dir.max(off(
                    a.0 / is - a.1 / ought,
                    b.0 / is - b.1 / ought,
                    d / is - d / ought,
                ));
            }
        }
    }
    assert!(worst_w <= f64::from(w_error), "{worst_w:e} > {w_error:e}");
    // What is computed with W afterwards has the bound that it has without samples.
    let rounded = (DIR_ROUNDINGS - 3.0) * U;
    let bound = DIR_ROUNDINGS * f64::from(condition) * U - rounded;
    assert!(worst_dir <= bound, "{worst_dir:e} > {bound:e}");
}

/// Materials and lights each of which is of ordinary size, and whose product is not.
#[test]
fn what_is_too_bright_together_is_left_to_the_cpu() {
    let doubt = |reflectivity: f64, emissivity: f64, mirror: f64| {
        let text = format!(
            "camera c {{ pixeldim 3 3 worlddim 3 3 viewpoint 1.5 1.5 1 }}
            material m {{ ambient 1 1 1 diffuse {reflectivity} 1 1 specular {mirror} 0 0 }}
            plane p {{ material m normal 0 0 1 point 0 0 -3 }}
            light l {{ location 0 0 1 emissivity 1 1 {emissivity} }}"
        );
        let scene = load_from("test", text.as_bytes(), Path::new(".")).unwrap();
        Packed::new(&scene, &Settings::default()).unprovable
    };
    let (half, more) = ((MOST_PRODUCT / 2.0 - 4.0).exp2(), 8.0_f64.exp2());
    assert_eq!(doubt(half, half, 0.0), None);
    assert_eq!(doubt(1.0, half * more, half / more), None);
    assert!(doubt(half * more, half * more, 0.0).is_some());
    assert!(doubt(1.0, half * more, half * more).is_some());
}

/// What is prepared of planes is no reason not to take a scene: one through the viewpoint, whose offset is 0.
#[test]
fn planes_through_the_viewpoint_are_taken() {
    let path =
        Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes/hard/lit_mirrors_path_exactly_20.txt");
    let scene = crate::scene::load(&path).unwrap();
    let settings = Settings::default();
    assert_eq!(Packed::new(&scene, &settings).unprovable, None);
    assert_eq!(Packed::in_f64(&scene, &settings).unprovable, None);
}

/// A z up to which hits count that no number of f64 holds in the scene's unit: planes end there, or it is not taken.
#[test]
fn a_tolerance_beyond_all_numbers_is_a_limit() {
    let text = "camera c { pixeldim 3 3 worlddim 8 6 viewpoint 4 3 0.3 }
        material m { ambient 1 1 1 diffuse 1 1 1 }
        plane p { material m normal 0 1 0 point 0 0 0 }
        light l { location 4 5 3 emissivity 4 4 4 }";
    let scene = load_from("test", text.as_bytes(), Path::new(".")).unwrap();
    let settings = Settings {
        screen_tolerance: -1e308,
        ..Settings::default()
    };
    let single = Packed::new(&scene, &settings);
    let highest = single.lit.as_ref().unwrap().planes[0].highest;
    assert!(
        single.unprovable.is_some() || highest < -1e28,
        "{highest:e}"
    );
    let double = Packed::in_f64(&scene, &settings);
    let highest = double.lit.as_ref().unwrap().planes[0].highest;
    assert!(
        double.unprovable.is_some() || highest < -1e28,
        "{highest:e}"
    );
    // It is no number that cannot be told from others in a shader's text.
    let far = Settings {
        screen_tolerance: -1e300,
        ..Settings::default()
    };
    let double = Packed::in_f64(&scene, &far);
    assert!(double.lit.as_ref().unwrap().planes[0].highest < -1e28);
    assert_eq!(double.unprovable, None);
}
