//! `plumb render` of one scene or of many: which pictures there will be, and how they follow each other.
//!
//! A few threads take the scenes in order, and each goes the whole way with its own: while one reads and prepares the
//! next scene, another one renders, and a third writes the picture before. More than these three are never in memory.

use std::collections::HashMap;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Mutex, PoisonError};
use std::thread;
use std::time::Instant;

use anyhow::{Error, Result, anyhow, bail};
use plumb::diagnostic::visible_text;
use plumb::files::{Identity, identity};
use plumb::image::{Format, OutputError, Target};
use plumb::probe::digits::count;
use plumb::scene::{LoadError, Scene};
use serde_json::json;

use super::args::RenderOptions;
use super::place::{Place, Queue};
use super::render::{self, Args, RenderCommand};
use super::targets::Targets;
use super::{Answer, SOFTWARE, say, source};

/// Pictures under way at once: one that is written, one that is rendered, one that is prepared.
const AT_ONCE: usize = 3;

/// So many of those that failed are named in the end.
const NAMED: usize = 5;

/// Renders the scenes.
pub(crate) fn run(args: &Args) -> Result<Answer> {
    match &args.scenes[..] {
        [scene] => render::one(scene, args),
        _ if args.parts.job()?.is_some() => {
            bail!("--part and --resume are of one picture: give one scene")
        }
        scenes => Run::new(scenes, &args.options)?.run(),
    }
}

/// A run of many pictures.
struct Run<'a> {
    scenes: &'a [PathBuf],
    options: &'a RenderOptions,
    /// What is written, and of which scene.
    written: HashMap<Identity, usize>,
    /// Whether a picture goes to stdout, so that reports go to stderr.
    to_stdout: bool,
    next: AtomicUsize,
    ended: Mutex<Ended>,
}

/// How pictures ended.
#[derive(Default)]
struct Ended {
    made: usize,
    /// Names of scenes.
    failed: Vec<String>,
    /// Whether a picture is made of which the answer is no.
    any_no: bool,
    /// What ended all, the others' pictures too.
    broken: Option<Error>,
}

impl<'a> Run<'a> {
    /// Refuses what would be regretted before anything is rendered.
    fn new(scenes: &'a [PathBuf], options: &'a RenderOptions) -> Result<Self> {
        // `plumb render scene.txt picture.png` is how other programs have it.
        let picture = scenes[1..].iter().find(|s| Format::from_path(s).is_ok());
        if let Some(picture) = picture {
            let picture = picture.display();
            bail!("{picture} is no name of a scene; to name the picture: -o {picture}");
        }
        if options.shown().is_some() {
            bail!("--debug lists the pixels of one picture: give one scene");
        }
        let mut written = HashMap::new();
        let mut to_stdout = false;
        for (number, scene) in scenes.iter().enumerate() {
            let targets = Targets::new(options, render::file(scene))?;
            to_stdout |= targets.picture.is_stdout();
            for target in [Some(targets.picture), targets.verdicts]
                .into_iter()
                .flatten()
            {
                let Some(identity) = target.identity()? else {
                    continue;
                };
                let other = written.insert(identity, number);
                if let Some(other) = other.filter(|other| *other != number) {
                    return Err(one_file(&scenes[other], scene, &target));
                }
            }
        }
        for scene in scenes {
            if let Some(&writer) = identity(scene).and_then(|known| written.get(&known)) {
                let [scene, writer] = [scene, &scenes[writer]].map(|path| path.display());
                bail!("{scene} would be overwritten by the picture of {writer}: give another -o");
            }
        }
        Ok(Self {
            scenes,
            options,
            written,
            to_stdout,
            next: AtomicUsize::new(0),
            ended: Mutex::default(),
        })
    }

    fn run(self) -> Result<Answer> {
        render::start_threads(self.options);
        let started = Instant::now();
        let talks = !(self.options.quiet || self.options.json && self.to_stdout);
        let queue = Queue::new(self.scenes.len(), talks);
        thread::scope(|scope| {
            for _ in 1..AT_ONCE {
                // Where there can be no thread, this one does it all.
                let _ = thread::Builder::new()
                    .name("pictures".into())
                    .spawn_scoped(scope, || self.work(&queue));
            }
            self.work(&queue);
        });
        queue.clear();
        let ended = self.ended.into_inner();
        let ended = ended.unwrap_or_else(PoisonError::into_inner);
        if let Some(error) = ended.broken {
            return Err(error);
        }
        if talks && !(self.options.json && ended.failed.is_empty()) {
            let seconds = started.elapsed().as_secs_f64();
            let line = format!("{}, {seconds:.2} s", ended.summary());
            say::talk(&format!("{}\n", visible_text(&line)));
        }
        Ok(if !ended.failed.is_empty() {
            Answer::Bad
        } else if ended.any_no {
            Answer::No
        } else {
            Answer::Yes
        })
    }

