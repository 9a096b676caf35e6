//! The picture in the middle of the window: drawn, dragged, zoomed, with the bytes of enlarged pixels.

use std::sync::Arc;

use eframe::egui::{self, Align2, Color32, FontId, PointerButton, Pos2, Rect, Sense, Ui};

use super::draw::{Draw, Outlined};
use super::screen;
use super::viewport::{Area, Placed, Viewport};
use super::worker::PreviewPicture;

/// Pixels of the picture show their bytes where they are at least so many points large.
const LABELLED: f64 = 30.0;

/// What the mouse did on the picture.
#[derive(Debug, Default, Clone, Copy, PartialEq)]
pub(super) struct Mouse {
    /// The viewpoint was dragged by so many pixels of the picture, to the right and down.
    pub(super) dragged: [f64; 2],
    /// The wheel was turned so many notches away from the user.
    pub(super) wheel: f64,
    /// The pixel under the cursor: column, and row from the bottom.
    pub(super) over: Option<[u32; 2]>,
    /// Whether it was clicked.
    pub(super) clicked: bool,
    /// Where the mouse is: columns from the left and rows from the top, with fractions, also beside the picture.
    pub(super) at: Option<[f64; 2]>,
    /// Where the button went down that begins to drag now, likewise.
    pub(super) grabs: Option<[f64; 2]>,
    /// Whether the button that drags the viewpoint is still down.
    pub(super) dragging: bool,
}

/// How the picture is shown.
#[derive(Debug, Default)]
pub(super) struct Showing {
    /// Where in its area, how large.
    pub(super) viewport: Viewport,
    /// Whether what decided each pixel is painted over it.
    pub(super) verdicts: bool,
    /// The button that drags, and where the mouse was when that was last followed, in points.
    dragging: Option<(PointerButton, Pos2)>,
    /// What is outlined.
    pub(super) outlined: Option<Outlined>,
}

/// Shows the picture in all the room that there is; what the mouse did, where it is, and in which area.
pub(super) fn show(
    ui: &mut Ui,
    picture: &PreviewPicture,
    showing: &mut Showing,
    held: Option<[u32; 2]>,
) -> (Mouse, Placed, Rect) {
    let (response, painter) = ui.allocate_painter(ui.available_size(), Sense::click_and_drag());
    let rect = response.rect;
    let scale = f64::from(ui.ctx().pixels_per_point());
    let area = area(rect, scale);
    let size = picture.scene.camera.pixeldim;
    let in_pixels = |at: Pos2| [f64::from(at.x) * scale, f64::from(at.y) * scale];
    let over = response.hover_pos().map(in_pixels);
    let mut mouse = Mouse::default();
    let placed = showing.viewport.place(area, size);
    let (origin, now) = ui.input(|input| {
        let pointer = &input.pointer;
        (pointer.press_origin(), pointer.interact_pos())
    });
    let in_picture = |at: Pos2| placed.at(in_pixels(at));
    mouse.at = now.map(in_picture);
    if response.drag_started_by(PointerButton::Primary) {
        mouse.grabs = origin.map(in_picture);
    }
    mouse.dragging = response.dragged_by(PointerButton::Primary);
    let (delta, button) = dragged(ui, &response, &mut showing.dragging);
    if delta != egui::Vec2::ZERO {
        let by = [f64::from(delta.x) * scale, f64::from(delta.y) * scale];
        if button == Some(PointerButton::Primary) {
            let zoom = showing.viewport.place(area, size).zoom;
            mouse.dragged = by.map(|pixels| pixels / zoom);
        } else {
            showing.viewport.pan(by, area, size);
        }
    }
    if let Some(at) = over {
        let (turned, zoomed) = ui.input(turned);
        mouse.wheel = turned;
        for _ in 0..zoomed.abs().round() as u32 {
            showing.viewport.step(zoomed > 0.0, at, area, size);
        }
    }
    let placed = showing.viewport.place(area, size);
    mouse.over = over.and_then(|at| placed.pixel(at, size));
    mouse.clicked = response.clicked_by(PointerButton::Primary);
    let draw = Draw {
        pixels: Arc::clone(&picture.pixels),
        size,
        placed,
        verdicts: showing.verdicts,
        outlined: showing.outlined.clone(),
    };
    painter.add(match &picture.canvas {
        Some(canvas) => screen::shape(rect, Arc::clone(canvas), draw),
        None => super::painter::shape(rect, draw),
    });
    let cell = |[x, y]: [u32; 2]| -> Rect {
        let row = size[1] - 1 - y;
        let corner = |column: u32, row: u32| {
            let place = |i: usize, at: u32| {
                ((f64::from(placed.origin[i]) + placed.zoom * f64::from(at)) / scale) as f32
            };
            Pos2::new(place(0, column), place(1, row))
        };
        Rect::from_min_max(corner(x, row), corner(x + 1, row + 1))
    };
    if placed.zoom / scale >= LABELLED && picture.pixels.size == size {
        label(&painter, picture, &placed, area, &cell);
    }
    if let Some(pixel) = held {
        let around = cell(pixel).expand(1.5);
        let stroke = |width, color| egui::Stroke::new(width, color);
        let kind = egui::StrokeKind::Outside;
        painter.rect_stroke(around, 0.0, stroke(3.0, Color32::BLACK), kind);
        painter.rect_stroke(
            around,
            0.0,
            stroke(1.5, Color32::from_rgb(255, 140, 0)),
            kind,
        );
    }
    (mouse, placed, rect)
}

