//! Where light passes a projector's picture on its way to a point that is off as far as it may be.

use glam::{DVec2, DVec3};
use plumb::gpu::device::Gpu;
use plumb::prepare::extent::rows;
use plumb::real::V3;
use plumb::render::Settings;
use plumb::scene::{
    Beam, Camera, Extent, Light, ProjectorPicture, Rectangle, Scene, Shape, Surface, Texels,
    Texture, TextureMode,
};
use plumb::shader::bounds::round_up;

use super::support::{BoundStatistics, Rng, rounded, run};
use super::world::{UNIT, World, camera, materials, object, seen_from_viewpoint};

/// Columns and rows of the picture.
const SIZE: [u32; 2] = [7, 5];

/// A projector as the scene has it, in f64.
#[derive(Debug, Clone, Copy)]
struct Lantern {
    location: DVec3,
    picture: ProjectorPicture,
}

impl Lantern {
    fn new(rng: &mut Rng) -> Self {
        let location = DVec3::new(4.0, 3.0, 2.0) + rng.within(6.0);
        let (normal, reach) = (rng.unit(), rng.log(-2.0, 0.7) * rng.sign());
        let middle = location + normal * reach + normal.cross(rng.unit()) * rng.log(-1.5, 0.3);
        let rectangle = Rectangle {
            xdir: normal.cross(rng.unit()),
            dimensions: DVec2::new(rng.log(-1.0, 1.0), rng.log(-1.0, 1.0)),
        };
        let rows = rows::<f64>(normal, rectangle.xdir).map(V3::to_f64);
        let half = rectangle.dimensions / 2.0;
        Self {
            location,
            picture: ProjectorPicture {
                normal: normal * rng.log(-1.0, 1.0),
                point: middle - rows[0] * half.x - rows[1] * half.y,
                rectangle,
                texture: 0,
                mode: TextureMode::Fit,
            },
        }
    }

    fn rows(&self) -> [DVec3; 2] {
        rows::<f64>(self.picture.normal, self.picture.rectangle.xdir).map(V3::to_f64)
    }

    /// A point at which light arrives that passes the picture's plane about where the picture is.
    fn point(&self, rng: &mut Rng) -> DVec3 {
        let dimensions = self.picture.rectangle.dimensions;
        let place = |rng: &mut Rng, side: f64| match rng.below(8) {
            // Next to an edge.
            0 => rng.log(-7.0, -2.0) * rng.sign(),
            1 => side + rng.log(-7.0, -2.0) * rng.sign(),
            _ => side * rng.uniform(-0.1, 1.1),
        };
        let [x, y] = [place(rng, dimensions.x), place(rng, dimensions.y)];
        let rows = self.rows();
        let crossing = self.picture.point + rows[0] * x + rows[1] * y;
        // The picture is on the way, or a hair behind its end.
        let share = match rng.below(8) {
            0 => 1.0 + rng.log(-7.0, -1.0) * rng.sign(),
            _ => rng.log(-2.0, 0.0),
        };
        self.location + (crossing - self.location) / share
    }

    /// Whether light to this point passes the picture, and where, in texels.
    fn truth(&self, point: DVec3) -> (bool, [f64; 2]) {
        let (normal, way) = (self.picture.normal, point - self.location);
        let share = normal.dot(self.picture.point - self.location) / normal.dot(way);
        let crossing = self.location + way * share - self.picture.point;
        let sides = self.picture.rectangle.dimensions.to_array();
        let place = self.rows().map(|row| row.dot(crossing));
        let within = (0..2).all(|i| (0.0..=sides[i]).contains(&place[i]));
        (
            within && share > 0.0 && share < 1.0,
            [0, 1].map(|i| place[i] / sides[i] * f64::from(SIZE[i])),
        )
    }
}

