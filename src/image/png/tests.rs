//! The strips of a PNG are one stream, the same whatever threads and bands it was made with.

use std::io::Cursor;

use super::*;

/// Bytes of a picture: noise, or what deflate finds much of.
fn pixels(width: u32, height: u32, noise: bool) -> Vec<u8> {
    let mut seed = 7_u32;
    (0..PIXEL * (width * height) as usize)
        .map(|place| {
            seed = seed.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            if noise {
                (seed >> 24) as u8
            } else {
                (place / 1000) as u8
            }
        })
        .collect()
}

/// The file of a picture that comes in bands of so many rows, made with so many threads.
fn file(width: u32, height: u32, rgb: &[u8], band: usize, threads: usize) -> Vec<u8> {
    let pool = rayon::ThreadPoolBuilder::new()
        .num_threads(threads)
        .build()
        .unwrap();
    pool.install(|| {
        let mut bytes = Vec::new();
        let mut png = Png::new(width, height, &[("Title".into(), "ä".into())]).unwrap();
        for rows in rgb.chunks(band * PIXEL * width as usize) {
            png.write(rows, &mut bytes).unwrap();
        }
        png.finish("key", "text", &mut bytes).unwrap();
        bytes
    })
}

#[test]
fn others_read_the_same_pixels_whatever_threads_and_bands_made_it() {
    for (width, height) in [
        (1, 1),
        (1, 7),
        (7, 1),
        (3, 5),
        (641, 700),
        (100_003, 3),
        (2, 100_000),
    ] {
        for noise in [false, true] {
            let rgb = pixels(width, height, noise);
            let once = file(width, height, &rgb, height as usize, 1);
            // The format's name stands in front.
            let read = image::load(Cursor::new(&once), image::ImageFormat::Png).unwrap();
            assert_eq!((read.width(), read.height()), (width, height));
            assert!(read.into_rgb8().into_raw() == rgb, "{width}×{height}");
            for (band, threads) in [
                (1, 1),
                (1, 3),
                (13, 2),
                (height as usize, 2),
                (height as usize, 5),
            ] {
                let again = file(width, height, &rgb, band, threads);
                assert!(
                    again == once,
                    "{width}×{height} in bands of {band}, {threads} threads"
                );
            }
        }
    }
}

#[test]
fn large_pictures_have_several_strips_and_small_ones_one() {
    let chunks = |width, height| {
        let bytes = file(width, height, &pixels(width, height, true), 9, 2);
        bytes.windows(4).filter(|name| *name == b"IDAT").count()
    };
    assert_eq!(chunks(10, 10), 1);
    // A row has 3,000 bytes, so a strip has 87 rows.
    assert_eq!(chunks(1000, 87), 1);
    assert_eq!(chunks(1000, 88), 2);
    assert_eq!(chunks(1000, 870), 10);
}

#[test]
fn sums_of_parts_are_the_sum_of_the_whole() {
    let bytes = pixels(300, 300, true);
    let sum = |bytes: &[u8]| simd_adler32::adler32(&bytes);
    for at in [0, 1, 2, 5_552, 65_520, 65_521, 65_522, 200_000, bytes.len()] {
        let (first, second) = bytes.split_at(at);
        assert_eq!(
            joined(sum(first), sum(second), second.len()),
            sum(&bytes),
            "{at}"
        );
    }
}

#[test]
fn the_filter_is_the_formats() {
    let above = pixels(50, 1, true);
    let row = &pixels(50, 2, true)[150..];
    let filtered = filter(&above, row);
    assert_eq!(filtered[0], PAETH);
    let at = |row: &[u8], place: usize| {
        place
            .checked_sub(PIXEL)
            .map_or(0, |left| i32::from(row[left]))
    };
    for place in 0..row.len() {
        // As its specification has it.
        let (a, b, c) = (at(row, place), i32::from(above[place]), at(&above, place));
        let p = a + b - c;
        let (pa, pb, pc) = ((p - a).abs(), (p - b).abs(), (p - c).abs());
        let nearest = if pa <= pb && pa <= pc {
            a
        } else if pb <= pc {
            b
        } else {
            c
        };
        let want = (i32::from(row[place]) - nearest).rem_euclid(256);
        assert_eq!(i32::from(filtered[1 + place]), want, "{place}");
    }
}
