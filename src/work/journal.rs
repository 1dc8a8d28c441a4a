//! A run: a scenario, and the journal of what the user did to it at which step.
//!
//! Everything else, any earlier state and any export, is computed from it again. What is done at a step acts from the
//! next one on; doing something earlier than what was done before drops the later entries. The last entry can be taken
//! back, and brought again.
//!
//! The journal is the plain list of what was done, in the order in which it was done. Which of it holds is computed from
//! the steps: an entry that a later one dropped stays in the list, and holds again when that one is taken back.

mod stored;

use super::parameters;
pub use crate::scenario::dotted::number_of_push;
use crate::scenario::file::{EditFile, PushFile, ScenarioFile};
use crate::scenario::keys::Effect;
use crate::scenario::{Document, Problems, Scenario, rescale};
use crate::text::printable::brief;
use serde::{Deserialize, Serialize};
use toml::{Table, Value};

/// Characters of a value in words.
const LONGEST_VALUE: usize = 30;

/// A scenario and what was done to it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(from = "stored::Stored")]
pub struct Journal {
    /// The scenario before anything was done to it.
    base: ScenarioFile,
    /// What was done, in the order in which it was done, with what was dropped by it later.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    log: Vec<Entry>,
    /// What was taken back, the last one first to be brought again.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    undone: Vec<Entry>,
}

/// Something that was done.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Entry {
    /// The step at which it was done.
    pub step: u64,
    /// What it was.
    pub act: Act,
    /// Whether it stood in the file the run was opened from.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    from_file: bool,
    /// Whether it is one more nudge, taken back together with the entry before it.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    is_chained: bool,
}

/// What can be done to a run without beginning a new one.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Act {
    /// A push from then on.
    Push(PushFile),
    /// Keys of motion or push and their new values from then on.
    Edit(Table),
    /// Keys that no number depends on: title, length of the run, what the lab starts with.
    Describe(Table),
}

impl Act {
    /// `value` at `key`; of a key that has no effect, a description.
    pub fn set(key: &str, value: Value) -> Self {
        let set = Table::from_iter([(key.to_owned(), value)]);
        match Effect::of(key) {
            Effect::None => Self::Describe(set),
            Effect::FromHere | Effect::NewRun => Self::Edit(set),
        }
    }

    /// What was done, for a line that says so.
    pub fn in_words(&self) -> String {
        match self {
            Self::Push(push) => format!("the push on {}", push.point),
            Self::Edit(set) | Self::Describe(set) => {
                let words = set.iter().map(|(key, value)| {
                    format!("{key} = {}", brief(&value.to_string(), LONGEST_VALUE))
                });
                words.collect::<Vec<_>>().join(", ")
            }
        }
    }
}

impl Journal {
    /// The run that `file` holds: its edits are what was done.
    pub fn of(mut file: ScenarioFile) -> Self {
        let entry = |edit: EditFile| Entry {
            step: edit.step,
            act: Act::Edit(edit.set),
            from_file: true,
            is_chained: false,
        };
        Self {
            log: std::mem::take(&mut file.edit)
                .into_iter()
                .map(entry)
                .collect(),
            base: file,
            undone: Vec::new(),
        }
    }

    /// The scenario before anything was done to it.
    pub fn base(&self) -> &ScenarioFile {
        &self.base
    }

    /// The entries that hold, in the order of their steps: those that no later entry has dropped. What has no time is
    /// never dropped, and drops nothing.
    fn done(&self) -> Vec<&Entry> {
        let mut earliest = u64::MAX; // step of the entries that were made later
        let holds = |entry: &&Entry| {
            let holds = !entry.is_later_than(earliest);
            if entry.drops() {
                earliest = earliest.min(entry.step);
            }
            holds
        };
        let mut done: Vec<_> = self.log.iter().rev().filter(holds).collect();
        done.reverse();
        done
    }

    /// The run file.
    pub fn file(&self) -> ScenarioFile {
        self.made_of(&self.done())
    }

