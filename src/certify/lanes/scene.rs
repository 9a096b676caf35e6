//! What the lanes know of a scene: the numbers that stand in the GPU's text, and what its buffers hold.

use std::fmt::Debug;
use std::ops::Deref;

use bytemuck::{Pod, Zeroable as _};
use fearless_simd::Simd;

use super::gather::Gather;
use super::vector::{D, F, I, Lanewise, M, U, Vec2, Vec3, Vec4};
use crate::real::rational::two_to;
use crate::settings::Settings;
use crate::shader::bounds;
use crate::shader::format::{Double, Format, Single};
use crate::shader::pack::{Lit, Packed};
use crate::shader::records::Dispatch;
use crate::shader::records::wide::{
    BvhNode, CameraNumbers, Light, LitObject, Material, Object, Plane, Polygon, ProceduralPlane,
    Projector, Quadric, Sphere, SphereHit, Texplane, TiledPlane, WorldPlane, WorldSphere,
};

/// A format of the lanes' numbers.
pub(super) trait LaneFormat: Format {
    /// A number that all lanes share.
    type Real: Copy + Debug;

    /// The nearest number.
    fn real(value: f64) -> Self::Real;
}

impl LaneFormat for Single {
    type Real = f32;

    #[inline(always)]
    fn real(value: f64) -> f32 {
        value as f32
    }
}

impl LaneFormat for Double {
    type Real = f64;

    #[inline(always)]
    fn real(value: f64) -> f64 {
        value
    }
}

/// The numbers that the text refers to by name, as the GPU's text has them.
#[derive(Debug, Clone)]
pub(super) struct Numbers<R> {
    pub(super) camera_anchor: [i32; 2],
    pub(super) camera_step: [R; 2],
    pub(super) camera_offset: [R; 2],
    pub(super) camera_distance: R,
    pub(super) camera_gain: R,
    pub(super) camera_unit: R,
    pub(super) w_error: R,
    pub(super) length_error: R,
    pub(super) dir_error: R,
    pub(super) value_error: R,
    pub(super) dark: R,
    pub(super) bright: R,
    pub(super) light_nearest: R,
    pub(super) total_least: R,
    pub(super) bvh_size: R,
    pub(super) max_path: R,
    pub(super) max_rays: u32,
    pub(super) lights_count: u32,
    /// How a loop's rounds count for a driver: nobody counts them here.
    pub(super) lanes: u32,
    /// Where the tables begin behind the objects, and the third sides behind them.
    pub(super) tables: u32,
    pub(super) columns: u32,
    pub(super) third_sides: u32,
    /// Whether some object lets light through.
    pub(super) transparent: bool,
    /// What the host tells a GPU with each dispatch: nothing but a 0 is asked of it.
    pub(super) dispatch: Dispatch,
}

/// So many rays a sample may have at most: no sum of theirs leaves the range then (docs/NUMERICS.md).
const MOST_RAYS: u32 = 1 << 16;

/// The numbers for a format.
pub(super) fn numbers<X: LaneFormat>(packed: &Packed<X>, settings: &Settings) -> Numbers<X::Real> {
    let camera = &packed.camera;
    let seen: CameraNumbers = X::wide(&camera.numbers);
    let [length, dir] = bounds::direction_roundings(settings.supersampling().is_some());
    let above = |value: f64| X::real(X::round_up(value));
    let for_spread = |roundings: f64| above(roundings * f64::from(camera.condition) * X::U);
    let lit = packed.lit.as_ref();
    let words = packed.tables.words.len();
    Numbers {
        camera_anchor: seen.anchor,
        camera_step: seen.step.map(X::real),
        camera_offset: seen.offset.map(X::real),
        camera_distance: X::real(seen.distance),
        camera_gain: X::real(seen.gain),
        camera_unit: X::real(seen.unit),
        w_error: X::real(camera.w_error.into()),
        length_error: for_spread(length),
        dir_error: for_spread(dir),
        value_error: for_spread(bounds::VALUE_ROUNDINGS),
        dark: X::real(packed.dark.into()),
        bright: above(packed.brightest()),
        light_nearest: above(packed.light_nearest()),
        total_least: above(packed.total_least()),
        bvh_size: X::real(packed.tree_size.into()),
        max_path: X::real(settings.limits.max_path * two_to(-packed.scale)),
        max_rays: settings.limits.max_rays.min(MOST_RAYS),
        lights_count: lit.map_or(0, |lit| lit.lights.len() as u32),
        lanes: 1,
        tables: packed.objects.len() as u32,
        columns: packed.tables.columns,
        third_sides: (packed.objects.len() + words) as u32,
        transparent: lit.is_some_and(|lit| lit.transparent),
        dispatch: Dispatch::zeroed(),
    }
}

