//! What lies over the picture: the file's trouble, the help, and where to save the picture.

use eframe::egui::{self, Align2, Context, RichText, Ui};

use super::keys::HELP;
use super::session::{Mistakes, Trouble};

/// Shows what is wrong with the file, over the upper part of the picture, which stays.
pub(super) fn trouble(ui: &mut Ui, area: egui::Rect, trouble: &Trouble, picture: bool) {
    let (title, text) = match trouble {
        Trouble::Mistakes(Mistakes { count, text }) => {
            let title = match count {
                1 => "The file has a mistake".to_owned(),
                count => format!("The file has {count} mistakes"),
            };
            (title, text.as_str())
        }
        Trouble::Gone => (
            "The file is gone".to_owned(),
            "It is shown again once it is back.",
        ),
        Trouble::Unreadable(why) => ("The file cannot be read".to_owned(), why.as_str()),
    };
    let title = if picture {
        format!("{title}: this is its last good picture")
    } else {
        title
    };
    notice(ui, area, &title, text);
}

/// Shows that something is wrong, over the upper part of the picture.
pub(super) fn notice(ui: &mut Ui, area: egui::Rect, title: &str, text: &str) {
    let color = ui.visuals().error_fg_color;
    egui::Area::new(area_of(title, text))
        .fixed_pos(area.left_top() + egui::vec2(8.0, 8.0))
        .constrain_to(area)
        .order(egui::Order::Middle)
        .show(ui.ctx(), |ui| {
            egui::Frame::popup(ui.style())
                .stroke(egui::Stroke::new(2.0, color))
                .show(ui, |ui| {
                    ui.set_max_width(area.width() - 40.0);
                    ui.label(RichText::new(title).strong().color(color));
                    egui::ScrollArea::both()
                        .max_height(area.height() * 0.6)
                        .show(ui, |ui| {
                            ui.add(egui::Label::new(RichText::new(text).monospace()).extend());
                        });
                });
        });
}

/// The area for a text. Each has its own: an area stays as large as it was for what was in it first.
fn area_of(title: &str, text: &str) -> egui::Id {
    egui::Id::unique(("trouble", title, text))
}

/// Shows what keys and mouse do.
pub(super) fn help(context: &Context, open: &mut bool) {
    egui::Window::new("Keys and mouse")
        .open(open)
        .collapsible(false)
        .resizable(false)
        .anchor(Align2::CENTER_CENTER, [0.0, 0.0])
        .show(context, |ui| {
            egui::Grid::new("keys").num_columns(2).show(ui, |ui| {
                for (what, does) in HELP {
                    ui.label(RichText::new(*what).strong());
                    ui.label(*does);
                    ui.end_row();
                }
            });
        });
}

/// What to do with changes when the window is to be closed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Leaving {
    /// Write them into the file, then close.
    Save,
    /// Close without.
    Lose,
    /// Not to close.
    Stay,
}

/// Asks what to do with so many changes; none as long as there is no answer.
///
/// `opens`: it is another scene that is to be opened, and not the window that is to be closed.
pub(super) fn leaving(
    context: &Context,
    changes: usize,
    name: &str,
    opens: bool,
) -> Option<Leaving> {
    let mut chosen = None;
    let (title, save, lose) = if opens {
        ("Open another scene?", "Save and open", "Open without")
    } else {
        ("Close the window?", "Save and close", "Close without")
    };
    // Nothing else can be done meanwhile.
    egui::Modal::new(egui::Id::unique("close")).show(context, |ui| {
        ui.heading(title);
        ui.label(match changes {
            1 => format!("A change is not in {name}."),
            changes => format!("{changes} changes are not in {name}."),
        });
        ui.horizontal(|ui| {
            for (text, choice) in [
                (save, Leaving::Save),
                (lose, Leaving::Lose),
                ("Stay", Leaving::Stay),
            ] {
                let button = ui.button(text);
                // The keyboard is the question's, and begins where nothing is lost.
                if choice == Leaving::Save && ui.memory(|memory| memory.focused().is_none()) {
                    button.request_focus();
                }
                if button.clicked() {
                    chosen = Some(choice);
                }
            }
        });
        if ui.input(|input| input.key_pressed(egui::Key::Escape)) {
            chosen = Some(Leaving::Stay);
        }
    });
    chosen
}

/// Where to save the picture.
#[derive(Debug, Default)]
pub(super) struct SaveAs {
    /// The name as it is typed.
    pub(super) name: String,
    /// Whether the field has to be given the keyboard.
    fresh: bool,
}

/// What came of asking.
#[derive(Debug, PartialEq, Eq)]
pub(super) enum Chosen {
    /// Nothing yet.
    Open,
    /// To save there.
    Save,
    /// Not to save.
    Cancel,
}

impl SaveAs {
    /// With a name to begin with.
    pub(super) fn new(name: String) -> Self {
        Self { name, fresh: true }
    }

