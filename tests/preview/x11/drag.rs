//! A file that is dragged over a window from another program's, and dropped: the other side of the XDND protocol.

use std::path::Path;
use std::time::{Duration, Instant};

use x11rb::connection::Connection;
use x11rb::protocol::Event;
use x11rb::protocol::xproto::{
    ClientMessageEvent, ConnectionExt as _, CreateWindowAux, EventMask, PropMode,
    SELECTION_NOTIFY_EVENT, SelectionNotifyEvent, WindowClass,
};
use x11rb::wrapper::ConnectionExt as _;

use super::Window;

/// The version of the protocol that is spoken.
const VERSION: u32 = 5;

/// No window takes longer to answer.
const DEADLINE: Duration = Duration::from_secs(60);

/// A file over a window.
pub(crate) struct Dragged<'d> {
    over: Window<'d>,
    /// The window that it comes from.
    source: u32,
    /// What is asked for: the file's address.
    list: String,
}

impl<'d> Window<'d> {
    /// Drags a file over it, and waits until it has taken that in.
    pub(crate) fn drag_over(&self, file: &Path) -> Dragged<'d> {
        let connection = &self.display.connection;
        let source = connection.generate_id().unwrap();
        let (class, aux) = (WindowClass::INPUT_ONLY, CreateWindowAux::new());
        connection
            .create_window(0, source, self.display.root, 0, 0, 1, 1, 0, class, 0, &aux)
            .unwrap();
        let selection = self.display.atom("XdndSelection");
        connection
            .set_selection_owner(source, selection, x11rb::CURRENT_TIME)
            .unwrap();
        let dragged = Dragged {
            over: *self,
            source,
            list: format!("file://{}\r\n", file.display()),
        };
        let kind = self.display.atom("text/uri-list");
        dragged.tell("XdndEnter", [VERSION << 24, kind, 0, 0]);
        let action = self.display.atom("XdndActionCopy");
        dragged.tell("XdndPosition", [0, 0, x11rb::CURRENT_TIME, action]);
        dragged.wait_for("XdndStatus");
        dragged
    }
}

impl Dragged<'_> {
    /// Drops it, and waits until it was taken.
    pub(crate) fn drop_it(self) {
        self.tell("XdndDrop", [0, x11rb::CURRENT_TIME, 0, 0]);
        self.wait_for("XdndFinished");
    }

    /// Tells the window something, after from where it comes.
    fn tell(&self, what: &str, [a, b, c, d]: [u32; 4]) {
        let display = self.over.display;
        let data = [self.source, a, b, c, d];
        let event = ClientMessageEvent::new(32, self.over.id, display.atom(what), data);
        let (connection, to) = (&display.connection, self.over.id);
        connection
            .send_event(false, to, EventMask::NO_EVENT, event)
            .unwrap()
            .check()
            .unwrap();
    }

    /// Waits until the window says this, and until then gives it what it asks for.
    fn wait_for(&self, what: &str) {
        let display = self.over.display;
        let (answer, start) = (display.atom(what), Instant::now());
        let (mut answered, mut given) = (false, what != "XdndStatus");
        while !(answered && given) {
            assert!(start.elapsed() < DEADLINE, "{what} did not come");
            match display.connection.poll_for_event().unwrap() {
                Some(Event::ClientMessage(event)) => answered |= event.type_ == answer,
                Some(Event::SelectionRequest(asked)) => {
                    let (to, at, kind) = (asked.requestor, asked.property, asked.target);
                    let bytes = self.list.as_bytes();
                    display
                        .connection
                        .change_property8(PropMode::REPLACE, to, at, kind, bytes)
                        .unwrap();
                    let event = SelectionNotifyEvent {
                        response_type: SELECTION_NOTIFY_EVENT,
                        sequence: 0,
                        time: asked.time,
                        requestor: to,
                        selection: asked.selection,
                        target: kind,
                        property: at,
                    };
                    let none = EventMask::NO_EVENT;
                    display
                        .connection
                        .send_event(false, to, none, event)
                        .unwrap()
                        .check()
                        .unwrap();
                    given = true;
                }
                Some(_) => {}
                None => std::thread::sleep(Duration::from_millis(5)),
            }
        }
    }
}
