//! The prepared scene rounded to f32, or f64: flat records for the GPU, and the numbers that go into the shader's text.

mod camera;
mod counts;
mod lit;
mod numbers;
mod primary;
mod projector;
mod quadric;
mod range;
mod shared;
mod surface;
mod tables;
mod trees;

pub use lit::Lit;
pub use tables::Tables;

use std::sync::Arc;

use rayon::prelude::*;

use super::bounds::{BRIGHT_GROWTH, DARKNESS, MOST_DARK, Screen, round_up};
use super::format::{Double, Format, Known, Single};
use super::kind::SurfaceKind;
use super::records::PackedCamera;
use super::records::wide::{
    BvhNode, Object, Plane, Polygon, ProceduralPlane, Quadric, Sphere, SphereAndHit, SphereHit,
    Texplane, TiledPlane,
};
use crate::prepare::plane::Sides;
use crate::prepare::screen_grid::ScreenGrid;
use crate::prepare::{self, Prepared};
use crate::real::{Bounded, V3};
use crate::scene::Scene;
use crate::settings::{SamplePattern, Settings};
use camera::camera;
use numbers::{factor, factors, nearest};
use shared::Surfaces;
use surface::{procedural_plane, texplane, tiled_plane};
use trees::{Trees, node_size};

/// The whole scene, packed.
#[derive(Debug, Clone)]
pub struct Packed<F: Format = Single> {
    /// The camera.
    pub camera: PackedCamera<F>,
    /// Lengths are in units of 2^scale.
    pub scale: i32,
    /// One for each object of the scene.
    pub objects: Vec<F::Record<Object>>,
    /// The kinds of the objects that a ray can hit.
    pub kinds: Vec<SurfaceKind>,
    /// Planes without end that a primary ray can hit.
    pub planes: Vec<F::Record<Plane>>,
    /// Rectangles and triangles that a primary ray can hit; last those triangles that are in the screen's cells.
    pub polygons: Vec<F::Record<Polygon>>,
    /// How many those are.
    pub grid_polygons: usize,
    /// The trees over the spheres and over the triangles of a lit scene, for rays from anywhere; empty without.
    pub bvh: Vec<F::Record<BvhNode>>,
    /// Depth of the deeper one.
    pub bvh_depth: usize,
    /// The root of the triangles' tree, if there is one.
    pub triangle_root: Option<usize>,
    /// Spheres that a primary ray can hit.
    pub spheres: Vec<F::Record<Sphere>>,
    /// Which of them are seen where on the screen, if they are many.
    pub screen_grid: Option<Arc<ScreenGrid>>,
    /// One for each of `spheres`, if anybody looks at hits on spheres: where it is hit.
    pub sphere_points: Vec<F::Record<SphereHit>>,
    /// Tiled planes.
    pub tiled_planes: Vec<F::Record<TiledPlane>>,
    /// Procedural planes.
    pub pplanes: Vec<F::Record<ProceduralPlane>>,
    /// Texplanes.
    pub texplanes: Vec<F::Record<Texplane>>,
    /// The texels of all textures that a texplane shows, bottom rows first.
    pub texels: Vec<u32>,
    /// What is known of the planes' indices along columns and rows.
    pub tables: Tables,
    /// What a lit scene needs beside.
    pub lit: Option<Lit<F>>,
    /// A surface farther away than where 1/|P| is this is black, whatever it is; of scenes without lights.
    pub dark: f32,
    /// The largest coordinate of the tree's boxes, all three summed.
    pub tree_size: f32,
    /// Quadrics, for all rays.
    pub quadrics: Vec<F::Record<Quadric>>,
    /// Why the error bounds cannot be relied on, if they cannot.
    pub unprovable: Option<&'static str>,
}

impl Packed {
    /// Prepares a scene and rounds it to f32.
    pub fn new(scene: &Scene, settings: &Settings) -> Self {
        Self::prepared(&Prepared::new(scene, settings.view()), scene, settings)
    }

    /// Rounds a scene to f32 that has been prepared as the settings say.
    pub fn prepared(prepared: &Prepared<Bounded>, scene: &Scene, settings: &Settings) -> Self {
        Self::rounded(prepared, scene, settings)
    }
}

impl Packed<Double> {
    /// Prepares a scene in pairs of f64, as a whole, and rounds it to f64.
    pub fn in_f64(scene: &Scene, settings: &Settings) -> Self {
        Self::rounded(&Prepared::new(scene, settings.view()), scene, settings)
    }
}

