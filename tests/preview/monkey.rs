//! A monkey at the window: keys, clicks, drags, sizes, and somebody else who writes the file, all by chance. Nothing
//! panics, no change is lost, and the memory stays as it is.
//!
//! ```sh
//! PLUMB_MONKEY_SECONDS=3600 PLUMB_MONKEY_SEED=7 \
//!     cargo test --release --features preview --test preview -- --nocapture monkey
//! ```

mod acts;
mod memory;
mod model;

use std::path::Path;
use std::thread;
use std::time::{Duration, Instant};

use plumb::edit::Target;
use plumb::scene::{EntityId, Scene, load};
use tempfile::TempDir;

use crate::common;
use crate::program::Program;
use crate::window::{File, ROOM, command};
use crate::x11::{Display, keys};
use memory::{Memory, WARM_UP};
use model::{Model, Numbers, differing};

/// A scene of all kinds but textures, in spellings that saving has to keep.
const KINDS: &str = "\
# All kinds.
camera cam { pixeldim 160 120  worlddim 8.0 6  viewpoint +4 3 6 }
material red { ambient 5.0 0 0 specular 0.50 }   # warm
material gray { ambient 2 2 2 diffuse 1e0 1 1 shininess 5. transparency .5 }
plane floor { material gray  normal 0 1.0 0  point 0 -1 0 }
tiled_plane tiles { material gray altmaterial red normal 0 1 0 point 0 -2. 0 dimension 1.0 1.0 xdir 1.0 0 0 }
sphere ball { material red  center 4 3 -5.0  radius 1.50 }
psphere globe { material gray  center 6 4 -7.0  radius 1 shader 0 }
fplane sheet { material red normal 0 0 1. point 0 0 -9 xdir 1 0 0 dimensions 2.0 2 }
triangle tri { material red v0 0 0 -4.0 v1 1 0 -4 v2 0 1 -4 normal 0 0 1. }
quadric cone { material red coefficients 1.0 -0.25 1 0 0 0 -8 2 10 -37 lower -9 0 -9 upper 9. 4 9 }
pplane waves { material gray normal 0 0 1 point 0 0 -20. shader 00 }
light lamp { location 4.0 5 -2  emissivity 3.0 3 3 }
spotlight spot { location 0 5 0 emissivity 1.0 1 1 point 0 0 -5.0 theta 30.0 }
";

/// Where texts are tried: a name that the dialog for another scene does not list.
const TRIED: &str = ".tried.txt";

/// SplitMix64.
struct Random(u64);

impl Random {
    fn below(&mut self, count: i32) -> i32 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut bits = self.0;
        bits = (bits ^ bits >> 30).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        bits = (bits ^ bits >> 27).wrapping_mul(0x94D0_49BB_1331_11EB);
        ((bits ^ bits >> 31) % count as u64) as i32
    }

    fn of<T: Copy>(&mut self, all: &[T]) -> T {
        all[self.below(all.len() as i32) as usize]
    }
}

fn number(name: &str, otherwise: u64) -> u64 {
    std::env::var(name).map_or(otherwise, |text| text.parse().unwrap())
}

/// Plays for a third of the time, so that all three tests take as long as is said.
fn play(name: &str, text: &str, options: &[&str]) {
    let seed = number("PLUMB_MONKEY_SEED", 1);
    let seconds = number("PLUMB_MONKEY_SECONDS", 15);
    Monkey::new(name, text, options, seed).play(Duration::from_secs(seconds) / 3);
}

#[test]
fn a_monkey_loses_nothing_in_a_room() {
    play("room", ROOM, &[]);
}

#[test]
fn a_monkey_loses_nothing_of_any_kind() {
    play("kinds", KINDS, &["--size", "160x120"]);
}

#[test]
fn a_monkey_loses_nothing_on_a_stage() {
    let stage = std::fs::read_to_string(common::scenes().join("lit/spotlight_stage.txt")).unwrap();
    play("stage", &stage, &["--size", "200x150"]);
}

struct Monkey<'a> {
    name: &'a str,
    options: &'a [&'a str],
    file: File,
    pictures: TempDir,
    random: Random,
    model: Model,
    /// The last text without mistakes that is known of the file.
    good: String,
    /// How much of the log was read.
    read: usize,
    /// Whether it was agreed to that changes are lost.
    agreed: bool,
    /// What was done last, for who reads of a failure.
    done: Vec<String>,
    starts: u32,
    checks: u32,
    steps: u64,
}

