//! A folder with the parts of a picture: what they are called, and which of them are there and right.

use std::collections::BTreeSet;
use std::ffi::{OsStr, OsString};
use std::io;
use std::path::{Path, PathBuf};
use std::{fs, iter};

use rayon::prelude::*;

use super::cut::Cut;
use super::header::Header;
use super::identity::Identity;
use super::part::{Part, PartError};
use crate::image::remove_left;

/// How a part's file is called at its end.
const ENDING: &str = "plumbpart";

/// Where the parts of a picture lie. Several pictures may share a folder: parts are called by their picture.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Folder {
    path: PathBuf,
    stem: OsString,
}

impl Folder {
    /// The folder at `path`, and in it the parts of the picture that is called `stem`, without its ending.
    pub fn new(path: PathBuf, stem: OsString) -> Self {
        Self { path, stem }
    }

    /// The folder's own name.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// The file of a part, `picture.03-of-16.plumbpart`: in the order of numbers by name.
    pub fn part(&self, number: u32, parts: u32) -> PathBuf {
        let digits = parts.to_string().len();
        let mut name = self.stem.clone();
        name.push(format!(".{number:0digits$}-of-{parts}.{ENDING}"));
        self.path.join(name)
    }

    /// Into how many parts the picture is cut, by the names of the files that are there; several numbers, where parts
    /// of several cuts are.
    ///
    /// # Errors
    /// If the folder cannot be read.
    pub fn cuts(&self) -> io::Result<BTreeSet<u32>> {
        let ours = |(stem, _, parts): Named| (stem == self.stem).then_some(parts);
        Ok(names(&self.path)?.into_iter().filter_map(ours).collect())
    }

    /// Of which pictures there are parts in a folder.
    ///
    /// # Errors
    /// If the folder cannot be read.
    pub fn stems(path: &Path) -> io::Result<BTreeSet<OsString>> {
        Ok(names(path)?.into_iter().map(|(stem, ..)| stem).collect())
    }

    /// Looks at all parts: whether they are there, their headers, which picture they are of; not yet at their rows.
    /// Where it is known which picture is `wanted`, parts of others are wrong.
    pub fn survey(&self, parts: u32, wanted: Option<Identity>) -> Survey {
        let open = |number: u32| {
            let part = self.open(number, parts, wanted)?;
            Ok((part.header().clone(), part.presumed()))
        };
        let opened: Vec<_> = (1..=parts).into_par_iter().map(open).collect();
        let mut survey = Survey {
            folder: self.clone(),
            states: Vec::new(),
            pictures: Vec::new(),
            presumed: 0,
        };
        for (number, opened) in (1..).zip(opened) {
            survey.states.push(match opened {
                Err(error) => State::Wrong(error),
                Ok((header, presumed)) => {
                    survey.presumed += presumed;
                    let rows = header.rows.clone();
                    let mut pictures = survey.pictures.iter_mut();
                    match pictures.find(|(known, _)| known.identity == header.identity) {
                        Some((_, numbers)) => numbers.push(number),
                        None => survey.pictures.push((header, vec![number])),
                    }
                    State::Right(rows)
                }
            });
        }
        survey.check_tiling();
        survey
    }

    /// Opens a part, and checks all but its rows.
    fn open(&self, number: u32, parts: u32, wanted: Option<Identity>) -> Result<Part, PartError> {
        let part = Part::open(&self.part(number, parts))?;
        let header = part.header();
        if (header.number, header.parts) != (number, parts) {
            let (number, parts) = (header.number, header.parts);
            let what = format!("it is part {number} of {parts} by its header");
            return Err(PartError::Wrong(what));
        }
        if wanted.is_some_and(|wanted| wanted != header.identity) {
            let what = "it is of another picture: another scene, other settings, or cut otherwise";
            return Err(PartError::Wrong(what.into()));
        }
        Ok(part)
    }

    /// Opens a part of the picture that is wanted, and checks all of it.
    ///
    /// # Errors
    /// If it is not there, or not right.
    pub fn check(&self, number: u32, cut: &Cut, wanted: Identity) -> Result<Part, PartError> {
        let part = self.open(number, cut.parts(), Some(wanted))?;
        if part.header().rows != cut.rows(number) {
            return Err(PartError::Wrong("its rows are not its share".into()));
        }
        part.check()?;
        Ok(part)
    }

    /// Removes what killed processes have left of this picture's parts that were not whole. Nobody may be making some.
    ///
    /// # Errors
    /// If the folder cannot be read.
    pub fn remove_unfinished(&self) -> io::Result<()> {
        let is_ours =
            |name: &str| named(OsStr::new(name)).is_some_and(|(stem, ..)| stem == self.stem);
        remove_left(&self.path, &is_ours)
    }

