//! The explanation of a pixel, line by line, and that of each of its samples.

use std::io::{self, Write};

use super::digits::{components, line, short, short_triple, triple};
use super::primary_ray::PrimaryRay;
use super::tree::Tree;
use super::{AskGpu, Ended, Options, Probe, Unexplained};
use crate::certify::verdict::meaning;
use crate::cpu::camera::camera_setpix;
use crate::cpu::trace::{Fault, Limits, Traced, Unobserved, ray_trace};
use crate::frame::PixelFault;
use crate::gpu::single::Single;
use crate::jitter::Sampling;
use crate::prepare::Prepared;
use crate::real::{Undecided, V3};

/// More samples than this are only counted.
const SHOWN_SAMPLES: usize = 200;

/// A pixel at hand.
struct Pixel<'p, 'a> {
    probe: &'p Probe<'a>,
    /// The scene in plain f64.
    prepared: &'p Prepared<f64>,
    options: Options,
    x: u32,
    y: u32,
}

/// Explains pixel (x, y), which is in the picture.
pub(super) fn write(
    probe: &Probe<'_>,
    name: &str,
    [x, y]: [u32; 2],
    options: Options,
    to: &mut dyn Write,
) -> Ended {
    let pixel = Pixel {
        probe,
        prepared: probe.exact_tracer.plain(),
        options,
        x,
        y,
    };
    let ended = pixel.write(name, to)?;
    Ok(ended.map_err(|fault| match fault {
        Fault::TooManyRays => PixelFault {
            x,
            y,
            max_rays: probe.limits.max_rays,
        }
        .into(),
        Fault::Undecided => Unexplained::OutOfRange { x, y },
    }))
}

impl Pixel<'_, '_> {
    fn write(&self, name: &str, to: &mut dyn Write) -> io::Result<Result<(), Fault>> {
        let Self { probe, x, y, .. } = *self;
        let settings = &probe.settings;
        let [width, height] = probe.scene.camera.pixeldim;
        let tolerance = settings.screen_tolerance;
        line(
            to,
            "scene",
            format!("{name}, {width}×{height}, screen tolerance {tolerance}"),
        )?;
        line(to, "pixel", format!("({x}, {y}) from the bottom left"))?;
        let row = probe.row(y);
        let sampling = probe.sampling(row.as_deref(), x);
        let color = match self.offsets(sampling) {
            None => self.one([0.0; 2], to)?,
            Some(offsets) => self.several(&offsets, to)?,
        };
        let color = match color {
            Ok(color) => color,
            Err(fault) => return Ok(Err(fault)),
        };
        line(to, "colour", triple(components(color)))?;
        if self.prepared.world.is_some() || settings.supersampling().is_some() {
            line(
                to,
                "times 255",
                triple(components(color).map(|c| 255.0 * c)),
            )?;
        }
        // The bytes come from the same tracer as in rendering, with all that it takes to be sure of them.
        let decided = match probe.exact_tracer.trace(&probe.limits, sampling, x, y) {
            Ok(decided) => decided,
            Err(_) => return Ok(Err(Fault::TooManyRays)),
        };
        let bytes = decided.bytes;
        let [r, g, b] = bytes;
        let doubt = match camera_setpix(color) {
            Ok(same) if same == bytes => String::new(),
            Ok([r, g, b]) => format!(" (f64 alone: {r} {g} {b})"),
            Err(Undecided) => " (f64 alone cannot tell)".to_owned(),
        };
        line(to, "bytes", format!("{r} {g} {b}{doubt}"))?;
        line(to, "decided by", meaning(decided.by).to_owned())?;
        let enclosure = probe
            .exact_tracer
            .pixel_enclosure(&probe.limits, sampling, x, y);
        line(
            to,
            "f64",
            enclosure.map_or_else(
                || "leaves open what the rays meet".to_owned(),
                |v| within(v.map(|c| 255.0 * c.value), v.map(|c| 255.0 * c.error)),
            ),
        )?;
        let ask = self.options.gpu;
        if ask == AskGpu::ValueAndVerdict {
            line(to, "GPU", probe.verdict(x, y).to_string())?;
        }
        if ask != AskGpu::Nothing
            && let Some(Single { value, error }) = probe.single(x, y)
        {
            line(
                to,
                "GPU's f32",
                within(value.map(f64::from), error.map(f64::from)),
            )?;
        }
        Ok(Ok(()))
    }

    /// The offsets of the samples, if there are several.
    fn offsets(&self, sampling: Sampling<'_>) -> Option<Vec<[f64; 2]>> {
        match sampling {
            Sampling::Once => None,
            several => Some(several.offsets(self.x, self.y).collect()),
        }
    }

