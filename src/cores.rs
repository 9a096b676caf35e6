//! The threads that all of plumb's work on the CPU shares, unless it runs in a pool of its own.

use std::error::Error;

use rayon::{ThreadPoolBuildError, ThreadPoolBuilder};

/// Starts so many of them, or one a core, where they have not been started yet. (Started by themselves where they are
/// used first, they would end the process if the system refused.)
///
/// # Errors
/// Where the system refuses: there is too little memory, or there are too many processes.
pub fn start(threads: Option<usize>) -> Result<(), ThreadPoolBuildError> {
    // 0 stands for one a core.
    let builder = ThreadPoolBuilder::new().num_threads(threads.unwrap_or(0));
    match builder.build_global() {
        // Without a cause it says that they have been started.
        Err(error) if error.source().is_some() => Err(error),
        _ => Ok(()),
    }
}

/// Whether there is another core to ask, and its thread is there; in a pool, that is the pool's.
pub fn are_several() -> bool {
    let is_in_pool = rayon::current_thread_index().is_some();
    (is_in_pool || start(None).is_ok()) && rayon::current_num_threads() > 1
}
