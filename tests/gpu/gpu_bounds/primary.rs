//! Literal bounds: the ray of a pixel, and how it meets planes, rectangles and spheres, over whole pictures.

use glam::{DVec2, DVec3};
use plumb::gpu::device::Gpu;
use plumb::prepare;
use plumb::render::{SamplePattern, Settings};
use plumb::scene::{Camera, Extent, Rectangle, Scene, Shape, Surface};

use super::support::{BoundStatistics, Rng, run};
use super::world::{World, about_triangle, is_between, materials, object, triangle};

/// A scene without lights, of planes, rectangles and spheres of all sizes, that are too many for the shader's text.
fn scene(rng: &mut Rng, camera: Camera) -> Scene {
    let view = camera.viewpoint;
    let mut objects = Vec::new();
    for i in 0..240 {
        let normal = rng.unit() * rng.log(-1.0, 1.0);
        let far = rng.log(-1.0, 2.0);
        let mut point = DVec3::new(0.5, 0.5, 0.0) * camera.worlddim.extend(0.0) + rng.within(far);
        point.z = point.z.min(-0.1 * far);
        if i % 4 == 1 {
            let shape = triangle(rng, normal, point);
            objects.push(object(shape, Surface::Procedural { shader: 0 }, 0));
            continue;
        }
        let extent = if i % 2 == 0 {
            Extent::Rectangle(Rectangle {
                xdir: normal.cross(rng.unit()),
                dimensions: DVec2::splat(far) * rng.uniform(0.2, 2.0),
            })
        } else {
            Extent::Unbounded
        };
        let surface = Surface::Procedural { shader: 0 };
        let shape = Shape::Plane {
            normal,
            point,
            extent,
        };
        objects.push(object(shape, surface, 0));
    }
    for i in 0..400 {
        // Toward a place on the screen, or next to it.
        let at = DVec2::from_array([0; 2].map(|_| rng.uniform(-0.3, 1.3))) * camera.worlddim;
        let center = view + (at.extend(0.0) - view) * rng.uniform(1.2, 20.0);
        let radius = center.distance(view) * rng.log(-3.0, -0.01);
        let surface = if i % 2 == 0 {
            Surface::Procedural { shader: 0 }
        } else {
            Surface::Plain
        };
        objects.push(object(Shape::Sphere { center, radius }, surface, 0));
    }
    Scene {
        camera,
        materials: materials(),
        objects,
        lights: vec![],
        textures: vec![],
    }
}

/// A picture whose rays pass through the pixels' middles, on a lattice, or anywhere.
pub(crate) struct SampledPicture {
    pub(crate) world: World,
    samples: u32,
    pattern: SamplePattern,
    unit: f64,
}

/// Unit vectors along the sides of a rectangle.
fn sides(rectangle: &Rectangle, normal: DVec3) -> [DVec3; 2] {
    let xdir = rectangle.xdir;
    let first = (xdir - normal * normal.dot(xdir)).normalize();
    [first, normal.cross(first)]
}

/// Whether a point of the plane of a shape is within its sides; `normal` is of unit length.
fn is_inside(shape: &Shape, normal: DVec3, hit: DVec3) -> bool {
    match shape {
        Shape::Plane {
            extent: Extent::Rectangle(r),
            point,
            ..
        } => {
            let [first, second] = sides(r, normal);
            let from_corner = hit - point;
            (0.0..=r.dimensions.x).contains(&from_corner.dot(first))
                && (0.0..=r.dimensions.y).contains(&from_corner.dot(second))
        }
        Shape::Triangle(triangle) => is_between(&triangle.vertices, hit),
        Shape::Plane { .. } | Shape::Sphere { .. } | Shape::Quadric(_) => true,
    }
}

impl SampledPicture {
    fn new(camera: Camera, samples: u32, pattern: SamplePattern, seed: u64) -> Self {
        let settings = Settings {
            samples,
            jitter: pattern,
            ..Settings::default()
        };
        let unit = 2.0_f64.powi(prepare::Camera::<f64>::new(&camera).scale);
        Self {
            world: World::of(scene(&mut Rng(seed), camera), &settings),
            samples,
            pattern,
            unit,
        }
    }

