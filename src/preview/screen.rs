//! Draws a picture that is on the GPU into the window, byte by byte, without bringing it to the host.
//!
//! A callback of egui's: the worker's [`Canvas`] goes in as it is, and what decided each pixel or which object it shows
//! is painted over it. That is drawn into a texture once, and each frame of the window copies the texture: frames are
//! many, one for each motion of the mouse, and a driver that computes on the CPU took 20 ms for them.

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
    nothing: u32,
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
#[derive(Debug, Clone)]
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
    blit: wgpu::RenderPipeline,
    view: wgpu::Buffer,
    /// In place of buffers that are not there.
    nothing: wgpu::Buffer,
    drawn: Option<Drawn>,
}

/// A picture that was drawn into a texture as large as the window.
struct Drawn {
    /// What it shows. A canvas that is held here is not used for another picture.
    draw: Draw,
    window: [u32; 2],
    texture: wgpu::Texture,
    bound: wgpu::BindGroup,
}

/// What is drawn is bytes, whatever the window's surface is made of.
const DRAWN: wgpu::TextureFormat = wgpu::TextureFormat::Rgba8Unorm;

impl Draw {
    /// Whether it would look the same.
    fn is_as(&self, other: &Self) -> bool {
        let outlined = match (&self.outlined, &other.outlined) {
            (None, None) => true,
            (Some(a), Some(b)) => {
                Arc::ptr_eq(&a.seen, &b.seen) && Arc::ptr_eq(&a.chosen, &b.chosen)
            }
            _ => false,
        };
        outlined
            && Arc::ptr_eq(&self.canvas, &other.canvas)
            && (self.size, self.placed, self.verdicts) == (other.size, other.placed, other.verdicts)
    }

    /// The part of the window that the picture covers: left, top, width, height.
    fn covers(&self, window: [u32; 2]) -> [u32; 4] {
        let end = |i: usize| {
            let length = (f64::from(self.size[i]) * self.placed.zoom).ceil();
            (f64::from(self.placed.origin[i]) + length).clamp(0.0, f64::from(window[i])) as u32
        };
        let start = |i: usize| (self.placed.origin[i].max(0) as u32).min(end(i));
        [start(0), start(1), end(0) - start(0), end(1) - start(1)]
    }
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

/// A pipeline without vertices that draws a triangle over everything.
fn pipeline(
    device: &wgpu::Device,
    label: &'static str,
    wgsl: String,
    entry: &'static str,
    format: wgpu::TextureFormat,
) -> wgpu::RenderPipeline {
    let module = device.create_shader_module(wgpu::ShaderModuleDescriptor {
        label: Some(label),
        source: wgpu::ShaderSource::Wgsl(wgsl.into()),
    });
    device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: Some(label),
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
            entry_point: Some(entry),
            compilation_options: wgpu::PipelineCompilationOptions::default(),
            targets: &[Some(wgpu::ColorTargetState {
                format,
                blend: None,
                write_mask: wgpu::ColorWrites::ALL,
            })],
        }),
        multiview_mask: None,
        cache: None,
    })
}

/// Compiles the shaders for the window, and gives them to egui's renderer.
pub(super) fn install(state: &RenderState) {
    let device = &state.device;
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
    let entry = if state.target_format.is_srgb() {
        "linear"
    } else {
        "bytes"
    };
    let blit = String::from(include_str!("blit.wgsl"));
    state.renderer.write().callback_resources.insert(Screen {
        pipeline: pipeline(device, "screen", wgsl(), "color", DRAWN),
        blit: pipeline(device, "blit", blit, entry, state.target_format),
        view,
        nothing,
        drawn: None,
    });
}

