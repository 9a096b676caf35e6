//! The window: brings together the file, the pictures, the panels, and what the user does.

use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{self, Receiver, Sender};
use std::time::{Duration, Instant};

use eframe::egui::{self, Context, Rect, Ui};
use eframe::egui_wgpu::wgpu;
use glam::DVec3;
use wgpu::util::DeviceExt as _;

use super::inspect::{Answer, Inspector, Question};
use super::inspector::Panel;
use super::keys::{self, Command};
use super::look::{self, Area, Look};
use super::overlay::{self, Chosen, SaveAs};
use super::picture::{self, Mouse, Showing};
use super::save;
use super::screen::{self, Outlined, Seen};
use super::session::{self, Session};
use super::side::{self, Side, Wanted};
use super::status::{self, Line};
use super::watch::Watcher;
use super::worker::{self, Picture, Wish, Worker};
use super::{Options, inspector};
use crate::certify::verdict::meaning;
use crate::edit::{Target, Value, camera_block};
use crate::gpu::canvas::Scatter;
use crate::gpu::device::Gpu;
use crate::scene::{EntityId, Scene};
use crate::settings::Precision;

/// What is said stays in the status line for so long.
const SAID: Duration = Duration::from_secs(12);

/// What other threads tell the window.
enum Event {
    File(session::News),
    Rendered(worker::News),
    Inspected(Answer),
    Saved(Result<String, String>),
}

/// Tells the window, and wakes it.
#[derive(Clone)]
struct Teller {
    events: Sender<Event>,
    context: Context,
}

impl Teller {
    fn tell(&self, event: Event) {
        // A window that is closed has nobody to tell.
        if self.events.send(event).is_ok() {
            self.context.request_repaint();
        }
    }
}

/// The window.
pub(super) struct App {
    gpu: Arc<Gpu>,
    options: Options,
    session: Session,
    events: Receiver<Event>,
    teller: Teller,
    worker: Worker,
    inspector: Inspector,
    /// Watches as long as it lives.
    _watcher: Watcher,
    /// The picture that is shown.
    picture: Option<Picture>,
    /// Why the newest wish could not be fulfilled.
    failed: Option<String>,
    /// The number of the newest wish.
    wished: u64,
    showing: Showing,
    side: Side,
    side_open: bool,
    panel: Panel,
    panel_open: bool,
    /// What was asked last: of which wish, which pixel; whether the picture stays, whether which objects are seen.
    asked: Option<(u64, Option<[u32; 2]>, [bool; 2])>,
    seen: Option<(u64, Arc<Seen>)>,
    outlined: Option<(u64, EntityId)>,
    over: Option<[u32; 2]>,
    area: Option<Rect>,
    help_open: bool,
    save_as: Option<SaveAs>,
    /// Set when the window closes: pictures that are being saved are given up.
    closing: Arc<AtomicBool>,
    said: Option<(String, Instant)>,
    /// When the last pictures came.
    came: Vec<Instant>,
    title: String,
}

impl App {
    /// Sets the window up on its device, and begins to watch, read and render.
    pub(super) fn new(
        creation: &eframe::CreationContext<'_>,
        gpu: Arc<Gpu>,
        options: Options,
    ) -> anyhow::Result<Self> {
        let state = creation.wgpu_render_state.as_ref();
        screen::install(state.ok_or_else(|| anyhow::anyhow!("egui does not draw with wgpu"))?);
        gpu.check()?;
        let (sender, events) = mpsc::channel();
        let teller = Teller {
            events: sender,
            context: creation.egui_ctx.clone(),
        };
        let tell = teller.clone();
        let scatter = Scatter::new(&gpu)?;
        let worker = Worker::new(
            Arc::clone(&gpu),
            scatter,
            options.settings.clone(),
            move |news| tell.tell(Event::Rendered(news)),
        )?;
        let tell = teller.clone();
        let inspector =
            Inspector::new(Arc::clone(&gpu), options.settings.clone(), move |answer| {
                tell.tell(Event::Inspected(answer))
            })?;
        let tell = teller.clone();
        let path = options.path.clone();
        let watcher = Watcher::new(&options.path, move |news| {
            tell.tell(Event::File(session::News::read(&path, news)));
        })?;
        Ok(Self {
            session: Session::new(options.path.clone(), options.size),
            gpu,
            options,
            events,
            teller,
            worker,
            inspector,
            _watcher: watcher,
            picture: None,
            failed: None,
            wished: 0,
            showing: Showing::default(),
            side: Side::default(),
            side_open: true,
            panel: Panel::default(),
            panel_open: true,
            asked: None,
            seen: None,
            outlined: None,
            over: None,
            area: None,
            help_open: false,
            save_as: None,
            closing: Arc::new(AtomicBool::new(false)),
            said: None,
            came: Vec::new(),
            title: String::new(),
        })
    }

