//! What a program copied, asked for as the program does into which it would be pasted.

use std::thread;
use std::time::{Duration, Instant};

use x11rb::connection::Connection;
use x11rb::protocol::Event;
use x11rb::protocol::xproto::{AtomEnum, ConnectionExt as _, CreateWindowAux, WindowClass};

use crate::x11::Display;

/// No owner takes longer.
const DEADLINE: Duration = Duration::from_secs(60);

impl Display {
    /// The text in the clipboard; none where there is none.
    pub(crate) fn clipboard(&self) -> Option<String> {
        // A connection of its own: no event is taken from anyone else.
        let (connection, screen) = x11rb::connect(Some(self.name())).unwrap();
        let root = connection.setup().roots[screen].root;
        let window = connection.generate_id().unwrap();
        let (class, aux) = (WindowClass::INPUT_ONLY, CreateWindowAux::new());
        connection
            .create_window(0, window, root, 0, 0, 1, 1, 0, class, 0, &aux)
            .unwrap();
        let atom = |name: &str| {
            let cookie = connection.intern_atom(false, name.as_bytes()).unwrap();
            cookie.reply().unwrap().atom
        };
        let (from, kind, to) = (atom("CLIPBOARD"), atom("UTF8_STRING"), atom("PLUMB_TEST"));
        connection
            .convert_selection(window, from, kind, to, x11rb::CURRENT_TIME)
            .unwrap();
        connection.flush().unwrap();
        let start = Instant::now();
        loop {
            match connection.poll_for_event().unwrap() {
                // The server itself answers for who is not there.
                Some(Event::SelectionNotify(answer)) if answer.property == x11rb::NONE => {
                    return None;
                }
                Some(Event::SelectionNotify(_)) => break,
                _ => assert!(start.elapsed() < DEADLINE, "who copied does not answer"),
            }
            thread::sleep(Duration::from_millis(5));
        }
        let reply = connection.get_property(true, window, to, AtomEnum::ANY, 0, u32::MAX);
        let reply = reply.unwrap().reply().unwrap();
        assert_eq!(reply.type_, kind, "too long for one piece, or no text");
        Some(String::from_utf8(reply.value).unwrap())
    }
}
