//! plumb's program: arguments → job → exit code. The jobs are in `cli`, what they call is the library.

mod cli;

use std::process::ExitCode;

fn main() -> ExitCode {
    cli::main()
}
