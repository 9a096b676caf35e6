//! What the other tests rely on, tried on a window whose every pixel is known: this program itself, started once more.

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::process::Command;
use std::time::Duration;

use image::{Rgb, RgbImage};
use x11rb::connection::Connection;
use x11rb::protocol::Event;
use x11rb::protocol::xproto::{
    AtomEnum, ChangeGCAux, ConnectionExt as _, CreateGCAux, CreateWindowAux, EventMask, PropMode,
    Rectangle, SELECTION_NOTIFY_EVENT, SelectionNotifyEvent, WindowClass,
};
use x11rb::wrapper::ConnectionExt as _;

use crate::program::Program;
use crate::x11::{Display, LEFT, keys};

const GROUND: Rgb<u8> = Rgb([17, 130, 250]);
const MARK: Rgb<u8> = Rgb([251, 64, 3]);
/// Left, top, width, height of the mark.
const MARKED: [u32; 4] = [20, 10, 30, 15];
const SIZE: (u32, u32) = (200, 120);

/// What the client copies.
const COPIED: &str = "two lines\nand an é";

/// Set where this program is the one that is tested.
const CLIENT: &str = "PLUMB_TEST_CLIENT";

/// Long enough for what comes, short enough to wait for what does not.
const SOON: Duration = Duration::from_secs(1);

/// What the window looks like.
fn expected((width, height): (u32, u32)) -> RgbImage {
    let [left, top, across, down] = MARKED;
    RgbImage::from_fn(width, height, |x, y| {
        let marked = (left..left + across).contains(&x) && (top..top + down).contains(&y);
        if marked { MARK } else { GROUND }
    })
}

/// This program, to run [`the_client`].
fn client() -> Command {
    let mut command = Command::new(std::env::current_exe().unwrap());
    command.env(CLIENT, "1");
    command.args(["--ignored", "--exact", "harness::the_client", "--nocapture"]);
    command
}