impl<'a> Monkey<'a> {
    fn new(name: &'a str, text: &str, options: &'a [&'a str], seed: u64) -> Self {
        Self {
            name,
            options,
            file: File::new(text),
            pictures: tempfile::tempdir().unwrap(),
            random: Random(seed),
            model: Model::default(),
            good: text.to_owned(),
            read: 0,
            agreed: false,
            done: Vec::new(),
            starts: 0,
            checks: 0,
            steps: 0,
        }
    }

    #[allow(clippy::print_stdout, reason = "what was done, with --nocapture")]
    fn play(&mut self, time: Duration) {
        let display = Display::start(1400, 900);
        let end = Instant::now() + time;
        while Instant::now() < end {
            let mut program = self.start(&display);
            let mut memory = Memory::new(WARM_UP.max(time / 12));
            loop {
                for _ in 0..40 + self.random.below(60) {
                    self.act(&program);
                    thread::sleep(Duration::from_millis(self.random.below(12) as u64));
                    self.steps += 1;
                    self.listen(&program);
                    if program.has_ended().is_some() {
                        break;
                    }
                }
                if program.has_ended().is_some() {
                    self.ended(program);
                    break;
                }
                if !self.check(&mut program) {
                    self.ended(program);
                    break;
                }
                let Some(now) = program.memory_if_there() else {
                    self.ended(program);
                    break;
                };
                memory.is(now);
                assert!(memory.is_steady(), "{}: {memory}", self.name);
                if Instant::now() >= end {
                    let ended = program.close();
                    assert!(ended.status.success());
                    break;
                }
            }
            println!("{}: {memory}", self.name);
        }
        println!(
            "{}: {} steps, {} starts, {} checks, {:?}",
            self.name, self.steps, self.starts, self.checks, self.model.counts
        );
    }

    fn start<'d>(&mut self, display: &'d Display) -> Program<'d> {
        let mut command = command(&self.file.path, self.options);
        command.env(
            "RUST_LOG",
            "error,plumb::preview::session=debug,plumb::preview::app=info",
        );
        // Pictures may be saved under any name, but not where the dialog for another scene lists them.
        command.current_dir(self.pictures.path());
        // Each start has its own scene, which is what the file has.
        self.file.write(&self.good);
        self.model.forget();
        (self.read, self.agreed) = (0, false);
        self.starts += 1;
        let mut program = Program::start(display, command);
        program.window.focus();
        program.wait("the first picture", |window| {
            window.title().contains("certified").then_some(())
        });
        self.listen(&program);
        program
    }

    /// Keeps what is in the file, if that has no mistake: the program may have saved.
    fn keep_good(&mut self) {
        let text = self.file.read();
        let other = self.file.beside(TRIED);
        std::fs::write(&other, &text).unwrap();
        if load(&other).is_ok() {
            self.good = text;
        }
    }

    fn scene(&self, text: &str) -> Scene {
        let other = self.file.beside(TRIED);
        std::fs::write(&other, text).unwrap();
        load(&other).unwrap()
    }

    /// Takes the log as far as it goes.
    fn listen(&mut self, program: &Program<'_>) {
        self.hear(&program.said_from(self.read));
    }

    /// Takes what the log says from where it was read last.
    fn hear(&mut self, said: &str) {
        let Some(end) = said.rfind('\n') else {
            return;
        };
        for line in said[..end].lines() {
            let Some((_, told)) = line.split_once("session::report] ") else {
                let fine = ["[INFO", "[DEBUG"].iter().any(|level| line.contains(level));
                assert!(fine, "{} says {line}; {}", self.name, self.last());
                if line.contains(" closed without ") {
                    self.agreed = true;
                }
                if line.contains(" opened ") {
                    self.nothing_is_lost();
                    self.model.forget();
                }
                continue;
            };
            self.agreed = false;
            let taken = self.model.take(told);
            assert!(
                taken.is_ok(),
                "{}: {}; after {told}; {}",
                self.name,
                taken.unwrap_err(),
                self.last()
            );
        }
        self.read += end + 1;
    }

    fn last(&self) -> String {
        let last = self.done.len().saturating_sub(12);
        format!("step {}, last {:?}", self.steps, &self.done[last..])
    }

    /// Saves, and compares the file with what is shown. Whether the window is still there.
    fn check(&mut self, program: &mut Program<'_>) -> bool {
        if load(&self.file.path).is_err() {
            self.file.write(&self.good);
        }
        program.window.resize(1000, 800);
        let start = Instant::now();
        // Whatever is open is closed; a question that was asked is answered with no.
        loop {
            for key in [keys::ESCAPE, keys::ESCAPE] {
                program.window.key(key, &[]);
            }
            thread::sleep(Duration::from_millis(100));
            program.window.key('s'.into(), &[keys::CONTROL]);
            let settle = Instant::now();
            while settle.elapsed() < Duration::from_millis(500) {
                thread::sleep(Duration::from_millis(20));
                if program.has_ended().is_some() {
                    return false;
                }
                self.listen(program);
                let quiet = !program.window.title().contains(['*']);
                if quiet && self.model.shown == self.model.file && self.is_in_file() {
                    self.checks += 1;
                    self.keep_good();
                    return true;
                }
            }
            if start.elapsed() > Duration::from_secs(60) {
                let shot = std::env::temp_dir().join("monkey.png");
                program.window.screenshot().map(|image| image.save(&shot));
                panic!(
                    "{}: it is not saved; shown but not in the file as the program knows it: {:?}; title {}, {}",
                    self.name,
                    differing(&self.model.shown, &self.model.file),
                    program.window.title(),
                    self.last()
                );
            }
        }
    }

    /// Whether the file has what the model has, and all its comments.
    fn is_in_file(&self) -> bool {
        let text = self.file.read();
        let comments = |text: &str| -> Vec<String> {
            let lines = text.lines().filter_map(|line| line.split_once('#'));
            lines.map(|(_, comment)| comment.to_owned()).collect()
        };
        load(&self.file.path).is_ok_and(|scene| numbers(&scene) == self.model.file)
            && comments(&text) == comments(&self.good)
    }

    /// It ended by itself: nothing was to be lost, or it was asked for.
    fn ended(&mut self, program: Program<'_>) {
        let ended = program.end();
        self.hear(&ended.said[self.read..]);
        assert!(
            ended.status.success(),
            "{}: {}; {}; {}",
            self.name,
            ended.status,
            ended.said,
            self.last()
        );
        self.nothing_is_lost();
        self.keep_good();
    }

    /// The window closes, or turns to a scene: changes are lost only where that was agreed to.
    fn nothing_is_lost(&mut self) {
        let lost = self.model.to_be_lost();
        assert!(
            std::mem::take(&mut self.agreed) || lost == 0,
            "{}: {lost} changes are lost; {}",
            self.name,
            self.last()
        );
    }
}

