//! The prepared scene rounded to f32: flat records for the GPU, and the numbers that go into the shader's text.

mod lit;
mod records;

pub use lit::Lit;
pub use records::*;

use crate::prepare::surface::{Pplane, Textured, Tiled};
use crate::prepare::{self, Prepared};
use crate::real::V3;

/// What `Object::kind` says in its low byte.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Kind {
    /// The material alone.
    Plain,
    /// A `tiled_plane`.
    Tiled,
    /// A `pplane` with this shader.
    Pplane(u32),
    /// A `psphere` with this shader, small.
    SmallPsphere(u32),
    /// A `psphere` with this shader, wide.
    WidePsphere(u32),
    /// A `psphere` with this shader, in a lit scene.
    LitPsphere(u32),
    /// A `texplane`.
    Textured,
}

impl Kind {
    /// The low byte: families of up to 64 shaders each.
    pub fn code(self) -> u32 {
        match self {
            Self::Plain => 0,
            Self::Tiled => 1,
            Self::Textured => 2,
            Self::Pplane(shader) => 64 + shader,
            Self::SmallPsphere(shader) | Self::LitPsphere(shader) => 128 + shader,
            Self::WidePsphere(shader) => 192 + shader,
        }
    }

    /// The name of the code in WGSL.
    pub fn name(self) -> String {
        match self {
            Self::Plain => "KIND_PLAIN".into(),
            Self::Tiled => "KIND_TILED".into(),
            Self::Pplane(shader) => format!("KIND_PPLANE_{shader}"),
            Self::SmallPsphere(shader) => format!("KIND_SMALL_PSPHERE_{shader}"),
            Self::WidePsphere(shader) => format!("KIND_WIDE_PSPHERE_{shader}"),
            Self::LitPsphere(shader) => format!("KIND_PSPHERE_{shader}"),
            Self::Textured => "KIND_TEXTURED".into(),
        }
    }
}

/// The whole scene, packed.
#[derive(Debug, Clone)]
pub struct Packed {
    /// The camera.
    pub camera: CameraText,
    /// Lengths are in units of 2^scale.
    pub scale: i32,
    /// One for each object of the scene.
    pub objects: Vec<Object>,
    /// The kinds of the objects that a ray can hit.
    pub kinds: Vec<Kind>,
    /// Planes without end that a primary ray can hit.
    pub planes: Vec<Plane>,
    /// Rectangles that a primary ray can hit.
    pub rectangles: Vec<Rectangle>,
    /// The tree over the small spheres, or in a lit scene over all; empty without. They stand in its order.
    pub bvh: Vec<BvhNode>,
    /// Depth of the tree.
    pub bvh_depth: usize,
    /// Spheres seen small.
    pub small_spheres: Vec<SmallSphere>,
    /// The other spheres.
    pub wide_spheres: Vec<WideSphere>,
    /// Tiled planes.
    pub tiled_planes: Vec<TiledPlane>,
    /// Procedural planes.
    pub pplanes: Vec<ProceduralPlane>,
    /// Texplanes.
    pub texplanes: Vec<Texplane>,
    /// The texels of all textures that a texplane shows, bottom rows first.
    pub texels: Vec<u32>,
    /// What a lit scene needs beside.
    pub lit: Option<Lit>,
}

impl Packed {
    /// Rounds a prepared scene to f32.
    pub fn new(scene: &Prepared<f64>) -> Self {
        let world_tree = scene.world.as_ref().and_then(|world| world.bvh.as_ref());
        let tree = if scene.world.is_some() {
            world_tree
        } else {
            scene.bvh.as_ref()
        };
        let mut packed = Self {
            camera: camera(&scene.camera),
            scale: scene.camera.scale,
            objects: scene
                .materials
                .iter()
                .map(|&m| object(scene.palette[m].ambient))
                .collect(),
            kinds: Vec::new(),
            planes: Vec::new(),
            rectangles: Vec::new(),
            bvh: tree
                .iter()
                .flat_map(|bvh| &bvh.nodes)
                .map(bvh_node)
                .collect(),
            bvh_depth: tree.map_or(0, |bvh| bvh.depth),
            small_spheres: Vec::new(),
            wide_spheres: Vec::new(),
            tiled_planes: Vec::new(),
            pplanes: Vec::new(),
            texplanes: Vec::new(),
            texels: Vec::new(),
            lit: None,
        };
        let mut textures = vec![None; scene.textures.len()];
        for plane in &scene.planes {
            match &plane.sides {
                None => packed.planes.push(pack_plane(plane)),
                Some(sides) => packed.rectangles.push(rectangle(plane, sides)),
            }
        }
        for sphere in &scene.spheres {
            // In a lit scene the tree holds them for all rays alike.
            if world_tree.is_none() {
                match &sphere.seen {
                    Some(seen) => packed.small_spheres.push(small_sphere(sphere, seen)),
                    None => packed.wide_spheres.push(wide_sphere(sphere)),
                }
            }
        }
        if scene.world.is_some() {
            // Any ray can hit any object.
            for object in 0..scene.surfaces.len() {
                packed.pack_surface(scene, object, &mut textures);
            }
        } else {
            let hit = scene
                .planes
                .iter()
                .map(|plane| plane.object)
                .chain(scene.spheres.iter().map(|s| s.object));
            for object in hit {
                packed.pack_surface(scene, object, &mut textures);
            }
            packed.point_pspheres(scene);
        }
        packed.kinds.sort_unstable();
        packed.kinds.dedup();
        packed.lit = scene
            .world
            .as_ref()
            .map(|world| Lit::new(scene, world, &packed));
        packed
    }

