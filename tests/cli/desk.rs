//! A folder with a scene in it, the program run there, and how the run ended.

use std::fs;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};

use tempfile::TempDir;

/// A room with a wall, a sphere and tiles; small, and no two rows alike.
pub(crate) const ROOM: &str = "\
camera cam { pixeldim 40 30 worlddim 8 6 viewpoint 4 3 6 }
material green { ambient 0 5 0 }
material red { ambient 6 1 1 }
material grey { ambient 3 3 3 }
plane wall { material green normal 3 0 1 point 0 0 0 }
tiled_plane floor { material grey normal 0 1 0 point 0 -0.2 0 altmaterial red dimension 1.5 1.5 }
sphere ball { material red center 5 3 -4 radius 2 }
";

/// The same kind of room under two lights, with a mirror, glass, a shadow and a picture's frame.
pub(crate) const LIT: &str = "\
camera cam { pixeldim 40 30 worlddim 8 6 viewpoint 4 3 6 }
material green { ambient 0 1 0 diffuse 1 2 1 specular 0.3 }
material glass { ambient 1 1 1 diffuse 4 1 1 transparency 0.5 specular 0.4 shininess 20 }
material grey { ambient 1 1 1 diffuse 3 3 3 }
plane wall { material green normal 0 0 1 point 0 0 -8 }
tiled_plane floor { material grey normal 0 1 0 point 0 -0.2 0 altmaterial green dimension 1.5 1.5 xdir 1 0 1 }
sphere ball { material glass center 5 3 -4 radius 2 }
sphere stone { material grey center 2 1 -3 radius 0.7 }
fplane frame { material grey normal 0 0 1 point 1 3.5 -6 xdir 1 0 0 dimensions 2 1.5 }
light lamp { location 4 5.5 1 emissivity 3 3 3 }
spotlight spot { location 0 5 -1 emissivity 3 2 1 point 4 1 -4 theta 25 }
";

/// A folder of its own, with a scene in it, in which the program runs.
pub(crate) struct Desk {
    pub(crate) folder: TempDir,
}

impl Desk {
    pub(crate) fn new() -> Self {
        let desk = Self {
            folder: tempfile::tempdir().unwrap(),
        };
        desk.write("room.txt", ROOM);
        desk
    }

    pub(crate) fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    pub(crate) fn write(&self, name: &str, text: &str) {
        fs::write(self.path(name), text).unwrap();
    }

    pub(crate) fn read(&self, name: &str) -> Vec<u8> {
        fs::read(self.path(name)).unwrap()
    }

    pub(crate) fn command(&self, args: &[&str]) -> Command {
        let mut command = Command::new(env!("CARGO_BIN_EXE_plumb"));
        command
            .args(args)
            .current_dir(self.folder.path())
            .env_remove("RUST_LOG")
            // What the program remembers between runs is the tests' own.
            .env(
                "XDG_CACHE_HOME",
                concat!(env!("CARGO_TARGET_TMPDIR"), "/cache"),
            )
            .stdin(Stdio::null());
        command
    }

    pub(crate) fn run(&self, args: &[&str]) -> Ran {
        Ran::new(args, self.command(args).output().unwrap())
    }

    pub(crate) fn pipe(&self, args: &[&str], input: &str) -> Ran {
        let mut command = self.command(args);
        command
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .stderr(Stdio::piped());
        let mut child = command.spawn().unwrap();
        child
            .stdin
            .take()
            .unwrap()
            .write_all(input.as_bytes())
            .unwrap();
        Ran::new(args, child.wait_with_output().unwrap())
    }

    /// Names of all there is, sorted.
    pub(crate) fn names(&self) -> Vec<String> {
        let entries = fs::read_dir(self.folder.path()).unwrap();
        let mut names: Vec<String> = entries
            .map(|e| e.unwrap().file_name().into_string().unwrap())
            .collect();
        names.sort();
        names
    }
}

/// How a run ended.
pub(crate) struct Ran {
    pub(crate) args: String,
    pub(crate) code: Option<i32>,
    pub(crate) stdout: Vec<u8>,
    pub(crate) stderr: String,
}

impl Ran {
    pub(crate) fn new(args: &[&str], output: Output) -> Self {
        let stderr = String::from_utf8(output.stderr).unwrap();
        Self {
            args: args.join(" "),
            code: output.status.code(),
            stdout: output.stdout,
            stderr,
        }
    }

    #[track_caller]
    pub(crate) fn ends(self, code: i32) -> Self {
        assert_eq!(
            self.code,
            Some(code),
            "plumb {}: {}",
            self.args,
            self.stderr
        );
        self
    }

    /// Failed as it should: exit 2, nothing on stdout, these words on stderr.
    #[track_caller]
    pub(crate) fn fails_with(self, words: &[&str]) {
        let ran = self.ends(2);
        assert_eq!(ran.text(), "", "plumb {}", ran.args);
        for word in words {
            assert!(
                ran.stderr.contains(word),
                "plumb {}: no {word:?} in {}",
                ran.args,
                ran.stderr
            );
        }
    }

    pub(crate) fn text(&self) -> String {
        String::from_utf8_lossy(&self.stdout).into_owned()
    }
}

/// Header and bytes of a PPM.
pub(crate) fn ppm(bytes: &[u8]) -> (u32, u32, &[u8]) {
    let end = bytes.iter().position(|&byte| byte == b'\n').unwrap();
    let header = std::str::from_utf8(&bytes[..end]).unwrap();
    let words: Vec<&str> = header.split(' ').collect();
    assert_eq!((words[0], words[3]), ("P6", "255"), "{header}");
    (
        words[1].parse().unwrap(),
        words[2].parse().unwrap(),
        &bytes[end + 1..],
    )
}

pub(crate) fn scenes() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes")
}
