//! The front of writing pictures: one [`Output`] is one picture on its way into one target.
//!
//! Above the encoders and `sink`: counts the rows, hashes the bytes, and lets only whole pictures be finished.

use std::io::{self, Write};

use sha2::{Digest, Sha256};

use super::exr::Exr;
use super::png::Png;
use super::sink::Sink;
use super::size::check_size;
use super::target::Target;
use super::{Format, OutputError};
use crate::cores;
use crate::frame::Band;
use crate::ppm;
use crate::scene::Scene;
use crate::settings::Settings;

/// The key of the picture's hash among the metadata.
pub const HASH_KEY: &str = "plumb:sha256";

/// Bytes of one text at most: far more than any of ours, far less than a PNG's chunk may hold.
const TEXT_MOST: usize = 1 << 20;

/// Attributes of EXR with a meaning and a type of their own; a text by such a name would make the file unreadable.
const EXR_NAMES: [&str; 16] = [
    "channels",
    "chunkCount",
    "compression",
    "dataWindow",
    "displayWindow",
    "lineOrder",
    "maxSamplesPerPixel",
    "name",
    "pixelAspectRatio",
    "preview",
    "screenWindowCenter",
    "screenWindowWidth",
    "tiles",
    "type",
    "version",
    "view",
];

/// What a picture's file tells of how it was made: text chunks in PNG, attributes in EXR, nothing in PPM, which has no
/// place for it. The picture's hash is added by itself, as [`HASH_KEY`].
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Metadata {
    /// Keys and their texts. A key is 1 to 79 characters of printable ASCII without blanks at its ends or doubled, and
    /// comes once; a text is anything up to 1 MiB without the character NUL.
    pub entries: Vec<(String, String)>,
}

impl Metadata {
    /// What changes the bytes of a scene's picture, and by which software it was made; no date and no path, so that the
    /// same picture is the same file.
    pub fn of(software: &str, name: &str, scene: &Scene, settings: &Settings) -> Self {
        let [width, height] = scene.camera.pixeldim;
        let rows = settings.rows_of(height);
        let entry = |key: &str, text: String| (key.to_owned(), text);
        let mut entries = vec![
            entry("Software", software.to_owned()),
            entry("plumb:scene", name.to_owned()),
            entry("plumb:size", format!("{width}x{height}")),
            entry("plumb:rows", format!("{}..{}", rows.start, rows.end)),
            entry(
                "plumb:screen-tolerance",
                settings.screen_tolerance.to_string(),
            ),
            entry("plumb:samples", settings.samples.to_string()),
            entry(
                "plumb:precision",
                format!("{:?}", settings.precision).to_lowercase(),
            ),
        ];
        if let Some(several) = settings.supersampling() {
            entries.push(entry(
                "plumb:jitter",
                format!("{:?}", several.spread).to_lowercase(),
            ));
        }
        if !scene.lights.is_empty() {
            entries.push(entry(
                "plumb:max-path",
                settings.limits.max_path.to_string(),
            ));
        }
        Self { entries }
    }

    /// Checks what PNG and EXR ask of keys and texts, for every format alike: what can be told in one can be told in
    /// all.
    fn check(&self) -> Result<(), OutputError> {
        for (index, (key, text)) in self.entries.iter().enumerate() {
            let problem = if key.is_empty() || key.len() > 79 {
                "a key has 1 to 79 characters"
            } else if !key.bytes().all(|byte| matches!(byte, b' '..=b'~')) {
                "a key is printable ASCII"
            } else if key.trim() != key || key.contains("  ") {
                "a key has no blanks at its ends and no two in a row"
            } else if key == HASH_KEY || self.entries[..index].iter().any(|(known, _)| known == key)
            {
                "this key is taken"
            } else if EXR_NAMES.contains(&key.as_str()) {
                "this key means something else in EXR"
            } else if text.len() > TEXT_MOST {
                "a text has at most 1 MiB"
            } else if text.contains('\0') {
                "a text has no character NUL"
            } else {
                continue;
            };
            return Err(OutputError::Metadata {
                key: key.clone(),
                problem,
            });
        }
        Ok(())
    }
}