    /// Several cameras: in the middle, far to the side, close to the screen.
    pub(crate) fn all() -> Vec<Self> {
        let camera = |pixeldim, world: [f64; 2], view: [f64; 3]| Camera {
            name: "c".into(),
            pixeldim,
            worlddim: world.into(),
            viewpoint: view.into(),
        };
        vec![
            Self::new(
                camera([640, 480], [8.0, 6.0], [3.7, 2.9, 6.3]),
                1,
                SamplePattern::Hash,
                11,
            ),
            Self::new(
                camera([1920, 1080], [16.0, 9.0], [-7.3, 11.1, 5.9]),
                4,
                SamplePattern::Course,
                12,
            ),
            Self::new(
                camera([311, 177], [3.1, 1.9], [1.7, 0.4, 0.7]),
                4,
                SamplePattern::Hash,
                13,
            ),
        ]
    }

    /// The place nearest to `at`, in pixels, where a ray may pass: its pixel, its place in it, and what the shader is
    /// told of that.
    fn place(&self, at: DVec2) -> ([i32; 2], DVec2, [f32; 2]) {
        let most = self.world.scene.camera.pixeldim.map(|n| f64::from(n - 1));
        let pixel = at.round().clamp(DVec2::ZERO, DVec2::from_array(most));
        let offset = (at - pixel).clamp(DVec2::splat(-0.5), DVec2::splat(0.499));
        let offset = match (self.samples, self.pattern) {
            (1, _) => DVec2::ZERO,
            (_, SamplePattern::Hash) => (offset * 1024.0).round() / 1024.0,
            (_, SamplePattern::Course) => offset,
        };
        let told = offset.to_array().map(|x| x as f32);
        (pixel.to_array().map(|p| p as i32), offset, told)
    }

    /// The true direction to a place on the screen, in pixels.
    fn ray(&self, pixel: DVec2) -> DVec3 {
        let camera = &self.world.scene.camera;
        let steps = DVec2::from_array(camera.pixeldim.map(|n| f64::from(n - 1)));
        ((pixel * camera.worlddim / steps).extend(0.0) - camera.viewpoint) / self.unit
    }

    /// Where on the screen a point is seen, in pixels.
    fn seen_at(&self, point: DVec3) -> DVec2 {
        let camera = &self.world.scene.camera;
        let from = point - camera.viewpoint;
        let at = camera.viewpoint - from * (camera.viewpoint.z / from.z.min(-1e-9));
        let steps = DVec2::from_array(camera.pixeldim.map(|n| f64::from(n - 1)));
        at.truncate() / camera.worlddim * steps
    }

    fn anywhere(&self, rng: &mut Rng) -> DVec2 {
        let steps = self.world.scene.camera.pixeldim.map(|n| f64::from(n - 1));
        DVec2::from_array(steps.map(|n| rng.uniform(-0.5, n + 0.5)))
    }

    /// Rays through pixels, as the shader is told about them with a record's number, and truly.
    fn rays(
        &self,
        count: usize,
        mut choose: impl FnMut(&mut Rng, usize) -> DVec2,
    ) -> (Vec<f32>, Vec<DVec3>) {
        let mut rng = Rng(5);
        let mut items = Vec::new();
        let rays = (0..count).map(|i| {
            let (pixel, offset, told) = self.place(choose(&mut rng, i));
            items.extend(pixel.map(|p| p as f32));
            items.extend(told);
            self.ray(DVec2::from_array(pixel.map(f64::from)) + offset)
        });
        let rays = rays.collect();
        (items, rays)
    }

