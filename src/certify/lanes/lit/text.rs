//! Scenes with lights: `shaders/` for the lanes of a vector, written by `src/lower` from the WGSL. Change that, and run
//! its test with `UPDATE_EXPECT=1`.

use std::mem::offset_of;

use fearless_simd::Simd;

use super::{Scene, by_hand, records};
use crate::certify::lanes::gather::Gather;
use crate::certify::lanes::vector::*;

/// What the text refers to by name.
pub(super) mod constants {
    pub(in crate::certify::lanes) const GROWTH: f32 = 1.0001;
    pub(in crate::certify::lanes) const U: f32 = 5.9610606e-8;
    pub(in crate::certify::lanes) const TINY_SQUARE: f32 = 7.70372e-34;
    pub(in crate::certify::lanes) const FARTHEST: f32 = 1099511600000.0;
    pub(in crate::certify::lanes) const LEAST_INVERSE: f32 = 9.094947e-13;
    pub(in crate::certify::lanes) const DIR_LIMIT: f32 = 0.0078125;
    pub(in crate::certify::lanes) const FIRST_ORDER: f32 = 128.0;
    pub(in crate::certify::lanes) const SECOND_ORDER: f32 = 1.0100001;
    pub(in crate::certify::lanes) const ROOT_NEAR: f32 = 1.0100001;
    pub(in crate::certify::lanes) const ROOT_FAR: f32 = 0.54;
    pub(in crate::certify::lanes) const ROOT_FAR_FROM: f32 = 4.0;
    pub(in crate::certify::lanes) const HIT_ROUNDINGS: f32 = 7.5;
    pub(in crate::certify::lanes) const WEIGHT_LEAST: f32 = 41.0;
    pub(in crate::certify::lanes) const WEIGHT_MOST: f32 = 131.0;
    pub(in crate::certify::lanes) const FLUSHED: f32 = 1.4901161e-8;
    pub(in crate::certify::lanes) const PLANE_ROUNDINGS: f32 = 6.5;
    pub(in crate::certify::lanes) const STEEP: f32 = 2.0;
    pub(in crate::certify::lanes) const STEEP_SLOPE: f32 = 2.0;
    pub(in crate::certify::lanes) const DISTANCE_ROUNDINGS: f32 = 12.5;
    pub(in crate::certify::lanes) const LOWERED: f32 = 0.99999905;
    pub(in crate::certify::lanes) const RIVAL_ROUNDINGS: f32 = 4.0;
    pub(in crate::certify::lanes) const POSITION_ROUNDINGS: f32 = 5.5;
    pub(in crate::certify::lanes) const PLANE_NORMAL_ROUNDINGS: f32 = 1.5;
    pub(in crate::certify::lanes) const TURN: f32 = 1.0200001;
    pub(in crate::certify::lanes) const TURN_MORE: f32 = 2.0;
    pub(in crate::certify::lanes) const PERPENDICULAR_ROUNDINGS: f32 = 18.5;
    pub(in crate::certify::lanes) const SQUARE_SLOPE: f32 = 2.0100002;
    pub(in crate::certify::lanes) const DISC_ROUNDINGS: f32 = 11.5;
    pub(in crate::certify::lanes) const ROOT_ROUNDINGS: f32 = 14.5;
    pub(in crate::certify::lanes) const FAR_GROWTH: f32 = 1.0400001;
    pub(in crate::certify::lanes) const GRADIENT_ROUNDINGS: f32 = 7.5;
    pub(in crate::certify::lanes) const MOMENT_ROUNDINGS: f32 = 15.0;
    pub(in crate::certify::lanes) const BORDER_ROUNDINGS: f32 = 2.5;
    pub(in crate::certify::lanes) const QUOTIENT_FROM: f32 = 8.0;
    pub(in crate::certify::lanes) const QUOTIENT_GROWTH: f32 = 1.1500001;
    pub(in crate::certify::lanes) const LEAST_SLOPE: f32 = 9.094947e-13;
    pub(in crate::certify::lanes) const NEAREST: f32 = 9.094947e-13;
    pub(in crate::certify::lanes) const CLOSEST: f32 = 1.2676506e30;
    pub(in crate::certify::lanes) const QUADRIC_FLUSHED: f32 = 1.880791e-37;
    pub(in crate::certify::lanes) const NORMAL_ROUNDINGS: f32 = 7.5;
    pub(in crate::certify::lanes) const UNIT_ROUNDINGS: f32 = 5.0;
    pub(in crate::certify::lanes) const AIM_ROUNDINGS: f32 = 6.0;
    pub(in crate::certify::lanes) const DIRECTION_ROUNDINGS: f32 = 10.0;
    pub(in crate::certify::lanes) const DOT_ROUNDINGS: f32 = 5.5;
    pub(in crate::certify::lanes) const HEIGHT_ROUNDINGS: f32 = 2.5;
    pub(in crate::certify::lanes) const CLOSE_FROM: f32 = 4.0;
    pub(in crate::certify::lanes) const CLOSE: f32 = 1.4000001;
    pub(in crate::certify::lanes) const HEIGHT_SLOPE: f32 = 1.75;
    pub(in crate::certify::lanes) const TOWARD_ROUNDINGS: f32 = 1.5;
    pub(in crate::certify::lanes) const LIMIT_ROUNDINGS: f32 = 13.0;
    pub(in crate::certify::lanes) const CONE_ROUNDINGS: f32 = 7.5;
    pub(in crate::certify::lanes) const BEYOND_ROUNDINGS: f32 = 4.5;
    pub(in crate::certify::lanes) const PICTURE_ROUNDINGS: f32 = 13.5;
    pub(in crate::certify::lanes) const LIGHT_ROUNDINGS: f32 = 17.0;
    pub(in crate::certify::lanes) const PANE_ROUNDINGS: f32 = 4.5;
    pub(in crate::certify::lanes) const HALF_ROUNDINGS: f32 = 2.5;
    pub(in crate::certify::lanes) const MOST_SHININESS: f32 = 1048576.0;
    pub(in crate::certify::lanes) const APART_ROUNDINGS: f32 = 14.0;
    pub(in crate::certify::lanes) const LOG_ROUNDINGS: f32 = 16.5;
    pub(in crate::certify::lanes) const POWER_ROUNDINGS: f32 = 25.0;
    pub(in crate::certify::lanes) const SUM_ROUNDINGS: f32 = 3.0;
    pub(in crate::certify::lanes) const SHARE_ROUNDINGS: f32 = 13.5;
    pub(in crate::certify::lanes) const MIRROR_TURN: f32 = 2.0400002;
    pub(in crate::certify::lanes) const MIRROR_GROWTH: f32 = 1.00001;
    pub(in crate::certify::lanes) const LINE_ROUNDINGS: f32 = 6.0;
    pub(in crate::certify::lanes) const WEIGHT_ROUNDINGS: f32 = 2.5;
    pub(in crate::certify::lanes) const PANE_WEIGHT_ROUNDINGS: f32 = 5.0;
    pub(in crate::certify::lanes) const WEIGHT_GROWTH: f32 = 8.0;
    pub(in crate::certify::lanes) const PATH_ROUNDINGS: f32 = 2.5;
    pub(in crate::certify::lanes) const MIRROR_ROUNDINGS: f32 = 14.0;
    pub(in crate::certify::lanes) const BOUNCE_ROUNDINGS: f32 = 36.0;
    pub(in crate::certify::lanes) const INDEX_ROUNDINGS: f32 = 5.5;
    pub(in crate::certify::lanes) const MOST_INDEX: f32 = 1048576.0;
    pub(in crate::certify::lanes) const WHEEL_FAR: f32 = 1024.0;
    pub(in crate::certify::lanes) const WHEEL_SLOPE: f32 = 3.0;
    pub(in crate::certify::lanes) const WHEEL_ROUNDINGS: f32 = 24.0;
    pub(in crate::certify::lanes) const BOX_ROUNDINGS: f32 = 4.0;
    pub(in crate::certify::lanes) const BVH_DEPTH: u32 = 1;
    pub(in crate::certify::lanes) const STACK: u32 = 8;
    pub(in crate::certify::lanes) const KIND_TILED: u32 = 1;
    pub(in crate::certify::lanes) const KIND_TEXTURED: u32 = 2;
    pub(in crate::certify::lanes) const KIND_PPLANE_0: u32 = 64;
    pub(in crate::certify::lanes) const KIND_PPLANE_1: u32 = 65;
    pub(in crate::certify::lanes) const KIND_PPLANE_2: u32 = 66;
    pub(in crate::certify::lanes) const KIND_PSPHERE_0: u32 = 128;
    pub(in crate::certify::lanes) const UNDECIDED: u32 = 4278190080;
    pub(in crate::certify::lanes) const T_MAX: f32 = 1e30;
    pub(in crate::certify::lanes) const BVH_NEAR: f32 = 0.999998;
    pub(in crate::certify::lanes) const BVH_FAR: f32 = 1.000004;
    pub(in crate::certify::lanes) const HALF_ROOT_3: f32 = 0.8660254;
    pub(in crate::certify::lanes) const NOTHING: u32 = 4294967295;
    pub(in crate::certify::lanes) const STEPS_LIMIT: u32 = 50000;
    pub(in crate::certify::lanes) const T_FAR: f32 = 1e30;
    pub(in crate::certify::lanes) const QUADRIC_BIT: u32 = 1073741824;
    pub(in crate::certify::lanes) const SPHERE_BIT: u32 = 2147483648;
}

/// What is private to the lanes.
pub(super) struct State<S: Simd> {
    pub doubt: M<S>,
    pub stack: [Branch<S>; 8],
    pub waiting: U<S>,
}

impl<S: Simd> State<S> {
    #[inline(always)]
    pub(super) fn new(simd: S) -> Self {
        Self {
            doubt: <M<S>>::zero(simd),
            stack: [<Branch<S>>::zero(simd); 8],
            waiting: <U<S>>::zero(simd),
        }
    }
}

record! {
/// A ray of the tree.
Branch {
    ray: SecondaryRay<S>,
    total: F<S>,
    total_error: F<S>,
    last: U<S>,
    weight: Vec3<F<S>>,
    weight_error: F<S>,
}
}

record! {
/// How a ray passes a sphere.
ClosestApproach {
    perpendicular: Vec3<F<S>>,
    apart: F<S>,
    along: F<S>,
    off: F<S>,
}
}

record! {
Hit {
    inverse: F<S>,
    object: U<S>,
    index: U<S>,
    error: F<S>,
    rival: F<S>,
    group: U<S>,
}
}

record! {
/// A surface as a ray meets it.
Intersection {
    t: F<S>,
    hit: M<S>,
    error: F<S>,
    possible: M<S>,
    low: F<S>,
    high: F<S>,
}
}

record! {
/// How light comes through a picture.
Passage {
    passes: M<S>,
    sure: M<S>,
    index: Vec2<F<S>>,
    errors: Vec2<F<S>>,
}
}

record! {
/// Where a ray of the tree hit, and how far that is along it.
PathPoint {
    point: Point<S>,
    t: F<S>,
    t_error: F<S>,
    slip: Vec2<F<S>>,
}
}

/// What a procedural plane's shader is told about the hit.
#[derive(Clone, Copy)]
pub(super) struct PlanePoint<'a, S: Simd> {
    pub point: Point<S>,
    pub ambient: Vec3<F<S>>,
    pub plane: Gather<'a, records::ProceduralPlane, S>,
}

record! {
/// A hit point.
Point {
    object: U<S>,
    position: Vec3<F<S>>,
    error: F<S>,
    size: F<S>,
    direct: M<S>,
    pixel: Vec2<I<S>>,
    from_center: Vec3<F<S>>,
    from_center_error: F<S>,
    normal: Vec3<F<S>>,
    normal_error: F<S>,
    group: U<S>,
    low_light: U<S>,
    height: F<S>,
    lights_on_surface: U<S>,
}
}

record! {
/// An object as a primary ray meets it.
PrimaryIntersection {
    inverse: F<S>,
    hit: M<S>,
    error: F<S>,
    possible: M<S>,
}
}

record! {
/// Where a ray meets a quadric first.
QuadricHit {
    t: F<S>,
    hit: M<S>,
    error: F<S>,
    possible: M<S>,
    low: F<S>,
    high: F<S>,
}
}

record! {
/// How a line passes a quadric.
QuadricPassage {
    perpendicular: Vec3<F<S>>,
    along: F<S>,
    gradient: Vec3<F<S>>,
    turn: Vec3<F<S>>,
    off: F<S>,
    gradient_error: F<S>,
    turn_error: F<S>,
}
}

record! {
/// A ray as quadrics see it.
QuadricRay {
    base: Vec3<F<S>>,
    dir: Vec3<F<S>>,
    start: F<S>,
    base_error: F<S>,
    dir_error: F<S>,
    size: F<S>,
    start_error: F<S>,
}
}

record! {
/// What of the scene a ray sees.
Range {
    skip: U<S>,
    light: U<S>,
    beyond: F<S>,
    limit: F<S>,
    beyond_error: F<S>,
    limit_error: F<S>,
}
}

record! {
/// A primary ray: base viewpoint (the origin), direction w through the screen, not of unit length.
Ray {
    pixel: Vec2<I<S>>,
    offset: Vec2<F<S>>,
    w: Vec3<F<S>>,
    w2: F<S>,
    inverse_length: F<S>,
}
}

record! {
/// A root: where the line meets the surface.
Root {
    t: F<S>,
    error: F<S>,
    counts: M<S>,
    out: M<S>,
}
}

record! {
/// The closest hit: its distance, and the object; NOTHING if there is none.
SecondaryHit {
    t: F<S>,
    object: U<S>,
    error: F<S>,
    low: F<S>,
    rival: F<S>,
    group: U<S>,
}
}

record! {
/// A ray from anywhere; positions are from the viewpoint.
SecondaryRay {
    base: Vec3<F<S>>,
    dir: Vec3<F<S>>,
    base_error: F<S>,
    dir_error: F<S>,
    start_error: F<S>,
    size: F<S>,
}
}

record! {
/// A colour, and the bound of its error.
Shade {
    color: Vec3<F<S>>,
    error: Vec3<F<S>>,
}
}

record! {
/// The transmittance: what of a light reaches the point.
Shadow {
    transmittance: Vec3<F<S>>,
    open: M<S>,
    sure: M<S>,
    roundings: F<S>,
}
}

record! {
/// What a procedural sphere's shader is told about the hit.
SpherePoint {
    from_center: Vec3<F<S>>,
    error: F<S>,
    ambient: Vec3<F<S>>,
}
}

record! {
/// What a ray brings: 255 times its colour, and 0 or UNDECIDED.
Traced {
    color: Vec3<F<S>>,
    error: Vec3<F<S>>,
    verdict: U<S>,
}
}

/// How far the ray passes from the middle of pixel `anchor`, in pixels.
#[inline(always)]
pub(super) fn from_pixel<'a, S: Simd>(
    scene: &'a Scene<'a, S>,
    ray: Ray<S>,
    anchor: Vec2<I<S>>,
) -> Vec2<F<S>> {
    (ray.pixel - anchor).map(|v| v.as_f32()) + ray.offset
}

/// The ray through a pixel, (0, 0) at the bottom left. Near the viewpoint's own column and row (CAMERA_ANCHOR) w.x and
/// w.y are small, and keep their relative accuracy.
#[inline(always)]
pub(super) fn camera_getdir<'a, S: Simd>(
    scene: &'a Scene<'a, S>,
    pixel: Vec2<I<S>>,
    offset: Vec2<F<S>>,
) -> Ray<S> {
    let mut ray = <Ray<S>>::zero(scene.simd);
    ray.offset = offset;
    ray.pixel = pixel;
    let pixel_2 = from_pixel(scene, ray, scene.vec2_i32(scene.camera_anchor));
    ray.w = Vec3::new(
        (pixel_2 * scene.vec2(scene.camera_step) + scene.vec2(scene.camera_offset)).x,
        (pixel_2 * scene.vec2(scene.camera_step) + scene.vec2(scene.camera_offset)).y,
        scene.f32(-scene.camera_distance),
    );
    ray.w2 = ray.w.dot(ray.w);
    ray.inverse_length = ray.w2.inverse_sqrt();
    ray
}

