//! The priority of threads: whatever computes for long gives way to the thread that the window lives on, and to those
//! of the driver that draws it.
//!
//! A window that waits for a processor is as dead as one that waits for a lock, and a picture that is rendered keeps
//! all processors busy.

/// How much lower than usual, in the steps of `nice`. A thread gets about a tenth of a processor that somebody at the
/// usual priority wants, and all of it where nobody does.
#[cfg(target_os = "linux")]
const LOWER: i32 = 10;

/// Lowers the priority of this thread, and of all threads that it or the driver starts on it from now on. Only Linux
/// has priorities of threads that one may lower and pass on like that.
pub(super) fn lower() {
    // A system that refuses leaves the window as slow as it would be otherwise.
    #[cfg(target_os = "linux")]
    let _ = rustix::process::setpriority_process(None, LOWER);
}

#[cfg(test)]
#[cfg(target_os = "linux")]
mod tests {
    use super::*;

    fn priority() -> i32 {
        rustix::process::getpriority_process(None).unwrap()
    }

    #[test]
    fn a_thread_passes_its_priority_on_and_others_keep_theirs() {
        let before = priority();
        let (own, passed_on) = std::thread::spawn(|| {
            lower();
            (priority(), std::thread::spawn(priority).join().unwrap())
        })
        .join()
        .unwrap();
        assert_eq!([own, passed_on], [LOWER.max(before); 2]);
        assert_eq!(priority(), before);
    }
}