impl<F: Format> Packed<F> {
    /// Rounds a scene to a format that has been prepared as the settings say.
    pub fn rounded(prepared: &Prepared<F::Number>, scene: &Scene, settings: &Settings) -> Self {
        let lattice = match settings.supersampling().map(|several| several.spread) {
            None => 1.0,
            Some(SamplePattern::Hash) => 1.0 / 1024.0,
            Some(SamplePattern::Course) => 0.0,
        };
        let screen = Screen {
            pixels: scene.camera.pixeldim,
            margin: settings.view().margin,
            lattice,
        };
        let screen = &screen;
        let trees = Trees::<F>::new(prepared.world.as_ref());
        let surfaces = Surfaces::new(prepared);
        let mut packed = Self {
            camera: camera::<F>(&prepared.camera, screen),
            scale: prepared.camera.scale,
            objects: prepared
                .materials
                .par_iter()
                .map(|&m| F::record(object(prepared.palette[m].ambient)))
                .collect(),
            kinds: Vec::new(),
            planes: Vec::new(),
            polygons: Vec::new(),
            grid_polygons: 0,
            bvh: trees.nodes,
            bvh_depth: trees.depth,
            triangle_root: trees.triangle_root,
            spheres: Vec::new(),
            screen_grid: prepared.screen_grid.clone(),
            sphere_points: Vec::new(),
            tiled_planes: Vec::new(),
            pplanes: Vec::new(),
            texplanes: Vec::new(),
            texels: Vec::new(),
            tables: Tables::new(scene, prepared, settings),
            lit: None,
            dark: 0.0,
            tree_size: 0.0,
            quadrics: quadric::all::<F>(scene, prepared),
            unprovable: None,
        };
        packed.pack_primary(prepared, &surfaces, screen);
        let mut textures = vec![None; prepared.textures.len()];
        let mut projectors = Vec::new();
        if let Some(world) = &prepared.world {
            projectors = packed.pack_projectors(prepared, world, &mut textures);
            // Any ray can hit any object.
            for object in 0..prepared.surfaces.len() {
                packed.pack_surface(prepared, object, &mut textures, 0);
            }
        } else {
            let planes = packed.planes.iter().map(|p| F::wide(p).object);
            let objects: Vec<u32> = planes
                .chain(packed.polygons.iter().map(|r| F::wide(r).object))
                .collect();
            let curved = packed.quadrics.iter().map(|q| F::wide(q).object);
            for object in objects.into_iter().chain(curved.collect::<Vec<_>>()) {
                packed.pack_surface(prepared, object as usize, &mut textures, 0);
            }
            for record in 0..packed.spheres.len() {
                let object = F::wide(&packed.spheres[record]).object as usize;
                packed.pack_surface(prepared, object, &mut textures, record);
            }
        }
        packed.kinds.sort_unstable();
        packed.kinds.dedup();
        packed.lit = prepared
            .world
            .as_ref()
            .map(|world| Lit::new(prepared, world, &packed, &projectors));
        packed.dark = packed.darkness();
        packed.tree_size = round_up(
            packed
                .bvh
                .iter()
                .map(|node| node_size(&F::wide(node)))
                .fold(0.0, f64::max),
        );
        packed.unprovable = packed.doubtful_numbers();
        packed
    }

    /// What primary rays can hit.
    fn pack_primary(&mut self, scene: &Prepared<F::Number>, surfaces: &Surfaces, screen: &Screen) {
        for plane in &scene.planes {
            let group = surfaces.shared(plane.object);
            match &plane.sides {
                Sides::Unbounded => self.planes.push(F::record(primary::plane::<F>(
                    &scene.camera,
                    plane,
                    screen,
                    group,
                ))),
                Sides::Rectangle(strips) => {
                    let sides = primary::rectangle::<F>(&scene.camera, plane, strips, screen);
                    let base = primary::plane::<F>(&scene.camera, plane, screen, group);
                    self.polygons
                        .push(F::record(primary::polygon(base, sides, 0.0)));
                }
                Sides::Triangle(sides) => {
                    let sides = primary::triangle::<F>(&scene.camera, sides, screen);
                    let base = primary::plane::<F>(&scene.camera, plane, screen, group);
                    self.polygons
                        .push(F::record(primary::polygon(base, sides, 0.0)));
                }
            }
        }
        let max_inverse = |place: usize| {
            scene
                .screen_grid
                .as_ref()
                .map_or(0.0, |screen_grid| screen_grid.max_inverse[place].into())
        };
        self.spheres = scene
            .spheres
            .par_iter()
            .enumerate()
            .map(|(place, sphere)| {
                F::record(primary::sphere::<F>(
                    &scene.camera,
                    sphere,
                    screen,
                    max_inverse(place),
                ))
            })
            .collect();
        let grid_polygons = scene
            .triangles
            .par_iter()
            .enumerate()
            .filter_map(|(i, plane)| {
                let Sides::Triangle(sides) = &plane.sides else {
                    return None;
                };
                let sides = primary::triangle::<F>(&scene.camera, sides, screen);
                // Triangles of a cell are not in the order of the file, so that none stands for others on its plane.
                let base = primary::plane::<F>(&scene.camera, plane, screen, 0);
                let max_inverse = max_inverse(scene.spheres.len() + i);
                Some(F::record(primary::polygon(base, sides, max_inverse)))
            });
        let before = self.polygons.len();
        self.polygons.par_extend(grid_polygons);
        self.grid_polygons = self.polygons.len() - before;
        // Plain spheres without light are not looked at where they are hit.
        let psphere =
            |surface: &prepare::Surface<F::Number>| matches!(surface, prepare::Surface::Psphere(_));
        if scene.world.is_some() || scene.surfaces.iter().any(psphere) {
            self.sphere_points = scene
                .spheres
                .par_iter()
                .map(|sphere| F::record(primary::sphere_hit::<F>(&scene.camera, sphere, screen)))
                .collect();
        }
    }

