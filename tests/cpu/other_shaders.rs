//! The shaders that only `plumb bench` and `plumb probe` have are valid WGSL for every scene of ours; no GPU needed.

use naga::valid::{Capabilities, ValidationFlags, Validator};
use plumb::bench::{first_hit, textbook};
use plumb::gpu::single;
use plumb::render::{Precision, Settings};
use plumb::shader::feature_set::SOFTWARE_LANES;
use plumb::shader::pack::Packed;

use crate::common::{good_scenes, read};

#[track_caller]
fn validate(what: &str, wgsl: &str) {
    let module = naga::front::wgsl::parse_str(wgsl)
        .unwrap_or_else(|error| panic!("{what}: {}", error.emit_to_string(wgsl)));
    Validator::new(ValidationFlags::all(), Capabilities::empty())
        .validate(&module)
        .unwrap_or_else(|error| panic!("{what}: {}", error.emit_to_string(wgsl)));
}

#[test]
fn a_picture_s_shader_takes_the_other_entry_point() {
    let mut asked = 0;
    for path in good_scenes() {
        let scene = read(&path);
        for precision in [Precision::Certified, Precision::Fast] {
            let settings = Settings {
                precision,
                ..Settings::default()
            };
            let packed = Packed::new(&scene, &settings);
            let Some((wgsl, _)) = first_hit::wgsl(&packed, &settings, SOFTWARE_LANES) else {
                continue;
            };
            asked += 1;
            validate(&path.display().to_string(), &wgsl);
            assert_eq!(wgsl.matches("@compute").count(), 1);
            if precision == Precision::Certified {
                let features = single::features(&packed, &settings, SOFTWARE_LANES);
                let wgsl = single::wgsl(&packed, &features).unwrap();
                validate(&path.display().to_string(), &wgsl);
            }
            // What is measured is what renders: the bounds stay where there are any.
            let bounds = wgsl.contains("const U = ");
            assert_eq!(
                bounds,
                precision == Precision::Certified,
                "{}",
                path.display()
            );
        }
    }
    assert!(asked > 300, "{asked}");
}

#[test]
fn the_textbook_s_shaders_are_valid() {
    for path in good_scenes() {
        let scene = read(&path);
        for prepared in [true, false] {
            for report in [true, false] {
                let settings = Settings::default();
                let wgsl = textbook::wgsl(&scene, &settings, SOFTWARE_LANES, prepared, report);
                validate(&path.display().to_string(), &wgsl);
            }
        }
    }
}
