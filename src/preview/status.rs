//! The line at the bottom, and the title: what is shown, and how long it took.

use eframe::egui::{self, RichText, Ui};

use super::values::short;
use super::worker::PreviewPicture;
use crate::render::{Backend, Precision};

/// How the picture that is shown came about, in a few words.
pub(super) fn kind(picture: &PreviewPicture) -> String {
    let [width, height] = picture.scene.camera.pixeldim;
    let mut kind = match picture.precision {
        Precision::Certified => String::from("certified"),
        Precision::Fast => String::from("fast"),
    };
    let times = width.div_ceil(picture.pixels.size[0]);
    if times > 1 {
        kind.push_str(&format!(", 1/{times} of the resolution"));
    }
    // Where software is left out that is as it should be.
    if picture.report.backend == Backend::Cpu && picture.report.left_out.is_none() {
        kind.push_str(", on the CPU");
    }
    if picture.whole != [width, height] {
        let [width, height] = picture.whole;
        kind.push_str(&format!(", smaller than its {width}×{height}"));
    }
    kind
}

/// What the status line says of a picture.
pub(super) fn figures(picture: &PreviewPicture) -> String {
    let report = &picture.report;
    let [width, height] = [report.width, report.height];
    let rate = report.pixels as f64 / report.seconds.total.max(1e-9) * 1e-6;
    let mut text = format!(
        "{width}×{height} in {:.0} ms, {} Mpixel/s",
        1e3 * report.seconds.total,
        short((rate * 10.0).round() / 10.0)
    );
    if picture.precision == Precision::Certified && report.backend == Backend::Gpu {
        text.push_str(&format!(
            ", {} % decided on the CPU",
            short((report.refined_percent * 1000.0).round() / 1000.0)
        ));
    }
    text
}

/// What else is to be said of a picture, if anything: why the CPU rendered, what is not proven.
pub(super) fn remarks(picture: &PreviewPicture) -> Vec<String> {
    let report = &picture.report;
    let mut remarks: Vec<String> = report.fallback.iter().cloned().collect();
    if let Some(revoked) = &report.revoked {
        remarks.push(format!("{revoked}: the CPU rendered the picture again"));
    }
    if report.presumed > 0 {
        remarks.push(format!(
            "{} pixels are presumed to lie on a border, not proven",
            report.presumed
        ));
    }
    remarks
}

/// What the line shows besides the picture.
#[derive(Debug, Default)]
pub(super) struct Line {
    /// What is being done, if anything.
    pub(super) doing: Option<String>,
    /// Pixels of the window for each of the picture.
    pub(super) zoom: f64,
    /// How many pictures a second are shown, while the view moves.
    pub(super) frames: Option<f64>,
    /// The pixel under the cursor, and its bytes.
    pub(super) pixel: Option<([u32; 2], [u8; 3])>,
    /// The options that it is rendered with, if any.
    pub(super) rendering: String,
    /// Whether the file has not what is shown.
    pub(super) trouble: bool,
    /// The last thing that was said.
    pub(super) said: Option<String>,
}

/// Where there are fewer points across than this, the line has the most important things only.
const ROOM: f32 = 640.0;

/// Shows the line. Whether the help was asked for.
pub(super) fn show(ui: &mut Ui, picture: Option<&PreviewPicture>, line: &Line) -> bool {
    let is_narrow = ui.available_width() < ROOM;
    let mut help = false;
    // The button comes first: what is too long is cut off, and it is not.
    ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), |ui| {
        let keys = if is_narrow { "F1" } else { "F1 keys" };
        help = ui.small_button(keys).clicked();
        ui.with_layout(egui::Layout::left_to_right(egui::Align::Center), |ui| {
            if let Some(picture) = picture {
                of_picture(ui, picture, line, is_narrow);
            }
            if let Some(doing) = &line.doing {
                separate(ui, picture.is_some());
                ui.add(egui::Label::new(doing).truncate());
            }
            if let Some(frames) = line.frames {
                ui.label(format!("{frames:.0} pictures/s"));
            }
            if picture.is_some() && !is_narrow {
                ui.separator();
                ui.label(zoom(line.zoom));
            }
            if let Some(([x, y], [r, g, b])) = line.pixel {
                ui.separator();
                ui.monospace(format!("({x}, {y})  {r} {g} {b}"));
            }
            if let Some(said) = &line.said {
                separate(ui, picture.is_some() || line.doing.is_some());
                ui.add(egui::Label::new(said).truncate())
                    .on_hover_text(said);
            }
        });
    });
    help
}

fn separate(ui: &mut Ui, is_needed: bool) {
    if is_needed {
        ui.separator();
    }
}

/// How the picture came about.
fn of_picture(ui: &mut Ui, picture: &PreviewPicture, line: &Line, is_narrow: bool) {
    let certified = picture.precision == Precision::Certified;
    // What is certified of the picture is not so of the file.
    let kind = if line.trouble {
        "the last good picture".to_owned()
    } else {
        kind(picture)
    };
    let kind = RichText::new(kind).strong();
    let color = if certified && !line.trouble {
        ui.visuals().strong_text_color()
    } else {
        ui.visuals().warn_fg_color
    };
    let shown = ui.label(kind.color(color));
    let figures = figures(picture);
    let remarks = remarks(picture);
    if is_narrow {
        shown.on_hover_text([vec![figures], remarks.clone()].concat().join("\n"));
    } else {
        if !line.rendering.is_empty() {
            ui.label(&line.rendering);
        }
        let figures = ui.label(figures);
        if !remarks.is_empty() {
            figures.on_hover_text(remarks.join("\n"));
        }
    }
    if !remarks.is_empty() {
        let mark = RichText::new("!").strong();
        ui.label(mark.color(ui.visuals().warn_fg_color))
            .on_hover_text(remarks.join("\n"));
    }
}

fn zoom(zoom: f64) -> String {
    if zoom >= 1.0 {
        format!("{}:1", short(zoom))
    } else {
        format!("{} %", short((zoom * 1000.0).round() / 10.0))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use egui_kittest::Harness;
    use egui_kittest::kittest::Queryable as _;

    fn shown(width: f32, line: Line) -> Harness<'static> {
        let mut harness = Harness::builder()
            .with_size([width, 40.0])
            .build_ui(move |ui| {
                show(ui, None, &line);
            });
        harness.run_steps(3);
        harness
    }

    #[test]
    fn without_a_picture_nothing_is_said_of_one() {
        let harness = shown(900.0, Line::default());
        harness.get_by_label("F1 keys");
        assert!(harness.query_by_label("1:1").is_none());
        assert!(harness.query_by_label_contains("picture").is_none());
    }

    #[test]
    fn what_is_long_is_cut_off_and_the_button_is_not() {
        for width in [320.0, 420.0] {
            let long = "saved 12 changes into a_scene_with_a_long_name.txt, ".repeat(4);
            let harness = shown(
                width,
                Line {
                    doing: Some("rendering 40 %, about 1.2 s left".into()),
                    said: Some(long.clone()),
                    ..Line::default()
                },
            );
            let button = harness.get_by_label("F1").rect();
            assert!(
                button.right() <= width && button.left() > 0.8 * width,
                "{button}"
            );
            let said = harness.get_by_label(&long).rect();
            assert!(said.right() <= button.left(), "{said} {button}");
        }
    }
}
