//! Which display the window opens on, where the environment names two and one is dead.

use winit::event_loop::EventLoopBuilder;

/// Leaves Wayland aside where nobody answers at `WAYLAND_DISPLAY` and there is an X11 display: winit would take the
/// former, and fail.
#[cfg(target_os = "linux")]
pub(super) fn choose<T>(builder: &mut EventLoopBuilder<T>) {
    use winit::platform::x11::EventLoopBuilderExtX11 as _;

    let variable = |name: &str| std::env::var_os(name).filter(|value| !value.is_empty());
    // An open socket may have been handed down; then the name does not count.
    if variable("WAYLAND_SOCKET").is_some() || variable("DISPLAY").is_none() {
        return;
    }
    let Some(name) = variable("WAYLAND_DISPLAY") else {
        return;
    };
    // A relative name is one in the folder of the session; an absolute one stays as it is.
    let folder = variable("XDG_RUNTIME_DIR").unwrap_or_default();
    let socket = std::path::Path::new(&folder).join(&name);
    if let Err(error) = std::os::unix::net::UnixStream::connect(&socket) {
        log::info!(
            "no Wayland display answers at {}: {error}; X11 is used",
            socket.display()
        );
        builder.with_x11();
    }
}

/// There is one kind of display.
#[cfg(not(target_os = "linux"))]
pub(super) fn choose<T>(_builder: &mut EventLoopBuilder<T>) {}