    /// Packs what modulates an object's material, and notes it in the object.
    fn pack_surface(&mut self, scene: &Prepared<f64>, object: usize, textures: &mut [Option<u32>]) {
        match &scene.surfaces[object] {
            prepare::Surface::Tiled(tiled) => {
                self.tiled_planes
                    .push(tiled_plane(scene, tiled, scene.materials[object]));
                self.set_kind(object, Kind::Tiled, self.tiled_planes.len() - 1);
            }
            prepare::Surface::Pplane(pplane) => {
                self.pplanes.push(procedural_plane(pplane));
                self.set_kind(object, Kind::Pplane(pplane.shader), self.pplanes.len() - 1);
            }
            prepare::Surface::Textured(textured) => {
                let first = *textures[textured.texture].get_or_insert_with(|| {
                    let first = self.texels.len() as u32;
                    let texels = &scene.textures[textured.texture];
                    let rows = texels.rgb.chunks_exact(3 * texels.width as usize).rev();
                    let pack =
                        |t: &[u8]| u32::from(t[0]) | u32::from(t[1]) << 8 | u32::from(t[2]) << 16;
                    self.texels
                        .extend(rows.flat_map(|row| row.chunks_exact(3)).map(pack));
                    first
                });
                self.texplanes.push(texplane(textured, first));
                self.set_kind(object, Kind::Textured, self.texplanes.len() - 1);
            }
            prepare::Surface::Psphere(shader) if scene.world.is_some() => {
                self.set_kind(object, Kind::LitPsphere(*shader), 0);
            }
            // Those of an unlit scene are told apart afterwards.
            prepare::Surface::Psphere(_) => {}
            prepare::Surface::Plain => self.set_kind(object, Kind::Plain, 0),
        }
    }

    /// Tells the procedural spheres of an unlit scene which record is theirs.
    fn point_pspheres(&mut self, scene: &Prepared<f64>) {
        let shader = |object: u32| match scene.surfaces[object as usize] {
            prepare::Surface::Psphere(shader) => Some(shader),
            _ => None,
        };
        let small: Vec<_> = self.small_spheres.iter().map(|s| s.object).collect();
        for (record, object) in small.into_iter().enumerate() {
            if let Some(shader) = shader(object) {
                self.set_kind(object as usize, Kind::SmallPsphere(shader), record);
            }
        }
        let wide: Vec<_> = self.wide_spheres.iter().map(|s| s.object).collect();
        for (record, object) in wide.into_iter().enumerate() {
            if let Some(shader) = shader(object) {
                self.set_kind(object as usize, Kind::WidePsphere(shader), record);
            }
        }
    }

    fn set_kind(&mut self, object: usize, kind: Kind, record: usize) {
        // A plain object needs no record; the others are far fewer than 2²⁴ before any buffer is full.
        self.objects[object].kind = if kind == Kind::Plain {
            0
        } else {
            kind.code() | ((record as u32) << 8)
        };
        if self.kinds.last() != Some(&kind) {
            self.kinds.push(kind);
        }
    }

    /// How many objects a primary ray can hit.
    pub fn tested(&self) -> usize {
        let spheres = if self.lit.is_some() && !self.bvh.is_empty() {
            self.lit.as_ref().map_or(0, |lit| lit.spheres.len())
        } else {
            self.small_spheres.len() + self.wide_spheres.len()
        };
        self.planes.len() + self.rectangles.len() + spheres
    }

    /// About how many tests a pixel costs: a tree's spheres cost by their number's logarithm.
    pub fn tests(&self) -> usize {
        let primary = self.loop_iterations() + 8 * self.bvh_depth;
        let Some(lit) = &self.lit else { return primary };
        // A shadow ray a light, a few times over for mirrors.
        primary + 4 * (1 + lit.lights.len()) * (lit.loop_iterations() + 8 * self.bvh_depth + 4)
    }

    /// Iterations of the loops over objects outside the tree, for one primary ray.
    pub fn loop_iterations(&self) -> usize {
        let small = if self.bvh.is_empty() {
            self.small_spheres.len()
        } else {
            0
        };
        self.planes.len() + self.rectangles.len() + small + self.wide_spheres.len()
    }
}

