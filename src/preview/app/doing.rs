//! What keys and panels ask for, done.

use std::io::ErrorKind;
use std::path::Path;
use std::sync::Arc;
use std::time::Instant;

use eframe::egui::{self, Context};
use glam::DVec3;

use super::App;
use super::events::Event;
use crate::edit::{Target, Value, camera_block};
use crate::preview::chooser::Purpose;
use crate::preview::entities::title;
use crate::preview::keys::{self, Command};
use crate::preview::overlay::SaveAs;
use crate::preview::picture;
use crate::preview::priority;
use crate::preview::save;
use crate::preview::selection::Selection;
use crate::preview::session;
use crate::preview::undo::{Direction, Step};
use crate::preview::viewport::{self, Area, Viewport};
use crate::preview::wanted::Wanted;
use crate::scene::{self, EntityId, LoadError, Scene};

impl App {
    /// The keys that were struck since the last frame, unless something is asked.
    pub(super) fn take_keys(&mut self, context: &Context) {
        let presses = context.input(|input| {
            let is_press = |event: &&egui::Event| {
                matches!(event, egui::Event::PointerButton { pressed: true, .. })
            };
            input.events.iter().filter(is_press).count()
        });
        self.presses += presses as u64;
        let mut commands = std::mem::take(&mut self.deferred);
        if self.save_as.is_none() && self.chooser.is_none() && !self.leaving.asks() {
            self.deferred = keys::leaves_field(context);
            if self.deferred.is_empty() {
                commands.extend(keys::pressed(context));
            }
        }
        for command in commands {
            self.obey(context, command);
        }
    }

    /// The viewpoint as it is shown, and the scene as the file has it.
    fn viewpoint(&self) -> Option<(DVec3, Arc<Scene>)> {
        let state = self.shared.lock();
        let scene = Arc::clone(state.session.wanted()?.0);
        let viewpoint = state.session.value(Target::VIEWPOINT)?.vector()?;
        Some((viewpoint, scene))
    }

    pub(super) fn move_viewpoint(&mut self, to: impl FnOnce(DVec3, &Scene) -> DVec3) {
        if let Some((viewpoint, scene)) = self.viewpoint() {
            self.set(Target::VIEWPOINT, to(viewpoint, &scene).into());
        }
    }

    /// Changes a number: while a button of the mouse is held, in one step.
    pub(super) fn set(&mut self, target: Target, value: Value) {
        let is_held = self.teller.context.input(|input| {
            let pointer = &input.pointer;
            pointer.any_down() || pointer.any_released()
        });
        let step = if is_held {
            Step::Held(target, self.presses)
        } else {
            Step::Run(target, Instant::now())
        };
        let mut state = self.shared.lock();
        state.change(|session| session.set(target, value, step));
    }

    /// Takes a step back, or forward again.
    fn step(&mut self, direction: Direction) {
        self.grabbed = None;
        self.shared
            .lock()
            .change(|session| session.step_back(direction));
    }

    /// Selects something, and shows it in the lists.
    pub(super) fn select(&mut self, entity: Option<EntityId>) {
        let state = self.shared.lock();
        if let Some(good) = state.session.good() {
            self.side.selection.select(&good.scene, entity);
            let titled = entity.and_then(|entity| title(&good.scene, entity));
            let (kind, name) = titled.unwrap_or(("nothing", ""));
            log::info!("selected {kind} {name}");
        }
    }

    fn discard(&mut self, target: Option<Target>) {
        self.shared.lock().change(|session| session.discard(target));
    }

    pub(super) fn obey(&mut self, context: &Context, command: Command) {
        match command {
            Command::Step(steps) => self.move_viewpoint(|viewpoint, scene| {
                viewport::stepped(&scene.camera, viewpoint, steps)
            }),
            Command::Away(steps) => self.move_viewpoint(|viewpoint, scene| {
                viewport::moved_away(&scene.camera, viewpoint, steps)
            }),
            Command::Reset => self.discard(Some(Target::VIEWPOINT)),
            Command::Fit => self.showing.viewport = Viewport::Fit,
            Command::OneToOne => self.zoom(context, |viewport, at, area, size| {
                viewport.zoom_to(1.0, at, area, size);
            }),
            Command::Zoom(larger) => self.zoom(context, |viewport, at, area, size| {
                viewport.step(larger, at, area, size);
            }),
            Command::Verdicts => self.showing.verdicts ^= true,
            Command::Inspector => self.panels.toggle_inspector(),
            Command::Side => self.panels.toggle_side(),
            Command::Escape => {
                self.panel.held = None;
                self.help_open = false;
                self.side.selection = Selection::default();
            }
            Command::CopyCamera => self.copy_camera(context),
            Command::Undo => self.step(Direction::Undo),
            Command::Redo => self.step(Direction::Redo),
            Command::Open => self.choose(Purpose::Open),
            Command::New => self.choose(Purpose::New),
            Command::SaveChanges => self.save_changes(),
            Command::SavePicture => self.ask_where(),
            Command::Reload => self.reload(),
            Command::Theme => {
                let dark = context.theme() == egui::Theme::Dark;
                context.set_theme(if dark {
                    egui::Theme::Light
                } else {
                    egui::Theme::Dark
                });
            }
            Command::Help => self.help_open ^= true,
            Command::Quit => {
                self.next = None;
                self.leaving.ask();
            }
        }
    }