    fn say(&mut self, text: impl Into<String>) {
        self.said = Some((text.into(), Instant::now()));
    }

    /// Has what is wanted now rendered.
    fn wish(&mut self) {
        if let Some((scene, changes)) = self.session.wanted() {
            self.wished = self.worker.wish(Wish {
                scene: Arc::clone(scene),
                changes: changes.clone(),
                since: Instant::now(),
            });
        }
    }

    /// Takes what other threads tell.
    fn listen(&mut self) {
        while let Ok(event) = self.events.try_recv() {
            match event {
                Event::File(news) => {
                    if self.session.news(news) {
                        self.wish();
                    }
                }
                Event::Rendered(worker::News::Picture(picture)) => {
                    self.failed = None;
                    self.came.push(Instant::now());
                    log::info!(
                        "{} after {:.1} ms: {}",
                        status::kind(&picture),
                        1e3 * picture.seconds,
                        status::figures(&picture)
                    );
                    self.picture = Some(*picture);
                }
                Event::Rendered(worker::News::Failed { number, why }) => {
                    if number == self.wished {
                        self.failed = Some(why);
                    }
                }
                Event::Inspected(answer) => self.answered(answer),
                Event::Saved(Ok(text) | Err(text)) => self.say(text),
            }
        }
        for text in std::mem::take(&mut self.session.said) {
            self.say(text);
        }
    }

    fn answered(&mut self, answer: Answer) {
        match answer {
            Answer::Pixel {
                number,
                pixel,
                text,
            } => self.panel.explained = Some((number, pixel, text)),
            Answer::Objects {
                number,
                size,
                objects,
            } => {
                let buffer =
                    self.gpu
                        .device
                        .create_buffer_init(&wgpu::util::BufferInitDescriptor {
                            label: Some("objects seen"),
                            contents: bytemuck::cast_slice(&objects),
                            usage: wgpu::BufferUsages::STORAGE,
                        });
                let seen = Seen {
                    size,
                    objects: buffer,
                };
                self.seen = Some((number, Arc::new(seen)));
                self.outlined = None;
            }
        }
    }

    /// The viewpoint as it is shown, and the scene as the file has it.
    fn viewpoint(&self) -> Option<(DVec3, Arc<Scene>)> {
        let scene = Arc::clone(self.session.wanted()?.0);
        match self.session.value(Target::Viewpoint)? {
            Value::Vector(viewpoint) => Some((viewpoint, scene)),
            Value::Number(_) => None,
        }
    }

    fn move_viewpoint(&mut self, to: impl FnOnce(DVec3, &Scene) -> DVec3) {
        if let Some((viewpoint, scene)) = self.viewpoint() {
            self.set(Target::Viewpoint, to(viewpoint, &scene).into());
        }
    }

    fn set(&mut self, target: Target, value: Value) {
        if self.session.set(target, value) {
            self.wish();
        }
    }

