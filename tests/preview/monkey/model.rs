//! What there is to be lost, as a model beside the program: all numbers of the file, what is shown in their place, and
//! what undo and redo lead to. Fed by the program's log, of which each line has to follow from those before.

use std::collections::{BTreeMap, BTreeSet};

/// Numbers by type, name and attribute.
pub(crate) type Numbers = BTreeMap<String, Vec<f64>>;

/// As many steps can be undone.
const STEPS: usize = 1000;

/// The model.
#[derive(Debug, Default)]
pub(crate) struct Model {
    /// What the file has, as far as the program knows.
    pub(crate) file: Numbers,
    /// What is shown.
    pub(crate) shown: Numbers,
    past: Vec<Numbers>,
    future: Vec<Numbers>,
    /// What the program said that the file has, until it says what happened.
    told: Option<Numbers>,
    /// What was changed last, if that was what happened last.
    last: Option<String>,
    /// Every number that was ever shown.
    ever: BTreeSet<String>,
    /// How often what happened.
    pub(crate) counts: BTreeMap<String, usize>,
}

impl Model {
    /// How many numbers would be lost if the window were closed. The viewpoint is not one of them.
    pub(crate) fn to_be_lost(&self) -> usize {
        let changed = differing(&self.shown, &self.file);
        changed
            .iter()
            .filter(|key| !key.contains(" viewpoint"))
            .count()
    }

    /// A scene was opened: nothing is known of it, and there is nothing to be undone.
    pub(crate) fn forget(&mut self) {
        let counts = std::mem::take(&mut self.counts);
        *self = Self {
            counts,
            ..Self::default()
        };
    }

    /// Takes what the log says. What is wrong with it, if anything is.
    pub(crate) fn take(&mut self, line: &str) -> Result<(), String> {
        let mut words = line.split("; ");
        let happened = words.next().unwrap_or_default().to_owned();
        let listed: Numbers = words.map(number).collect::<Result<_, _>>()?;
        if happened == "numbers" {
            self.told = Some(listed);
            return Ok(());
        }
        let before = self.shown.clone();
        let file = self.told.take().unwrap_or_else(|| self.file.clone());
        let mut shown = file.clone();
        shown.extend(listed);
        *self.counts.entry(happened.clone()).or_default() += 1;
        let last = self.last.take();
        match &*happened {
            "file" if self.file.is_empty() => {}
            "file" => {
                let wanted = self.rebase(&file);
                same(&shown, &wanted, "the file became another")?;
            }
            "saved" => {
                same(&shown, &before, "it was saved")?;
                for key in differing(&file, &self.file) {
                    // What was saved was shown then; since that it may have been changed.
                    let known = self.ever.contains(&format!("{key} {:?}", file[&key]));
                    if !known {
                        return Err(format!(
                            "{key} was saved as {:?}, and never shown",
                            file[&key]
                        ));
                    }
                }
            }
            "changed" | "changed on" => {
                same(&file, &self.file, "a number was changed")?;
                let changed = differing(&shown, &before);
                if let [one] = &changed[..] {
                    if happened == "changed on" && last.as_ref() != Some(one) {
                        return Err(format!("{one} was changed in one step with {last:?}"));
                    }
                    self.last = Some(one.clone());
                } else if shown != file {
                    return Err(format!("all of these were changed at once: {changed:?}"));
                }
                if happened == "changed" {
                    self.past.push(before.clone());
                    let surplus = self.past.len().saturating_sub(STEPS);
                    self.past.drain(..surplus);
                }
                self.future.clear();
            }
            "undone:" | "redone:" => {
                same(&file, &self.file, "a step was undone")?;
                let (from, to) = if happened == "undone:" {
                    (&mut self.past, &mut self.future)
                } else {
                    (&mut self.future, &mut self.past)
                };
                let step = loop {
                    let step = from.pop().ok_or(format!("{happened} nothing was to be"))?;
                    if step != before {
                        break step;
                    }
                };
                to.push(before.clone());
                same(&shown, &step, &happened)?;
            }
            other => return Err(format!("{other} is nothing that happens")),
        }
        for key in differing(&shown, &before) {
            self.ever.insert(format!(
                "{key} {:?}",
                shown.get(&key).map_or(&[][..], |it| it)
            ));
        }
        (self.file, self.shown) = (file, shown);
        Ok(())
    }

