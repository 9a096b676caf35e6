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
    if picture.report.backend == Backend::Cpu {
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

/// Shows the line. Whether the help was asked for.
pub(super) fn show(ui: &mut Ui, picture: Option<&PreviewPicture>, line: &Line) -> bool {
    let mut help = false;
    ui.horizontal(|ui| {
        match picture {
            Some(picture) => {
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
                ui.label(kind.color(color));
                if !line.rendering.is_empty() {
                    ui.label(&line.rendering);
                }
                let figures = ui.label(figures(picture));
                let remarks = remarks(picture);
                if !remarks.is_empty() {
                    ui.label(
                        RichText::new("!")
                            .strong()
                            .color(ui.visuals().warn_fg_color),
                    )
                    .on_hover_text(remarks.join("\n"));
                    figures.on_hover_text(remarks.join("\n"));
                }
            }
            None => {
                ui.label("no picture yet");
            }
        }
        if let Some(doing) = &line.doing {
            ui.separator();
            ui.label(doing);
        }
        if let Some(frames) = line.frames {
            ui.label(format!("{frames:.0} pictures/s"));
        }
        ui.separator();
        ui.label(zoom(line.zoom));
        if let Some(([x, y], [r, g, b])) = line.pixel {
            ui.separator();
            ui.monospace(format!("({x}, {y})  {r} {g} {b}"));
        }
        ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), |ui| {
            help = ui.small_button("F1 keys").clicked();
            if let Some(said) = &line.said {
                ui.add(egui::Label::new(said).truncate())
                    .on_hover_text(said);
            }
        });
    });
    help
}

fn zoom(zoom: f64) -> String {
    if zoom >= 1.0 {
        format!("{}:1", short(zoom))
    } else {
        format!("{} %", short((zoom * 1000.0).round() / 10.0))
    }
}
