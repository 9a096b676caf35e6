//! How the memory that many threads give back is kept: in one place for all, so that it is used again.
//!
//! glibc gives every thread an arena of its own to allocate from, and keeps what is freed in each. Pictures, texts and
//! the driver's shaders are made on threads that come and go: what a window had after some minutes of changes was twice
//! as much as it ever needed at once, and grew on.

/// Lets all threads that are started from now on allocate from the same arena as this one.
pub(super) fn share() {
    #[cfg(all(target_os = "linux", target_env = "gnu"))]
    #[expect(
        unsafe_code,
        reason = "the system's call is unsafe to call, as all of C's"
    )]
    // SAFETY: it takes two numbers, and keeps one of them. Where it refuses, arenas are as many as they were.
    let _ = unsafe { libc::mallopt(libc::M_ARENA_MAX, 1) };
}