pub(super) fn f32x3(v: V3<f64>) -> [f32; 3] {
    [v.x as f32, v.y as f32, v.z as f32]
}

fn camera(camera: &prepare::Camera<f64>) -> CameraText {
    let unit = prepare::exact::two_to(-camera.scale);
    CameraText {
        anchor: camera.anchor,
        step: camera.step.map(|v| v as f32),
        offset: camera.offset.map(|v| v as f32),
        distance: camera.distance as f32,
        gain: (255.0 * unit) as f32,
        unit: unit as f32,
    }
}

fn object(ambient: V3<f64>) -> Object {
    Object {
        ambient: f32x3(ambient),
        kind: 0,
    }
}

fn bvh_node(node: &prepare::bvh::Node) -> BvhNode {
    BvhNode {
        min: node.min,
        first: node.first,
        max: node.max,
        count: node.count,
    }
}

fn form(form: [f64; 3]) -> [f32; 3] {
    form.map(|v| v as f32)
}

fn pack_plane(plane: &prepare::Plane<f64>) -> Plane {
    Plane {
        inverse: form(plane.inverse),
        object: plane.object as u32,
        front: plane.front.map_or([0.0; 3], form),
        unused: 0,
    }
}

fn rectangle(plane: &prepare::Plane<f64>, sides: &prepare::plane::Sides<f64>) -> Rectangle {
    Rectangle {
        inverse: form(plane.inverse),
        object: plane.object as u32,
        front: plane.front.map_or([0.0; 3], form),
        unused: 0,
        side_0: form(sides.forms[0]),
        length_0: sides.dimensions[0] as f32,
        side_1: form(sides.forms[1]),
        length_1: sides.dimensions[1] as f32,
    }
}

fn small_sphere(sphere: &prepare::Sphere<f64>, seen: &prepare::sphere::Seen<f64>) -> SmallSphere {
    SmallSphere {
        toward: f32x3(sphere.toward),
        rho2: sphere.rho2 as f32,
        gain: sphere.gain as f32,
        distance: sphere.distance as f32,
        offset: seen.offset.map(|v| v as f32),
        anchor: seen.anchor,
        object: sphere.object as u32,
        unused: 0,
    }
}

fn wide_sphere(sphere: &prepare::Sphere<f64>) -> WideSphere {
    WideSphere {
        toward: f32x3(sphere.toward),
        kappa2: sphere.kappa2 as f32,
        gain: sphere.gain as f32,
        distance: sphere.distance as f32,
        object: sphere.object as u32,
        unused: 0,
    }
}

fn tiled_plane(scene: &Prepared<f64>, tiled: &Tiled<f64>, own: usize) -> TiledPlane {
    let zero = V3::new(0.0, 0.0, 0.0);
    let world = [V3 { x: 1.0, ..zero }, V3 { z: 1.0, ..zero }];
    let rows = tiled.rows.unwrap_or(world);
    let [even, odd] = tiled.materials;
    // The shader gives even sums the object's own material.
    let (other, flip) = if even == own { (odd, 0) } else { (even, 1) };
    TiledPlane {
        row_0: f32x3(rows[0] * tiled.index[0].per_unit),
        fraction_0: tiled.index[0].fraction as f32,
        row_1: f32x3(rows[1] * tiled.index[1].per_unit),
        fraction_1: tiled.index[1].fraction as f32,
        altmaterial: f32x3(scene.palette[other].ambient),
        altindex: other as u32,
        parity: (tiled.index[0].parity + tiled.index[1].parity + flip) as f32,
        padding: [0; 3],
        unused: [0.0; 3],
        padding_end: 0,
    }
}

fn procedural_plane(pplane: &Pplane<f64>) -> ProceduralPlane {
    let [x, y] = pplane.from_point;
    ProceduralPlane {
        per_unit: pplane.index.map(|i| i.per_unit as f32),
        unused_0: 0,
        fraction: pplane.index.map(|i| i.fraction as f32),
        unused_1: 0,
        parity: pplane.index.map(|i| i.parity as f32),
        unused_2: 0,
        from_point: [
            x.per_unit as f32,
            y.per_unit as f32,
            x.offset as f32,
            y.offset as f32,
        ],
    }
}

fn texplane(textured: &Textured<f64>, first: u32) -> Texplane {
    let extent = &textured.extent;
    let [u, v] = textured.per_unit;
    Texplane {
        row_0: f32x3(extent.rows[0] * u),
        origin_0: (extent.origin[0] * u) as f32,
        row_1: f32x3(extent.rows[1] * v),
        origin_1: (extent.origin[1] * v) as f32,
        size: textured.size,
        first,
        repeats: u32::from(textured.repeats),
    }
}
