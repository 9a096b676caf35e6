//! What the program inherits from whoever starts it: signals that are ignored, and whether stdout is open at all.

use anyhow::{Result, bail};

/// Refuses to write to a stdout that the caller closed: the runtime has opened /dev/null in its place by now, where
/// everything would be lost without a word.
pub(crate) fn check_stdout() -> Result<()> {
    if !stdout::is_open() {
        bail!("cannot write to stdout: it is closed");
    }
    Ok(())
}

/// Has `handler` called at Ctrl-C, SIGTERM and SIGHUP, but not at those of them that the caller had ignored: `nohup`
/// ignores SIGHUP, and a shell Ctrl-C for what it starts in the background.
pub(crate) fn on_signals(handler: fn()) {
    let ignored = signals::ignored();
    // Without a handler Ctrl-C only leaves an unfinished file behind, which is no reason not to start.
    if let Err(error) = ctrlc::set_handler(handler) {
        log::warn!("Ctrl-C may leave an unfinished file: {error}");
    }
    signals::ignore(&ignored);
}

/// Before `main` the runtime opens /dev/null for each of the three streams that is closed. What the linker's list of
/// initial functions names runs earlier still.
#[cfg(target_os = "linux")]
#[allow(
    unsafe_code,
    reason = "a place in the linker's list, and a call of the system, are unsafe"
)]
mod stdout {
    use std::sync::atomic::{AtomicBool, Ordering};

    static OPEN: AtomicBool = AtomicBool::new(true);

    // SAFETY: functions of this list are called without arguments that matter, by the one thread that there is.
    #[used]
    #[unsafe(link_section = ".init_array")]
    static LOOK: extern "C" fn() = look;

    extern "C" fn look() {
        // SAFETY: asks for the flags of a descriptor, whether it is open or not, and changes nothing.
        let flags = unsafe { libc::fcntl(libc::STDOUT_FILENO, libc::F_GETFD) };
        OPEN.store(flags != -1, Ordering::Relaxed);
    }

    pub(super) fn is_open() -> bool {
        OPEN.load(Ordering::Relaxed)
    }
}

#[cfg(not(target_os = "linux"))]
mod stdout {
    pub(super) fn is_open() -> bool {
        true
    }
}

#[cfg(unix)]
#[allow(
    unsafe_code,
    reason = "asking for a signal's handler, and setting one, are unsafe"
)]
mod signals {
    use std::mem::MaybeUninit;
    use std::ptr;

    /// Those of our signals that are ignored.
    pub(super) fn ignored() -> Vec<libc::c_int> {
        let is_ignored = |signal: &libc::c_int| {
            let mut now = MaybeUninit::<libc::sigaction>::zeroed();
            // SAFETY: without a new action the call only fills in the present one, for which there is room; all of
            // its bytes being 0 is a value too, should the call fail.
            let now = unsafe {
                libc::sigaction(*signal, ptr::null(), now.as_mut_ptr());
                now.assume_init()
            };
            now.sa_sigaction == libc::SIG_IGN
        };
        let ours = [libc::SIGINT, libc::SIGTERM, libc::SIGHUP];
        ours.into_iter().filter(is_ignored).collect()
    }

    /// Ignores them again.
    pub(super) fn ignore(signals: &[libc::c_int]) {
        for signal in signals {
            // SAFETY: no code of ours runs at a signal that is ignored.
            unsafe { libc::signal(*signal, libc::SIG_IGN) };
        }
    }
}

#[cfg(not(unix))]
mod signals {
    pub(super) fn ignored() {}

    pub(super) fn ignore((): &()) {}
}
