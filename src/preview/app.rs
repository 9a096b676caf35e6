//! The window: brings together the file, the pictures, the panels, and what the user does.
//!
//! Here are its parts, and a frame; `doing` has what keys and panels ask for, `hands` what the mouse does on the
//! picture, `asking` what is wanted to be known of it, `opening` how another scene comes, `leaving` what is asked
//! before the window closes; `events` has what other threads tell, `telling` what the user is told.

mod asking;
mod doing;
mod events;
mod hands;
mod leaving;
mod opening;
mod telling;

use std::path::PathBuf;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{self, Receiver};
use std::thread::JoinHandle;
use std::time::Instant;

use eframe::egui::{self, Context, Rect, Ui};

use super::canvases::Canvases;
use super::chooser::Chooser;
use super::draw::ObjectMap;
use super::handles::Grabbed;
use super::hints::Hints;
use super::input::Waiting;
use super::inspect::Inspector;
use super::inspector::Panel;
use super::keys::Command;
use super::overlay::{self, Chosen, SaveAs};
use super::painter;
use super::panels::Panels;
use super::picture::{self, Showing};
use super::recent::Recent;
use super::rendering::Rendering;
use super::scene_watch::SceneWatch;
use super::screen;
use super::session::Session;
use super::shared_session::SharedSession;
use super::side::{self, Side};
use super::start;
use super::worker::{PreviewPicture, Worker};
use super::{Devices, Options, inspector, legend};
use crate::gpu::device::Gpu;
use crate::scene::EntityId;
use events::{Event, Teller};
use leaving::Leaving;

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
    /// The wish that is fulfilled to the last byte, while nothing moves.
    rests: u64,
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
    /// What the user did that is not this frame's.
    waiting: Waiting,
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
        devices: Devices,
        options: Options,
    ) -> anyhow::Result<Self> {
        let state = creation.wgpu_render_state.as_ref();
        let state = state.ok_or_else(|| anyhow::anyhow!("egui does not draw with wgpu"))?;
        if devices.are_one() {
            screen::install(state);
        } else {
            painter::install(state, &creation.egui_ctx);
        }
        let Devices { gpu, window } = devices;
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
            rests: 0,
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
            waiting: Waiting::default(),
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
    fn raw_input_hook(&mut self, context: &Context, input: &mut egui::RawInput) {
        self.waiting.take_turns(&mut input.events);
        if !self.waiting.is_empty() {
            context.request_repaint();
        }
    }

    fn logic(&mut self, context: &Context, _frame: &mut eframe::Frame) {
        self.listen();
        self.set_title(context);
    }

    fn ui(&mut self, ui: &mut Ui, _frame: &mut eframe::Frame) {
        let context = ui.ctx().clone();
        self.waiting.drawn();
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