    fn obey(&mut self, context: &Context, command: Command) {
        match command {
            Command::Step(steps) => self
                .move_viewpoint(|viewpoint, scene| look::stepped(&scene.camera, viewpoint, steps)),
            Command::Away(steps) => self.move_viewpoint(|viewpoint, scene| {
                look::moved_away(&scene.camera, viewpoint, steps)
            }),
            Command::Reset => {
                if self.session.discard(Some(Target::Viewpoint)) {
                    self.wish();
                }
            }
            Command::Fit => self.showing.look = Look::Fit,
            Command::OneToOne => self.zoom(context, |look, at, area, size| {
                look.zoom_to(1.0, at, area, size);
            }),
            Command::Zoom(larger) => self.zoom(context, |look, at, area, size| {
                look.step(larger, at, area, size);
            }),
            Command::Verdicts => self.showing.verdicts ^= true,
            Command::Inspector => self.panel_open ^= true,
            Command::Side => self.side_open ^= true,
            Command::Escape => {
                self.panel.held = None;
                self.help_open = false;
                self.side.selected = None;
            }
            Command::CopyCamera => self.copy_camera(context),
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
            Command::Quit => context.send_viewport_cmd(egui::ViewportCommand::Close),
        }
    }

    fn zoom(&mut self, context: &Context, zoom: impl FnOnce(&mut Look, [f64; 2], Area, [u32; 2])) {
        let (Some(rect), Some(picture)) = (self.area, &self.picture) else {
            return;
        };
        let scale = f64::from(context.pixels_per_point());
        let in_pixels = |at: egui::Pos2| [f64::from(at.x) * scale, f64::from(at.y) * scale];
        let cursor = context.input(|input| input.pointer.hover_pos());
        let at = cursor.filter(|at| rect.contains(*at));
        let at = in_pixels(at.unwrap_or(rect.center()));
        let size = picture.scene.camera.pixeldim;
        zoom(&mut self.showing.look, at, picture::area(rect, scale), size);
    }

    fn copy_camera(&mut self, context: &Context) {
        if let Some((viewpoint, scene)) = self.viewpoint() {
            let mut camera = scene.camera.clone();
            camera.viewpoint = viewpoint;
            context.copy_text(camera_block(&camera));
            self.say("the camera's block is in the clipboard");
        }
    }

    fn save_changes(&mut self) {
        match self.session.save() {
            Ok(()) => self.wish(),
            Err(why) => self.say(why),
        }
    }

    fn reload(&mut self) {
        let path = self.options.path.clone();
        let teller = self.teller.clone();
        let read = std::thread::Builder::new()
            .name("reload".into())
            .spawn(move || {
                let news = match std::fs::read(&path) {
                    Ok(text) => session::News::Version(session::Version::read(&path, text)),
                    Err(error) => session::News::Unreadable(error.to_string()),
                };
                teller.tell(Event::File(news));
            });
        match read {
            Ok(_) => self.say("read again"),
            Err(error) => self.say(format!("cannot be read again: {error}")),
        }
    }

    fn ask_where(&mut self) {
        let name = Path::new(&self.session.name()).with_extension("png");
        self.save_as = Some(SaveAs::new(name.display().to_string()));
    }

    fn save_picture(&mut self, name: &str) {
        let Some((scene, changes)) = self.session.wanted() else {
            return;
        };
        let job = save::Job {
            gpu: Arc::clone(&self.gpu),
            scene: Arc::clone(scene),
            changes: changes.clone(),
            settings: self.options.settings.clone(),
            file: self.options.path.clone(),
            to: name.into(),
            software: self.options.software,
            stop: Arc::clone(&self.closing),
        };
        let teller = self.teller.clone();
        let saves = std::thread::Builder::new()
            .name("save".into())
            .spawn(move || teller.tell(Event::Saved(job.run())));
        match saves {
            Ok(_) => self.say(format!("saving {name} …")),
            Err(error) => self.say(format!("cannot be saved: {error}")),
        }
    }

    fn do_wanted(&mut self, context: &Context, wanted: Wanted) {
        match wanted {
            Wanted::Set(target, value) => self.set(target, value),
            Wanted::Reset(target) => {
                if self.session.discard(Some(target)) {
                    self.wish();
                }
            }
            Wanted::Discard => {
                if self.session.discard(None) {
                    self.wish();
                }
            }
            Wanted::Save => self.save_changes(),
            Wanted::CopyCamera => self.copy_camera(context),
            Wanted::SavePicture => self.ask_where(),
        }
    }

