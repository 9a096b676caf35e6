//! What comes to a monkey's mind.

use std::thread;
use std::time::Duration;

use plumb::edit::{Changes, Target, Value};
use plumb::scene::EntityId;

use super::Monkey;
use crate::program::Program;
use crate::x11::{LEFT, MIDDLE, RIGHT, Window, keys};

/// Keys that do something, and some that only fields of text take.
const KEYS: &[u32] = &[
    keys::LEFT,
    keys::RIGHT,
    keys::UP,
    keys::DOWN,
    keys::PAGE_UP,
    keys::PAGE_DOWN,
    keys::HOME,
    keys::END,
    keys::TAB,
    keys::RETURN,
    keys::ESCAPE,
    keys::ESCAPE,
    keys::BACKSPACE,
    keys::DELETE,
    keys::F1,
];

/// Characters that are typed.
const CHARACTERS: &str = "0123456789.-rfvioctp+sszzzyzwq";

/// Where nothing is to be lost a window is closed once in so many times that this comes to the monkey's mind: windows
/// are to live for minutes, since memory that grows is seen in nothing else.
const CLOSES: i32 = 300;

/// A question is left on the screen once in so many times: what comes to the monkey's mind then soon closes the window.
const STAYS: i32 = 150;

/// A question needs about so long to be on the screen.
const QUESTION: Duration = Duration::from_millis(80);

impl Monkey<'_> {
    /// Whatever comes to its mind.
    pub(super) fn act(&mut self, program: &Program<'_>) {
        let window = program.window;
        let Some((width, height)) = window.size_if_there() else {
            return;
        };
        let random = &mut self.random;
        let mut place = || (random.below(width as i32), random.below(height as i32));
        let (from, to) = (place(), place());
        let what = random.below(100);
        self.done.push(format!("{what} {from:?} {to:?}"));
        match what {
            0..=24 => {
                let key = self.random.of(KEYS);
                let held: &[u32] =
                    self.random
                        .of(&[&[][..], &[], &[keys::SHIFT], &[keys::CONTROL]]);
                window.key(key, held);
            }
            25..=49 => {
                let characters: Vec<char> = CHARACTERS.chars().collect();
                let key = self.random.of(&characters);
                match self.random.below(4) {
                    0 | 1 if "wq".contains(key) => self.close(program, |window| {
                        window.key(key.into(), &[keys::CONTROL]);
                    }),
                    0 | 1 if key == 'o' => self.open(program),
                    0 | 1 => window.key(key.into(), &[keys::CONTROL]),
                    2 if key == 'z' => window.key(key.into(), &[keys::CONTROL, keys::SHIFT]),
                    _ => window.key(key.into(), &[]),
                }
            }
            50..=64 => window.click(from.0, from.1),
            65..=84 => {
                let button = self.random.of(&[LEFT, LEFT, LEFT, RIGHT, MIDDLE]);
                let near = (from.0 + (to.0 - from.0) / 8, from.1 + (to.1 - from.1) / 8);
                let to = self.random.of(&[near, near, to]);
                window.move_to(from.0, from.1);
                window.press(button);
                let steps = 1 + self.random.below(8);
                for step in 1..=steps {
                    thread::sleep(Duration::from_millis(self.random.below(40) as u64));
                    let part = |from: i32, to: i32| from + (to - from) * step / steps;
                    window.move_to(part(from.0, to.0), part(from.1, to.1));
                }
                window.release(button);
            }
            85..=91 => {
                window.move_to(from.0, from.1);
                window.wheel(self.random.below(7) - 3);
            }
            92..=93 => {
                let size = (420 + self.random.below(900), 320 + self.random.below(550));
                window.resize(size.0 as u32, size.1 as u32);
            }
            94..=97 => self.write(),
            98 if self.random.below(4) == 0 => {
                self.close(program, |window| window.ask_to_close());
            }
            _ => {
                // A mistake for a while, wherever the text is cut off.
                let end = self.good.len() * self.random.below(100) as usize / 100;
                let start = self.good.get(..end).unwrap_or_default();
                self.file.write(&format!("{start}\ncamera {{"));
            }
        }
    }

    /// Wants the window closed. The question that comes where changes are not in the file is mostly answered with no;
    /// else it is there for whatever comes to its mind next.
    fn close(&mut self, program: &Program<'_>, ask: impl Fn(&Window<'_>)) {
        if self.model.to_be_lost() == 0 && self.random.below(CLOSES) > 0 {
            return;
        }
        ask(&program.window);
        if self.random.below(STAYS) > 0 {
            thread::sleep(QUESTION);
            program.window.key(keys::ESCAPE, &[]);
        }
    }

    /// Asks for another scene, and opens this one again or none: a path leads to everybody's files, so nothing is left
    /// to chance while it can be typed.
    fn open(&mut self, program: &Program<'_>) {
        let window = &program.window;
        window.key('o'.into(), &[keys::CONTROL]);
        thread::sleep(QUESTION);
        if self.random.below(2) == 0 {
            window.type_text(self.file.name());
            window.key(keys::RETURN, &[]);
            thread::sleep(QUESTION);
        } else {
            window.type_text("nothing");
            window.key(keys::TAB, &[]);
        }
        // The dialog is closed, or the question whether changes are to be lost is answered with no.
        for _ in 0..2 {
            window.key(keys::ESCAPE, &[]);
            thread::sleep(QUESTION);
        }
    }

    /// Somebody else writes a number into the file.
    fn write(&mut self) {
        self.keep_good();
        let scene = self.scene(&self.good);
        let all = [EntityId::Camera].into_iter();
        let all = all.chain((0..scene.materials.len()).map(EntityId::Material));
        let all = all.chain((0..scene.objects.len()).map(EntityId::Object));
        let all = all.chain((0..scene.lights.len()).map(EntityId::Light));
        let all = all.flat_map(|entity| Target::all_of(&scene, entity));
        // Those that cannot contradict others, whose changes would have to go with them.
        let all = all.filter(|target| {
            [
                "ambient",
                "diffuse",
                "radius",
                "center",
                "viewpoint",
                "emissivity",
                "theta",
            ]
            .contains(&target.attribute())
        });
        let all: Vec<_> = all.collect();
        let target = self.random.of(&all);
        let numbers = target.value_in(&scene).unwrap();
        let numbers = numbers.numbers().iter();
        let numbers: Vec<_> = numbers
            .map(|number| number + f64::from(self.random.below(9)) / 8.0)
            .collect();
        let mut changes = Changes::new();
        if changes
            .set(&scene, target, Value::new(&numbers).unwrap())
            .is_ok()
        {
            let text = changes.write(self.good.as_bytes()).unwrap();
            self.good = String::from_utf8(text).unwrap();
        }
        self.file.write(&self.good);
    }
}
