//! Offsets and sizes of the packed records are those that naga computes for the WGSL structs.

use plumb::shader::binding::BINDINGS;
use plumb::shader::record::Layout;
use plumb::shader::records::{CameraNumbers, Dispatch, layouts};

use super::*;

/// Struct members by name with their offsets, and the array stride or span of the struct.
fn wgsl_struct(module: &naga::Module, name: &str) -> Option<(Vec<(String, usize)>, usize)> {
    let (_, ty) = module
        .types
        .iter()
        .find(|(_, ty)| ty.name.as_deref() == Some(name))?;
    let naga::TypeInner::Struct { members, span } = &ty.inner else {
        panic!("{name} is no struct")
    };
    let offsets = members
        .iter()
        .map(|m| (m.name.clone().unwrap(), m.offset as usize))
        .collect();
    Some((offsets, *span as usize))
}

/// Modules that have all the structs.
fn modules() -> Vec<naga::Module> {
    let all = ingredients();
    let dark: Vec<_> = all
        .iter()
        .copied()
        .filter(|i| {
            !matches!(
                i,
                Lamp | Spotlight
                    | Projector(_)
                    | LampInFloor
                    | LampOverFloor
                    | Mirror
                    | Glass
                    | Glint
            )
        })
        .collect();
    let (packed, features) = packed(&[Plane, Lamp, Fast]);
    let moving = compose(&packed, &features.while_moving(), Entry::Picture);
    [
        composed(&all).0,
        composed(&dark).0,
        composed(&[Plane, Samples]).0,
        composed(&[SmallSphere, SmallPsphere(0), ManyPlanes]).0,
        moving,
    ]
    .iter()
    .map(|wgsl| assert_valid(wgsl, "structs"))
    .collect()
}

fn ours(layout: &Layout) -> (Vec<(String, usize)>, usize) {
    let members = layout
        .members()
        .map(|field| (field.name.to_owned(), field.offset));
    (members.collect(), layout.size)
}

#[test]
fn records_are_laid_out_as_naga_says() {
    let modules = modules();
    for layout in layouts() {
        // The camera is no struct of its own: see below.
        if layout.name == "CameraNumbers" {
            continue;
        }
        let found: Vec<_> = modules
            .iter()
            .filter_map(|module| wgsl_struct(module, layout.wgsl))
            .collect();
        assert!(!found.is_empty(), "no struct {}", layout.wgsl);
        // Two records may have the same name in the shaders of different scenes.
        let named: Vec<_> = layouts()
            .filter(|other| other.wgsl == layout.wgsl)
            .map(ours)
            .collect();
        assert!(found.contains(&ours(layout)), "{}: {found:?}", layout.name);
        for found in found
            .iter()
            .filter(|(members, _)| members.len() == ours(layout).0.len())
        {
            assert!(named.contains(found), "{}: {found:?}", layout.wgsl);
        }
    }
}

/// The same with f64: every number is where the WGSL struct has it.
#[test]
fn records_with_f64_are_laid_out_as_naga_says() {
    let one_ray = |i: &Ingredient| !matches!(i, Samples | CourseSamples | Fast | Values);
    let light = |i: &Ingredient| {
        matches!(
            i,
            Lamp | Spotlight | Projector(_) | LampInFloor | LampOverFloor | Mirror | Glass | Glint
        )
    };
    let all: Vec<_> = ingredients().into_iter().filter(one_ray).collect();
    let dark: Vec<_> = all.iter().copied().filter(|i| !light(i)).collect();
    let modules = [all, dark].map(|chosen| assert_valid(&doubled(&chosen).unwrap()[1], "f64"));
    let mut compared = 0;
    for layout in layouts() {
        // Records of the same name have other members in the shaders of other scenes.
        let members = layout.members().count();
        let found = modules
            .iter()
            .filter_map(|module| wgsl_struct(module, layout.wgsl))
            .find(|(found, _)| {
                let names = layout.members().map(|field| field.name);
                found.len() == members && names.eq(found.iter().map(|(name, _)| name.as_str()))
            });
        let Some((offsets, span)) = found else {
            continue;
        };
        // Word number n holds n, as an f32 or as an integer.
        let mut bytes = vec![0; layout.size];
        let words = |field: &plumb::shader::record::FieldLayout| {
            let count = match field.wgsl {
                "f32" | "u32" => 1,
                "vec2f" | "vec2u" | "vec2i" => 2,
                "vec3f" => 3,
                "vec4f" => 4,
                // Of a record within a record the first number is enough.
                _ => 1,
            };
            let first = field.offset / 4;
            (
                first..first + count,
                !matches!(field.wgsl, "u32" | "vec2u" | "vec2i"),
            )
        };
        for field in layout.members() {
            let (words, float) = words(field);
            for n in words {
                let number = n as u32 + 1;
                let word = if float {
                    (number as f32).to_bits()
                } else {
                    number
                };
                bytes[4 * n..4 * n + 4].copy_from_slice(&word.to_le_bytes());
            }
        }
        let wide = (layout.widened)(&bytes);
        assert_eq!(wide.len(), span, "{}", layout.name);
        for (field, (_, offset)) in layout.members().zip(offsets) {
            let (words, float) = words(field);
            for (i, n) in words.enumerate() {
                let number = n as u32 + 1;
                if float {
                    let at = offset + 8 * i;
                    let found = f64::from_le_bytes(wide[at..at + 8].try_into().unwrap());
                    assert_eq!(found, f64::from(number), "{}.{}", layout.name, field.name);
                } else {
                    let at = offset + 4 * i;
                    let found = u32::from_le_bytes(wide[at..at + 4].try_into().unwrap());
                    assert_eq!(found, number, "{}.{}", layout.name, field.name);
                }
                compared += 1;
            }
        }
    }
    assert!(compared > 150, "{compared}");
}