    /// Makes pictures until there are no more to make.
    fn work(&self, queue: &Queue) {
        loop {
            let number = self.next.fetch_add(1, Ordering::Relaxed);
            let Some(scene) = self.scenes.get(number) else {
                return;
            };
            let name = source::name(scene);
            let place = queue.place(number, &name);
            place.wait_to_read();
            if queue.is_cut() {
                continue;
            }
            let made = self.make(scene, &name, &place);
            // What is told comes in the order of the scenes.
            place.turn().pass();
            // Whether one before was cut off, `tell` sees.
            let _ = place.wait_to_write();
            self.tell(&name, made, queue);
        }
    }

    fn make(&self, scene: &Path, name: &str, place: &Place<'_>) -> Result<Answer> {
        let loaded = source::load_with_text(scene)?;
        self.check_textures(&loaded.0, place.turn().number())?;
        let file = render::file(scene);
        let targets = Targets::new(self.options, file)?;
        RenderCommand::new((name, file), loaded, targets, self.options, Some(place)).run()
    }

    /// Whether the scene would show what this run writes, before or after it is written.
    fn check_textures(&self, scene: &Scene, number: usize) -> Result<()> {
        for texture in &scene.textures {
            let writer = identity(&texture.path).and_then(|known| self.written.get(&known));
            // That it is its own picture the rendering tells.
            if let Some(&writer) = writer.filter(|writer| **writer != number) {
                bail!(
                    "its texture `{}` is the picture of {} in this run: render that one before, by itself",
                    texture.name,
                    self.scenes[writer].display()
                );
            }
        }
        Ok(())
    }

    /// Tells what came of a picture, if it did not tell itself.
    fn tell(&self, name: &str, made: Result<Answer>, queue: &Queue) {
        let mut ended = self.ended.lock().unwrap_or_else(PoisonError::into_inner);
        let error = match made {
            Ok(answer) => {
                ended.made += 1;
                ended.any_no |= answer == Answer::No;
                return;
            }
            // Behind a picture that was cut off there is none.
            Err(_) if queue.is_cut() && ended.broken.is_some() => return,
            Err(error) => error,
        };
        if say::is_broken_pipe(&error) {
            ended.broken = Some(error);
            return;
        }
        if queue.is_cut() {
            let why = say::causes(&error);
            ended.broken = Some(anyhow!("{name}: {why}; so no others can follow it"));
            return;
        }
        ended.failed.push(name.to_owned());
        if self.options.json {
            let json = json!({ "software": SOFTWARE, "scene": name, "error": say::causes(&error) });
            let line = format!("{json}\n");
            if self.to_stdout {
                say::talk(&line);
            } else {
                // Where nobody reads the report, the error is there all the same.
                let _ = say::data(&line);
            }
        }
        let names_it = error.is::<LoadError>() || error.is::<OutputError>();
        say::error(&if names_it {
            error
        } else {
            error.context(name.to_owned())
        });
    }
}

impl Ended {
    /// `2 of 3 pictures, without b.txt`.
    fn summary(&self) -> String {
        if self.failed.is_empty() {
            return count(self.made, "picture");
        }
        let all = count(self.made + self.failed.len(), "picture");
        let mut named = self.failed[..self.failed.len().min(NAMED)].join(", ");
        if self.failed.len() > NAMED {
            named += &format!(" and {} more", self.failed.len() - NAMED);
        }
        format!("{} of {all}, without {named}", self.made)
    }
}

/// Why two pictures are refused that would be one file.
fn one_file(first: &Path, second: &Path, target: &Target) -> Error {
    let [first, second] = [first, second].map(Path::display);
    anyhow!(
        "{first} and {second} would both become {target}: give a folder, or a name with {{}} for the scene's, such as \
        -o 'out/{{}}.png'; where two scenes have one name, render them one by one"
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_summary_names_some_of_those_that_failed() {
        let mut ended = Ended {
            made: 3,
            ..Ended::default()
        };
        assert_eq!(ended.summary(), "3 pictures");
        ended.failed.push("b.txt".into());
        assert_eq!(ended.summary(), "3 of 4 pictures, without b.txt");
        ended.failed.extend((0..7).map(|n| n.to_string()));
        assert_eq!(
            ended.summary(),
            "3 of 11 pictures, without b.txt, 0, 1, 2, 3 and 3 more"
        );
    }
}