/// The bytes of a pixel from 255 times its value, truncated; red lowest.
#[inline(always)]
pub(super) fn camera_setpix<'a, S: Simd>(
    scene: &'a Scene<'a, S>,
    color: Vec3<F<S>>,
    error: Vec3<F<S>>,
) -> U<S> {
    let value = color
        .zip(Vec3::splat(scene.f32(0.5)), |v, low| v.max(low))
        .zip(Vec3::splat(scene.f32(255.5)), |v, high| v.min(high));
    let nearest = value.map(|v| v.round());
    let decided = (value - nearest)
        .map(|v| v.abs())
        .zip(error, |a, b| a.gt(b))
        | (color - error).zip(Vec3::splat(scene.f32(255.5)), |a, b| a.gt(b));
    let bytes = (nearest.map(|v| v.as_u32())
        - (value - nearest)
            .zip(Vec3::splat(scene.f32(0.0)), |a, b| a.lt(b))
            .select(Vec3::splat(scene.u32(1)), Vec3::splat(scene.u32(0))))
    .zip(Vec3::splat(scene.u32(255)), |a, b| a.min(b));
    bytes.x
        | bytes.y << 8
        | bytes.z << 16
        | decided
            .all()
            .select(scene.u32(0), scene.u32(constants::UNDECIDED))
}

/// A vector of about unit length after a step of Newton's towards it. What is left of a difference of η is 1.5·η².
#[inline(always)]
pub(super) fn unit_step<'a, S: Simd>(scene: &'a Scene<'a, S>, v: Vec3<F<S>>) -> Vec3<F<S>> {
    let square = v.dot(v);
    let v_2 = 1.5 - 0.5 * square;
    let v_3 = v * v_2;
    v_3
}

/// The direction of a primary ray.
#[inline(always)]
pub(super) fn unit_direction<'a, S: Simd>(scene: &'a Scene<'a, S>, ray: Ray<S>) -> Vec3<F<S>> {
    let v = ray.inverse_length;
    let v_2 = ray.w * v;
    let step = unit_step(scene, v_2);
    step
}

/// Where in its pixel a sample's ray passes: the PCG 3D hash of Jarzynski and Olano. `hash` in src/jitter.rs has the
/// same steps, to the bit.
#[inline(always)]
pub(super) fn jitter_hash<'a, S: Simd>(
    scene: &'a Scene<'a, S>,
    pixel: Vec2<I<S>>,
    number: U<S>,
) -> Vec2<F<S>> {
    let mut v = Vec3::new(
        pixel.map(|v| v.as_u32()).x,
        pixel.map(|v| v.as_u32()).y,
        number,
    ) * 1664525
        + Vec3::splat(scene.u32(1013904223));
    v.x = v.x + v.y * v.z;
    v.y = v.y + v.z * v.x;
    v.z = v.z + v.x * v.y;
    v = v ^ v >> Vec3::splat(scene.u32(16));
    v.x = v.x + v.y * v.z;
    v.y = v.y + v.z * v.x;
    (Vec2::new(v.x, v.y) >> Vec2::splat(scene.u32(22))).map(|v| v.as_f32()) * 0.0009765625
        - Vec2::splat(scene.f32(0.5))
}

/// The plane as a primary ray meets it.
#[inline(always)]
pub(super) fn plane_hits<'a, S: Simd>(
    scene: &'a Scene<'a, S>,
    plane: &records::Plane,
    ray: Ray<S>,
) -> PrimaryIntersection<S> {
    let mut intersection = <PrimaryIntersection<S>>::zero(scene.simd);
    let at = from_pixel(scene, ray, scene.vec2_i32(scene.camera_anchor));
    intersection.inverse = plane.inverse[0] * at.x + plane.inverse[1] * at.y + plane.inverse[2];
    let side = plane.front[0] * at.x + plane.front[1] * at.y + plane.front[2];
    intersection.hit = side.gt(scene.f32(plane.front_error));
    intersection.possible = side.gt(scene.f32(-plane.front_error));
    intersection.error = scene.f32(plane.inverse_error);
    intersection
}

/// The rectangle or triangle as a primary ray meets it.
#[inline(always)]
pub(super) fn polygon_hits<'a, S: Simd>(
    scene: &'a Scene<'a, S>,
    polygon: &records::Polygon,
    ray: Ray<S>,
) -> PrimaryIntersection<S> {
    let mut intersection = <PrimaryIntersection<S>>::zero(scene.simd);
    let pixel = from_pixel(scene, ray, scene.vec2_i32(scene.camera_anchor));
    let at = Vec3::new(pixel.x, pixel.y, scene.f32(1.0));
    let sides = Vec4::new(
        scene.vec3(polygon.side_0).dot(at),
        scene.vec3(polygon.side_1).dot(at),
        scene.vec3(polygon.side_2).dot(at),
        scene.vec3(polygon.side_3).dot(at),
    );
    intersection.inverse = scene.vec3(polygon.inverse).dot(at);
    intersection.hit = sides
        .zip(scene.vec4(polygon.side_errors), |a, b| a.gt(b))
        .all();
    intersection.possible = sides
        .zip(-scene.vec4(polygon.side_errors), |a, b| a.gt(b))
        .all();
    let side = scene.vec3(polygon.front).dot(at);
    intersection.hit = intersection.hit & side.gt(scene.f32(polygon.front_error));
    intersection.possible = intersection.possible & side.gt(scene.f32(-polygon.front_error));
    intersection.error = scene.f32(polygon.inverse_error);
    intersection
}

/// The third side of the triangle whose record says so in `bounded`: within, row·P is at least the fourth component.
#[inline(always)]
pub(super) fn third_side<'a, S: Simd>(scene: &'a Scene<'a, S>, bounded: u32) -> Vec4<F<S>> {
    let side = &scene.lit_objects[(scene.third_sides + bounded - 2) as usize];
    Vec4::new(
        scene.u32(side.material),
        scene.u32(side.kind),
        scene.u32(side.group),
        scene.u32(side.place),
    )
    .map(|v| v.float())
}

/// The plane as a ray from anywhere meets it.
#[inline(always)]
pub(super) fn plane_hits_from<'a, S: Simd>(
    scene: &'a Scene<'a, S>,
    plane: &records::WorldPlane,
    ray: SecondaryRay<S>,
    range: Range<S>,
) -> Intersection<S> {
    let mut intersection = <Intersection<S>>::zero(scene.simd);
    let mut margin = <F<S>>::zero(scene.simd);
    let ahead = plane.offset - scene.vec3(plane.normal).dot(ray.base);
    let along = scene.vec3(plane.normal).dot(ray.dir);
    let inverse = 1.0 / along;
    let t = ahead * inverse;
    intersection.t = t;
    let ahead_error = ray.base_error
        + constants::PLANE_ROUNDINGS * constants::U * (plane.offset.abs() + ray.size);
    let along_error = ray.dir_error + constants::PLANE_ROUNDINGS * constants::U;
    let steep =
        along.abs().gt(constants::STEEP * along_error) & t.abs().lt(scene.f32(constants::FARTHEST));
    let slope =
        inverse.abs() * (constants::GROWTH + constants::STEEP_SLOPE * along_error * inverse.abs());
    let error = (ahead_error + t.abs() * along_error) * slope
        + constants::DISTANCE_ROUNDINGS * constants::U * t.abs();
    let start = error + ray.start_error;
    let mut out = steep & t.lt(-start)
        | scene.u32(plane.group).eq(range.skip)
        | (plane.lights_on_surface & range.light).ne(scene.u32(0));
    let above = scene.mask(plane.height > 0.0).select(-ahead, ahead);
    out = out | (plane.low_light & range.light).ne(scene.u32(0)) & above.gt(ahead_error);
    let in_ = steep & t.gt(start) & !out;
    intersection.error = error;
    intersection.low = steep.select(
        t - error,
        (ahead.abs() - ahead_error).max(scene.f32(0.0)) / (along.abs() + along_error)
            * constants::LOWERED,
    );
    intersection.high = steep.select(t + error, scene.f32(constants::T_MAX));
    let position =
        (ray.base + t * ray.dir) * scene.vec3(plane.axis_mask) + scene.vec3(plane.fixed_coordinate);
    let position_error =
        error + constants::POSITION_ROUNDINGS * constants::U * (ray.size + t.abs());
    let below = plane.highest - position.z;
    out = out | in_ & below.lt(-position_error);
    let mut inside = below.gt(position_error);
    if plane.bounded != 0 {
        let p = Vec2::new(
            scene.vec3(plane.row_0).dot(position) - plane.origin_0,
            scene.vec3(plane.row_1).dot(position) - plane.origin_1,
        );
        margin =
            p.x.min(p.y)
                .min((plane.lengths[0] - p.x).min(plane.lengths[1] - p.y));
        if plane.bounded > 1 {
            let third = third_side(scene, plane.bounded);
            margin = margin.min(Vec3::new(third.x, third.y, third.z).dot(position) - third.w);
        }
        let margin_error = constants::SECOND_ORDER * position_error
            + plane.sides_error
            + constants::PLANE_ROUNDINGS * constants::U * (ray.size + t.abs());
        out = out | in_ & margin.lt(-margin_error);
        inside = inside & margin.gt(margin_error);
    }
    intersection.possible = !out;
    intersection.hit = in_ & !out & inside;
    intersection
}

/// What an error in `square`, which is at least that error, is to its root.
#[inline(always)]
pub(super) fn root_error<'a, S: Simd>(
    scene: &'a Scene<'a, S>,
    square: F<S>,
    error: F<S>,
    inverse_root: F<S>,
) -> F<S> {
    error
        * inverse_root
        * square.gt(constants::ROOT_FAR_FROM * error).select(
            scene.f32(constants::ROOT_FAR),
            scene.f32(constants::ROOT_NEAR),
        )
}

/// Above 0 where the ray through the pixel `at`, from the sphere's anchor, meets the sphere.
#[inline(always)]
pub(super) fn sphere_disc<'a, S: Simd>(
    scene: &'a Scene<'a, S>,
    sphere: Gather<'a, records::Sphere, S>,
    at: Vec2<F<S>>,
) -> F<S> {
    (sphere.f32(offset_of!(records::Sphere, square)) * at.x
        + sphere.f32(offset_of!(records::Sphere, square) + 4) * at.y
        + sphere.f32(offset_of!(records::Sphere, affine)))
        * at.x
        + (sphere.f32(offset_of!(records::Sphere, square) + 8) * at.y
            + sphere.f32(offset_of!(records::Sphere, affine) + 4))
            * at.y
        + sphere.f32(offset_of!(records::Sphere, affine) + 8)
}

/// The sphere as a primary ray meets it; a tangent ray misses.
#[inline(always)]
pub(super) fn sphere_hits<'a, S: Simd>(
    scene: &'a Scene<'a, S>,
    sphere: &records::Sphere,
    ray: Ray<S>,
) -> PrimaryIntersection<S> {
    let mut intersection = <PrimaryIntersection<S>>::zero(scene.simd);
    let at = from_pixel(scene, ray, scene.vec2_i32(sphere.anchor));
    let along = sphere.along[0] * at.x + sphere.along[1] * at.y + sphere.along[2];
    let disc = sphere_disc(scene, scene.same(&sphere), at);
    intersection.hit =
        disc.gt(scene.f32(sphere.disc_error)) & along.gt(scene.f32(sphere.along_error));
    intersection.possible =
        disc.gt(scene.f32(-sphere.disc_error)) & along.gt(scene.f32(-sphere.along_error));
    let least = disc.max(scene.f32(sphere.disc_error));
    let inverse_root = least.inverse_sqrt();
    intersection.inverse = sphere.gain * (along + least * inverse_root);
    let error = root_error(scene, least, scene.f32(sphere.disc_error), inverse_root);
    intersection.error = sphere.gain * (sphere.along_error + error)
        + constants::ROOT_ROUNDINGS * constants::U * intersection.inverse.abs();
    intersection
}

/// The unit normal that a vector within `error` of it stands for; in its fourth component the bound of its error: that
/// of its direction and that of its length together.
#[inline(always)]
pub(super) fn unit_normal<'a, S: Simd>(
    scene: &'a Scene<'a, S>,
    v: Vec3<F<S>>,
    error: F<S>,
) -> Vec4<F<S>> {
    let off = error.min(scene.f32(1.0));
    let known = off.lt(scene.f32(1.0));
    let step = unit_step(scene, known.select(v, Vec3::splat(scene.f32(0.0))));
    Vec4::new(
        step.x,
        step.y,
        step.z,
        known.select(
            off + 2.5 * off * off + constants::UNIT_ROUNDINGS * constants::U,
            scene.f32(1.0),
        ),
    )
}

/// The unit normal at the hit, outward; in its fourth component the bound of its error.
#[inline(always)]
pub(super) fn sphere_normal<'a, S: Simd>(
    scene: &'a Scene<'a, S>,
    index: U<S>,
    ray: Ray<S>,
    hit: Hit<S>,
) -> Vec4<F<S>> {
    let sphere = scene.gather(&scene.spheres, index);
    let point = scene.gather(&scene.sphere_points, index);
    let pixel = from_pixel(
        scene,
        ray,
        sphere.vec2_i32(offset_of!(records::Sphere, anchor)),
    );
    let at = Vec3::new(pixel.x, pixel.y, scene.f32(1.0));
    let disc = sphere_disc(scene, sphere, Vec2::new(at.x, at.y));
    let s = 1.0 / hit.inverse;
    let least = disc.max(sphere.f32(offset_of!(records::Sphere, disc_error)));
    let inverse_root = least.inverse_sqrt();
    let root = least * inverse_root;
    let normal = (Vec3::new(
        point.vec3(offset_of!(records::SphereHit, form_x)).dot(at),
        point.vec3(offset_of!(records::SphereHit, form_y)).dot(at),
        point.vec3(offset_of!(records::SphereHit, form_z)).dot(at),
    ) - point.vec3(offset_of!(records::SphereHit, center)) * root)
        * s;
    let error = root_error(
        scene,
        least,
        sphere.f32(offset_of!(records::Sphere, disc_error)),
        inverse_root,
    );
    let parts_error = point.f32(offset_of!(records::SphereHit, form_error))
        + point.f32(offset_of!(records::SphereHit, center_size))
            * (error + constants::ROOT_ROUNDINGS * constants::U * root);
    let error_2 = constants::SECOND_ORDER * s * (parts_error + hit.error)
        + constants::NORMAL_ROUNDINGS * constants::U;
    let normal_2 = unit_normal(scene, normal, error_2);
    normal_2
}

#[inline(always)]
pub(super) fn closest_approach<'a, S: Simd>(
    scene: &'a Scene<'a, S>,
    center: Vec3<F<S>>,
    radius: F<S>,
    size: F<S>,
    ray: SecondaryRay<S>,
) -> ClosestApproach<S> {
    let mut approach = <ClosestApproach<S>>::zero(scene.simd);
    let to_center = center - ray.base;
    approach.along = to_center.dot(ray.dir);
    let v = to_center - approach.along * ray.dir;
    approach.perpendicular = v;
    approach.apart = approach.perpendicular.dot(approach.perpendicular);
    let far = approach.along.abs() + radius + ray.base_error;
    approach.off = constants::SECOND_ORDER * ray.base_error
        + constants::U * size
        + far
            * ((constants::TURN + constants::TURN_MORE * ray.dir_error) * ray.dir_error
                + constants::PERPENDICULAR_ROUNDINGS * constants::U);
    approach
}

