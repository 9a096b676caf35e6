//! How many rays are followed: a scene that takes long is a fault too.

use plumb::cpu::light::Lit;
use plumb::cpu::pixel::ExactTracer;
use plumb::cpu::surface::Point;
use plumb::cpu::trace::{Branch, Fault, Limits, TraceObserver, Unmet, ray_trace};
use plumb::jitter::Sampling;
use plumb::prepare::ViewParameters;
use plumb::real::{Bounded, V3};
use plumb::render::{Backend, Settings};

use super::{cpu, picture, scene};
use crate::common;
use crate::oracle::{self, Rules, differences};

/// Rays followed, and rays that those stand for.
#[derive(Default)]
pub(super) struct Followed {
    pub(super) rays: u64,
    counted: u64,
}

impl TraceObserver<Bounded> for Followed {
    fn met(
        &mut self,
        _: u32,
        ray: &Branch<Bounded>,
        _: Bounded,
        _: &Point<Bounded>,
        _: V3<Bounded>,
    ) {
        self.rays += 1;
        self.counted += u64::from(ray.rays);
    }
    fn missed(&mut self, _: u32, ray: &Branch<Bounded>, why: Unmet) {
        if why == Unmet::Nothing {
            self.rays += 1;
            self.counted += u64::from(ray.rays);
        }
    }
    fn light(&mut self, _: usize, _: &Lit<Bounded>) {}
}

/// Half mirrors, so far apart.
fn half_mirrors(count: u32, apart: f64) -> String {
    let mirrors = (0..count).map(|i| {
        let z = -1.0 - apart * f64::from(i);
        format!("plane p {{ material half normal 0 0 1 point 0 0 {z:?} }}\n")
    });
    let mirrors: String = mirrors.collect();
    format!(
        "camera c {{ pixeldim 8 6 worlddim 8 6 viewpoint 4 3 4 }}
         material half {{ ambient 0.5 0.25 1 diffuse 1 1 1 specular 0.5 transparency 0.5 }}
         {mirrors}
         light l {{ location 3 5 2 emissivity 1 1 1 }}"
    )
}

fn followed(text: &str, limits: &Limits) -> (Followed, Result<(), Fault>) {
    let scene = scene(text);
    let exact_tracer = ExactTracer::new(&scene, ViewParameters::from(0.0));
    let mut followed = Followed::default();
    let traced = ray_trace(exact_tracer.bounded(), limits, 2.0, 2.0, &mut followed);
    (followed, traced.map(|_| ()))
}

#[test]
fn rays_on_the_same_way_are_followed_as_one() {
    for (mirrors, path, least) in [(4, 20.0, 1_500), (6, 20.0, 4_000), (4, 24.0, 10_000)] {
        let text = half_mirrors(mirrors, 0.97);
        let limits = Limits {
            max_path: path,
            ..Limits::default()
        };
        let (followed, traced) = followed(&text, &limits);
        println!(
            "{mirrors} mirrors: {} rays as {}",
            followed.counted, followed.rays
        );
        assert_eq!(traced, Ok(()));
        assert!(followed.counted > least, "{}", followed.counted);
        assert!(followed.rays < 1_000, "{}", followed.rays);
    }
}

/// Joined rays count as all those that they stand for.
#[test]
fn joined_rays_are_counted() {
    let text = half_mirrors(3, 0.25);
    let (_, traced) = followed(&text, &Limits::default());
    assert_eq!(traced, Err(Fault::TooManyRays));
    let plain = |max_rays| {
        let limits = Limits {
            max_rays,
            ..Limits::default()
        };
        followed(&half_mirrors(4, 0.97), &limits)
    };
    let (all, traced) = plain(u32::MAX);
    assert_eq!(traced, Ok(()));
    let counted = u32::try_from(all.counted).unwrap();
    assert_eq!(plain(counted).1, Ok(()));
    assert_eq!(plain(counted - 1).1, Err(Fault::TooManyRays));
}

