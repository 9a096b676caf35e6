//! Brings a texture as large as the window into the window: what was drawn once is copied in every frame.

use eframe::egui_wgpu::wgpu;

/// What is drawn is bytes, whatever the window's surface is made of.
pub(super) const DRAWN: wgpu::TextureFormat = wgpu::TextureFormat::Rgba8Unorm;

/// How textures are copied.
pub(super) struct Blit {
    pipeline: wgpu::RenderPipeline,
}

/// A texture as large as the window.
pub(super) struct Drawn {
    pub(super) texture: wgpu::Texture,
    bound: wgpu::BindGroup,
}

impl Drawn {
    /// Columns and rows.
    pub(super) fn size(&self) -> [u32; 2] {
        [self.texture.width(), self.texture.height()]
    }
}

impl Blit {
    /// Compiles the shader for the window's surface.
    pub(super) fn new(device: &wgpu::Device, format: wgpu::TextureFormat) -> Self {
        let wgsl = String::from(include_str!("blit.wgsl"));
        let pipeline = pipeline(device, "blit", wgsl, entry(format), format);
        Self { pipeline }
    }

    /// A texture for a window of so many columns and rows.
    pub(super) fn texture(&self, device: &wgpu::Device, window: [u32; 2]) -> Drawn {
        let texture = device.create_texture(&wgpu::TextureDescriptor {
            label: Some("drawn"),
            size: wgpu::Extent3d {
                width: window[0],
                height: window[1],
                depth_or_array_layers: 1,
            },
            mip_level_count: 1,
            sample_count: 1,
            dimension: wgpu::TextureDimension::D2,
            format: DRAWN,
            // The device draws into it, or it is given what the host drew.
            usage: wgpu::TextureUsages::RENDER_ATTACHMENT
                | wgpu::TextureUsages::TEXTURE_BINDING
                | wgpu::TextureUsages::COPY_DST,
            view_formats: &[],
        });
        let view = texture.create_view(&wgpu::TextureViewDescriptor::default());
        let bound = device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("drawn"),
            layout: &self.pipeline.get_bind_group_layout(0),
            entries: &[wgpu::BindGroupEntry {
                binding: 0,
                resource: wgpu::BindingResource::TextureView(&view),
            }],
        });
        Drawn { texture, bound }
    }

    /// Copies it.
    pub(super) fn paint(&self, pass: &mut wgpu::RenderPass<'static>, drawn: &Drawn) {
        pass.set_pipeline(&self.pipeline);
        pass.set_bind_group(0, &drawn.bound, &[]);
        pass.draw(0..3, 0..1);
    }
}

/// What writes bytes into a surface of this format, so that they are shown as they are.
fn entry(format: wgpu::TextureFormat) -> &'static str {
    if format.is_srgb() { "linear" } else { "bytes" }
}

/// A pipeline without vertices that draws a triangle over everything.
pub(super) fn pipeline(
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

#[cfg(test)]
mod tests {
    #[test]
    fn the_shader_is_valid() {
        let module = naga::front::wgsl::parse_str(include_str!("blit.wgsl")).unwrap();
        let flags = naga::valid::ValidationFlags::all();
        let mut validator = naga::valid::Validator::new(flags, naga::valid::Capabilities::empty());
        validator.validate(&module).unwrap();
    }
}
