//! The flat records, laid out as the structs of `shaders/` (a test compares the offsets with naga's).

use bytemuck::{Pod, Zeroable};

/// `Object` in `shaders/surface.wgsl`.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
pub struct Object {
    /// Ambient reflectivity of the material.
    pub ambient: [f32; 3],
    /// [`Kind`](super::Kind) in the low byte, the index of its record above.
    pub kind: u32,
}

/// `Plane` in `shaders/plane.wgsl`.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
pub struct Plane {
    /// 1/s over (X, Y, 1), the pixel from the camera's anchor.
    pub inverse: [f32; 3],
    /// Index of the object.
    pub object: u32,
    /// ≥ 0 over (X, Y, 1) where the hit counts.
    pub front: [f32; 3],
    /// Number of the surface, where others share it; else 0.
    pub group: u32,
    /// Bound of the error of 1/s.
    pub inverse_error: f32,
    /// Bound of the error of `front`.
    pub front_error: f32,
    /// Nothing.
    pub unused: [f32; 2],
}

/// `Rectangle` in `shaders/plane.wgsl`.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
pub struct Rectangle {
    /// 1/s over (X, Y, 1).
    pub inverse: [f32; 3],
    /// Index of the object.
    pub object: u32,
    /// ≥ 0 over (X, Y, 1) where the hit counts.
    pub front: [f32; 3],
    /// As in a [`Plane`].
    pub group: u32,
    /// ≥ 0 over (X, Y, 1) on the inner side of the first side, and so on.
    pub side_0: [f32; 3],
    /// Bound of the error of 1/s.
    pub inverse_error: f32,
    /// The side next to it.
    pub side_1: [f32; 3],
    /// Bound of the error of `front`.
    pub front_error: f32,
    /// The side opposite the first.
    pub side_2: [f32; 3],
    /// Nothing.
    pub unused_0: u32,
    /// The side opposite the second.
    pub side_3: [f32; 3],
    /// Nothing.
    pub unused_1: u32,
    /// Bounds of the errors of the four sides.
    pub side_errors: [f32; 4],
}

/// `Sphere` in `shaders/sphere.wgsl`.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
pub struct Sphere {
    /// e·W over (X, Y, 1), the pixel from `anchor`.
    pub along: [f32; 3],
    /// |C|/(|C|² − r²).
    pub gain: f32,
    /// The discriminant's coefficients of X², XY, Y².
    pub square: [f32; 3],
    /// Index of the object.
    pub object: u32,
    /// The discriminant's coefficients of X, Y, 1.
    pub affine: [f32; 3],
    /// Bound of the error of `along`.
    pub along_error: f32,
    /// Where X and Y start.
    pub anchor: [i32; 2],
    /// Bound of the error of the discriminant.
    pub disc_error: f32,
    /// 1/s is no larger; where spheres are many.
    pub most: f32,
}

/// `SphereHit` in `shaders/sphere.wgsl`: (H − C)/(r·s) = forms − center·√disc.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
pub struct SphereHit {
    /// First component over (X, Y, 1).
    pub form_x: [f32; 3],
    /// Bound of the errors of the forms, as a vector.
    pub form_error: f32,
    /// Second component.
    pub form_y: [f32; 3],
    /// gain·|C|/r.
    pub center_size: f32,
    /// Third component.
    pub form_z: [f32; 3],
    /// Nothing.
    pub unused_0: u32,
    /// gain·C/r.
    pub center: [f32; 3],
    /// Nothing.
    pub unused_1: u32,
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
    /// Nothing: a vec2 starts at a multiple of 8 bytes.
    pub padding: u32,
    /// Lengths of the rows.
    pub spread: [f32; 2],
    /// Bounds of the indices' errors, but for what the position's error adds.
    pub errors: [f32; 2],
    /// Nothing: the struct ends at a multiple of 16 bytes.
    pub padding_end: [u32; 2],
}

/// `Pplane` in `shaders/surface.wgsl`.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
pub struct ProceduralPlane {
    /// Tiles a unit, along x, y, z.
    pub per_unit: [f32; 3],
    /// Bound of the indices' errors, but for what the position's error adds.
    pub index_error: f32,
    /// Fraction of the index at the viewpoint.
    pub fraction: [f32; 3],
    /// The same for `from_point`.
    pub from_point_error: f32,
    /// Parities, 0 or 1.
    pub parity: [f32; 3],
    /// Nothing.
    pub unused: u32,
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
    /// 0, which only the host knows.
    pub zero: u32,
    /// Records that the list of pixels with doubtful samples has room for; 0 where there is no list.
    pub room: u32,
}

/// The camera in `Job`, where the shader reads it from there: behind what [`Job`] has.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
pub struct CameraNumbers {
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
    /// Nothing.
    pub unused: u32,
}

/// What the shader is told of the camera.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PackedCamera {
    /// Its numbers, which go into the text of the shader as a rule.
    pub numbers: CameraNumbers,
    /// Bound of the error of W, as a vector.
    pub w_error: f32,
    /// κ ≥ 1 (docs/NUMERICS.md): the terms that W·W is a sum of, over W·W.
    pub spread: f32,
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
    /// Lengths of the rows.
    pub spread: [f32; 2],
    /// Bounds of the indices' errors, but for what the position's error adds.
    pub errors: [f32; 2],
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
    /// The exponent if it is a whole number from 1 to 1023, else 0.
    pub power: u32,
    /// What tints light that goes through.
    pub tint: [f32; 3],
    /// 1 − transparency.
    pub kept: f32,
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
    /// Length of `location`.
    pub size: f32,
    /// A spotlight's axis.
    pub axis: [f32; 3],
    /// Nothing.
    pub unused: u32,
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
    /// A hit counts only up to this z.
    pub highest: f32,
    /// Bound of the errors of the coordinates on the rectangle, but for what the position's error adds.
    pub sides_error: f32,
    /// Nothing.
    pub unused: [f32; 2],
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
    /// Length of `center`.
    pub size: f32,
    /// 1 / radius.
    pub inverse_radius: f32,
    /// Nothing.
    pub unused_0: u32,
    /// Nothing.
    pub unused_1: u32,
    /// Nothing.
    pub unused_2: u32,
}
