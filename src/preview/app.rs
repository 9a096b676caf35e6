//! The window: brings together the file, the pictures, the panels, and what the user does.
//!
//! Here are its parts, and a frame; `doing` has what keys and panels ask for, `hands` what the mouse does on the
//! picture, `asking` what is wanted to be known of it, `leaving` what is asked before the window closes.

mod asking;
mod doing;
mod hands;
mod leaving;
mod opening;

use std::path::PathBuf;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{self, Receiver, Sender};
use std::thread::JoinHandle;
use std::time::{Duration, Instant};

use eframe::egui::{self, Context, Rect, Ui};

use super::canvases::Canvases;
use super::chooser::{Chooser, Purpose};
use super::draw::ObjectMap;
use super::handles::Grabbed;
use super::hints::Hints;
use super::inspect::{Answer, Inspector};
use super::inspector::Panel;
use super::keys::Command;
use super::overlay::{self, Chosen, SaveAs};
use super::painter;
use super::panels::Panels;
use super::picture::{self, Showing};
use super::recent::Recent;
use super::rendering::Rendering;
use super::screen;
use super::session::{self, Session};
use super::shared_session::SharedSession;
use super::side::{self, Side};
use super::start;
use super::status::{self, Line};
use super::watch::SceneWatch;
use super::worker::{self, PreviewPicture, Worker};
use super::{Devices, Options, inspector, legend};
use crate::gpu::device::Gpu;
use crate::scene::EntityId;
use leaving::Leaving;

/// What is said stays in the status line for so long.
const SAID: Duration = Duration::from_secs(12);

/// Figures that change are drawn anew so often.
const FIGURES: Duration = Duration::from_millis(250);

