use super::*;
use crate::gpu::adapters;
use crate::gpu::device::Gpu;
use crate::preview::draw::{Outlined, Pixels};
use crate::preview::painter;
use crate::preview::viewport::Placed;

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
            std::mem::offset_of!(ScreenUniforms, nothing),
        ]
    );
}

/// Columns and rows of the window; a row's bytes are a multiple of 256, as copies want it.
const WINDOW: [u32; 2] = [64, 40];

/// What a device draws, and what the host draws, of the same. Where the picture is not, the device leaves what is
/// there: 0.
fn both(gpu: &Gpu, draw: &Draw) -> [Vec<[u8; 4]>; 2] {
    let pixels = &draw.pixels;
    let words = pixels.rgb.as_chunks::<3>().0.iter().zip(&pixels.verdicts);
    let words: Vec<_> = words.map(|(rgb, by)| Canvas::word(*rgb, *by)).collect();
    let canvas = Arc::new(Canvas::new(gpu, pixels.size).unwrap());
    let words = bytemuck::cast_slice(&words);
    gpu.queue.write_buffer(&canvas.pixels, 0, words);
    let mut screen = Screen::new(&gpu.device, blit::DRAWN);
    let size = wgpu::Extent3d {
        width: WINDOW[0],
        height: WINDOW[1],
        depth_or_array_layers: 1,
    };
    let texture = gpu.device.create_texture(&wgpu::TextureDescriptor {
        label: Some("drawn"),
        size,
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format: blit::DRAWN,
        usage: wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::COPY_SRC,
        view_formats: &[],
    });
    let staging = gpu.device.create_buffer(&wgpu::BufferDescriptor {
        label: Some("staging"),
        size: u64::from(4 * WINDOW[0] * WINDOW[1]),
        usage: wgpu::BufferUsages::MAP_READ | wgpu::BufferUsages::COPY_DST,
        mapped_at_creation: false,
    });
    let descriptor = wgpu::CommandEncoderDescriptor::default();
    let mut encoder = gpu.device.create_command_encoder(&descriptor);
    let drawn = OnDevice {
        draw: draw.clone(),
        canvas,
    };
    screen.draw(&gpu.device, &gpu.queue, &mut encoder, &drawn, &texture);
    encoder.copy_texture_to_buffer(
        texture.as_image_copy(),
        wgpu::TexelCopyBufferInfo {
            buffer: &staging,
            layout: wgpu::TexelCopyBufferLayout {
                offset: 0,
                bytes_per_row: Some(4 * WINDOW[0]),
                rows_per_image: None,
            },
        },
        size,
    );
    let index = gpu.submit(encoder);
    staging.map_async(wgpu::MapMode::Read, .., |_| ());
    gpu.wait(index).unwrap();
    let device = staging.get_mapped_range(..).unwrap().to_vec();
    let [left, top, width, height] = draw.covers(WINDOW);
    let mut host = vec![[0; 4]; (WINDOW[0] * WINDOW[1]) as usize];
    let words = painter::drawn(draw, WINDOW);
    for (i, word) in words.iter().enumerate() {
        let (x, y) = (left + i as u32 % width, top + i as u32 / width);
        host[(y * WINDOW[0] + x) as usize] = word.to_le_bytes();
    }
    assert_eq!(words.len() as u32, width * height);
    [device.as_chunks::<4>().0.to_vec(), host]
}

/// A picture in which each pixel is another one, decided by all that there are, and the objects in it.
fn picture(size: [u32; 2], drawn_as: [u32; 2], zoom: f64, origin: [i32; 2]) -> Draw {
    let mut number = 7_u32;
    let mut random = || {
        number = number.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        (number >> 24) as u8
    };
    let pixels = (size[0] * size[1]) as usize;
    Draw {
        pixels: Arc::new(Pixels {
            size,
            rgb: (0..3 * pixels).map(|_| random()).collect(),
            verdicts: (0..pixels).map(|i| DecidedBy::ALL[i % 7]).collect(),
        }),
        size: drawn_as,
        placed: Placed { origin, zoom },
        verdicts: false,
        outlined: None,
    }
}

#[test]
fn the_host_draws_what_the_shader_draws() {
    let gpu = adapters::open(None).unwrap();
    // As it is, enlarged in whole steps and others, made smaller a little and much, in lower resolution, beyond edges.
    let draws = [
        picture([30, 20], [30, 20], 1.0, [5, 7]),
        picture([30, 20], [30, 20], 3.0, [-9, -4]),
        picture([30, 20], [30, 20], 1.37, [3, 2]),
        picture([100, 60], [100, 60], 0.5, [2, 1]),
        picture([100, 60], [100, 60], 0.613, [1, 3]),
        picture([700, 500], [700, 500], 0.071, [4, 2]),
        picture([25, 15], [100, 60], 0.5, [0, 0]),
        picture([8, 5], [30, 20], 2.0, [1, -3]),
    ];
    for draw in draws {
        let objects = (0..12 * 10).map(|i: u32| i % 12 / 5 + i / 60).collect();
        let outlined = Outlined {
            seen: Arc::new(ObjectMap {
                size: [12, 10],
                objects,
            }),
            chosen: Arc::new(vec![0b10]),
        };
        for verdicts in [false, true] {
            for outlined in [None, Some(outlined.clone())] {
                let draw = Draw {
                    verdicts,
                    outlined,
                    ..draw.clone()
                };
                let [device, host] = both(&gpu, &draw);
                let is_outlined = host.contains(&[OUTLINE[0], OUTLINE[1], OUTLINE[2], 255]);
                assert_eq!(is_outlined, draw.outlined.is_some(), "{:?}", draw.placed);
                // What is not a mean is the same; means may be rounded otherwise.
                let most = u8::from(draw.placed.zoom < 1.0 || verdicts);
                for (i, (one, other)) in device.iter().zip(&host).enumerate() {
                    let far = one.iter().zip(other).any(|(a, b)| a.abs_diff(*b) > most);
                    let at = (i as u32 % WINDOW[0], i as u32 / WINDOW[0]);
                    assert!(
                        !far,
                        "{at:?}: {one:?}, {other:?}, {:?} {verdicts}",
                        draw.placed
                    );
                }
            }
        }
    }
}
