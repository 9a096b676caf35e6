//! Which adapters are trusted with certified pixels: those that passed the self-test, once a process and, where there
//! is a folder to remember it in, once a driver (if that tells its version).
//!
//! The folder holds one small file for each adapter and driver. It may be deleted at any time, and a file that cannot
//! be read or written only means that the test is run again.

use std::collections::BTreeSet;
use std::fs;
use std::io::{self, Write as _};
use std::path::{Path, PathBuf};
use std::sync::{Mutex, MutexGuard, PoisonError};

use crate::gpu::device::Gpu;
use crate::gpu::selftest::Outcome;
use crate::gpu::{GpuError, selftest};

/// What passed since the process started.
static PASSED: Mutex<BTreeSet<String>> = Mutex::new(BTreeSet::new());

fn passed() -> MutexGuard<'static, BTreeSet<String>> {
    PASSED.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Refuses a device that does not pass the test.
///
/// # Errors
/// [`GpuError::Untrusted`].
pub fn check(gpu: &Gpu, folder: Option<&Path>) -> Result<(), GpuError> {
    match doubts(gpu, folder) {
        None => Ok(()),
        Some(failures) => Err(GpuError::Untrusted {
            adapter: gpu.name.clone(),
            failures,
        }),
    }
}

/// Tests the device, unless it is known to pass. Returns what failed, if anything; that the test cannot be run is a
/// failure.
pub fn doubts(gpu: &Gpu, folder: Option<&Path>) -> Option<String> {
    passes(gpu, &note(gpu), folder, selftest::run)
}

/// Whether the device has f64 and computes with it as it should.
pub fn has_doubles(gpu: &Gpu, folder: Option<&Path>) -> bool {
    if !gpu.doubles {
        return false;
    }
    let failures = passes(gpu, &note_of_doubles(gpu), folder, selftest::run_double);
    if let Some(failures) = &failures {
        log::info!("{} is not trusted with f64: {failures}", gpu.name);
    }
    failures.is_none()
}

/// What fails of a test that is remembered by a note, if anything.
fn passes(
    gpu: &Gpu,
    note: &str,
    folder: Option<&Path>,
    test: fn(&Gpu) -> Result<Vec<Outcome>, GpuError>,
) -> Option<String> {
    // Another version of the driver must not pass for this one.
    let folder = folder.filter(|_| gpu.tells_version);
    if is_known(note, folder) {
        return None;
    }
    let failures = match test(gpu) {
        Ok(outcomes) => selftest::failures(&outcomes),
        Err(error) => Some(error.to_string()),
    };
    if failures.is_none() {
        remember(note, folder);
    }
    failures
}

/// Takes the trust back: the next certified rendering tests the device again.
pub fn revoke(gpu: &Gpu, folder: Option<&Path>) {
    for note in [note(gpu), note_of_doubles(gpu)] {
        passed().remove(&note);
        if let Some(folder) = folder {
            // A file that is missing needs no removing.
            let _ = fs::remove_file(file(&note, folder));
        }
    }
}

/// What is remembered of a device that passed the self-test.
fn note(gpu: &Gpu) -> String {
    note_of(gpu, "the self-test", selftest::version())
}

/// The same of its f64.
fn note_of_doubles(gpu: &Gpu) -> String {
    note_of(gpu, "the self-test with f64", selftest::double_version())
}

/// All that may change how a device computes, and which version of which test it passed.
fn note_of(gpu: &Gpu, test: &str, version: u64) -> String {
    format!(
        "plumb: this adapter passed {test}. This file may be deleted.\n{}\ntest {version:016x}\n",
        gpu.identity
    )
}

fn file(note: &str, folder: &Path) -> PathBuf {
    use std::hash::{DefaultHasher, Hash as _, Hasher as _};
    let mut hasher = DefaultHasher::new();
    note.hash(&mut hasher);
    folder.join(format!("passed-{:016x}.txt", hasher.finish()))
}

fn is_known(note: &str, folder: Option<&Path>) -> bool {
    #[cfg(test)]
    if tests::FORGETFUL.get() {
        return false;
    }
    passed().contains(note)
        || folder.is_some_and(|folder| {
            fs::read(file(note, folder)).is_ok_and(|found| found == note.as_bytes())
        })
}

fn remember(note: &str, folder: Option<&Path>) {
    passed().insert(note.to_owned());
    if let Some(folder) = folder
        && let Err(error) = write(note, folder)
    {
        log::info!(
            "{} cannot remember the self-test: {error}",
            folder.display()
        );
    }
}