impl Screen {
    /// Draws the picture into a texture.
    fn draw(
        &self,
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        encoder: &mut wgpu::CommandEncoder,
        draw: &Draw,
        texture: &wgpu::Texture,
    ) {
        let view = ScreenUniforms {
            origin: draw.placed.origin,
            size: draw.size,
            canvas: draw.canvas.size,
            marked: draw
                .outlined
                .as_ref()
                .map_or([0; 2], |marks| marks.seen.size),
            zoom: draw.placed.zoom as f32,
            times: draw.placed.times(),
            verdicts: u32::from(draw.verdicts),
            nothing: 0,
        };
        queue.write_buffer(&self.view, 0, bytemuck::bytes_of(&view));
        let outlined = draw.outlined.as_ref();
        let seen = outlined.map_or(&self.nothing, |outlined| &outlined.seen.objects);
        let chosen = outlined.map_or(&self.nothing, |outlined| &*outlined.chosen);
        let buffers = [&self.view, &draw.canvas.pixels, seen, chosen];
        let entries: Vec<_> = (0..)
            .zip(buffers)
            .map(|(binding, buffer)| wgpu::BindGroupEntry {
                binding,
                resource: buffer.as_entire_binding(),
            })
            .collect();
        let bound = device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("screen"),
            layout: &self.pipeline.get_bind_group_layout(0),
            entries: &entries,
        });
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("screen"),
            color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                view: &texture.create_view(&wgpu::TextureViewDescriptor::default()),
                depth_slice: None,
                resolve_target: None,
                ops: wgpu::Operations {
                    load: wgpu::LoadOp::Clear(wgpu::Color::TRANSPARENT),
                    store: wgpu::StoreOp::Store,
                },
            })],
            ..wgpu::RenderPassDescriptor::default()
        });
        let [left, top, width, height] = draw.covers([texture.width(), texture.height()]);
        pass.set_scissor_rect(left, top, width, height);
        pass.set_pipeline(&self.pipeline);
        pass.set_bind_group(0, &bound, &[]);
        pass.draw(0..3, 0..1);
    }

    /// A texture as large as the window, and how it is read.
    fn texture(&self, device: &wgpu::Device, window: [u32; 2]) -> (wgpu::Texture, wgpu::BindGroup) {
        let texture = device.create_texture(&wgpu::TextureDescriptor {
            label: Some("drawn picture"),
            size: wgpu::Extent3d {
                width: window[0],
                height: window[1],
                depth_or_array_layers: 1,
            },
            mip_level_count: 1,
            sample_count: 1,
            dimension: wgpu::TextureDimension::D2,
            format: DRAWN,
            usage: wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::TEXTURE_BINDING,
            view_formats: &[],
        });
        let view = texture.create_view(&wgpu::TextureViewDescriptor::default());
        let bound = device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("drawn picture"),
            layout: &self.blit.get_bind_group_layout(0),
            entries: &[wgpu::BindGroupEntry {
                binding: 0,
                resource: wgpu::BindingResource::TextureView(&view),
            }],
        });
        (texture, bound)
    }
}

impl CallbackTrait for Draw {
    fn prepare(
        &self,
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        descriptor: &ScreenDescriptor,
        encoder: &mut wgpu::CommandEncoder,
        resources: &mut CallbackResources,
    ) -> Vec<wgpu::CommandBuffer> {
        let Some(screen) = resources.get_mut::<Screen>() else {
            return Vec::new();
        };
        let window = descriptor.size_in_pixels;
        let (texture, bound) = match screen.drawn.take() {
            Some(drawn) if drawn.window == window => {
                if drawn.draw.is_as(self) {
                    screen.drawn = Some(drawn);
                    return Vec::new();
                }
                (drawn.texture, drawn.bound)
            }
            _ => screen.texture(device, window),
        };
        screen.draw(device, queue, encoder, self, &texture);
        screen.drawn = Some(Drawn {
            draw: self.clone(),
            window,
            texture,
            bound,
        });
        Vec::new()
    }

    fn paint(
        &self,
        _info: PaintCallbackInfo,
        pass: &mut wgpu::RenderPass<'static>,
        resources: &CallbackResources,
    ) {
        if let Some(screen) = resources.get::<Screen>()
            && let Some(drawn) = &screen.drawn
        {
            pass.set_pipeline(&screen.blit);
            pass.set_bind_group(0, &drawn.bound, &[]);
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
        let blit = naga::front::wgsl::parse_str(include_str!("blit.wgsl")).unwrap();
        validator.validate(&blit).unwrap();
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
                std::mem::offset_of!(ScreenUniforms, nothing),
            ]
        );
    }
}
