//! A display that nobody sees (Xvfb), and what a user does to a window on it: look, type, drag.
//!
//! There is no window manager: windows are where they put themselves, without a frame, and have no focus until
//! [`Window::focus`].
#![allow(dead_code, reason = "every test uses a part")]

mod drag;

use std::io::{BufRead, BufReader, Read};
use std::process::{Child, Command, Stdio};
use std::thread;
use std::time::Duration;

use image::RgbImage;
use x11rb::connection::Connection;
use x11rb::protocol::xproto::{
    AtomEnum, BUTTON_PRESS_EVENT, BUTTON_RELEASE_EVENT, ClientMessageEvent, ConfigureWindowAux,
    ConnectionExt as _, EventMask, ImageFormat, ImageOrder, InputFocus, KEY_PRESS_EVENT,
    KEY_RELEASE_EVENT, MOTION_NOTIFY_EVENT, MapState, VisualClass, Window as Id, WindowClass,
};
use x11rb::protocol::xtest::ConnectionExt as _;
use x11rb::rust_connection::RustConnection;

/// Keys that have no character. Those that have one are `u32::from('a')`.
pub(crate) mod keys {
    pub(crate) const BACKSPACE: u32 = 0xff08;
    pub(crate) const TAB: u32 = 0xff09;
    pub(crate) const RETURN: u32 = 0xff0d;
    pub(crate) const ESCAPE: u32 = 0xff1b;
    pub(crate) const HOME: u32 = 0xff50;
    pub(crate) const LEFT: u32 = 0xff51;
    pub(crate) const UP: u32 = 0xff52;
    pub(crate) const RIGHT: u32 = 0xff53;
    pub(crate) const DOWN: u32 = 0xff54;
    pub(crate) const PAGE_UP: u32 = 0xff55;
    pub(crate) const PAGE_DOWN: u32 = 0xff56;
    pub(crate) const END: u32 = 0xff57;
    pub(crate) const F1: u32 = 0xffbe;
    pub(crate) const SHIFT: u32 = 0xffe1;
    pub(crate) const CONTROL: u32 = 0xffe3;
    pub(crate) const ALT: u32 = 0xffe9;
    pub(crate) const DELETE: u32 = 0xffff;
}

/// Buttons of the mouse.
pub(crate) const LEFT: u8 = 1;
pub(crate) const MIDDLE: u8 = 2;
pub(crate) const RIGHT: u8 = 3;
/// One step of the wheel is a press of such a button.
const WHEEL_UP: u8 = 4;
const WHEEL_DOWN: u8 = 5;

/// Between the steps of a drag, so that they come one by one.
const STEP: Duration = Duration::from_millis(5);

/// An X server without a screen, ended when dropped.
pub(crate) struct Display {
    server: Child,
    name: String,
    connection: RustConnection,
    root: Id,
}

impl Display {
    /// Starts one whose screen has this many pixels.
    pub(crate) fn start(width: u32, height: u32) -> Display {
        Display::start_with("Xvfb", width, height)
    }

    /// With another server than Xvfb.
    pub(crate) fn start_with(server: &str, width: u32, height: u32) -> Display {
        let mut server = Command::new(server)
            // It chooses a number that is free, and says it when it is ready.
            .args(["-displayfd", "1", "-nolisten", "tcp", "-noreset"])
            .args(["-screen", "0", &format!("{width}x{height}x24")])
            .stdin(Stdio::null())
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .unwrap_or_else(|error| {
                panic!("{server}: {error}; it is in the package xvfb (Fedora: xorg-x11-server-Xvfb, Arch: xorg-server-xvfb)")
            });
        let mut number = String::new();
        let said = BufReader::new(server.stdout.take().unwrap()).read_line(&mut number);
        if said.is_err() || number.trim().is_empty() {
            let _ = server.kill();
            let mut why = String::new();
            let _ = server.stderr.take().unwrap().read_to_string(&mut why);
            panic!("Xvfb does not start: {why}");
        }
        // What it complains of later must not fill the pipe.
        let mut stderr = server.stderr.take().unwrap();
        thread::spawn(move || std::io::copy(&mut stderr, &mut std::io::sink()));
        let name = format!(":{}", number.trim());
        let connected = x11rb::connect(Some(&name));
        let (connection, screen) = connected.unwrap_or_else(|error| {
            let _ = server.kill();
            panic!("no connection to Xvfb at {name}: {error}")
        });
        let root = connection.setup().roots[screen].root;
        Display {
            server,
            name,
            connection,
            root,
        }
    }

    /// What programs are given as `DISPLAY`.
    pub(crate) fn name(&self) -> &str {
        &self.name
    }

