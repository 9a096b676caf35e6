//! Finds the lines that diagnostics point at, and cuts out of them what fits a terminal.
//!
//! Between the [`Diagnostic`]s of a parser, which know bytes, and the renderer, which wants lines.

use std::ops::Range;

use super::{Diagnostic, Help, visible};

/// The most bytes of a line that are shown; of a longer line, so many before the place.
const WINDOW: usize = 160;
const BEFORE: usize = 60;

/// Where a byte of the text is: line and column from 1 (columns in characters), and where its line starts.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Place {
    offset: usize,
    pub(super) line: usize,
    pub(super) column: usize,
    line_start: usize,
}

/// The places of all bytes that a list of complaints points at, found in one walk over the text.
pub(super) struct Places(Vec<Place>);

impl Places {
    pub(super) fn find(text: &[u8], list: &[Diagnostic]) -> Self {
        let mut offsets: Vec<usize> = Vec::new();
        for diagnostic in list {
            offsets.push(diagnostic.span.start);
            offsets.extend(diagnostic.secondary.iter().map(|(span, _)| span.start));
            if let Some(Help::AtLine { offset, .. }) = &diagnostic.help {
                offsets.push(*offset);
            }
        }
        offsets.sort_unstable();
        offsets.dedup();
        // A byte order mark is no character of the first line.
        let mut at = if text.starts_with(b"\xEF\xBB\xBF") {
            3
        } else {
            0
        };
        let mut place = Place {
            offset: 0,
            line: 1,
            column: 1,
            line_start: at,
        };
        let walk = |offset: usize| {
            while at < offset.min(text.len()) {
                let byte = text[at];
                at += 1;
                if byte == b'\n' || (byte == b'\r' && text.get(at) != Some(&b'\n')) {
                    place = Place {
                        offset: 0,
                        line: place.line + 1,
                        column: 1,
                        line_start: at,
                    };
                } else if byte & 0xC0 != 0x80 {
                    place.column += 1;
                }
            }
            Place { offset, ..place }
        };
        Self(offsets.into_iter().map(walk).collect())
    }

    pub(super) fn of(&self, offset: usize) -> Place {
        match self.0.binary_search_by_key(&offset, |place| place.offset) {
            Ok(index) => self.0[index],
            Err(_) => Place {
                offset,
                line: 1,
                column: 1,
                line_start: offset,
            },
        }
    }
}

/// The part of one line that is shown.
#[derive(Debug, Clone)]
pub(super) struct Row {
    pub(super) line: usize,
    text: String,
    /// Where the part starts in the source.
    start: usize,
    /// For each byte of the part, and for its end: where it went in `text`.
    map: Vec<usize>,
    /// Number of the line as the renderer sees it, and where `text` is on the page: see [`Page::lay`].
    pub(super) index: usize,
    pub(super) range: Range<usize>,
}

impl Row {
    pub(super) fn cut(source: &[u8], place: Place) -> Self {
        let is_continuation = |at: usize| source.get(at).is_some_and(|byte| byte & 0xC0 == 0x80);
        let offset = place.offset.min(source.len());
        let line_start = place.line_start.min(offset);
        let is_end = |byte: &u8| matches!(byte, b'\n' | b'\r');
        let window = |start: usize| {
            let limit = source.len().min(start + WINDOW).max(offset);
            let end = source[offset..limit]
                .iter()
                .position(is_end)
                .map_or(limit, |length| offset + length);
            (end, source.get(end).is_some_and(|byte| !is_end(byte)))
        };
        let mut start = line_start;
        let (mut end, mut cut_end) = window(start);
        if cut_end || offset - start > WINDOW {
            start = start.max(offset.saturating_sub(BEFORE));
            (end, cut_end) = window(start);
        }
        let cut_start = start > line_start;
        // Characters are cut whole; a run of continuation bytes that is no text at all is not followed far.
        for _ in 0..3 {
            start += usize::from(cut_start && start < offset && is_continuation(start));
            end -= usize::from(cut_end && end > offset && is_continuation(end));
        }
        let mut text = String::from(if cut_start { "..." } else { "" });
        let mut map = Vec::with_capacity(end - start + 1);
        for chunk in source[start..end].utf8_chunks() {
            for character in chunk.valid().chars() {
                map.extend(std::iter::repeat_n(text.len(), character.len_utf8()));
                text.push(visible(character));
            }
            if !chunk.invalid().is_empty() {
                map.extend(std::iter::repeat_n(text.len(), chunk.invalid().len()));
                text.push(char::REPLACEMENT_CHARACTER);
            }
        }
        map.push(text.len());
        if cut_end {
            text.push_str("...");
        }
        Self {
            line: place.line,
            text,
            start,
            map,
            index: 0,
            range: 0..0,
        }
    }

    /// The bytes of the page that show `span`, cut at the end of the line; nothing where it starts outside.
    pub(super) fn find(&self, span: &Range<usize>) -> Option<Range<usize>> {
        let last = self.map.len() - 1;
        let first = span
            .start
            .checked_sub(self.start)
            .filter(|first| *first <= last)?;
        let end = span.end.saturating_sub(self.start).clamp(first, last);
        Some(self.range.start + self.map[first]..self.range.start + self.map[end])
    }
}

/// The lines that one complaint shows, as a text of their own.
#[derive(Debug, Clone)]
pub(super) struct Page {
    pub(super) text: String,
    pub(super) rows: Vec<Row>,
}

impl Page {
    /// Lays rows out. The renderer draws a gap where two line indices differ by more than 2, and wants to see the line
    /// between where they differ by 2; we do not have that line, so indices are 1 apart for neighbours, else 3.
    pub(super) fn lay(mut rows: Vec<Row>) -> Self {
        rows.sort_by_key(|row| row.line);
        let mut text = String::new();
        let mut last: Option<(usize, usize)> = None;
        for row in &mut rows {
            row.index = last.map_or(0, |(line, index)| {
                index + if row.line == line + 1 { 1 } else { 3 }
            });
            last = Some((row.line, row.index));
            row.range = text.len()..text.len() + row.text.len();
            text.push_str(&row.text);
            text.push('\n');
        }
        Self { text, rows }
    }
}
