//! What is wrong with a text, and where: one type for every complaint, one renderer for all of them.
//!
//! The scene parser (and whatever else reads a text) makes [`Diagnostic`]s that point at bytes of the text;
//! [`Diagnostics`] turns those into lines, columns and short excerpts, and drops the text. So an error never holds a
//! large file alive, and a line of any length prints as a line of a terminal.

use std::fmt;
use std::ops::Range;

use codespan_reporting::diagnostic::{Diagnostic as Drawing, Label, LabelStyle};
use codespan_reporting::files::{Error as FilesError, Files, Location};
use codespan_reporting::term::{self, Chars, Config};

mod excerpt;

use excerpt::{Page, Places, Row};

/// So many complaints about one text are kept and printed; the rest is counted.
pub const MAX_SHOWN: usize = 100;

/// Characters of a token that a message quotes.
const QUOTED: usize = 40;

/// One complaint about a text: what is wrong, where, and what would mend it.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Diagnostic {
    /// What is wrong, in a sentence without a full stop.
    pub message: String,
    /// The bytes of the text that it is about.
    pub span: Range<usize>,
    /// A few words to print beside the caret.
    pub label: String,
    /// What would mend it.
    pub help: Option<Help>,
    /// Other places that matter, each with a few words.
    pub secondary: Vec<(Range<usize>, String)>,
}

/// What would mend a mistake.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Help {
    /// A sentence.
    Text(String),
    /// A sentence that names the line of a byte of the text, which is known only once lines are counted.
    AtLine {
        /// The sentence up to the number of the line.
        before: String,
        /// The byte.
        offset: usize,
        /// The sentence after the number.
        after: String,
    },
}

impl Diagnostic {
    /// A complaint about the bytes `span` of a text.
    pub fn new(span: Range<usize>, message: impl Into<String>) -> Self {
        Self {
            message: message.into(),
            span,
            label: String::new(),
            help: None,
            secondary: Vec::new(),
        }
    }

    /// With a few words beside the caret.
    #[must_use]
    pub fn label(mut self, label: impl Into<String>) -> Self {
        self.label = label.into();
        self
    }

    /// With what would mend it.
    #[must_use]
    pub fn help(mut self, help: impl Into<String>) -> Self {
        self.help = Some(Help::Text(help.into()));
        self
    }

    /// With a mend that names the line of the byte `offset`.
    #[must_use]
    pub fn help_at(
        mut self,
        before: impl Into<String>,
        offset: usize,
        after: impl Into<String>,
    ) -> Self {
        self.help = Some(Help::AtLine {
            before: before.into(),
            offset,
            after: after.into(),
        });
        self
    }

    /// With another place that matters.
    #[must_use]
    pub fn also(mut self, span: Range<usize>, label: impl Into<String>) -> Self {
        self.secondary.push((span, label.into()));
        self
    }
}

/// All that is wrong with one text, in the order of the text, ready to print.
#[derive(Debug, Clone)]
pub struct Diagnostics {
    file: String,
    reports: Vec<Report>,
    total: usize,
}

/// One complaint with its place found and its lines cut out.
#[derive(Debug, Clone)]
struct Report {
    message: String,
    help: Option<String>,
    line: usize,
    column: usize,
    page: Page,
    labels: Vec<(LabelStyle, Range<usize>, String)>,
}

impl Diagnostics {
    /// Complaints about `text`, which diagnostics call `file`. Of `total` complaints `list` may hold only the first.
    pub fn new(file: &str, text: &[u8], mut list: Vec<Diagnostic>, total: usize) -> Self {
        let total = total.max(list.len());
        list.sort_by_key(|diagnostic| diagnostic.span.start);
        list.truncate(MAX_SHOWN);
        let places = Places::find(text, &list);
        let reports = list
            .into_iter()
            .map(|diagnostic| Report::new(text, &places, diagnostic))
            .collect();
        Self {
            file: visible_text(file),
            reports,
            total,
        }
    }

    /// The name of the text.
    pub fn file(&self) -> &str {
        &self.file
    }

    /// How many complaints there are, those that are not printed included.
    pub fn total(&self) -> usize {
        self.total
    }

    /// Line and column (both from 1, columns in characters) and message of each complaint that is printed.
    pub fn messages(&self) -> impl Iterator<Item = (usize, usize, &str)> {
        self.reports
            .iter()
            .map(|report| (report.line, report.column, report.message.as_str()))
    }

    /// The text for a terminal: message, place, line, caret and mend of each complaint; `color` with ANSI colours.
    pub fn render(&self, color: bool) -> String {
        let config = Config {
            chars: Chars::ascii(),
            ..Config::default()
        };
        let mut out = Vec::new();
        for report in &self.reports {
            let drawing = report.drawing();
            let sheet = Sheet {
                name: &self.file,
                report,
            };
            // Writing to memory cannot fail, and `Sheet` knows every place that it is asked for; should it not, the
            // message alone is better than nothing.
            let drawn = if color {
                let styles = term::Styles::default();
                let mut ansi = term::termcolor::Ansi::new(&mut out);
                let mut writer = term::StylesWriter::new(&mut ansi, &styles);
                term::emit_to_write_style(&mut writer, &config, &sheet, &drawing)
            } else {
                term::emit_to_io_write(&mut out, &config, &sheet, &drawing)
            };
            if drawn.is_err() {
                let plain = format!(
                    "error: {}\n --> {}:{}:{}\n\n",
                    report.message, self.file, report.line, report.column
                );
                out.extend_from_slice(plain.as_bytes());
            }
        }
        let mut text = String::from_utf8_lossy(&out).into_owned();
        text.truncate(text.trim_end().len());
        let more = self.total - self.reports.len();
        if more > 0 {
            text.push_str(&format!("\n\nerror: {}: and {more} more", self.file));
        }
        text.push('\n');
        text
    }

