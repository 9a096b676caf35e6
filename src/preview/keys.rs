//! What the keys and the mouse do: one table for the window and for the help that F1 shows.

use eframe::egui::{Context, Event, Key, Modifiers};

/// What a key asks for.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Command {
    /// The viewpoint to the right and up, by so many steps.
    Step([f64; 2]),
    /// The viewpoint away from the screen, by so many steps.
    Away(f64),
    /// The viewpoint of the file.
    Reset,
    /// The picture as large as fits.
    Fit,
    /// A pixel of the picture for each of the window.
    OneToOne,
    /// Larger or smaller.
    Zoom(bool),
    /// What decided each pixel, over the picture.
    Verdicts,
    /// The inspector.
    Inspector,
    /// Objects, materials and lights.
    Side,
    /// Lets go of the pixel that is held, closes what is open.
    Escape,
    /// The camera's block to the clipboard.
    CopyCamera,
    /// Takes the last change back.
    Undo,
    /// Does it again.
    Redo,
    /// Another scene.
    Open,
    /// A new scene.
    New,
    /// The changes into the file.
    SaveChanges,
    /// The picture into a file.
    SavePicture,
    /// Reads the file and its textures again.
    Reload,
    /// Light or dark.
    Theme,
    /// This help.
    Help,
    /// Closes the window.
    Quit,
}

/// A key that does something.
pub(super) struct Binding {
    key: Key,
    command: Command,
    with_command: bool,
    with_shift: Option<bool>,
}

const fn key(key: Key, command: Command) -> Binding {
    Binding {
        key,
        command,
        with_command: false,
        with_shift: None,
    }
}

const fn with(key: Key, command: Command) -> Binding {
    Binding {
        key,
        command,
        with_command: true,
        with_shift: None,
    }
}

const fn shift(shift: bool, key: Key, command: Command) -> Binding {
    Binding {
        key,
        command,
        with_command: false,
        with_shift: Some(shift),
    }
}

const fn with_shift(shift: bool, key: Key, command: Command) -> Binding {
    Binding {
        key,
        command,
        with_command: true,
        with_shift: Some(shift),
    }
}

/// All keys. Where the same stands twice, Shift tells them apart.
const BINDINGS: &[Binding] = &[
    shift(false, Key::ArrowLeft, Command::Step([-1.0, 0.0])),
    shift(false, Key::ArrowRight, Command::Step([1.0, 0.0])),
    shift(false, Key::ArrowUp, Command::Step([0.0, 1.0])),
    shift(false, Key::ArrowDown, Command::Step([0.0, -1.0])),
    shift(true, Key::ArrowLeft, Command::Step([-0.1, 0.0])),
    shift(true, Key::ArrowRight, Command::Step([0.1, 0.0])),
    shift(true, Key::ArrowUp, Command::Step([0.0, 0.1])),
    shift(true, Key::ArrowDown, Command::Step([0.0, -0.1])),
    shift(false, Key::PageUp, Command::Away(1.0)),
    shift(false, Key::PageDown, Command::Away(-1.0)),
    shift(true, Key::PageUp, Command::Away(0.1)),
    shift(true, Key::PageDown, Command::Away(-0.1)),
    key(Key::Home, Command::Reset),
    key(Key::R, Command::Reset),
    key(Key::F, Command::Fit),
    key(Key::Num0, Command::Fit),
    key(Key::Num1, Command::OneToOne),
    key(Key::Plus, Command::Zoom(true)),
    key(Key::Equals, Command::Zoom(true)),
    key(Key::Minus, Command::Zoom(false)),
    key(Key::V, Command::Verdicts),
    key(Key::I, Command::Inspector),
    key(Key::O, Command::Side),
    key(Key::Escape, Command::Escape),
    with(Key::C, Command::CopyCamera),
    key(Key::C, Command::CopyCamera),
    with_shift(false, Key::Z, Command::Undo),
    with_shift(true, Key::Z, Command::Redo),
    with(Key::Y, Command::Redo),
    with(Key::O, Command::Open),
    with(Key::N, Command::New),
    with(Key::S, Command::SaveChanges),
    key(Key::P, Command::SavePicture),
    key(Key::F5, Command::Reload),
    key(Key::T, Command::Theme),
    key(Key::F1, Command::Help),
    key(Key::Questionmark, Command::Help),
    with(Key::Q, Command::Quit),
    with(Key::W, Command::Quit),
];