/// The nearer hit, by the perpendicular from the ray to the center.
#[inline(always)]
pub(super) fn sphere_hits_from<'a, S: Simd>(
    scene: &'a Scene<'a, S>,
    sphere: &records::WorldSphere,
    ray: SecondaryRay<S>,
    range: Range<S>,
) -> Intersection<S> {
    let mut intersection = <Intersection<S>>::zero(scene.simd);
    let approach = closest_approach(
        scene,
        scene.vec3(sphere.center),
        scene.f32(sphere.radius),
        scene.f32(sphere.size),
        ray,
    );
    let disc = sphere.radius * sphere.radius - approach.apart;
    let disc_error = approach.off * (constants::SQUARE_SLOPE * sphere.radius + approach.off)
        + constants::DISC_ROUNDINGS * constants::U * sphere.radius * sphere.radius;
    let least = disc.max(disc_error);
    let inverse_root = least.inverse_sqrt();
    let root = least * inverse_root;
    let t = approach.along - root;
    let error = root_error(scene, least, disc_error, inverse_root);
    let error_2 = approach.off
        + error
        + constants::ROOT_ROUNDINGS * constants::U * (approach.along.abs() + root);
    intersection.t = t;
    intersection.error = error_2;
    intersection.low = t - error_2;
    intersection.high = disc
        .gt(disc_error)
        .select(t + error_2, approach.along + approach.off);
    let start = error_2 + ray.start_error;
    let mut out = disc.lt(-disc_error) | t.lt(-start) | scene.u32(sphere.group).eq(range.skip);
    intersection.hit = !out & disc.gt(disc_error) & t.gt(start);
    let on_surface = (sphere.lights_on_surface & range.light).ne(scene.u32(0));
    let entry = range.limit - approach.along;
    out = out | on_surface & entry.lt(-(range.limit_error + error_2));
    intersection.hit = intersection.hit & (!on_surface | entry.gt(range.limit_error + error_2));
    intersection.possible = !out;
    intersection
}

/// H − C over the radius, where a ray from anywhere meets the sphere; in the fourth component the bound of its error.
#[inline(always)]
pub(super) fn sphere_normal_from<'a, S: Simd>(
    scene: &'a Scene<'a, S>,
    sphere: Gather<'a, records::WorldSphere, S>,
    ray: SecondaryRay<S>,
) -> Vec4<F<S>> {
    let approach = closest_approach(
        scene,
        sphere.vec3(offset_of!(records::WorldSphere, center)),
        sphere.f32(offset_of!(records::WorldSphere, radius)),
        sphere.f32(offset_of!(records::WorldSphere, size)),
        ray,
    );
    let disc = sphere.f32(offset_of!(records::WorldSphere, radius))
        * sphere.f32(offset_of!(records::WorldSphere, radius))
        - approach.apart;
    let disc_error = approach.off
        * (constants::SQUARE_SLOPE * approach.apart.sqrt() + approach.off)
        + constants::DISC_ROUNDINGS
            * constants::U
            * sphere.f32(offset_of!(records::WorldSphere, radius))
            * sphere.f32(offset_of!(records::WorldSphere, radius));
    let least = disc.max(disc_error);
    let inverse_root = least.inverse_sqrt();
    let root = least * inverse_root;
    let normal = (approach.perpendicular + root * ray.dir)
        * -sphere.f32(offset_of!(records::WorldSphere, inverse_radius));
    let error = root_error(scene, least, disc_error, inverse_root);
    let reach_error = error + constants::ROOT_ROUNDINGS * constants::U * root;
    let error_2 = constants::SECOND_ORDER * (approach.off + reach_error + root * ray.dir_error);
    let normal_2 = unit_normal(
        scene,
        normal,
        error_2 * sphere.f32(offset_of!(records::WorldSphere, inverse_radius))
            + constants::NORMAL_ROUNDINGS * constants::U,
    );
    normal_2
}

/// floor(index), from the nearest whole number and the side of it that the index lies on: where that side is certain the
/// floor is. (Behind a barrier the index is one number, and its difference from the nearest whole number exact.)
#[inline(always)]
pub(super) fn floor3<'a, S: Simd>(scene: &'a Scene<'a, S>, index: Vec3<F<S>>) -> Vec3<F<S>> {
    let nearest = index.map(|v| v.round());
    nearest
        - (index - nearest)
            .zip(Vec3::splat(scene.f32(0.0)), |a, b| a.lt(b))
            .select(Vec3::splat(scene.f32(1.0)), Vec3::splat(scene.f32(0.0)))
}

/// 1 where the integers are odd, 0 where they are even.
#[inline(always)]
pub(super) fn odd3<'a, S: Simd>(scene: &'a Scene<'a, S>, index: Vec3<F<S>>) -> Vec3<F<S>> {
    index - 2.0 * (index * 0.5).map(|v| v.floor())
}

/// How far a position may be off for an index, per unit of the index's slope.
#[inline(always)]
pub(super) fn index_error<'a, S: Simd>(scene: &'a Scene<'a, S>, point: Point<S>) -> F<S> {
    point.error + constants::INDEX_ROUNDINGS * constants::U * point.size
}

/// Leaves a doubt where an index is no farther from a whole number than its error.
#[inline(always)]
pub(super) fn certain<'a, S: Simd>(
    scene: &'a Scene<'a, S>,
    state: &mut State<S>,
    on: M<S>,
    margin: Vec3<F<S>>,
) {
    state.doubt.set(
        on,
        state.doubt
            | !margin
                .zip(Vec3::splat(scene.f32(0.0)), |a, b| a.gt(b))
                .all(),
    );
}

/// What the host knows of the indices at the hit of a pixel's own ray, from the pixel's column and row: 0 where that is
/// nothing. src/gpu/pack/tables.rs says which bit means what. (The tables are in the buffer of the objects, in the field
/// `kind`, as some drivers allow only ten buffers. Asked only where an index is not certain by itself: loads cost more.)
#[inline(always)]
pub(super) fn index_table<'a, S: Simd>(scene: &'a Scene<'a, S>, point: Point<S>) -> U<S> {
    let first = scene
        .gather(&scene.lit_objects, scene.tables + point.object)
        .u32(offset_of!(records::LitObject, kind));
    let there = point.direct & first.ne(scene.u32(0));
    let column = scene.tables + there.select(first + point.pixel.x.as_u32(), scene.u32(0));
    let row =
        scene.tables + there.select(first + scene.columns + point.pixel.y.as_u32(), scene.u32(0));
    there.select(
        scene
            .gather(&scene.lit_objects, column)
            .u32(offset_of!(records::LitObject, kind))
            | scene
                .gather(&scene.lit_objects, row)
                .u32(offset_of!(records::LitObject, kind)),
        scene.u32(0),
    )
}

/// Which indices of tiles or blocks are known, and what has the parity of their floors.
#[inline(always)]
pub(super) fn index_table_known<'a, S: Simd>(scene: &'a Scene<'a, S>, word: U<S>) -> Vec3<M<S>> {
    (Vec3::splat(word) & Vec3::new(scene.u32(2), scene.u32(8), scene.u32(32)))
        .zip(Vec3::splat(scene.u32(0)), |a, b| a.ne(b))
}

#[inline(always)]
pub(super) fn index_table_odd<'a, S: Simd>(scene: &'a Scene<'a, S>, word: U<S>) -> Vec3<F<S>> {
    (Vec3::splat(word) >> Vec3::new(scene.u32(0), scene.u32(2), scene.u32(4))
        & Vec3::splat(scene.u32(1)))
    .map(|v| v.as_f32())
}

/// Whether a tile is of the plane's own material.
#[inline(always)]
pub(super) fn tplane_foreground<'a, S: Simd>(
    scene: &'a Scene<'a, S>,
    state: &mut State<S>,
    on: M<S>,
    plane: Gather<'a, records::TiledPlane, S>,
    point: Point<S>,
) -> M<S> {
    let position = point.position;
    let mut index = Vec2::new(
        plane
            .vec3(offset_of!(records::TiledPlane, row_0))
            .dot(position)
            + plane.f32(offset_of!(records::TiledPlane, fraction_0)),
        plane
            .vec3(offset_of!(records::TiledPlane, row_1))
            .dot(position)
            + plane.f32(offset_of!(records::TiledPlane, fraction_1)),
    );
    let v = Vec3::new(index.x, index.y, scene.f32(0.0));
    index = Vec2::new(v.x, v.y);
    let v_2 = index;
    let v_3 = index;
    let error = index_error(scene, point);
    let mut margin = (v_2 - v_3.map(|v| v.round())).map(|v| v.abs())
        - (plane.vec2(offset_of!(records::TiledPlane, row_lengths)) * error
            + plane.vec2(offset_of!(records::TiledPlane, errors)));
    let floor3_2 = floor3(
        scene,
        Vec3::new(
            index.x,
            index.y,
            plane.f32(offset_of!(records::TiledPlane, parity)) + 0.5,
        ),
    );
    let mut whole = floor3_2;
    let here = on
        & !margin
            .zip(Vec2::splat(scene.f32(0.0)), |a, b| a.gt(b))
            .all();
    if here.any() {
        let on = here;
        let word = index_table(scene, point);
        let v_4 = margin;
        let known = index_table_known(scene, word);
        margin.set(
            on,
            Vec2::new(known.x, known.y).select(Vec2::splat(scene.f32(1.0)), v_4),
        );
        let v_5 = whole;
        let odd = index_table_odd(scene, word);
        let known_2 = index_table_known(scene, word);
        whole.set(on, known_2.select(odd, v_5));
    }
    certain(
        scene,
        state,
        on,
        Vec3::new(margin.x, margin.y, scene.f32(1.0)),
    );
    let odd_2 = odd3(scene, whole);
    let odd3_2 = odd3(scene, Vec3::splat(odd_2.x + odd_2.y + odd_2.z));
    odd3_2.x.eq(scene.f32(0.0))
}

/// Parities of floor(2·H + 1000), each 0 or 1, for the axes asked for (1, else 0).
#[inline(always)]
pub(super) fn pplane_odd<'a, S: Simd>(
    scene: &'a Scene<'a, S>,
    state: &mut State<S>,
    on: M<S>,
    at: PlanePoint<'a, S>,
    axes: Vec3<F<S>>,
) -> Vec3<F<S>> {
    let mut index = at.point.position
        * at.plane
            .vec3(offset_of!(records::ProceduralPlane, per_unit))
        + at.plane
            .vec3(offset_of!(records::ProceduralPlane, fraction));
    let v = index;
    index = v;
    let floor3_2 = floor3(scene, index);
    let mut whole = floor3_2;
    let v_2 = index;
    let v_3 = index;
    let error = index_error(scene, at.point);
    let mut margin = (v_2 - v_3.map(|v| v.round())).map(|v| v.abs())
        - (at
            .plane
            .vec3(offset_of!(records::ProceduralPlane, per_unit))
            .map(|v| v.abs())
            * error
            + Vec3::splat(
                at.plane
                    .f32(offset_of!(records::ProceduralPlane, index_error)),
            ));
    let here = on
        & !margin
            .zip(Vec3::splat(scene.f32(0.0)), |a, b| a.gt(b))
            .all();
    if here.any() {
        let on = here;
        let word = index_table(scene, at.point);
        let v_4 = margin;
        let known = index_table_known(scene, word);
        margin.set(on, known.select(Vec3::splat(scene.f32(1.0)), v_4));
        let v_5 = whole;
        let odd = index_table_odd(scene, word);
        let known_2 = index_table_known(scene, word);
        whole.set(on, known_2.select(odd, v_5));
    }
    certain(
        scene,
        state,
        on,
        axes.zip(Vec3::splat(scene.f32(0.0)), |a, b| a.gt(b))
            .select(margin, Vec3::splat(scene.f32(1.0))),
    );
    let odd3_2 = odd3(
        scene,
        whole + at.plane.vec3(offset_of!(records::ProceduralPlane, parity)),
    );
    odd3_2
}

/// Components x and y of H − point, and the bound of their errors.
#[inline(always)]
pub(super) fn pplane_from_point<'a, S: Simd>(
    scene: &'a Scene<'a, S>,
    at: PlanePoint<'a, S>,
) -> Vec3<F<S>> {
    let v = Vec2::new(at.point.position.x, at.point.position.y) * {
        let v = at
            .plane
            .vec4(offset_of!(records::ProceduralPlane, from_point));
        Vec2::new(v.x, v.y)
    } - {
        let v = at
            .plane
            .vec4(offset_of!(records::ProceduralPlane, from_point));
        Vec2::new(v.z, v.w)
    };
    let scale = at
        .plane
        .f32(offset_of!(records::ProceduralPlane, from_point))
        .abs()
        .max(
            at.plane
                .f32(offset_of!(records::ProceduralPlane, from_point) + 4)
                .abs(),
        );
    let error = index_error(scene, at.point);
    Vec3::new(
        v.x,
        v.y,
        scale * error
            + at.plane
                .f32(offset_of!(records::ProceduralPlane, from_point_error)),
    )
}

/// How far indices of texels are from the next texels', less their errors. At the ends of a stretched picture indices
/// are clamped, and one beyond is as good as the last.
#[inline(always)]
pub(super) fn texel_margin<'a, S: Simd>(
    scene: &'a Scene<'a, S>,
    size: Vec2<F<S>>,
    repeats: M<S>,
    index: Vec2<F<S>>,
    errors: Vec2<F<S>>,
) -> Vec2<F<S>> {
    let edge = (repeats
        | size
            .zip(Vec2::splat(scene.f32(2.0)), |a, b| a.lt(b))
            .any_of())
    .select(
        index.map(|v| v.round()),
        index
            .map(|v| v.round())
            .zip(Vec2::splat(scene.f32(1.0)), |v, low| v.max(low))
            .zip(size - Vec2::splat(scene.f32(1.0)), |v, high| v.min(high)),
    );
    let lone = Vec2::new(
        (!repeats & size.x.lt(scene.f32(2.0))).select(scene.f32(2.0), scene.f32(0.0)),
        (!repeats & size.y.lt(scene.f32(2.0))).select(scene.f32(2.0), scene.f32(0.0)),
    );
    (index - edge).map(|v| v.abs()) - errors + lone
}

/// The texel at an index, each channel byte/256, of the picture whose texels begin at `first`.
#[inline(always)]
pub(super) fn texel_at<'a, S: Simd>(
    scene: &'a Scene<'a, S>,
    on: M<S>,
    first: U<S>,
    columns: U<S>,
    size: Vec2<F<S>>,
    repeats: M<S>,
    index: Vec2<F<S>>,
) -> Vec3<F<S>> {
    let floor3_2 = floor3(scene, Vec3::new(index.x, index.y, scene.f32(0.5)));
    let mut p = Vec2::new(floor3_2.x, floor3_2.y);
    let here = on & repeats;
    if here.any() {
        let on = here;
        p.set(
            on,
            p - size * ((p + Vec2::splat(scene.f32(0.5))) / size).map(|v| v.floor()),
        );
    }
    let place = p
        .zip(Vec2::splat(scene.f32(0.0)), |v, low| v.max(low))
        .zip(size - Vec2::splat(scene.f32(1.0)), |v, high| v.min(high))
        .map(|v| v.as_u32());
    let packed = scene
        .gather(&scene.texels, first + place.y * columns + place.x)
        .u32(0);
    (Vec3::new(packed, packed >> 8, packed >> 16) & Vec3::splat(scene.u32(255))).map(|v| v.as_f32())
        * 0.00390625
}