/// A picture that was written.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Finished {
    /// The picture's hash, 64 lowercase hexadecimal digits: the SHA-256 of its PPM file. Of PNG and EXR, which tell it,
    /// always; of PPM if it was asked for ([`Output::hashing`]).
    pub sha256: Option<String>,
    /// Length of the file that was written, in bytes.
    pub bytes: u64,
}

/// One picture on its way. [`finish`](Output::finish) gives it its name; dropped without, nothing remains.
pub struct Output {
    target: Target,
    to: Counted,
    encoder: Encoder,
    hash: Option<Sha256>,
    width: u32,
    rows: u32,
    written: u32,
    /// The row above which the next band must end, counted from the bottom; any before the first.
    next: Option<u32>,
    failed: bool,
    durable: bool,
}

enum Encoder {
    Ppm,
    Png(Box<Png>),
    Exr(Box<Exr>),
}

impl Encoder {
    fn write(&mut self, band: &Band, to: &mut Counted) -> io::Result<()> {
        match self {
            Self::Ppm => to.write_all(&band.rgb),
            Self::Png(png) => png.write(&band.rgb, to),
            Self::Exr(exr) => exr.write(band.values.as_deref().unwrap_or_default(), &mut to.sink),
        }
    }
}

/// Counts what goes on to the sink.
struct Counted {
    sink: Sink,
    bytes: u64,
}

impl Write for Counted {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        let written = self.sink.write(bytes)?;
        self.bytes += written as u64;
        Ok(written)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.sink.flush()
    }
}

impl Output {
    /// Opens a target for a picture of `width` columns, of which `rows` rows will be written (a part of a picture is a
    /// picture of that many rows). Comes before rendering: whatever can be known to fail fails here.
    ///
    /// # Errors
    /// Any [`OutputError`] but [`Unfinished`](OutputError::Unfinished): what cannot be opened or created, a size that
    /// the format cannot hold (no pixels at all; more than it can count), metadata that cannot be told.
    pub fn open(
        target: Target,
        format: Format,
        width: u32,
        rows: u32,
        metadata: Metadata,
    ) -> Result<Self, OutputError> {
        metadata.check()?;
        check_size(format, width, rows)?;
        // The encoder is made in memory first, so that the file is created only when nothing but the system can fail.
        let mut encoder = match format {
            Format::Ppm => Encoder::Ppm,
            Format::Png => Encoder::Png(Box::new(
                Png::new(width, rows, &metadata.entries).map_err(|source| OutputError::Write {
                    target: target.clone(),
                    source,
                })?,
            )),
            Format::Exr => {
                Encoder::Exr(Box::new(Exr::new(width, rows, &metadata.entries, HASH_KEY)))
            }
        };
        let mut to = Counted {
            sink: Sink::open(&target)?,
            bytes: 0,
        };
        let header = ppm::header(width, rows);
        if let Encoder::Ppm = &mut encoder {
            to.write_all(header.as_bytes())
                .map_err(|source| OutputError::Write {
                    target: target.clone(),
                    source,
                })?;
        }
        let hash = (format != Format::Ppm).then(|| Sha256::new_with_prefix(&header));
        Ok(Self {
            target,
            to,
            encoder,
            hash,
            width,
            rows,
            written: 0,
            next: None,
            failed: false,
            durable: false,
        })
    }

    /// Has [`finish`](Output::finish) wait until the system has put the file where it outlives a power cut.
    #[must_use]
    pub fn durable(mut self) -> Self {
        self.to.sink.begin_early();
        self.durable = true;
        self
    }

    /// Hashes the picture whatever its format is; to be asked for before the first rows are written.
    #[must_use]
    pub fn hashing(mut self) -> Self {
        let header = ppm::header(self.width, self.rows);
        self.hash
            .get_or_insert_with(|| Sha256::new_with_prefix(&header));
        self
    }

    /// Whether nothing reaches the target before [`finish`](Output::finish); devices, pipes and stdout are written
    /// through.
    #[must_use]
    pub fn is_beside(&self) -> bool {
        self.to.sink.is_beside()
    }