    /// The run, checked.
    ///
    /// # Errors
    /// What is wrong with it; nothing, where [`act`](Self::act) made it.
    pub fn scenario(&self) -> Result<Scenario, Problems> {
        checked(self.file())
    }

    /// The run as it was when its length was told last: by its file, or by what was done since.
    ///
    /// # Errors
    /// As [`scenario`](Self::scenario).
    pub fn when_its_length_was_told(&self) -> Result<Scenario, Problems> {
        let tells = |entry: &Entry| match &entry.act {
            Act::Describe(set) => set.contains_key("motion.steps"),
            Act::Edit(_) | Act::Push(_) => entry.from_file,
        };
        let done = self.done();
        let told = done.iter().rposition(|entry| tells(entry));
        checked(self.made_of(&done[..told.map_or(0, |last| last + 1)]))
    }

    /// The run file of the run up to `step`: as long, and without what was done later.
    pub fn file_until(&self, step: u64) -> ScenarioFile {
        let mut done = self.done();
        done.retain(|entry| !entry.is_later_than(step));
        let mut file = self.made_of(&done);
        file.motion.steps = step.max(1);
        file
    }

    /// How many entries stand later than `step`.
    pub fn later_than(&self, step: u64) -> usize {
        let done = self.done();
        done.iter()
            .filter(|entry| entry.is_later_than(step))
            .count()
    }

    fn made_of(&self, done: &[&Entry]) -> ScenarioFile {
        let mut file = self.base.clone();
        let mut last_is_of_file = true;
        for entry in done {
            match &entry.act {
                Act::Describe(set) => file = with(&file, set).unwrap_or(file), // checked when it was done
                Act::Push(push) => file.push.push(push.clone()),
                Act::Edit(set) => match file.edit.last_mut() {
                    // Edits of one moment are one edit, unless they were two in the file.
                    Some(last)
                        if last.step == entry.step && !last_is_of_file && may_be_joined(entry) =>
                    {
                        last.set.extend(set.clone());
                    }
                    _ => {
                        last_is_of_file = entry.from_file;
                        file.edit.push(EditFile {
                            step: entry.step,
                            set: set.clone(),
                        });
                    }
                },
            }
        }
        file
    }

    /// Does `act` at `step`; gives what the run is then.
    ///
    /// # Errors
    /// Why it cannot be done; nothing has changed then.
    pub fn act(&mut self, step: u64, act: Act) -> Result<Scenario, Problems> {
        self.enter(step, act, false)
    }

    /// Does `act` at `step` as one more nudge of what was nudged before: undo takes them all back at once.
    ///
    /// # Errors
    /// As [`act`](Self::act).
    pub fn act_again(&mut self, step: u64, act: Act) -> Result<Scenario, Problems> {
        self.enter(step, act, !self.log.is_empty())
    }

    fn enter(&mut self, step: u64, act: Act, is_chained: bool) -> Result<Scenario, Problems> {
        if let Act::Describe(set) = &act {
            let file = self.file();
            set.iter().try_for_each(|(key, value)| {
                parameters::changed(&file, key, value.clone()).map(drop)
            })?;
        }
        let act = match act {
            Act::Push(push) => self.push_at_the_end(push),
            act => act,
        };
        self.log.push(Entry {
            step,
            act,
            from_file: false,
            is_chained,
        });
        let scenario = self.scenario();
        match &scenario {
            Ok(_) => self.undone.clear(),
            Err(_) => drop(self.log.pop()),
        }
        scenario
    }

    /// A push as a table of its own; where edits have added pushes, whose numbers must stay, as one more edit.
    fn push_at_the_end(&self, push: PushFile) -> Act {
        let file = self.file();
        let set = file.edit.iter().flat_map(|edit| edit.set.keys());
        let added = set.filter_map(|key| number_of_push(key)).max();
        match (added, Table::try_from(&push)) {
            (Some(last), Ok(table)) if last >= file.push.len() => Act::Edit(Table::from_iter([(
                format!("push.{}", last + 1),
                Value::Table(table),
            )])),
            _ => Act::Push(push),
        }
    }