/// The texel at a point of a texplane, each channel byte/256.
pub(super) fn texel<'a, S: Simd>(
    scene: &'a Scene<'a, S>,
    state: &mut State<S>,
    on: M<S>,
    plane: Gather<'a, records::Texplane, S>,
    point: Point<S>,
) -> Vec3<F<S>> {
    scene.simd.vectorize(
        #[inline(always)]
        || {
            let position = point.position;
            let mut index = Vec2::new(
                plane
                    .vec3(offset_of!(records::Texplane, row_0))
                    .dot(position)
                    - plane.f32(offset_of!(records::Texplane, origin_0)),
                plane
                    .vec3(offset_of!(records::Texplane, row_1))
                    .dot(position)
                    - plane.f32(offset_of!(records::Texplane, origin_1)),
            );
            let v = Vec3::new(index.x, index.y, scene.f32(0.0));
            index = Vec2::new(v.x, v.y);
            let size = plane
                .vec2_u32(offset_of!(records::Texplane, size))
                .map(|v| v.as_f32());
            let repeats = plane
                .u32(offset_of!(records::Texplane, repeats))
                .ne(scene.u32(0));
            let v_2 = index;
            let error = index_error(scene, point);
            let margin_2 = texel_margin(
                scene,
                size,
                repeats,
                v_2,
                plane.vec2(offset_of!(records::Texplane, row_lengths)) * error
                    + plane.vec2(offset_of!(records::Texplane, errors)),
            );
            let mut margin = margin_2;
            let here = on
                & !margin
                    .zip(Vec2::splat(scene.f32(0.0)), |a, b| a.gt(b))
                    .all();
            if here.any() {
                let on = here;
                let word = index_table(scene, point);
                let known = (Vec2::splat(word)
                    & Vec2::new(scene.u32(32768), scene.u32(2147483648)))
                .zip(Vec2::splat(scene.u32(0)), |a, b| a.ne(b));
                index.set(
                    on,
                    known.select(
                        (Vec2::splat(word) >> Vec2::new(scene.u32(0), scene.u32(16))
                            & Vec2::splat(scene.u32(32767)))
                        .map(|v| v.as_f32())
                            + Vec2::splat(scene.f32(0.5)),
                        index,
                    ),
                );
                margin.set(on, known.select(Vec2::splat(scene.f32(1.0)), margin));
            }
            certain(
                scene,
                state,
                on,
                Vec3::new(
                    margin.x,
                    margin.y,
                    constants::MOST_INDEX - index.x.abs().max(index.y.abs()),
                ),
            );
            let at = texel_at(
                scene,
                on,
                plane.u32(offset_of!(records::Texplane, first)),
                plane.u32(offset_of!(records::Texplane, size)),
                size,
                repeats,
                index,
            );
            at
        },
    )
}

/// (1 + cos 2θ, 1 + cos(2θ + 2π/3), 1 + cos(2θ + 4π/3)), θ the angle of (x, y) from +x; θ = 0 at the origin. No acos and
/// no cos: cos 2θ = (x² − y²)/(x² + y²), sin 2θ = 2xy/(x² + y²). Both components may be off by `error`.
#[inline(always)]
pub(super) fn color_wheel<'a, S: Simd>(
    scene: &'a Scene<'a, S>,
    state: &mut State<S>,
    on: M<S>,
    x_: F<S>,
    y_: F<S>,
    error: F<S>,
) -> Shade<S> {
    let mut shade = <Shade<S>>::zero(scene.simd);
    let mut result = <Shade<S>>::zero(scene.simd);
    let mut on = on;
    let mut gone = scene.mask(false);
    let v = Vec3::new(x_, y_, scene.f32(0.0));
    let x = v.x;
    let y = v.y;
    let square = x * x + y * y;
    let here = on & !square.gt(constants::WHEEL_FAR * error * error + constants::TINY_SQUARE);
    if here.any() {
        let on = here;
        state.doubt.set(on, scene.mask(true));
        result.set(on, shade);
        gone = gone | on;
    }
    on = on & !gone;
    if !on.any() {
        return result;
    }
    let inverse = 1.0 / square;
    let cosine = (x - y) * (x + y) * inverse;
    let sine = 2.0 * x * y * inverse;
    shade.color = Vec3::new(
        1.0 + cosine,
        1.0 - 0.5 * cosine - constants::HALF_ROOT_3 * sine,
        1.0 - 0.5 * cosine + constants::HALF_ROOT_3 * sine,
    )
    .zip(Vec3::splat(scene.f32(0.0)), |a, b| a.max(b));
    shade.error = Vec3::splat(
        constants::WHEEL_SLOPE * error * square.inverse_sqrt()
            + constants::WHEEL_ROUNDINGS * constants::U,
    );
    result.set(on, shade);
    result
}

/// pplane shader 0: tiles of half a unit; the ambient colour without red (i + j odd), or without blue.
#[inline(always)]
pub(super) fn pplane_0_tiles<'a, S: Simd>(
    scene: &'a Scene<'a, S>,
    state: &mut State<S>,
    on: M<S>,
    at: PlanePoint<'a, S>,
) -> Shade<S> {
    let mut shade = <Shade<S>>::zero(scene.simd);
    let odd = pplane_odd(
        scene,
        state,
        on,
        at,
        Vec3::new(scene.f32(1.0), scene.f32(0.0), scene.f32(1.0)),
    );
    shade.color = at.ambient
        * odd.x.ne(odd.z).select(
            Vec3::new(scene.f32(0.0), scene.f32(1.0), scene.f32(1.0)),
            Vec3::new(scene.f32(1.0), scene.f32(1.0), scene.f32(0.0)),
        );
    shade
}

/// pplane shader 1: colours around the plane's point, by the angle: 6·(1 + cos(2θ + φ)).
#[inline(always)]
pub(super) fn pplane_1_angle<'a, S: Simd>(
    scene: &'a Scene<'a, S>,
    state: &mut State<S>,
    on: M<S>,
    at: PlanePoint<'a, S>,
) -> Shade<S> {
    let v = pplane_from_point(scene, at);
    let wheel = color_wheel(scene, state, on, v.x, v.y, v.z);
    let mut shade = wheel;
    shade.color = shade.color * 6.0;
    shade.error = shade.error * 6.0;
    shade
}

/// pplane shader 2: blocks of half a unit, by turns shader 1's colours (i + j + k even) and the material's ambient.
#[inline(always)]
pub(super) fn pplane_2_blocks<'a, S: Simd>(
    scene: &'a Scene<'a, S>,
    state: &mut State<S>,
    on: M<S>,
    at: PlanePoint<'a, S>,
) -> Shade<S> {
    let mut local = <M<S>>::zero(scene.simd);
    let mut shade = <Shade<S>>::zero(scene.simd);
    let mut result = <Shade<S>>::zero(scene.simd);
    let mut on = on;
    let mut gone = scene.mask(false);
    let odd = pplane_odd(scene, state, on, at, Vec3::splat(scene.f32(1.0)));
    let holds = !(odd.x + odd.y + odd.z).eq(scene.f32(0.0));
    let here = on & holds;
    if here.any() {
        let on = here;
        local.set(on, (odd.x + odd.y + odd.z).eq(scene.f32(2.0)));
    }
    let here = on & !holds;
    if here.any() {
        let on = here;
        local.set(on, scene.mask(true));
    }
    let here = on & local;
    if here.any() {
        let on = here;
        let angle = pplane_1_angle(scene, state, on, at);
        result.set(on, angle);
        gone = gone | on;
    }
    on = on & !gone;
    if !on.any() {
        return result;
    }
    shade.color = at.ambient;
    result.set(on, shade);
    result
}

/// psphere shader 0: colours around the sphere's axis, by the angle of (c.x, −|c.y|).
#[inline(always)]
pub(super) fn psphere_0_angle<'a, S: Simd>(
    scene: &'a Scene<'a, S>,
    state: &mut State<S>,
    on: M<S>,
    at: SpherePoint<S>,
) -> Shade<S> {
    let wheel = color_wheel(
        scene,
        state,
        on,
        at.from_center.x,
        -at.from_center.y.abs(),
        at.error,
    );
    wheel
}

/// The material at a point: of a tiled plane, that of the tile.
#[inline(always)]
pub(super) fn tile_material<'a, S: Simd>(
    scene: &'a Scene<'a, S>,
    state: &mut State<S>,
    on: M<S>,
    point: Point<S>,
) -> U<S> {
    let mut result = <U<S>>::zero(scene.simd);
    let mut on = on;
    let mut gone = scene.mask(false);
    let object = scene.gather(&scene.lit_objects, point.object);
    let here = on
        & ((object.u32(offset_of!(records::LitObject, kind)) & 255)
            .eq(scene.u32(constants::KIND_TILED)));
    if here.any() {
        let on = here;
        let plane = scene.gather(
            &scene.tiled_planes,
            object.u32(offset_of!(records::LitObject, kind)) >> 8,
        );
        let foreground = tplane_foreground(scene, state, on, plane, point);
        result.set(
            on,
            foreground.select(
                object.u32(offset_of!(records::LitObject, material)),
                plane.u32(offset_of!(records::TiledPlane, altindex)),
            ),
        );
        gone = gone | on;
    }
    on = on & !gone;
    if !on.any() {
        return result;
    }
    result.set(on, object.u32(offset_of!(records::LitObject, material)));
    result
}

/// The diffuse reflectivity at a point.
pub(super) fn getdiff<'a, S: Simd>(
    scene: &'a Scene<'a, S>,
    state: &mut State<S>,
    on: M<S>,
    point: Point<S>,
) -> Vec3<F<S>> {
    scene.simd.vectorize(
        #[inline(always)]
        || {
            let mut result = <Vec3<F<S>>>::zero(scene.simd);
            let mut on = on;
            let mut gone = scene.mask(false);
            let material = tile_material(scene, state, on, point);
            let diffuse = scene
                .gather(&scene.materials, material)
                .vec3(offset_of!(records::Material, diffuse));
            let object = scene.gather(&scene.lit_objects, point.object);
            let here = on
                & ((object.u32(offset_of!(records::LitObject, kind)) & 255)
                    .eq(scene.u32(constants::KIND_TEXTURED)));
            if here.any() {
                let on = here;
                let texel_2 = texel(
                    scene,
                    state,
                    on,
                    scene.gather(
                        &scene.texplanes,
                        object.u32(offset_of!(records::LitObject, kind)) >> 8,
                    ),
                    point,
                );
                result.set(on, diffuse * texel_2);
                gone = gone | on;
            }
            on = on & !gone;
            if !on.any() {
                return result;
            }
            result.set(on, diffuse);
            result
        },
    )
}

/// The ambient reflectivity at a point.
pub(super) fn getamb<'a, S: Simd>(
    scene: &'a Scene<'a, S>,
    state: &mut State<S>,
    on: M<S>,
    point: Point<S>,
) -> Shade<S> {
    scene.simd.vectorize(
        #[inline(always)]
        || {
            let mut shade = <Shade<S>>::zero(scene.simd);
            let mut result = <Shade<S>>::zero(scene.simd);
            let mut on = on;
            let mut gone = scene.mask(false);
            let object = scene.gather(&scene.lit_objects, point.object);
            let material = tile_material(scene, state, on, point);
            shade.color = scene
                .gather(&scene.materials, material)
                .vec3(offset_of!(records::Material, ambient));
            let record = object.u32(offset_of!(records::LitObject, kind)) >> 8;
            let chosen = object.u32(offset_of!(records::LitObject, kind)) & 255;
            let here = on & chosen.eq(scene.u32(2));
            if here.any() {
                let on = here;
                let v = shade.color;
                let texel_2 = texel(
                    scene,
                    state,
                    on,
                    scene.gather(&scene.texplanes, record),
                    point,
                );
                shade.color.set(on, v * texel_2);
            }
            let here = on & chosen.eq(scene.u32(64));
            if here.any() {
                let on = here;
                let tiles = pplane_0_tiles(
                    scene,
                    state,
                    on,
                    PlanePoint {
                        point,
                        ambient: shade.color,
                        plane: scene.gather(&scene.pplanes, record),
                    },
                );
                result.set(on, tiles);
                gone = gone | on;
            }
            let here = on & chosen.eq(scene.u32(65));
            if here.any() {
                let on = here;
                let angle = pplane_1_angle(
                    scene,
                    state,
                    on,
                    PlanePoint {
                        point,
                        ambient: shade.color,
                        plane: scene.gather(&scene.pplanes, record),
                    },
                );
                result.set(on, angle);
                gone = gone | on;
            }
            let here = on & chosen.eq(scene.u32(66));
            if here.any() {
                let on = here;
                let blocks = pplane_2_blocks(
                    scene,
                    state,
                    on,
                    PlanePoint {
                        point,
                        ambient: shade.color,
                        plane: scene.gather(&scene.pplanes, record),
                    },
                );
                result.set(on, blocks);
                gone = gone | on;
            }
            let here = on & chosen.eq(scene.u32(128));
            if here.any() {
                let on = here;
                let angle_2 = psphere_0_angle(
                    scene,
                    state,
                    on,
                    SpherePoint {
                        from_center: point.from_center,
                        error: point.from_center_error,
                        ambient: shade.color,
                    },
                );
                result.set(on, angle_2);
                gone = gone | on;
            }
            on = on & !gone;
            if !on.any() {
                return result;
            }
            result.set(on, shade);
            result
        },
    )
}

/// Takes a hit if it is nearer, or as near and first in the file.
#[inline(always)]
pub(super) fn nearer_secondary<'a, S: Simd>(
    scene: &'a Scene<'a, S>,
    closest: &mut SecondaryHit<S>,
    intersection: Intersection<S>,
    object: U<S>,
    group: U<S>,
    range: Range<S>,
) {
    let same = group.eq(closest.group);
    let fresh = !same | object.lt(closest.object);
    let mut hit = intersection.hit & fresh;
    let mut possible = intersection.possible & fresh;
    let from_start = range.beyond.eq(scene.f32(0.0));
    possible = possible & (from_start | (intersection.high - range.beyond).gt(-range.beyond_error));
    hit = hit & (from_start | (intersection.low - range.beyond).gt(range.beyond_error));
    let low = possible.select(intersection.low, scene.f32(constants::T_MAX));
    let takes = hit & (intersection.t.lt(closest.t) | same);
    let rival = takes.select(same.select(scene.f32(constants::T_MAX), closest.low), low);
    closest.rival = closest.rival.min(rival);
    closest.low = takes.select(low, closest.low);
    closest.error = takes.select(intersection.error, closest.error);
    closest.group = takes.select(group, closest.group);
    closest.t = takes.select(intersection.t, closest.t);
    closest.object = takes.select(object, closest.object);
}

/// The product of a symmetric matrix, its diagonal and what stands beside it (yz, xz, xy), with a vector.
#[inline(always)]
pub(super) fn symmetric<'a, S: Simd>(
    scene: &'a Scene<'a, S>,
    diagonal: Vec3<F<S>>,
    beside: Vec3<F<S>>,
    v: Vec3<F<S>>,
) -> Vec3<F<S>> {
    Vec3::new(
        diagonal.x * v.x + beside.z * v.y + beside.y * v.z,
        beside.z * v.x + diagonal.y * v.y + beside.x * v.z,
        beside.y * v.x + beside.x * v.y + diagonal.z * v.z,
    )
}

#[inline(always)]
pub(super) fn sum3<'a, S: Simd>(scene: &'a Scene<'a, S>, v: Vec3<F<S>>) -> F<S> {
    v.x.abs() + v.y.abs() + v.z.abs()
}