    /// 1/|P| below which the byte is 0 whatever is hit: `DARKNESS`/255 over the brightest ambient reflectivity there
    /// is.
    fn darkness(&self) -> f32 {
        let brightest = |color: [f64; 3]| color.into_iter().fold(0.0, f64::max);
        let objects = self.objects.iter().map(|o| brightest(F::wide(o).ambient));
        let others = self.tiled_planes.iter();
        let others = others.map(|t| brightest(F::wide(t).altmaterial));
        let ambient = objects.chain(others).fold(0.0, f64::max);
        let most = self
            .kinds
            .iter()
            .map(|kind| kind.brightest(ambient))
            .fold(1e-30, f64::max);
        (DARKNESS / (most * BRIGHT_GROWTH * F::wide(&self.camera.numbers).gain)).min(MOST_DARK)
            as f32
    }

    /// 255 times what a ray may bring to its pixel, for a unit of 1/|P|: what `dark` is the other side of.
    pub fn brightest(&self) -> f64 {
        (DARKNESS / f64::from(self.dark)).min(f64::from(f32::MAX))
    }

    /// Packs what modulates an object's material, and notes it in the object.
    fn pack_surface(
        &mut self,
        scene: &Prepared<F::Number>,
        object: usize,
        textures: &mut [Option<u32>],
        record: usize,
    ) {
        match &scene.surfaces[object] {
            prepare::Surface::Tiled(tiled) => {
                let record = tiled_plane::<F>(scene, tiled, scene.materials[object]);
                self.tiled_planes.push(F::record(record));
                self.set_kind(object, SurfaceKind::Tiled, self.tiled_planes.len() - 1);
            }
            prepare::Surface::Pplane(pplane) => {
                self.pplanes.push(F::record(procedural_plane::<F>(pplane)));
                self.set_kind(
                    object,
                    SurfaceKind::Pplane(pplane.shader),
                    self.pplanes.len() - 1,
                );
            }
            prepare::Surface::Textured(textured) => {
                let first = self.pack_texture(scene, textured.texture, textures);
                self.texplanes
                    .push(F::record(texplane::<F>(textured, first)));
                self.set_kind(object, SurfaceKind::Textured, self.texplanes.len() - 1);
            }
            prepare::Surface::Psphere(shader) => {
                self.set_kind(object, SurfaceKind::Psphere(*shader), record);
            }
            prepare::Surface::Plain => self.set_kind(object, SurfaceKind::Plain, 0),
        }
    }

    fn set_kind(&mut self, object: usize, kind: SurfaceKind, record: usize) {
        // A plain object needs no record; the others are far fewer than 2²⁴ before any buffer is full.
        let mut object_record: Object = F::wide(&self.objects[object]);
        object_record.kind = if kind == SurfaceKind::Plain {
            0
        } else {
            kind.code() | ((record as u32) << 8)
        };
        self.objects[object] = F::record(object_record);
        if self.kinds.last() != Some(&kind) {
            self.kinds.push(kind);
        }
    }

    /// The spheres with where they are hit, for shaders that look at hits.
    pub fn sphere_records(&self) -> Vec<F::Record<SphereAndHit>> {
        let pairs = self.spheres.iter().zip(&self.sphere_points);
        let both = pairs.map(|(sphere, hit)| SphereAndHit {
            sphere: F::wide(sphere),
            hit: F::wide(hit),
        });
        both.map(F::record).collect()
    }

    /// The polygon of this place in the cells of the screen, which count spheres first.
    pub fn grid_polygon(&self, place: usize) -> &F::Record<Polygon> {
        &self.polygons[self.loose_polygons() + place - self.spheres.len()]
    }

    /// Where the list of each cell starts in what this returns, and where the last one ends; then the lists.
    pub fn cell_lists(&self) -> Vec<u32> {
        let Some(screen_grid) = &self.screen_grid else {
            return Vec::new();
        };
        let starts = screen_grid.starts.len() as u32;
        let starts = screen_grid.starts.iter().map(|start| start + starts);
        starts.chain(screen_grid.members.iter().copied()).collect()
    }
}

fn object(ambient: V3<impl Known>) -> Object {
    Object {
        ambient: factors(ambient),
        kind: 0,
    }
}

#[cfg(test)]
mod tests;
