//! The prepared scene as flat f32 records, laid out as the structs of `shaders/` (a test compares the offsets with naga's).

use bytemuck::{Pod, Zeroable};

use crate::prepare::surface::{Pplane, Tiled};
use crate::prepare::{self, Prepared};
use crate::real::V3;

/// `Object` in `shaders/surface.wgsl`.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
pub struct Object {
    /// Ambient reflectivity of the material.
    pub ambient: [f32; 3],
    /// [`Kind`] in the low byte, the index of its record above.
    pub kind: u32,
}

/// `Plane` in `shaders/plane.wgsl`.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
pub struct Plane {
    /// 1/s over (W.x, W.y, 1).
    pub inverse: [f32; 3],
    /// Index of the object.
    pub object: u32,
    /// ≥ 0 over (x, y, 1) where the hit counts; zeros where it always does.
    pub front: [f32; 3],
    /// Nothing.
    pub unused: u32,
}

/// `SmallSphere` in `shaders/sphere.wgsl`.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
pub struct SmallSphere {
    /// Unit vector to the center.
    pub toward: [f32; 3],
    /// (r/|C|)².
    pub rho2: f32,
    /// |C|/(|C|² − r²).
    pub gain: f32,
    /// |C|.
    pub distance: f32,
    /// W − W_c at the anchor.
    pub offset: [f32; 2],
    /// Pixel next to the projected center.
    pub anchor: [i32; 2],
    /// Index of the object.
    pub object: u32,
    /// Nothing.
    pub unused: u32,
}

/// `WideSphere` in `shaders/sphere.wgsl`.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
pub struct WideSphere {
    /// Unit vector to the center.
    pub toward: [f32; 3],
    /// (|C|² − r²)/|C|².
    pub kappa2: f32,
    /// |C|/(|C|² − r²).
    pub gain: f32,
    /// |C|.
    pub distance: f32,
    /// Index of the object.
    pub object: u32,
    /// Nothing.
    pub unused: u32,
}

/// `BvhNode` in `shaders/bvh.wgsl`.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
pub struct BvhNode {
    /// Least corner of the box.
    pub min: [f32; 3],
    /// First sphere of a leaf, or first child.
    pub first: u32,
    /// Greatest corner of the box.
    pub max: [f32; 3],
    /// Spheres of a leaf; 0 for an inner node.
    pub count: u32,
}

/// `Tiled` in `shaders/surface.wgsl`.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
pub struct TiledPlane {
    /// Tiles a unit, along x and z.
    pub per_unit: [f32; 2],
    /// Fraction of the index at the viewpoint.
    pub fraction: [f32; 2],
    /// Ambient reflectivity of the other material.
    pub altmaterial: [f32; 3],
    /// Sum of the two parities.
    pub parity: f32,
}

/// `Pplane` in `shaders/surface.wgsl`.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
pub struct ProceduralPlane {
    /// Tiles a unit, along x, y, z.
    pub per_unit: [f32; 3],
    /// Nothing.
    pub unused_0: u32,
    /// Fraction of the index at the viewpoint.
    pub fraction: [f32; 3],
    /// Nothing.
    pub unused_1: u32,
    /// Parities, 0 or 1.
    pub parity: [f32; 3],
    /// Nothing.
    pub unused_2: u32,
    /// Factors of x and y, then what is subtracted from them.
    pub from_point: [f32; 4],
}

/// `Job` in `shaders/bindings.wgsl`: the rectangle of one dispatch.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Eq, Pod, Zeroable)]
pub struct Job {
    /// Column and row (from the bottom) of the top left pixel.
    pub first: [u32; 2],
    /// Columns and rows.
    pub size: [u32; 2],
}

/// The camera's numbers, which go into the text of the shader.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CameraText {
    /// Pixel next to the viewpoint.
    pub anchor: [i32; 2],
    /// From one pixel to the next.
    pub step: [f32; 2],
    /// W.x and W.y at the anchor.
    pub offset: [f32; 2],
    /// −W.z.
    pub distance: f32,
    /// 255 / 2^scale.
    pub gain: f32,
}

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
}

impl Kind {
    /// The low byte: families of up to 64 shaders each.
    pub fn code(self) -> u32 {
        match self {
            Self::Plain => 0,
            Self::Tiled => 1,
            Self::Pplane(shader) => 64 + shader,
            Self::SmallPsphere(shader) => 128 + shader,
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
        }
    }
}

/// The whole scene, packed.
#[derive(Debug, Clone)]
pub struct Packed {
    /// The camera.
    pub camera: CameraText,
    /// One for each object of the scene.
    pub objects: Vec<Object>,
    /// The kinds of the objects that a ray can hit.
    pub kinds: Vec<Kind>,
    /// Planes that a primary ray can hit.
    pub planes: Vec<Plane>,
    /// The tree over the small spheres, empty without; they stand in its order.
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
}