#[inline(always)]
pub(super) fn quadric_passage<'a, S: Simd>(
    scene: &'a Scene<'a, S>,
    quadric: Gather<'a, records::Quadric, S>,
    ray: QuadricRay<S>,
) -> QuadricPassage<S> {
    let mut passage = <QuadricPassage<S>>::zero(scene.simd);
    let from_center = ray.base - quadric.vec3(offset_of!(records::Quadric, center));
    let v = -from_center.dot(ray.dir);
    passage.along = v;
    let v_2 = from_center + passage.along * ray.dir;
    passage.perpendicular = v_2;
    let p = passage.perpendicular;
    let symmetric_2 = symmetric(
        scene,
        quadric.vec3(offset_of!(records::Quadric, diagonal)),
        quadric.vec3(offset_of!(records::Quadric, beside)),
        p,
    );
    let v_3 = symmetric_2 + quadric.vec3(offset_of!(records::Quadric, slope));
    passage.gradient = v_3;
    let symmetric_3 = symmetric(
        scene,
        quadric.vec3(offset_of!(records::Quadric, diagonal)),
        quadric.vec3(offset_of!(records::Quadric, beside)),
        ray.dir,
    );
    let v_4 = symmetric_3;
    passage.turn = v_4;
    let v_5 = passage.along;
    let sum3_2 = sum3(scene, p);
    let far = constants::FAR_GROWTH * (v_5.abs() + sum3_2 + ray.base_error);
    passage.off = constants::SECOND_ORDER * ray.base_error
        + constants::U * quadric.f32(offset_of!(records::Quadric, size))
        + far
            * ((constants::TURN + constants::TURN_MORE * ray.dir_error) * ray.dir_error
                + constants::PERPENDICULAR_ROUNDINGS * constants::U);
    let symmetric_4 = symmetric(
        scene,
        quadric
            .vec3(offset_of!(records::Quadric, diagonal))
            .map(|v| v.abs()),
        quadric
            .vec3(offset_of!(records::Quadric, beside))
            .map(|v| v.abs()),
        p.map(|v| v.abs()),
    );
    let moved = symmetric_4
        + quadric
            .vec3(offset_of!(records::Quadric, slope))
            .map(|v| v.abs());
    let v_6 = passage.off;
    let sum3_3 = sum3(scene, moved);
    passage.gradient_error = quadric.f32(offset_of!(records::Quadric, norm)) * v_6
        + constants::GRADIENT_ROUNDINGS * constants::U * sum3_3;
    passage.turn_error = quadric.f32(offset_of!(records::Quadric, norm))
        * (ray.dir_error + constants::GRADIENT_ROUNDINGS * constants::U);
    passage
}

/// What a root comes to.
#[inline(always)]
pub(super) fn quadric_root<'a, S: Simd>(
    scene: &'a Scene<'a, S>,
    quadric: &records::Quadric,
    ray: QuadricRay<S>,
    t: F<S>,
    error: F<S>,
) -> Root<S> {
    let mut root = <Root<S>>::zero(scene.simd);
    let ahead = t - ray.start;
    let ahead_error = error + ray.start_error;
    let position = ray.base + t * ray.dir;
    let above = position - scene.vec3(quadric.lower);
    let below = scene.vec3(quadric.upper) - position;
    let position_error = constants::SECOND_ORDER
        * (error + ray.base_error + t.abs() * ray.dir_error)
        + (constants::POSITION_ROUNDINGS + constants::BORDER_ROUNDINGS)
            * constants::U
            * (ray.size + t.abs());
    let above_error = Vec3::splat(position_error)
        + constants::BORDER_ROUNDINGS * constants::U * scene.vec3(quadric.lower).map(|v| v.abs());
    let below_error = Vec3::splat(position_error)
        + constants::BORDER_ROUNDINGS * constants::U * scene.vec3(quadric.upper).map(|v| v.abs());
    root.t = t;
    root.error = error;
    root.counts = ahead.gt(ahead_error)
        & above.zip(above_error, |a, b| a.gt(b)).all()
        & below.zip(below_error, |a, b| a.gt(b)).all()
        & t.abs().lt(scene.f32(constants::FARTHEST));
    root.out = ahead.lt(-ahead_error)
        | above.zip(-above_error, |a, b| a.lt(b)).any_of()
        | below.zip(-below_error, |a, b| a.lt(b)).any_of();
    root
}

/// `light` is where a shadow ray's light lies on the surface, which hides nothing from itself; else before the start.
pub(super) fn quadric_meets<'a, S: Simd>(
    scene: &'a Scene<'a, S>,
    on: M<S>,
    quadric: &records::Quadric,
    ray: QuadricRay<S>,
    light: F<S>,
    light_error: F<S>,
) -> QuadricHit<S> {
    scene.simd.vectorize(
        #[inline(always)]
        || {
            let mut met = <QuadricHit<S>>::zero(scene.simd);
            let passage_2 = quadric_passage(scene, scene.same(&quadric), ray);
            let p = passage_2.perpendicular;
            let e = passage_2.turn;
            let g = passage_2.gradient;
            let k = quadric.constant;
            let moment = p.cross(ray.dir);
            let symmetric_2 = symmetric(
                scene,
                scene.vec3(quadric.adjoint_diagonal),
                scene.vec3(quadric.adjoint_beside),
                moment,
            );
            let turned = symmetric_2;
            let slanted = e.cross(scene.vec3(quadric.slope));
            let slope = scene.vec3(quadric.slope).dot(ray.dir);
            let a = ray.dir.dot(e);
            let h = p.dot(e) + slope;
            let c = p.dot(g + scene.vec3(quadric.slope)) + k;
            let disc = 2.0 * moment.dot(slanted) - moment.dot(turned) + slope * slope - k * a;
            let u = constants::MOMENT_ROUNDINGS * constants::U;
            let length_p = sum3(scene, p);
            let length_e = sum3(scene, e);
            let length_g = sum3(scene, g);
            let length_v = quadric.slope_size;
            let length_m = sum3(scene, moment);
            let d_error = ray.dir_error;
            let symmetric_3 = symmetric(
                scene,
                scene.vec3(quadric.adjoint_diagonal).map(|v| v.abs()),
                scene.vec3(quadric.adjoint_beside).map(|v| v.abs()),
                moment.map(|v| v.abs()),
            );
            let all_turned = moment.map(|v| v.abs()).dot(symmetric_3);
            let along_d = symmetric(
                scene,
                scene.vec3(quadric.diagonal).map(|v| v.abs()),
                scene.vec3(quadric.beside).map(|v| v.abs()),
                ray.dir.map(|v| v.abs()),
            );
            let all_a = ray.dir.map(|v| v.abs()).dot(along_d);
            let all_h = p.map(|v| v.abs()).dot(along_d) + length_v;
            let symmetric_4 = symmetric(
                scene,
                scene.vec3(quadric.diagonal).map(|v| v.abs()),
                scene.vec3(quadric.beside).map(|v| v.abs()),
                p.map(|v| v.abs()),
            );
            let all_c = p.map(|v| v.abs()).dot(symmetric_4) + 2.0 * length_v * length_p + k.abs();
            let a_error =
                2.0 * d_error * (constants::SECOND_ORDER * length_e + quadric.norm * d_error)
                    + u * all_a
                    + constants::LEAST_SLOPE;
            let h_error = constants::SECOND_ORDER * (length_e * passage_2.off + length_g * d_error)
                + 2.0 * quadric.norm * passage_2.off * d_error
                + u * all_h
                + constants::LEAST_SLOPE;
            let c_error = 2.0
                * passage_2.off
                * (constants::SECOND_ORDER * length_g + quadric.norm * passage_2.off)
                + u * all_c;
            let moment_error =
                constants::SECOND_ORDER * (passage_2.off + length_p * d_error) + u * length_p;
            let slope_error = length_v * (d_error + u);
            let sum3_2 = sum3(scene, turned);
            let disc_error = 2.0
                * moment_error
                * (constants::SECOND_ORDER * sum3_2 + quadric.adjoint_norm * moment_error)
                + 2.0
                    * constants::SECOND_ORDER
                    * length_v
                    * (length_e * moment_error
                        + (length_m + moment_error) * (passage_2.turn_error + u * length_e))
                + slope_error * (2.0 * slope.abs() + slope_error)
                + k.abs() * a_error
                + u * (all_turned + slope * slope + k.abs() * all_a)
                + constants::TINY_SQUARE
                + constants::QUADRIC_FLUSHED
                    * ((length_m + moment_error + length_e) * (length_m + moment_error));
            let least = disc.max(disc_error);
            let inverse_root = least.inverse_sqrt();
            let root = least * inverse_root;
            let reach_error = disc_error
                * inverse_root
                * least.gt(constants::ROOT_FAR_FROM * disc_error).select(
                    scene.f32(constants::ROOT_FAR),
                    scene.f32(constants::ROOT_NEAR),
                )
                + constants::ROOT_ROUNDINGS * constants::U * root;
            let signed = h.lt(scene.f32(0.0)).select(-root, root);
            let sum = -(h + signed);
            let sum_error =
                h_error + reach_error + constants::ROOT_ROUNDINGS * constants::U * sum.abs();
            let sum_known = sum.abs().gt(constants::QUOTIENT_FROM * sum_error);
            let a_known = a.abs().gt(constants::QUOTIENT_FROM * a_error);
            let by_sum = 1.0 / sum_known.select(sum, scene.f32(1.0));
            let by_a = 1.0 / a_known.select(a, scene.f32(1.0));
            let difference = signed - h;
            let other = difference * by_a;
            let other_error = constants::QUOTIENT_GROWTH
                * (h_error + reach_error + other.abs() * a_error)
                * by_a.abs()
                + constants::ROOT_ROUNDINGS
                    * constants::U
                    * (other.abs() + (h.abs() + root) * by_a.abs());
            let quotient = c * by_sum;
            let quotient_error =
                constants::QUOTIENT_GROWTH * (c_error + quotient.abs() * sum_error) * by_sum.abs()
                    + constants::ROOT_ROUNDINGS * constants::U * quotient.abs();
            let takes_other = a_known & (!sum_known | other_error.lt(quotient_error));
            let one = takes_other.select(other, quotient);
            let one_error = takes_other.select(other_error, quotient_error);
            let two = sum * by_a;
            let two_error =
                constants::QUOTIENT_GROWTH * (sum_error + two.abs() * a_error) * by_a.abs()
                    + constants::ROOT_ROUNDINGS * constants::U * two.abs();
            let along = passage_2.along;
            let places = Vec3::new(along + one, along + two, scene.f32(0.0));
            let place_errors = Vec2::new(one_error, two_error)
                + Vec2::splat(passage_2.off)
                + constants::DISTANCE_ROUNDINGS
                    * constants::U
                    * (Vec2::splat(along.abs()) + Vec2::new(one.abs(), two.abs()));
            let swap = a_known & one.gt(two);
            let near = quadric_root(
                scene,
                quadric,
                ray,
                swap.select(places.y, places.x),
                swap.select(place_errors.y, place_errors.x),
            );
            let root_2 = quadric_root(
                scene,
                quadric,
                ray,
                swap.select(places.x, places.y),
                swap.select(place_errors.x, place_errors.y),
            );
            let mut far = root_2;
            let mut first = near;
            let here = on & light.gt(ray.start);
            if here.any() {
                let on = here;
                let near_apart = (near.t - light).abs().gt(near.error + light_error);
                let far_apart = (far.t - light).abs().gt(far.error + light_error);
                first.out.set(on, first.out | !near_apart & far_apart);
                first.counts.set(on, first.counts & near_apart);
                far.out.set(on, far.out | !far_apart & near_apart);
                far.counts.set(on, far.counts & far_apart);
            }
            met.possible = disc.gt(-disc_error) & !(first.out & far.out & a_known);
            let second = first.out & a_known;
            met.t = second.select(far.t, first.t);
            met.error = second.select(far.error, first.error);
            met.hit = disc.gt(disc_error) & second.select(far.counts, first.counts);
            met.low = met.t - met.error;
            met.high = met.hit.select(met.t + met.error, far.t + far.error);
            let here = on & !a_known;
            if here.any() {
                let on = here;
                let away = (sum.abs() - sum_error).max(scene.f32(0.0)) / (a.abs() + a_error)
                    * constants::LOWERED
                    - (passage_2.off + constants::DISTANCE_ROUNDINGS * constants::U * along.abs());
                let behind = (along - away).lt(ray.start - ray.start_error) & sum_known;
                let beyond = along + away;
                met.possible.set(on, disc.gt(-disc_error));
                met.hit.set(
                    on,
                    met.hit & (behind & (met.low + 2.0 * met.error).lt(beyond)),
                );
                met.low.set(
                    on,
                    behind.select(
                        first.out.select(beyond, met.low.min(beyond)),
                        ray.start - ray.start_error,
                    ),
                );
                met.high
                    .set(on, met.hit.select(met.high, scene.f32(constants::T_FAR)));
            }
            met
        },
    )
}

/// The quadric as a ray from anywhere meets it.
#[inline(always)]
pub(super) fn quadric_hits_from<'a, S: Simd>(
    scene: &'a Scene<'a, S>,
    on: M<S>,
    quadric: &records::Quadric,
    ray: SecondaryRay<S>,
    range: Range<S>,
) -> Intersection<S> {
    let mut intersection = <Intersection<S>>::zero(scene.simd);
    let on_surface = (quadric.lights_on_surface & range.light).ne(scene.u32(0));
    let light = on_surface.select(range.limit, scene.f32(-1.0));
    let start_error = range
        .beyond
        .eq(scene.f32(0.0))
        .select(ray.start_error, range.beyond_error);
    let seen = QuadricRay {
        base: ray.base,
        dir: ray.dir,
        start: range.beyond,
        base_error: ray.base_error,
        dir_error: ray.dir_error,
        size: ray.size,
        start_error,
    };
    let met = quadric_meets(scene, on, quadric, seen, light, range.limit_error);
    let left = scene.u32(quadric.group).eq(range.skip);
    intersection.t = met.t;
    intersection.error = met.error;
    intersection.hit = met.hit & !left;
    intersection.possible = met.possible & !left;
    intersection.low = met.low;
    intersection.high = met.high;
    intersection
}

/// Whether nothing else can be nearer than what was met, or nothing at all is met.
#[inline(always)]
pub(super) fn surely_closest<'a, S: Simd>(scene: &'a Scene<'a, S>, hit: SecondaryHit<S>) -> M<S> {
    (hit.rival - hit.t).gt(hit.error + constants::RIVAL_ROUNDINGS * constants::U * hit.t.abs())
        | hit.object.eq(scene.u32(constants::NOTHING)) & hit.rival.ge(scene.f32(constants::T_MAX))
}

/// Whether a surface stands before the end of the range: 0 no, 1 perhaps, 2 yes.
#[inline(always)]
pub(super) fn occludes<'a, S: Simd>(
    scene: &'a Scene<'a, S>,
    intersection: Intersection<S>,
    range: Range<S>,
) -> U<S> {
    let left = range.limit - intersection.t;
    let yes = intersection.hit & left.gt(intersection.error + range.limit_error);
    let no = !intersection.possible | (intersection.low - range.limit).gt(range.limit_error);
    yes.select(scene.u32(2), no.select(scene.u32(0), scene.u32(1)))
}

/// (1 − y)ⁿ or 2⁻¹⁰⁰, whichever is more, for y from 0 up to 1 and n up to MOST_SHININESS; and what share of that it may
/// be off by. Sums and products alone: what a driver's own functions are off by need not be known.
#[inline(always)]
pub(super) fn power<'a, S: Simd>(scene: &'a Scene<'a, S>, y: F<S>, n: F<S>) -> Vec2<F<S>> {
    let x = 1.0 - y;
    let e = x.signed_bits() - 1060439283 >> 23;
    let m = (x.signed_bits() - (e << 23)).float();
    let z = e.eq(scene.i32(0)).select(y, 1.0 - m) / (1.0 + m);
    let z2 = z * z;
    let part_of_log = 2.88539 * z * (1.0 + z2 * (0.33333334 + z2 * (0.2 + z2 * 0.14285715)));
    let log = e.as_f32() - part_of_log;
    let q = (n * log).max(scene.f32(-100.0));
    let whole = q.round();
    let w = (q - whole) * 0.6931472;
    let part = 1.0
        + w * (1.0
            + w * (0.5
                + w * (0.16666667
                    + w * (0.041666668
                        + w * (0.008333334 + w * (0.0013888889 + w * 0.0001984127))))));
    let error = q.eq(scene.f32(-100.0)).select(
        scene.f32(1.0),
        (constants::POWER_ROUNDINGS - constants::LOG_ROUNDINGS * q) * constants::U,
    );
    Vec2::new(part * (whole.as_i32() + 127 << 23).float(), error)
}