    fn zoom(
        &mut self,
        context: &Context,
        zoom: impl FnOnce(&mut Viewport, [f64; 2], Area, [u32; 2]),
    ) {
        let (Some(rect), Some(picture)) = (self.area, &self.picture) else {
            return;
        };
        let scale = f64::from(context.pixels_per_point());
        let in_pixels = |at: egui::Pos2| [f64::from(at.x) * scale, f64::from(at.y) * scale];
        let cursor = context.input(|input| input.pointer.hover_pos());
        let at = cursor.filter(|at| rect.contains(*at));
        let at = in_pixels(at.unwrap_or(rect.center()));
        let size = picture.scene.camera.pixeldim;
        zoom(
            &mut self.showing.viewport,
            at,
            picture::area(rect, scale),
            size,
        );
    }

    fn copy_camera(&mut self, context: &Context) {
        if let Some((viewpoint, scene)) = self.viewpoint() {
            let mut camera = scene.camera.clone();
            camera.viewpoint = viewpoint;
            let options = self.shared.lock().session.rendering().options();
            let mut block = camera_block(&camera);
            if !options.is_empty() {
                // What the file cannot say.
                block = format!("# rendered with {options}\n{block}");
            }
            context.copy_text(block);
            self.say("the camera's block is in the clipboard");
        }
    }

    pub(super) fn save_changes(&mut self) {
        let saving = match self.shared.lock().session.saving() {
            Ok(saving) => saving,
            Err(why) => {
                // The message is sent after the lock is released.
                self.teller.tell(Event::Saved(Err(why)));
                return;
            }
        };
        let (shared, teller) = (self.shared.clone(), self.teller.clone());
        self.on_thread("save changes", move || {
            teller.tell(Event::Saved(shared.save(saving)));
        });
    }

    fn reload(&mut self) {
        let Some(path) = self.options.path.clone() else {
            return;
        };
        let (shared, teller) = (self.shared.clone(), self.teller.clone());
        self.on_thread("reload", move || {
            let news = match scene::read_file(&path) {
                Ok(text) => session::News::Version(session::Version::read(&path, text)),
                Err(LoadError::Io { source, .. }) if source.kind() == ErrorKind::NotFound => {
                    session::News::Gone
                }
                Err(error) => session::News::Unreadable(error.to_string()),
            };
            shared.news_of(&path, news);
            teller.tell(Event::Saved(Ok("read again".into())));
        });
    }

    fn ask_where(&mut self) {
        let name = Path::new(&self.shared.lock().session.name()).with_extension("png");
        self.save_as = Some(SaveAs::new(name.display().to_string()));
    }

    pub(super) fn save_picture(&mut self, name: &str) {
        let state = self.shared.lock();
        let Some((scene, changes)) = state.session.wanted() else {
            return;
        };
        let task = save::SaveTask {
            gpu: Arc::clone(&self.gpu),
            scene: Arc::clone(scene),
            changes: changes.clone(),
            settings: state.session.rendering().over(&self.options.settings),
            file: state.session.path.clone(),
            to: name.into(),
            software: self.options.software,
            stop: Arc::clone(&self.closing),
        };
        drop(state);
        let teller = self.teller.clone();
        self.say(format!("saving {name} …"));
        self.on_thread("save picture", move || {
            priority::lower();
            teller.tell(Event::Saved(task.run()));
        });
    }

    /// Does what would keep the window waiting.
    fn on_thread(&mut self, name: &str, work: impl FnOnce() + Send + 'static) {
        self.threads.retain(|thread| !thread.is_finished());
        match std::thread::Builder::new().name(name.into()).spawn(work) {
            Ok(thread) => self.threads.push(thread),
            Err(error) => self.say(format!("cannot {name}: {error}")),
        }
    }

    pub(super) fn do_wanted(&mut self, context: &Context, wanted: Wanted) {
        match wanted {
            Wanted::Set(target, value) => self.set(target, value),
            Wanted::Reset(target) => self.discard(Some(target)),
            Wanted::Discard => self.discard(None),
            Wanted::Render(rendering) => {
                let mut state = self.shared.lock();
                state.change(|session| session.render_as(rendering));
            }
            Wanted::Save => self.save_changes(),
            Wanted::CopyCamera => self.copy_camera(context),
            Wanted::SavePicture => self.ask_where(),
            Wanted::Undo => self.step(Direction::Undo),
            Wanted::Redo => self.step(Direction::Redo),
        }
    }
}
