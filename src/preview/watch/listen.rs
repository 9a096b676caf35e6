//! Signs from the system that something happened to the file: where to listen, and anew when that changes.
//!
//! A folder is listened to, not the file: what is renamed over the file is another one. Where the path is a symbolic
//! link, so are the folder of the link's target and those in between.

use std::collections::BTreeSet;
use std::ffi::OsString;
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::SyncSender;

use notify::event::{AccessKind, AccessMode};
use notify::{Event, EventKind, RecommendedWatcher, RecursiveMode, Watcher};

/// Links after which a path is taken to lead nowhere, as the system does.
const MAX_LINKS: usize = 40;

/// Listens at the places where the file is, and gives a sign.
pub(super) struct Ears {
    wake: SyncSender<()>,
    /// Where it is listened to, or was tried to.
    places: Vec<Place>,
    listener: Option<Listener>,
}

/// A name in a folder.
#[derive(Debug, Clone, PartialEq, Eq)]
struct Place {
    /// Without links.
    folder: PathBuf,
    /// Another folder may take the place of this one.
    identity: Identity,
    name: OsString,
}

struct Listener {
    /// Listens until it is dropped.
    _watcher: RecommendedWatcher,
    /// Set when one of the folders is moved or removed: it is no longer heard what happens where it was.
    lost: Arc<AtomicBool>,
}

impl Ears {
    /// Gives signs to `wake`; listens nowhere yet.
    pub(super) fn new(wake: SyncSender<()>) -> Ears {
        Ears {
            wake,
            places: Vec::new(),
            listener: None,
        }
    }

    /// Listens where `path` leads now. This costs a few calls of the system when nothing changed.
    pub(super) fn turn_to(&mut self, path: &Path) {
        let places = places(path);
        if places == self.places && !self.is_lost() {
            return;
        }
        self.listener = None;
        self.places = places;
        // Without a folder there is nothing to say: the file is gone.
        if self.places.is_empty() {
            return;
        }
        match self.listen() {
            Ok(listener) => self.listener = Some(listener),
            Err(error) => log::warn!(
                "{}: changes are not told by the system ({error}), so the file is looked at every {} ms",
                path.display(),
                super::LOOK_DEAF.as_millis()
            ),
        }
    }

    /// Whether signs may come.
    pub(super) fn hear(&self) -> bool {
        self.listener.is_some()
    }

    /// Whether a folder that is listened to is no longer where it was.
    pub(super) fn is_lost(&self) -> bool {
        let lost = |listener: &Listener| listener.lost.load(Ordering::Relaxed);
        self.listener.as_ref().is_some_and(lost)
    }

    fn listen(&self) -> notify::Result<Listener> {
        let lost = Arc::new(AtomicBool::new(false));
        let folders: BTreeSet<PathBuf> = self.places.iter().map(|p| p.folder.clone()).collect();
        let names: Vec<OsString> = self.places.iter().map(|p| p.name.clone()).collect();
        let wake = self.wake.clone();
        let concerned = {
            let (lost, folders) = (Arc::clone(&lost), folders.clone());
            move |event: &Event| {
                let itself = event.paths.iter().any(|path| folders.contains(path));
                if itself && is_departure(event.kind) {
                    lost.store(true, Ordering::Relaxed);
                }
                // A folder may be where the file belongs, and a file named as its folder.
                let named = |path: &PathBuf| names.iter().any(|n| path.file_name() == Some(n));
                itself || event.need_rescan() || event.paths.iter().any(named)
            }
        };
        let mut watcher = notify::recommended_watcher(move |event: notify::Result<Event>| {
            // An error may mean lost signs, so it counts as a sign too.
            let sign = match event {
                Ok(event) => is_change(event.kind) && concerned(&event),
                Err(_) => true,
            };
            if sign {
                // A full channel is a sign that is waiting already.
                let _ = wake.try_send(());
            }
        })?;
        for folder in &folders {
            watcher.watch(folder, RecursiveMode::NonRecursive)?;
        }
        Ok(Listener {
            _watcher: watcher,
            lost,
        })
    }
}

/// Whether the file may be another after it. Reading it, which we do, is told as well.
fn is_change(kind: EventKind) -> bool {
    match kind {
        EventKind::Access(access) => access == AccessKind::Close(AccessMode::Write),
        _ => true,
    }
}

/// Whether what it is about is no longer where it was.
fn is_departure(kind: EventKind) -> bool {
    use notify::event::ModifyKind;
    matches!(
        kind,
        EventKind::Remove(_) | EventKind::Modify(ModifyKind::Name(_))
    )
}

/// Where the file is, and the links that lead to it; only as far as there are folders.
fn places(path: &Path) -> Vec<Place> {
    let mut places = Vec::new();
    let mut at = path.to_owned();
    while places.len() < MAX_LINKS {
        let (Some(name), Some(parent)) = (at.file_name(), at.parent()) else {
            break;
        };
        let parent = if parent.as_os_str().is_empty() {
            Path::new(".")
        } else {
            parent
        };
        let Ok(folder) = fs::canonicalize(parent) else {
            break;
        };
        let Some(identity) = identity(&folder) else {
            break;
        };
        places.push(Place {
            name: name.to_owned(),
            identity,
            folder: folder.clone(),
        });
        match fs::read_link(&at) {
            Ok(target) => at = folder.join(target),
            Err(_) => break,
        }
    }
    places
}

/// Device and inode.
#[cfg(unix)]
type Identity = (u64, u64);

#[cfg(unix)]
fn identity(folder: &Path) -> Option<Identity> {
    use std::os::unix::fs::MetadataExt;
    let metadata = fs::metadata(folder).ok()?;
    metadata.is_dir().then(|| (metadata.dev(), metadata.ino()))
}

/// When it was made.
#[cfg(not(unix))]
type Identity = Option<std::time::SystemTime>;

#[cfg(not(unix))]
fn identity(folder: &Path) -> Option<Identity> {
    let metadata = fs::metadata(folder).ok()?;
    metadata.is_dir().then(|| metadata.created().ok())
}
