//! Draws a picture that is on the GPU into the window, byte by byte, without bringing it to the host.
//!
//! A callback of egui's: the worker's [`Canvas`] goes in as it is, and what decided each pixel or which object it shows
//! is painted over it.

use std::sync::Arc;

use bytemuck::{Pod, Zeroable};
use eframe::egui_wgpu::{CallbackResources, CallbackTrait, RenderState, ScreenDescriptor, wgpu};
use eframe::epaint::PaintCallbackInfo;
use wgpu::util::DeviceExt as _;

use super::viewport::Placed;
use crate::certify::verdict;
use crate::frame::DecidedBy;
use crate::gpu::canvas::Canvas;

/// What the shader is told; its struct `ScreenUniforms`.
#[repr(C)]
#[derive(Debug, Clone, Copy, Pod, Zeroable)]
struct ScreenUniforms {
    origin: [i32; 2],
    size: [u32; 2],
    canvas: [u32; 2],
    marked: [u32; 2],
    zoom: f32,
    times: u32,
    verdicts: u32,
    linear: u32,
}

/// What each pixel of a picture sees, on the GPU.
#[derive(Debug)]
pub(super) struct ObjectMap {
    /// Columns and rows.
    pub(super) size: [u32; 2],
    /// Numbers of objects, from 1; 0 is nothing. Rows from the top.
    pub(super) objects: wgpu::Buffer,
}

/// Objects to be outlined.
#[derive(Debug, Clone)]
pub(super) struct Outlined {
    /// What each pixel sees.
    pub(super) seen: Arc<ObjectMap>,
    /// A bit for each number of an object.
    pub(super) chosen: Arc<wgpu::Buffer>,
}

/// A picture to be drawn.
#[derive(Debug)]
pub(super) struct Draw {
    /// The picture.
    pub(super) canvas: Arc<Canvas>,
    /// As large as this.
    pub(super) size: [u32; 2],
    /// Where.
    pub(super) placed: Placed,
    /// Whether to paint what decided each pixel.
    pub(super) verdicts: bool,
    /// What to outline.
    pub(super) outlined: Option<Outlined>,
}

/// What all pictures are drawn with; kept by egui's renderer.
struct Screen {
    pipeline: wgpu::RenderPipeline,
    view: wgpu::Buffer,
    /// In place of buffers that are not there.
    nothing: wgpu::Buffer,
    linear: bool,
    bound: Option<wgpu::BindGroup>,
}

/// The shader: what is said above, and the colours of verdicts, those of `plumb render --verdicts`.
pub(super) fn wgsl() -> String {
    let mut wgsl = String::from(include_str!("screen.wgsl"));
    wgsl.push_str(
        "\n// Sure pixels step back; the others have the colour of what decided them.\n\
         fn verdict(by: u32, bytes: vec3f) -> vec3f {\n    switch by {\n",
    );
    for by in DecidedBy::ALL {
        let [r, g, b] = verdict::color(by);
        let number = by as u8;
        let line = match by {
            DecidedBy::Gpu | DecidedBy::Single => {
                format!(
                    "        case {number}u: {{ return 0.3 * bytes + 0.3 * vec3f({r}.0, {g}.0, {b}.0); }}\n"
                )
            }
            _ => format!("        case {number}u: {{ return vec3f({r}.0, {g}.0, {b}.0); }}\n"),
        };
        wgsl.push_str(&line);
    }
    wgsl.push_str("        default: { return vec3f(255.0, 0.0, 255.0); }\n    }\n}\n");
    wgsl
}

/// Compiles the shader for the window, and gives it to egui's renderer.
pub(super) fn install(state: &RenderState) {
    let device = &state.device;
    let module = device.create_shader_module(wgpu::ShaderModuleDescriptor {
        label: Some("screen"),
        source: wgpu::ShaderSource::Wgsl(wgsl().into()),
    });
    let pipeline = device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: Some("screen"),
        layout: None,
        vertex: wgpu::VertexState {
            module: &module,
            entry_point: Some("corner"),
            compilation_options: wgpu::PipelineCompilationOptions::default(),
            buffers: &[],
        },
        primitive: wgpu::PrimitiveState::default(),
        depth_stencil: None,
        multisample: wgpu::MultisampleState::default(),
        fragment: Some(wgpu::FragmentState {
            module: &module,
            entry_point: Some("color"),
            compilation_options: wgpu::PipelineCompilationOptions::default(),
            targets: &[Some(wgpu::ColorTargetState {
                format: state.target_format,
                blend: None,
                write_mask: wgpu::ColorWrites::ALL,
            })],
        }),
        multiview_mask: None,
        cache: None,
    });
    let view = device.create_buffer(&wgpu::BufferDescriptor {
        label: Some("view"),
        size: size_of::<ScreenUniforms>() as u64,
        usage: wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST,
        mapped_at_creation: false,
    });
    let nothing = device.create_buffer_init(&wgpu::util::BufferInitDescriptor {
        label: Some("nothing"),
        contents: &[0; 4],
        usage: wgpu::BufferUsages::STORAGE,
    });
    state.renderer.write().callback_resources.insert(Screen {
        pipeline,
        view,
        nothing,
        linear: state.target_format.is_srgb(),
        bound: None,
    });
}

