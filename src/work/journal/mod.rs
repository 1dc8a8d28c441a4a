//! A run: a scenario, and the journal of what the user did to it at which step.
//!
//! Everything else, any earlier state and any export, is computed again from these two. An act done at a step has its
//! effect from the next step on. When the user goes back and acts at an earlier step, the entries at later steps are
//! dropped. Undo takes the last entry back; redo does it again.
//!
//! The journal lists all acts in the order in which the user did them. Which entries are in force is computed from their
//! steps: an entry that a newer one dropped stays in the list, and is in force again once the newer one is undone.

mod stored;

use super::parameters;
pub use crate::scenario::dotted::number_of_push;
use crate::scenario::file::{EditFile, PushFile, ScenarioFile};
use crate::scenario::keys::Effect;
use crate::scenario::{Document, Problems, Scenario, rescale};
use crate::text::printable::brief;
use serde::{Deserialize, Serialize};
use toml::{Table, Value};

/// The most characters of a value that a message shows.
const LONGEST_VALUE: usize = 30;

/// A scenario and what the user did to it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(from = "stored::Stored")]
pub struct Journal {
    /// The scenario before the first act.
    base: ScenarioFile,
    /// All acts in the order in which the user did them, dropped ones included.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    log: Vec<Entry>,
    /// Undone entries, the one undone last at the end: redo takes it first.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    undone: Vec<Entry>,
}

/// One act, and the step at which it was done.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Entry {
    /// The step at which the user acted.
    pub step: u64,
    /// Whether the entry is an edit that the opened file contained.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    from_file: bool,
    /// Whether it is one more nudge of the same value: undo takes it back together with the entry before it.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    is_chained: bool,
    /// What the user did. It must stay the last field: TOML writes it as a table, and the serializer of `toml` moves the
    /// whole text that follows for each value that it meets after a table.
    pub act: Act,
}

/// What can be done to a run without beginning a new one.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Act {
    /// Adds a push.
    Push(PushFile),
    /// Sets keys of `motion` or `push`, with effect from the next step on.
    Edit(Table),
    /// Sets keys on which no number of the run depends: title, number of steps, `[view]`.
    Describe(Table),
}

impl Act {
    /// Sets `key` to `value`: a [`Describe`](Self::Describe) where the key has no effect on the numbers, else an
    /// [`Edit`](Self::Edit).
    pub fn set(key: &str, value: Value) -> Self {
        let set = Table::from_iter([(key.to_owned(), value)]);
        match Effect::of(key) {
            Effect::None => Self::Describe(set),
            Effect::FromHere | Effect::NewRun => Self::Edit(set),
        }
    }

    /// The act in words, for a message.
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
    /// The journal of a run file: the file without its edits is the base, and each edit is an entry.
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

    /// The scenario before the first act.
    pub fn base(&self) -> &ScenarioFile {
        &self.base
    }

    /// The entries in force, in the order in which they were done: those that no newer entry has dropped. Descriptions
    /// are never dropped and drop nothing.
    fn in_force(&self) -> Vec<&Entry> {
        let mut earliest = u64::MAX; // smallest step of the newer entries
        let is_in_force = |entry: &&Entry| {
            let is_in_force = !entry.is_later_than(earliest);
            if entry.drops_later_steps() {
                earliest = earliest.min(entry.step);
            }
            is_in_force
        };
        let mut entries: Vec<_> = self.log.iter().rev().filter(is_in_force).collect();
        entries.reverse();
        entries
    }

    /// The entries in force that have an effect by `step`; descriptions always do.
    fn in_force_by(&self, step: u64) -> Vec<&Entry> {
        let mut entries = self.in_force();
        entries.retain(|entry| !entry.is_later_than(step));
        entries
    }

    /// The run file: the base with all entries in force.
    pub fn file(&self) -> ScenarioFile {
        self.file_with(&self.in_force())
    }

    /// The checked scenario of the run file.
    ///
    /// # Errors
    /// What is wrong with the run file. A journal that was changed by [`act`](Self::act) alone has no errors.
    pub fn scenario(&self) -> Result<Scenario, Problems> {
        checked(self.file())
    }

    /// The scenario as it was when its number of steps was set last: by the opened file, or by a later `motion.steps`.
    ///
    /// # Errors
    /// As [`scenario`](Self::scenario).
    pub fn when_steps_were_set(&self) -> Result<Scenario, Problems> {
        let sets_steps = |entry: &Entry| match &entry.act {
            Act::Describe(set) => set.contains_key("motion.steps"),
            Act::Edit(_) | Act::Push(_) => entry.from_file,
        };
        let entries = self.in_force();
        let last = entries.iter().rposition(|entry| sets_steps(entry));
        checked(self.file_with(&entries[..last.map_or(0, |last| last + 1)]))
    }

    /// The run file of the run up to `step`: it has that many steps (at least one), and no later entry.
    pub fn file_until(&self, step: u64) -> ScenarioFile {
        let mut file = self.file_with(&self.in_force_by(step));
        file.motion.steps = step.max(1);
        file
    }

    /// How many entries in force stand at steps later than `step`.
    pub fn later_than(&self, step: u64) -> usize {
        let entries = self.in_force();
        entries
            .iter()
            .filter(|entry| entry.is_later_than(step))
            .count()
    }

