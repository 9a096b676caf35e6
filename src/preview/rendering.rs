//! How the picture is rendered, as far as it can be changed in the window: the options of `plumb render` of the same
//! names. They are not in the scene's file, and so no changes to be saved into it.

use eframe::egui::{self, Ui};

use super::values::short;
use crate::settings::{Limits, MAX_SAMPLES, SamplePattern, Settings};

/// What can be changed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Rendering {
    /// Rays a pixel.
    pub(super) samples: u32,
    /// How several of them are spread.
    pub(super) jitter: SamplePattern,
    /// τ: planes count only where z ≤ τ.
    pub(super) screen_tolerance: f64,
    /// A ray that starts farther than this along its path brings nothing.
    pub(super) max_path: f64,
}

impl Default for Rendering {
    fn default() -> Self {
        Self::of(&Settings::default())
    }
}

impl Rendering {
    /// What the settings say.
    pub(super) fn of(settings: &Settings) -> Self {
        Self {
            samples: settings.samples,
            jitter: settings.jitter,
            screen_tolerance: settings.screen_tolerance,
            max_path: settings.limits.max_path,
        }
    }

    /// The settings with this.
    pub(super) fn over(self, settings: &Settings) -> Settings {
        let Self {
            samples,
            jitter,
            screen_tolerance,
            max_path,
        } = self;
        Settings {
            samples,
            jitter,
            screen_tolerance,
            limits: Limits {
                max_path,
                ..settings.limits
            },
            ..settings.clone()
        }
    }

    /// The options that say the same on the command line; empty where all is as it is without options.
    pub(super) fn options(self) -> String {
        let usual = Self::default();
        let mut options = Vec::new();
        if self.samples != usual.samples {
            options.push(format!("--samples {}", self.samples));
        }
        if self.samples > 1 && self.jitter == SamplePattern::Course {
            options.push("--jitter course".to_owned());
        }
        if self.screen_tolerance != usual.screen_tolerance {
            options.push(format!("--screen-tolerance {}", self.screen_tolerance));
        }
        if self.max_path != usual.max_path {
            options.push(format!("--max-path {}", self.max_path));
        }
        options.join(" ")
    }

    /// Why a picture of so many columns cannot be rendered so.
    pub(super) fn fault(self, width: u32) -> Option<String> {
        self.over(&Settings::default()).fault(width)
    }

    /// Shows it, to be dragged or typed; what it is after that.
    pub(super) fn show(mut self, ui: &mut Ui, unit: f64) -> Self {
        egui::Grid::new("rendering")
            .num_columns(2)
            .show(ui, |ui| self.rows(ui, unit));
        self
    }

    fn rows(&mut self, ui: &mut Ui, unit: f64) {
        let label = ui.label("samples");
        let samples = egui::DragValue::new(&mut self.samples)
            .range(1..=MAX_SAMPLES)
            .speed(0.1);
        ui.add(samples)
            .labelled_by(label.id)
            .on_hover_text("rays a pixel, whose mean is taken; 16 is plenty for most pictures");
        ui.end_row();
        if self.samples > 1 {
            ui.label("spread by");
            ui.horizontal(|ui| {
                for (pattern, name) in [
                    (SamplePattern::Hash, "hash"),
                    (SamplePattern::Course, "course"),
                ] {
                    ui.selectable_value(&mut self.jitter, pattern, name)
                        .on_hover_text(pattern.meaning());
                }
            });
            ui.end_row();
        }
        let label = ui.label("screen tolerance");
        let tolerance = egui::DragValue::new(&mut self.screen_tolerance)
            .range(-f64::MAX..=f64::MAX)
            .speed(unit / 1000.0)
            .max_decimals(12)
            .custom_formatter(|number, _| short(number));
        ui.add(tolerance)
            .labelled_by(label.id)
            .on_hover_text("all but spheres counts only where z ≤ this; 0 in the notes");
        ui.end_row();
        let label = ui.label("longest path");
        let path = egui::DragValue::new(&mut self.max_path)
            .range(0.0..=f64::MAX)
            .speed(unit / 40.0)
            .max_decimals(12)
            .custom_formatter(|number, _| short(number));
        ui.add(path).labelled_by(label.id).on_hover_text(
            "mirror images and what is seen through things end after this path, in world units",
        );
        ui.end_row();
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use egui_kittest::Harness;
    use egui_kittest::kittest::Queryable as _;

    #[test]
    fn what_is_shown_are_the_options_of_the_command_line() {
        let usual = Rendering::default();
        assert_eq!(usual.options(), "");
        let all = Rendering {
            samples: 16,
            jitter: SamplePattern::Course,
            screen_tolerance: 0.01,
            max_path: 3.5,
        };
        assert_eq!(
            all.options(),
            "--samples 16 --jitter course --screen-tolerance 0.01 --max-path 3.5"
        );
        assert_eq!(Rendering::of(&all.over(&Settings::default())), all);
        // The spread of a single sample is none.
        assert_eq!(
            Rendering { samples: 1, ..all }.options(),
            "--screen-tolerance 0.01 --max-path 3.5"
        );
        assert_eq!(all.fault(640), None);
        let many = Rendering {
            samples: MAX_SAMPLES,
            ..all
        };
        assert!(
            many.fault(640)
                .is_some_and(|why| why.contains("65536 samples"))
        );
        assert_eq!(
            Rendering {
                jitter: SamplePattern::Hash,
                ..many
            }
            .fault(640),
            None
        );
    }

    #[test]
    fn numbers_are_typed_within_their_limits() {
        let mut harness = Harness::new_ui_state(
            |ui, rendering: &mut Rendering| *rendering = rendering.show(ui, 8.0),
            Rendering::default(),
        );
        let mut typed = |label: &str, text: &str| {
            harness.get_by_label(label).click();
            harness.run_steps(4);
            harness.event(egui::Event::Text(text.into()));
            harness.run_steps(2);
            harness.key_press(egui::Key::Enter);
            harness.run_steps(4);
            *harness.state()
        };
        assert_eq!(typed("samples", "0").samples, 1);
        assert_eq!(typed("samples", "70000").samples, MAX_SAMPLES);
        assert_eq!(typed("samples", "4").samples, 4);
        assert_eq!(typed("screen tolerance", "0.01").screen_tolerance, 0.01);
        assert_eq!(typed("longest path", "-3").max_path, 0.0);
        assert_eq!(typed("longest path", "2.5").max_path, 2.5);
        harness.get_by_label("course").click();
        harness.run_steps(4);
        assert_eq!(harness.state().jitter, SamplePattern::Course);
    }
}