impl CallbackTrait for Draw {
    fn prepare(
        &self,
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        _screen: &ScreenDescriptor,
        _encoder: &mut wgpu::CommandEncoder,
        resources: &mut CallbackResources,
    ) -> Vec<wgpu::CommandBuffer> {
        let Some(screen) = resources.get_mut::<Screen>() else {
            return Vec::new();
        };
        let view = ScreenUniforms {
            origin: self.placed.origin,
            size: self.size,
            canvas: self.canvas.size,
            marked: self
                .outlined
                .as_ref()
                .map_or([0; 2], |marks| marks.seen.size),
            zoom: self.placed.zoom as f32,
            times: self.placed.times(),
            verdicts: u32::from(self.verdicts),
            linear: u32::from(screen.linear),
        };
        queue.write_buffer(&screen.view, 0, bytemuck::bytes_of(&view));
        let outlined = self.outlined.as_ref();
        let seen = outlined.map_or(&screen.nothing, |outlined| &outlined.seen.objects);
        let chosen = outlined.map_or(&screen.nothing, |outlined| &*outlined.chosen);
        let buffers = [&screen.view, &self.canvas.pixels, seen, chosen];
        let entries: Vec<_> = (0..)
            .zip(buffers)
            .map(|(binding, buffer)| wgpu::BindGroupEntry {
                binding,
                resource: buffer.as_entire_binding(),
            })
            .collect();
        screen.bound = Some(device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("screen"),
            layout: &screen.pipeline.get_bind_group_layout(0),
            entries: &entries,
        }));
        Vec::new()
    }

    fn paint(
        &self,
        _info: PaintCallbackInfo,
        pass: &mut wgpu::RenderPass<'static>,
        resources: &CallbackResources,
    ) {
        if let Some(screen) = resources.get::<Screen>()
            && let Some(bound) = &screen.bound
        {
            pass.set_pipeline(&screen.pipeline);
            pass.set_bind_group(0, bound, &[]);
            pass.draw(0..3, 0..1);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_shader_is_valid_and_laid_out_as_the_host_writes_it() {
        let module = naga::front::wgsl::parse_str(&wgsl()).unwrap_or_else(|error| {
            panic!("{}", error.emit_to_string(&wgsl()));
        });
        let flags = naga::valid::ValidationFlags::all();
        let mut validator = naga::valid::Validator::new(flags, naga::valid::Capabilities::empty());
        validator.validate(&module).unwrap();
        let view = module
            .types
            .iter()
            .find(|(_, ty)| ty.name.as_deref() == Some("ScreenUniforms"));
        let Some((
            _,
            naga::Type {
                inner: naga::TypeInner::Struct { members, span },
                ..
            },
        )) = view
        else {
            panic!("no struct ScreenUniforms");
        };
        let offsets: Vec<_> = members
            .iter()
            .map(|member| member.offset as usize)
            .collect();
        assert_eq!(*span as usize, size_of::<ScreenUniforms>());
        assert_eq!(
            offsets,
            [
                std::mem::offset_of!(ScreenUniforms, origin),
                std::mem::offset_of!(ScreenUniforms, size),
                std::mem::offset_of!(ScreenUniforms, canvas),
                std::mem::offset_of!(ScreenUniforms, marked),
                std::mem::offset_of!(ScreenUniforms, zoom),
                std::mem::offset_of!(ScreenUniforms, times),
                std::mem::offset_of!(ScreenUniforms, verdicts),
                std::mem::offset_of!(ScreenUniforms, linear),
            ]
        );
    }
}