/// The power of the cosine between the direction `half`, of any length, and a unit normal, at the upper end of what it
/// may be; and what share of that it may be off by. The cosine may also be 0 or less where the share is 1.
pub(super) fn glint_power<'a, S: Simd>(
    scene: &'a Scene<'a, S>,
    state: &mut State<S>,
    on: M<S>,
    half: Vec3<F<S>>,
    half_error: F<S>,
    normal: Vec3<F<S>>,
    normal_error: F<S>,
    n: F<S>,
) -> Vec2<F<S>> {
    scene.simd.vectorize(
        #[inline(always)]
        || {
            let mut result = <Vec2<F<S>>>::zero(scene.simd);
            let mut on = on;
            let mut gone = scene.mask(false);
            let half_2 = half.dot(half);
            let half_inverse = half_2.max(scene.f32(constants::TINY_SQUARE)).inverse_sqrt();
            state.doubt.set(
                on,
                state.doubt
                    | (!(half_2 * half_inverse).gt(constants::CLOSE_FROM * half_error)
                        | n.gt(scene.f32(constants::MOST_SHININESS))),
            );
            let v = half * half_inverse;
            let apart = v - normal;
            let apart_2 = apart.dot(apart);
            let distance = apart_2
                * apart_2
                    .max(scene.f32(constants::TINY_SQUARE))
                    .inverse_sqrt();
            let off = constants::CLOSE * half_error * half_inverse
                + normal_error
                + constants::DIRECTION_ROUNDINGS * constants::U
                + constants::APART_ROUNDINGS * constants::U * distance;
            let near = (distance - off).max(scene.f32(0.0));
            let y = 0.5 * near * near;
            let here = on & y.ge(scene.f32(1.0));
            if here.any() {
                let on = here;
                result.set(on, Vec2::splat(scene.f32(0.0)));
                gone = gone | on;
            }
            on = on & !gone;
            if !on.any() {
                return result;
            }
            let most = power(scene, y, n.min(scene.f32(constants::MOST_SHININESS)));
            let spread = constants::SECOND_ORDER * off * (distance + distance.max(off));
            result.set(
                on,
                Vec2::new(
                    most.x,
                    (n.max(scene.f32(1.0)) * spread / (1.0 - y)).min(scene.f32(1.0)) + most.y,
                ),
            );
            result
        },
    )
}

/// The way from a projector to the point that it lies at `toward` from, on surface number `group`.
pub(super) fn passage<'a, S: Simd>(
    scene: &'a Scene<'a, S>,
    state: &mut State<S>,
    on: M<S>,
    projector: &records::Projector,
    group: U<S>,
    toward: Vec3<F<S>>,
    distance: F<S>,
    toward_error: F<S>,
) -> Passage<S> {
    scene.simd.vectorize(
        #[inline(always)]
        || {
            let mut passage = <Passage<S>>::zero(scene.simd);
            let mut result = <Passage<S>>::zero(scene.simd);
            let mut on = on;
            let mut gone = scene.mask(false);
            passage.sure = scene.mask(true);
            let here = on & group.eq(scene.u32(projector.group));
            if here.any() {
                let on = here;
                result.set(on, passage);
                gone = gone | on;
            }
            on = on & !gone;
            if !on.any() {
                return result;
            }
            let along = -Vec3::new(
                scene.vec3(projector.normal).dot(toward),
                scene.vec3(projector.row_0).dot(toward),
                scene.vec3(projector.row_1).dot(toward),
            );
            let beyond = along.x - projector.reach;
            let along_error = toward_error + constants::BEYOND_ROUNDINGS * constants::U * distance;
            let beyond_error = along_error + constants::U * projector.reach;
            let here = on & beyond.lt(-beyond_error);
            if here.any() {
                let on = here;
                result.set(on, passage);
                gone = gone | on;
            }
            on = on & !gone;
            if !on.any() {
                return result;
            }
            let here = on & !along.x.gt(constants::CLOSE_FROM * along_error);
            if here.any() {
                let on = here;
                passage.sure.set(on, scene.mask(false));
                state.doubt.set(on, scene.mask(true));
                result.set(on, passage);
                gone = gone | on;
            }
            on = on & !gone;
            if !on.any() {
                return result;
            }
            passage.sure = beyond.gt(beyond_error);
            let share = projector.reach / along.x;
            let v = Vec3::new(
                (share * Vec2::new(along.y, along.z)
                    + Vec2::new(scene.f32(projector.start_0), scene.f32(projector.start_1)))
                .x,
                (share * Vec2::new(along.y, along.z)
                    + Vec2::new(scene.f32(projector.start_0), scene.f32(projector.start_1)))
                .y,
                scene.f32(0.0),
            );
            let index = Vec2::new(v.x, v.y);
            let stretch = constants::CLOSE * along_error / along.x;
            let errors = scene.vec2(projector.errors)
                + share
                    * (Vec2::new(along.y, along.z).map(|v| v.abs()) * stretch
                        + scene.vec2(projector.row_lengths)
                            * (toward_error
                                + constants::PICTURE_ROUNDINGS * constants::U * distance)
                            * (1.0 + stretch));
            let margin = index.zip(scene.vec2(projector.ends) - index, |a, b| a.min(b));
            let here = on & margin.zip(-errors, |a, b| a.lt(b)).any_of();
            if here.any() {
                let on = here;
                result.set(on, passage);
                gone = gone | on;
            }
            on = on & !gone;
            if !on.any() {
                return result;
            }
            passage.sure = passage.sure & margin.zip(errors, |a, b| a.gt(b)).all();
            passage.errors = errors;
            passage.passes = scene.mask(true);
            passage.index = index;
            result.set(on, passage);
            result
        },
    )
}

/// The texel that light passes, each channel byte/256.
pub(super) fn passed_texel<'a, S: Simd>(
    scene: &'a Scene<'a, S>,
    state: &mut State<S>,
    on: M<S>,
    projector: &records::Projector,
    passage: Passage<S>,
) -> Vec3<F<S>> {
    scene.simd.vectorize(
        #[inline(always)]
        || {
            let size = scene.vec2_u32(projector.size).map(|v| v.as_f32());
            let repeats = projector.repeats != 0;
            let index = passage.index;
            let margin = texel_margin(scene, size, scene.mask(repeats), index, passage.errors);
            certain(
                scene,
                state,
                on,
                Vec3::new(
                    margin.x,
                    margin.y,
                    constants::MOST_INDEX - index.x.abs().max(index.y.abs()),
                ),
            );
            let at = texel_at(
                scene,
                on,
                scene.u32(projector.first),
                scene.u32(projector.size[0]),
                size,
                scene.mask(repeats),
                index,
            );
            at
        },
    )
}

/// Fills in what follows from the object alone, on a plane.
#[inline(always)]
pub(super) fn complete<'a, S: Simd>(scene: &'a Scene<'a, S>, on: M<S>, point: &mut Point<S>) {
    let mut on = on;
    let mut gone = scene.mask(false);
    let object = scene.gather(&scene.lit_objects, point.object);
    point
        .group
        .set(on, object.u32(offset_of!(records::LitObject, group)));
    let holds = object
        .u32(offset_of!(records::LitObject, place))
        .lt(scene.u32(constants::QUADRIC_BIT));
    let here = on & holds;
    if here.any() {
        let on = here;
        let plane = scene.gather(
            &scene.world_planes,
            object.u32(offset_of!(records::LitObject, place)),
        );
        point
            .normal
            .set(on, plane.vec3(offset_of!(records::WorldPlane, normal)));
        point.normal_error.set(
            on,
            scene.f32(constants::PLANE_NORMAL_ROUNDINGS * constants::U),
        );
        point.position.set(
            on,
            point.position * plane.vec3(offset_of!(records::WorldPlane, axis_mask))
                + plane.vec3(offset_of!(records::WorldPlane, fixed_coordinate)),
        );
        point
            .low_light
            .set(on, plane.u32(offset_of!(records::WorldPlane, low_light)));
        point
            .height
            .set(on, plane.f32(offset_of!(records::WorldPlane, height)));
        point.lights_on_surface.set(
            on,
            plane.u32(offset_of!(records::WorldPlane, lights_on_surface)),
        );
        gone = gone | on;
    }
    let here = on & !holds;
    if here.any() {
        let on = here;
        gone = gone | on;
    }
    on = on & !gone;
    if !on.any() {
        return;
    }
}

/// Takes the normal of a quadric, with the bound of its error.
#[inline(always)]
pub(super) fn on_quadric<'a, S: Simd>(
    scene: &'a Scene<'a, S>,
    on: M<S>,
    point: &mut Point<S>,
    normal: Vec4<F<S>>,
) {
    point
        .normal
        .set(on, Vec3::new(normal.x, normal.y, normal.z));
    point.normal_error.set(on, normal.w);
}

/// The unit normal where a ray meets a quadric at a distance; in the fourth component the bound of its error.
pub(super) fn quadric_normal<'a, S: Simd>(
    scene: &'a Scene<'a, S>,
    quadric: Gather<'a, records::Quadric, S>,
    ray: SecondaryRay<S>,
    t: F<S>,
    error: F<S>,
) -> Vec4<F<S>> {
    scene.simd.vectorize(
        #[inline(always)]
        || {
            let seen = QuadricRay {
                base: ray.base,
                dir: ray.dir,
                start: scene.f32(0.0),
                base_error: ray.base_error,
                dir_error: ray.dir_error,
                size: ray.size,
                start_error: scene.f32(0.0),
            };
            let passage_2 = quadric_passage(scene, quadric, seen);
            let further = t - passage_2.along;
            let gradient = passage_2.gradient + further * passage_2.turn;
            let square = gradient.dot(gradient);
            let inverse = square.max(scene.f32(constants::TINY_SQUARE)).inverse_sqrt();
            let turn = sum3(scene, passage_2.turn);
            let sum3_2 = sum3(scene, passage_2.gradient);
            let off = passage_2.gradient_error
                + further.abs() * passage_2.turn_error
                + constants::SECOND_ORDER
                    * turn
                    * (error + passage_2.off + constants::U * (t.abs() + passage_2.along.abs()))
                + constants::GRADIENT_ROUNDINGS * constants::U * (sum3_2 + further.abs() * turn);
            let share = off * inverse;
            let known = (share * constants::FIRST_ORDER).lt(scene.f32(1.0))
                & square.gt(scene.f32(constants::TINY_SQUARE));
            Vec4::new(
                (gradient * inverse).x,
                (gradient * inverse).y,
                (gradient * inverse).z,
                known.select(
                    constants::SECOND_ORDER * share + constants::NORMAL_ROUNDINGS * constants::U,
                    scene.f32(2.0),
                ),
            )
        },
    )
}

/// Takes the normal of a sphere, with the bound of its error.
#[inline(always)]
pub(super) fn on_sphere<'a, S: Simd>(
    scene: &'a Scene<'a, S>,
    on: M<S>,
    point: &mut Point<S>,
    normal: Vec4<F<S>>,
) {
    point
        .from_center
        .set(on, Vec3::new(normal.x, normal.y, normal.z));
    point
        .normal
        .set(on, Vec3::new(normal.x, normal.y, normal.z));
    point.from_center_error.set(on, normal.w);
    point.normal_error.set(on, normal.w);
}

/// Where a ray from anywhere hit.
pub(super) fn locate_secondary<'a, S: Simd>(
    scene: &'a Scene<'a, S>,
    on: M<S>,
    ray: SecondaryRay<S>,
    hit: SecondaryHit<S>,
) -> Point<S> {
    scene.simd.vectorize(
        #[inline(always)]
        || {
            let mut point = <Point<S>>::zero(scene.simd);
            point.object = hit.object;
            let v = ray.base + hit.t * ray.dir;
            point.position = v;
            point.error =
                hit.error + constants::POSITION_ROUNDINGS * constants::U * (ray.size + hit.t);
            complete(scene, on, &mut point);
            let here = on
                & ((scene
                    .gather(&scene.lit_objects, hit.object)
                    .u32(offset_of!(records::LitObject, place))
                    & constants::QUADRIC_BIT)
                    .ne(scene.u32(0)));
            if here.any() {
                let on = here;
                let quadric = scene.gather(
                    &scene.quadrics,
                    scene
                        .gather(&scene.lit_objects, hit.object)
                        .u32(offset_of!(records::LitObject, place))
                        & 3221225471,
                );
                let normal = quadric_normal(scene, quadric, ray, hit.t, hit.error);
                on_quadric(scene, on, &mut point, normal);
                point.error.set(
                    on,
                    constants::SECOND_ORDER * (hit.error + ray.base_error + hit.t * ray.dir_error)
                        + constants::POSITION_ROUNDINGS * constants::U * (ray.size + hit.t),
                );
            }
            let object = scene.gather(&scene.lit_objects, hit.object);
            let here = on
                & ((object.u32(offset_of!(records::LitObject, place)) & constants::SPHERE_BIT)
                    .ne(scene.u32(0)));
            if here.any() {
                let on = here;
                let sphere = scene.gather(
                    &scene.world_spheres,
                    object.u32(offset_of!(records::LitObject, place)) & 2147483647,
                );
                let normal_2 = sphere_normal_from(scene, sphere, ray);
                on_sphere(scene, on, &mut point, normal_2);
                let v_2 = sphere.vec3(offset_of!(records::WorldSphere, center))
                    + sphere.f32(offset_of!(records::WorldSphere, radius))
                        * Vec3::new(normal_2.x, normal_2.y, normal_2.z);
                point.position.set(on, v_2);
                point.error.set(
                    on,
                    constants::SECOND_ORDER
                        * sphere.f32(offset_of!(records::WorldSphere, radius))
                        * normal_2.w
                        + constants::POSITION_ROUNDINGS
                            * constants::U
                            * (sphere.f32(offset_of!(records::WorldSphere, size))
                                + sphere.f32(offset_of!(records::WorldSphere, radius))),
                );
            }
            point.size = point.position.x.abs() + point.position.y.abs() + point.position.z.abs();
            point
        },
    )
}