/// All numbers of a scene, as the log calls them.
fn numbers(scene: &Scene) -> Numbers {
    let mut numbers = Numbers::new();
    let mut add = |entity: EntityId, kind: &str, name: &str| {
        for target in Target::all_of(scene, entity) {
            if let Some(value) = target.value_in(scene) {
                let key = format!("{kind} {name} {}", target.attribute());
                numbers.insert(key, value.numbers().to_vec());
            }
        }
    };
    add(EntityId::Camera, "camera", &scene.camera.name);
    for (i, it) in scene.materials.iter().enumerate() {
        add(EntityId::Material(i), "material", &it.name);
    }
    for (i, it) in scene.objects.iter().enumerate() {
        add(EntityId::Object(i), it.entity(), &it.name);
    }
    for (i, it) in scene.lights.iter().enumerate() {
        add(EntityId::Light(i), it.entity(), &it.name);
    }
    numbers
}

#[test]
fn names_are_not_used_twice() {
    let file = File::new(KINDS);
    let stage = common::scenes().join("lit/spotlight_stage.txt");
    for path in [Path::new(&file.path), &stage] {
        let scene = load(path).unwrap();
        let count = 1 + scene.materials.len() + scene.objects.len() + scene.lights.len();
        let numbers = numbers(&scene);
        let mut names: Vec<_> = numbers
            .keys()
            .map(|key| key.rsplit_once(' ').unwrap().0)
            .collect();
        names.dedup();
        names.sort_unstable();
        names.dedup();
        assert_eq!(names.len(), count);
    }
}
