//! How the program talks: data to stdout, talk to stderr, errors with their causes.
//!
//! Used by every subcommand. Talk that cannot be printed is dropped: it must never spoil a job that went well.

use std::io::{self, ErrorKind, IsTerminal, Write};
use std::{env, fmt};

use anyhow::{Context, Result};
use plumb::diagnostic::{Diagnostics, visible_text};
use plumb::image::{OutputError, ReadError};
use plumb::scene::LoadError;

use super::inherited::check_stdout;
use super::progress;

/// A pipe whose reader went away: no failure, the reader has seen enough.
#[derive(Debug)]
pub(crate) struct BrokenPipe;

impl fmt::Display for BrokenPipe {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("the reader of the output went away")
    }
}

impl std::error::Error for BrokenPipe {}

/// Whether the job only ended because nobody reads what it writes.
pub(crate) fn is_broken_pipe(error: &anyhow::Error) -> bool {
    error.chain().any(|cause| {
        cause.is::<BrokenPipe>()
            || cause
                .downcast_ref::<OutputError>()
                .is_some_and(OutputError::is_broken_pipe)
            || cause
                .downcast_ref::<io::Error>()
                .is_some_and(|error| error.kind() == ErrorKind::BrokenPipe)
    })
}

/// Writes data to stdout; a reader that went away is no failure, so that an answer keeps its exit code.
pub(crate) fn data(text: &str) -> Result<()> {
    progress::aside(|| stream(|to| to.write_all(text.as_bytes())))
}

/// Lets `write` write data to stdout, however much, under the rules of [`data`].
pub(crate) fn stream(write: impl FnOnce(&mut dyn Write) -> io::Result<()>) -> Result<()> {
    check_stdout()?;
    let mut stdout = io::BufWriter::new(io::stdout().lock());
    match write(&mut stdout).and_then(|()| stdout.flush()) {
        Err(error) if error.kind() == ErrorKind::BrokenPipe => {
            // What is buffered has nowhere to go.
            drop(stdout.into_parts());
            Ok(())
        }
        written => written.context("cannot write to stdout"),
    }
}

/// Prints text to stderr as it is.
pub(crate) fn talk(text: &str) {
    // There is nowhere to say that stderr is closed.
    let _ = progress::aside(|| io::stderr().lock().write_all(text.as_bytes()));
}

/// Prints text to stderr that begins with the program's name. Names in it may hold anything; lines are those of
/// libraries' errors.
pub(crate) fn note(text: &str) {
    let lines: Vec<String> = text.lines().map(visible_text).collect();
    talk(&format!("plumb: {}\n", lines.join("\n")));
}

/// Prints an error: scene errors as their listing, everything else as one line with its causes.
pub(crate) fn error(error: &anyhow::Error) {
    if let Some(LoadError::Scene(diagnostics)) = error.downcast_ref::<LoadError>() {
        return diagnosed(diagnostics);
    }
    if let Some(diagnostics) = error.downcast_ref::<Diagnostics>() {
        return diagnosed(diagnostics);
    }
    note(&format!("error: {}", causes(error)));
}

/// Prints what is wrong with a scene.
pub(crate) fn diagnosed(diagnostics: &Diagnostics) {
    talk(&diagnostics.render(color()));
}

/// The error and its causes in one line. Some errors of libraries repeat their cause in their own text: it is said
/// once.
pub(crate) fn causes(error: &anyhow::Error) -> String {
    let mut line = String::new();
    for cause in error.chain() {
        let text = cause.to_string();
        if line.is_empty() {
            line = text;
        } else if !line.contains(&text) {
            line.push_str(": ");
            line.push_str(&text);
        }
        // Our own errors say in one sentence what the system said to them.
        if cause.is::<LoadError>() || cause.is::<OutputError>() || cause.is::<ReadError>() {
            break;
        }
    }
    line
}

/// Whether stderr is a terminal that is to be coloured.
fn color() -> bool {
    let set = |name: &str| env::var_os(name).is_some_and(|value| !value.is_empty());
    io::stderr().is_terminal()
        && !set("NO_COLOR")
        && env::var_os("TERM").is_none_or(|term| term != "dumb")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_cause_is_said_once() {
        let inner = io::Error::other("no space");
        let outer = anyhow::Error::new(inner)
            .context("writing a.ppm failed: no space")
            .context("a.ppm");
        assert_eq!(causes(&outer), "a.ppm: writing a.ppm failed: no space");
        let plain =
            anyhow::Error::new(io::Error::other("no space")).context("writing a.ppm failed");
        assert_eq!(causes(&plain), "writing a.ppm failed: no space");
    }

    #[test]
    fn broken_pipes_are_found_below_their_context() {
        let pipe = anyhow::Error::new(io::Error::from(ErrorKind::BrokenPipe)).context("writing");
        assert!(is_broken_pipe(&pipe));
        assert!(!is_broken_pipe(&anyhow::Error::new(io::Error::other(
            "no space"
        ))));
    }
}
