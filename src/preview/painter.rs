//! Draws the window on the host, where the only device is a driver that computes on the CPU.
//!
//! Such a driver takes 30 to 80 ms of all cores for a window of widgets, since it samples a texture for every pixel of
//! every background; and it would draw all of it whenever the mouse moves. Here what egui wants to be painted is taken
//! before it comes to the driver (a plugin's hook), what looks otherwise than before is found ([`tiles`]), that alone
//! is painted ([`triangles`], [`picture`]), and the driver is left with copying the frame into the window.

mod picture;
mod textures;
mod tiles;
mod triangles;

use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use eframe::egui::{Context, FullOutput, Plugin, Rect};
use eframe::egui_wgpu::{
    Callback, CallbackResources, CallbackTrait, RenderState, ScreenDescriptor, wgpu,
};
use eframe::epaint::{ClippedPrimitive, ClippedShape, PaintCallback, PaintCallbackInfo, Primitive};

use super::blit::{Blit, Drawn};
use super::draw::Draw;
use picture::Cached;
use textures::Textures;
use tiles::{Seen, Tiles};
use triangles::Triangles;

/// What lies below all that egui paints, from the lowest byte up: red, green, blue, and that it is opaque.
const GROUND: u32 = u32::from_le_bytes([8, 8, 8, 255]);

/// A part of the window in whole pixels: columns and rows from the first to before the last.
#[derive(Debug, Default, Clone, Copy, PartialEq, Eq)]
struct Part {
    from: [u32; 2],
    to: [u32; 2],
}

impl Part {
    /// What both cover.
    fn and(self, other: Self) -> Self {
        let from = [0, 1].map(|i| self.from[i].max(other.from[i]));
        let to = [0, 1].map(|i| self.to[i].min(other.to[i]).max(from[i]));
        Self { from, to }
    }

    fn is_empty(self) -> bool {
        (0..2).any(|i| self.from[i] >= self.to[i])
    }

    /// The pixels whose middle lies within, in a window of that size.
    fn of(rect: Rect, scale: f32, size: [u32; 2]) -> Self {
        let round = |at: f32, most: u32| (at * scale).round().clamp(0.0, most as f32) as u32;
        Self {
            from: [round(rect.min.x, size[0]), round(rect.min.y, size[1])],
            to: [round(rect.max.x, size[0]), round(rect.max.y, size[1])],
        }
    }

    fn whole(size: [u32; 2]) -> Self {
        Self {
            from: [0; 2],
            to: size,
        }
    }
}

/// The window's pixels, rows from the top, bytes as in [`GROUND`].
#[derive(Debug, Default)]
struct Frame {
    size: [u32; 2],
    pixels: Vec<u32>,
    /// What was painted since it was handed to the driver last.
    fresh: Vec<Part>,
}

impl Frame {
    /// A row's pixels within a part.
    fn row(&mut self, y: u32, part: Part) -> &mut [u32] {
        let first = y as usize * self.size[0] as usize;
        &mut self.pixels[first + part.from[0] as usize..first + part.to[0] as usize]
    }
}

/// A frame that the window's thread paints and hands over.
type Shared = Arc<Mutex<Frame>>;

fn lock(frame: &Shared) -> MutexGuard<'_, Frame> {
    frame.lock().unwrap_or_else(PoisonError::into_inner)
}

/// The painter, as egui has it.
#[derive(Default)]
struct HostPainter {
    textures: Textures,
    tiles: Tiles,
    picture: Cached,
    frame: Shared,
}

/// Paints the window on the host from now on.
pub(super) fn install(state: &RenderState, context: &Context) {
    state.renderer.write().callback_resources.insert(Copied {
        blit: Blit::new(&state.device, state.target_format),
        drawn: None,
    });
    context.add_plugin(HostPainter::default());
}

/// Draws a picture over this rectangle.
pub(super) fn shape(rect: Rect, draw: Draw) -> PaintCallback {
    PaintCallback {
        rect,
        callback: Arc::new(draw),
    }
}

/// Something to be painted, and within what.
enum Painted<'a> {
    Triangles(Triangles<'a>),
    /// The picture, as it is cached.
    Picture,
}