    /// Removes the files of all parts of a cut, with what killed processes have left, and the folder, if nothing else
    /// is there. Nobody may be making some.
    ///
    /// # Errors
    /// What the system says of a part that it does not let us remove.
    pub fn remove(&self, parts: u32) -> io::Result<()> {
        for number in 1..=parts {
            match fs::remove_file(self.part(number, parts)) {
                Err(error) if error.kind() != io::ErrorKind::NotFound => return Err(error),
                _ => {}
            }
        }
        self.remove_unfinished()?;
        // It fails where there is something else, which is to stay.
        let _ = fs::remove_dir(&self.path);
        Ok(())
    }
}

/// What the name of a part's file says: the picture's name, which part, and of how many.
type Named = (OsString, u32, u32);

/// Reads the name of a part's file.
fn named(name: &OsStr) -> Option<Named> {
    let name = Path::new(name);
    let rest = Path::new(
        name.extension()
            .filter(|ending| *ending == ENDING)
            .and(name.file_stem())?,
    );
    let (number, parts) = rest.extension()?.to_str()?.split_once("-of-")?;
    Some((
        rest.file_stem()?.to_owned(),
        number.parse().ok()?,
        parts.parse().ok()?,
    ))
}

/// What the names of all parts' files in a folder say.
fn names(path: &Path) -> io::Result<Vec<Named>> {
    let mut found = Vec::new();
    for entry in fs::read_dir(path)? {
        found.extend(named(&entry?.file_name()));
    }
    Ok(found)
}

/// What there is of a part.
#[derive(Debug)]
pub enum State {
    /// Its header is right, and it has these rows.
    Right(std::ops::Range<u32>),
    /// It is not there, or not right.
    Wrong(PartError),
}

/// What there is of a picture's parts.
#[derive(Debug)]
pub struct Survey {
    folder: Folder,
    states: Vec<State>,
    /// Which pictures they are of: what a part of each says of itself, and which parts are of it.
    pictures: Vec<(Header, Vec<u32>)>,
    presumed: u64,
}

impl Survey {
    /// Parts whose rows do not follow those of the part above are wrong, whatever their hash says.
    fn check_tiling(&mut self) {
        let [(like, _)] = &self.pictures[..] else {
            return;
        };
        let mut top = Some(like.picture.end);
        let last = self.states.len() - 1;
        for (index, state) in self.states.iter_mut().enumerate() {
            let State::Right(rows) = state else {
                // What follows a part that is not there is not known.
                top = None;
                continue;
            };
            let start = rows.start;
            let follows = top.is_none_or(|top| top == rows.end);
            if !follows || (index == last && start != like.picture.start) {
                let what = "its rows do not follow those of the part above".into();
                *state = State::Wrong(PartError::Wrong(what));
            }
            top = Some(start);
        }
    }

    /// Checks the rows of all parts that seem right.
    pub fn check_rows(&mut self) {
        let (folder, parts) = (&self.folder, self.states.len() as u32);
        let states = self.states.par_iter_mut().enumerate();
        states.for_each(|(index, state)| {
            if matches!(state, State::Right(_)) {
                let part = Part::open(&folder.part(index as u32 + 1, parts));
                if let Err(error) = part.and_then(|part| part.check()) {
                    *state = State::Wrong(error);
                }
            }
        });
    }

    /// The folder.
    pub fn folder(&self) -> &Folder {
        &self.folder
    }

    /// What there is of each part, from the first.
    pub fn states(&self) -> &[State] {
        &self.states
    }

    /// Which pictures the parts are of that seem right: what one of them says of itself, and which parts are of it. It
    /// should be one.
    pub fn pictures(&self) -> &[(Header, Vec<u32>)] {
        &self.pictures
    }

    /// What every part says of the picture, if they agree.
    pub fn picture(&self) -> Option<&Header> {
        match &self.pictures[..] {
            [(like, _)] => Some(like),
            _ => None,
        }
    }

    /// Pixels that are presumed, not proven.
    pub fn presumed(&self) -> u64 {
        self.presumed
    }

    /// The numbers of the parts that have to be made: those that are not there or not right; all, where there are parts
    /// of several pictures, as the files do not tell which of them is wanted.
    pub fn missing(&self) -> Vec<u32> {
        let several = self.pictures.len() > 1;
        let wrong = |state: &State| several || matches!(state, State::Wrong(_));
        let numbered = iter::zip(1.., &self.states);
        numbered
            .filter_map(|(number, state)| wrong(state).then_some(number))
            .collect()
    }
}
