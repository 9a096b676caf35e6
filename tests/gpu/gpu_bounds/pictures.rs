//! Whole pictures: which of the pixels that a shader calls certain are wrong.

use plumb::gpu::device::Gpu;
use plumb::gpu::pipeline::Pipeline;
use plumb::render::Settings;
use plumb::scene::Scene;
use plumb::shader::compose::{Entry, compose};
use plumb::shader::constants::WORKGROUP;
use plumb::shader::feature_set::FeatureSet;
use plumb::shader::pack::Packed;
use plumb::shader::records::Dispatch;
use wgpu::util::DeviceExt as _;

use super::support::with_constant;

/// Sets every bound that the host derived to zero.
pub(crate) fn without_literal_bounds(packed: &mut Packed) {
    packed.camera.w_error = 0.0;
    // The lengths', directions' and values' errors are multiples of it.
    packed.camera.condition = 0.0;
    for plane in &mut packed.planes {
        (plane.inverse_error, plane.front_error) = (0.0, 0.0);
    }
    for polygon in &mut packed.polygons {
        (polygon.inverse_error, polygon.front_error) = (0.0, 0.0);
        polygon.side_errors = [0.0; 4];
    }
    for sphere in &mut packed.spheres {
        (sphere.along_error, sphere.disc_error) = (0.0, 0.0);
    }
    for point in &mut packed.sphere_points {
        point.form_error = 0.0;
    }
    for tiled in &mut packed.tiled_planes {
        tiled.errors = [0.0; 2];
    }
    for pplane in &mut packed.pplanes {
        (pplane.index_error, pplane.from_point_error) = (0.0, 0.0);
    }
    for texplane in &mut packed.texplanes {
        texplane.errors = [0.0; 2];
    }
    for projector in packed.lit.iter_mut().flat_map(|lit| &mut lit.projectors) {
        projector.errors = [0.0; 2];
    }
    for plane in packed.lit.iter_mut().flat_map(|lit| &mut lit.planes) {
        plane.sides_error = 0.0;
    }
}

/// How certain a shader is, and how often it is wrong then.
#[derive(Debug, Default, Clone, Copy)]
pub(crate) struct Count {
    pub(crate) pixels: usize,
    pub(crate) sure: usize,
    pub(crate) wrong: usize,
}

impl std::ops::AddAssign for Count {
    fn add_assign(&mut self, other: Self) {
        self.pixels += other.pixels;
        self.sure += other.sure;
        self.wrong += other.wrong;
    }
}

/// What is wrong with a shader or its records.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Fault {
    /// Nothing.
    Right,
    /// All error bounds are zero.
    NoBounds,
    /// No object has a table of indices.
    NoTables,
    /// In the tables' entry for this row, of the first object that has any, an index is odd that is even, or the other
    /// way round.
    Entry(u32),
    /// Tables are taken for hits of all rays.
    ForAllRays,
}

/// Renders with a fault or without, and compares what is certain with `rgb`, top row first.
pub(crate) fn count(
    gpu: &Gpu,
    scene: &Scene,
    settings: &Settings,
    fault: Fault,
    rgb: &[u8],
) -> Count {
    let mut packed = Packed::new(scene, settings);
    let features = FeatureSet::new(&packed, settings, gpu.lanes);
    assert_eq!(packed.unprovable, None);
    let mut wgsl = compose(&packed, &features, Entry::Picture);
    let objects = scene.objects.len();
    match fault {
        Fault::Right => {}
        Fault::NoBounds => {
            without_literal_bounds(&mut packed);
            wgsl = with_constant(&compose(&packed, &features, Entry::Picture), "U", "0f");
        }
        Fault::NoTables => packed.tables.words[..objects].fill(0),
        Fault::Entry(row) => {
            let entry = objects + (scene.camera.pixeldim[0] + row) as usize;
            let known = packed.tables.words[entry] & 0b10_1010;
            assert_ne!(known, 0, "nothing to be wrong");
            packed.tables.words[entry] ^= known >> 1;
        }
        Fault::ForAllRays => {
            const RULE: &str = "point.direct & (first != 0u)";
            assert!(wgsl.contains(RULE), "no longer in the shader");
            wgsl = wgsl.replace(RULE, "first != 0u");
        }
    }
    let pipeline = Pipeline::new(gpu, &packed, &features, &wgsl).unwrap();
    let [width, height] = scene.camera.pixeldim;
    let pitch = width.next_multiple_of(pipeline.form.group());
    let dispatch = Dispatch {
        first: [0, height - 1],
        size: [width, height],
        ..bytemuck::Zeroable::zeroed()
    };
    let dispatch = gpu
        .device
        .create_buffer_init(&wgpu::util::BufferInitDescriptor {
            label: Some("dispatch"),
            contents: bytemuck::bytes_of(&dispatch),
            usage: wgpu::BufferUsages::UNIFORM,
        });
    let size = u64::from(pitch) * u64::from(height) * 4;
    let pixels = gpu.device.create_buffer(&wgpu::BufferDescriptor {
        label: Some("pixels"),
        size,
        usage: wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_SRC,
        mapped_at_creation: false,
    });
    let group = pipeline.bind(gpu, &dispatch, &pixels, None);
    let groups = [pitch / pipeline.form.across, height].map(|n| n.div_ceil(WORKGROUP));
    let left = gpu
        .run_once(&pipeline.pipeline, &group, groups, &pixels)
        .unwrap();
    let mut count = Count::default();
    let rows = left.chunks_exact(4 * pitch as usize);
    let found = rows.flat_map(|row| row[..4 * width as usize].chunks_exact(4));
    for (found, right) in found.zip(rgb.chunks_exact(3)) {
        count.pixels += 1;
        if found[3] == 0 {
            count.sure += 1;
            count.wrong += usize::from(found[..3] != *right);
        }
    }
    count
}
