//! Writing pictures as a caller sees it: whole files under good names, or nothing; and the same bytes back.

mod formats;
mod refused;
#[cfg(unix)]
mod unix;
mod whole;

use std::fs::{self, File};
use std::io;
use std::path::{Path, PathBuf};

use plumb::image::{
    Finished, Format, HASH_KEY, Metadata, Output, OutputError, Picture, Target, compare,
    difference, read, read_with_remark,
};
use plumb::render::Band;
use sha2::{Digest, Sha256};
use tempfile::TempDir;

const FORMATS: [(Format, &str); 3] = [
    (Format::Ppm, "a.ppm"),
    (Format::Png, "a.png"),
    (Format::Exr, "a.exr"),
];

/// A picture with everything an encoder may stumble over: flat, steep, noisy.
fn picture(width: u32, height: u32) -> Picture {
    let mut noise = 1u32;
    let mut rgb = Vec::new();
    for y in 0..height {
        for x in 0..width {
            noise = noise.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            rgb.extend([
                (x * 255 / width) as u8,
                if y % 8 < 4 { 255 } else { 0 },
                (noise >> 24) as u8,
            ]);
        }
    }
    Picture { width, height, rgb }
}

/// The value in the middle of those that a byte stands for.
fn value(byte: u8) -> f32 {
    (f32::from(byte) + 0.5) / 255.0
}

/// The picture in bands of these heights, over and over, from the top.
fn bands(picture: &Picture, heights: &[u32]) -> Vec<Band> {
    let row = 3 * picture.width as usize;
    let mut bands = Vec::new();
    let mut end = picture.height;
    for &height in heights.iter().cycle() {
        if end == 0 {
            break;
        }
        let start = end.saturating_sub(height);
        let from = (picture.height - end) as usize * row;
        let rgb = picture.rgb[from..from + (end - start) as usize * row].to_vec();
        let values = rgb
            .as_chunks::<3>()
            .0
            .iter()
            .map(|pixel| pixel.map(value))
            .collect();
        bands.push(Band {
            rows: start..end,
            rgb,
            values: Some(values),
            verdicts: None,
        });
        end = start;
    }
    bands
}

fn metadata() -> Metadata {
    let entries = [
        ("plumb:size", "13 x 29"),
        ("plumb:tolerance", "0"),
        ("Title", "Spiegel – 鏡"),
    ];
    Metadata {
        entries: entries
            .map(|(key, text)| (key.to_owned(), text.to_owned()))
            .to_vec(),
    }
}

fn open(path: &Path, format: Format, picture: &Picture) -> Result<Output, OutputError> {
    Output::open(
        Target::Path(path.to_owned()),
        format,
        picture.width,
        picture.height,
        metadata(),
    )
}

fn write(path: &Path, format: Format, picture: &Picture, heights: &[u32]) -> Finished {
    let mut output = open(path, format, picture).unwrap();
    for band in bands(picture, heights) {
        output.write(&band).unwrap();
    }
    output.finish().unwrap()
}

/// The file that a PPM of the picture is, written without the code under test.
fn ppm(picture: &Picture) -> Vec<u8> {
    [
        format!("P6 {} {} 255\n", picture.width, picture.height).as_bytes(),
        &picture.rgb,
    ]
    .concat()
}

fn sha256(bytes: &[u8]) -> String {
    Sha256::digest(bytes)
        .iter()
        .map(|byte| format!("{byte:02x}"))
        .collect()
}

fn folder() -> (TempDir, PathBuf) {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().canonicalize().unwrap();
    (folder, path)
}

/// The names in a folder, in order.
fn names(folder: &Path) -> Vec<String> {
    let mut names: Vec<_> = fs::read_dir(folder)
        .unwrap()
        .map(|entry| entry.unwrap().file_name().into_string().unwrap())
        .collect();
    names.sort();
    names
}
