//! The textbook's way, in f32 on the GPU: how a scene is rendered that nobody prepared with care. For the report alone.
//!
//! Two variants of one shader (`textbook.wgsl`), which show what precision costs: one whose scene the host has prepared
//! in f64, so that only the quadratic formula is the textbook's; one that gets the scene's numbers, rounded to f32, and
//! nothing else. Both ask every object for every ray, which is why they stop at [`MOST_SPHERES`].

mod records;

use std::time::Instant;

use glam::DVec2;

use super::dispatch::Runner;
use super::truth::{FirstObject, PixelHit};
use crate::gpu::GpuError;
use crate::gpu::device::Gpu;
use crate::image::Picture;
use crate::scene::{Object, Scene, Shape};
use crate::settings::Settings;
use crate::shader::literal::{literal, vector};
use crate::shader::preprocess::{Directives, preprocess};
use records::Records;

/// Spheres of a scene that these ways take on.
pub const MOST_SPHERES: usize = 1000;

const TEXTBOOK: &str = include_str!("textbook.wgsl");

/// Why there is no such picture of a scene.
#[derive(Debug, thiserror::Error)]
pub enum TextbookError {
    /// Every ray asks every object.
    #[error("the textbook's ways stop at {MOST_SPHERES} spheres, and the scene has {0}")]
    TooManySpheres(usize),
    /// It is older than the language's later entities.
    #[error("the textbook's ways have no {0}")]
    NotInTheTextbook(&'static str),
    /// The loops of some pixels came near what the driver allows.
    #[error("{0} pixels need more rounds of loops than a driver is sure to go")]
    GaveUp(u64),
    /// As any rendering on the GPU.
    #[error(transparent)]
    Gpu(#[from] GpuError),
}

/// A scene ready to be rendered the textbook's way.
pub struct Textbook<'a> {
    gpu: &'a Gpu,
    pipeline: wgpu::ComputePipeline,
    buffers: Vec<wgpu::Buffer>,
    size: [u32; 2],
    report: bool,
}

/// A picture rendered the textbook's way.
#[derive(Debug)]
pub struct Rendered {
    /// Its bytes.
    pub picture: Picture,
    /// Seconds of the dispatches.
    pub kernel: f64,
}

/// The type of an object that textbooks of that time leave out, if the scene has one.
fn later_entity(scene: &Scene) -> Option<&'static str> {
    let object = scene.objects.iter().find(|object| match object.shape {
        Shape::Triangle(_) | Shape::Quadric(_) => true,
        Shape::Plane { .. } | Shape::Sphere { .. } => false,
    });
    object.map(Object::entity)
}

impl<'a> Textbook<'a> {
    /// Composes, compiles, uploads. `prepared`: by the host in f64. `report`: for [`Textbook::hits`] instead of
    /// [`Textbook::render`].
    ///
    /// # Errors
    /// Too many spheres, or as any rendering on the GPU.
    pub fn new(
        gpu: &'a Gpu,
        scene: &Scene,
        settings: &Settings,
        prepared: bool,
        report: bool,
    ) -> Result<Self, TextbookError> {
        let spheres = scene
            .objects
            .iter()
            .filter(|object| matches!(object.shape, Shape::Sphere { .. }))
            .count();
        if spheres > MOST_SPHERES {
            return Err(TextbookError::TooManySpheres(spheres));
        }
        if let Some(entity) = later_entity(scene) {
            return Err(TextbookError::NotInTheTextbook(entity));
        }
        let records = Records::new(scene, prepared);
        let buffers = [
            buffer(gpu, "objects", bytemuck::cast_slice(&records.objects)),
            buffer(gpu, "materials", bytemuck::cast_slice(&records.materials)),
            buffer(gpu, "lights", bytemuck::cast_slice(&records.lights)),
            buffer(gpu, "texels", bytemuck::cast_slice(&records.texels)),
        ];
        let wgsl = wgsl(scene, settings, gpu.lanes, prepared, report);
        Ok(Self {
            gpu,
            pipeline: gpu.compile(&wgsl, "main")?,
            buffers: buffers.into(),
            size: scene.camera.pixeldim,
            report,
        })
    }

