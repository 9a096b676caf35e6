//! Scenes made of ingredients, each of which a shader needs something for.

use std::sync::Arc;

use glam::{DVec2, DVec3};
use plumb::procedural::{PPLANE_SHADERS, PSPHERE_SHADERS};
use plumb::render::{Precision, SamplePattern, Settings};
use plumb::scene::{
    self, Beam, Camera, Cone, Extent, Light, Material, Object, ProjectorPicture, Rectangle, Scene,
    Shape, Surface, Texels, Texture, TextureMode,
};
use plumb::shader::compose::{Entry, compose};
use plumb::shader::feature_set::FeatureSet;
use plumb::shader::pack::Packed;

use crate::common::light;

/// Something that a scene may have and a shader then needs.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Ingredient {
    Plane,
    PlaneAcrossTheScreen,
    Tiled,
    Pplane(u32),
    SmallSphere,
    WideSphere,
    SmallPsphere(u32),
    WidePsphere(u32),
    Coplanar,
    Fast,
    ManyPlanes,
    ManySpheres,
    Values,
    Rectangle,
    Triangle,
    Ptriangle(u32),
    ManyTriangles,
    Quadric,
    Pquadric(u32),
    ManyQuadrics,
    TiledAlong,
    Texplane(TextureMode),
    Lamp,
    Spotlight,
    Projector(TextureMode),
    LampInFloor,
    LampOverFloor,
    Mirror,
    Glass,
    Glint,
    Samples,
    CourseSamples,
}

use Ingredient::*;

pub(super) fn ingredients() -> Vec<Ingredient> {
    let mut all = vec![
        Plane,
        PlaneAcrossTheScreen,
        Tiled,
        SmallSphere,
        WideSphere,
        Coplanar,
        Fast,
        ManyPlanes,
        ManySpheres,
        Values,
        Rectangle,
        Triangle,
        ManyTriangles,
        Quadric,
        ManyQuadrics,
        TiledAlong,
        Texplane(TextureMode::Fit),
        Texplane(TextureMode::Tile),
        Lamp,
        Spotlight,
        Projector(TextureMode::Fit),
        Projector(TextureMode::Tile),
        LampInFloor,
        LampOverFloor,
        Mirror,
        Glass,
        Glint,
        Samples,
        CourseSamples,
    ];
    all.extend((0..PPLANE_SHADERS).flat_map(|n| [Pplane(n), Ptriangle(n), Pquadric(n)]));
    all.extend((0..PSPHERE_SHADERS).flat_map(|n| [SmallPsphere(n), WidePsphere(n)]));
    all
}

fn plane(normal: DVec3, point: DVec3, surface: Surface) -> Object {
    let shape = Shape::Plane {
        normal,
        point,
        extent: Extent::Unbounded,
    };
    Object {
        name: "p".into(),
        material: 0,
        shape,
        surface,
    }
}

fn sphere(center: DVec3, radius: f64, surface: Surface) -> Object {
    Object {
        name: "s".into(),
        material: 0,
        shape: Shape::Sphere { center, radius },
        surface,
    }
}