/// The buffers that are not as the packed scene has them.
#[derive(Debug, Clone)]
pub(super) struct Buffers<X: Format> {
    /// The objects of a scene without lights, and the tables behind them.
    pub(super) objects: Vec<X::Record<Object>>,
    /// The same of a scene with lights, and the third sides behind the tables.
    pub(super) lit_objects: Vec<X::Record<LitObject>>,
}

/// A scene as the lanes' functions ask for it.
pub(super) struct Scene<'a, S: Simd, X: LaneFormat> {
    pub(super) simd: S,
    numbers: &'a Numbers<X::Real>,
    pub(super) packed: &'a Packed<X>,
    pub(super) objects: &'a [X::Record<Object>],
    pub(super) lit_objects: &'a [X::Record<LitObject>],
    pub(super) polygons: &'a [X::Record<Polygon>],
    pub(super) planes: &'a [X::Record<Plane>],
    pub(super) spheres: &'a [X::Record<Sphere>],
    pub(super) sphere_points: &'a [X::Record<SphereHit>],
    pub(super) quadrics: &'a [X::Record<Quadric>],
    pub(super) tiled_planes: &'a [X::Record<TiledPlane>],
    pub(super) pplanes: &'a [X::Record<ProceduralPlane>],
    pub(super) texplanes: &'a [X::Record<Texplane>],
    pub(super) texels: &'a [u32],
    pub(super) bvh: &'a [X::Record<BvhNode>],
    pub(super) materials: &'a [X::Record<Material>],
    pub(super) lights: &'a [X::Record<Light>],
    pub(super) projectors: &'a [X::Record<Projector>],
    pub(super) world_planes: &'a [X::Record<WorldPlane>],
    pub(super) world_spheres: &'a [X::Record<WorldSphere>],
}

impl<S: Simd, X: LaneFormat> Deref for Scene<'_, S, X> {
    type Target = Numbers<X::Real>;

    #[inline(always)]
    fn deref(&self) -> &Numbers<X::Real> {
        self.numbers
    }
}

impl<'a, S: Simd> Scene<'a, S, Single> {
    /// A number of the scene's format.
    #[inline(always)]
    pub(super) fn real(&self, value: f32) -> F<S> {
        self.f32(value)
    }

    /// A vector of such numbers.
    #[inline(always)]
    pub(super) fn reals(&self, value: [f32; 3]) -> Vec3<F<S>> {
        self.vec3(value)
    }
}

impl<'a, S: Simd> Scene<'a, S, Double> {
    /// A number of the scene's format.
    #[inline(always)]
    pub(super) fn real(&self, value: f64) -> D<S> {
        self.f64(value)
    }

    /// A vector of such numbers.
    #[inline(always)]
    pub(super) fn reals(&self, value: [f64; 3]) -> Vec3<D<S>> {
        self.vec3_f64(value)
    }
}

impl<'a, S: Simd, X: LaneFormat> Scene<'a, S, X> {
    pub(super) fn new(
        simd: S,
        packed: &'a Packed<X>,
        numbers: &'a Numbers<X::Real>,
        buffers: &'a Buffers<X>,
    ) -> Self {
        fn of<X: Format, T>(packed: &Packed<X>, of: impl Fn(&Lit<X>) -> &Vec<T>) -> &[T] {
            packed.lit.as_ref().map_or(&[], |lit| of(lit))
        }
        Self {
            simd,
            numbers,
            packed,
            objects: &buffers.objects,
            lit_objects: &buffers.lit_objects,
            polygons: &packed.polygons,
            planes: &packed.planes,
            spheres: &packed.spheres,
            sphere_points: &packed.sphere_points,
            quadrics: &packed.quadrics,
            tiled_planes: &packed.tiled_planes,
            pplanes: &packed.pplanes,
            texplanes: &packed.texplanes,
            texels: &packed.texels,
            bvh: &packed.bvh,
            materials: of(packed, |lit| &lit.materials),
            lights: of(packed, |lit| &lit.lights),
            projectors: of(packed, |lit| &lit.projectors),
            world_planes: of(packed, |lit| &lit.planes),
            world_spheres: of(packed, |lit| &lit.spheres),
        }
    }

