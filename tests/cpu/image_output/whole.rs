//! A picture is whole under its name, or not there.

use super::*;

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
    assert!(refused(Path::new("/proc/a.ppm")).contains("no file can be made in /proc"));
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