/// Writes the note under another name and renames it, so that nobody reads half of it.
fn write(note: &str, folder: &Path) -> io::Result<()> {
    fs::create_dir_all(folder)?;
    let mut beside = tempfile::NamedTempFile::new_in(folder)?;
    beside.write_all(note.as_bytes())?;
    beside.persist(file(note, folder))?;
    Ok(())
}

#[cfg(test)]
pub(crate) mod tests {
    use std::cell::Cell;

    use super::*;

    thread_local! {
        /// Whether this thread knows of no adapter that passed, whatever other tests did.
        pub(super) static FORGETFUL: Cell<bool> = const { Cell::new(false) };
    }

    /// Makes all adapters unknown to this thread, or not any more.
    pub(crate) fn forget_all(forget: bool) {
        FORGETFUL.set(forget);
    }

    /// Makes another thread forget what this one does.
    pub(crate) fn carry() -> Box<dyn FnOnce() + Send> {
        let forgetful = FORGETFUL.get();
        Box::new(move || FORGETFUL.set(forgetful))
    }

    #[test]
    fn a_note_is_found_again_and_only_as_it_was() {
        let folder = tempfile::tempdir().unwrap();
        let folder = folder.path().join("not/there/yet");
        let note = "an adapter of this test, driver 1";
        assert!(!is_known(note, Some(&folder)));
        remember(note, Some(&folder));
        passed().remove(note);
        assert!(is_known(note, Some(&folder)));
        assert!(!is_known(
            "an adapter of this test, driver 2",
            Some(&folder)
        ));
        assert!(!is_known(note, None));
        fs::write(file(note, &folder), "half").unwrap();
        assert!(!is_known(note, Some(&folder)));
    }

    #[test]
    fn a_folder_that_cannot_be_written_is_no_error() {
        let beside = tempfile::NamedTempFile::new().unwrap();
        let note = "another adapter of this test";
        remember(note, Some(&beside.path().join("sub")));
        assert!(is_known(note, None), "it is remembered in the process");
    }

    /// Needs an adapter, and fails without one.
    #[test]
    fn a_device_is_tested_once_and_again_when_its_trust_is_revoked() {
        let folder = tempfile::tempdir().unwrap();
        let mut gpu = crate::gpu::adapters::open(None).unwrap();
        gpu.identity += " of this test";
        gpu.tells_version = true;
        assert_eq!(doubts(&gpu, Some(folder.path())), None);
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 1);
        // The device would fail the test now, if it were tested.
        selftest::tests::spoil_next(Some(0));
        assert_eq!(doubts(&gpu, Some(folder.path())), None);
        revoke(&gpu, Some(folder.path()));
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 0);
        let failed = doubts(&gpu, Some(folder.path())).unwrap();
        assert!(failed.starts_with("x + y: "), "{failed}");
        assert_eq!(
            fs::read_dir(folder.path()).unwrap().count(),
            0,
            "a failure is not remembered"
        );
        selftest::tests::spoil_next(None);
        gpu.tells_version = false;
        assert_eq!(doubts(&gpu, Some(folder.path())), None);
        assert_eq!(
            fs::read_dir(folder.path()).unwrap().count(),
            0,
            "nor what cannot be told from its next version"
        );
    }

    /// Needs an adapter, and fails without one. A device whose f64 is wrong does without; it is as good as before.
    #[test]
    fn f64_is_trusted_by_itself() {
        let folder = tempfile::tempdir().unwrap();
        let mut gpu = crate::gpu::adapters::open(None).unwrap();
        gpu.identity += " of another test";
        gpu.tells_version = true;
        let has = gpu.doubles;
        selftest::tests::spoil_next_double(Some(0));
        assert!(!has_doubles(&gpu, Some(folder.path())));
        assert_eq!(doubts(&gpu, Some(folder.path())), None);
        selftest::tests::spoil_next_double(None);
        assert_eq!(has_doubles(&gpu, Some(folder.path())), has);
        assert_eq!(
            fs::read_dir(folder.path()).unwrap().count(),
            1 + usize::from(has)
        );
        // It would fail now, if it were asked.
        selftest::tests::spoil_next_double(Some(0));
        assert_eq!(has_doubles(&gpu, Some(folder.path())), has);
        revoke(&gpu, Some(folder.path()));
        assert!(!has_doubles(&gpu, Some(folder.path())));
        selftest::tests::spoil_next_double(None);
        gpu.doubles = false;
        assert!(!has_doubles(&gpu, None));
    }
}