    /// Shows the chosen sample, then what each brings; returns their mean.
    fn several(
        &self,
        offsets: &[[f64; 2]],
        to: &mut dyn Write,
    ) -> io::Result<Result<V3<f64>, Fault>> {
        let Options { all, sample, .. } = self.options;
        if let Some(sample) = sample
            && let Some(&offset) = offsets.get(sample as usize)
        {
            line(
                to,
                "sample",
                format!("{sample} of {}, {}", offsets.len(), place(offset)),
            )?;
            match self.one(offset, to)? {
                Ok(color) => line(to, "brings", triple(components(color)))?,
                Err(fault) => return Ok(Err(fault)),
            }
        }
        line(
            to,
            "samples",
            format!(
                "{}, spread by {}",
                offsets.len(),
                self.probe.settings.jitter.meaning()
            ),
        )?;
        let mut sum = V3::new(0.0, 0.0, 0.0);
        for (sample, offset) in offsets.iter().enumerate() {
            let traced = self.trace(*offset);
            if all || sample < SHOWN_SAMPLES || traced.is_err() {
                let brings = match &traced {
                    Ok(traced) => triple(components(traced.color)),
                    Err(Fault::TooManyRays) => {
                        format!("needs more than {} rays", self.probe.limits.max_rays)
                    }
                    Err(Fault::Undecided) => "out of f64's range".to_owned(),
                };
                writeln!(to, "  {sample:>5}  {}  {brings}", place(*offset))?;
            }
            match traced {
                Ok(traced) => sum = sum + traced.color,
                Err(fault) => return Ok(Err(fault)),
            }
        }
        if !all && offsets.len() > SHOWN_SAMPLES {
            let more = offsets.len() - SHOWN_SAMPLES;
            writeln!(to, "    … and {more} more (--all lists them)")?;
        }
        if sample.is_none() {
            writeln!(to, "    (--sample I shows the rays of sample I)")?;
        }
        let n = offsets.len() as f64;
        Ok(Ok(V3::new(sum.x / n, sum.y / n, sum.z / n)))
    }

    /// Traces the sample that is so far from the middle of the pixel.
    fn trace(&self, [a, b]: [f64; 2]) -> Result<Traced<f64>, Fault> {
        let (x, y) = (f64::from(self.x) + a, f64::from(self.y) + b);
        ray_trace(self.prepared, &self.probe.limits, x, y, &mut Unobserved)
    }

    /// Shows all about one sample, and returns its colour.
    fn one(&self, [a, b]: [f64; 2], to: &mut dyn Write) -> io::Result<Result<V3<f64>, Fault>> {
        let (x, y) = (f64::from(self.x) + a, f64::from(self.y) + b);
        let Self {
            probe, prepared, ..
        } = *self;
        let (scene, limits, all) = (probe.scene, &probe.limits, self.options.all);
        let tolerance = probe.settings.screen_tolerance;
        let primary_ray = PrimaryRay::new(scene, prepared, tolerance, [x, y]);
        primary_ray.ray(to)?;
        // The primary ray is traced once for what it hits, and once more for the tree, whose rays may be too many.
        let first = Limits {
            max_path: 0.0,
            ..*limits
        };
        let traced = match ray_trace(prepared, &first, x, y, &mut Unobserved) {
            Ok(traced) => traced,
            Err(fault) => return Ok(Err(fault)),
        };
        let objects = match primary_ray.objects(&traced, all) {
            Ok(text) => text,
            Err(undecided) => return Ok(Err(undecided.into())),
        };
        to.write_all(objects.as_bytes())?;
        primary_ray.closest(&traced, to)?;
        if prepared.world.is_none() || traced.hit.is_none() {
            return Ok(Ok(traced.color));
        }
        line(
            to,
            "rays",
            format!(
                "up to a path of {}, and at most {} of them",
                limits.max_path, limits.max_rays
            ),
        )?;
        let mut tree = Tree::new(scene, prepared, limits.max_path, all, to);
        let traced = ray_trace(prepared, limits, x, y, &mut tree);
        tree.finish()?;
        Ok(traced.map(|traced| traced.color))
    }
}

/// 255 times a colour, and its bound.
fn within(value: [f64; 3], bound: [f64; 3]) -> String {
    let bound = bound.map(|b| format!("{b:.1e}"));
    format!(
        "255 v = {}, off by at most ({})",
        short_triple(value),
        bound.join(", ")
    )
}

/// Where in its pixel a sample is.
fn place([a, b]: [f64; 2]) -> String {
    format!("at ({}, {})", short(a), short(b))
}
