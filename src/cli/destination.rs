//! Where pictures go: what `-o` means for a scene, or for each of many.

use std::ffi::{OsStr, OsString};
use std::path::{self, Path};

use anyhow::{Result, bail};
use plumb::files::is_stream;
use plumb::image::Target;

/// What stands for a scene's name in the name of its picture.
const NAME: &str = "{}";

/// What `-o` and its like say.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Destination<'a> {
    /// Nothing: the scene's name, in the current folder.
    Unsaid,
    /// The scene's name, in this folder.
    Folder(&'a Path),
    /// This, with the scene's name for each `{}`.
    Pattern(&'a str),
    /// Just this.
    Name(&'a OsStr),
}

impl<'a> Destination<'a> {
    /// What an argument means.
    pub(crate) fn of(argument: Option<&'a Path>) -> Self {
        let Some(path) = argument else {
            return Self::Unsaid;
        };
        if let Some(pattern) = path.to_str().filter(|text| text.contains(NAME)) {
            return Self::Pattern(pattern);
        }
        let last = path.as_os_str().as_encoded_bytes().last();
        let asks_for_folder = last.is_some_and(|&last| path::is_separator(char::from(last)));
        if asks_for_folder || path.is_dir() {
            return Self::Folder(path);
        }
        Self::Name(path.as_os_str())
    }

    /// Where the picture of the scene goes that has this file; of one that has none, to stdout if nothing is said.
    pub(crate) fn target(self, scene: Option<&Path>) -> Result<Target> {
        match self {
            Self::Name(name) => Ok(Target::from_argument(name)),
            Self::Unsaid => {
                let Some(file) = scene else {
                    return Ok(Target::Stdout);
                };
                // A name such as `-.txt` must not turn into stdout.
                Ok(Target::Path(Path::new("").join(picture(stem(file)?))))
            }
            Self::Folder(folder) => {
                let Some(file) = scene else {
                    bail!(
                        "cannot write {}: it is a folder; name the file too, such as picture.ppm",
                        folder.display()
                    );
                };
                if !folder.exists() {
                    let folder = folder.display();
                    bail!("there is no folder {folder}: make it first, with `mkdir -p {folder}`");
                }
                Ok(Target::Path(folder.join(picture(stem(file)?))))
            }
            Self::Pattern(pattern) => {
                let Some(file) = scene else {
                    bail!(
                        "the scene on stdin has no name to stand for {NAME} in {pattern}: name the picture"
                    );
                };
                let mut name = OsString::new();
                for (place, part) in pattern.split(NAME).enumerate() {
                    if place > 0 {
                        name.push(stem(file)?);
                    }
                    name.push(part);
                }
                Ok(Target::Path(name.into()))
            }
        }
    }
}

/// The scene's name, by which its picture is called.
fn stem(file: &Path) -> Result<&OsStr> {
    match file.file_stem().filter(|stem| !stem.is_empty()) {
        Some(stem) if !is_stream(file) => Ok(stem),
        _ => bail!(
            "{} has no name to call the picture by: give one with -o",
            file.display()
        ),
    }
}

/// The name of a picture whose format nobody gave.
fn picture(stem: &OsStr) -> OsString {
    let mut name = stem.to_owned();
    name.push(".ppm");
    name
}

#[cfg(test)]
mod tests {
    use super::*;

    fn target(argument: Option<&str>, scene: Option<&str>) -> Result<String, String> {
        let destination = Destination::of(argument.map(Path::new));
        let target = destination.target(scene.map(Path::new));
        target
            .map(|target| target.to_string())
            .map_err(|error| error.to_string())
    }

    #[test]
    fn a_scene_gives_its_name_to_its_picture() {
        let folder = tempfile::tempdir().unwrap();
        let folder = folder.path().to_str().unwrap();
        let scene = Some("frames/0001.a.txt");
        for (argument, expected) in [
            (None, "0001.a.ppm"),
            (Some("x.png"), "x.png"),
            (Some("-"), "stdout"),
            (Some(folder), &format!("{folder}/0001.a.ppm")),
            (
                Some(&*format!("{folder}/")),
                &format!("{folder}/0001.a.ppm"),
            ),
            (Some("{}.png"), "0001.a.png"),
            (Some("out/{}/{}-big.exr"), "out/0001.a/0001.a-big.exr"),
        ] {
            assert_eq!(
                target(argument, scene).as_deref(),
                Ok(expected),
                "{argument:?}"
            );
        }
        assert_eq!(target(None, Some("a/-.txt")).as_deref(), Ok("-.ppm"));
    }

    #[test]
    fn what_has_no_name_gives_none() {
        assert_eq!(target(None, None).as_deref(), Ok("stdout"));
        for (argument, scene, words) in [
            (Some("{}.png"), None, "no name to stand for {}"),
            (Some("."), None, "it is a folder"),
            (None, Some("/dev/stdin"), "no name to call the picture by"),
            (Some("none-such/"), Some("a.txt"), "`mkdir -p none-such/`"),
        ] {
            let error = target(argument, scene).unwrap_err();
            assert!(error.contains(words), "{error}");
        }
    }
}