    /// Asks where to.
    pub(super) fn show(&mut self, context: &Context) -> Chosen {
        let mut open = true;
        let mut chosen = Chosen::Open;
        egui::Window::new("Save the picture, certified")
            .open(&mut open)
            .collapsible(false)
            .resizable(false)
            .anchor(Align2::CENTER_CENTER, [0.0, 0.0])
            .show(context, |ui| {
                let label = ui.label(
                    "Its name ends in .png, .ppm or .exr (the values before they become bytes):",
                );
                let field = egui::TextEdit::singleline(&mut self.name).desired_width(420.0);
                let field = ui.add(field).labelled_by(label.id);
                if std::mem::take(&mut self.fresh) {
                    field.request_focus();
                }
                let entered =
                    field.lost_focus() && ui.input(|input| input.key_pressed(egui::Key::Enter));
                ui.horizontal(|ui| {
                    if ui.button("Save").clicked() || entered {
                        chosen = Chosen::Save;
                    }
                    if ui.button("Cancel").clicked()
                        || ui.input(|input| input.key_pressed(egui::Key::Escape))
                    {
                        chosen = Chosen::Cancel;
                    }
                });
            });
        if open { chosen } else { Chosen::Cancel }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use egui_kittest::Harness;
    use egui_kittest::kittest::Queryable as _;

    #[test]
    fn trouble_shows_what_is_wrong() {
        for (trouble_of_file, words) in [
            (
                Trouble::Mistakes(Mistakes {
                    count: 1,
                    text: "error: 3:1\n  ^".into(),
                }),
                "error: 3:1\n  ^",
            ),
            (Trouble::Gone, "It is shown again once it is back."),
            (Trouble::Unreadable("no rights".into()), "no rights"),
        ] {
            for picture in [true, false] {
                let shown = trouble_of_file.clone();
                let mut harness = Harness::new_ui(move |ui| {
                    trouble(ui, ui.max_rect(), &shown, picture);
                });
                harness.run_steps(3);
                harness.get_by_label(words);
                let last = harness.query_by_label_contains("last good picture");
                assert_eq!(last.is_some(), picture);
            }
        }
    }

    #[test]
    fn what_becomes_of_changes_is_asked_for() {
        for (button, answer, opens) in [
            ("Save and close", Leaving::Save, false),
            ("Close without", Leaving::Lose, false),
            ("Stay", Leaving::Stay, false),
            ("Save and open", Leaving::Save, true),
            ("Open without", Leaving::Lose, true),
            ("Stay", Leaving::Stay, true),
        ] {
            let mut harness = Harness::new_ui_state(
                move |ui, chosen: &mut Option<Leaving>| {
                    *chosen = chosen.or(leaving(ui.ctx(), 3, "room.txt", opens));
                },
                None,
            );
            harness.run_steps(3);
            harness.get_by_label("3 changes are not in room.txt.");
            assert_eq!(*harness.state(), None);
            harness.get_by_label(button).click();
            harness.run_steps(3);
            assert_eq!(*harness.state(), Some(answer));
        }
    }

    /// An area remembers its size; a longer text must not be cut to it.
    #[test]
    fn a_longer_mistake_after_a_short_one_is_seen_whole() {
        let mut harness = Harness::builder().with_size([600.0, 400.0]).build_ui_state(
            |ui, text: &mut String| notice(ui, ui.max_rect(), "title", text),
            String::from("short"),
        );
        harness.run();
        let long = "1\n2\n3\n4\n5\n6\n7\n8";
        *harness.state_mut() = long.into();
        harness.run();
        let label = harness.get_by_label(long).rect();
        let area = harness
            .ctx
            .memory(|memory| memory.area_rect(area_of("title", long)));
        let area = area.unwrap();
        assert!(area.contains_rect(label), "{label} is not in {area}");
    }

    fn asking(name: &str) -> Harness<'static, (SaveAs, Chosen)> {
        let state = (SaveAs::new(name.into()), Chosen::Open);
        let mut harness = Harness::new_ui_state(
            |ui, (dialog, chosen): &mut (SaveAs, Chosen)| {
                if *chosen == Chosen::Open {
                    *chosen = dialog.show(ui.ctx());
                }
            },
            state,
        );
        harness.run_steps(3);
        harness
    }

    #[test]
    fn the_name_of_a_picture_is_asked_for() {
        let mut harness = asking("room.png");
        assert_eq!(harness.state().1, Chosen::Open);
        harness.event(egui::Event::Text("x".into()));
        harness.run_steps(3);
        harness.key_press(egui::Key::Enter);
        harness.run_steps(3);
        assert_eq!(
            (&*harness.state().0.name, &harness.state().1),
            ("room.pngx", &Chosen::Save)
        );
        let mut harness = asking("room.png");
        harness.get_by_label("Save").click();
        harness.run_steps(3);
        assert_eq!(harness.state().1, Chosen::Save);
        let mut harness = asking("room.png");
        harness.key_press(egui::Key::Escape);
        harness.run_steps(3);
        assert_eq!(harness.state().1, Chosen::Cancel);
    }
}