    /// Writes the next rows below those that were written.
    ///
    /// # Errors
    /// What the system says; [`io::ErrorKind::BrokenPipe`] if the reader of a pipe or of stdout went away.
    /// [`io::ErrorKind::InvalidInput`] for a band that does not fit: not the next rows, more than were announced, not
    /// three bytes a pixel, without values although the format is EXR. After any error the picture cannot be finished.
    pub fn write(&mut self, band: &Band) -> io::Result<()> {
        let written = self
            .check(band)
            .and_then(|rows| self.encode(band).map(|()| rows));
        match written {
            Ok(rows) => {
                self.written += rows;
                self.next = Some(band.rows.start);
                Ok(())
            }
            Err(error) => {
                self.failed = true;
                Err(error)
            }
        }
    }

    /// The number of rows of a band that comes next.
    fn check(&self, band: &Band) -> io::Result<u32> {
        let misfit = |problem: &str| {
            let message = format!(
                "rows {} to {} do not fit: {problem}",
                band.rows.start, band.rows.end
            );
            Err(io::Error::new(io::ErrorKind::InvalidInput, message))
        };
        let Some(rows) = band.rows.end.checked_sub(band.rows.start) else {
            return misfit("they end before they start");
        };
        if self.failed {
            return misfit("an earlier band failed");
        }
        if rows > self.rows - self.written {
            return misfit("there are more than were announced");
        }
        if self.next.is_some_and(|next| next != band.rows.end) {
            return misfit("they are not the ones right below the last");
        }
        let pixels = u64::from(self.width) * u64::from(rows);
        if band.rgb.len() as u64 != 3 * pixels {
            return misfit("there are not three bytes a pixel");
        }
        match (&self.encoder, &band.values) {
            (Encoder::Exr(_), None) => misfit("EXR needs the values before quantising"),
            (Encoder::Exr(_), Some(values)) if values.len() as u64 != pixels => {
                misfit("there is not one value a pixel")
            }
            _ => Ok(rows),
        }
    }

    /// Hashes the band, if that is wanted, on another core while it is written here.
    fn encode(&mut self, band: &Band) -> io::Result<()> {
        let (to, encoder) = (&mut self.to, &mut self.encoder);
        match &mut self.hash {
            None => encoder.write(band, to),
            Some(hash) if cores::are_several() => rayon::in_place_scope(|beside| {
                beside.spawn(|_| hash.update(&band.rgb));
                encoder.write(band, to)
            }),
            Some(hash) => {
                hash.update(&band.rgb);
                encoder.write(band, to)
            }
        }
    }

    /// Ends the picture and gives it its name. What was under the name before is there until now.
    ///
    /// # Errors
    /// [`OutputError::Unfinished`] if rows are missing or a write failed; [`OutputError::Write`] if the rest could not
    /// be written or named. Nothing remains then.
    pub fn finish(self) -> Result<Finished, OutputError> {
        let Self {
            target,
            mut to,
            encoder,
            hash,
            rows,
            written,
            failed,
            durable,
            ..
        } = self;
        if failed || written != rows {
            return Err(OutputError::Unfinished {
                target,
                written,
                rows,
            });
        }
        let digits = |byte: &u8| format!("{byte:02x}");
        let sha256 = hash.map(|hash| hash.finalize().iter().map(digits).collect::<String>());
        // PNG and EXR are hashed always.
        let told = sha256.as_deref().unwrap_or_default();
        let ended = match encoder {
            Encoder::Ppm => Ok(()),
            Encoder::Png(png) => png.finish(HASH_KEY, told, &mut to),
            Encoder::Exr(exr) => exr.finish(told, &mut to.sink).map(|bytes| to.bytes = bytes),
        };
        let bytes = to.bytes;
        match ended.and_then(|()| to.sink.commit(durable)) {
            Ok(()) => Ok(Finished { sha256, bytes }),
            Err(source) => Err(OutputError::Write { target, source }),
        }
    }
}
