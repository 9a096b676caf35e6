//! What the lanes know of a scene: the numbers that stand in the GPU's text, and what its buffers hold.

use std::ops::Deref;

use bytemuck::Pod;
use fearless_simd::Simd;

use super::gather::Gather;
use super::vector::{F, I, Lanewise, M, U, Vec2, Vec3, Vec4};
use crate::real::rational::two_to;
use crate::settings::Settings;
use crate::shader::bounds;
use crate::shader::pack::{Lit, Packed};
use crate::shader::records::{
    BvhNode, Light, LitObject, Material, Object, Projector, Quadric, Texplane, TiledPlane,
    WorldPlane, WorldSphere,
};
use crate::shader::records::{Plane, Polygon, ProceduralPlane, Sphere, SphereHit};

/// The numbers that the text refers to by name, as the GPU's text has them.
#[derive(Debug, Clone)]
pub(super) struct Numbers {
    pub(super) camera_anchor: [i32; 2],
    pub(super) camera_step: [f32; 2],
    pub(super) camera_offset: [f32; 2],
    pub(super) camera_distance: f32,
    pub(super) camera_gain: f32,
    pub(super) camera_unit: f32,
    pub(super) w_error: f32,
    pub(super) length_error: f32,
    pub(super) dir_error: f32,
    pub(super) value_error: f32,
    pub(super) dark: f32,
    pub(super) bright: f32,
    pub(super) light_nearest: f32,
    pub(super) total_least: f32,
    pub(super) bvh_size: f32,
    pub(super) max_path: f32,
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
}

impl Numbers {
    pub(super) fn new(packed: &Packed, settings: &Settings) -> Self {
        let camera = &packed.camera;
        let numbers = &camera.numbers;
        let [length, dir] = bounds::direction_roundings(settings.supersampling().is_some());
        let for_spread =
            |roundings: f64| bounds::round_up(roundings * f64::from(camera.condition) * bounds::U);
        let lit = packed.lit.as_ref();
        let words = packed.tables.words.len();
        Self {
            camera_anchor: numbers.anchor,
            camera_step: numbers.step,
            camera_offset: numbers.offset,
            camera_distance: numbers.distance,
            camera_gain: numbers.gain,
            camera_unit: numbers.unit,
            w_error: camera.w_error,
            length_error: for_spread(length),
            dir_error: for_spread(dir),
            value_error: for_spread(bounds::VALUE_ROUNDINGS),
            dark: packed.dark,
            bright: bounds::round_up(packed.brightest()),
            light_nearest: bounds::round_up(packed.light_nearest()),
            total_least: bounds::round_up(packed.total_least()),
            bvh_size: packed.tree_size,
            max_path: (settings.limits.max_path * two_to(-packed.scale)) as f32,
            max_rays: settings.limits.max_rays,
            lights_count: lit.map_or(0, |lit| lit.lights.len() as u32),
            lanes: 1,
            tables: packed.objects.len() as u32,
            columns: packed.tables.columns,
            third_sides: (packed.objects.len() + words) as u32,
            transparent: lit.is_some_and(|lit| lit.transparent),
        }
    }
}

/// The buffers that are not as the packed scene has them.
#[derive(Debug, Clone, Default)]
pub(super) struct Buffers {
    /// The objects of a scene without lights, and the tables behind them.
    pub(super) objects: Vec<Object>,
    /// The same of a scene with lights, and the third sides behind the tables.
    pub(super) lit_objects: Vec<LitObject>,
}

/// A scene as the lanes' functions ask for it.
pub(super) struct Scene<'a, S: Simd> {
    pub(super) simd: S,
    numbers: &'a Numbers,
    pub(super) packed: &'a Packed,
    pub(super) objects: &'a [Object],
    pub(super) lit_objects: &'a [LitObject],
    pub(super) polygons: &'a [Polygon],
    pub(super) planes: &'a [Plane],
    pub(super) spheres: &'a [Sphere],
    pub(super) sphere_points: &'a [SphereHit],
    pub(super) quadrics: &'a [Quadric],
    pub(super) tiled_planes: &'a [TiledPlane],
    pub(super) pplanes: &'a [ProceduralPlane],
    pub(super) texplanes: &'a [Texplane],
    pub(super) texels: &'a [u32],
    pub(super) bvh: &'a [BvhNode],
    pub(super) materials: &'a [Material],
    pub(super) lights: &'a [Light],
    pub(super) projectors: &'a [Projector],
    pub(super) world_planes: &'a [WorldPlane],
    pub(super) world_spheres: &'a [WorldSphere],
}

impl<S: Simd> Deref for Scene<'_, S> {
    type Target = Numbers;

    #[inline(always)]
    fn deref(&self) -> &Numbers {
        self.numbers
    }
}

impl<'a, S: Simd> Scene<'a, S> {
    pub(super) fn new(
        simd: S,
        packed: &'a Packed,
        numbers: &'a Numbers,
        buffers: &'a Buffers,
    ) -> Self {
        fn of<T>(packed: &Packed, of: impl Fn(&Lit) -> &Vec<T>) -> &[T] {
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