/// What F1 shows: what to press or do, and what it does.
pub(super) const HELP: &[(&str, &str)] = &[
    ("drag", "the viewpoint, x and y"),
    ("wheel", "the viewpoint's z; also Page up, Page down"),
    ("arrows", "steps of the viewpoint; with Shift a tenth"),
    ("R, Home", "the file's viewpoint again"),
    (
        "Ctrl+wheel, + −",
        "zoom, up to 64 times with the bytes of each pixel",
    ),
    ("right or middle drag", "move the enlarged picture"),
    ("F, 0", "the picture as large as fits"),
    ("1", "pixel for pixel"),
    (
        "click",
        "select what is hit, hold the pixel in the inspector; Esc lets go",
    ),
    (
        "drag a handle",
        "move what is selected; with Shift to and fro",
    ),
    ("I", "the inspector: what `plumb probe` tells of a pixel"),
    ("O", "objects, materials, lights"),
    (
        "V",
        "what decided each pixel, as `plumb render --verdicts` paints it",
    ),
    (
        "C",
        "copy the camera, as shown, as a block for a scene file",
    ),
    ("Ctrl+Z", "undo"),
    ("Ctrl+Shift+Z, Ctrl+Y", "redo"),
    ("Ctrl+O, Ctrl+N", "open another scene, begin a new one"),
    ("Ctrl+S", "write what was changed into the scene file"),
    ("P", "save the picture, certified: .png, .ppm or .exr"),
    ("F5", "read the file and its textures again"),
    ("T", "light or dark"),
    ("F1", "this"),
    ("Ctrl+Q", "close"),
];

/// The commands of the keys that were pressed, unless a field of text has them. Those that concern the window as a
/// whole it has not: see [`leaves_field`].
pub(super) fn pressed(context: &Context) -> Vec<Command> {
    if context.egui_wants_keyboard_input() {
        return Vec::new();
    }
    commands(context)
}

/// The commands for the window as a whole where a field of text has the keys. The field is left, so that what was typed
/// counts from the next frame on; the commands are for then.
pub(super) fn leaves_field(context: &Context) -> Vec<Command> {
    let Some(field) = context.memory(|memory| memory.focused()) else {
        return Vec::new();
    };
    let mut commands = commands(context);
    commands.retain(|command| matches!(command, Command::SaveChanges | Command::Quit));
    if !commands.is_empty() {
        context.memory_mut(|memory| memory.surrender_focus(field));
        context.request_repaint();
    }
    commands
}

fn commands(context: &Context) -> Vec<Command> {
    context.input(|input| {
        let asked = |event: &Event| match event {
            // Each key event carries the modifiers of its own moment, as several events may come between two frames.
            Event::Key {
                key,
                pressed: true,
                modifiers,
                ..
            } => command(*key, *modifiers),
            // egui makes an event of its own of Ctrl+C.
            Event::Copy => Some(Command::CopyCamera),
            _ => None,
        };
        input.events.iter().filter_map(asked).collect()
    })
}

/// What a key asks for with these modifiers.
fn command(key: Key, modifiers: Modifiers) -> Option<Command> {
    let asks = |binding: &&Binding| {
        binding.key == key
            && binding.with_command == modifiers.command
            && !modifiers.alt
            && binding
                .with_shift
                .is_none_or(|wanted| wanted == modifiers.shift)
    };
    BINDINGS.iter().find(asks).map(|binding| binding.command)
}

#[cfg(test)]
mod tests {
    use super::*;
    use egui_kittest::Harness;