/// The transmittance from the point to light number `number`; `range` ends at the light.
pub(super) fn shadow<'a, S: Simd>(
    scene: &'a Scene<'a, S>,
    state: &mut State<S>,
    on: M<S>,
    ray: SecondaryRay<S>,
    range_: Range<S>,
) -> Shadow<S> {
    scene.simd.vectorize(
        #[inline(always)]
        || {
            let mut transmittance = Vec3::splat(scene.f32(1.0));
            let mut roundings = scene.f32(0.0);
            let mut result = <Shadow<S>>::zero(scene.simd);
            let mut on = on;
            let mut gone = scene.mask(false);
            let mut range = range_;
            let mut looping_1 = on;
            while looping_1.any() {
                let mut on = looping_1;
                let mut gone_1 = scene.mask(false);
                'round_1: {
                    let hit = by_hand::closest_hit(scene, on, ray, range, scene.lanes);
                    let left = range.limit - hit.t;
                    let left_error = hit.error + range.limit_error;
                    let here = on
                        & ((hit.rival - range.limit).gt(range.limit_error)
                            & (hit.object.eq(scene.u32(constants::NOTHING))
                                | left.lt(-left_error)));
                    if here.any() {
                        let on = here;
                        result.set(
                            on,
                            Shadow {
                                transmittance,
                                open: scene.mask(true),
                                sure: scene.mask(true),
                                roundings,
                            },
                        );
                        gone = gone | on;
                        looping_1 = looping_1 & !on;
                        gone_1 = gone_1 | on;
                    }
                    on = on & !gone_1;
                    if !on.any() {
                        break 'round_1;
                    }
                    let closest = surely_closest(scene, hit);
                    let here = on
                        & (hit.object.eq(scene.u32(constants::NOTHING))
                            | !closest
                            | !left.gt(left_error)
                            | scene.mask(0 > constants::STEPS_LIMIT));
                    if here.any() {
                        let on = here;
                        result.set(
                            on,
                            Shadow {
                                transmittance: Vec3::splat(scene.f32(1.0)),
                                open: scene.mask(true),
                                sure: scene.mask(false),
                                roundings: scene.f32(0.0),
                            },
                        );
                        gone = gone | on;
                        looping_1 = looping_1 & !on;
                        gone_1 = gone_1 | on;
                    }
                    on = on & !gone_1;
                    if !on.any() {
                        break 'round_1;
                    }
                    let blocker = locate_secondary(scene, on, ray, hit);
                    let material = scene.gather(
                        &scene.materials,
                        scene
                            .gather(&scene.lit_objects, hit.object)
                            .u32(offset_of!(records::LitObject, material)),
                    );
                    let here = on
                        & material
                            .f32(offset_of!(records::Material, transparency))
                            .eq(scene.f32(0.0));
                    if here.any() {
                        let on = here;
                        result.set(
                            on,
                            Shadow {
                                transmittance: Vec3::splat(scene.f32(0.0)),
                                open: scene.mask(false),
                                sure: scene.mask(true),
                                roundings: scene.f32(0.0),
                            },
                        );
                        gone = gone | on;
                        looping_1 = looping_1 & !on;
                        gone_1 = gone_1 | on;
                    }
                    on = on & !gone_1;
                    if !on.any() {
                        break 'round_1;
                    }
                    let v = transmittance;
                    let material_2 = tile_material(scene, state, on, blocker);
                    transmittance.set(
                        on,
                        v * (scene
                            .gather(&scene.materials, material_2)
                            .vec3(offset_of!(records::Material, tint))
                            * material.f32(offset_of!(records::Material, transparency))),
                    );
                    roundings.set(on, roundings + constants::PANE_ROUNDINGS);
                    range.skip.set(on, blocker.group);
                    range.beyond.set(on, hit.t);
                    range.beyond_error.set(on, hit.error);
                }
            }
            on = on & !gone;
            result.set(
                on,
                Shadow {
                    transmittance,
                    open: scene.mask(true),
                    sure: scene.mask(false),
                    roundings: scene.f32(0.0),
                },
            );
            result
        },
    )
}

/// What light number `number` brings to a point with diffuse reflectivity `diffuse`, seen by a ray.
pub(super) fn light_term<'a, S: Simd>(
    scene: &'a Scene<'a, S>,
    state: &mut State<S>,
    on: M<S>,
    number: u32,
    point: Point<S>,
    seen: SecondaryRay<S>,
    diffuse: Vec3<F<S>>,
) -> Shade<S> {
    scene.simd.vectorize(
        #[inline(always)]
        || {
            let mut shade = <Shade<S>>::zero(scene.simd);
            let mut passed = <Passage<S>>::zero(scene.simd);
            let mut result = <Shade<S>>::zero(scene.simd);
            let mut on = on;
            let mut gone = scene.mask(false);
            let light = &scene.lights[number as usize];
            let bit = (if number < 32 { 1 << number } else { 0 });
            let here = on & ((point.lights_on_surface & bit).ne(scene.u32(0)));
            if here.any() {
                let on = here;
                result.set(on, shade);
                gone = gone | on;
            }
            on = on & !gone;
            if !on.any() {
                return result;
            }
            let toward = scene.vec3(light.location) - point.position;
            let toward_2 = toward.dot(toward);
            let inverse = toward_2
                .max(scene.f32(constants::TINY_SQUARE))
                .inverse_sqrt();
            let distance = toward_2 * inverse;
            let v = toward * inverse;
            let d = unit_step(scene, v);
            let mut c = d.dot(point.normal);
            let toward_error =
                point.error + constants::U * (light.size + constants::TOWARD_ROUNDINGS * distance);
            let here = on
                & (!distance.gt(constants::CLOSE_FROM * toward_error)
                    | inverse.gt(scene.f32(scene.light_nearest)));
            if here.any() {
                let on = here;
                state.doubt.set(on, scene.mask(true));
                result.set(on, shade);
                gone = gone | on;
            }
            on = on & !gone;
            if !on.any() {
                return result;
            }
            let d_error =
                constants::CLOSE * toward_error * inverse + constants::AIM_ROUNDINGS * constants::U;
            let distance_error =
                toward_error + constants::LIMIT_ROUNDINGS * constants::U * distance;
            let mut c_error =
                d_error + point.normal_error + constants::DOT_ROUNDINGS * constants::U;
            let low = (bit & point.low_light).ne(scene.u32(0));
            c = low.select(point.height * inverse, c);
            c_error = low.select(
                c.abs()
                    * (constants::HEIGHT_SLOPE * distance_error * inverse
                        + constants::HEIGHT_ROUNDINGS * constants::U),
                c_error,
            );
            let here = on & c.lt(-c_error);
            if here.any() {
                let on = here;
                result.set(on, shade);
                gone = gone | on;
            }
            on = on & !gone;
            if !on.any() {
                return result;
            }
            let mut sure = c.gt(c_error);
            let inside = -d.dot(scene.vec3(light.axis)) - light.cosine;
            let inside_error = d_error + constants::CONE_ROUNDINGS * constants::U;
            if light.cosine >= -1.0 {
                let here = on & inside.lt(-inside_error);
                if here.any() {
                    let on = here;
                    result.set(on, shade);
                    gone = gone | on;
                }
                on = on & !gone;
                sure = sure & inside.gt(inside_error);
            }
            on = on & !gone;
            if !on.any() {
                return result;
            }
            if light.projector != 0 {
                let passage_2 = passage(
                    scene,
                    state,
                    on,
                    &scene.projectors[(light.projector - 1) as usize],
                    point.group,
                    toward,
                    distance,
                    toward_error,
                );
                passed = passage_2;
                sure = sure & passed.sure;
                let here = on & !passed.passes;
                if here.any() {
                    let on = here;
                    result.set(on, shade);
                    gone = gone | on;
                }
                on = on & !gone;
            }
            on = on & !gone;
            if !on.any() {
                return result;
            }
            let way = SecondaryRay {
                base: point.position,
                dir: d,
                base_error: point.error,
                dir_error: d_error,
                start_error: scene.f32(0.0),
                size: point.size,
            };
            let blocked = by_hand::shadow(
                scene,
                state,
                on,
                way,
                Range {
                    skip: point.group,
                    light: scene.u32(bit),
                    beyond: scene.f32(0.0),
                    limit: distance,
                    beyond_error: scene.f32(0.0),
                    limit_error: distance_error,
                },
            );
            sure = sure & blocked.sure;
            let here = on & !blocked.open;
            if here.any() {
                let on = here;
                result.set(on, shade);
                gone = gone | on;
            }
            on = on & !gone;
            if !on.any() {
                return result;
            }
            let mut emissivity = scene.vec3(light.emissivity);
            if light.projector != 0 {
                let v_2 = emissivity;
                let texel_2 = passed_texel(
                    scene,
                    state,
                    on,
                    &scene.projectors[(light.projector - 1) as usize],
                    passed,
                );
                emissivity = v_2 * texel_2;
            }
            let full = diffuse * emissivity * blocked.transmittance * (inverse * scene.camera_unit);
            shade.color = full * c.max(scene.f32(0.0));
            shade.error = full
                * (c_error
                    + c.max(scene.f32(0.0))
                        * (constants::CLOSE * distance_error * inverse
                            + (constants::LIGHT_ROUNDINGS + blocked.roundings) * constants::U));
            let material = scene.gather(
                &scene.materials,
                scene
                    .gather(&scene.lit_objects, point.object)
                    .u32(offset_of!(records::LitObject, material)),
            );
            let here = on
                & material
                    .f32(offset_of!(records::Material, shininess))
                    .gt(scene.f32(0.0));
            if here.any() {
                let on = here;
                let half = d - seen.dir;
                let half_error =
                    seen.dir_error + d_error + constants::HALF_ROUNDINGS * constants::U;
                let most = glint_power(
                    scene,
                    state,
                    on,
                    half,
                    half_error,
                    point.normal,
                    point.normal_error,
                    material.f32(offset_of!(records::Material, shininess)),
                );
                let glint =
                    material.vec3(offset_of!(records::Material, specular)) * emissivity * most.x;
                shade.color.set(on, shade.color + glint);
                shade.error.set(on, shade.error + glint * most.y);
                shade.error.set(on, shade.error + glint * constants::U);
            }
            let here = on & !sure;
            if here.any() {
                let on = here;
                shade.error.set(on, shade.error + shade.color);
            }
            result.set(on, shade);
            result
        },
    )
}

/// The quadric as a primary ray meets it.
#[inline(always)]
pub(super) fn quadric_hits<'a, S: Simd>(
    scene: &'a Scene<'a, S>,
    on: M<S>,
    quadric: &records::Quadric,
    ray: Ray<S>,
) -> PrimaryIntersection<S> {
    let mut intersection = <PrimaryIntersection<S>>::zero(scene.simd);
    let length = ray.w2 * ray.inverse_length;
    let direction = unit_direction(scene, ray);
    let seen = QuadricRay {
        base: Vec3::splat(scene.f32(0.0)),
        dir: direction,
        start: scene.f32(0.0),
        base_error: scene.f32(0.0),
        dir_error: scene.f32(scene.dir_error),
        size: scene.f32(0.0),
        start_error: scene.f32(0.0),
    };
    let met = quadric_meets(scene, on, quadric, seen, scene.f32(-1.0), scene.f32(0.0));
    let limit = constants::NEAREST * length;
    intersection.hit = met.hit & met.t.gt(constants::FIRST_ORDER * met.error) & met.t.gt(limit);
    intersection.possible = met.possible;
    let nearest = intersection.hit.select(met.t, met.low).max(limit);
    let is_closest = !intersection.hit & met.low.lt(limit);
    intersection.inverse = is_closest.select(scene.f32(constants::CLOSEST), length / nearest);
    intersection.error = intersection.inverse
        * (intersection.hit.select(
            constants::SECOND_ORDER * met.error / nearest,
            scene.f32(0.0),
        ) + scene.length_error);
    intersection
}

/// Takes a hit if it is nearer, or as near and first in the file.
#[inline(always)]
pub(super) fn nearer<'a, S: Simd>(
    scene: &'a Scene<'a, S>,
    closest: &mut Hit<S>,
    intersection: PrimaryIntersection<S>,
    object: U<S>,
    index: U<S>,
    group: U<S>,
) {
    let mut hit = intersection.hit;
    let mut possible = intersection.possible;
    let fresh = group.eq(scene.u32(0)) | group.ne(closest.group);
    hit = hit & fresh;
    possible = possible & fresh;
    let takes = hit & intersection.inverse.gt(closest.inverse);
    let high = possible.select(intersection.inverse + intersection.error, scene.f32(0.0));
    closest.rival = closest
        .rival
        .max(takes.select(closest.inverse + closest.error, high));
    closest.error = takes.select(intersection.error, closest.error);
    closest.group = takes.select(group, closest.group);
    closest.inverse = takes.select(intersection.inverse, closest.inverse);
    closest.object = takes.select(object, closest.object);
    closest.index = takes.select(index, closest.index);
}

/// The primary ray as one from anywhere.
#[inline(always)]
pub(super) fn as_secondary_ray<'a, S: Simd>(
    scene: &'a Scene<'a, S>,
    ray: Ray<S>,
) -> SecondaryRay<S> {
    let direction = unit_direction(scene, ray);
    SecondaryRay {
        base: Vec3::splat(scene.f32(0.0)),
        dir: direction,
        base_error: scene.f32(0.0),
        dir_error: scene.f32(scene.dir_error),
        start_error: scene.f32(0.0),
        size: scene.f32(0.0),
    }
}

/// Where a primary ray hit.
#[inline(always)]
pub(super) fn locate<'a, S: Simd>(
    scene: &'a Scene<'a, S>,
    on: M<S>,
    ray: Ray<S>,
    hit: Hit<S>,
) -> Point<S> {
    let mut point = <Point<S>>::zero(scene.simd);
    point.object = hit.object;
    point.pixel = ray.pixel;
    point.direct = scene.mask(true);
    let s = 1.0 / hit.inverse;
    let v = ray.w * s;
    point.position = v;
    let length = ray.w2 * ray.inverse_length;
    point.error = constants::SECOND_ORDER
        * s
        * (scene.w_error + length * (s * hit.error + constants::HIT_ROUNDINGS * constants::U));
    point.size = point.position.x.abs() + point.position.y.abs() + point.position.z.abs();
    complete(scene, on, &mut point);
    let here = on
        & ((scene
            .gather(&scene.lit_objects, hit.object)
            .u32(offset_of!(records::LitObject, place))
            & constants::QUADRIC_BIT)
            .ne(scene.u32(0)));
    if here.any() {
        let on = here;
        let t = ray.w2 * ray.inverse_length * s;
        let quadric = scene.gather(
            &scene.quadrics,
            scene
                .gather(&scene.lit_objects, hit.object)
                .u32(offset_of!(records::LitObject, place))
                & 3221225471,
        );
        let error = t * (constants::SECOND_ORDER * hit.error * s + scene.length_error);
        let ray_2 = as_secondary_ray(scene, ray);
        let normal = quadric_normal(scene, quadric, ray_2, t, error);
        on_quadric(scene, on, &mut point, normal);
    }
    let here = on
        & ((scene
            .gather(&scene.lit_objects, hit.object)
            .u32(offset_of!(records::LitObject, place))
            & constants::SPHERE_BIT)
            .ne(scene.u32(0)));
    if here.any() {
        let on = here;
        let normal_2 = sphere_normal(scene, hit.index, ray, hit);
        on_sphere(scene, on, &mut point, normal_2);
    }
    point
}

/// Whether every channel of a weight is of ordinary size, or 0 because a factor of it is 0: not because f32 could not
/// hold it. That is asked of exponents, since a compiler may take it for granted that no number is too large for f32.
#[inline(always)]
pub(super) fn ordinary<'a, S: Simd>(
    scene: &'a Scene<'a, S>,
    before: Vec3<F<S>>,
    factor: Vec3<F<S>>,
    weight: Vec3<F<S>>,
) -> M<S> {
    let exponent =
        weight.map(|v| v.bits()) >> Vec3::splat(scene.u32(23)) & Vec3::splat(scene.u32(255));
    let least = constants::WEIGHT_LEAST as u32;
    let inside = (exponent - Vec3::splat(scene.u32(least))).zip(
        Vec3::splat(scene.u32(constants::WEIGHT_MOST as u32 - least)),
        |a, b| a.le(b),
    );
    (inside
        | before.zip(Vec3::splat(scene.f32(0.0)), |a, b| a.eq(b))
        | factor.zip(Vec3::splat(scene.f32(0.0)), |a, b| a.eq(b)))
    .all()
}

/// Adds what a point brings that a branch ends at; `ended` is the branch with the length of its path up to there.
#[inline(always)]
pub(super) fn add_shade<'a, S: Simd>(
    scene: &'a Scene<'a, S>,
    on: M<S>,
    traced: &mut Traced<S>,
    ended: Branch<S>,
    kept: F<S>,
    lit: Shade<S>,
) {
    let share = ended.weight * (kept / ended.total * scene.camera_gain);
    traced.color.set(on, traced.color + share * lit.color);
    let off = constants::SECOND_ORDER * (ended.weight_error + ended.total_error / ended.total);
    traced.error.set(
        on,
        traced.error
            + (share
                * (lit.error
                    * (constants::SECOND_ORDER + constants::SECOND_ORDER * ended.weight_error)
                    + lit.color * (off + constants::SHARE_ROUNDINGS * constants::U))
                + constants::SUM_ROUNDINGS * constants::U * (traced.color + traced.error)),
    );
}

