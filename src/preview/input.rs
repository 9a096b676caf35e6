//! What the user does, in the order in which it was done, between winit and egui.
//!
//! egui takes all events of a frame at once: where the mouse is at the end of it is what was clicked in it, and whoever
//! reads keys first puts those that were struck last before what the mouse did. Where frames are slow, much happens in
//! one of them. So events that egui would take in another order wait for the next frame, which comes at once.

use std::collections::VecDeque;

use eframe::egui::{Event, Key};

/// Where more events than so many wait, more is done than frames can follow: all of them are one frame's then, since a
/// window that lags behind is worse than a click that is elsewhere.
const MOST: usize = 256;

/// What an event is to the order.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Step {
    /// A key goes down, or the keys are struck that copy or paste: what has the keyboard then may be something else.
    Key(Option<Key>),
    /// A key comes up.
    Up(Key),
    /// The mouse is moved.
    Moves,
    /// Its wheel is turned.
    Turns,
    /// A button goes down.
    Press,
    /// It comes up.
    Release,
}

impl Step {
    /// None for what may come at any time, such as the text that a key makes.
    fn of(event: &Event) -> Option<Self> {
        Some(match event {
            Event::Key {
                key, pressed: true, ..
            } => Self::Key(Some(*key)),
            Event::Copy | Event::Cut | Event::Paste(_) | Event::Ime(_) => Self::Key(None),
            Event::Key { key, .. } => Self::Up(*key),
            Event::PointerMoved(_) | Event::PointerGone => Self::Moves,
            Event::MouseWheel { .. } | Event::Zoom(_) => Self::Turns,
            Event::PointerButton { pressed: true, .. } => Self::Press,
            Event::PointerButton { pressed: false, .. } => Self::Release,
            _ => return None,
        })
    }

    /// Whether this may come after that in one frame; while a button is held, what moves drags.
    fn follows(self, last: Self, drags: bool) -> bool {
        match (last, self) {
            // One that is held comes again and again, faster than frames perhaps.
            (Self::Key(last), Self::Key(this)) => last.is_some() && last == this,
            // Whoever reads keys does so before it asks where the mouse is; that is where it was moved to when a button
            // goes down; and egui takes a press and its release for a click.
            (_, Self::Up(_))
            | (Self::Key(_) | Self::Up(_) | Self::Moves, Self::Moves | Self::Turns)
            | (Self::Turns, Self::Turns)
            | (Self::Moves, Self::Press)
            | (Self::Press, Self::Release) => true,
            // The mouse is somewhere else: that is all.
            (Self::Moves, Self::Key(_)) => !drags,
            (
                Self::Key(_)
                | Self::Up(_)
                | Self::Moves
                | Self::Turns
                | Self::Press
                | Self::Release,
                _,
            ) => false,
        }
    }
}

/// Events that wait for their frame.
#[derive(Debug, Default)]
pub(super) struct Waiting {
    events: VecDeque<Event>,
    /// How many buttons of the mouse are held, as far as egui knows.
    held: usize,
    /// How many events were left for a frame that has not been drawn, and how many buttons were held before them.
    left: (usize, usize),
}

impl Waiting {
    /// Takes the events that came, and leaves those of them and of earlier ones that are this frame's.
    pub(super) fn take_turns(&mut self, events: &mut Vec<Event>) {
        let (left, held) = std::mem::take(&mut self.left);
        if left > 0 {
            // A window that nobody sees draws no frame: what was left for it comes again, before what waits.
            for event in events.drain(..left.min(events.len())).rev() {
                self.events.push_front(event);
            }
            self.held = held;
        }
        self.events.extend(events.drain(..));
        let held = self.held;
        self.choose(events);
        self.left = (events.len(), held);
    }

    /// Leaves those that are one frame's.
    fn choose(&mut self, events: &mut Vec<Event>) {
        let in_turn = self.events.len() <= MOST;
        let mut last = None;
        while let Some(event) = self.events.pop_front() {
            let step = Step::of(&event);
            if in_turn
                && let (Some(last), Some(step)) = (last, step)
                && !step.follows(last, self.held > 0)
            {
                self.events.push_front(event);
                return;
            }
            // A key that comes up says something only of the one that went down last.
            if !matches!(step, Some(Step::Up(key)) if last != Some(Step::Key(Some(key)))) {
                last = step.or(last);
            }
            match step {
                Some(Step::Press) => self.held += 1,
                Some(Step::Release) => self.held = self.held.saturating_sub(1),
                _ => {}
            }
            events.push(event);
        }
    }

    /// The frame that events were left for is drawn.
    pub(super) fn drawn(&mut self) {
        self.left = Default::default();
    }

