//! Scenes without lights: `shaders/` for the lanes of a vector, written by `src/lower` from the WGSL. Change that, and run
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
    pub(in crate::certify::lanes) const FIRST_ORDER: f32 = 128.0;
    pub(in crate::certify::lanes) const SECOND_ORDER: f32 = 1.0100001;
    pub(in crate::certify::lanes) const ROOT_NEAR: f32 = 1.0100001;
    pub(in crate::certify::lanes) const ROOT_FAR: f32 = 0.54;
    pub(in crate::certify::lanes) const ROOT_FAR_FROM: f32 = 4.0;
    pub(in crate::certify::lanes) const HIT_ROUNDINGS: f32 = 7.5;
    pub(in crate::certify::lanes) const FLUSHED: f32 = 1.4901161e-8;
    pub(in crate::certify::lanes) const STEEP: f32 = 2.0;
    pub(in crate::certify::lanes) const DISTANCE_ROUNDINGS: f32 = 12.5;
    pub(in crate::certify::lanes) const LOWERED: f32 = 0.99999905;
    pub(in crate::certify::lanes) const POSITION_ROUNDINGS: f32 = 5.5;
    pub(in crate::certify::lanes) const TURN: f32 = 1.0200001;
    pub(in crate::certify::lanes) const TURN_MORE: f32 = 2.0;
    pub(in crate::certify::lanes) const PERPENDICULAR_ROUNDINGS: f32 = 18.5;
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
    pub(in crate::certify::lanes) const CLOSE: f32 = 1.4000001;
    pub(in crate::certify::lanes) const HALF_OPEN: f32 = 0.51000005;
    pub(in crate::certify::lanes) const WEIGHT_ROUNDINGS: f32 = 2.5;
    pub(in crate::certify::lanes) const INDEX_ROUNDINGS: f32 = 5.5;
    pub(in crate::certify::lanes) const MOST_INDEX: f32 = 1048576.0;
    pub(in crate::certify::lanes) const WHEEL_FAR: f32 = 1024.0;
    pub(in crate::certify::lanes) const WHEEL_SLOPE: f32 = 3.0;
    pub(in crate::certify::lanes) const WHEEL_ROUNDINGS: f32 = 24.0;
    pub(in crate::certify::lanes) const KIND_TILED: u32 = 1;
    pub(in crate::certify::lanes) const KIND_TEXTURED: u32 = 2;
    pub(in crate::certify::lanes) const KIND_PPLANE_0: u32 = 64;
    pub(in crate::certify::lanes) const KIND_PPLANE_1: u32 = 65;
    pub(in crate::certify::lanes) const KIND_PPLANE_2: u32 = 66;
    pub(in crate::certify::lanes) const KIND_PSPHERE_0: u32 = 128;
    pub(in crate::certify::lanes) const UNDECIDED: u32 = 4278190080;
    pub(in crate::certify::lanes) const HALF_ROOT_3: f32 = 0.8660254;
    pub(in crate::certify::lanes) const T_FAR: f32 = 1e30;
    pub(in crate::certify::lanes) const STEPS_LIMIT: u32 = 50000;
}

/// What is private to the lanes.
pub(super) struct State<S: Simd> {
    pub doubt: M<S>,
}

