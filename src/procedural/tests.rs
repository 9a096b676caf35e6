//! How bright each shader says that it is.

use glam::DVec3;

use super::*;

/// A hit at a place where all that a shader is told can be chosen.
struct Told {
    ambient: f64,
    odd: [u32; 3],
    from_point: [f64; 2],
}

impl PlanePoint<f64> for Told {
    fn ambient(&self) -> V3<f64> {
        V3::exact(DVec3::splat(self.ambient))
    }

    fn odd(&self, axis: usize) -> Result<u32, Undecided> {
        Ok(self.odd[axis])
    }

    fn offset_from_point(&self) -> [f64; 2] {
        self.from_point
    }
}

/// The brightest channel that a shader gives at hits of all kinds: at all angles around the point, near and far.
fn found(family: Family, shader: u32, ambient: f64) -> f64 {
    let mut brightest: f64 = 0.0;
    let distances = [0.0, 1e-6, 0.1, 1.0, 10.0, 1e6];
    for (i, distance) in (0..3600_u32).flat_map(|i| distances.map(|distance| (i, distance))) {
        let (y, x) = (f64::from(i) * 0.1_f64.to_radians()).sin_cos();
        let (x, y) = (distance * x, distance * y);
        let odd = [i & 1, i >> 1 & 1, i >> 2 & 1];
        let color = match family {
            Family::Pplane => pplane(
                shader,
                &Told {
                    ambient,
                    odd,
                    from_point: [x, y],
                },
            ),
            Family::Psphere => psphere(
                shader,
                &SpherePoint {
                    from_center: V3::new(x, y, 0.5),
                    ambient: V3::exact(DVec3::splat(ambient)),
                },
            ),
        };
        let color = color.unwrap();
        brightest = brightest.max(color.x).max(color.y).max(color.z);
    }
    brightest
}

/// The GPU takes what is too far away for that for black, without looking at it.
#[test]
fn no_shader_is_brighter_than_it_says() {
    for family in [Family::Pplane, Family::Psphere] {
        for (number, shader) in (0..).zip(family.shaders()) {
            let mut tight = false;
            for ambient in [0.0, 0.3, 1.0, 5.0, 100.0] {
                let (says, is) = ((shader.brightest)(ambient), found(family, number, ambient));
                assert!(
                    is <= says * (1.0 + 1e-12),
                    "{} says {says} and gives {is} for {ambient}",
                    shader.name
                );
                tight |= is >= 0.999 * says;
            }
            assert!(tight, "{} is never as bright as it says", shader.name);
        }
    }
}

#[test]
fn a_shader_brings_those_that_it_calls() {
    let names = |used: u32| -> Vec<&str> {
        let used = BTreeSet::from([used]);
        let with = with_called(Family::Pplane, used);
        with.iter().map(|shader| shader.name).collect()
    };
    assert_eq!(names(1), ["pplane_1_angle"]);
    assert_eq!(names(2), ["pplane_1_angle", "pplane_2_blocks"]);
    assert!(asks(Family::Pplane, 2, "color_wheel("));
    assert!(!asks(Family::Pplane, 0, "color_wheel("));
}
