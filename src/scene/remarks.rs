//! What is allowed and yet seldom meant: said beside a good scene, never an error.
//!
//! Stands after the parser; `plumb check` and `plumb render` print it.

use std::collections::HashSet;

use glam::DVec3;

use super::{Beam, Light, Object, Scene, Surface};
use crate::diagnostic::quote;
use crate::real::rational::{dot, is_zero, ratio3, sub};

/// Most names that a remark lists.
const SHOWN: usize = 3;

/// What someone who wonders about the picture may want to know, in sentences.
pub fn remarks(scene: &Scene) -> Vec<String> {
    let mut found = Vec::new();
    if scene.objects.is_empty() {
        found.push("there are no objects: the picture is black".to_owned());
    }
    if scene.lights.is_empty() {
        let dark = |object: &&Object| {
            scene.materials[object.material].ambient == DVec3::ZERO
                && match object.surface {
                    Surface::Plain | Surface::Tiled { .. } | Surface::Textured { .. } => true,
                    // Its colours need no material's ambient.
                    Surface::Procedural { .. } => false,
                }
        };
        let mut names: Vec<&str> = Vec::new();
        for object in scene.objects.iter().filter(dark) {
            let name = scene.materials[object.material].name.as_str();
            if !names.contains(&name) && names.len() <= SHOWN {
                names.push(name);
            }
        }
        if !names.is_empty() {
            found.push(format!(
                "there is no light, so only ambient counts, and {} has none: what is made of it is black",
                list(&names)
            ));
        }
    }
    let idle: Vec<&str> = scene
        .lights
        .iter()
        .filter(|light| lights_nothing(light))
        .map(|light| light.name.as_str())
        .collect();
    if !idle.is_empty() {
        found.push(format!(
            "no light of {} passes its picture: its location lies in the picture's plane",
            list(&idle)
        ));
    }
    for texture in &scene.textures {
        if let Some(odd) = &texture.remark {
            let file = quote(texture.filename.as_bytes());
            found.push(format!("texture {file} {odd}"));
        }
    }
    for (what, names) in [
        (
            "material",
            scene
                .materials
                .iter()
                .map(|m| m.name.as_str())
                .collect::<Vec<_>>(),
        ),
        (
            "texture",
            scene.textures.iter().map(|t| t.name.as_str()).collect(),
        ),
    ] {
        let mut seen = HashSet::new();
        let mut again: Vec<&str> = Vec::new();
        for name in names {
            if !seen.insert(name) && !again.contains(&name) && again.len() <= SHOWN {
                again.push(name);
            }
        }
        if !again.is_empty() {
            found.push(format!(
                "{} is the name of more than one {what}: the first counts",
                list(&again)
            ));
        }
    }
    found
}

/// Whether a projector's location lies in the plane of its own rectangle.
fn lights_nothing(light: &Light) -> bool {
    let Beam::Picture(picture) = light.beam else {
        return false;
    };
    let way = sub(&ratio3(picture.point), &ratio3(light.location));
    is_zero(&dot(&ratio3(picture.normal), &way))
}

/// `a`, `b` and others.
fn list(names: &[&str]) -> String {
    let shown: Vec<String> = names
        .iter()
        .take(SHOWN)
        .map(|name| quote(name.as_bytes()))
        .collect();
    shown.join(", ")
        + if names.len() > SHOWN {
            " and others"
        } else {
            ""
        }
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::*;

    fn of(text: &str) -> Vec<String> {
        let camera = "camera c { pixeldim 4 3 worlddim 8 6 viewpoint 4 3 6 } ";
        remarks(
            &super::super::parse("test", (camera.to_owned() + text).as_bytes(), Path::new(""))
                .unwrap(),
        )
    }

    #[test]
    fn a_scene_as_it_is_meant_gets_none() {
        let wall = "material m { ambient 1 1 1 } plane p { material m normal 0 0 1 point 0 0 -1 }";
        assert_eq!(of(wall), Vec::<String>::new());
    }

    #[test]
    fn black_pictures_are_foretold() {
        assert_eq!(of(""), ["there are no objects: the picture is black"]);
        let wall = "material m { diffuse 1 1 1 } plane p { material m normal 0 0 1 point 0 0 -1 }";
        let told = [
            "there is no light, so only ambient counts, and `m` has none: what is made of it is black",
        ];
        assert_eq!(of(wall), told);
        let lit = format!("{wall} light l {{ location 0 0 0 emissivity 1 1 1 }}");
        assert_eq!(of(&lit), Vec::<String>::new());
    }

    #[test]
    fn projectors_that_light_nothing_are_told() {
        let of = |location: &str| {
            let text = format!(
                "camera c {{ pixeldim 4 3 worlddim 8 6 viewpoint 4 3 6 }}
                 texture t {{ filename textures/texels.ppm }} material m {{ ambient 1 1 1 }}
                 plane p {{ material m normal 0 0 1 point 0 0 -4 }}
                 projector l {{ location {location} emissivity 1 1 1 normal 1 2 3 point 3 2 1 xdir 1 0 0
                     dimensions 1 1 texname t mode 0 }}"
            );
            let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes");
            remarks(&super::super::parse("test", text.as_bytes(), &folder).unwrap())
        };
        assert_eq!(of("0 0 3.333"), Vec::<String>::new());
        assert_eq!(
            of("1 3 1"),
            ["no light of `l` passes its picture: its location lies in the picture's plane"]
        );
    }

    #[test]
    fn names_that_stand_twice_are_told() {
        let twice = "material m { ambient 1 1 1 } material m { ambient 2 2 2 } \
                     plane p { material m normal 0 0 1 point 0 0 -1 }";
        assert_eq!(
            of(twice),
            ["`m` is the name of more than one material: the first counts"]
        );
    }
}