pub(super) fn objects(ingredient: Ingredient) -> Vec<Object> {
    let floor = |surface| plane(DVec3::Y, DVec3::new(0.0, -1.0, 0.0), surface);
    let small = |surface| sphere(DVec3::new(4.0, 3.0, -9.0), 1.0, surface);
    let wide = |surface| sphere(DVec3::new(4.0, -30.0, -9.0), 29.0, surface);
    match ingredient {
        Plane => vec![floor(Surface::Plain)],
        PlaneAcrossTheScreen => vec![plane(
            DVec3::new(3.0, 0.0, 1.0),
            DVec3::new(2.0, 0.0, 0.0),
            Surface::Plain,
        )],
        Tiled => vec![floor(Surface::Tiled {
            dimension: DVec2::new(2.0, 3.0),
            altmaterial: 0,
            xdir: None,
        })],
        Pplane(shader) => vec![floor(Surface::Procedural { shader })],
        SmallSphere => vec![small(Surface::Plain)],
        WideSphere => vec![wide(Surface::Plain)],
        // Of equal spheres the first hides the others.
        SmallPsphere(shader) => vec![sphere(
            DVec3::new(3.0, 2.0, -8.0),
            1.0,
            Surface::Procedural { shader },
        )],
        WidePsphere(shader) => vec![sphere(
            DVec3::new(4.0, -30.0, -9.0),
            28.0,
            Surface::Procedural { shader },
        )],
        ManyPlanes => (1..100)
            .map(|i| {
                plane(
                    DVec3::Z,
                    DVec3::new(0.0, 0.0, -f64::from(i)),
                    Surface::Plain,
                )
            })
            .collect(),
        ManySpheres => (0..1000)
            .map(|i| {
                sphere(
                    DVec3::new(f64::from(i % 8), f64::from(i / 8 % 6), -9.0 - f64::from(i)),
                    0.3,
                    Surface::Plain,
                )
            })
            .collect(),
        Rectangle => vec![rectangle(Surface::Plain)],
        Triangle => vec![triangle(DVec3::new(1.0, 1.0, -7.0), Surface::Plain)],
        Ptriangle(shader) => {
            let corner = DVec3::new(2.0, 4.0, -7.5);
            vec![triangle(corner, Surface::Procedural { shader })]
        }
        ManyTriangles => (0..100)
            .map(|i| {
                let corner = DVec3::new(f64::from(i % 8), f64::from(i / 8 % 6), -20.0);
                triangle(corner, Surface::Plain)
            })
            .collect(),
        Quadric => vec![quadric(DVec3::new(3.0, 2.0, -9.0), Surface::Plain)],
        Pquadric(shader) => {
            let center = DVec3::new(5.0, 2.0, -9.0);
            vec![quadric(center, Surface::Procedural { shader })]
        }
        ManyQuadrics => (0..40)
            .map(|i| quadric(DVec3::new(f64::from(i % 8), 1.0, -20.0), Surface::Plain))
            .collect(),
        Coplanar => {
            let wall = plane(DVec3::Z, DVec3::new(0.0, 0.0, -4.0), Surface::Plain);
            vec![rectangle(Surface::Plain), wall]
        }
        TiledAlong => {
            vec![floor(Surface::Tiled {
                dimension: DVec2::ONE,
                altmaterial: 0,
                xdir: Some(DVec3::new(1.0, 0.0, 1.0)),
            })]
        }
        Texplane(mode) => vec![rectangle(Surface::Textured { texture: 0, mode })],
        Mirror => vec![of_material(1, floor(Surface::Plain))],
        Glass => vec![of_material(2, small(Surface::Plain))],
        Glint => vec![of_material(3, small(Surface::Plain))],
        LampInFloor | LampOverFloor => vec![floor(Surface::Plain)],
        Values | Fast | Lamp | Spotlight | Projector(_) | Samples | CourseSamples => vec![],
    }
}

fn of_material(material: usize, object: Object) -> Object {
    Object { material, ..object }
}

fn triangle(corner: DVec3, surface: Surface) -> Object {
    let (a, b) = (DVec3::new(1.0, 0.0, -0.5), DVec3::new(0.25, 1.0, 0.0));
    let shape = Shape::Triangle(scene::Triangle {
        vertices: [corner, corner + a, corner + b],
        normal: None,
        point: None,
    });
    Object {
        name: "t".into(),
        material: 0,
        shape,
        surface,
    }
}

/// A cone that is cut.
fn quadric(apex: DVec3, surface: Surface) -> Object {
    let DVec3 { x, y, z } = apex;
    let right = y * y - x * x - z * z;
    let shape = Shape::Quadric(scene::Quadric {
        coefficients: [
            1.0,
            -1.0,
            1.0,
            0.0,
            0.0,
            0.0,
            -2.0 * x,
            2.0 * y,
            -2.0 * z,
            right,
        ],
        lower: Some(apex - DVec3::ONE),
        upper: None,
    });
    Object {
        name: "q".into(),
        material: 0,
        shape,
        surface,
    }
}