/// A wall that stands in no ray's way, and the projectors.
fn world(lanterns: &[Lantern]) -> World {
    let wall = Shape::Plane {
        normal: DVec3::Z,
        point: DVec3::new(0.0, 0.0, -1e6),
        extent: Extent::Unbounded,
    };
    let light = |lantern: &Lantern| Light {
        name: "l".into(),
        location: lantern.location,
        emissivity: DVec3::ONE,
        beam: Beam::Picture(lantern.picture),
    };
    let texels = Texels {
        width: SIZE[0],
        height: SIZE[1],
        rgb: vec![0; 3 * (SIZE[0] * SIZE[1]) as usize],
    };
    let scene = Scene {
        camera: Camera { ..camera([64, 48]) },
        materials: materials(),
        objects: vec![object(wall, Surface::Plain, 0)],
        lights: lanterns.iter().map(light).collect(),
        textures: vec![Texture {
            name: "t".into(),
            filename: "t.ppm".into(),
            path: "t.ppm".into(),
            texels: texels.into(),
            remark: None,
        }],
    };
    World::of(scene, &Settings::default())
}

/// What `passage` says of points, exact and off, against the truth; `own_errors` false takes the records' bounds away.
pub(crate) fn passages(
    gpu: &Gpu,
    change: impl Fn(&str) -> String,
    own_errors: bool,
    count: usize,
) -> [BoundStatistics; 2] {
    let mut rng = Rng(12);
    // An odd number, so that each has points of both kinds.
    let lanterns = [0; 31].map(|_| Lantern::new(&mut rng));
    let mut world = world(&lanterns);
    let lit = world.packed.lit.as_mut().unwrap();
    assert_eq!(lit.projectors.len(), lanterns.len());
    for projector in lit.projectors.iter_mut().filter(|_| !own_errors) {
        projector.errors = [0.0; 2];
    }
    let mut items = Vec::new();
    let truth: Vec<_> = (0..count)
        .map(|i| {
            let lantern = &lanterns[i % lanterns.len()];
            let (told, near) = rounded(seen_from_viewpoint(lantern.point(&mut rng)));
            let toward = (seen_from_viewpoint(lantern.location) - near).length();
            let [x, y] = lantern.rows();
            let normal = lantern.picture.normal.normalize();
            let ways = [x, y, normal, rng.unit()].map(|way| way * rng.sign());
            let error = if i % 2 == 1 {
                rng.log(-7.0, -2.0) * toward
            } else {
                0.0
            };
            let point = near + ways[rng.below(4)] * error;
            items.extend(told);
            items.push(round_up((point - near).length()));
            lantern.truth(point * UNIT + super::world::VIEWPOINT)
        })
        .collect();
    let n = lanterns.len();
    let body = format!(
        "
    let light = lights[i % {n}u];
    let toward = barrier(light.location - items[i].xyz);
    let toward_2 = dot(toward, toward);
    let distance = toward_2 * inverseSqrt(max(toward_2, TINY_SQUARE));
    let toward_error = items[i].w + U * (light.size + TOWARD_ROUNDINGS * distance);
    doubt = false;
    let passed = passage(projectors[light.projector - 1u], 0xffffffffu, toward, distance, toward_error);
    answers[2u * i] = vec4f(passed.index, passed.errors);
    answers[2u * i + 1u] =
        vec4f(select(0.0, 1.0, passed.passes), select(0.0, 1.0, passed.sure), select(0.0, 1.0, doubt), 0.0);"
    );
    let inputs = [
        (13, bytemuck::cast_slice(&lit.lights)),
        (17, bytemuck::cast_slice(&lit.projectors)),
    ];
    let wgsl = change(&world.wgsl);
    let answers = run(gpu, &wgsl, &body, &items, &inputs, count, 2);
    let mut seen = ["passage, exact point", "passage, point is off"].map(BoundStatistics::new);
    for (i, (answer, (passes, place))) in answers.chunks(2).zip(truth).enumerate() {
        let seen = &mut seen[i % 2];
        let [possible, sure, doubt] = [0, 1, 2].map(|k| answer[1][k] == 1.0);
        if doubt {
            seen.decision(false, true, passes);
            continue;
        }
        seen.decision(possible && sure, possible, passes);
        for k in (0..2).filter(|_| possible) {
            let [found, error] = [answer[0][k], answer[0][k + 2]].map(f64::from);
            seen.error((found - place[k]).abs(), error);
        }
    }
    seen
}