    /// What the mouse did on the picture.
    fn take_mouse(&mut self, mouse: &Mouse) {
        self.over = mouse.over;
        if mouse.dragged != [0.0; 2] {
            self.move_viewpoint(|viewpoint, scene| {
                look::dragged(&scene.camera, viewpoint, mouse.dragged)
            });
        }
        if mouse.wheel != 0.0 {
            self.move_viewpoint(|viewpoint, scene| {
                look::moved_away(&scene.camera, viewpoint, -mouse.wheel)
            });
        }
        if mouse.clicked {
            let again = self.panel.held == mouse.over;
            self.panel.held = mouse.over.filter(|_| !again);
        }
    }

    /// Asks for what the inspector shows, and for what is to be outlined.
    fn ask(&mut self) {
        let Some(picture) = &self.picture else {
            return;
        };
        let pixel = self.panel.held.or(self.over).filter(|_| self.panel_open);
        let seen = self
            .seen
            .as_ref()
            .is_some_and(|(number, _)| *number == picture.number);
        let objects = (self.side.hovered.is_some() || self.side.selected.is_some()) && !seen;
        let still = picture.precision == Precision::Certified;
        let question = (picture.number, pixel, [still, objects]);
        if (pixel.is_none() && !objects) || self.asked == Some(question) {
            return;
        }
        self.asked = Some(question);
        self.inspector.ask(Question {
            number: picture.number,
            scene: Arc::clone(&picture.scene),
            name: self.session.name(),
            pixel,
            still,
            objects,
        });
    }

    /// Outlines what is under the cursor in the lists, or was clicked there.
    fn outline(&mut self) {
        let entity = self.side.hovered.or(self.side.selected);
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
            if session::shows(scene, object, entity) {
                words[(object + 1) / 32] |= 1 << ((object + 1) % 32);
            }
        }
        let chosen = self
            .gpu
            .device
            .create_buffer_init(&wgpu::util::BufferInitDescriptor {
                label: Some("chosen objects"),
                contents: bytemuck::cast_slice(&words),
                usage: wgpu::BufferUsages::STORAGE,
            });
        self.showing.outlined = Some(Outlined {
            seen: Arc::clone(seen),
            chosen: Arc::new(chosen),
        });
        self.outlined = Some((*number, entity));
    }

    /// Pictures a second, while they come one after the other.
    fn frames(&mut self) -> Option<f64> {
        let now = Instant::now();
        self.came
            .retain(|came| now - *came < Duration::from_secs(1));
        let (first, last) = (*self.came.first()?, *self.came.last()?);
        let count = self.came.len();
        (count > 4 && now - last < Duration::from_millis(300))
            .then(|| (count - 1) as f64 / (last - first).as_secs_f64())
    }

    fn set_title(&mut self, context: &Context) {
        let kind = self.picture.as_ref().map(status::kind).unwrap_or_default();
        let star = if self.session.changes().is_empty() {
            ""
        } else {
            "*"
        };
        let mut title = format!("{}{star} – plumb", self.session.name());
        if let Some(trouble) = &self.session.trouble {
            title.push_str(match trouble {
                session::Trouble::Mistakes(_) => " – mistake",
                session::Trouble::Gone => " – gone",
                session::Trouble::Unreadable(_) => " – cannot be read",
            });
        } else if !kind.is_empty() {
            title.push_str(&format!(" – {kind}"));
        }
        if title != self.title {
            context.send_viewport_cmd(egui::ViewportCommand::Title(title.clone()));
            self.title = title;
        }
    }

    fn status(&mut self, ui: &mut Ui) {
        let frames = self.frames();
        let said = self.said.as_ref().filter(|(_, when)| when.elapsed() < SAID);
        let picture = self.picture.as_ref();
        let working = picture.map_or(self.wished > 0, |picture| picture.number != self.wished)
            && self.failed.is_none();
        let size = picture.map_or([1, 1], |picture| picture.scene.camera.pixeldim);
        let scale = f64::from(ui.ctx().pixels_per_point());
        let placed = self
            .area
            .map(|rect| self.showing.look.place(picture::area(rect, scale), size));
        let line = Line {
            working,
            share: self.worker.progress.share(),
            zoom: placed.map_or(1.0, |placed| placed.zoom),
            frames,
            pixel: self.over.and_then(|pixel| {
                let bytes = picture.and_then(|picture| picture::bytes(picture, pixel));
                Some((pixel, bytes?))
            }),
            said: said.map(|(text, _)| text.clone()),
        };
        if line.share.is_some() || frames.is_some() || said.is_some() {
            // So that it does not stand still.
            ui.ctx().request_repaint_after(Duration::from_millis(100));
        }
        if status::show(ui, picture, &line) {
            self.help_open = true;
        }
    }

    fn middle(&mut self, ui: &mut Ui) {
        let rect = ui.available_rect_before_wrap();
        match &self.picture {
            Some(picture) => {
                let held = self.panel.held;
                let (mouse, _, area) = picture::show(ui, picture, &mut self.showing, held);
                self.area = Some(area);
                self.take_mouse(&mouse);
            }
            None if self.session.trouble.is_none() && self.failed.is_none() => {
                ui.centered_and_justified(|ui| ui.label("reading the scene …"));
            }
            None => {}
        }
        if let Some(trouble) = &self.session.trouble {
            overlay::trouble(ui, rect, trouble, self.picture.is_some());
        } else if let Some(why) = &self.failed {
            let trouble = session::Trouble::Unreadable(why.clone());
            overlay::trouble(ui, rect, &trouble, self.picture.is_some());
        }
    }

    fn dialogs(&mut self, context: &Context) {
        overlay::help(context, &mut self.help_open);
        let chosen = self.save_as.as_mut().map(|dialog| dialog.show(context));
        match chosen {
            Some(Chosen::Save) => {
                if let Some(dialog) = self.save_as.take() {
                    self.save_picture(&dialog.name);
                }
            }
            Some(Chosen::Cancel) => self.save_as = None,
            Some(Chosen::Open) | None => {}
        }
    }
}

