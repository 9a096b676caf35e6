//! The flat records, laid out as the structs of `shaders/` (a test compares the offsets with naga's).

use bytemuck::{Pod, Zeroable};

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

/// `Rectangle` in `shaders/plane.wgsl`.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
pub struct Rectangle {
    /// 1/s over (W.x, W.y, 1).
    pub inverse: [f32; 3],
    /// Index of the object.
    pub object: u32,
    /// ≥ 0 over (x, y, 1) where the hit counts; zeros where it always does.
    pub front: [f32; 3],
    /// Nothing.
    pub unused: u32,
    /// p_0/s over (W.x, W.y, 1).
    pub side_0: [f32; 3],
    /// Length of the first side.
    pub length_0: f32,
    /// p_1/s over (W.x, W.y, 1).
    pub side_1: [f32; 3],
    /// Length of the second side.
    pub length_1: f32,
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
    /// Tiles a unit along the first direction, times the direction.
    pub row_0: [f32; 3],
    /// Fraction of the index at the viewpoint.
    pub fraction_0: f32,
    /// The same for the second direction.
    pub row_1: [f32; 3],
    /// The same for the second direction.
    pub fraction_1: f32,
    /// Ambient reflectivity of the other material.
    pub altmaterial: [f32; 3],
    /// Index of the other material.
    pub altindex: u32,
    /// The parities together: odd sums have the other material.
    pub parity: f32,
    /// Nothing: a vec3 starts at a multiple of 16 bytes, and the struct ends at one.
    pub padding: [u32; 3],
    /// Nothing.
    pub unused: [f32; 3],
    /// Nothing.
    pub padding_end: u32,
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
    /// 1 / 2^scale.
    pub unit: f32,
}

/// `Texplane` in `shaders/surface.wgsl`.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
pub struct Texplane {
    /// Texels a unit along the first side, times its direction.
    pub row_0: [f32; 3],
    /// What is subtracted.
    pub origin_0: f32,
    /// The same for the second side.
    pub row_1: [f32; 3],
    /// The same for the second side.
    pub origin_1: f32,
    /// Columns and rows of the texture.
    pub size: [u32; 2],
    /// Its first texel.
    pub first: u32,
    /// 1 where the picture repeats.
    pub repeats: u32,
}

/// `Object` in `shaders/surface.wgsl`, of a lit scene.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Eq, Pod, Zeroable)]
pub struct LitObject {
    /// Index of the material.
    pub material: u32,
    /// As in [`Object`].
    pub kind: u32,
    /// Number of the surface that it is or is part of.
    pub group: u32,
    /// Index into the planes, or into the spheres with the highest bit set.
    pub place: u32,
}

/// `Material` in `shaders/surface.wgsl`.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
pub struct Material {
    /// Ambient reflectivity.
    pub ambient: [f32; 3],
    /// Share of light that goes through.
    pub transparency: f32,
    /// Diffuse reflectivity.
    pub diffuse: [f32; 3],
    /// Exponent of the glint, 0 for none.
    pub shininess: f32,
    /// Specular reflectivity.
    pub specular: [f32; 3],
    /// Nothing.
    pub unused_0: u32,
    /// What tints light that goes through.
    pub tint: [f32; 3],
    /// Nothing.
    pub unused_1: u32,
}

/// `Light` in `shaders/light.wgsl`.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
pub struct Light {
    /// From the viewpoint.
    pub location: [f32; 3],
    /// Cosine of the half angle; −2 for a light without a cone.
    pub cosine: f32,
    /// How bright it is.
    pub emissivity: [f32; 3],
    /// Nothing.
    pub unused_0: u32,
    /// A spotlight's axis.
    pub axis: [f32; 3],
    /// Nothing.
    pub unused_1: u32,
}

/// `WorldPlane` in `shaders/plane.wgsl`.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
pub struct WorldPlane {
    /// Unit normal.
    pub normal: [f32; 3],
    /// normal·P on the plane.
    pub offset: f32,
    /// Factors of a hit point: 0 for the plane's own coordinate, else 1.
    pub keep: [f32; 3],
    /// Number of the surface.
    pub group: u32,
    /// The plane's own coordinate, else 0.
    pub own: [f32; 3],
    /// Index of the object.
    pub object: u32,
    /// Direction of the first side.
    pub row_0: [f32; 3],
    /// What is subtracted.
    pub origin_0: f32,
    /// Direction of the second side.
    pub row_1: [f32; 3],
    /// What is subtracted.
    pub origin_1: f32,
    /// Lengths of the sides.
    pub lengths: [f32; 2],
    /// Bit i: light i lies in the plane.
    pub level: u32,
    /// 1 for a rectangle.
    pub bounded: u32,
}

/// `WorldSphere` in `shaders/sphere.wgsl`.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
pub struct WorldSphere {
    /// From the viewpoint.
    pub center: [f32; 3],
    /// Its radius.
    pub radius: f32,
    /// Number of the surface.
    pub group: u32,
    /// Index of the object.
    pub object: u32,
    /// Bit i: light i lies on the sphere.
    pub level: u32,
    /// Its number among the small spheres plus one; 0 for none.
    pub seen: u32,
}