impl Packed {
    /// Rounds a prepared scene to f32.
    pub fn new(scene: &Prepared<f64>) -> Self {
        let mut packed = Self {
            camera: camera(&scene.camera),
            objects: scene.materials.iter().map(|&m| object(scene.ambient[m])).collect(),
            kinds: Vec::new(),
            planes: Vec::new(),
            bvh: scene.bvh.iter().flat_map(|bvh| &bvh.nodes).map(bvh_node).collect(),
            bvh_depth: scene.bvh.as_ref().map_or(0, |bvh| bvh.depth),
            small_spheres: Vec::new(),
            wide_spheres: Vec::new(),
            tiled_planes: Vec::new(),
            pplanes: Vec::new(),
        };
        for plane in &scene.planes {
            packed.planes.push(pack_plane(plane));
            packed.surface_of_plane(scene, plane.object);
        }
        for sphere in &scene.spheres {
            let object = sphere.object;
            let psphere = match scene.surfaces[object] {
                prepare::Surface::Psphere(shader) => Some(shader),
                _ => None,
            };
            let (kind, record) = if let Some(seen) = &sphere.seen {
                packed.small_spheres.push(small_sphere(sphere, seen));
                (psphere.map(Kind::SmallPsphere), packed.small_spheres.len() - 1)
            } else {
                packed.wide_spheres.push(wide_sphere(sphere));
                (psphere.map(Kind::WidePsphere), packed.wide_spheres.len() - 1)
            };
            packed.set_kind(object, kind.unwrap_or(Kind::Plain), record);
        }
        packed.kinds.sort_unstable();
        packed.kinds.dedup();
        packed
    }

    fn surface_of_plane(&mut self, scene: &Prepared<f64>, object: usize) {
        match &scene.surfaces[object] {
            prepare::Surface::Tiled(tiled) => {
                self.tiled_planes.push(tiled_plane(scene, tiled));
                self.set_kind(object, Kind::Tiled, self.tiled_planes.len() - 1);
            }
            prepare::Surface::Pplane(pplane) => {
                self.pplanes.push(procedural_plane(pplane));
                self.set_kind(object, Kind::Pplane(pplane.shader), self.pplanes.len() - 1);
            }
            _ => self.set_kind(object, Kind::Plain, 0),
        }
    }

    fn set_kind(&mut self, object: usize, kind: Kind, record: usize) {
        // A plain object needs no record; the others are far fewer than 2²⁴ before any buffer is full.
        self.objects[object].kind = if kind == Kind::Plain { 0 } else { kind.code() | ((record as u32) << 8) };
        if self.kinds.last() != Some(&kind) {
            self.kinds.push(kind);
        }
    }

    /// How many objects a ray can hit.
    pub fn tested(&self) -> usize {
        self.planes.len() + self.small_spheres.len() + self.wide_spheres.len()
    }

    /// About how many tests a ray costs: a tree's spheres cost by their number's logarithm.
    pub fn tests(&self) -> usize {
        let small = if self.bvh.is_empty() { self.small_spheres.len() } else { 8 * self.bvh_depth };
        self.planes.len() + small + self.wide_spheres.len()
    }

    /// Iterations of the loops over objects outside the tree.
    pub fn loop_iterations(&self) -> usize {
        let small = if self.bvh.is_empty() { self.small_spheres.len() } else { 0 };
        self.planes.len() + small + self.wide_spheres.len()
    }
}

fn f32x3(v: V3<f64>) -> [f32; 3] {
    [v.x as f32, v.y as f32, v.z as f32]
}

fn camera(camera: &prepare::Camera<f64>) -> CameraText {
    CameraText {
        anchor: camera.anchor,
        step: camera.step.map(|v| v as f32),
        offset: camera.offset.map(|v| v as f32),
        distance: camera.distance as f32,
        gain: (255.0 * prepare::exact::two_to(-camera.scale)) as f32,
    }
}

fn object(ambient: V3<f64>) -> Object {
    Object { ambient: f32x3(ambient), kind: 0 }
}

fn pack_plane(plane: &prepare::Plane<f64>) -> Plane {
    Plane {
        inverse: plane.inverse.map(|v| v as f32),
        object: plane.object as u32,
        front: plane.front.map_or([0.0; 3], |f| f.map(|v| v as f32)),
        unused: 0,
    }
}

fn bvh_node(node: &prepare::bvh::Node) -> BvhNode {
    BvhNode { min: node.min, first: node.first, max: node.max, count: node.count }
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

fn tiled_plane(scene: &Prepared<f64>, tiled: &Tiled<f64>) -> TiledPlane {
    TiledPlane {
        per_unit: tiled.index.map(|i| i.per_unit as f32),
        fraction: tiled.index.map(|i| i.fraction as f32),
        altmaterial: f32x3(scene.ambient[tiled.altmaterial]),
        parity: tiled.index.iter().map(|i| i.parity as f32).sum(),
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
        from_point: [x.per_unit as f32, y.per_unit as f32, x.offset as f32, y.offset as f32],
    }
}