    /// Takes the last entry back, or all nudges of a chain; gives from which step on, and what the last of it was. What it
    /// had dropped holds again.
    pub fn undo(&mut self) -> Option<(u64, Act)> {
        let last = self.log.last()?.act.clone();
        loop {
            let entry = self.log.pop()?;
            let (step, is_chained) = (entry.step, entry.is_chained);
            self.undone.push(entry);
            if !is_chained {
                return Some((step, last));
            }
        }
    }

    /// Brings again what was taken back last; gives from which step on, and what the last of it was.
    pub fn redo(&mut self) -> Option<(u64, Act)> {
        let first = self.undone.last()?.step;
        loop {
            let entry = self.undone.pop()?;
            let act = entry.act.clone();
            self.log.push(entry);
            if !self.undone.last().is_some_and(|next| next.is_chained) {
                return Some((first, act));
            }
        }
    }

    /// What was taken back can no longer be brought again.
    pub fn forget_undone(&mut self) {
        self.undone.clear();
    }

    /// How many entries act by `step`, those made there counted in.
    pub fn in_force(&self, step: u64) -> usize {
        let mut done = self.done();
        done.retain(|entry| !entry.is_later_than(step));
        done.len()
    }

    /// How many pushes there are by `step`, over or to come: those of the scenario, and those given since.
    pub fn pushes_by(&self, step: u64) -> usize {
        let mut given = self.done();
        given.retain(|entry| entry.step <= step && matches!(entry.act, Act::Push(_)));
        self.base.push.len() + given.len()
    }

    /// A new run with the values of `set`: nothing is done to it yet, and it moves from the start as this one does at `step`.
    ///
    /// # Errors
    /// Why it cannot begin so.
    pub fn begun_with(&self, step: u64, set: &Table) -> Result<(Self, Scenario), Problems> {
        let scenario = parameters::changed_all(&self.as_it_moves_at(step)?, set)?;
        Ok((Self::of(scenario.file.clone()), scenario))
    }

    /// The scenario with gravity, scheme, time step and pushes as they are at `step`, without the pushes that were
    /// added on the way. The time step is taken over where that changes no push.
    fn as_it_moves_at(&self, step: u64) -> Result<ScenarioFile, Problems> {
        let mut file = self.base.clone();
        let mut time_step_s = file.motion.time_step_s;
        let mut done = self.done();
        done.retain(|entry| !entry.is_later_than(step));
        for entry in done {
            let (Act::Edit(set) | Act::Describe(set)) = &entry.act else {
                continue;
            };
            let mut lasting = set.clone();
            lasting.retain(|key, _| !self.is_of_an_added_push(key));
            if let Some(value) = lasting.remove("motion.time_step_s") {
                time_step_s = number(&value).unwrap_or(time_step_s);
            }
            file = with(&file, &lasting)?;
        }
        Ok(if time_step_s == file.motion.time_step_s {
            file
        } else {
            rescale::at_time_step(&file, time_step_s).unwrap_or(file)
        })
    }

    fn is_of_an_added_push(&self, key: &str) -> bool {
        number_of_push(key).is_some_and(|number| number >= self.base.push.len())
    }
}

impl Entry {
    /// Whether it acts on steps after the one that follows `step`.
    fn is_later_than(&self, step: u64) -> bool {
        self.step > step && !self.has_no_time()
    }

    /// Whether it drops the entries before it that stand at later steps. What stood in the file was never done.
    fn drops(&self) -> bool {
        !self.from_file && !self.has_no_time()
    }

    /// Whether no number depends on it.
    fn has_no_time(&self) -> bool {
        matches!(self.act, Act::Describe(_))
    }
}

/// Whether an edit can be one with others of its moment. A table has its keys in the order of their letters, push 10
/// before push 9: a push that is added keeps its place by being an edit of its own.
fn may_be_joined(entry: &Entry) -> bool {
    let adds = matches!(&entry.act, Act::Edit(set) if set.values().any(Value::is_table));
    !entry.from_file && !adds
}

fn number(value: &Value) -> Option<f64> {
    value
        .as_float()
        .or_else(|| Some(value.as_integer()? as f64))
}