impl HostPainter {
    /// Brings the frame to what is to be seen.
    fn paint(&mut self, primitives: &[ClippedPrimitive], size: [u32; 2], scale: f32) {
        let mut frame = lock(&self.frame);
        if frame.size != size {
            frame.size = size;
            frame.pixels = vec![GROUND; size[0] as usize * size[1] as usize];
            self.tiles = Tiles::default();
        }
        let mut seen = Seen::new(size);
        let mut painted = Vec::with_capacity(primitives.len());
        for ClippedPrimitive {
            clip_rect,
            primitive,
        } in primitives
        {
            let clip = Part::of(*clip_rect, scale, size);
            if clip.is_empty() {
                continue;
            }
            match primitive {
                Primitive::Mesh(mesh) => {
                    let Some(texture) = self.textures.get(mesh.texture_id) else {
                        continue;
                    };
                    let triangles = Triangles::new(mesh, texture, clip, scale);
                    triangles.see(&mut seen);
                    painted.push((clip, Painted::Triangles(triangles)));
                }
                Primitive::Callback(PaintCallback { rect, callback }) => {
                    if let Some(draw) = callback.downcast_ref::<Draw>() {
                        let clip = clip.and(Part::of(*rect, scale, size));
                        let number = self.picture.update(draw, clip, size);
                        seen.add(clip, number);
                        painted.push((clip, Painted::Picture));
                    }
                }
            }
        }
        for part in self.tiles.differ(seen) {
            for y in part.from[1]..part.to[1] {
                frame.row(y, part).fill(GROUND);
            }
            for (clip, painted) in &painted {
                let within = clip.and(part);
                if within.is_empty() {
                    continue;
                }
                match painted {
                    Painted::Triangles(triangles) => triangles.paint(&mut frame, within),
                    Painted::Picture => self.picture.paint(&mut frame, within),
                }
            }
            frame.fresh.push(part);
        }
    }
}

impl Plugin for HostPainter {
    fn debug_name(&self) -> &'static str {
        "host painter"
    }

    fn output_hook(&mut self, context: &Context, output: &mut FullOutput) {
        let mut delta = std::mem::take(&mut output.textures_delta);
        if self.textures.update(&mut delta) {
            self.tiles = Tiles::default();
        }
        let scale = output.pixels_per_point;
        let shapes = std::mem::take(&mut output.shapes);
        let primitives = context.tessellate(shapes, scale);
        let rect = context.viewport_rect();
        let size = [rect.width(), rect.height()].map(|points| (points * scale).round() as u32);
        self.paint(&primitives, size, scale);
        let copy = Copy(Arc::clone(&self.frame));
        let shape = Callback::new_paint_callback(rect, copy);
        output.shapes = vec![ClippedShape::new(rect, shape)];
    }
}

/// What the frame is copied with; kept by egui's renderer.
struct Copied {
    blit: Blit,
    drawn: Option<Drawn>,
}

/// The frame, to be copied into the window.
struct Copy(Shared);

impl CallbackTrait for Copy {
    fn prepare(
        &self,
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        _descriptor: &ScreenDescriptor,
        _encoder: &mut wgpu::CommandEncoder,
        resources: &mut CallbackResources,
    ) -> Vec<wgpu::CommandBuffer> {
        let Some(copied) = resources.get_mut::<Copied>() else {
            return Vec::new();
        };
        let mut frame = lock(&self.0);
        let mut fresh = std::mem::take(&mut frame.fresh);
        if copied
            .drawn
            .as_ref()
            .is_none_or(|it| it.size() != frame.size)
        {
            copied.drawn = Some(copied.blit.texture(device, frame.size));
            fresh = vec![Part::whole(frame.size)];
        }
        let Some(drawn) = &copied.drawn else {
            return Vec::new();
        };
        for part in fresh {
            upload(queue, &drawn.texture, &frame, part);
        }
        Vec::new()
    }

    fn paint(
        &self,
        _info: PaintCallbackInfo,
        pass: &mut wgpu::RenderPass<'static>,
        resources: &CallbackResources,
    ) {
        if let Some(copied) = resources.get::<Copied>()
            && let Some(drawn) = &copied.drawn
        {
            copied.blit.paint(pass, drawn);
        }
    }
}

/// Hands a part of the frame to the driver.
fn upload(queue: &wgpu::Queue, texture: &wgpu::Texture, frame: &Frame, part: Part) {
    let [width, height] = [0, 1].map(|i| part.to[i] - part.from[i]);
    let pitch = 4 * frame.size[0];
    let offset = 4 * (u64::from(part.from[1]) * u64::from(frame.size[0]) + u64::from(part.from[0]));
    queue.write_texture(
        wgpu::TexelCopyTextureInfo {
            origin: wgpu::Origin3d {
                x: part.from[0],
                y: part.from[1],
                z: 0,
            },
            ..texture.as_image_copy()
        },
        bytemuck::cast_slice(&frame.pixels),
        wgpu::TexelCopyBufferLayout {
            offset,
            bytes_per_row: Some(pitch),
            rows_per_image: None,
        },
        wgpu::Extent3d {
            width,
            height,
            depth_or_array_layers: 1,
        },
    );
}

/// The pixels of the part of a window that a picture covers, as the host draws it.
#[cfg(test)]
pub(super) fn drawn(draw: &Draw, window: [u32; 2]) -> Vec<u32> {
    let [left, top, width, height] = draw.covers(window);
    let covered = Part {
        from: [left, top],
        to: [left + width, top + height],
    };
    picture::drawn(draw, covered)
}
