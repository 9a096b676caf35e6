//! A program with a window: started on a display, waited for, closed.
#![allow(dead_code, reason = "every test uses a part")]

use std::fs;
use std::io::Read;
use std::path::Path;
use std::process::{Child, Command, ExitStatus, Stdio};
use std::sync::{Arc, Mutex};
use std::thread::{self, JoinHandle};
use std::time::{Duration, Instant};

use image::RgbImage;
use tempfile::TempDir;

use crate::x11::{Display, Window};

/// No machine is slower than this.
const DEADLINE: Duration = Duration::from_secs(120);

/// Between two looks.
const LOOK: Duration = Duration::from_millis(10);

/// A running program; killed when dropped.
pub(crate) struct Program<'d> {
    /// Its window.
    pub(crate) window: Window<'d>,
    process: Process,
}

/// How a program ended.
pub(crate) struct Ended {
    pub(crate) status: ExitStatus,
    /// All that it printed.
    pub(crate) said: String,
}

impl<'d> Program<'d> {
    /// Starts it, and waits for its window. It is given the display, and nothing of the desktop on which the test runs.
    pub(crate) fn start(display: &'d Display, command: Command) -> Program<'d> {
        Program::start_within(DEADLINE, display, command)
    }

    /// With another deadline, for this and all that is waited for later.
    pub(crate) fn start_within(
        deadline: Duration,
        display: &'d Display,
        command: Command,
    ) -> Program<'d> {
        let mut process = Process::start(display, command, deadline);
        let number = process.child.id();
        let window = process.wait("its window", None, || display.window_of(number));
        Program { window, process }
    }

    /// Waits until `check` gives something, and returns that. `what` says in a failure what did not come.
    pub(crate) fn wait<T>(&mut self, what: &str, mut check: impl FnMut(&Window) -> Option<T>) -> T {
        let window = self.window;
        self.process.wait(what, Some(window), || check(&window))
    }

    /// Waits until a screenshot is as it should be, and returns it.
    pub(crate) fn wait_for(
        &mut self,
        what: &str,
        mut check: impl FnMut(&RgbImage) -> bool,
    ) -> RgbImage {
        self.wait(what, |window| window.screenshot().filter(&mut check))
    }

    /// What it printed so far, on stdout and stderr together.
    pub(crate) fn said(&self) -> String {
        self.process.said()
    }

    /// What it printed from this byte on.
    pub(crate) fn said_from(&self, start: usize) -> String {
        let said = self.process.said.lock().unwrap();
        String::from_utf8_lossy(&said[start..]).into_owned()
    }

    /// The number of its process.
    pub(crate) fn number(&self) -> u32 {
        self.process.child.id()
    }

    /// How it ended, if it has.
    pub(crate) fn has_ended(&mut self) -> Option<ExitStatus> {
        self.process.child.try_wait().unwrap()
    }

    /// The memory that it has, in KiB (VmRSS).
    pub(crate) fn memory(&self) -> u64 {
        self.memory_if_there().unwrap()
    }

    /// The same; none if it has ended.
    pub(crate) fn memory_if_there(&self) -> Option<u64> {
        let path = format!("/proc/{}/status", self.process.child.id());
        let status = fs::read_to_string(path).ok()?;
        let line = status.lines().find(|l| l.starts_with("VmRSS:"))?;
        line.split_whitespace().nth(1)?.parse().ok()
    }

    /// The seconds that its threads computed so far, all together.
    pub(crate) fn cpu_seconds(&self) -> f64 {
        cpu_seconds(&self.process.child.id().to_string(), 14)
    }

    /// Closes the window as a user does, and waits for the end.
    pub(crate) fn close(self) -> Ended {
        self.window.ask_to_close();
        self.end()
    }

    /// Waits for the end, for which a key or a button asked.
    pub(crate) fn end(mut self) -> Ended {
        let start = Instant::now();
        let status = loop {
            if let Some(status) = self.process.child.try_wait().unwrap() {
                break status;
            }
            if start.elapsed() > self.process.deadline {
                let picture = save(self.window, "the end");
                panic!("it does not end{picture}; it said: {}", self.said());
            }
            thread::sleep(LOOK);
        };
        Ended {
            status,
            said: self.process.last_words(),
        }
    }
}

/// The seconds that processes computed which this one started and waited for.
pub(crate) fn cpu_seconds_of_children() -> f64 {
    cpu_seconds("self", 16)
}