    /// An array with `file`, `line`, `column`, `message` and `help` (or null) of each complaint that is printed.
    pub fn to_json(&self) -> serde_json::Value {
        let report = |report: &Report| {
            serde_json::json!({
                "file": self.file,
                "line": report.line,
                "column": report.column,
                "message": report.message,
                "help": report.help,
            })
        };
        self.reports.iter().map(report).collect()
    }
}

impl fmt::Display for Diagnostics {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.render(false).trim_end())
    }
}

impl std::error::Error for Diagnostics {}

impl Report {
    fn new(text: &[u8], places: &Places, diagnostic: Diagnostic) -> Self {
        let Diagnostic {
            message,
            span,
            label,
            help,
            secondary,
        } = diagnostic;
        let place = places.of(span.start);
        let help = help.map(|help| match help {
            Help::Text(text) => text,
            Help::AtLine {
                before,
                offset,
                after,
            } => format!("{before}{}{after}", places.of(offset).line),
        });
        let mut marks = vec![(LabelStyle::Primary, span, label)];
        marks.extend(
            secondary
                .into_iter()
                .map(|(span, label)| (LabelStyle::Secondary, span, label)),
        );
        let mut rows: Vec<Row> = Vec::new();
        for (_, span, _) in &marks {
            let place = places.of(span.start);
            if !rows.iter().any(|row| row.line == place.line) {
                rows.push(Row::cut(text, place));
            }
        }
        let page = Page::lay(rows);
        let find = |(style, span, label): (LabelStyle, Range<usize>, String)| {
            let line = places.of(span.start).line;
            page.rows
                .iter()
                .find(|row| row.line == line)?
                .find(&span)
                .map(|range| (style, range, label))
        };
        let labels = marks.into_iter().filter_map(find).collect();
        Self {
            message,
            help,
            line: place.line,
            column: place.column,
            page,
            labels,
        }
    }

    fn drawing(&self) -> Drawing<()> {
        let label = |(style, range, message): &(LabelStyle, Range<usize>, String)| {
            Label::new(*style, (), range.clone()).with_message(message)
        };
        Drawing::error()
            .with_message(&self.message)
            .with_labels(self.labels.iter().map(label).collect())
            .with_notes(
                self.help
                    .iter()
                    .map(|help| format!("help: {help}"))
                    .collect(),
            )
    }
}

/// A page as the renderer wants to see a file.
struct Sheet<'r> {
    name: &'r str,
    report: &'r Report,
}

impl<'r> Files<'r> for Sheet<'r> {
    type FileId = ();
    type Name = &'r str;
    type Source = &'r str;

    fn name(&'r self, (): ()) -> Result<&'r str, FilesError> {
        Ok(self.name)
    }

    fn source(&'r self, (): ()) -> Result<&'r str, FilesError> {
        Ok(&self.report.page.text)
    }

    fn line_index(&'r self, (): (), byte_index: usize) -> Result<usize, FilesError> {
        let rows = &self.report.page.rows;
        let row = rows
            .iter()
            .find(|row| byte_index <= row.range.end)
            .or(rows.last());
        row.map(|row| row.index).ok_or(FilesError::FileMissing)
    }

    fn line_number(&'r self, (): (), line_index: usize) -> Result<usize, FilesError> {
        let mut rows = self.report.page.rows.iter();
        let max = rows.len();
        let row = rows.find(|row| row.index == line_index);
        row.map(|row| row.line).ok_or(FilesError::LineTooLarge {
            given: line_index,
            max,
        })
    }

    fn line_range(&'r self, (): (), line_index: usize) -> Result<Range<usize>, FilesError> {
        let mut rows = self.report.page.rows.iter();
        let max = rows.len();
        let row = rows.find(|row| row.index == line_index);
        row.map(|row| row.range.clone())
            .ok_or(FilesError::LineTooLarge {
                given: line_index,
                max,
            })
    }

    /// The place in the file, not on the page.
    fn location(&'r self, (): (), _byte_index: usize) -> Result<Location, FilesError> {
        Ok(Location {
            line_number: self.report.line,
            column_number: self.report.column,
        })
    }
}

/// A character as it may be printed: none that moves the cursor or turns the direction of writing.
fn visible(character: char) -> char {
    let turns = matches!(character, '\u{200E}' | '\u{200F}' | '\u{202A}'..='\u{202E}' | '\u{2066}'..='\u{2069}');
    if turns || (character.is_control() && character != '\t') {
        char::REPLACEMENT_CHARACTER
    } else {
        character
    }
}

/// A text as it may be printed in a line: with nothing that moves the cursor or turns the direction of writing.
pub fn visible_text(text: &str) -> String {
    text.chars().map(visible).collect()
}

/// A token for a message: in backticks, cut when long, with control characters escaped.
pub fn quote(token: &[u8]) -> String {
    let mut quoted = String::from("`");
    // Four bytes a character at most, so no more than this is ever decoded.
    let head = String::from_utf8_lossy(&token[..token.len().min(4 * (QUOTED + 1))]);
    let mut characters = head.chars();
    for character in characters.by_ref().take(QUOTED) {
        if character != '\t' && visible(character) != character {
            quoted.extend(character.escape_unicode());
        } else {
            quoted.push(character);
        }
    }
    if characters.next().is_some() {
        quoted.push_str("...");
    }
    quoted.push('`');
    quoted
}
