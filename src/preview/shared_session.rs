//! The session and what was wished for of it, shared by the window and by who reads the file: a file that was written
//! is rendered at once, and does not wait for the window's next frame.

use std::path::Path;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::Instant;

use super::latest::LatestSender;
use super::session::{News, Saving, Session};
use super::worker::Wish;

/// A session under a lock, which nobody holds for long.
#[derive(Debug, Clone)]
pub(super) struct SharedSession {
    shared: Arc<Mutex<SessionState>>,
}

/// The session, and the wishes of it.
#[derive(Debug)]
pub(super) struct SessionState {
    /// The file, and what is changed on top of it.
    pub(super) session: Session,
    /// The number of the newest wish.
    pub(super) wished: u64,
    wishes: Arc<LatestSender<Wish>>,
}

impl SharedSession {
    /// With nothing wished for yet.
    pub(super) fn new(session: Session, wishes: Arc<LatestSender<Wish>>) -> Self {
        let state = SessionState {
            session,
            wished: 0,
            wishes,
        };
        Self {
            shared: Arc::new(Mutex::new(state)),
        }
    }

    /// The session.
    pub(super) fn lock(&self) -> MutexGuard<'_, SessionState> {
        self.shared.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Takes news of a file, unless the session is about another one by now. Whether something is rendered now; if not,
    /// there may be something to be said.
    pub(super) fn news_of(&self, path: &Path, news: News) -> bool {
        let mut state = self.lock();
        let changed = state.session.path == path && state.session.news(news);
        if changed {
            state.wish();
        }
        changed
    }
}

impl SharedSession {
    /// Writes changes into the file. What was done, or why not, in a sentence.
    ///
    /// # Errors
    /// Why not.
    pub(super) fn save(&self, saving: Saving) -> Result<String, String> {
        let path = saving.path().to_owned();
        let saved = saving.run(|text, changes| self.lock().session.expect(text, changes));
        let (version, told) = match saved {
            Ok((version, said)) => (Some(version), Ok(said)),
            Err(why) => (None, Err(why)),
        };
        self.lock().change(|session| {
            // Another scene may have been opened meanwhile.
            session.path == path && session.finish_saving(version)
        });
        told
    }
}

impl SessionState {
    /// Has what is wanted now rendered.
    pub(super) fn wish(&mut self) {
        if let Some((scene, changes)) = self.session.wanted() {
            self.wished = self.wishes.put(Wish {
                scene: Arc::clone(scene),
                changes: changes.clone(),
                rendering: self.session.rendering(),
                since: Instant::now(),
            });
        }
    }

    /// Changes something, and has it rendered where that is something else.
    pub(super) fn change(&mut self, change: impl FnOnce(&mut Session) -> bool) {
        if change(&mut self.session) {
            self.wish();
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::latest::latest;
    use super::super::session::Version;
    use super::*;

    const SCENE: &str = "camera cam { pixeldim 64 48 worlddim 8 6 viewpoint 4 3 6 }";

    #[test]
    fn what_is_new_is_wished_for_and_nothing_else() {
        let (wishes, receiver) = latest();
        let shared = SharedSession::new(Session::new("a.txt".into(), None), Arc::new(wishes));
        let tell = |text: &str| {
            let version = Version::read("a.txt".as_ref(), text.into());
            shared.news_of("a.txt".as_ref(), News::Version(version))
        };
        assert!(!tell("camera"));
        assert_eq!(shared.lock().wished, 0);
        assert!(tell(SCENE));
        assert!(!tell(SCENE));
        assert_eq!(shared.lock().wished, 1);
        assert!(tell(&SCENE.replace("4 3 6", "5 3 6")));
        let (number, wish) = receiver.take().unwrap();
        assert_eq!((number, wish.scene.camera.viewpoint.x), (2, 5.0));
        shared.lock().change(|session| session.discard(None));
        assert_eq!(shared.lock().wished, 2);
        // What is told of another file is not this one's.
        let version = Version::read("b.txt".as_ref(), SCENE.into());
        assert!(!shared.news_of("b.txt".as_ref(), News::Version(version)));
        assert_eq!(shared.lock().wished, 2);
    }
}