impl eframe::App for App {
    fn logic(&mut self, context: &Context, _frame: &mut eframe::Frame) {
        self.listen();
        self.set_title(context);
    }

    fn ui(&mut self, ui: &mut Ui, _frame: &mut eframe::Frame) {
        let context = ui.ctx().clone();
        if self.save_as.is_none() {
            for command in keys::pressed(&context) {
                self.obey(&context, command);
            }
        }
        egui::Panel::bottom("status").show(ui, |ui| self.status(ui));
        if self.side_open {
            let wanted = egui::Panel::right("side")
                .default_size(side::WIDTH)
                .show(ui, |ui| {
                    egui::ScrollArea::vertical()
                        .auto_shrink([false, false])
                        .show(ui, |ui| side::show(ui, &mut self.side, &self.session))
                        .inner
                });
            for wanted in wanted.inner {
                self.do_wanted(&context, wanted);
            }
        } else {
            self.side.hovered = None;
        }
        if self.panel_open {
            let pixel = self.panel.held.or(self.over);
            let verdict = pixel.and_then(|pixel| self.verdict(pixel));
            let let_go = egui::Panel::bottom("inspector")
                .resizable(true)
                .default_size(inspector::HEIGHT)
                .show(ui, |ui| inspector::show(ui, &self.panel, pixel, verdict));
            if let_go.inner {
                self.panel.held = None;
            }
        }
        egui::CentralPanel::no_frame().show(ui, |ui| self.middle(ui));
        self.dialogs(&context);
        self.ask();
        self.outline();
    }

    fn on_exit(&mut self) {
        self.closing.store(true, Ordering::Relaxed);
    }
}

impl App {
    /// What decided a pixel of the picture, if that is certified.
    fn verdict(&self, [x, y]: [u32; 2]) -> Option<&'static str> {
        let picture = self.picture.as_ref()?;
        let [width, height] = picture.canvas.size;
        let shown = picture.canvas.size == picture.scene.camera.pixeldim
            && picture.precision == Precision::Certified
            && x < width
            && y < height;
        let place = (height.checked_sub(1 + y)?) as usize * width as usize + x as usize;
        let stage = shown.then(|| picture.stages.get(place)).flatten()?;
        Some(meaning(*stage))
    }
}
