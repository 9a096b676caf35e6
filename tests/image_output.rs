//! Writing pictures as a caller sees it: whole files under good names, or nothing; and the same bytes back.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use std::fs::{self, File};
use std::io;
use std::path::{Path, PathBuf};

use plumb::image::{
    Finished, Format, HASH_KEY, Metadata, Output, OutputError, Picture, Target, compare,
    difference, read,
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

#[test]
fn a_ppm_is_the_contracts_to_the_byte() {
    let (_keep, folder) = folder();
    let path = folder.join("a.ppm");
    let picture = picture(13, 29);
    let finished = write(&path, Format::Ppm, &picture, &[29]);
    assert_eq!(fs::read(&path).unwrap(), ppm(&picture));
    assert_eq!(finished.bytes, ppm(&picture).len() as u64);
}

#[test]
fn pictures_come_back_as_they_went() {
    let (_keep, folder) = folder();
    for (width, height) in [(1, 1), (1, 50), (50, 1), (13, 29), (640, 480)] {
        let picture = picture(width, height);
        for (format, name) in FORMATS {
            let path = folder.join(name);
            let finished = write(&path, format, &picture, &[7]);
            let back = read(&path).unwrap();
            let differs = compare(&picture, &back).unwrap();
            assert!(differs.is_same(), "{format} {differs:?}");
            assert_eq!(finished.bytes, fs::metadata(&path).unwrap().len());
        }
    }
    assert_eq!(names(&folder), ["a.exr", "a.png", "a.ppm"]);
}

#[test]
fn the_bands_heights_leave_no_trace() {
    let (_keep, folder) = folder();
    let picture = picture(300, 211);
    for (format, name) in FORMATS {
        let path = folder.join(name);
        let all = write(&path, format, &picture, &[211]);
        let bytes = fs::read(&path).unwrap();
        for heights in [[1, 1, 1], [64, 64, 64], [3, 100, 1], [200, 7, 9]] {
            assert_eq!(write(&path, format, &picture, &heights), all);
            assert!(
                fs::read(&path).unwrap() == bytes,
                "{format} in bands of {heights:?} is another file"
            );
        }
    }
}

#[test]
fn the_hash_is_that_of_the_ppm_in_every_format() {
    let (_keep, folder) = folder();
    let picture = picture(31, 17);
    for (format, name) in FORMATS {
        assert_eq!(
            write(&folder.join(name), format, &picture, &[5]).sha256,
            sha256(&ppm(&picture))
        );
    }
}

#[test]
fn a_png_tells_its_metadata_and_its_hash() {
    let (_keep, folder) = folder();
    let path = folder.join("a.png");
    let picture = picture(13, 29);
    write(&path, Format::Png, &picture, &[5]);
    let mut reader = png::Decoder::new(io::BufReader::new(File::open(&path).unwrap()))
        .read_info()
        .unwrap();
    let mut pixels = vec![0; reader.output_buffer_size().unwrap()];
    reader.next_frame(&mut pixels).unwrap();
    assert_eq!(pixels, picture.rgb);
    reader.finish().unwrap();
    let info = reader.info();
    assert_eq!(
        (info.color_type, info.bit_depth),
        (png::ColorType::Rgb, png::BitDepth::Eight)
    );
    let plain: Vec<_> = info
        .uncompressed_latin1_text
        .iter()
        .map(|text| (text.keyword.as_str(), text.text.as_str()))
        .collect();
    let hash = sha256(&ppm(&picture));
    assert_eq!(
        plain,
        [
            ("plumb:size", "13 x 29"),
            ("plumb:tolerance", "0"),
            (HASH_KEY, hash.as_str())
        ]
    );
    assert_eq!(info.utf8_text[0].keyword, "Title");
    assert_eq!(info.utf8_text[0].get_text().unwrap(), "Spiegel – 鏡");
    assert_eq!(
        image::open(&path).unwrap().into_rgb8().into_raw(),
        picture.rgb
    );
}

#[test]
fn an_exr_holds_the_values_as_they_were_its_metadata_and_the_hash() {
    use exr::prelude::*;
    let (_keep, folder) = folder();
    let path = folder.join("a.exr");
    let mut band = bands(&picture(7, 3), &[3]).remove(0);
    // Values that no byte can hold go through untouched.
    band.values.as_mut().unwrap()[5] = [-1.5, 1e-40, 1e30];
    let mut output =
        Output::open(Target::Path(path.clone()), Format::Exr, 7, 3, metadata()).unwrap();
    output.write(&band).unwrap();
    let finished = output.finish().unwrap();
    let image = read_first_flat_layer_from_file(&path).unwrap();
    let attributes = &image.layer_data.attributes.other;
    let text = |key: &str| match attributes.get(&Text::from(key)) {
        Some(AttributeValue::Text(text)) => String::from_utf8(text.bytes().to_vec()).unwrap(),
        other => panic!("{key} is {other:?}"),
    };
    assert_eq!(text("plumb:size"), "13 x 29");
    assert_eq!(text("plumb:tolerance"), "0");
    assert_eq!(text("Title"), "Spiegel – 鏡");
    assert_eq!(text(HASH_KEY), finished.sha256);
    for (channel, name) in ["R", "G", "B"].into_iter().enumerate() {
        let found = image
            .layer_data
            .channel_data
            .list
            .iter()
            .find(|found| found.name.eq(name))
            .unwrap();
        let FlatSamples::F32(samples) = &found.sample_data else {
            panic!("{name} is no f32")
        };
        let expected: Vec<_> = band
            .values
            .as_ref()
            .unwrap()
            .iter()
            .map(|value| value[channel])
            .collect();
        assert_eq!(samples, &expected);
    }
}

#[test]
fn the_old_file_is_there_until_the_new_one_is_whole() {
    let (_keep, folder) = folder();
    let path = folder.join("a.ppm");
    fs::write(&path, "old").unwrap();
    let picture = picture(40, 30);
    let mut output = open(&path, Format::Ppm, &picture).unwrap();
    for band in bands(&picture, &[10]) {
        output.write(&band).unwrap();
        assert_eq!(fs::read(&path).unwrap(), b"old");
        assert_eq!(names(&folder).len(), 2);
    }
    output.finish().unwrap();
    assert_eq!(fs::read(&path).unwrap(), ppm(&picture));
    assert_eq!(names(&folder), ["a.ppm"]);
}

#[test]
fn nothing_remains_of_a_picture_that_was_given_up() {
    let (_keep, folder) = folder();
    let picture = picture(40, 30);
    for (format, name) in FORMATS {
        let path = folder.join(name);
        for old in [false, true] {
            if old {
                fs::write(&path, "old").unwrap();
            }
            let before = names(&folder);
            let mut output = open(&path, format, &picture).unwrap();
            output.write(&bands(&picture, &[10])[0]).unwrap();
            drop(output);
            assert_eq!(names(&folder), before);
            if old {
                assert_eq!(fs::read(&path).unwrap(), b"old");
            }
        }
    }
}

#[test]
fn half_a_picture_gets_no_name() {
    let (_keep, folder) = folder();
    let picture = picture(40, 30);
    for (format, name) in FORMATS {
        let mut output = open(&folder.join(name), format, &picture).unwrap();
        for band in &bands(&picture, &[10])[..2] {
            output.write(band).unwrap();
        }
        let error = output.finish().unwrap_err();
        assert!(
            matches!(
                error,
                OutputError::Unfinished {
                    written: 20,
                    rows: 30,
                    ..
                }
            ),
            "{error}"
        );
        assert!(error.to_string().contains("20 of 30 rows"), "{error}");
        assert!(names(&folder).is_empty());
    }
}

#[test]
fn bands_that_do_not_fit_are_refused_for_good() {
    let (_keep, folder) = folder();
    let picture = picture(4, 30);
    let whole = bands(&picture, &[10]);
    let mut misfits = vec![whole[2].clone(); 6];
    misfits[1].rows = 0..11;
    misfits[2].rgb.pop();
    misfits[3].values = None;
    misfits[4].values.as_mut().unwrap().pop();
    misfits[5] = whole[1].clone();
    // The first misses nothing but its predecessor.
    misfits[0].rows = 1..11;
    for (index, misfit) in misfits.iter().enumerate() {
        let mut output = open(&folder.join("a.exr"), Format::Exr, &picture).unwrap();
        output.write(&whole[0]).unwrap();
        output.write(&whole[1]).unwrap();
        let error = output.write(misfit).unwrap_err();
        assert_eq!(
            error.kind(),
            io::ErrorKind::InvalidInput,
            "{index}: {error}"
        );
        assert!(output.write(&whole[2]).is_err(), "{index}");
        assert!(output.finish().is_err(), "{index}");
        assert!(names(&folder).is_empty());
    }
    let mut output = open(&folder.join("a.ppm"), Format::Ppm, &picture).unwrap();
    for band in &whole {
        output.write(band).unwrap();
    }
    assert!(
        output
            .write(&whole[2])
            .unwrap_err()
            .to_string()
            .contains("more than were announced")
    );
    assert!(output.finish().is_err());
    assert!(names(&folder).is_empty());
}

/// Bands are handed on from the thread that renders.
#[test]
fn an_output_can_be_sent_to_another_thread() {
    fn send<T: Send>() {}
    send::<Output>();
}

#[test]
fn a_part_of_a_picture_is_a_picture() {
    let (_keep, folder) = folder();
    let path = folder.join("a.ppm");
    let mut output = Output::open(
        Target::Path(path.clone()),
        Format::Ppm,
        1,
        2,
        Metadata::default(),
    )
    .unwrap();
    output
        .write(&Band {
            rows: 101..102,
            rgb: vec![1, 2, 3],
            values: None,
            verdicts: None,
        })
        .unwrap();
    output
        .write(&Band {
            rows: 100..101,
            rgb: vec![4, 5, 6],
            values: None,
            verdicts: None,
        })
        .unwrap();
    output.finish().unwrap();
    assert_eq!(
        fs::read(&path).unwrap(),
        b"P6 1 2 255\n\x01\x02\x03\x04\x05\x06"
    );
}

#[test]
fn what_cannot_be_opened_is_told_before_rendering() {
    let (_keep, folder) = folder();
    let small = picture(2, 2);
    let refused = |path: &Path| open(path, Format::Ppm, &small).err().unwrap().to_string();
    assert!(refused(&folder).contains("the name of a folder"));
    assert!(refused(&folder.join("new/")).contains("the name of a folder"));
    assert!(refused(&folder.join("none/a.ppm")).contains("does not exist"));
    fs::write(folder.join("file"), "").unwrap();
    assert!(refused(&folder.join("file/a.ppm")).contains("cannot write"));
    // Not even root can create a file here.
    #[cfg(target_os = "linux")]
    assert!(refused(Path::new("/proc/a.ppm")).contains("creating a file in /proc failed"));
    assert_eq!(names(&folder), ["file"]);
}

#[cfg(unix)]
#[test]
fn protected_files_and_folders_are_respected() {
    use std::os::unix::fs::PermissionsExt;
    let (_keep, folder) = folder();
    let small = picture(2, 2);
    let path = folder.join("a.ppm");
    fs::write(&path, "old").unwrap();
    fs::set_permissions(&path, fs::Permissions::from_mode(0o444)).unwrap();
    // Root may write it all the same; then so may we.
    let may = File::options().write(true).open(&path).is_ok();
    assert_eq!(open(&path, Format::Ppm, &small).is_ok(), may);
    fs::set_permissions(&folder, fs::Permissions::from_mode(0o555)).unwrap();
    let may = File::create(folder.join("b")).is_ok();
    assert_eq!(
        open(&folder.join("c.ppm"), Format::Ppm, &small).is_ok(),
        may
    );
    fs::set_permissions(&folder, fs::Permissions::from_mode(0o755)).unwrap();
}

#[test]
fn sizes_that_a_format_cannot_hold_are_refused_before_rendering() {
    let (_keep, folder) = folder();
    let open = |format, width, rows| {
        Output::open(
            Target::Path(folder.join("a")),
            format,
            width,
            rows,
            Metadata::default(),
        )
        .map(drop)
    };
    for (format, width, rows) in [
        (Format::Exr, 10_001, 10_000),
        (Format::Exr, 1_000_000, 1_000_000),
        (Format::Png, u32::MAX, 1),
        (Format::Ppm, 0, 1),
        (Format::Ppm, 1, 0),
    ] {
        let error = open(format, width, rows).unwrap_err();
        assert!(matches!(error, OutputError::Size { .. }), "{error}");
        assert!(
            error.to_string().contains(&format!("{width} × {rows}")),
            "{error}"
        );
    }
    assert!(
        open(Format::Exr, 10_001, 10_000)
            .unwrap_err()
            .to_string()
            .contains("100 million pixels")
    );
}

#[test]
fn the_largest_png_is_begun_in_little_memory() {
    let (_keep, folder) = folder();
    let path = folder.join("a.png");
    let large = 1_000_000;
    let mut output = Output::open(
        Target::Path(path),
        Format::Png,
        large,
        large,
        Metadata::default(),
    )
    .unwrap();
    for row in (large - 2..large).rev() {
        let band = Band {
            rows: row..row + 1,
            rgb: vec![row as u8; 3 * large as usize],
            values: None,
            verdicts: None,
        };
        output.write(&band).unwrap();
    }
    assert!(output.finish().is_err());
    assert!(names(&folder).is_empty());
}

#[test]
fn metadata_that_a_format_cannot_tell_is_refused_in_all() {
    let (_keep, folder) = folder();
    let long = "k".repeat(80);
    for key in [
        "", &long, "ä", "a\nb", " a", "a ", "a  b", HASH_KEY, "channels",
    ] {
        let metadata = Metadata {
            entries: vec![(key.to_owned(), String::new())],
        };
        for (format, name) in FORMATS {
            let opened = Output::open(
                Target::Path(folder.join(name)),
                format,
                1,
                1,
                metadata.clone(),
            );
            assert!(
                matches!(opened, Err(OutputError::Metadata { .. })),
                "{key:?}"
            );
        }
    }
    let twice = Metadata {
        entries: vec![("a".into(), "1".into()), ("a".into(), "2".into())],
    };
    assert!(Output::open(Target::Path(folder.join("a.ppm")), Format::Ppm, 1, 1, twice).is_err());
    let nul = Metadata {
        entries: vec![("a".into(), "b\0c".into())],
    };
    assert!(Output::open(Target::Path(folder.join("a.ppm")), Format::Ppm, 1, 1, nul).is_err());
}

#[test]
fn the_difference_picture_can_be_written() {
    let (_keep, folder) = folder();
    let path = folder.join("a.png");
    let a = picture(9, 5);
    let mut b = a.clone();
    b.rgb[30] ^= 1;
    let seen = difference(&a, &b).unwrap();
    let mut output = open(&path, Format::Png, &seen).unwrap();
    output.write(&seen.clone().into_band()).unwrap();
    output.finish().unwrap();
    assert_eq!(read(&path).unwrap(), seen);
    assert_eq!(seen.rgb[30], 128);
}

#[test]
fn damaged_and_foreign_files_are_refused() {
    let (_keep, folder) = folder();
    let path = folder.join("a");
    let picture = picture(40, 30);
    let refused = |told: &str| {
        let message = read(&path).unwrap_err().to_string();
        assert!(message.contains(told), "{message:?} does not tell {told:?}");
    };
    refused("cannot read");
    for bytes in [
        b"".as_slice(),
        b"P5 1 1 255\n0",
        b"GIF89a",
        b"P3 1 1 255\n1 2 3",
    ] {
        fs::write(&path, bytes).unwrap();
        refused("neither a binary PPM nor a PNG nor an EXR");
    }
    let whole = ppm(&picture);
    for cut in [whole.len() - 1, whole.len() / 2, 13] {
        fs::write(&path, &whole[..cut]).unwrap();
        refused("follow");
    }
    fs::write(&path, &whole[..8]).unwrap();
    refused("ends too early");
    fs::write(&path, [&whole[..], b"\n"].concat()).unwrap();
    refused("but more follow");
    for (format, _) in &FORMATS[1..] {
        write(&path, *format, &picture, &[30]);
        let whole = fs::read(&path).unwrap();
        for cut in [6, 30, whole.len() / 2] {
            fs::write(&path, &whole[..cut]).unwrap();
            refused("cannot read");
        }
        let mut hit = whole.clone();
        let middle = hit.len() / 2;
        hit[middle..middle + 8].fill(0x55);
        fs::write(&path, hit).unwrap();
        assert!(read(&path).is_err() || *format == Format::Exr);
    }
    assert!(
        read(&folder)
            .unwrap_err()
            .to_string()
            .contains("cannot read")
    );
}

/// The picture's own size may be small: a reader that looks only there takes hundreds of gigabytes.
#[test]
fn an_exr_whose_layer_claims_too_much_is_refused() {
    let (_keep, folder) = folder();
    let path = folder.join("a.exr");
    write(&path, Format::Exr, &picture(40, 30), &[30]);
    let mut bytes = fs::read(&path).unwrap();
    let name = b"dataWindow\0box2i\0";
    let at = bytes
        .windows(name.len())
        .position(|found| found == name)
        .unwrap();
    // Behind the name: the length, then the box's left, top, right, bottom, 4 bytes each.
    let right = at + name.len() + 4 + 8;
    bytes[right..right + 4].copy_from_slice(&1_000_000_000i32.to_le_bytes());
    fs::write(&path, bytes).unwrap();
    let message = read(&path).unwrap_err().to_string();
    assert!(
        message.contains("1000000001 × 30 pixels cannot come out of"),
        "{message}"
    );
}

#[test]
fn pngs_that_cannot_be_compared_are_refused() {
    let (_keep, folder) = folder();
    let path = folder.join("a.png");
    let png = |width, height, color, depth| {
        let mut encoder = png::Encoder::new(File::create(&path).unwrap(), width, height);
        encoder.set_color(color);
        encoder.set_depth(depth);
        encoder.write_header().unwrap()
    };
    let refused = |told: &str| {
        let message = read(&path).unwrap_err().to_string();
        assert!(message.contains(told), "{message:?} does not tell {told:?}");
    };
    use png::{BitDepth, ColorType};
    // Headers without a picture: the claimed sizes must not be believed.
    png(30_000, 30_000, ColorType::Rgb, BitDepth::Eight)
        .write_chunk(png::chunk::IDAT, b"")
        .unwrap();
    refused("cannot come out of");
    png(1_000_000, 1_000_000, ColorType::Grayscale, BitDepth::One)
        .write_chunk(png::chunk::IDAT, b"")
        .unwrap();
    refused("too many");
    png(1, 1, ColorType::Rgb, BitDepth::Sixteen)
        .write_image_data(&[0; 6])
        .unwrap();
    refused("16 bits");
    png(1, 1, ColorType::Rgba, BitDepth::Eight)
        .write_image_data(&[1, 2, 3, 254])
        .unwrap();
    refused("transparent");
    png(1, 1, ColorType::Rgba, BitDepth::Eight)
        .write_image_data(&[1, 2, 3, 255])
        .unwrap();
    assert_eq!(read(&path).unwrap().rgb, [1, 2, 3]);
    png(2, 1, ColorType::Grayscale, BitDepth::One)
        .write_image_data(&[0x40])
        .unwrap();
    assert_eq!(read(&path).unwrap().rgb, [0, 0, 0, 255, 255, 255]);
}

#[cfg(unix)]
mod unix {
    use std::os::unix::fs::{FileTypeExt, MetadataExt, PermissionsExt, symlink};
    use std::process::Command;
    use std::thread;

    use super::*;

    #[test]
    fn a_new_file_gets_the_mode_of_any_new_file() {
        let (_keep, folder) = folder();
        let path = folder.join("a.ppm");
        File::create(folder.join("any")).unwrap();
        write(&path, Format::Ppm, &picture(3, 3), &[1]);
        assert_eq!(
            fs::metadata(path).unwrap().mode(),
            fs::metadata(folder.join("any")).unwrap().mode()
        );
    }

    #[test]
    fn an_old_files_mode_is_kept() {
        let (_keep, folder) = folder();
        let path = folder.join("a.ppm");
        for mode in [0o600, 0o640, 0o777] {
            fs::write(&path, "old").unwrap();
            fs::set_permissions(&path, fs::Permissions::from_mode(mode)).unwrap();
            write(&path, Format::Ppm, &picture(3, 3), &[1]);
            assert_eq!(fs::metadata(&path).unwrap().mode() & 0o7777, mode);
        }
    }

    #[test]
    fn a_link_stays_a_link() {
        let (_keep, folder) = folder();
        let picture = picture(3, 3);
        fs::create_dir(folder.join("sub")).unwrap();
        symlink("sub/b", folder.join("a.ppm")).unwrap();
        symlink("../c", folder.join("sub/b")).unwrap();
        // Once as a chain that leads nowhere yet, once to the file that this has made.
        for _ in 0..2 {
            write(&folder.join("a.ppm"), Format::Ppm, &picture, &[1]);
            assert_eq!(names(&folder), ["a.ppm", "c", "sub"]);
            assert_eq!(names(&folder.join("sub")), ["b"]);
            assert!(
                fs::symlink_metadata(folder.join("a.ppm"))
                    .unwrap()
                    .is_symlink()
            );
            assert!(
                fs::symlink_metadata(folder.join("sub/b"))
                    .unwrap()
                    .is_symlink()
            );
            assert!(fs::symlink_metadata(folder.join("c")).unwrap().is_file());
            assert_eq!(fs::read(folder.join("c")).unwrap(), ppm(&picture));
        }
    }

    #[test]
    fn devices_are_written_through() {
        let (_keep, folder) = folder();
        symlink("/dev/null", folder.join("a.ppm")).unwrap();
        for path in [Path::new("/dev/null"), &folder.join("a.ppm")] {
            for (format, _) in FORMATS {
                assert!(write(path, format, &picture(3, 3), &[1]).bytes > 30);
            }
        }
        assert!(
            fs::metadata("/dev/null")
                .unwrap()
                .file_type()
                .is_char_device()
        );
        assert!(
            fs::symlink_metadata(folder.join("a.ppm"))
                .unwrap()
                .is_symlink()
        );
        assert_eq!(names(&folder), ["a.ppm"]);
    }

    #[test]
    fn hard_links_stay_together() {
        let (_keep, folder) = folder();
        let (path, other) = (folder.join("a.ppm"), folder.join("b.ppm"));
        fs::write(&path, vec![b'o'; 1000]).unwrap();
        fs::hard_link(&path, &other).unwrap();
        let inode = fs::metadata(&path).unwrap().ino();
        // Shorter than what is there, then longer.
        for (width, height) in [(3, 3), (50, 50)] {
            let picture = picture(width, height);
            let before = fs::read(&other).unwrap();
            let mut output = open(&path, Format::Ppm, &picture).unwrap();
            for band in bands(&picture, &[10]) {
                output.write(&band).unwrap();
            }
            assert_eq!(fs::read(&other).unwrap(), before);
            output.finish().unwrap();
            assert_eq!(fs::read(&path).unwrap(), ppm(&picture));
            assert_eq!(fs::read(&other).unwrap(), ppm(&picture));
            assert_eq!(fs::metadata(&path).unwrap().ino(), inode);
            assert_eq!(names(&folder), ["a.ppm", "b.ppm"]);
        }
    }

    fn fifo(folder: &Path) -> PathBuf {
        let path = folder.join("pipe");
        assert!(
            Command::new("mkfifo")
                .arg(&path)
                .status()
                .unwrap()
                .success()
        );
        path
    }

    #[test]
    fn a_named_pipe_gets_every_byte_and_stays_one() {
        let (_keep, folder) = folder();
        let path = fifo(&folder);
        let picture = picture(640, 480);
        for (format, _) in FORMATS {
            let from = path.clone();
            let reader = thread::spawn(move || fs::read(from).unwrap());
            let finished = write(&path, format, &picture, &[100]);
            let bytes = reader.join().unwrap();
            assert_eq!(bytes.len() as u64, finished.bytes);
            let copy = folder.join("copy");
            fs::write(&copy, bytes).unwrap();
            assert_eq!(read(&copy).unwrap(), picture);
            fs::remove_file(copy).unwrap();
        }
        assert!(fs::metadata(&path).unwrap().file_type().is_fifo());
        assert_eq!(names(&folder), ["pipe"]);
    }

    #[test]
    fn a_picture_is_read_from_a_named_pipe() {
        let (_keep, folder) = folder();
        let path = fifo(&folder);
        let picture = picture(64, 48);
        for (bytes, whole) in [
            (ppm(&picture), true),
            (ppm(&picture)[..5000].to_vec(), false),
        ] {
            let to = path.clone();
            let writer = thread::spawn(move || fs::write(to, bytes).unwrap());
            assert_eq!(read(&path).ok(), whole.then(|| picture.clone()));
            writer.join().unwrap();
        }
    }

    #[test]
    fn a_reader_that_goes_away_is_a_broken_pipe() {
        let (_keep, folder) = folder();
        let path = fifo(&folder);
        let from = path.clone();
        let reader = thread::spawn(move || drop(File::open(from).unwrap()));
        // Larger than any buffer on the way.
        let picture = picture(800, 800);
        let mut output = open(&path, Format::Ppm, &picture).unwrap();
        reader.join().unwrap();
        let band = bands(&picture, &[800]).remove(0);
        assert_eq!(
            output.write(&band).unwrap_err().kind(),
            io::ErrorKind::BrokenPipe
        );
        // Else the next reader would meet this writer.
        drop(output);
        // A small one is noticed at the end.
        let from = path.clone();
        let reader = thread::spawn(move || drop(File::open(from).unwrap()));
        let picture = super::picture(2, 2);
        let mut output = open(&path, Format::Ppm, &picture).unwrap();
        reader.join().unwrap();
        output.write(&bands(&picture, &[2])[0]).unwrap();
        assert!(output.finish().unwrap_err().is_broken_pipe());
    }

    #[cfg(target_os = "linux")]
    #[test]
    fn a_full_device_is_told() {
        for (format, _) in FORMATS {
            let picture = picture(40, 30);
            let mut output = open(Path::new("/dev/full"), format, &picture).unwrap();
            output.write(&bands(&picture, &[30])[0]).unwrap();
            let error = output.finish().unwrap_err();
            assert!(
                matches!(&error, OutputError::Write { source, .. } if source.kind() == io::ErrorKind::StorageFull),
                "{error}"
            );
            assert!(
                error.to_string().starts_with("writing /dev/full failed"),
                "{error}"
            );
        }
    }

    /// Runs [`child`] in a process of its own, started by `sh` after `before`; its exit status and its stdout.
    fn run_child(task: &str, folder: &Path, before: &str) -> (Option<i32>, Vec<u8>) {
        let script = format!("{before} exec \"$0\" --exact unix::child --ignored --nocapture");
        let output = Command::new("sh")
            .args(["-c", &script])
            .arg(std::env::current_exe().unwrap())
            .env("PLUMB_TEST_TASK", task)
            .env("PLUMB_TEST_FOLDER", folder)
            .output()
            .unwrap();
        (output.status.code(), output.stdout)
    }

    #[test]
    #[ignore = "a part of other tests, which run it in a process of its own"]
    fn child() {
        let folder = PathBuf::from(std::env::var_os("PLUMB_TEST_FOLDER").unwrap());
        let path = folder.join("a.ppm");
        let picture = picture(600, 400);
        match std::env::var("PLUMB_TEST_TASK").unwrap().as_str() {
            "interrupted" => {
                // Two on their way, of which one would be finished just now.
                let mut output = open(&path, Format::Ppm, &picture).unwrap();
                let other = open(&folder.join("b.png"), Format::Png, &picture).unwrap();
                output.write(&bands(&picture, &[400])[0]).unwrap();
                assert_eq!(names(&folder).len(), 2);
                plumb::image::remove_unfinished();
                plumb::image::remove_unfinished();
                assert!(names(&folder).is_empty());
                thread::spawn(move || (output.finish(), drop(other)));
                thread::sleep(std::time::Duration::from_millis(100));
                std::process::exit(130);
            }
            "out of space" => {
                let mut failed = 0;
                for (format, name) in FORMATS {
                    let mut output = open(&folder.join(name), format, &picture).unwrap();
                    let wrote = bands(&picture, &[50])
                        .iter()
                        .try_for_each(|band| output.write(band));
                    failed += i32::from(wrote.is_err() | output.finish().is_err());
                }
                std::process::exit(100 + failed);
            }
            "stdout" => {
                for target in [Target::Stdout, Target::Path("/dev/stdout".into())] {
                    let format = target.format().unwrap();
                    let mut output =
                        Output::open(target, format, 600, 400, Metadata::default()).unwrap();
                    output.write(&picture.clone().into_band()).unwrap();
                    output.finish().unwrap();
                }
                std::process::exit(0);
            }
            task => panic!("no task {task}"),
        }
    }

    #[test]
    fn nothing_remains_after_an_interruption() {
        let (_keep, folder) = folder();
        assert_eq!(run_child("interrupted", &folder, "").0, Some(130));
        assert!(names(&folder).is_empty());
    }

    #[test]
    fn nothing_remains_where_there_is_no_space() {
        let (_keep, folder) = folder();
        fs::write(folder.join("a.png"), "old").unwrap();
        // A limit on the size of files fails as a full disk does, once its signal is ignored.
        assert_eq!(
            run_child("out of space", &folder, "trap '' XFSZ; ulimit -f 16;").0,
            Some(103)
        );
        assert_eq!(names(&folder), ["a.png"]);
        assert_eq!(fs::read(folder.join("a.png")).unwrap(), b"old");
    }

    /// The same on a file system that is really full: `PLUMB_TEST_FULL` names a folder on one with less than 100 KiB.
    #[test]
    #[ignore = "needs a small file system"]
    fn nothing_remains_on_a_full_disk() {
        let folder = PathBuf::from(std::env::var_os("PLUMB_TEST_FULL").unwrap());
        let before = names(&folder);
        assert_eq!(run_child("out of space", &folder, "").0, Some(103));
        assert_eq!(names(&folder), before);
    }

    #[test]
    fn stdout_gets_the_bytes_and_nothing_else_of_ours() {
        let (_keep, folder) = folder();
        let (code, bytes) = run_child("stdout", &folder, "");
        assert_eq!(code, Some(0));
        // The test harness has its say before.
        let picture = [ppm(&picture(600, 400)), ppm(&picture(600, 400))].concat();
        assert!(bytes.ends_with(&picture));
    }

    #[test]
    fn a_redirected_stdout_is_written_where_it_stands() {
        let (_keep, folder) = folder();
        let path = folder.join("all");
        fs::write(&path, "before\n").unwrap();
        let before = format!("exec >>'{}';", path.display());
        assert_eq!(run_child("stdout", &folder, &before).0, Some(0));
        let bytes = fs::read(&path).unwrap();
        assert!(bytes.starts_with(b"before\n"));
        assert!(bytes.ends_with(&ppm(&picture(600, 400))));
        assert_eq!(names(&folder), ["all"]);
    }
}