pub(super) fn area(rect: Rect, scale: f64) -> Area {
    // Whole pixels, so that the picture's are too.
    let corner = [rect.left(), rect.top()].map(|at| (f64::from(at) * scale).round());
    let size = [rect.width(), rect.height()].map(|length| (f64::from(length) * scale).floor());
    Area { corner, size }
}

/// How far the mouse was dragged since this was last asked, in points, and by which button. All of the way counts: what
/// goes by before egui takes it for a drag, and what comes together with the release; so what was grabbed stays under
/// the cursor.
fn dragged(
    ui: &Ui,
    response: &egui::Response,
    dragging: &mut Option<(PointerButton, Pos2)>,
) -> (egui::Vec2, Option<PointerButton>) {
    let (origin, now) = ui.input(|input| {
        let pointer = &input.pointer;
        (pointer.press_origin(), pointer.interact_pos())
    });
    if response.drag_started() {
        let mut buttons = [
            PointerButton::Primary,
            PointerButton::Secondary,
            PointerButton::Middle,
        ]
        .into_iter();
        let button = buttons.find(|button| response.drag_started_by(*button));
        *dragging = button.zip(origin);
    }
    let (Some((button, last)), Some(now)) = (*dragging, now) else {
        return (egui::Vec2::ZERO, None);
    };
    *dragging = response.dragged().then_some((button, now));
    (now - last, Some(button))
}

/// Notches that the wheel was turned away from the user, and the same with Ctrl.
fn turned(input: &egui::InputState) -> (f64, f64) {
    let (mut plain, mut zoomed) = (0.0, 0.0);
    for event in &input.events {
        match event {
            egui::Event::MouseWheel {
                unit,
                delta,
                modifiers,
                ..
            } => {
                let notches = f64::from(delta.y)
                    / match unit {
                        egui::MouseWheelUnit::Line => 1.0,
                        egui::MouseWheelUnit::Page => 0.2,
                        egui::MouseWheelUnit::Point => 50.0,
                    };
                if modifiers.command {
                    zoomed += notches;
                } else {
                    plain += notches;
                }
            }
            egui::Event::Zoom(factor) => zoomed += 4.0 * f64::from(factor.max(0.01)).log2(),
            _ => {}
        }
    }
    (plain, zoomed)
}

/// The bytes of a pixel: column, and row from the bottom.
pub(super) fn bytes(picture: &PreviewPicture, [x, y]: [u32; 2]) -> Option<[u8; 3]> {
    let [width, height] = picture.pixels.size;
    if picture.pixels.size != picture.scene.camera.pixeldim || x >= width || y >= height {
        return None;
    }
    let place = (height - 1 - y) as usize * width as usize + x as usize;
    picture.pixels.rgb.as_chunks::<3>().0.get(place).copied()
}

/// Writes their bytes into the pixels that are seen.
fn label(
    painter: &egui::Painter,
    picture: &PreviewPicture,
    placed: &Placed,
    area: Area,
    cell: &dyn Fn([u32; 2]) -> Rect,
) {
    let [width, height] = picture.pixels.size;
    let [first, last] = [0.0, 1.0].map(|end| {
        let corner = [0, 1].map(|i| area.corner[i] + end * area.size[i]);
        placed.at(corner)
    });
    let range = |i: usize, most: u32| {
        let clamp = |at: f64| at.clamp(0.0, f64::from(most));
        clamp(first[i].floor()) as u32..clamp(last[i].ceil()) as u32
    };
    for row in range(1, height) {
        for x in range(0, width) {
            let pixel = [x, height - 1 - row];
            let Some([r, g, b]) = bytes(picture, pixel) else {
                continue;
            };
            let rect = cell(pixel);
            let light = 2 * u32::from(r) + 5 * u32::from(g) + u32::from(b) > 8 * 128;
            let color = if light {
                Color32::BLACK
            } else {
                Color32::WHITE
            };
            let font = FontId::monospace(rect.height() * 0.26);
            painter.text(
                rect.center(),
                Align2::CENTER_CENTER,
                format!("{r}\n{g}\n{b}"),
                font,
                color,
            );
        }
    }
}
