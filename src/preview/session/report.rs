//! What happened to a session, for the log (`RUST_LOG=plumb=debug`): with it, who drives the window from outside knows
//! what there is to be lost. Two lines at most: all numbers that the file has, where it is another one, and what
//! happened, with all numbers that are shown otherwise.

use super::Session;
use crate::edit::{Target, Value};
use crate::preview::entities::title;
use crate::scene::{EntityId, Scene};

impl Session {
    /// Logs what happened here.
    pub(super) fn report(&self, happened: &str) {
        let Some(origin) = self
            .origin
            .as_ref()
            .filter(|_| log::log_enabled!(log::Level::Debug))
        else {
            return;
        };
        let unsaved = self.unsaved();
        log::debug!("{happened}{}", list(&origin.scene, unsaved.iter()));
    }

    /// Logs that the file is another one.
    pub(super) fn report_file(&self, happened: &str) {
        let Some(good) = self.good().filter(|_| log::log_enabled!(log::Level::Debug)) else {
            return;
        };
        let scene = &good.scene;
        let all = [EntityId::Camera].into_iter();
        let all = all.chain((0..scene.materials.len()).map(EntityId::Material));
        let all = all.chain((0..scene.objects.len()).map(EntityId::Object));
        let all = all.chain((0..scene.lights.len()).map(EntityId::Light));
        let targets = all.flat_map(|entity| Target::all_of(scene, entity));
        let values = targets.filter_map(|target| Some((target, target.value_in(scene)?)));
        log::debug!("numbers{}", list(scene, values));
        self.report(happened);
    }
}

fn list(scene: &Scene, values: impl Iterator<Item = (Target, Value)>) -> String {
    let mut list = String::new();
    for (target, value) in values {
        let (kind, name) = title(scene, target.entity()).unwrap_or_default();
        let attribute = target.attribute();
        list.push_str(&format!("; {kind} {name} {attribute} {value:?}"));
    }
    list
}