    /// The base with `entries`.
    fn file_with(&self, entries: &[&Entry]) -> ScenarioFile {
        let mut file = self.base.clone();
        let mut last_is_of_file = true;
        for entry in entries {
            match &entry.act {
                Act::Describe(set) => file = with(&file, set).unwrap_or(file), // checked when it was done
                Act::Push(push) => file.push.push(push.clone()),
                Act::Edit(set) => match file.edit.last_mut() {
                    // Edits at one step become one edit, unless the file had them apart.
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

    /// Does `act` at `step` and returns the run's new scenario.
    ///
    /// # Errors
    /// Why the act is refused; the journal is then unchanged.
    pub fn act(&mut self, step: u64, act: Act) -> Result<Scenario, Problems> {
        self.enter(step, act, false)
    }

    /// Does `act` at `step` as one more nudge of the value that the last entry set: undo takes all nudges of this chain
    /// back at once.
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
            Act::Push(push) => self.push_with_new_number(push),
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

    /// The act that adds `push`: a `[[push]]` table. Where edits have added pushes, one more table would change their
    /// numbers, so the push is then added by one more edit.
    fn push_with_new_number(&self, push: PushFile) -> Act {
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

    /// Takes the last entry back, or all nudges of its chain. Entries that they had dropped are in force again. Returns the
    /// step of the first entry taken back and the act of the last one; `None` where there is no entry.
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

    /// Does again what was undone last: an entry, or all nudges of a chain. Returns the step of the first of them and the
    /// act of the last one; `None` where nothing is undone.
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

    /// Drops what was undone: it can no longer be redone.
    pub fn forget_undone(&mut self) {
        self.undone.clear();
    }

    /// How many entries in force were done at `step` or earlier, descriptions of any step included.
    pub fn count_by(&self, step: u64) -> usize {
        self.in_force_by(step).len()
    }

    /// How many pushes the run has at `step`, past and future ones: those of the scenario, and those that the user has
    /// added at `step` or earlier.
    pub fn pushes_by(&self, step: u64) -> usize {
        let mut added = self.in_force();
        added.retain(|entry| entry.step <= step && matches!(entry.act, Act::Push(_)));
        self.base.push.len() + added.len()
    }

    /// A new run with the values of `set` and an empty journal. From its start on it has the gravity, scheme, time step and
    /// pushes that this run has at `step`.
    ///
    /// # Errors
    /// Why the values are refused.
    pub fn begun_with(&self, step: u64, set: &Table) -> Result<(Self, Scenario), Problems> {
        let scenario = parameters::changed_all(&self.settings_at(step)?, set)?;
        Ok((Self::of(scenario.file.clone()), scenario))
    }

    /// The base with gravity, scheme, time step and its own pushes as they are at `step`, without added pushes. The base
    /// keeps its time step where its pushes cannot be rescaled to the new one.
    fn settings_at(&self, step: u64) -> Result<ScenarioFile, Problems> {
        let mut file = self.base.clone();
        let mut time_step_s = file.motion.time_step_s;
        for entry in self.in_force_by(step) {
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
    /// Whether it has its effect later than an act done at `step` would. A description belongs to no step.
    fn is_later_than(&self, step: u64) -> bool {
        self.step > step && !self.is_description()
    }

    /// Whether it drops older entries that stand at later steps. Edits of the opened file do not: they stand beside each
    /// other in any order.
    fn drops_later_steps(&self) -> bool {
        !self.from_file && !self.is_description()
    }

    /// Whether no number of the run depends on it.
    fn is_description(&self) -> bool {
        matches!(self.act, Act::Describe(_))
    }
}

/// Whether an edit may be joined with others at the same step. An edit that adds a push may not: a TOML table sorts its
/// keys as text, `push.10` before `push.9`, and pushes must be added in the order of their numbers.
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

/// `file` with the values of `set`, not yet checked.
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
    fn an_act_drops_entries_at_later_steps_until_it_is_undone() {
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
            "an act at the last step is included"
        );
        assert_eq!(journal.later_than(15), 1);
    }

    #[test]
    fn the_act_is_written_last() {
        let entry = Entry {
            step: 3,
            from_file: true,
            is_chained: true,
            act: gravity(1.0),
        };
        let text = serde_json::to_string(&entry).unwrap();
        assert!(text.find("\"act\"") > text.find("\"is_chained\""), "{text}");
        assert!(text.find("\"act\"") > text.find("\"from_file\""), "{text}");
    }

    #[test]
    fn a_description_belongs_to_every_step() {
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
    fn undo_restores_the_edits_of_the_file() {
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
    fn pushes_added_at_one_step_keep_their_order() {
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
    fn redo_does_not_panic_in_a_journal_edited_by_hand() {
        let mut journal = journal("method-2");
        journal.act(5, gravity(3.0)).unwrap();
        journal.act(3, gravity(4.0)).unwrap();
        journal.undo();
        journal.log.clear();
        assert!(journal.redo().is_some());
    }

    #[test]
    fn undo_takes_all_nudges_of_a_chain_back() {
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
    fn edits_at_one_step_are_joined_unless_the_file_had_them_apart() {
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
    fn a_new_push_keeps_the_numbers_of_pushes_that_edits_added() {
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
    fn a_new_run_begins_with_the_settings_of_the_old_one() {
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
            "the push keeps its times in seconds"
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