/// Two fields of what the system tells of a process, both of them times: by the program and by the system for it.
fn cpu_seconds(process: &str, field: usize) -> f64 {
    let stat = fs::read_to_string(format!("/proc/{process}/stat")).unwrap();
    // Behind the name in parentheses the fields are numbered from 3. Of their ticks 100 are a second.
    let (_, fields) = stat.rsplit_once(") ").unwrap();
    let ticks = fields.split(' ').skip(field - 3).take(2);
    let ticks: f64 = ticks.map(|ticks| ticks.parse::<f64>().unwrap()).sum();
    ticks / 100.0
}

/// A process, what it prints, and how long it has for all it does.
struct Process {
    child: Child,
    said: Arc<Mutex<Vec<u8>>>,
    readers: Vec<JoinHandle<()>>,
    deadline: Duration,
    _runtime: Option<TempDir>,
}

impl Process {
    fn start(display: &Display, mut command: Command, deadline: Duration) -> Process {
        command
            .env("DISPLAY", display.name())
            .env_remove("WAYLAND_SOCKET")
            .env_remove("XAUTHORITY")
            .env_remove("XMODIFIERS")
            .stdin(Stdio::null())
            .stdout(Stdio::piped())
            .stderr(Stdio::piped());
        // A test may be about one.
        if !command.get_envs().any(|e| e.0 == "WAYLAND_DISPLAY") {
            command.env_remove("WAYLAND_DISPLAY");
        }
        let scaled = command.get_envs().any(|e| e.0 == "WINIT_X11_SCALE_FACTOR");
        if !scaled {
            command.env("WINIT_X11_SCALE_FACTOR", "1");
        }
        // Mesa complains where it is not set.
        let runtime = std::env::var_os("XDG_RUNTIME_DIR")
            .is_none()
            .then(|| TempDir::new().unwrap());
        if let Some(runtime) = &runtime {
            command.env("XDG_RUNTIME_DIR", runtime.path());
        }
        let mut child = command
            .spawn()
            .unwrap_or_else(|error| panic!("{}: {error}", command.get_program().display()));
        let said = Arc::default();
        let readers = vec![
            listen(child.stdout.take().unwrap(), Arc::clone(&said)),
            listen(child.stderr.take().unwrap(), Arc::clone(&said)),
        ];
        Process {
            child,
            said,
            readers,
            deadline,
            _runtime: runtime,
        }
    }

    fn said(&self) -> String {
        String::from_utf8_lossy(&self.said.lock().unwrap()).into_owned()
    }

    /// What it printed until it ended.
    fn last_words(&mut self) -> String {
        for reader in self.readers.drain(..) {
            reader.join().unwrap();
        }
        self.said()
    }

    fn wait<T>(
        &mut self,
        what: &str,
        window: Option<Window>,
        mut check: impl FnMut() -> Option<T>,
    ) -> T {
        let start = Instant::now();
        loop {
            // Asked first: who has ended has no window to be asked for.
            if let Some(status) = self.child.try_wait().unwrap() {
                let said = self.last_words();
                panic!("{what} was waited for, but it ended with {status}; it said: {said}");
            }
            if let Some(found) = check() {
                return found;
            }
            if start.elapsed() > self.deadline {
                let picture = window.map_or(String::new(), |window| save(window, what));
                let title = window.map_or(String::new(), |w| format!(", title {:?}", w.title()));
                let said = self.said();
                panic!("{what} did not come{picture}{title}; it said: {said}");
            }
            thread::sleep(LOOK);
        }
    }
}

impl Drop for Process {
    fn drop(&mut self) {
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

/// Keeps what is printed.
fn listen(mut from: impl Read + Send + 'static, said: Arc<Mutex<Vec<u8>>>) -> JoinHandle<()> {
    thread::spawn(move || {
        let mut buffer = [0; 4096];
        while let Ok(count @ 1..) = from.read(&mut buffer) {
            said.lock().unwrap().extend_from_slice(&buffer[..count]);
        }
    })
}

/// Saves how the window looks, and says where.
fn save(window: Window, what: &str) -> String {
    let name: String = what
        .chars()
        .map(|c| if c.is_ascii_alphanumeric() { c } else { '-' })
        .collect();
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("preview");
    let file = folder.join(format!("{name}.png"));
    let saved = fs::create_dir_all(&folder).is_ok()
        && window
            .screenshot()
            .is_some_and(|shot| shot.save(&file).is_ok());
    if saved {
        format!(" (see {})", file.display())
    } else {
        String::from(" (and there is no screenshot)")
    }
}