fn rectangle(surface: Surface) -> Object {
    let extent = Extent::Rectangle(Rectangle {
        xdir: DVec3::X,
        dimensions: DVec2::new(2.0, 3.0),
    });
    let shape = Shape::Plane {
        normal: DVec3::Z,
        point: DVec3::new(1.0, 1.0, -4.0),
        extent,
    };
    Object {
        name: "r".into(),
        material: 0,
        shape,
        surface,
    }
}

fn lights(ingredient: Ingredient) -> Vec<Light> {
    let light = |y, beam| Light {
        beam,
        ..light(DVec3::new(4.0, y, 2.0))
    };
    match ingredient {
        // What materials do is seen by light alone.
        Lamp | Mirror | Glass | Glint => vec![light(6.0, Beam::Everywhere)],
        LampInFloor => vec![light(-1.0, Beam::Everywhere)],
        LampOverFloor => vec![light(-0.999, Beam::Everywhere)],
        Projector(mode) => vec![light(
            6.0,
            Beam::Picture(ProjectorPicture {
                normal: DVec3::Y,
                point: DVec3::new(3.0, 5.0, 1.0),
                rectangle: Rectangle {
                    xdir: DVec3::X,
                    dimensions: DVec2::new(2.0, 3.0),
                },
                texture: 0,
                mode,
            }),
        )],
        Spotlight => vec![light(
            6.0,
            Beam::Cone(Cone {
                point: DVec3::ZERO,
                theta: 20.0,
            }),
        )],
        _ => vec![],
    }
}

fn materials() -> Vec<Material> {
    let material = || Material {
        name: "m".into(),
        ambient: DVec3::ONE,
        diffuse: DVec3::ONE,
        ..Material::default()
    };
    let specular = DVec3::splat(0.5);
    vec![
        material(),
        Material {
            specular,
            ..material()
        },
        Material {
            transparency: 0.5,
            ..material()
        },
        Material {
            specular,
            shininess: 20.0,
            ..material()
        },
    ]
}

pub(super) fn composed(chosen: &[Ingredient]) -> (String, FeatureSet) {
    let (packed, features) = packed(chosen);
    (compose(&packed, &features, Entry::Picture), features)
}

/// The shaders that list pixels in doubt, and take them from the list in f64; None where they do not.
pub(super) fn doubled(chosen: &[Ingredient]) -> Option<[String; 2]> {
    let (scene, settings) = (scene(chosen), settings(chosen));
    let (packed, features) = packed(chosen);
    let features = features.for_a_file(true).with_a_list();
    let double = Packed::in_f64(&scene, &settings);
    features.is_listed().then(|| {
        [
            compose(&packed, &features, Entry::Picture),
            compose(&double, &features.for_the_list(), Entry::Listed),
        ]
    })
}

pub(super) fn packed(chosen: &[Ingredient]) -> (Packed, FeatureSet) {
    let (scene, settings) = (scene(chosen), settings(chosen));
    let packed = Packed::new(&scene, &settings);
    let features = FeatureSet::new(&packed, &settings, 8);
    (packed, features)
}

fn scene(chosen: &[Ingredient]) -> Scene {
    let texels = Texels {
        width: 2,
        height: 1,
        rgb: vec![0; 6],
    };
    Scene {
        camera: Camera {
            name: "c".into(),
            pixeldim: [64, 48],
            worlddim: DVec2::new(8.0, 6.0),
            viewpoint: DVec3::new(4.0, 3.0, 6.0),
        },
        materials: materials(),
        objects: chosen.iter().flat_map(|i| objects(*i)).collect(),
        lights: chosen.iter().flat_map(|i| lights(*i)).collect(),
        textures: vec![Texture {
            name: "t".into(),
            filename: "t.ppm".into(),
            path: "t.ppm".into(),
            texels: Arc::new(texels),
            remark: None,
        }],
    }
}

fn settings(chosen: &[Ingredient]) -> Settings {
    let has = |ingredient| chosen.contains(&ingredient);
    Settings {
        values: has(Values),
        samples: if has(Samples) || has(CourseSamples) {
            16
        } else {
            1
        },
        jitter: if has(CourseSamples) {
            SamplePattern::Course
        } else {
            SamplePattern::Hash
        },
        precision: if has(Fast) {
            Precision::Fast
        } else {
            Precision::Certified
        },
        ..Settings::default()
    }
}