/// What other threads tell the window.
enum Event {
    /// Something is to be said, or to be shown of the file.
    File,
    Rendered(worker::News),
    Inspected(Answer),
    Saved(Result<String, String>),
    /// What the desktop's file dialog gave.
    Browsed(Purpose, Option<PathBuf>),
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
    /// The device that renders.
    gpu: Arc<Gpu>,
    options: Options,
    shared: SharedSession,
    events: Receiver<Event>,
    teller: Teller,
    worker: Worker,
    inspector: Inspector,
    /// Watches as long as it lives.
    watch: Option<SceneWatch>,
    recent: Recent,
    chooser: Option<Chooser>,
    /// The scene to be opened next, where it is not the window that is to be closed.
    next: Option<PathBuf>,
    /// Pictures of wishes up to this are of a scene that was shown before.
    since: u64,
    /// The picture that is shown.
    picture: Option<PreviewPicture>,
    /// Why the newest wish could not be fulfilled.
    failed: Option<String>,
    showing: Showing,
    side: Side,
    panel: Panel,
    panels: Panels,
    hints: Hints,
    /// Of which wish and which text the hints are.
    hinted: Option<(u64, Arc<Vec<u8>>)>,
    /// What was asked last: of which wish, which pixel; whether the picture stays, whether which objects are seen.
    asked: Option<(u64, Option<[u32; 2]>, [bool; 4])>,
    seen: Option<(u64, Arc<ObjectMap>)>,
    outlined: Option<(u64, EntityId)>,
    over: Option<[u32; 2]>,
    /// The pixel that was clicked, as long as it is not known what it shows.
    clicked: Option<[u32; 2]>,
    /// The handle that is dragged.
    grabbed: Option<Grabbed>,
    /// How often a button of the mouse was pressed.
    presses: u64,
    area: Option<Rect>,
    help_open: bool,
    save_as: Option<SaveAs>,
    /// Whether the window is to be closed.
    leaving: Leaving,
    /// What is to be done once a field of text was left.
    deferred: Vec<Command>,
    /// What is being saved or read beside the window.
    threads: Vec<JoinHandle<()>>,
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
        Devices { gpu, window }: Devices,
        options: Options,
    ) -> anyhow::Result<Self> {
        let state = creation.wgpu_render_state.as_ref();
        let state = state.ok_or_else(|| anyhow::anyhow!("egui does not draw with wgpu"))?;
        if Arc::ptr_eq(&gpu, &window) {
            screen::install(state);
        } else {
            painter::install(state, &creation.egui_ctx);
        }
        window.check()?;
        let (sender, events) = mpsc::channel();
        let teller = Teller {
            events: sender,
            context: creation.egui_ctx.clone(),
        };
        let tell = teller.clone();
        let canvases = Canvases::new(&gpu, &window)?;
        let worker = Worker::new(
            Arc::clone(&gpu),
            canvases,
            options.settings.clone(),
            move |news| tell.tell(Event::Rendered(news)),
        )?;
        let tell = teller.clone();
        let inspector =
            Inspector::new(Arc::clone(&gpu), options.settings.clone(), move |answer| {
                tell.tell(Event::Inspected(answer))
            })?;
        let mut session = Session::new(PathBuf::new(), options.size);
        session.render_as(Rendering::of(&options.settings));
        let shared = SharedSession::new(session, Arc::clone(&worker.wishes));
        let recent = Recent::read(options.recent.clone());
        let path = options.path.clone();
        let mut app = Self {
            shared,
            gpu,
            options,
            events,
            teller,
            worker,
            inspector,
            watch: None,
            recent,
            chooser: None,
            next: None,
            since: 0,
            picture: None,
            failed: None,
            showing: Showing::default(),
            side: Side::default(),
            panel: Panel::default(),
            panels: Panels::default(),
            hints: Hints::default(),
            hinted: None,
            asked: None,
            seen: None,
            outlined: None,
            over: None,
            clicked: None,
            grabbed: None,
            presses: 0,
            area: None,
            help_open: false,
            save_as: None,
            leaving: Leaving::default(),
            deferred: Vec::new(),
            threads: Vec::new(),
            closing: Arc::new(AtomicBool::new(false)),
            said: None,
            came: Vec::new(),
            title: String::new(),
        };
        if let Some(path) = path {
            app.turn_to(path);
        }
        Ok(app)
    }

    fn say(&mut self, text: impl Into<String>) {
        self.said = Some((text.into(), Instant::now()));
    }

    /// Takes what other threads tell.
    fn listen(&mut self) {
        while let Ok(event) = self.events.try_recv() {
            match event {
                Event::File => {}
                Event::Rendered(worker::News::Picture(picture)) if picture.number <= self.since => {
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
                    if number == self.shared.lock().wished && number > self.since {
                        self.failed = Some(why);
                    }
                }
                Event::Browsed(purpose, path) => self.browsed(purpose, path),
                Event::Inspected(answer) => self.answered(answer),
                Event::Saved(saved) => {
                    if saved.is_err() {
                        // There is something to be read first.
                        self.leaving.stop_saving();
                    }
                    let (Ok(text) | Err(text)) = saved;
                    self.say(text);
                }
            }
        }
        let said = std::mem::take(&mut self.shared.lock().session.said);
        said.into_iter().for_each(|text| self.say(text));
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
        let state = self.shared.lock();
        let session = &state.session;
        let star = if session.unsaved().is_empty() {
            ""
        } else {
            "*"
        };
        let mut title = match session.name() {
            name if name.is_empty() => "plumb".to_owned(),
            name => format!("{name}{star} – plumb"),
        };
        if let Some(trouble) = &session.trouble {
            title.push_str(match trouble {
                session::Trouble::Mistakes(it) if it.count > 1 => " – mistakes",
                session::Trouble::Mistakes(_) => " – mistake",
                session::Trouble::Gone => " – gone",
                session::Trouble::Unreadable(_) => " – cannot be read",
            });
        } else if !kind.is_empty() {
            title.push_str(&format!(" – {kind}"));
        }
        drop(state);
        if title != self.title {
            context.send_viewport_cmd(egui::ViewportCommand::Title(title.clone()));
            self.title = title;
        }
    }

    fn status(&mut self, ui: &mut Ui) {
        let frames = self.frames();
        let said = self.said.as_ref().filter(|(_, when)| when.elapsed() < SAID);
        let picture = self.picture.as_ref();
        let state = self.shared.lock();
        let rendering = state.session.rendering().options();
        let trouble = state.session.trouble.is_some();
        drop(state);
        let size = picture.map_or([1, 1], |picture| picture.scene.camera.pixeldim);
        let scale = f64::from(ui.ctx().pixels_per_point());
        let placed = self.area.map(|rect| {
            self.showing
                .viewport
                .place(picture::area(rect, scale), size)
        });
        let line = Line {
            doing: self.doing(),
            zoom: placed.map_or(1.0, |placed| placed.zoom),
            frames,
            pixel: self.over.and_then(|pixel| {
                let bytes = picture.and_then(|picture| picture::bytes(picture, pixel));
                Some((pixel, bytes?))
            }),
            rendering,
            trouble,
            said: said.map(|(text, _)| text.clone()),
        };
        if line.doing.is_some() || frames.is_some() || said.is_some() {
            // The line is drawn again soon, so that its figures do not stand still.
            ui.ctx().request_repaint_after(FIGURES);
        }
        if status::show(ui, picture, &line) {
            self.help_open = true;
        }
    }

    /// What is being done, if anything.
    fn doing(&self) -> Option<String> {
        self.options.path.as_ref()?;
        let state = self.shared.lock();
        if state.wished == 0 {
            // Nothing is wished for while there is no scene; what is wrong with the file is said elsewhere.
            return state
                .session
                .trouble
                .is_none()
                .then(|| "reading the scene".into());
        }
        let shown = self.picture.as_ref().map(|picture| picture.number);
        let behind = shown != Some(state.wished) && self.failed.is_none();
        let words = self.worker.progress.doing().words();
        words.or_else(|| behind.then(|| "rendering next".into()))
    }

    fn middle(&mut self, ui: &mut Ui) {
        if self.options.path.is_none() {
            if let Some(start) = start::show(ui, self.recent.scenes()) {
                self.start(start);
            }
            return;
        }
        let rect = ui.available_rect_before_wrap();
        let trouble = self.shared.lock().session.trouble.clone();
        match &self.picture {
            Some(picture) => {
                let held = self.panel.held;
                let (mouse, placed, area) = picture::show(ui, picture, &mut self.showing, held);
                self.area = Some(area);
                self.take_mouse(ui, &mouse, &placed);
                if self.showing.verdicts {
                    legend::show(ui, area);
                }
            }
            None => {
                if let (Some(doing), None, None) = (self.doing(), &trouble, &self.failed) {
                    ui.centered_and_justified(|ui| ui.label(format!("{doing} …")));
                }
            }
        }
        if let Some(trouble) = &trouble {
            overlay::trouble(ui, rect, trouble, self.picture.is_some());
        } else if let Some(why) = &self.failed {
            overlay::notice(ui, rect, "The picture cannot be rendered", why);
        }
    }

    fn dialogs(&mut self, context: &Context) {
        overlay::help(context, &mut self.help_open);
        self.show_chooser(context);
        self.take_dropped(context);
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
        self.take_keys(&context);
        self.panels.room = ui.max_rect().size();
        let room = self.panels.room;
        egui::Panel::bottom("status").show(ui, |ui| self.status(ui));
        let has_scene = self.options.path.is_some();
        if self.panels.side() && has_scene {
            let wanted = egui::Panel::right("side")
                .default_size(side::WIDTH)
                .max_size(Panels::most(room.x))
                .show(ui, |ui| {
                    side::show(ui, &mut self.side, &self.shared.lock().session)
                });
            for wanted in wanted.inner {
                self.do_wanted(&context, wanted);
            }
        } else {
            self.side.hovered = None;
        }
        if self.hints.is_open() {
            egui::Panel::bottom("hints").show(ui, |ui| self.hints.show(ui, room));
        }
        if self.panels.inspector() && has_scene {
            let pixel = self.panel.held.or(self.over);
            let verdict = pixel.and_then(|pixel| self.verdict(pixel));
            let let_go = egui::Panel::bottom("inspector")
                .resizable(true)
                .default_size(inspector::HEIGHT)
                .max_size(Panels::most(room.y))
                .show(ui, |ui| inspector::show(ui, &self.panel, pixel, verdict));
            if let_go.inner {
                self.panel.held = None;
            }
        }
        egui::CentralPanel::no_frame().show(ui, |ui| self.middle(ui));
        self.dialogs(&context);
        self.leave(&context);
        self.ask();
        self.outline();
    }

    fn on_exit(&mut self) {
        self.closing.store(true, Ordering::Relaxed);
        // A frame just after a change of the size closes the gate; whoever waits there would be waited for below. All
        // of them are gone before eframe takes the surface down.
        self.gpu.submit_gate.open();
        self.worker.end();
        self.inspector.end();
        // What is being written into the scene's file is written to its end; pictures are given up.
        for thread in self.threads.drain(..) {
            // A panic was printed when it happened.
            let _ = thread.join();
        }
    }
}
