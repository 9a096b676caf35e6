//! Parts on their way into their picture: read and checked on all cores, a few chunks ahead of who writes them, so that
//! memory does not grow with the picture. What was written is memory for what is read next: memory that was never
//! touched before costs as much as half of the hashing.

use std::io;
use std::sync::Arc;
use std::sync::mpsc::{Receiver, Sender, SyncSender, channel, sync_channel};
use std::thread;

use rayon::prelude::*;

use super::folder::Survey;
use super::part::{Part, PartError};
use crate::frame::{Band, Emit};

/// Chunks for each core in a batch: enough that cores seldom wait for the last one of them.
const BATCH: usize = 4;

/// Why parts were not joined.
#[derive(Debug, thiserror::Error)]
pub enum JoinError {
    /// A part is not right.
    #[error("part {number} is not right: {error}")]
    Part {
        /// Which.
        number: u32,
        /// Why.
        error: PartError,
    },
    /// What takes the rows said no.
    #[error(transparent)]
    Emit(#[from] io::Error),
}

/// What came of it: how many bytes the parts' files have.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Joined {
    /// Bytes that were read.
    pub bytes: u64,
}

/// Hands the rows of all parts on, from the top of the picture down. Each chunk is checked before it is.
///
/// # Errors
/// If a part is not right, after those above it were handed on; if `emit` says no.
pub fn join(survey: &Survey, emit: &mut Emit<'_>) -> Result<Joined, JoinError> {
    thread::scope(|scope| {
        // One batch is read and checked while another waits and a third one is written.
        let (sender, receiver) = sync_channel(1);
        let (used, spare) = channel();
        scope.spawn(move || read_all(survey, &spare, &sender));
        write_all(&receiver, &used, emit)
    })
}

/// Rows, and how many bytes they took in the file; or what was wrong.
type Chunk = Result<(Band, u64), JoinError>;

fn write_all(
    from: &Receiver<Vec<Chunk>>,
    used: &Sender<Vec<u8>>,
    emit: &mut Emit<'_>,
) -> Result<Joined, JoinError> {
    let mut joined = Joined { bytes: 0 };
    for chunk in from.iter().flatten() {
        let (band, bytes) = chunk?;
        emit(&band)?;
        joined.bytes += bytes;
        // At the end nobody reads any more.
        let _ = used.send(band.rgb);
    }
    Ok(joined)
}

/// Reads all chunks in order, a batch at a time, until nobody takes them any more.
fn read_all(survey: &Survey, spare: &Receiver<Vec<u8>>, to: &SyncSender<Vec<Chunk>>) {
    let parts = survey.states().len() as u32;
    let batch = BATCH * rayon::current_num_threads();
    let mut places = Vec::with_capacity(batch);
    let send = |places: &mut Vec<(Arc<Part>, u32, Vec<u8>)>| {
        let read: Vec<Chunk> = places
            .par_drain(..)
            .map(|(part, chunk, bytes)| band(&part, chunk, bytes))
            .collect();
        to.send(read).is_ok()
    };
    for number in 1..=parts {
        let part = match open(survey, number) {
            Ok(part) => part,
            Err(error) => {
                if send(&mut places) {
                    // Where nobody takes it, nobody asks.
                    let _ = to.send(vec![Err(error)]);
                }
                return;
            }
        };
        for chunk in 0..part.chunks() {
            let bytes = spare.try_recv().unwrap_or_default();
            places.push((Arc::clone(&part), chunk, bytes));
            if places.len() == batch && !send(&mut places) {
                return;
            }
        }
    }
    send(&mut places);
}

/// Opens a part again, which may not be the one any more that was surveyed.
fn open(survey: &Survey, number: u32) -> Result<Arc<Part>, JoinError> {
    let parts = survey.states().len() as u32;
    let failed = |error| JoinError::Part { number, error };
    let part = Part::open(&survey.folder().part(number, parts)).map_err(failed)?;
    let header = part.header();
    let same = survey.picture().is_some_and(|like| {
        (like.identity, like.width, like.values) == (header.identity, header.width, header.values)
    });
    if !same {
        return Err(failed(PartError::Wrong("it is of another picture".into())));
    }
    Ok(Arc::new(part))
}

/// The rows of a chunk, in memory that there is.
fn band(part: &Part, chunk: u32, mut rgb: Vec<u8>) -> Chunk {
    let header = part.header();
    let number = header.number;
    part.read(chunk, &mut rgb)
        .map_err(|error| JoinError::Part { number, error })?;
    let bytes = rgb.len() as u64;
    let rows = part.layout().rows_of(chunk);
    let top = header.rows.end;
    let values = header.values.then(|| {
        let pixels = header.width as usize * rows.len();
        let values = rgb.split_off(3 * pixels);
        let (floats, _) = values.as_chunks::<4>();
        let floats: Vec<f32> = floats
            .iter()
            .map(|four| f32::from_le_bytes(*four))
            .collect();
        floats.as_chunks::<3>().0.to_vec()
    });
    let band = Band {
        rows: top - rows.end..top - rows.start,
        rgb,
        values,
        verdicts: None,
    };
    Ok((band, bytes))
}
