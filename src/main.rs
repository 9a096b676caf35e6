//! plumb's program: arguments → job → exit code. The jobs are in `cli`, what they call is the library.

mod cli;

fn main() {
    quiet_the_loader();
    cli::main()
}

/// Without XDG_RUNTIME_DIR (services, containers, `env -i`) Mesa's Vulkan layer that chooses among devices complains on
/// stderr, whatever is asked of us. It asks the desktop which device to prefer; we choose by ourselves, so it may stay
/// out.
#[allow(
    unsafe_code,
    reason = "a layer's switch is an environment variable, and setting one is unsafe"
)]
fn quiet_the_loader() {
    let switch = "NODEVICE_SELECT";
    if cfg!(target_os = "linux")
        && std::env::var_os("XDG_RUNTIME_DIR").is_none()
        && std::env::var_os(switch).is_none()
    {
        // SAFETY: this is the first thing that the program does, so no other thread is there to read the environment.
        unsafe { std::env::set_var(switch, "1") };
    }
}