    /// How the shader makes the ray of an item.
    fn begin(&self) -> &'static str {
        if self.samples > 1 {
            "let ray = camera_getdir(vec2i(items[i].xy), items[i].zw);"
        } else {
            "let ray = camera_getdir(vec2i(items[i].xy));"
        }
    }

    /// W, its length, its direction, and the value of an ambient colour.
    pub(crate) fn camera(
        &self,
        gpu: &Gpu,
        wgsl: &str,
        count: usize,
        seen: &mut [BoundStatistics; 4],
    ) {
        const LINE: &str = "traced.color = ambient.color * (share * hit.inverse);";
        assert!(wgsl.contains(LINE), "the value is no longer made so");
        let (items, rays) = self.rays(count, |rng, _| self.anywhere(rng));
        let body = format!(
            "{}
    answers[4u * i] = vec4f(ray.w, W_ERROR);
    answers[4u * i + 1u] = vec4f(unit_direction(ray), DIR_ERROR);
    let share = CAMERA_GAIN * ray.inverse_length;
    let near = fract(abs(ray.w.x) * 977.0) + 0.125;
    let value = vec3f(near) * (share * near);
    answers[4u * i + 2u] = vec4f(ray.w2 * ray.inverse_length, LENGTH_ERROR, 0.0, 0.0);
    answers[4u * i + 3u] = vec4f(value.x, VALUE_ERROR * value.x, near, 0.0);",
            self.begin()
        );
        // What only scenes with lights or quadrics have.
        let wgsl = format!("{wgsl}{}", include_str!("../../../shaders/unit.wgsl"));
        let answers = run(gpu, &wgsl, &body, &items, &[], count, 4);
        for (answer, w) in answers.chunks(4).zip(rays) {
            let [a, b, c, d] = [0, 1, 2, 3].map(|k| answer[k].map(f64::from));
            let vector = |v: [f64; 4]| DVec3::new(v[0], v[1], v[2]);
            let length = w.length();
            seen[0].error((vector(a) - w).length(), a[3]);
            seen[1].error((c[0] - length).abs(), c[1] * length);
            seen[2].error((vector(b) - w / length).length(), b[3]);
            let value = 255.0 / self.unit / length * d[2] * d[2];
            seen[3].error((d[0] - value).abs(), d[1]);
        }
    }

    /// What the shader makes a point of a hit with.
    fn point_inputs<'a>(&'a self, spheres: &'a [u8]) -> Vec<(u32, &'a [u8])> {
        let packed = &self.world.packed;
        vec![(2, bytemuck::cast_slice(&packed.objects)), (5, spheres)]
    }

    /// The unit normal of a plane, a point on it, and the shape.
    fn plane(&self, object: u32) -> (DVec3, DVec3, &Shape) {
        let shape = &self.world.scene.objects[object as usize].shape;
        match shape {
            Shape::Plane { normal, point, .. } => (normal.normalize(), *point, shape),
            Shape::Triangle(triangle) => {
                let [a, b, c] = triangle.vertices;
                ((b - a).cross(c - a).normalize(), a, shape)
            }
            Shape::Sphere { .. } | Shape::Quadric(_) => panic!("no plane"),
        }
    }

    /// A pixel that sees a plane: anywhere; of a rectangle or triangle most often in it, at an edge, or next to it.
    fn toward_plane(&self, rng: &mut Rng, object: u32) -> DVec2 {
        let (normal, point, shape) = self.plane(object);
        match shape {
            Shape::Triangle(triangle) if rng.chance(0.7) => {
                self.seen_at(about_triangle(rng, &triangle.vertices))
            }
            Shape::Plane {
                extent: Extent::Rectangle(r),
                ..
            } if rng.chance(0.7) => {
                let mut share = [0, 1].map(|_| rng.uniform(-0.1, 1.1));
                if rng.chance(0.5) {
                    share[rng.below(2)] = rng.below(2) as f64 + rng.sign() * rng.log(-9.0, -3.0);
                }
                let [first, second] = sides(r, normal);
                let along = first * r.dimensions.x * share[0];
                self.seen_at(point + along + second * r.dimensions.y * share[1])
            }
            _ => self.anywhere(rng),
        }
    }

    /// Planes and rectangles, and points on them.
    pub(crate) fn planes(
        &self,
        gpu: &Gpu,
        wgsl: &str,
        count: usize,
        seen: &mut [BoundStatistics; 3],
    ) {
        let packed = &self.world.packed;
        let planes = packed.planes.iter().map(|p| p.object);
        let rectangles = packed.polygons.iter().map(|r| r.object);
        let both: [Vec<u32>; 2] = [planes.collect(), rectangles.collect()];
        let records: [(u32, &[u8]); 2] = [
            (3, bytemuck::cast_slice(&packed.planes)),
            (4, bytemuck::cast_slice(&packed.polygons)),
        ];
        let calls = [("plane_hits", "planes"), ("polygon_hits", "polygons")];
        let spheres = packed.sphere_records();
        let spheres: &[u8] = bytemuck::cast_slice(&spheres);
        for kind in 0..2 {
            let objects = &both[kind];
            let n = objects.len();
            let (items, rays) = self.rays(count, |rng, i| self.toward_plane(rng, objects[i % n]));
            let (call, record) = calls[kind];
            let body = format!(
                "{}
    let c = {call}({record}[i % {n}u], ray);
    var h: Hit;
    h.inverse = c.inverse;
    h.error = c.error;
    h.object = {record}[i % {n}u].object;
    let p = locate(ray, h);
    answers[2u * i + 1u] = vec4f(p.position, p.error);
    {CANDIDATE}",
                self.begin()
            );
            let mut inputs = self.point_inputs(spheres);
            inputs.push(records[kind]);
            let answers = run(gpu, wgsl, &body, &items, &inputs, count, 2);
            for (i, (answer, w)) in answers.chunks(2).zip(rays).enumerate() {
                let (normal, point, shape) = self.plane(objects[i % n]);
                let viewpoint = self.world.scene.camera.viewpoint;
                let point = (point - viewpoint) / self.unit;
                let inverse = normal.dot(w) / normal.dot(point);
                let [found, error, hit, possible] = answer[0].map(f64::from);
                seen[kind].error((found - inverse).abs(), error);
                if inverse > 0.0 {
                    let s = 1.0 / inverse;
                    let inside = is_inside(shape, normal, viewpoint + w * s * self.unit);
                    seen[kind].decision(hit == 1.0, possible == 1.0, inside && s >= 1.0);
                    // Nothing is made of a point whose 1/s may be 0.
                    if hit == 1.0 && found > 4.0 * error {
                        let [x, y, z, error] = answer[1].map(f64::from);
                        seen[2].error((DVec3::new(x, y, z) - w * s).length(), error);
                    }
                }
            }
        }
    }

    /// Spheres, and their normals where they are hit for sure.
    pub(crate) fn spheres(
        &self,
        gpu: &Gpu,
        wgsl: &str,
        count: usize,
        seen: &mut [BoundStatistics; 2],
    ) {
        let packed = &self.world.packed;
        let n = packed.spheres.len();
        let camera = &self.world.scene.camera;
        let truth: Vec<_> = packed
            .spheres
            .iter()
            .map(
                |s| match self.world.scene.objects[s.object as usize].shape {
                    Shape::Sphere { center, radius } => (center, radius),
                    Shape::Plane { .. } | Shape::Triangle(_) | Shape::Quadric(_) => {
                        panic!("no sphere")
                    }
                },
            )
            .collect();
        let (items, rays) = self.rays(count, |rng, i| {
            let (center, radius) = truth[i % n];
            let to_center = (center - camera.viewpoint).normalize();
            // To the outline, to the sphere, anywhere.
            match rng.below(8) {
                0 => self.anywhere(rng),
                1..4 => {
                    let across = to_center.cross(rng.unit()).normalize();
                    let rho = radius / center.distance(camera.viewpoint);
                    let outline = across * (1.0 - rho * rho).max(0.0).sqrt() - to_center * rho;
                    let near = 1.0 + rng.sign() * rng.log(-9.0, -3.0);
                    self.seen_at(center + outline * radius * near)
                }
                _ => self.seen_at(center + rng.unit() * radius),
            }
        });
        let body = format!(
            "{}
    let c = sphere_hits(sphere_at(i % {n}u), ray);
    var h: Hit;
    h.inverse = c.inverse;
    h.error = c.error;
    answers[2u * i + 1u] = sphere_normal(i % {n}u, ray, h);
    {}",
            self.begin(),
            CANDIDATE
        );
        let spheres = packed.sphere_records();
        let spheres: &[u8] = bytemuck::cast_slice(&spheres);
        let inputs = [(5, spheres)];
        let answers = run(gpu, wgsl, &body, &items, &inputs, count, 2);
        for (i, (answer, w)) in answers.chunks(2).zip(rays).enumerate() {
            let (center, radius) = truth[i % n];
            let (c, r) = ((center - camera.viewpoint) / self.unit, radius / self.unit);
            let dir = w.normalize();
            let along = c.dot(dir);
            let apart = c - along * dir;
            let disc = (r - apart.length()) * (r + apart.length());
            let root = disc.max(0.0).sqrt();
            let [found, error, hit, possible] = answer[0].map(f64::from);
            seen[0].decision(hit == 1.0, possible == 1.0, disc > 0.0 && along > 0.0);
            if hit == 1.0 {
                let length = c.length();
                let inverse = w.length() * (along + root) / ((length - r) * (length + r));
                seen[0].error((found - inverse).abs(), error);
                let [x, y, z, error] = answer[1].map(f64::from);
                let normal = -(apart + root * dir) / r;
                seen[1].error((DVec3::new(x, y, z) - normal).length(), error);
            }
        }
    }
}

const CANDIDATE: &str = "
    answers[2u * i] = vec4f(c.inverse, c.error, select(0.0, 1.0, c.hit), select(0.0, 1.0, c.possible));
";
