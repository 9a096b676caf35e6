//! Files that are no pictures of ours: damaged, foreign, or claiming more than is in them.

use super::*;

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
        refused("it ends early");
    }
    fs::write(&path, &whole[..8]).unwrap();
    refused("it ends within its header");
    // What stands behind the last pixel is not read, and is no reason to refuse what stands before.
    fs::write(&path, [&whole[..], b"\n"].concat()).unwrap();
    let (read_on, remark) = read_with_remark(&path).unwrap();
    assert_eq!(read_on, picture);
    assert!(remark.unwrap().starts_with("goes on behind its pixels"));
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