/// What a mirror where a ray from anywhere ended adds to the errors of the line and of the path's length.
#[inline(always)]
pub(super) fn mirror_slip<'a, S: Simd>(
    scene: &'a Scene<'a, S>,
    ray: SecondaryRay<S>,
    at: PathPoint<S>,
) -> Vec2<F<S>> {
    let slip = Vec2::splat(
        at.t * ray.dir_error + constants::BOUNCE_ROUNDINGS * constants::U * (ray.size + at.t),
    );
    let curved = scene
        .gather(&scene.lit_objects, at.point.object)
        .u32(offset_of!(records::LitObject, place))
        .ge(scene.u32(constants::QUADRIC_BIT));
    curved.select(
        Vec2::new(
            (at.point.error - ray.base_error).max(scene.f32(0.0)),
            at.t_error + at.point.error,
        ),
        slip,
    )
}

/// The mirror image of the ray that ended at a point.
#[inline(always)]
pub(super) fn mirror_branch<'a, S: Simd>(
    scene: &'a Scene<'a, S>,
    state: &mut State<S>,
    on: M<S>,
    ended: Branch<S>,
    at: PathPoint<S>,
    specular: Vec3<F<S>>,
) -> Branch<S> {
    let mut mirror = <Branch<S>>::zero(scene.simd);
    let point = at.point;
    let along = -point.normal.dot(ended.ray.dir);
    mirror.ray.base = point.position;
    mirror.total = ended.total;
    mirror.last = point.group;
    let v = ended.weight * specular;
    mirror.weight = v;
    let v_2 = state.doubt;
    let ordinary_2 = ordinary(scene, ended.weight, specular, mirror.weight);
    state.doubt.set(on, v_2 | !ordinary_2);
    let v_3 = 2.0 * along * point.normal + ended.ray.dir;
    let step = unit_step(scene, v_3);
    mirror.ray.dir = step;
    mirror.ray.dir_error = constants::MIRROR_GROWTH * ended.ray.dir_error
        + constants::MIRROR_TURN * point.normal_error
        + constants::MIRROR_ROUNDINGS * constants::U;
    mirror.ray.base_error =
        (1.0 + constants::LINE_ROUNDINGS * constants::U) * (ended.ray.base_error + at.slip.x);
    mirror.ray.start_error = at.t_error + at.slip.y;
    mirror.ray.size = point.size;
    mirror.total_error =
        (1.0 + constants::LINE_ROUNDINGS * constants::U) * (ended.total_error + at.slip.y);
    mirror.weight_error = (1.0 + constants::WEIGHT_GROWTH * constants::U) * ended.weight_error
        + constants::WEIGHT_ROUNDINGS * constants::U;
    mirror
}

/// The ray that goes on behind the point at which a ray ended.
#[inline(always)]
pub(super) fn through_branch<'a, S: Simd>(
    scene: &'a Scene<'a, S>,
    state: &mut State<S>,
    on: M<S>,
    ended: Branch<S>,
    at: PathPoint<S>,
    transparency: F<S>,
) -> Branch<S> {
    let point = at.point;
    let mut through = ended;
    through.last = point.group;
    let base = ended.ray.base + at.t * ended.ray.dir;
    let slip = at.t * ended.ray.dir_error
        + constants::POSITION_ROUNDINGS * constants::U * (ended.ray.size + at.t);
    through.ray.base = base;
    through.ray.base_error =
        (1.0 + constants::LINE_ROUNDINGS * constants::U) * (ended.ray.base_error + slip);
    through.ray.start_error = at.t_error + slip;
    through.ray.size = base.x.abs() + base.y.abs() + base.z.abs();
    through.total_error =
        (1.0 + constants::LINE_ROUNDINGS * constants::U) * (ended.total_error + slip);
    through.weight_error = (1.0 + constants::WEIGHT_GROWTH * constants::U) * ended.weight_error
        + constants::PANE_WEIGHT_ROUNDINGS * constants::U;
    let holds = transparency.gt(scene.f32(0.0));
    let here = on & holds;
    if here.any() {
        let on = here;
        let material = tile_material(scene, state, on, point);
        let factor = scene
            .gather(&scene.materials, material)
            .vec3(offset_of!(records::Material, tint))
            * transparency;
        let v = ended.weight * factor;
        through.weight.set(on, v);
        let v_2 = state.doubt;
        let ordinary_2 = ordinary(scene, ended.weight, factor, through.weight);
        state.doubt.set(on, v_2 | !ordinary_2);
    }
    let here = on & !holds;
    if here.any() {
        let on = here;
        through.weight.set(on, Vec3::splat(scene.f32(0.0)));
    }
    through
}

/// What the lights and the light that is everywhere make of a point, seen by a ray.
#[inline(always)]
pub(super) fn shade<'a, S: Simd>(
    scene: &'a Scene<'a, S>,
    state: &mut State<S>,
    on: M<S>,
    point: Point<S>,
    seen: SecondaryRay<S>,
) -> Shade<S> {
    let mut i: u32 = 0;
    let getamb_2 = getamb(scene, state, on, point);
    let mut sum = getamb_2;
    let diffuse = getdiff(scene, state, on, point);
    loop {
        if i < scene.lights_count {
        } else {
            break;
        }
        let term = light_term(scene, state, on, i, point, seen, diffuse);
        sum.color = sum.color + term.color;
        sum.error = sum.error
            + (term.error + constants::SUM_ROUNDINGS * constants::U * (sum.color + sum.error));
        i = i + 1;
    }
    sum
}

/// Follows the tree from where the primary ray hit.
#[inline(always)]
pub(super) fn follow<'a, S: Simd>(
    scene: &'a Scene<'a, S>,
    state: &mut State<S>,
    on: M<S>,
    traced: &mut Traced<S>,
    primary: SecondaryRay<S>,
    first: PathPoint<S>,
) {
    let mut branch = <Branch<S>>::zero(scene.simd);
    let mut rays = scene.u32(1);
    let mut ended = <Branch<S>>::zero(scene.simd);
    let mut mirrors = <M<S>>::zero(scene.simd);
    let mut passes = <M<S>>::zero(scene.simd);
    let mut hit = <SecondaryHit<S>>::zero(scene.simd);
    let mut follows = <M<S>>::zero(scene.simd);
    let mut at = first;
    branch.ray = primary;
    branch.last = scene.u32(constants::NOTHING);
    branch.weight = Vec3::splat(scene.f32(1.0));
    state.waiting.set(on, scene.u32(0));
    let mut looping_1 = on;
    while looping_1.any() {
        let mut on = looping_1;
        let mut gone_1 = scene.mask(false);
        'round_1: {
            let material = scene.gather(
                &scene.materials,
                scene
                    .gather(&scene.lit_objects, at.point.object)
                    .u32(offset_of!(records::LitObject, material)),
            );
            let lit = shade(scene, state, on, at.point, branch.ray);
            branch.total.set(on, branch.total + at.t);
            branch
                .total_error
                .set(on, branch.total_error + constants::U * branch.total);
            ended = branch;
            ended.total_error = ended.total_error + at.t_error;
            add_shade(
                scene,
                on,
                traced,
                ended,
                material.f32(offset_of!(records::Material, kept)),
                lit,
            );
            let here = on
                & (state.doubt
                    | (constants::FIRST_ORDER * ended.total_error).gt(ended.total)
                    | ended.total.lt(scene.f32(scene.total_least)));
            if here.any() {
                let on = here;
                traced.verdict.set(on, scene.u32(constants::UNDECIDED));
                looping_1 = looping_1 & !on;
                gone_1 = gone_1 | on;
            }
            on = on & !gone_1;
            if !on.any() {
                break 'round_1;
            }
            let mirror = mirror_branch(
                scene,
                state,
                on,
                branch,
                at,
                material.vec3(offset_of!(records::Material, specular)),
            );
            mirrors = mirror
                .weight
                .zip(Vec3::splat(scene.f32(0.0)), |a, b| a.gt(b))
                .any_of();
            let through = through_branch(
                scene,
                state,
                on,
                branch,
                at,
                material.f32(offset_of!(records::Material, transparency)),
            );
            passes = through
                .weight
                .zip(Vec3::splat(scene.f32(0.0)), |a, b| a.gt(b))
                .any_of();
            let short = scene.max_path - branch.total;
            let short_sure = short
                .abs()
                .gt(ended.total_error + constants::PATH_ROUNDINGS * constants::U * scene.max_path);
            let here = on & (state.doubt | (mirrors | passes) & !short_sure);
            if here.any() {
                let on = here;
                traced.verdict.set(on, scene.u32(constants::UNDECIDED));
                looping_1 = looping_1 & !on;
                gone_1 = gone_1 | on;
            }
            on = on & !gone_1;
            if !on.any() {
                break 'round_1;
            }
            let within = branch.total.le(scene.f32(scene.max_path));
            mirrors = mirrors & within;
            passes = passes & within;
            let here = on & (mirrors & passes);
            if here.any() {
                let mut on = here;
                let here = on & state.waiting.eq(scene.u32(constants::STACK));
                if here.any() {
                    let on = here;
                    traced.verdict.set(on, scene.u32(constants::UNDECIDED));
                    looping_1 = looping_1 & !on;
                    gone_1 = gone_1 | on;
                }
                on = on & !gone_1;
                scene.put(&mut state.stack, on, state.waiting, mirror);
                let v = state.waiting;
                state.waiting.set(on, state.waiting + 1);
            }
            on = on & !gone_1;
            if !on.any() {
                break 'round_1;
            }
            branch.set(on, mirror);
            let here = on & passes;
            if here.any() {
                let on = here;
                branch.set(on, through);
            }
            hit = <SecondaryHit<S>>::zero(scene.simd);
            hit.object = scene.u32(constants::NOTHING);
            follows = mirrors | passes;
            let mut looping_2 = on;
            while looping_2.any() {
                let mut on = looping_2;
                let mut gone_2 = scene.mask(false);
                'round_2: {
                    let here = on & !follows;
                    if here.any() {
                        let mut on = here;
                        let here = on & state.waiting.eq(scene.u32(0));
                        if here.any() {
                            let on = here;
                            looping_2 = looping_2 & !on;
                            gone_2 = gone_2 | on;
                        }
                        on = on & !gone_2;
                        state.waiting.set(on, state.waiting - 1);
                        branch.set(on, scene.take(&state.stack, state.waiting));
                    }
                    on = on & !gone_2;
                    if !on.any() {
                        break 'round_2;
                    }
                    let here = on & rays.eq(scene.u32(scene.max_rays));
                    if here.any() {
                        let on = here;
                        traced.verdict.set(on, scene.u32(constants::UNDECIDED));
                        looping_2 = looping_2 & !on;
                        gone_2 = gone_2 | on;
                    }
                    on = on & !gone_2;
                    if !on.any() {
                        break 'round_2;
                    }
                    rays.set(on, rays + 1);
                    let hit_2 = by_hand::closest_hit(
                        scene,
                        on,
                        branch.ray,
                        Range {
                            skip: branch.last,
                            light: scene.u32(0),
                            beyond: scene.f32(0.0),
                            limit: scene.f32(constants::T_MAX),
                            beyond_error: scene.f32(0.0),
                            limit_error: scene.f32(0.0),
                        },
                        scene.lanes,
                    );
                    hit.set(on, hit_2);
                    let v_2 = state.doubt;
                    let closest = surely_closest(scene, hit);
                    state.doubt.set(
                        on,
                        v_2 | (!closest | branch.ray.dir_error.gt(scene.f32(constants::DIR_LIMIT))),
                    );
                    let here = on & (hit.object.ne(scene.u32(constants::NOTHING)) | state.doubt);
                    if here.any() {
                        let on = here;
                        looping_2 = looping_2 & !on;
                        gone_2 = gone_2 | on;
                    }
                    on = on & !gone_2;
                    if !on.any() {
                        break 'round_2;
                    }
                    follows.set(on, scene.mask(false));
                }
            }
            let here = on & state.doubt;
            if here.any() {
                let on = here;
                traced.verdict.set(on, scene.u32(constants::UNDECIDED));
                looping_1 = looping_1 & !on;
                gone_1 = gone_1 | on;
            }
            on = on & !gone_1;
            if !on.any() {
                break 'round_1;
            }
            let here = on & hit.object.eq(scene.u32(constants::NOTHING));
            if here.any() {
                let on = here;
                looping_1 = looping_1 & !on;
                gone_1 = gone_1 | on;
            }
            on = on & !gone_1;
            if !on.any() {
                break 'round_1;
            }
            let secondary = locate_secondary(scene, on, branch.ray, hit);
            at.point.set(on, secondary);
            at.t.set(on, hit.t);
            at.t_error.set(on, hit.error);
            let slip = mirror_slip(scene, branch.ray, at);
            at.slip.set(on, slip);
        }
    }
}

/// Whether the primary ray's hit leaves nothing to look at: nothing is met, or it is in doubt what; `traced` then is
/// all.
#[inline(always)]
pub(super) fn hit_decides<'a, S: Simd>(
    scene: &'a Scene<'a, S>,
    on: M<S>,
    traced: &mut Traced<S>,
    ray: Ray<S>,
    hit: Hit<S>,
) -> M<S> {
    let mut result = <M<S>>::zero(scene.simd);
    let mut on = on;
    let mut gone = scene.mask(false);
    let nothing = (hit.inverse + hit.error).le(scene.f32(0.0)) & hit.rival.le(scene.f32(0.0));
    let sure = (hit.inverse - hit.rival).gt(hit.error)
        & (hit.inverse * ray.inverse_length).gt(scene.f32(constants::LEAST_INVERSE))
        & hit.inverse.gt(constants::FIRST_ORDER * hit.error);
    let here = on & (nothing | !sure);
    if here.any() {
        let on = here;
        traced.verdict.set(
            on,
            nothing.select(scene.u32(0), scene.u32(constants::UNDECIDED)),
        );
        result.set(on, scene.mask(true));
        gone = gone | on;
    }
    on = on & !gone;
    if !on.any() {
        return result;
    }
    result.set(on, scene.mask(false));
    result
}

/// Traces a primary ray.
pub(super) fn ray_trace<'a, S: Simd>(
    scene: &'a Scene<'a, S>,
    state: &mut State<S>,
    on: M<S>,
    ray: Ray<S>,
) -> Traced<S> {
    scene.simd.vectorize(
        #[inline(always)]
        || {
            let mut traced = <Traced<S>>::zero(scene.simd);
            let mut next_hit = <PathPoint<S>>::zero(scene.simd);
            let mut result = <Traced<S>>::zero(scene.simd);
            let mut on = on;
            let mut gone = scene.mask(false);
            let hit = by_hand::find_closest_object(scene, ray);
            let decides = hit_decides(scene, on, &mut traced, ray, hit);
            let here = on & decides;
            if here.any() {
                let on = here;
                result.set(on, traced);
                gone = gone | on;
            }
            on = on & !gone;
            if !on.any() {
                return result;
            }
            state.doubt.set(on, scene.mask(false));
            let t = ray.w2 * ray.inverse_length / hit.inverse;
            let t_error =
                t * (constants::SECOND_ORDER * hit.error / hit.inverse + scene.length_error);
            let locate_2 = locate(scene, on, ray, hit);
            next_hit.point = locate_2;
            next_hit.t = t;
            next_hit.t_error = t_error;
            next_hit.slip = Vec2::new(next_hit.point.error, next_hit.point.error + t_error);
            let ray_2 = as_secondary_ray(scene, ray);
            follow(scene, state, on, &mut traced, ray_2, next_hit);
            traced.error = traced.error + Vec3::splat(scene.f32(constants::FLUSHED));
            let here = on & state.doubt;
            if here.any() {
                let on = here;
                traced.verdict.set(on, scene.u32(constants::UNDECIDED));
            }
            result.set(on, traced);
            result
        },
    )
}