    /// The file becomes another under what is shown: what is to be shown then.
    fn rebase(&mut self, file: &Numbers) -> Numbers {
        let old = &self.file;
        // What is as the file was becomes as it is; what is not stays.
        let kept = |numbers: &Numbers| -> Numbers {
            let keep = |(key, now): (&String, &Vec<f64>)| {
                let value = match numbers.get(key) {
                    Some(value) if old.get(key) != Some(value) => value,
                    _ => now,
                };
                (key.clone(), value.clone())
            };
            file.iter().map(keep).collect()
        };
        let mine = kept(&self.shown);
        for step in self.past.iter_mut().chain(&mut self.future) {
            *step = kept(step);
        }
        // Now the file counts where both were changed, and undo brings the other back.
        let theirs: Numbers = mine
            .iter()
            .map(|(key, value)| {
                let both = old.get(key) != file.get(key);
                let value = if both { &file[key] } else { value };
                (key.clone(), value.clone())
            })
            .collect();
        if theirs != mine {
            self.past.push(mine);
            let surplus = self.past.len().saturating_sub(STEPS);
            self.past.drain(..surplus);
        }
        theirs
    }
}

/// A number as the log has it: its type, name and attribute, and its value.
fn number(text: &str) -> Result<(String, Vec<f64>), String> {
    let (key, values) = text
        .split_once(" [")
        .ok_or(format!("{text} is no number"))?;
    // What is left out has none.
    let values = values.trim_end_matches(']').split_terminator(", ");
    let values: Result<_, _> = values.map(str::parse).collect();
    let values = values.map_err(|error| format!("{text}: {error}"))?;
    Ok((key.to_owned(), values))
}

/// The keys whose numbers differ.
pub(crate) fn differing(one: &Numbers, other: &Numbers) -> Vec<String> {
    let mut keys: Vec<_> = one.keys().chain(other.keys()).cloned().collect();
    keys.sort();
    keys.dedup();
    keys.retain(|key| one.get(key) != other.get(key));
    keys
}

fn same(found: &Numbers, wanted: &Numbers, when: &str) -> Result<(), String> {
    let wrong = differing(found, wanted);
    let told = wrong.iter().map(|key| {
        let of = |numbers: &Numbers| format!("{:?}", numbers.get(key));
        format!("{key} is {}, not {}", of(found), of(wanted))
    });
    let told: Vec<_> = told.collect();
    if told.is_empty() {
        Ok(())
    } else {
        Err(format!("when {when}: {}", told.join("; ")))
    }
}

#[test]
fn what_is_lost_is_noticed() {
    let lines = |lines: &[&str]| {
        let mut model = Model::default();
        lines
            .iter()
            .try_for_each(|line| model.take(line))
            .map(|()| model)
    };
    let file = ["numbers; s a r [1.0]; s b r [2.0]", "file"];
    let with = |more: &[&str]| lines(&[&file[..], more].concat());
    assert_eq!(with(&["changed; s a r [3.0]"]).unwrap().to_be_lost(), 1);
    let good = [
        "changed; s a r [3.0]",
        "changed on; s a r [4.0]",
        "undone:",
        "redone:; s a r [4.0]",
    ];
    assert_eq!(with(&good).unwrap().shown["s a r"], [4.0]);
    let saved = [
        "changed; s a r [3.0]",
        "numbers; s a r [3.0]; s b r [2.0]",
        "saved",
        "undone:; s a r [1.0]",
    ];
    assert_eq!(with(&saved).unwrap().to_be_lost(), 1);
    let theirs = [
        "changed; s a r [3.0]",
        "numbers; s a r [1.0]; s b r [5.0]",
        "file; s a r [3.0]",
    ];
    assert_eq!(with(&theirs).unwrap().shown["s b r"], [5.0]);
    let both = [
        "changed; s a r [3.0]",
        "numbers; s a r [7.0]; s b r [2.0]",
        "file",
        "undone:; s a r [3.0]",
    ];
    assert_eq!(with(&both).unwrap().to_be_lost(), 1);
    for wrong in [
        &["changed; s a r [3.0]; s b r [3.0]"][..],
        &[
            "changed; s a r [3.0]",
            "changed on; s a r [3.0]; s b r [3.0]",
        ],
        &["changed; s a r [3.0]", "undone:; s a r [3.0]"],
        &["undone:"],
        &[
            "changed; s a r [3.0]",
            "numbers; s a r [1.0]; s b r [2.0]",
            "saved",
        ],
        &[
            "changed; s a r [3.0]",
            "numbers; s a r [9.0]; s b r [2.0]",
            "saved",
        ],
        &[
            "changed; s a r [3.0]",
            "numbers; s a r [1.0]; s b r [5.0]",
            "file",
        ],
        &["changed; s a r [3.0]", "redone:"],
    ] {
        assert!(with(wrong).is_err(), "{wrong:?}");
    }
}