    /// Whether some wait for the next frame.
    pub(super) fn is_empty(&self) -> bool {
        self.events.is_empty()
    }
}

#[cfg(test)]
mod tests {
    use eframe::egui::{Modifiers, PointerButton, Pos2};

    use super::*;

    fn key(key: Key, pressed: bool) -> Event {
        Event::Key {
            key,
            physical_key: None,
            pressed,
            repeat: false,
            modifiers: Modifiers::NONE,
        }
    }

    fn moved(x: f32) -> Event {
        Event::PointerMoved(Pos2::new(x, 0.0))
    }

    fn button(x: f32, pressed: bool) -> Event {
        Event::PointerButton {
            pos: Pos2::new(x, 0.0),
            button: PointerButton::Primary,
            pressed,
            modifiers: Modifiers::NONE,
        }
    }

    #[test]
    fn what_comes_in_one_frame_is_done_one_after_the_other() {
        let frames = [
            // A click is where the mouse was then, not where it is now.
            vec![
                key(Key::A, true),
                moved(1.0),
                moved(2.0),
                button(2.0, true),
                button(2.0, false),
            ],
            vec![moved(3.0), button(3.0, true)],
            // A drag is one, however short it is.
            vec![moved(4.0), moved(5.0)],
            vec![button(5.0, false)],
            vec![button(5.0, true), button(5.0, false)],
            // Keys count after what the mouse did before.
            vec![button(5.0, true)],
            vec![moved(6.0)],
            vec![key(Key::S, true), key(Key::S, false)],
            vec![button(6.0, false)],
            // Where nothing is dragged it did nothing.
            vec![
                moved(7.0),
                key(Key::S, true),
                Event::Text("s".into()),
                key(Key::S, false),
            ],
            // Each may give the keyboard to something else, but one that is held is one.
            vec![key(Key::Tab, true), key(Key::Tab, false)],
            vec![key(Key::Tab, true)],
            vec![key(Key::X, true), key(Key::Tab, false), key(Key::X, true)],
            vec![Event::Paste("x".into())],
            vec![Event::Paste("y".into()), moved(6.0), key(Key::X, false)],
        ];
        let mut waiting = Waiting::default();
        let mut events = frames.concat();
        for (i, frame) in frames.iter().enumerate() {
            waiting.take_turns(&mut events);
            assert_eq!(&events, frame, "{i}");
            assert_eq!(waiting.is_empty(), i + 1 == frames.len(), "{i}");
            waiting.drawn();
            events.clear();
        }
        waiting.take_turns(&mut events);
        assert!(events.is_empty());
    }

    #[test]
    fn what_no_frame_has_taken_comes_again_in_order() {
        let frames = [
            vec![moved(1.0), button(1.0, true)],
            vec![moved(2.0)],
            vec![key(Key::S, true)],
            vec![button(2.0, false)],
            vec![moved(3.0), key(Key::T, true)],
        ];
        let mut waiting = Waiting::default();
        // Of a window that is not seen, what was left is there again with what came since.
        let mut events = frames[..2].concat();
        for later in [&frames[2..4].concat()[..], &[], &frames[4]] {
            waiting.take_turns(&mut events);
            assert_eq!(events, frames[0]);
            events.extend_from_slice(later);
        }
        for (i, frame) in frames.iter().enumerate() {
            waiting.take_turns(&mut events);
            assert_eq!(&events, frame, "{i}");
            waiting.drawn();
            events.clear();
        }
        assert!(waiting.is_empty());
    }

    #[test]
    fn more_than_frames_can_follow_is_one_frame() {
        let mut waiting = Waiting::default();
        let burst = [button(1.0, true), moved(2.0)];
        let mut events: Vec<_> = burst.iter().cycle().take(2 * MOST).cloned().collect();
        let all = events.clone();
        waiting.take_turns(&mut events);
        assert_eq!(events, all);
        assert!(waiting.is_empty());
    }

    #[test]
    fn what_comes_later_waits_for_what_came_before() {
        let mut waiting = Waiting::default();
        let turned = Event::Zoom(2.0);
        let mut events = vec![turned.clone(), key(Key::A, true)];
        waiting.take_turns(&mut events);
        assert_eq!(events, [turned]);
        waiting.drawn();
        let mut events = vec![key(Key::B, true), moved(2.0), Event::WindowFocused(false)];
        waiting.take_turns(&mut events);
        assert_eq!(events, [key(Key::A, true)]);
        waiting.drawn();
        events.clear();
        waiting.take_turns(&mut events);
        let rest = [key(Key::B, true), moved(2.0), Event::WindowFocused(false)];
        assert_eq!(events, rest);
    }
}