    fn runner(&self) -> Runner<'_> {
        let bytes = if self.report { 16 } else { 4 };
        Runner::new(
            self.gpu,
            &self.pipeline,
            bytes,
            self.size[0],
            |dispatch, pixels| {
                let entries: Vec<_> = (0..)
                    .zip([dispatch, pixels].into_iter().chain(&self.buffers))
                    .map(|(binding, buffer)| wgpu::BindGroupEntry {
                        binding,
                        resource: buffer.as_entire_binding(),
                    })
                    .collect();
                self.gpu
                    .device
                    .create_bind_group(&wgpu::BindGroupDescriptor {
                        label: Some("textbook"),
                        layout: &self.pipeline.get_bind_group_layout(0),
                        entries: &entries,
                    })
            },
        )
    }

    /// Renders the picture.
    ///
    /// # Errors
    /// If some pixel was given up, or as any rendering on the GPU.
    pub fn render(&self) -> Result<Rendered, TextbookError> {
        let [width, height] = self.size;
        let mut rgb = Vec::with_capacity(3 * width as usize * height as usize);
        let mut gave_up = 0;
        let kernel = self.runner().frame(height, |bytes| {
            for pixel in bytes.chunks_exact(4) {
                rgb.extend_from_slice(&pixel[..3]);
                gave_up += u64::from(pixel[3] != 0);
            }
        })?;
        if gave_up > 0 {
            return Err(TextbookError::GaveUp(gave_up));
        }
        let picture = Picture { width, height, rgb };
        Ok(Rendered { picture, kernel })
    }

    /// What the pixels of these rows see, row by row, from the left.
    ///
    /// # Errors
    /// As any rendering on the GPU.
    pub fn hits(&self, rows: &[u32]) -> Result<Vec<PixelHit>, TextbookError> {
        let mut seen = Vec::new();
        self.runner().picked(rows, |pixels| {
            seen.extend(pixels.iter().map(|&[t, object, ..]| {
                PixelHit {
                    object: object
                        .checked_sub(1)
                        .map_or(FirstObject::Nothing, FirstObject::Object),
                    t: f64::from(f32::from_bits(t)),
                }
            }));
        })?;
        Ok(seen)
    }
}

/// Renders a picture from the scene on: what a frame takes, and its result.
///
/// # Errors
/// As [`Textbook::new`] and [`Textbook::render`].
pub fn frame(
    gpu: &Gpu,
    scene: &Scene,
    settings: &Settings,
    prepared: bool,
) -> Result<(f64, Rendered), TextbookError> {
    let start = Instant::now();
    let rendered = Textbook::new(gpu, scene, settings, prepared, false)?.render()?;
    Ok((start.elapsed().as_secs_f64(), rendered))
}

/// The shader: see [`Textbook::new`]; `lanes` as in [`Gpu::lanes`].
#[must_use]
pub fn wgsl(
    scene: &Scene,
    settings: &Settings,
    lanes: u32,
    prepared: bool,
    report: bool,
) -> String {
    // What primary rays hit does not depend on the lights.
    let lit = !scene.lights.is_empty() && !report;
    let holds = |name: &str| match name {
        "prepared" => Some(prepared),
        "report" => Some(report),
        "lit" => Some(lit),
        _ => None,
    };
    let camera = &scene.camera;
    let view = camera.viewpoint;
    let narrow = |v: DVec2| vector(&v.as_vec2().to_array());
    let mut constants = vec![
        format!("const OBJECTS = {}u;", scene.objects.len()),
        format!("const LIGHTS = {}u;", scene.lights.len()),
        format!("const LANES = {lanes}u;"),
        format!(
            "const MAX_PATH = {};",
            literal(settings.limits.max_path as f32)
        ),
    ];
    let pixeldim = DVec2::from(camera.pixeldim.map(f64::from));
    if prepared {
        let step = |i: usize| match camera.pixeldim[i] {
            1 => (0.0, 0.5 * camera.worlddim[i] - view[i]),
            n => (camera.worlddim[i] / f64::from(n - 1), -view[i]),
        };
        let [(step_x, offset_x), (step_y, offset_y)] = [step(0), step(1)];
        constants.extend([
            format!(
                "const CAMERA_STEP = {};",
                narrow(DVec2::new(step_x, step_y))
            ),
            format!(
                "const CAMERA_OFFSET = {};",
                narrow(DVec2::new(offset_x, offset_y))
            ),
            format!("const CAMERA_Z = {};", literal(-view.z as f32)),
            format!(
                "const FRONT = {};",
                literal((settings.screen_tolerance - view.z) as f32)
            ),
        ]);
    } else {
        constants.extend([
            format!("const VIEWPOINT = {};", vector(&view.as_vec3().to_array())),
            format!("const WORLDDIM = {};", narrow(camera.worlddim)),
            format!("const PIXELDIM = {};", narrow(pixeldim)),
            format!(
                "const FRONT = {};",
                literal(settings.screen_tolerance as f32)
            ),
        ]);
    }
    let mut text = constants.join("\n") + "\n";
    let directives = Directives {
        holds: &holds,
        insert: &|_| None,
        certified: false,
    };
    if let Err(error) = preprocess(TEXTBOOK, &directives, &mut text) {
        unreachable!("textbook.wgsl: {error}");
    }
    text
}

fn buffer(gpu: &Gpu, label: &str, contents: &[u8]) -> wgpu::Buffer {
    use wgpu::util::DeviceExt as _;
    gpu.device
        .create_buffer_init(&wgpu::util::BufferInitDescriptor {
            label: Some(label),
            contents,
            usage: wgpu::BufferUsages::STORAGE,
        })
}

#[cfg(test)]
mod tests;