    /// The window that the process with this number shows; none while it shows none.
    pub(crate) fn window_of(&self, process: u32) -> Option<Window<'_>> {
        let tree = self.connection.query_tree(self.root).unwrap().reply();
        let children = tree.unwrap().children;
        // One that is gone meanwhile has errors for answers.
        let found = children.into_iter().find(|&id| {
            let window = Window { display: self, id };
            let attributes = self.connection.get_window_attributes(id).unwrap().reply();
            let shown = attributes.is_ok_and(|a| {
                a.map_state == MapState::VIEWABLE && a.class == WindowClass::INPUT_OUTPUT
            });
            let owner = window.property("_NET_WM_PID");
            shown && owner.is_some_and(|value| value == process.to_ne_bytes())
        });
        found.map(|id| Window { display: self, id })
    }

    fn atom(&self, name: &str) -> u32 {
        let reply = self.connection.intern_atom(false, name.as_bytes());
        reply.unwrap().reply().unwrap().atom
    }

    /// Returns when the server has done all that it was told.
    fn sync(&self) {
        self.connection.get_input_focus().unwrap().reply().unwrap();
    }

    /// An event as from a device.
    fn fake(&self, kind: u8, detail: u8, x: i32, y: i32) {
        let (x, y) = (x.try_into().unwrap(), y.try_into().unwrap());
        self.connection
            .xtest_fake_input(kind, detail, x11rb::CURRENT_TIME, self.root, x, y, 0)
            .unwrap()
            .check()
            .unwrap();
        self.sync();
    }

    /// The key that gives `keysym`, and whether that needs Shift.
    fn key_code(&self, keysym: u32) -> (u8, bool) {
        let setup = self.connection.setup();
        let first = setup.min_keycode;
        let count = setup.max_keycode - first + 1;
        let map = self.connection.get_keyboard_mapping(first, count);
        let map = map.unwrap().reply().unwrap();
        let per_key = usize::from(map.keysyms_per_keycode);
        for level in 0..per_key.min(2) {
            let mut keys = map.keysyms.chunks_exact(per_key);
            if let Some(place) = keys.position(|key| key[level] == keysym) {
                return (first + place as u8, level == 1);
            }
        }
        panic!("no key of Xvfb's keyboard gives {keysym:#x}")
    }
}

impl Drop for Display {
    fn drop(&mut self) {
        let _ = self.server.kill();
        let _ = self.server.wait();
    }
}

/// A window on a [`Display`]. Places are pixels from its top left corner.
#[derive(Clone, Copy)]
pub(crate) struct Window<'d> {
    display: &'d Display,
    id: Id,
}

