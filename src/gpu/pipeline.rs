//! A composed shader compiled, and the packed scene in buffers bound to it.

use std::collections::{BTreeSet, VecDeque};
use std::sync::{Mutex, PoisonError};

use bytemuck::{Pod, Zeroable as _};
use wgpu::util::DeviceExt as _;

use super::GpuError;
use super::device::Gpu;
use super::features::{FeatureSet, QUAD};
use super::pack::{CameraNumbers, LitObject, Object, Packed};

/// A shader ready to run on a scene.
#[derive(Debug)]
pub struct Pipeline {
    /// The compiled shader.
    pub pipeline: wgpu::ComputePipeline,
    /// Pixels side by side that an invocation makes; rows in its buffer are whole multiples of them.
    pub across: u32,
    /// Bytes that the shader writes for a pixel.
    pub pixel_bytes: u64,
    /// Samples whose offsets the shader reads, for each pixel; 0 where it does not.
    pub offsets: u32,
    /// Words of a record that the shader leaves of a pixel with sure and doubtful samples; 0 where it leaves none.
    pub partial_words: u32,
    /// The camera, where the shader reads it from its job.
    pub camera: Option<CameraNumbers>,
    buffers: SceneBuffers,
}

/// The packed scene in buffers, by the numbers of their bindings.
#[derive(Debug)]
pub struct SceneBuffers(Vec<(u32, wgpu::Buffer)>);

impl SceneBuffers {
    /// The buffers that a shader with these features reads.
    ///
    /// # Errors
    /// If the device does not allow so large a buffer, or so many.
    pub fn new(gpu: &Gpu, packed: &Packed, features: &FeatureSet) -> Result<Self, GpuError> {
        let names = features.names();
        let buffers = upload(gpu, packed, &names)?;
        // These, the pixels, and perhaps the samples' offsets.
        let needed = buffers.len() as u32 + 1 + u32::from(names.contains("course"));
        let allowed = gpu.device.limits().max_storage_buffers_per_shader_stage;
        if needed > allowed {
            return Err(GpuError::TooManyBuffers {
                needed,
                allowed,
                adapter: gpu.name.clone(),
            });
        }
        Ok(Self(buffers))
    }
}

impl Pipeline {
    /// Compiles `wgsl`, composed for `packed` with `features`, and uploads the scene.
    pub fn new(
        gpu: &Gpu,
        packed: &Packed,
        features: &FeatureSet,
        wgsl: &str,
    ) -> Result<Self, GpuError> {
        let buffers = SceneBuffers::new(gpu, packed, features)?;
        Ok(Self::of(
            gpu.compile(wgsl, "main")?,
            buffers,
            packed,
            features,
        ))
    }

    /// The compiled shader with its scene's buffers.
    pub(crate) fn of(
        pipeline: wgpu::ComputePipeline,
        buffers: SceneBuffers,
        packed: &Packed,
        features: &FeatureSet,
    ) -> Self {
        let names = features.names();
        Self {
            pipeline,
            across: if names.contains("quad") { QUAD } else { 1 },
            pixel_bytes: if features.values { 16 } else { 4 },
            offsets: if names.contains("course") {
                features.samples
            } else {
                0
            },
            partial_words: features.partial_words(),
            camera: names.contains("moving").then_some(packed.camera.numbers),
            buffers,
        }
    }

    /// Binds the scene, a job, a buffer for its pixels, and one for the offsets of its samples if they are read.
    pub fn bind(
        &self,
        gpu: &Gpu,
        job: &wgpu::Buffer,
        pixels: &wgpu::Buffer,
        offsets: Option<&wgpu::Buffer>,
    ) -> wgpu::BindGroup {
        let own = [(0, job), (1, pixels)]
            .into_iter()
            .chain(offsets.map(|offsets| (16, offsets)));
        let scene = self
            .buffers
            .0
            .iter()
            .map(|(binding, buffer)| (*binding, buffer));
        gpu.bind(&self.pipeline, &own.chain(scene).collect::<Vec<_>>())
    }
}

/// Shaders compiled lately, by their texts.
#[derive(Debug, Default)]
pub struct Compiled {
    /// The latest at the back.
    pipelines: Mutex<VecDeque<(String, wgpu::ComputePipeline)>>,
}

/// So many shaders are kept.
const KEPT: usize = 8;

