//! How the process ends: at once.
//!
//! Threads may still be loading a driver, or wait for one that does not answer. What the C library and the drivers do
//! at a regular end (destructors of libraries in use) is not safe beside such threads, and takes time for nothing: all
//! that a process has the system takes back.

use std::io::Write as _;

/// Ends the process with this exit code, when all that it had to say is out.
pub(crate) fn process(code: u8) -> ! {
    // Where this fails nobody reads any more.
    let _ = std::io::stdout().flush();
    let _ = std::io::stderr().flush();
    now(code)
}

/// Ends the process with this exit code, whatever its other threads do: one may wait for ever for somebody to read what
/// it says, and hold stdout meanwhile.
#[cfg_attr(
    unix,
    allow(
        unsafe_code,
        reason = "the system's call that ends a process is unsafe to call, as all of C's"
    )
)]
pub(crate) fn now(code: u8) -> ! {
    #[cfg(unix)]
    // SAFETY: it takes a number and does not return.
    unsafe {
        libc::_exit(code.into())
    }
    #[cfg(not(unix))]
    std::process::exit(code.into())
}