#[test]
fn joined_rays_bring_what_they_bring_alone() {
    for (mirrors, apart, path) in [(3, 0.97, 16.0), (4, 1.25, 17.0), (5, 1.5, 20.0)] {
        let text = half_mirrors(mirrors, apart);
        let scene = scene(&text);
        let mut settings = cpu();
        settings.limits.max_path = path;
        let answer = oracle::picture(&scene, &Rules::from(&settings));
        let rgb = picture(&scene, &settings).unwrap();
        let found: Vec<_> = differences(&scene, &answer, &rgb).collect();
        assert!(found.is_empty(), "{text}\n{}", found.join("\n"));
    }
}

/// A path that is much longer than the gap it goes to and fro in ends where it counts for nothing.
#[test]
fn long_paths_in_narrow_gaps_end() {
    let text = "camera c { pixeldim 8 6 worlddim 8 6 viewpoint 4 3 4 }
                material m { ambient 1 1 1 diffuse 1 1 1 specular 0.75 }
                plane a { material m normal 0 1 0 point 0 2.995 0 }
                plane b { material m normal 0 -1 0 point 0 3.005 0 }
                light l { location 4 5 -2 emissivity 1 1 1 }";
    let limits = Limits {
        max_path: 1e12,
        ..Limits::default()
    };
    let scene = scene(text);
    let exact_tracer = ExactTracer::new(&scene, ViewParameters::from(0.0));
    let mut followed = Followed::default();
    let traced = ray_trace(
        exact_tracer.bounded(),
        &limits,
        3.0,
        2.5 + 1e-3,
        &mut followed,
    );
    assert!(traced.is_ok());
    assert!((20..400).contains(&followed.rays), "{}", followed.rays);
}

/// Half mirrors before a part of the picture, whose rays are too many; the others have few.
const TOO_MANY_RAYS: &str = "camera c { pixeldim 160 48 worlddim 8 6 viewpoint 4 3 6 }
     material half { ambient 1 1 1 diffuse 3 3 3 specular 0.5 transparency 0.5 }
     fplane a { material half normal 0 0 1 point 2.2 1.3 -1 xdir 1 0 0 dimensions 4 3 }
     fplane b { material half normal 0 0 1 point 2.2 1.3 -1.25 xdir 1 0 0 dimensions 4 3 }
     fplane c { material half normal 0 0 1 point 2.2 1.3 -1.5 xdir 1 0 0 dimensions 4 3 }
     light l { location 4 3 4 emissivity 2 2 2 }";

/// The complaint names the first of the pixels in the order of the picture, whoever finds which of them first.
#[test]
fn the_first_pixel_with_too_many_rays_is_named() {
    let scene = scene(TOO_MANY_RAYS);
    let exact_tracer = ExactTracer::new(&scene, ViewParameters::from(0.0));
    let [width, height] = scene.camera.pixeldim;
    let too_many = |x: u32, y: u32| {
        let decided = exact_tracer.trace(&Limits::default(), Sampling::Once, x, y);
        decided.is_err()
    };
    let (x, y) = (0..height)
        .rev()
        .flat_map(|y| (0..width).map(move |x| (x, y)))
        .find(|&(x, y)| too_many(x, y))
        .unwrap();
    assert!(
        x > 0 && y < height - 1,
        "the first pixel of all tells little"
    );
    let named = format!("pixel ({x}, {y}) needs more than 65536 rays");
    for backend in [Backend::Cpu, Backend::Gpu] {
        for (threads, band_rows) in [
            (None, None),
            (Some(1), None),
            (Some(2), Some(9)),
            (Some(4), Some(48)),
        ] {
            let settings = Settings {
                threads,
                band_rows,
                ..common::on(backend)
            };
            let error = picture(&scene, &settings).unwrap_err();
            assert!(
                error.contains(&named),
                "{backend:?}, {threads:?}, {band_rows:?}: {error}"
            );
        }
    }
}
