//! Lights that light nothing, and objects that nothing lights.

use glam::DVec3;

use super::bounds::ellipsoid;
use super::sight::is_in_ball;
use super::{List, Names};
use crate::real::rational::{Ratio, dot, is_zero, ratio, ratio3, sub};
use crate::scene::{Beam, EntityId, Light, Material, Object, Quadric, Scene, Shape, Surface};

/// Tells of what is dark.
pub(super) fn remarks(scene: &Scene, tolerance: f64, names: &Names<'_>, found: &mut Vec<String>) {
    let shines = |light: &&Light| light.emissivity != DVec3::ZERO;
    if scene.lights.iter().any(|light| shines(&light)) {
        unlit(scene, names, found);
        shut_in(scene, tolerance, names, found);
    } else {
        black(scene, names, found);
    }
    let mut idle = List::default();
    for (i, light) in scene.lights.iter().enumerate() {
        if misses_its_picture(light) {
            idle.push(EntityId::Light(i));
        }
    }
    if !idle.is_empty() {
        found.push(format!(
            "no light of {} passes its picture: its location lies in the picture's plane",
            names.list(&idle)
        ));
    }
}

/// Materials of which something is made, once each, in the order of the objects.
fn used(scene: &Scene) -> impl Iterator<Item = (usize, &Material)> {
    let mut seen = vec![false; scene.materials.len()];
    let of = |object: &Object| {
        let second = match object.surface {
            Surface::Tiled { altmaterial, .. } => Some(altmaterial),
            Surface::Plain | Surface::Textured { .. } | Surface::Procedural { .. } => None,
        };
        [Some(object.material), second]
    };
    let all = scene.objects.iter().flat_map(of).flatten();
    all.filter(move |i| !std::mem::replace(&mut seen[*i], true))
        .map(move |i| (i, &scene.materials[i]))
}

/// No light shines, and materials have no ambient either.
fn black(scene: &Scene, names: &Names<'_>, found: &mut Vec<String>) {
    let mut told = vec![false; scene.materials.len()];
    let mut dark = List::default();
    for object in &scene.objects {
        let material = object.material;
        // A procedural surface needs no material's ambient for its colours.
        let plain = match object.surface {
            Surface::Plain | Surface::Tiled { .. } | Surface::Textured { .. } => true,
            Surface::Procedural { .. } => false,
        };
        if plain
            && scene.materials[material].ambient == DVec3::ZERO
            && !std::mem::replace(&mut told[material], true)
        {
            dark.push(EntityId::Material(material));
        }
    }
    if !dark.is_empty() {
        let light = if scene.lights.is_empty() {
            "there is no light"
        } else {
            "no light shines, as the emissivity of each is 0"
        };
        found.push(format!(
            "{light}, so only ambient counts, and {} {} none: what is made of {} is black",
            names.list(&dark),
            dark.verb("has", "have"),
            dark.verb("it", "them")
        ));
    }
}

/// Lights shine, and no material answers them.
fn unlit(scene: &Scene, names: &Names<'_>, found: &mut Vec<String>) {
    let answers = |material: &Material| {
        let glints = material.shininess != 0.0 && material.specular != DVec3::ZERO;
        material.diffuse != DVec3::ZERO || glints
    };
    if scene.objects.is_empty() || used(scene).any(|(_, material)| answers(material)) {
        return;
    }
    let mut list = List::default();
    used(scene).for_each(|(i, _)| list.push(EntityId::Material(i)));
    found.push(format!(
        "nothing is lit: {} {} neither diffuse nor a glint (specular and shininess), so lights change nothing",
        names.list(&list),
        list.verb("has", "have"),
    ));
}

/// Lights inside of what lets nothing out.
fn shut_in(scene: &Scene, tolerance: f64, names: &Names<'_>, found: &mut Vec<String>) {
    let opaque = |object: &Object| scene.materials[object.material].transparency == 0.0;
    for (i, light) in scene.lights.iter().enumerate() {
        let around = scene
            .objects
            .iter()
            .position(|object| opaque(object) && is_shut_in(light.location, object, tolerance));
        if let Some(object) = around {
            found.push(format!(
                "{} is inside {}, and lights nothing outside it",
                names.typed(EntityId::Light(i)),
                names.typed(EntityId::Object(object))
            ));
        }
    }
}

/// Whether a light is inside of a closed surface that every shadow ray from outside meets.
fn is_shut_in(light: DVec3, object: &Object, tolerance: f64) -> bool {
    match &object.shape {
        Shape::Sphere { center, radius } => is_in_ball(light, *center, *radius, false),
        Shape::Quadric(quadric) => {
            // What is cut off lets light out, and so does the part before the screen, which does not count.
            let whole = quadric.lower.is_none() && quadric.upper.is_none();
            let (_, upper) = super::bounds::edges(quadric);
            whole && upper.z <= tolerance && is_in_ellipsoid(light, quadric)
        }
        Shape::Plane { .. } | Shape::Triangle(_) => false,
    }
}

/// Whether a point is inside of an ellipsoid along the axes, decided exactly.
fn is_in_ellipsoid(point: DVec3, quadric: &Quadric) -> bool {
    if ellipsoid(quadric).is_none() {
        return false;
    }
    let [a, b, c, .., g, h, i, j] = quadric.coefficients.map(ratio);
    let [x, y, z] = ratio3(point);
    let left = &a * &x * &x + &b * &y * &y + &c * &z * &z + &g * &x + &h * &y + &i * &z - &j;
    if quadric.coefficients[0] > 0.0 {
        left < Ratio::ZERO
    } else {
        left > Ratio::ZERO
    }
}

/// Whether a projector's location lies in the plane of its own rectangle.
fn misses_its_picture(light: &Light) -> bool {
    let Beam::Picture(picture) = light.beam else {
        return false;
    };
    let way = sub(&ratio3(picture.point), &ratio3(light.location));
    is_zero(&dot(&ratio3(picture.normal), &way))
}