    #[inline(always)]
    pub(super) fn f32(&self, value: f32) -> F<S> {
        F::splat(self.simd, value)
    }

    #[inline(always)]
    pub(super) fn f64(&self, value: f64) -> D<S> {
        D::splat(self.simd, value)
    }

    #[inline(always)]
    pub(super) fn u32(&self, value: u32) -> U<S> {
        U::splat(self.simd, value)
    }

    #[inline(always)]
    pub(super) fn i32(&self, value: i32) -> I<S> {
        I::splat(self.simd, value)
    }

    #[inline(always)]
    pub(super) fn mask(&self, value: bool) -> M<S> {
        M::splat(self.simd, value)
    }

    #[inline(always)]
    pub(super) fn vec2(&self, value: [f32; 2]) -> Vec2<F<S>> {
        Vec2::new(self.f32(value[0]), self.f32(value[1]))
    }

    #[inline(always)]
    pub(super) fn vec2_u32(&self, value: [u32; 2]) -> Vec2<U<S>> {
        Vec2::new(self.u32(value[0]), self.u32(value[1]))
    }

    #[inline(always)]
    pub(super) fn vec2_i32(&self, value: [i32; 2]) -> Vec2<I<S>> {
        Vec2::new(self.i32(value[0]), self.i32(value[1]))
    }

    #[inline(always)]
    pub(super) fn vec3(&self, value: [f32; 3]) -> Vec3<F<S>> {
        let [x, y, z] = value;
        Vec3::new(self.f32(x), self.f32(y), self.f32(z))
    }

    #[inline(always)]
    pub(super) fn vec4(&self, value: [f32; 4]) -> Vec4<F<S>> {
        let [x, y, z, w] = value;
        Vec4::new(self.f32(x), self.f32(y), self.f32(z), self.f32(w))
    }

    #[inline(always)]
    pub(super) fn vec2_f64(&self, value: [f64; 2]) -> Vec2<D<S>> {
        Vec2::new(self.f64(value[0]), self.f64(value[1]))
    }

    #[inline(always)]
    pub(super) fn vec3_f64(&self, value: [f64; 3]) -> Vec3<D<S>> {
        let [x, y, z] = value;
        Vec3::new(self.f64(x), self.f64(y), self.f64(z))
    }

    #[inline(always)]
    pub(super) fn vec4_f64(&self, value: [f64; 4]) -> Vec4<D<S>> {
        let [x, y, z, w] = value;
        Vec4::new(self.f64(x), self.f64(y), self.f64(z), self.f64(w))
    }

    /// Of each lane its own element.
    #[inline(always)]
    pub(super) fn gather<'b, T: Pod>(&self, buffer: &'b [T], at: U<S>) -> Gather<'b, T, S> {
        Gather::new(self.simd, buffer, at)
    }

    /// The same element for all lanes.
    #[inline(always)]
    pub(super) fn same<'b, T: Pod>(&self, element: &'b T) -> Gather<'b, T, S> {
        Gather::same(self.simd, element)
    }

    /// Stores into each lane's own element.
    #[inline(always)]
    pub(super) fn put<T: Lanewise<S>>(&self, all: &mut [T], on: M<S>, at: U<S>, new: T) {
        for (i, element) in (0..).zip(all) {
            element.set(on & at.eq(self.u32(i)), new);
        }
    }

    /// Each lane's own element.
    #[inline(always)]
    pub(super) fn take<T: Lanewise<S>>(&self, all: &[T], at: U<S>) -> T {
        let mut taken = T::zero(self.simd);
        for (i, element) in (0..).zip(all) {
            taken.set(at.eq(self.u32(i)), *element);
        }
        taken
    }
}