impl Window<'_> {
    /// What it calls itself.
    pub(crate) fn title(&self) -> String {
        String::from_utf8(self.property("_NET_WM_NAME").unwrap_or_default()).unwrap()
    }

    /// Width and height.
    pub(crate) fn size(&self) -> (u32, u32) {
        self.size_if_there().unwrap()
    }

    /// Width and height; none if it is gone.
    pub(crate) fn size_if_there(&self) -> Option<(u32, u32)> {
        let geometry = self.display.connection.get_geometry(self.id).unwrap();
        let geometry = geometry.reply().ok()?;
        Some((geometry.width.into(), geometry.height.into()))
    }

    /// The pixels as they are on the screen; none if the window changed while they were fetched, is gone, or is partly
    /// beyond the edge of the screen.
    pub(crate) fn screenshot(&self) -> Option<RgbImage> {
        let connection = &self.display.connection;
        let geometry = connection.get_geometry(self.id).unwrap().reply().ok()?;
        let (width, height) = (geometry.width, geometry.height);
        let image = connection
            .get_image(ImageFormat::Z_PIXMAP, self.id, 0, 0, width, height, !0)
            .unwrap()
            .reply()
            .ok()?;
        let setup = connection.setup();
        assert!(image.depth >= 24, "{} bits a pixel", image.depth);
        assert_eq!(setup.image_byte_order, ImageOrder::LSB_FIRST);
        self.assert_true_color(image.visual);
        // Blue, green, red and a byte more.
        let rgb = image.data.chunks_exact(4).flat_map(|p| [p[2], p[1], p[0]]);
        RgbImage::from_raw(width.into(), height.into(), rgb.collect())
    }

    /// One pixel as it is on the screen, for who looks often.
    pub(crate) fn pixel(&self, x: u32, y: u32) -> Option<[u8; 3]> {
        let (x, y) = (i16::try_from(x).ok()?, i16::try_from(y).ok()?);
        let connection = &self.display.connection;
        let image = connection.get_image(ImageFormat::Z_PIXMAP, self.id, x, y, 1, 1, !0);
        let data = image.unwrap().reply().ok()?.data;
        Some([data[2], data[1], data[0]])
    }

    fn assert_true_color(&self, visual: u32) {
        let mut visuals = self.display.connection.setup().roots.iter().flat_map(|r| {
            let depths = r.allowed_depths.iter();
            depths.flat_map(|depth| &depth.visuals)
        });
        let visual = visuals.find(|v| v.visual_id == visual).unwrap();
        assert_eq!(visual.class, VisualClass::TRUE_COLOR);
        let masks = (visual.red_mask, visual.green_mask, visual.blue_mask);
        assert_eq!(masks, (0xff_0000, 0xff00, 0xff));
    }

    /// Gives it this size, and the place at the top left of the screen; nothing happens if it is gone.
    pub(crate) fn resize(&self, width: u32, height: u32) {
        let aux = ConfigureWindowAux::new()
            .x(0)
            .y(0)
            .width(width)
            .height(height);
        let connection = &self.display.connection;
        connection
            .configure_window(self.id, &aux)
            .unwrap()
            .check()
            .ok();
    }

    /// Sends it what is typed from now on.
    pub(crate) fn focus(&self) {
        self.display
            .connection
            .set_input_focus(InputFocus::PARENT, self.id, x11rb::CURRENT_TIME)
            .unwrap()
            .check()
            .unwrap();
    }

    /// Strikes a key (a character or one of [`keys`]) while others are held.
    pub(crate) fn key(&self, keysym: u32, held: &[u32]) {
        let (code, shift) = self.display.key_code(keysym);
        let mut held: Vec<u32> = held.to_vec();
        if shift && !held.contains(&keys::SHIFT) {
            held.push(keys::SHIFT);
        }
        let held: Vec<u8> = held.iter().map(|&k| self.display.key_code(k).0).collect();
        for &code in &held {
            self.display.fake(KEY_PRESS_EVENT, code, 0, 0);
        }
        self.display.fake(KEY_PRESS_EVENT, code, 0, 0);
        self.display.fake(KEY_RELEASE_EVENT, code, 0, 0);
        for &code in held.iter().rev() {
            self.display.fake(KEY_RELEASE_EVENT, code, 0, 0);
        }
    }

    /// Types characters that are on the keyboard.
    pub(crate) fn type_text(&self, text: &str) {
        for character in text.chars() {
            let keysym = match character {
                '\n' => keys::RETURN,
                character => character.into(),
            };
            self.key(keysym, &[]);
        }
    }

    /// Moves the mouse there at once; nothing happens if the window is gone.
    pub(crate) fn move_to(&self, x: i32, y: i32) {
        let connection = &self.display.connection;
        let at = connection.translate_coordinates(self.id, self.display.root, 0, 0);
        let Ok(at) = at.unwrap().reply() else {
            return;
        };
        let (x, y) = (x + i32::from(at.dst_x), y + i32::from(at.dst_y));
        self.display.fake(MOTION_NOTIFY_EVENT, 0, x, y);
    }

    /// Presses a button where the mouse is.
    pub(crate) fn press(&self, button: u8) {
        self.display.fake(BUTTON_PRESS_EVENT, button, 0, 0);
    }

    /// Releases a button.
    pub(crate) fn release(&self, button: u8) {
        self.display.fake(BUTTON_RELEASE_EVENT, button, 0, 0);
    }

    /// Presses and releases the left button there.
    pub(crate) fn click(&self, x: i32, y: i32) {
        self.move_to(x, y);
        self.press(LEFT);
        self.release(LEFT);
    }

    /// Drags with a button in steps of equal length.
    pub(crate) fn drag(&self, button: u8, from: (i32, i32), to: (i32, i32), steps: i32) {
        self.move_to(from.0, from.1);
        self.press(button);
        for step in 1..=steps {
            thread::sleep(STEP);
            let part = |from: i32, to: i32| from + (to - from) * step / steps;
            self.move_to(part(from.0, to.0), part(from.1, to.1));
        }
        self.release(button);
    }

    /// Turns the wheel: away from the user if positive. winit tells of each of these steps twice, as a button and as a
    /// scroll axis, which it does not for a wheel of a real mouse.
    pub(crate) fn wheel(&self, steps: i32) {
        let button = if steps > 0 { WHEEL_UP } else { WHEEL_DOWN };
        for _ in 0..steps.abs() {
            self.press(button);
            self.release(button);
        }
    }

    /// Asks it to close, as the cross in a window's frame does; one that is gone is not asked.
    pub(crate) fn ask_to_close(&self) {
        let (kind, what) = ("WM_PROTOCOLS", "WM_DELETE_WINDOW");
        let data = [self.display.atom(what), x11rb::CURRENT_TIME, 0, 0, 0];
        let event = ClientMessageEvent::new(32, self.id, self.display.atom(kind), data);
        self.display
            .connection
            .send_event(false, self.id, EventMask::NO_EVENT, event)
            .unwrap()
            .check()
            .ok();
    }

    /// The bytes of a property, in the machine's order.
    fn property(&self, name: &str) -> Option<Vec<u8>> {
        let connection = &self.display.connection;
        let name = self.display.atom(name);
        let any = AtomEnum::ANY;
        let reply = connection.get_property(false, self.id, name, any, 0, 1 << 16);
        let reply = reply.unwrap().reply().ok()?;
        (reply.format != 0).then_some(reply.value)
    }
}
