//! What the window wants to know of the picture: a pixel explained, which objects are seen where.

use std::sync::Arc;

use super::App;
use crate::certify::verdict::meaning;
use crate::preview::draw::{ObjectMap, Outlined};
use crate::preview::entities;
use crate::preview::inspect::{Answer, Question};
use crate::scene::EntityId;
use crate::settings::Precision;

impl App {
    /// Takes what was found out.
    pub(super) fn answered(&mut self, answer: Answer) {
        match answer {
            Answer::Pixel {
                number,
                pixel,
                text,
            } => self.panel.explained = Some((number, pixel, text)),
            Answer::Clicked { pixel, object } => {
                // Another pixel may have been clicked meanwhile.
                if self.clicked.take_if(|clicked| *clicked == pixel).is_some() {
                    self.select(object.map(EntityId::Object));
                }
            }
            Answer::Remarks {
                number,
                of,
                remarks,
            } => {
                self.hinted = Some((number, of));
                self.hints.take(remarks);
            }
            Answer::Objects {
                number,
                size,
                objects,
            } => {
                let seen = ObjectMap { size, objects };
                self.seen = Some((number, Arc::new(seen)));
                self.outlined = None;
            }
        }
    }

    /// Asks for what the inspector shows, and for what is to be outlined.
    pub(super) fn ask(&mut self) {
        let Some(picture) = &self.picture else {
            return;
        };
        let explained = self
            .panel
            .held
            .or(self.over)
            .filter(|_| self.panels.inspector());
        let pixel = self.clicked.or(explained);
        let seen = self
            .seen
            .as_ref()
            .is_some_and(|(number, _)| *number == picture.number);
        let objects =
            (self.side.hovered.is_some() || self.side.selection.entity().is_some()) && !seen;
        let still = picture.number == self.rests;
        let clicked = self.clicked.is_some();
        let state = self.shared.lock();
        let (session, is_newest) = (&state.session, state.wished == picture.number);
        let hinted = |text: &Arc<Vec<u8>>| {
            let hinted = self.hinted.as_ref();
            hinted.is_some_and(|(number, of)| *number == picture.number && Arc::ptr_eq(of, text))
        };
        let text = session
            .text()
            .filter(|text| is_newest && session.trouble.is_none() && !hinted(text));
        let places = session.good().map(|good| Arc::clone(&good.places));
        let remarks = text.cloned().zip(places);
        let (name, rendering) = (session.name(), session.rendering());
        drop(state);
        let question = (
            picture.number,
            pixel,
            [still, objects, clicked, remarks.is_some()],
        );
        if (pixel.is_none() && !objects && remarks.is_none()) || self.asked == Some(question) {
            return;
        }
        self.asked = Some(question);
        self.inspector.ask(Question {
            number: picture.number,
            scene: Arc::clone(&picture.scene),
            name,
            rendering,
            remarks,
            pixel,
            still,
            clicked,
            objects,
        });
    }

    /// Outlines what is under the cursor in the lists, or was clicked there.
    pub(super) fn outline(&mut self) {
        let entity = self.side.hovered.or(self.side.selection.entity());
        let (Some(entity), Some(picture), Some((number, seen))) =
            (entity, &self.picture, &self.seen)
        else {
            self.showing.outlined = None;
            self.outlined = None;
            return;
        };
        if *number != picture.number {
            self.showing.outlined = None;
            self.outlined = None;
            return;
        }
        if self.outlined == Some((*number, entity)) {
            return;
        }
        let scene = &picture.scene;
        let mut words = vec![0_u32; scene.objects.len() / 32 + 1];
        for object in 0..scene.objects.len() {
            if entities::shows(scene, object, entity) {
                words[(object + 1) / 32] |= 1 << ((object + 1) % 32);
            }
        }
        self.showing.outlined = Some(Outlined {
            seen: Arc::clone(seen),
            chosen: Arc::new(words),
        });
        self.outlined = Some((*number, entity));
    }

    /// What decided a pixel of the picture, if that is certified.
    pub(super) fn verdict(&self, [x, y]: [u32; 2]) -> Option<&'static str> {
        let picture = self.picture.as_ref()?;
        let [width, height] = picture.pixels.size;
        let shown = picture.pixels.size == picture.scene.camera.pixeldim
            && picture.precision == Precision::Certified
            && x < width
            && y < height;
        let place = (height.checked_sub(1 + y)?) as usize * width as usize + x as usize;
        let by = shown
            .then(|| picture.pixels.verdicts.get(place))
            .flatten()?;
        Some(meaning(*by))
    }
}