    fn listening() -> Harness<'static, Vec<Command>> {
        Harness::new_ui_state(
            |ui, commands: &mut Vec<Command>| commands.extend(pressed(ui.ctx())),
            Vec::new(),
        )
    }

    #[test]
    fn every_key_asks_for_what_the_table_says() {
        for binding in BINDINGS {
            let mut harness = listening();
            let modifiers = Modifiers {
                shift: binding.with_shift == Some(true),
                ctrl: binding.with_command,
                command: binding.with_command,
                ..Modifiers::NONE
            };
            harness.key_press_modifiers(modifiers, binding.key);
            harness.run_steps(3);
            assert_eq!(
                *harness.state(),
                [binding.command],
                "{:?} {modifiers:?}",
                binding.key
            );
        }
    }

    /// On a slow machine much happens between two frames.
    #[test]
    fn keys_that_were_struck_between_two_frames_all_count() {
        let mut harness = listening();
        for _ in 0..3 {
            harness.key_press(Key::V);
        }
        harness.key_press_modifiers(Modifiers::COMMAND | Modifiers::CTRL, Key::S);
        harness.event(Event::PointerGone);
        harness.run_steps(8);
        let verdicts = Command::Verdicts;
        assert_eq!(
            *harness.state(),
            [verdicts, verdicts, verdicts, Command::SaveChanges]
        );
    }

    #[test]
    fn with_other_modifiers_keys_ask_for_nothing() {
        let mut harness = listening();
        harness.key_press_modifiers(Modifiers::COMMAND | Modifiers::CTRL, Key::V);
        harness.key_press_modifiers(Modifiers::ALT, Key::R);
        harness.key_press(Key::S);
        harness.run_steps(3);
        assert!(harness.state().is_empty(), "{:?}", harness.state());
    }

    #[test]
    fn a_field_of_text_has_the_keys_for_itself() {
        let mut harness = Harness::new_ui_state(
            |ui, (text, commands): &mut (String, Vec<Command>)| {
                let label = ui.label("text");
                let field = ui.text_edit_singleline(text).labelled_by(label.id);
                field.request_focus();
                commands.extend(pressed(ui.ctx()));
            },
            (String::new(), Vec::new()),
        );
        harness.run_steps(3);
        harness.event(Event::Text("v".into()));
        harness.key_press(Key::V);
        harness.run_steps(3);
        assert_eq!(harness.state().0, "v");
        assert!(harness.state().1.is_empty());
    }

    /// What was typed counts before the window is closed or the file saved.
    #[test]
    fn keys_for_the_whole_window_leave_a_field_of_text() {
        let mut harness = Harness::new_ui_state(
            |ui, (number, commands): &mut (f64, Vec<(f64, Command)>)| {
                let left = leaves_field(ui.ctx());
                let seen = *number;
                commands.extend(left.into_iter().map(|command| (seen, command)));
                let label = ui.label("number");
                let field = eframe::egui::DragValue::new(number).update_while_editing(false);
                ui.add(field).labelled_by(label.id);
            },
            (4.0, Vec::new()),
        );
        harness.run_steps(3);
        let node = egui_kittest::kittest::Queryable::get_by_role(
            &harness,
            eframe::egui::accesskit::Role::SpinButton,
        );
        node.click();
        harness.run_steps(4);
        harness.event(Event::Text("7".into()));
        harness.run_steps(2);
        // A key of the field's own is none of the window's.
        harness.key_press_modifiers(Modifiers::COMMAND | Modifiers::CTRL, Key::Z);
        harness.event(Event::Text("7".into()));
        harness.run_steps(3);
        assert_eq!(harness.state().1, []);
        harness.key_press_modifiers(Modifiers::COMMAND | Modifiers::CTRL, Key::Q);
        harness.run_steps(4);
        assert_eq!(harness.state().1, [(4.0, Command::Quit)]);
        assert!(harness.state().0 > 4.0, "{}", harness.state().0);
        assert!(harness.ctx.memory(|memory| memory.focused()).is_none());
    }

    #[test]
    fn the_help_names_every_key() {
        let help: String = HELP.iter().map(|(what, _)| format!(" {what} ")).collect();
        for binding in BINDINGS {
            let name = match binding.key {
                Key::ArrowLeft | Key::ArrowRight | Key::ArrowUp | Key::ArrowDown => "arrows",
                Key::PageUp | Key::PageDown => continue,
                // These keys are alternatives to keys that are listed.
                Key::Equals | Key::Questionmark | Key::W => continue,
                Key::Plus => "+",
                Key::Minus => "−",
                Key::Num0 => "0",
                Key::Num1 => "1",
                Key::Escape => continue,
                key => key.name(),
            };
            assert!(help.contains(name), "{name}");
        }
    }
}