#[test]
#[ignore = "what the tests start"]
fn the_client() {
    if std::env::var_os(CLIENT).is_none() {
        return;
    }
    let (connection, screen) = x11rb::connect(None).unwrap();
    let screen = &connection.setup().roots[screen];
    let window = connection.generate_id().unwrap();
    let events = EventMask::EXPOSURE
        | EventMask::STRUCTURE_NOTIFY
        | EventMask::KEY_PRESS
        | EventMask::BUTTON_PRESS
        | EventMask::BUTTON_RELEASE
        | EventMask::BUTTON1_MOTION;
    let pixel = |c: Rgb<u8>| u32::from_be_bytes([0, c[0], c[1], c[2]]);
    let aux = CreateWindowAux::new()
        .event_mask(events)
        .background_pixel(pixel(GROUND));
    let (width, height) = (SIZE.0 as u16, SIZE.1 as u16);
    let class = WindowClass::INPUT_OUTPUT;
    connection
        .create_window(
            0,
            window,
            screen.root,
            30,
            40,
            width,
            height,
            0,
            class,
            0,
            &aux,
        )
        .unwrap();
    let atom = |name: &str| {
        let cookie = connection.intern_atom(false, name.as_bytes()).unwrap();
        cookie.reply().unwrap().atom
    };
    let set = |name, kind: AtomEnum, value: u32| {
        connection
            .change_property32(PropMode::REPLACE, window, atom(name), kind, &[value])
            .unwrap();
    };
    set("_NET_WM_PID", AtomEnum::CARDINAL, std::process::id());
    set("WM_PROTOCOLS", AtomEnum::ATOM, atom("WM_DELETE_WINDOW"));
    let context = connection.generate_id().unwrap();
    connection
        .create_gc(context, window, &CreateGCAux::new())
        .unwrap();
    connection.map_window(window).unwrap();
    eprintln!("the client says this");

    let first = connection.setup().min_keycode;
    let map = connection.get_keyboard_mapping(first, 248).unwrap().reply();
    let map = map.unwrap();
    // What happened, told in the title.
    let mut title = String::from("client");
    loop {
        let name = atom("_NET_WM_NAME");
        let kind = atom("UTF8_STRING");
        connection
            .change_property8(PropMode::REPLACE, window, name, kind, title.as_bytes())
            .unwrap();
        connection.flush().unwrap();
        let told = match connection.wait_for_event().unwrap() {
            Event::Expose(_) => {
                let [x, y, width, height] = MARKED.map(|n| n as u16);
                let mark = Rectangle {
                    x: x as i16,
                    y: y as i16,
                    width,
                    height,
                };
                let colour = ChangeGCAux::new().foreground(pixel(MARK));
                connection.change_gc(context, &colour).unwrap();
                connection
                    .poly_fill_rectangle(window, context, &[mark])
                    .unwrap();
                continue;
            }
            Event::KeyPress(event) => {
                let place = usize::from(event.detail - first);
                let shift = usize::from(u16::from(event.state) & 1);
                let keysym = map.keysyms[place * usize::from(map.keysyms_per_keycode) + shift];
                match char::from_u32(keysym) {
                    Some('c') => {
                        let time = event.time;
                        connection
                            .set_selection_owner(window, atom("CLIPBOARD"), time)
                            .unwrap();
                        String::from("copied")
                    }
                    Some('q') => std::process::exit(7),
                    Some('z') => panic!("told to"),
                    Some(c @ ' '..='~') => format!("{c}/{}", u16::from(event.state)),
                    _ => format!("{keysym:x}/{}", u16::from(event.state)),
                }
            }
            Event::SelectionRequest(asked) => {
                let bytes = COPIED.as_bytes();
                let (to, at, kind) = (asked.requestor, asked.property, asked.target);
                connection
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
                connection
                    .send_event(false, to, EventMask::NO_EVENT, event)
                    .unwrap();
                continue;
            }
            Event::ButtonPress(e) => format!("+{}@{},{}", e.detail, e.event_x, e.event_y),
            Event::ButtonRelease(e) => format!("-{}@{},{}", e.detail, e.event_x, e.event_y),
            Event::MotionNotify(e) => format!("~{},{}", e.event_x, e.event_y),
            Event::ConfigureNotify(e) => {
                title = format!("{}x{}", e.width, e.height);
                continue;
            }
            Event::ClientMessage(e) if e.data.as_data32()[0] == atom("WM_DELETE_WINDOW") => return,
            _ => continue,
        };
        title = format!("{title} {told}");
    }
}

/// Why something panics.
fn complaint(body: impl FnOnce()) -> String {
    let panic = catch_unwind(AssertUnwindSafe(body)).expect_err("it has to complain");
    *panic.downcast::<String>().unwrap()
}

#[test]
fn pixels_are_read_back_as_they_are() {
    let display = Display::start(640, 480);
    let mut client = Program::start(&display, client());
    let shot = client.wait_for("the colours", |shot| *shot == expected(SIZE));
    assert_eq!(shot.dimensions(), SIZE);
    // It moves to the corner, and is drawn anew.
    client.window.resize(333, 77);
    client.wait("its size", |window| {
        (window.size() == (333, 77)).then_some(())
    });
    client.wait_for("the colours", |shot| *shot == expected((333, 77)));
    client.wait("its title", |window| {
        (window.title() == "333x77").then_some(())
    });
    let ended = client.close();
    assert!(ended.status.success());
    assert!(ended.said.contains("the client says this"));
}

