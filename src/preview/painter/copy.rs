//! Copies the frame into the window: the driver has it in a buffer, of which a shader takes a word for each pixel. From
//! a texture, such a driver takes several times as long for that.

use std::ops::Range;

use eframe::egui_wgpu::{CallbackResources, CallbackTrait, RenderState, ScreenDescriptor, wgpu};
use eframe::epaint::PaintCallbackInfo;

use super::{Frame, Part, Shared, lock};
use crate::preview::blit;

/// What the frame is copied with; kept by egui's renderer.
pub(super) struct Copied {
    pipeline: wgpu::RenderPipeline,
    words: Option<Words>,
}

/// The frame, as the driver has it.
struct Words {
    size: [u32; 2],
    buffer: wgpu::Buffer,
    bound: wgpu::BindGroup,
}

impl Copied {
    /// Compiles the shader for the window's surface.
    pub(super) fn new(state: &RenderState) -> Self {
        let entry = blit::entry(state.target_format);
        let wgsl = String::from(include_str!("copy.wgsl"));
        Self {
            pipeline: blit::pipeline(&state.device, "copy", wgsl, entry, state.target_format),
            words: None,
        }
    }

    fn words(&self, device: &wgpu::Device, queue: &wgpu::Queue, size: [u32; 2]) -> Words {
        let buffer = |label, size, usage| {
            device.create_buffer(&wgpu::BufferDescriptor {
                label: Some(label),
                size,
                usage: usage | wgpu::BufferUsages::COPY_DST,
                mapped_at_creation: false,
            })
        };
        let pixels = u64::from(size[0]) * u64::from(size[1]);
        let columns = buffer("columns", 16, wgpu::BufferUsages::UNIFORM);
        queue.write_buffer(&columns, 0, bytemuck::bytes_of(&[size[0], size[1], 0, 0]));
        // A window of no pixels has a buffer too.
        let buffer = buffer("frame", 4 * pixels.max(1), wgpu::BufferUsages::STORAGE);
        let entries = [&columns, &buffer].map(wgpu::Buffer::as_entire_binding);
        let entries: Vec<_> = (0..)
            .zip(entries)
            .map(|(binding, resource)| wgpu::BindGroupEntry { binding, resource })
            .collect();
        let bound = device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("copy"),
            layout: &self.pipeline.get_bind_group_layout(0),
            entries: &entries,
        });
        Words {
            size,
            buffer,
            bound,
        }
    }
}

/// The frame, to be copied into the window.
pub(super) struct Copy(pub(super) Shared);

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
        let words = match copied.words.take() {
            Some(words) if words.size == frame.size => words,
            _ => {
                fresh = vec![Part::whole(frame.size)];
                copied.words(device, queue, frame.size)
            }
        };
        for rows in rows(&fresh) {
            upload(queue, &words.buffer, &frame, rows);
        }
        copied.words = Some(words);
        Vec::new()
    }

    fn paint(
        &self,
        _info: PaintCallbackInfo,
        pass: &mut wgpu::RenderPass<'static>,
        resources: &CallbackResources,
    ) {
        if let Some(copied) = resources.get::<Copied>()
            && let Some(words) = &copied.words
        {
            pass.set_pipeline(&copied.pipeline);
            pass.set_bind_group(0, &words.bound, &[]);
            pass.draw(0..3, 0..1);
        }
    }
}

/// The rows in which parts lie, each once, from the top.
fn rows(parts: &[Part]) -> Vec<Range<u32>> {
    let mut rows: Vec<_> = parts
        .iter()
        .map(|part| part.from[1]..part.to[1])
        .filter(|rows| !rows.is_empty())
        .collect();
    rows.sort_by_key(|rows| rows.start);
    let mut merged: Vec<Range<u32>> = Vec::new();
    for rows in rows {
        match merged.last_mut() {
            Some(last) if rows.start <= last.end => last.end = last.end.max(rows.end),
            _ => merged.push(rows),
        }
    }
    merged
}

/// Hands whole rows of the frame to the driver: one copy, whatever part of them is new.
fn upload(queue: &wgpu::Queue, buffer: &wgpu::Buffer, frame: &Frame, rows: Range<u32>) {
    let [first, end] = [rows.start, rows.end].map(|y| y as usize * frame.size[0] as usize);
    let words = bytemuck::cast_slice(&frame.pixels[first..end]);
    queue.write_buffer(buffer, 4 * first as u64, words);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_shader_is_valid() {
        let module = naga::front::wgsl::parse_str(include_str!("copy.wgsl")).unwrap();
        let flags = naga::valid::ValidationFlags::all();
        let mut validator = naga::valid::Validator::new(flags, naga::valid::Capabilities::empty());
        validator.validate(&module).unwrap();
    }

    #[test]
    fn rows_are_handed_over_once() {
        let part = |top: u32, bottom: u32| Part {
            from: [3, top],
            to: [9, bottom],
        };
        let parts = [
            part(32, 48),
            part(0, 16),
            part(16, 20),
            part(33, 40),
            part(50, 50),
        ];
        assert_eq!(rows(&parts), [0..20, 32..48]);
        assert!(rows(&[]).is_empty());
    }
}