fn checked(file: ScenarioFile) -> Result<Scenario, Problems> {
    Document::check_file("the run", file)
}

/// `file` with every key of `set` written; not yet checked.
fn with(file: &ScenarioFile, set: &Table) -> Result<ScenarioFile, Problems> {
    if set.is_empty() {
        return Ok(file.clone());
    }
    let mut document = Document::from_file("the run", file)?;
    for (key, value) in set {
        document.write(key, value.clone())?;
    }
    document.file()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scenario::presets;

    fn journal(name: &str) -> Journal {
        Journal::of(Document::open(name).unwrap().scenario().unwrap().file)
    }

    fn push(from_s: f64) -> Act {
        Act::Push(PushFile {
            point: "top".to_owned(),
            force_N: [10.0, 0.0, 0.0],
            first_step: None,
            steps: None,
            from_s: Some(from_s),
            for_s: Some(1.0),
            accumulates: None,
        })
    }

    fn gravity(value: f64) -> Act {
        Act::set("motion.gravity_m_per_s2", Value::Float(value))
    }

    #[test]
    fn doing_something_earlier_drops_what_came_later_until_it_is_undone() {
        let mut journal = journal("method-2");
        journal.act(10, gravity(1.0)).unwrap();
        journal.act(50, push(5.0)).unwrap();
        journal
            .act(60, Act::set("title", Value::String("Mine".to_owned())))
            .unwrap();
        journal.act(20, gravity(2.0)).unwrap();
        let file = journal.file();
        assert_eq!(
            (file.edit.len(), file.push.len(), file.title.as_str()),
            (2, 0, "Mine")
        );
        assert_eq!(journal.undo().unwrap().0, 20);
        let file = journal.file();
        assert_eq!((file.edit.len(), file.push.len()), (1, 1));
        journal.redo().unwrap();
        assert_eq!(
            (journal.file().edit.len(), journal.file().push.len()),
            (2, 0)
        );
        assert_eq!(journal.file_until(15).edit.len(), 1);
        assert_eq!(
            journal.file_until(20).edit.len(),
            2,
            "what is done here is in it"
        );
        assert_eq!(journal.later_than(15), 1);
    }

    #[test]
    fn what_no_number_depends_on_has_no_time() {
        let mut journal = journal("method-2");
        let title = Act::set("title", Value::String("Mine".to_owned()));
        journal.act(500, title).unwrap();
        assert_eq!(journal.file_until(100).title, "Mine");
        let begun = journal.begun_with(
            100,
            &Table::from_iter([("start.tilt_deg".to_owned(), Value::Float(3.0))]),
        );
        assert_eq!(begun.unwrap().1.file.title, "Mine");
    }

    #[test]
    fn edits_of_a_file_are_what_they_were_after_an_undo() {
        let edits = "[[edit]]\nstep = 60\nset = { 'motion.gravity_m_per_s2' = 1 }\n".repeat(2);
        let text = format!("{}\n{edits}", presets::find("method-2").unwrap().text);
        let file = Document::parse("edited", &text)
            .unwrap()
            .scenario()
            .unwrap()
            .file;
        let mut journal = Journal::of(file.clone());
        let title = Act::set("title", Value::String(file.title.clone()));
        journal.act(70, title).unwrap();
        journal.act(50, gravity(2.0)).unwrap();
        journal.undo();
        assert_eq!(journal.file(), file);
    }

    #[test]
    fn pushes_of_one_moment_are_added_one_after_the_other() {
        let own = "[[push]]\npoint = 'top'\nforce_N = [0, 0, -1]\nfor_s = 1\n".repeat(8);
        let added = "[[edit]]\nstep = 5\nset = { 'push.8' = \
                     { point = 'top', force_N = [0, 0, -1], for_s = 1 } }\n";
        let text = presets::find("method-2").unwrap().text;
        let document = Document::parse("pushed", &format!("{text}\n{own}{added}")).unwrap();
        let mut journal = Journal::of(document.scenario().unwrap().file);
        for count in 10..13 {
            let scenario = journal.act(20, push(2.0)).unwrap();
            assert_eq!(scenario.edits.last().unwrap().pushes.len(), count);
        }
    }

    #[test]
    fn a_journal_that_was_changed_by_hand_is_no_panic() {
        let mut journal = journal("method-2");
        journal.act(5, gravity(3.0)).unwrap();
        journal.act(3, gravity(4.0)).unwrap();
        journal.undo();
        journal.log.clear();
        assert!(journal.redo().is_some());
    }

    #[test]
    fn nudges_of_a_chain_are_taken_back_together() {
        let mut journal = journal("method-2");
        journal.act(5, push(0.5)).unwrap();
        journal.act(10, gravity(1.0)).unwrap();
        journal.act_again(12, gravity(2.0)).unwrap();
        journal.act_again(14, gravity(3.0)).unwrap();
        let whole = journal.file();
        assert_eq!(journal.undo(), Some((10, gravity(3.0))));
        assert_eq!(
            (journal.file().edit.len(), journal.file().push.len()),
            (0, 1)
        );
        assert_eq!(journal.redo(), Some((10, gravity(3.0))));
        assert_eq!(journal.file(), whole);
        assert_eq!(journal.redo(), None);
    }

    #[test]
    fn edits_of_one_moment_are_one_edit_but_for_those_of_a_file() {
        let mut journal = journal("method-2");
        journal.act(10, gravity(1.0)).unwrap();
        journal.act(10, gravity(2.0)).unwrap();
        journal
            .act(
                10,
                Act::set("motion.scheme", Value::String("rk4".to_owned())),
            )
            .unwrap();
        assert_eq!(journal.file().edit.len(), 1);
        assert_eq!(journal.file().edit[0].set.len(), 2);
        let mut file = journal.file();
        file.edit.push(EditFile {
            step: 10,
            set: Table::from_iter([("motion.gravity_m_per_s2".to_owned(), Value::Float(3.0))]),
        });
        assert_eq!(Journal::of(file.clone()).file(), file);
    }

    #[test]
    fn a_push_beside_pushes_that_edits_have_added_takes_no_number_away() {
        let mut file = journal("method-2").file();
        let added = "[edit]\npoint = 'top'\nforce_N = [0, 1, 0]\nfor_s = 2"
            .parse::<Table>()
            .unwrap();
        file.edit.push(EditFile {
            step: 3,
            set: Table::from_iter([("push.0".to_owned(), added["edit"].clone())]),
        });
        let mut journal = Journal::of(file);
        let scenario = journal.act(9, push(0.9)).unwrap();
        assert_eq!(scenario.edits.last().unwrap().pushes.len(), 2);
        assert_eq!(scenario.edits[0].pushes.len(), 1);
        assert_eq!(scenario.pushes.len(), 0);
    }

    #[test]
    fn a_new_run_moves_as_the_old_one_did() {
        let mut journal = journal("wobble-push");
        journal
            .act(40, Act::set("motion.time_step_s", Value::Float(0.05)))
            .unwrap();
        journal.act(50, push(4.5)).unwrap();
        journal
            .act(55, Act::set("push.1.force_N.0", Value::Float(3.0)))
            .unwrap();
        journal.act(60, gravity(1.6)).unwrap();
        let (begun, scenario) = journal
            .begun_with(
                60,
                &Table::from_iter([("start.tilt_deg".to_owned(), Value::Float(10.0))]),
            )
            .unwrap();
        assert_eq!(
            (scenario.motion.time_step_s, scenario.motion.gravity),
            (0.05, 1.6)
        );
        assert_eq!((scenario.pushes.len(), scenario.edits.len()), (1, 0));
        let push = &begun.base().push[0];
        assert_eq!(
            (push.from_s, push.for_s),
            (Some(0.0), Some(20.0)),
            "its seconds are held"
        );
        let (_, earlier) = journal
            .begun_with(
                39,
                &Table::from_iter([("start.tilt_deg".to_owned(), Value::Float(10.0))]),
            )
            .unwrap();
        assert_eq!(earlier.motion.time_step_s, 0.1);
    }
}