impl Compiled {
    /// The pipeline of a shader's text, compiled if it is not there.
    pub(crate) fn get(&self, gpu: &Gpu, wgsl: &str) -> Result<wgpu::ComputePipeline, GpuError> {
        let lock = || {
            self.pipelines
                .lock()
                .unwrap_or_else(PoisonError::into_inner)
        };
        let mut pipelines = lock();
        if let Some(place) = pipelines.iter().position(|(text, _)| text == wgsl)
            && let Some((text, pipeline)) = pipelines.remove(place)
        {
            pipelines.push_back((text, pipeline.clone()));
            return Ok(pipeline);
        }
        // Others may go on with theirs meanwhile.
        drop(pipelines);
        let pipeline = gpu.compile(wgsl, "main")?;
        let mut pipelines = lock();
        pipelines.push_back((wgsl.to_owned(), pipeline.clone()));
        if pipelines.len() > KEPT {
            pipelines.pop_front();
        }
        Ok(pipeline)
    }
}

/// The buffers that `shaders/bindings.wgsl` declares for these features.
fn upload(
    gpu: &Gpu,
    packed: &Packed,
    names: &BTreeSet<&str>,
) -> Result<Vec<(u32, wgpu::Buffer)>, GpuError> {
    let mut buffers = Vec::new();
    let mut add =
        |name: &str, binding: u32, what: &'static str, bytes: &[u8]| -> Result<(), GpuError> {
            if names.contains(name) {
                buffers.push((binding, buffer(gpu, what, bytes)?));
            }
            Ok(())
        };
    // The tables of indices stand behind the objects, in the field `kind`.
    let tables = packed.tables.words.iter();
    match &packed.lit {
        None => {
            let rows = tables.map(|&kind| Object {
                kind,
                ..Object::zeroed()
            });
            let objects: Vec<_> = packed.objects.iter().copied().chain(rows).collect();
            add("ambient_only", 2, "objects", bytes(&objects))?;
        }
        Some(lit) => {
            let rows = tables.map(|&kind| LitObject {
                kind,
                ..LitObject::zeroed()
            });
            let objects: Vec<_> = lit.objects.iter().copied().chain(rows).collect();
            add("lit", 2, "objects", bytes(&objects))?;
        }
    }
    add("plane_loop", 3, "planes", bytes(&packed.planes))?;
    add(
        "rectangle_loop",
        4,
        "finite planes",
        bytes(&packed.rectangles),
    )?;
    if names.contains("sphere_point") {
        add("sphere_point", 5, "spheres", &packed.sphere_records())?;
    } else {
        add("sphere_buffer", 5, "spheres", bytes(&packed.spheres))?;
    }
    if names.contains("tiles") {
        add(
            "tiles",
            6,
            "lists of spheres by tiles of the screen",
            bytes(&packed.tile_lists()),
        )?;
    }
    add("bvh", 7, "tree nodes", bytes(&packed.bvh))?;
    add("tiled", 8, "tiled planes", bytes(&packed.tiled_planes))?;
    add("pplane", 9, "procedural planes", bytes(&packed.pplanes))?;
    add("textured", 10, "texplanes", bytes(&packed.texplanes))?;
    add("textured", 11, "texels", bytes(&packed.texels))?;
    if let Some(lit) = &packed.lit {
        add("lit", 12, "materials", bytes(&lit.materials))?;
        add("lit", 13, "lights", bytes(&lit.lights))?;
        add(
            "world_planes",
            14,
            "planes for all rays",
            bytes(&lit.planes),
        )?;
        add(
            "world_spheres",
            15,
            "spheres for all rays",
            bytes(&lit.spheres),
        )?;
    }
    gpu.check()?;
    Ok(buffers)
}

fn bytes<T: Pod>(records: &[T]) -> &[u8] {
    bytemuck::cast_slice(records)
}

fn buffer(gpu: &Gpu, what: &'static str, contents: &[u8]) -> Result<wgpu::Buffer, GpuError> {
    let limits = gpu.device.limits();
    let allowed = limits
        .max_storage_buffer_binding_size
        .min(limits.max_buffer_size);
    let needed = contents.len() as u64;
    if needed > allowed {
        return Err(GpuError::TooLarge {
            what,
            needed,
            allowed,
            adapter: gpu.name.clone(),
        });
    }
    Ok(gpu
        .device
        .create_buffer_init(&wgpu::util::BufferInitDescriptor {
            label: Some(what),
            contents,
            usage: wgpu::BufferUsages::STORAGE,
        }))
}
