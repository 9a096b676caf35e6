//! What the mouse does on the picture: looks around, takes hold of handles, selects.

use eframe::egui::{Pos2, Ui};

use super::App;
use crate::preview::handles::{self, Grabbed};
use crate::preview::picture::Mouse;
use crate::preview::viewport::{self, Placed};

impl App {
    /// Does what the mouse did, and draws the handles of what is selected over the picture, which is placed there.
    pub(super) fn take_mouse(&mut self, ui: &Ui, mouse: &Mouse, placed: &Placed) {
        self.over = mouse.over;
        let scale = f64::from(ui.ctx().pixels_per_point());
        let zoom = placed.zoom / scale;
        let selected = self.side.selection.entity();
        let shown = handles::of(&self.shared.lock().session, selected);
        if let Some(at) = mouse.grabs {
            let state = self.shared.lock();
            self.grabbed = handles::hit(&shown, at, zoom)
                .map(|handle| Grabbed::new(handle, at, &state.session));
        }
        if mouse.dragged != [0.0; 2] {
            match (self.grabbed, mouse.at) {
                (Some(grabbed), Some(at)) => {
                    let depth = ui.input(|input| input.modifiers.shift);
                    let value = grabbed.value(&self.shared.lock().session, at, depth);
                    match value {
                        Some(value) => self.set(grabbed.target(), value),
                        None => self.grabbed = None,
                    }
                }
                (Some(_), None) => {}
                (None, _) => self.move_viewpoint(|viewpoint, scene| {
                    viewport::dragged(&scene.camera, viewpoint, mouse.dragged)
                }),
            }
        }
        if mouse.wheel != 0.0 {
            self.move_viewpoint(|viewpoint, scene| {
                viewport::moved_away(&scene.camera, viewpoint, -mouse.wheel)
            });
        }
        let under = mouse.at.filter(|_| mouse.over.is_some());
        let under = under.and_then(|at| handles::hit(&shown, at, zoom));
        // A handle that is clicked is not what lies behind it.
        if mouse.clicked && under.is_none() {
            let again = self.panel.held == mouse.over;
            self.panel.held = mouse.over.filter(|_| !again);
            self.clicked = self.panel.held;
        }
        let active = self.grabbed.map(|grabbed| grabbed.target());
        let active = active.or(under.map(|handle| handle.target));
        if !mouse.dragging {
            self.grabbed = None;
        }
        self.draw_handles(ui, placed, active);
    }

    fn draw_handles(&self, ui: &Ui, placed: &Placed, active: Option<crate::edit::Target>) {
        let Some(area) = self.area else {
            return;
        };
        let scale = f64::from(ui.ctx().pixels_per_point());
        // As they are after what the mouse did.
        let selected = self.side.selection.entity();
        let shown = handles::of(&self.shared.lock().session, selected);
        let to_window = |at: [f64; 2]| {
            let point =
                |i: usize| ((f64::from(placed.origin[i]) + placed.zoom * at[i]) / scale) as f32;
            Pos2::new(point(0), point(1))
        };
        handles::draw(&ui.painter_at(area), &shown, to_window, active);
    }
}
