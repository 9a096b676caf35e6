//! Draws a picture that is on the GPU into the window, byte by byte, without bringing it to the host.
//!
//! A callback of egui's: the worker's [`Canvas`] goes in as it is, and what decided each pixel or which object it shows
//! is painted over it. That is drawn into a texture once, and each frame of the window copies the texture: frames are
//! many, one for each motion of the mouse, and a driver that computes on the CPU would spend most of each on the
//! picture.

use std::sync::Arc;

use bytemuck::{Pod, Zeroable};
use eframe::egui::Rect;
use eframe::egui_wgpu::{
    Callback, CallbackResources, CallbackTrait, RenderState, ScreenDescriptor, wgpu,
};
use eframe::epaint::{PaintCallback, PaintCallbackInfo};
use wgpu::util::DeviceExt as _;

use super::blit::{self, Blit, Drawn};
use super::draw::{BORDER, Draw, OUTLINE, ObjectMap, TAPS, shown_as};
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

/// What all pictures are drawn with; kept by egui's renderer.
struct Screen {
    pipeline: wgpu::RenderPipeline,
    blit: Blit,
    view: wgpu::Buffer,
    /// In place of buffers that are not there.
    nothing: wgpu::Buffer,
    /// What each pixel sees, as it was handed over last.
    seen: Option<(Arc<ObjectMap>, wgpu::Buffer)>,
    /// What was drawn last. A canvas that is held here is not used for another picture.
    last: Option<(OnDevice, Drawn)>,
}

/// A picture to be drawn where it lies.
#[derive(Clone)]
struct OnDevice {
    draw: Draw,
    canvas: Arc<Canvas>,
}

/// Draws a picture that lies on the device that draws the window, over this rectangle.
pub(super) fn shape(rect: Rect, canvas: Arc<Canvas>, draw: Draw) -> PaintCallback {
    Callback::new_paint_callback(rect, OnDevice { draw, canvas })
}

/// The shader: what is said above, and the colours of verdicts, those of `plumb render --verdicts`.
pub(super) fn wgsl() -> String {
    let mut wgsl = String::from(include_str!("screen.wgsl"));
    let [r, g, b] = OUTLINE;
    wgsl.push_str(&format!(
        "\nconst OUTLINE: vec3f = vec3f({r}.0, {g}.0, {b}.0);\nconst BORDER: i32 = {BORDER};\n\
         const TAPS: f32 = {TAPS}.0;\n\nfn verdict(by: u32, bytes: vec3f) -> vec3f {{\n    switch by {{\n"
    ));
    for by in DecidedBy::ALL {
        let (keep, [r, g, b]) = shown_as(by);
        let number = by as u8;
        wgsl.push_str(&format!(
            "        case {number}u: {{ return {keep:?} * bytes + vec3f({r:?}, {g:?}, {b:?}); }}\n"
        ));
    }
    wgsl.push_str("        default: { return vec3f(255.0, 0.0, 255.0); }\n    }\n}\n");
    wgsl
}

/// Compiles the shaders for the window, and gives them to egui's renderer.
pub(super) fn install(state: &RenderState) {
    let screen = Screen::new(&state.device, state.target_format);
    state.renderer.write().callback_resources.insert(screen);
}

/// A buffer of these words for the shader to read.
fn buffer(device: &wgpu::Device, label: &str, words: &[u32]) -> wgpu::Buffer {
    device.create_buffer_init(&wgpu::util::BufferInitDescriptor {
        label: Some(label),
        contents: bytemuck::cast_slice(words),
        usage: wgpu::BufferUsages::STORAGE,
    })
}

impl Screen {
    /// Compiles the shaders for a window whose surface has this format.
    fn new(device: &wgpu::Device, format: wgpu::TextureFormat) -> Self {
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
        Self {
            pipeline: blit::pipeline(device, "screen", wgsl(), "color", blit::DRAWN),
            blit: Blit::new(device, format),
            view,
            nothing,
            seen: None,
            last: None,
        }
    }

    /// Draws the picture into a texture.
    fn draw(
        &mut self,
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        encoder: &mut wgpu::CommandEncoder,
        OnDevice { draw, canvas }: &OnDevice,
        texture: &wgpu::Texture,
    ) {
        let view = ScreenUniforms {
            origin: draw.placed.origin,
            size: draw.size,
            canvas: canvas.size,
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
        let chosen = draw.outlined.as_ref().map(|outlined| {
            let seen = &outlined.seen;
            if !matches!(&self.seen, Some((last, _)) if Arc::ptr_eq(last, seen)) {
                let words = buffer(device, "objects seen", &seen.objects);
                self.seen = Some((Arc::clone(seen), words));
            }
            buffer(device, "chosen objects", &outlined.chosen)
        });
        let seen = self.seen.as_ref().filter(|_| chosen.is_some());
        let seen = seen.map_or(&self.nothing, |(_, words)| words);
        let chosen = chosen.as_ref().unwrap_or(&self.nothing);
        let buffers = [&self.view, &canvas.pixels, seen, chosen];
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
}

impl CallbackTrait for OnDevice {
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
        let drawn = match screen.last.take() {
            Some((last, drawn)) if drawn.size() == window => {
                if last.draw.is_as(&self.draw) {
                    screen.last = Some((last, drawn));
                    return Vec::new();
                }
                drawn
            }
            _ => screen.blit.texture(device, window),
        };
        screen.draw(device, queue, encoder, self, &drawn.texture);
        screen.last = Some((self.clone(), drawn));
        Vec::new()
    }

    fn paint(
        &self,
        _info: PaintCallbackInfo,
        pass: &mut wgpu::RenderPass<'static>,
        resources: &CallbackResources,
    ) {
        if let Some(screen) = resources.get::<Screen>()
            && let Some((_, drawn)) = &screen.last
        {
            screen.blit.paint(pass, drawn);
        }
    }
}

#[cfg(test)]
mod tests;
