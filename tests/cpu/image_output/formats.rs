//! Each format holds the picture to the byte, its metadata and its hash.

use super::*;

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
        let path = folder.join(name);
        let mut output = open(&path, format, &picture).unwrap().hashing();
        for band in bands(&picture, &[5]) {
            output.write(&band).unwrap();
        }
        let hash = Some(sha256(&ppm(&picture)));
        assert_eq!(output.finish().unwrap().sha256, hash);
        // Where the file tells it, it need not be asked for; what nobody asks for takes no time.
        let unasked = write(&path, format, &picture, &[5]).sha256;
        assert_eq!(unasked, hash.filter(|_| format != Format::Ppm));
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
    assert_eq!(info.srgb, Some(png::SrgbRenderingIntent::Perceptual));
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
    assert_eq!(Some(text(HASH_KEY)), finished.sha256);
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

/// Blocks are compressed as they come, and are those that the library writes of a picture in one piece.
#[test]
fn an_exr_has_the_librarys_blocks() {
    use exr::prelude::*;
    let (_keep, folder) = folder();
    let path = folder.join("a.exr");
    // More than are compressed together, and a last block that is not whole.
    let (width, rows) = (1300_u32, 900_u32);
    let picture = picture(width, rows);
    write(&path, Format::Exr, &picture, &[7]);
    let bytes = fs::read(&path).unwrap();
    let values = bands(&picture, &[rows]).remove(0).values.unwrap();
    let pixel = |Vec2(x, y): Vec2<usize>| {
        let [r, g, b] = values[y * width as usize + x];
        (r, g, b)
    };
    let encoding = Encoding {
        compression: Compression::ZIP16,
        blocks: Blocks::ScanLines,
        line_order: LineOrder::Increasing,
    };
    let layer = Layer::new(
        (width as usize, rows as usize),
        LayerAttributes::default(),
        encoding,
        SpecificChannels::rgb(pixel),
    );
    let mut whole = io::Cursor::new(Vec::new());
    Image::from_layer(layer)
        .write()
        .to_buffered(&mut whole)
        .unwrap();
    let whole = whole.into_inner();
    let blocks = rows.div_ceil(16) as usize;
    // Where the first block is: its place stands so many places before it.
    let first = |bytes: &[u8]| {
        let place = |at: usize| bytes[at - 8 * blocks..][..8] == (at as u64).to_le_bytes();
        (8 * blocks..bytes.len()).find(|at| place(*at)).unwrap()
    };
    let (ours, theirs) = (first(&bytes), first(&whole));
    assert!(bytes[ours..] == whole[theirs..]);
    let places = |bytes: &[u8], at: usize| -> Vec<u64> {
        let (places, _) = bytes[at - 8 * blocks..at].as_chunks();
        let place = |place: &[u8; 8]| u64::from_le_bytes(*place) - at as u64;
        places.iter().map(place).collect()
    };
    assert_eq!(places(&bytes, ours), places(&whole, theirs));
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
        (Format::Exr, 11_184_811, 1),
        (Format::Exr, 1, u32::MAX),
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
        open(Format::Exr, 11_184_811, 1)
            .unwrap_err()
            .to_string()
            .contains("the most is 11184810 × 2147483647")
    );
}

#[test]
fn the_largest_pictures_are_begun_in_little_memory() {
    let (_keep, folder) = folder();
    let large = 1_000_000;
    for (format, name) in FORMATS {
        let target = Target::Path(folder.join(name));
        let mut output = Output::open(target, format, large, large, Metadata::default()).unwrap();
        for row in (large - 2..large).rev() {
            let values = || vec![[row as f32; 3]; large as usize];
            let band = Band {
                rows: row..row + 1,
                rgb: vec![row as u8; 3 * large as usize],
                values: format.wants_values().then(values),
                verdicts: None,
            };
            output.write(&band).unwrap();
        }
        assert!(output.finish().is_err());
        assert!(names(&folder).is_empty());
    }
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