#[test]
fn other_pixels_are_noticed_and_saved() {
    let display = Display::start(640, 480);
    let mut client = Program::start_within(SOON, &display, client());
    client.wait_for("the colours", |shot| *shot == expected(SIZE));
    // One pixel is another, or colours are the wrong way round, or all is one pixel aside.
    let mut other = expected(SIZE);
    other.get_pixel_mut(49, 24)[2] ^= 1;
    let mut swapped = expected(SIZE);
    swapped.pixels_mut().for_each(|p| p.0.reverse());
    let mut aside = expected(SIZE);
    image::imageops::replace(&mut aside, &expected(SIZE), 1, 0);
    for wrong in [other, swapped, aside] {
        let why = complaint(|| drop(client.wait_for("a wrong picture", |shot| *shot == wrong)));
        let (_, rest) = why
            .split_once("a wrong picture did not come (see ")
            .unwrap();
        let (file, rest) = rest.split_once("), title \"").unwrap();
        assert!(rest.contains("the client says this"), "{rest}");
        let saved = image::open(file).unwrap().into_rgb8();
        assert!(saved == expected(SIZE), "what is saved is what was seen");
    }
}

#[test]
fn keys_and_mouse_arrive() {
    let display = Display::start(640, 480);
    let mut client = Program::start(&display, client());
    let window = client.window;
    let mut expect = |what: &str, events: &str| {
        client.wait(&format!("{what}: {events}"), |window| {
            window.title().ends_with(events).then_some(())
        });
    };
    window.focus();
    window.key('a'.into(), &[]);
    expect("a key", "client a/0");
    window.type_text("bC?\n");
    // 1: with Shift held.
    expect("text", "a/0 b/0 ffe1/0 C/1 ffe1/0 ?/1 ff0d/0");
    // 4: with Control held, 8: with Alt.
    window.key(keys::LEFT, &[keys::CONTROL, keys::ALT]);
    expect("a key with others", "ffe3/0 ffe9/4 ff51/12");
    window.click(50, 60);
    expect("a click", "+1@50,60 -1@50,60");
    window.drag(LEFT, (10, 20), (40, 80), 3);
    expect("a drag", "+1@10,20 ~20,40 ~30,60 ~40,80 -1@40,80");
    window.wheel(2);
    window.wheel(-1);
    expect(
        "the wheel",
        "+4@40,80 -4@40,80 +4@40,80 -4@40,80 +5@40,80 -5@40,80",
    );
}

#[test]
fn what_is_copied_can_be_read() {
    let display = Display::start(640, 480);
    assert_eq!(display.clipboard(), None);
    let mut client = Program::start(&display, client());
    client.window.focus();
    client.window.key('c'.into(), &[]);
    client.wait("its word", |window| {
        window.title().ends_with("copied").then_some(())
    });
    assert_eq!(display.clipboard().as_deref(), Some(COPIED));
}

#[test]
fn an_end_is_noticed() {
    let display = Display::start(640, 480);
    // By itself, with a code.
    let first = Program::start(&display, client());
    first.window.focus();
    first.window.key('q'.into(), &[]);
    assert_eq!(first.end().status.code(), Some(7));
    // While something else is waited for.
    let mut second = Program::start(&display, client());
    assert!(second.memory() > 100, "a program has memory");
    second.window.focus();
    second.window.key('z'.into(), &[]);
    let why = complaint(|| second.wait("better weather", |_| None));
    assert!(
        why.contains("better weather was waited for, but it ended with exit status: 101"),
        "{why}"
    );
    assert!(why.contains("told to"), "{why}");
    // Before there is a window.
    let mut none = Command::new("sh");
    none.args(["-c", "echo no window here >&2; exit 3"]);
    let why = complaint(|| drop(Program::start(&display, none)));
    assert!(why.contains("exit status: 3"), "{why}");
    assert!(why.contains("no window here"), "{why}");
}

#[test]
fn without_a_server_it_says_what_to_install() {
    let why = complaint(|| drop(Display::start_with("no-such-Xvfb", 64, 64)));
    assert!(why.contains("package xvfb"), "{why}");
    // One that ends at once.
    let why = complaint(|| drop(Display::start_with("false", 64, 64)));
    assert!(why.contains("Xvfb does not start: "), "{why}");
}