impl<S: Simd> State<S> {
    #[inline(always)]
    pub(super) fn new(simd: S) -> Self {
        Self {
            doubt: <M<S>>::zero(simd),
        }
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
/// A colour, and the bound of its error.
Shade {
    color: Vec3<F<S>>,
    error: Vec3<F<S>>,
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
    Vec4::new(normal.x, normal.y, normal.z, error_2)
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
        .gather(&scene.objects, scene.tables + point.object)
        .u32(offset_of!(records::Object, kind));
    let there = point.direct & first.ne(scene.u32(0));
    let column = scene.tables + there.select(first + point.pixel.x.as_u32(), scene.u32(0));
    let row =
        scene.tables + there.select(first + scene.columns + point.pixel.y.as_u32(), scene.u32(0));
    there.select(
        scene
            .gather(&scene.objects, column)
            .u32(offset_of!(records::Object, kind))
            | scene
                .gather(&scene.objects, row)
                .u32(offset_of!(records::Object, kind)),
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
#[inline(always)]
pub(super) fn texel<'a, S: Simd>(
    scene: &'a Scene<'a, S>,
    state: &mut State<S>,
    on: M<S>,
    plane: Gather<'a, records::Texplane, S>,
    point: Point<S>,
) -> Vec3<F<S>> {
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
        let known = (Vec2::splat(word) & Vec2::new(scene.u32(32768), scene.u32(2147483648)))
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

/// The ambient reflectivity at a point.
#[inline(always)]
pub(super) fn getamb<'a, S: Simd>(
    scene: &'a Scene<'a, S>,
    state: &mut State<S>,
    on: M<S>,
    point: Point<S>,
) -> Shade<S> {
    let mut shade = <Shade<S>>::zero(scene.simd);
    let mut result = <Shade<S>>::zero(scene.simd);
    let mut on = on;
    let mut gone = scene.mask(false);
    let object = scene.gather(&scene.objects, point.object);
    shade.color = object.vec3(offset_of!(records::Object, ambient));
    let record = object.u32(offset_of!(records::Object, kind)) >> 8;
    let chosen = object.u32(offset_of!(records::Object, kind)) & 255;
    let here = on & chosen.eq(scene.u32(1));
    if here.any() {
        let on = here;
        let plane = scene.gather(&scene.tiled_planes, record);
        let v = shade.color;
        let foreground = tplane_foreground(scene, state, on, plane, point);
        shade.color.set(
            on,
            foreground.select(v, plane.vec3(offset_of!(records::TiledPlane, altmaterial))),
        );
    }
    let here = on & chosen.eq(scene.u32(2));
    if here.any() {
        let on = here;
        let v_2 = shade.color;
        let texel_2 = texel(
            scene,
            state,
            on,
            scene.gather(&scene.texplanes, record),
            point,
        );
        shade.color.set(on, v_2 * texel_2);
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
            let passage = quadric_passage(scene, scene.same(&quadric), ray);
            let p = passage.perpendicular;
            let e = passage.turn;
            let g = passage.gradient;
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
            let h_error = constants::SECOND_ORDER * (length_e * passage.off + length_g * d_error)
                + 2.0 * quadric.norm * passage.off * d_error
                + u * all_h
                + constants::LEAST_SLOPE;
            let c_error = 2.0
                * passage.off
                * (constants::SECOND_ORDER * length_g + quadric.norm * passage.off)
                + u * all_c;
            let moment_error =
                constants::SECOND_ORDER * (passage.off + length_p * d_error) + u * length_p;
            let slope_error = length_v * (d_error + u);
            let sum3_2 = sum3(scene, turned);
            let disc_error = 2.0
                * moment_error
                * (constants::SECOND_ORDER * sum3_2 + quadric.adjoint_norm * moment_error)
                + 2.0
                    * constants::SECOND_ORDER
                    * length_v
                    * (length_e * moment_error
                        + (length_m + moment_error) * (passage.turn_error + u * length_e))
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
            let along = passage.along;
            let places = Vec3::new(along + one, along + two, scene.f32(0.0));
            let place_errors = Vec2::new(one_error, two_error)
                + Vec2::splat(passage.off)
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
                    - (passage.off + constants::DISTANCE_ROUNDINGS * constants::U * along.abs());
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
    point.position = ray.w * s;
    let length = ray.w2 * ray.inverse_length;
    point.error = constants::SECOND_ORDER
        * s
        * (scene.w_error + length * (s * hit.error + constants::HIT_ROUNDINGS * constants::U));
    point.size = point.position.x.abs() + point.position.y.abs() + point.position.z.abs();
    let here = on
        & ((scene
            .gather(&scene.objects, hit.object)
            .u32(offset_of!(records::Object, kind))
            & 128)
            .ne(scene.u32(0)));
    if here.any() {
        let on = here;
        let normal = sphere_normal(scene, hit.index, ray, hit);
        point
            .from_center
            .set(on, Vec3::new(normal.x, normal.y, normal.z));
        point.from_center_error.set(on, normal.w);
    }
    point
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
    let dark =
        ((hit.inverse + hit.error).max(hit.rival) * ray.inverse_length).lt(scene.f32(scene.dark));
    let mut sure = (hit.inverse - hit.rival).gt(hit.error);
    sure = sure & hit.inverse.gt(constants::FIRST_ORDER * hit.error);
    let here = on & (dark | !sure);
    if here.any() {
        let on = here;
        traced.verdict.set(
            on,
            dark.select(scene.u32(0), scene.u32(constants::UNDECIDED)),
        );
        let most = (hit.inverse + hit.error).max(hit.rival) * ray.inverse_length * scene.bright;
        traced.color.set(on, Vec3::splat(0.5 * most));
        traced
            .error
            .set(on, Vec3::splat(constants::HALF_OPEN * most));
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
            let locate_2 = locate(scene, on, ray, hit);
            let ambient = getamb(scene, state, on, locate_2);
            let share = scene.camera_gain * ray.inverse_length;
            traced.color = ambient.color * (share * hit.inverse);
            traced.error = ambient.color
                * (share * (constants::SECOND_ORDER * hit.error + scene.value_error * hit.inverse));
            traced.error =
                traced.error + ambient.error * (constants::SECOND_ORDER * share * hit.inverse);
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