/// What the table says of bindings is what the shaders declare.
#[test]
fn bindings_are_as_the_table_says() {
    let all = ingredients();
    let mut scenes = vec![all.clone()];
    for ingredient in all {
        scenes.push(vec![ingredient]);
        scenes.push(vec![ingredient, Plane, Samples, Pplane(0)]);
        scenes.push(vec![ingredient, ManyPlanes]);
        scenes.push(vec![ingredient, ManyPlanes, Lamp, Mirror]);
    }
    let mut seen = BTreeSet::new();
    let both = scenes
        .iter()
        .flat_map(|scene| [(scene, false), (scene, true)]);
    for (ingredients, for_a_file) in both {
        let (packed, mut set) = packed(ingredients);
        if for_a_file {
            set = set.for_a_file(false);
        }
        let wgsl = compose(&packed, &set, Entry::Picture);
        let features = set.features();
        let module = assert_valid(&wgsl, "bindings");
        let declared: BTreeSet<(u32, &str)> = module
            .global_variables
            .iter()
            .filter_map(|(_, variable)| {
                let binding = variable.binding.as_ref()?;
                Some((binding.binding, variable.name.as_deref()?))
            })
            .collect();
        let holding: Vec<usize> = (0..BINDINGS.len())
            .filter(|&i| (BINDINGS[i].holds)(&features))
            .collect();
        let named = |&i: &usize| (BINDINGS[i].number, BINDINGS[i].name);
        // No number twice.
        assert_eq!(holding.len(), declared.len(), "{ingredients:?}");
        assert_eq!(
            declared,
            holding.iter().map(named).collect(),
            "{ingredients:?}"
        );
        seen.extend(holding);
    }
    assert_eq!(seen.len(), BINDINGS.len(), "{seen:?}");
}

#[test]
fn a_camera_that_moves_stands_behind_the_dispatch() {
    let (packed, features) = packed(&[Plane, Lamp, Fast]);
    let wgsl = compose(&packed, &features.while_moving(), Entry::Picture);
    let (members, span) = wgsl_struct(&assert_valid(&wgsl, "moving"), "Dispatch").unwrap();
    let (dispatch, camera) = (Dispatch::LAYOUT, CameraNumbers::LAYOUT);
    let behind = camera.members().map(|field| {
        (
            format!("camera_{}", field.name),
            dispatch.size + field.offset,
        )
    });
    assert_eq!(members[5..], behind.collect::<Vec<_>>());
    assert_eq!(span, dispatch.size + camera.size);
}

#[test]
fn a_shifted_field_is_noticed() {
    let wgsl = composed(&[Plane, ManyPlanes]).0.replace(
        "    inverse: vec3f,\n",
        "    extra: u32,\n    inverse: vec3f,\n",
    );
    let module = naga::front::wgsl::parse_str(&wgsl).unwrap();
    let found = wgsl_struct(&module, "Plane").unwrap();
    let plane = layouts().find(|layout| layout.name == "Plane").unwrap();
    assert_ne!(found, ours(plane));
}
