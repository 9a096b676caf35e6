//! `plumb completions`: a completion script for a shell, made from the same description as the parser and the help.

use anyhow::Result;
use clap_complete::Shell;

use super::{Answer, command, say};

/// What `plumb completions` takes.
#[derive(Debug, clap::Args)]
#[command(after_help = "\
EXAMPLES
  plumb completions bash > ~/.local/share/bash-completion/completions/plumb
  plumb completions zsh > ~/.zfunc/_plumb
  plumb completions fish > ~/.config/fish/completions/plumb.fish")]
pub(crate) struct Args {
    /// The shell
    shell: Shell,
}

/// Prints the script.
pub(crate) fn run(args: &Args) -> Result<Answer> {
    // Written to memory first: the generator would panic on a closed pipe.
    let mut script = Vec::new();
    clap_complete::generate(args.shell, &mut command(), "plumb", &mut script);
    say::data(&String::from_utf8_lossy(&script))?;
    Ok(Answer::Yes)
}
