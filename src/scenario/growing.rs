//! A checked scenario with one more edit or push, with fewer of them, or with other descriptions. Only what is new is
//! checked; the result is the scenario that checking the whole file would give.

use super::edits::Progress;
use super::file::{BodyFile, EditFile, PushFile, ScenarioFile};
use super::model::Scenario;
use super::parts;
use super::problem::{Found, Problem, Problems};
use super::{Document, keys};
use std::sync::Arc;
use toml::{Table, Value};

impl Scenario {
    /// A copy with the first `edits` edits and the first `pushes` pushes. `None` where a kept edit sets a push that is
    /// dropped.
    pub(crate) fn cut_to(&self, edits: usize, pushes: usize) -> Option<Self> {
        let kept = &self.edits[..edits.min(self.edits.len())];
        let mut cut = Self {
            body: Arc::clone(&self.body),
            pushes: self.pushes.clone(),
            edits: kept.to_vec(),
            file: ScenarioFile {
                edit: self.file.edit[..edits.min(self.file.edit.len())].to_vec(),
                ..without_edits(&self.file)
            },
            ..*self
        };
        if pushes < self.pushes.len() {
            let sets_dropped = |place: &usize| *place >= pushes;
            if kept
                .iter()
                .any(|edit| edit.set_pushes.iter().any(sets_dropped))
            {
                return None;
            }
            cut.pushes.cut_back(pushes);
            cut.file.push.truncate(pushes);
            cut.change_lists(|edit| {
                edit.pushes.cut_back(pushes);
                edit.written.cut_back(pushes);
            });
        }
        Some(cut)
    }

    /// Changes the pushes of each edit. Edits that set no push share their lists with the edit before.
    fn change_lists(&mut self, change: impl Fn(&mut super::Edit)) {
        for index in 0..self.edits.len() {
            let (before, rest) = self.edits.split_at_mut(index);
            match (before.last(), &mut rest[0]) {
                (Some(last), edit) if edit.set_pushes.is_empty() => {
                    edit.pushes.clone_from(&last.pushes);
                    edit.written.clone_from(&last.written);
                }
                (_, edit) => change(edit),
            }
        }
    }

    /// Adds `edit` after the last edit. `origin` names the file in a refusal.
    ///
    /// # Errors
    /// Why the edit is refused; the scenario is then unchanged.
    pub(crate) fn add_edit(&mut self, origin: &str, edit: EditFile) -> Result<(), Problems> {
        let here = format!("edit.{}", self.file.edit.len());
        let table = Value::try_from(&edit);
        let table = table.map_err(|error| refused(origin, vec![unwritable(&error)]))?;
        let problems = keys::check_part(&table, &here);
        if !problems.is_empty() {
            return Err(refused(origin, problems));
        }
        let added = Progress::after(self).edit(&edit, &here);
        let added = added.map_err(|problems| refused(origin, problems))?;
        self.edits.push(added);
        self.file.edit.push(edit);
        Ok(())
    }

    /// Adds `push` after the last push that stands in no edit. `None` where edits have added pushes: it would change
    /// their numbers.
    ///
    /// # Errors
    /// Why the push is refused; the scenario is then unchanged.
    pub(crate) fn add_push(
        &mut self,
        origin: &str,
        push: &PushFile,
    ) -> Option<Result<(), Problems>> {
        let place = self.pushes.len();
        let adds = |edit: &super::Edit| edit.pushes.len() > place;
        if self.edits.iter().any(adds) {
            return None;
        }
        let key = format!("push.{place}");
        let checked = || {
            let table = Value::try_from(push).map_err(|error| vec![unwritable(&error)])?;
            match keys::check_part(&table, &key) {
                problems if problems.is_empty() => parts::push(push, &self.body, &key),
                problems => Err(problems),
            }
        };
        let added = match checked() {
            Ok(added) => added,
            Err(problems) => return Some(Err(refused(origin, problems))),
        };
        self.pushes.put(place, added);
        self.file.push.push(push.clone());
        self.change_lists(|edit| {
            edit.pushes.put(place, added);
            edit.written.put(place, push.clone());
        });
        Some(Ok(()))
    }

    /// Takes title, number of steps, `[view]` and all else on which no number depends from `head`.
    pub(crate) fn describe_by(&mut self, head: ScenarioFile) {
        self.steps = head.motion.steps;
        let file = std::mem::replace(&mut self.file, head);
        (self.file.body, self.file.push, self.file.edit) = (file.body, file.push, file.edit);
    }
}

/// `file` without points, pushes and edits: its length no longer depends on theirs.
pub(crate) fn head(file: &ScenarioFile) -> ScenarioFile {
    ScenarioFile {
        gyrolab: file.gyrolab.clone(),
        title: file.title.clone(),
        about: file.about.clone(),
        source: file.source.clone(),
        trace: file.trace.clone(),
        body: BodyFile::default(),
        start: file.start.clone(),
        motion: file.motion.clone(),
        push: Vec::new(),
        friction: file.friction,
        view: file.view.clone(),
        expected: file.expected.clone(),
        edit: Vec::new(),
    }
}

fn without_edits(file: &ScenarioFile) -> ScenarioFile {
    ScenarioFile {
        body: file.body.clone(),
        push: file.push.clone(),
        ..head(file)
    }
}

/// The [`head`] with the descriptions `sets`, one after the other.
///
/// # Errors
/// What is wrong with them.
pub(crate) fn described<'a>(
    origin: &str,
    head: &ScenarioFile,
    sets: impl Iterator<Item = &'a Table>,
) -> Result<ScenarioFile, Problems> {
    let mut document = Document::from_file(origin, head)?;
    for (key, value) in sets.flatten() {
        document.write(key, value.clone())?;
    }
    checked(&document)
}

/// The file of `document`, which has been held against the keys.
fn checked(document: &Document) -> Result<ScenarioFile, Problems> {
    let problems = keys::check(document.table());
    if problems.list.is_empty() {
        document.file()
    } else {
        Err(document.placed(problems))
    }
}

/// Whether `head` may have `value` at `key`, on which no number depends.
///
/// # Errors
/// Why it may not.
pub(crate) fn may_describe(
    origin: &str,
    head: &ScenarioFile,
    key: &str,
    value: Value,
) -> Result<(), Problems> {
    let mut document = Document::from_file(origin, head)?;
    document.write(key, value)?;
    checked(&document).map(drop)
}

fn unwritable(error: &toml::ser::Error) -> Problem {
    Problem::at("", error.to_string())
}

fn refused(origin: &str, problems: Vec<Problem>) -> Problems {
    let Found { list, more } = problems.into();
    Problems {
        origin: origin.to_owned(),
        list,
        more,
    }
}
