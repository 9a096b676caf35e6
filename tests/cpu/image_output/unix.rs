//! What Unix has besides plain files: modes, links, devices, pipes, a stdout that leads somewhere, full disks.

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
    let (_, module) = module_path!().split_once("::").unwrap();
    let script = format!("{before} exec \"$0\" --exact {module}::child --ignored --nocapture");
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
