//! Which entries are in force, and the run file that they make of the base.

use super::{Act, Entry, Journal};
use crate::scenario::file::{EditFile, ScenarioFile};
use crate::scenario::growing;
use std::sync::Arc;
use toml::{Table, Value};

/// Which edits stand in the run file so far, as entry after entry is added.
#[derive(Default)]
pub(super) struct Edits {
    /// How many there are.
    pub(super) count: usize,
    /// Step of the last one, and whether the opened file contained it.
    last: Option<(u64, bool)>,
}

impl Edits {
    /// Adds the edit `entry`. Returns whether it is joined with the last edit: edits at one step become one edit, unless
    /// the file had them apart.
    pub(super) fn add(&mut self, entry: &Entry) -> bool {
        let is_joined = self.last == Some((entry.step, false)) && may_be_joined(entry);
        if !is_joined {
            self.last = Some((entry.step, entry.from_file));
            self.count += 1;
        }
        is_joined
    }

    /// Whether another edit may be joined with the last one.
    pub(super) fn last_may_be_joined(&self) -> bool {
        self.last.is_some_and(|(_, is_of_file)| !is_of_file)
    }
}

impl Journal {
    /// The entries in force, in the order in which they were done: those that no newer entry has dropped. Descriptions
    /// are never dropped and drop nothing.
    pub(super) fn in_force(&self) -> Vec<&Arc<Entry>> {
        let mut earliest = u64::MAX; // smallest step of the newer entries
        let is_in_force = |entry: &&Arc<Entry>| {
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
    pub(super) fn in_force_by(&self, step: u64) -> Vec<&Arc<Entry>> {
        let mut entries = self.in_force();
        entries.retain(|entry| !entry.is_later_than(step));
        entries
    }

    /// The base with `entries`.
    pub(super) fn file_with(&self, entries: &[&Arc<Entry>]) -> ScenarioFile {
        let mut file = self.described(entries);
        let mut edits = Edits::default();
        for entry in entries {
            match &entry.act {
                Act::Describe(_) => {}
                Act::Push(push) => file.push.push(push.clone()),
                Act::Edit(set) => match (edits.add(entry), file.edit.last_mut()) {
                    (true, Some(last)) => Arc::make_mut(&mut last.set).extend(set.clone()),
                    _ => file.edit.push(EditFile {
                        step: entry.step,
                        set: Arc::new(set.clone()),
                    }),
                },
            }
        }
        file
    }

    /// The base with the descriptions among `entries`.
    fn described(&self, entries: &[&Arc<Entry>]) -> ScenarioFile {
        let base = (*self.base).clone();
        let sets: Vec<&Table> = entries
            .iter()
            .filter_map(|entry| entry.description())
            .collect();
        if sets.is_empty() {
            return base;
        }
        let mut head = growing::head(&base);
        match growing::described("the run", &head, sets.iter().copied()) {
            Ok(described) => head = described,
            // One of them is wrong, which happens only in a file that was edited by hand. The others are kept.
            Err(_) => {
                for set in sets {
                    head = growing::described("the run", &head, [set].into_iter()).unwrap_or(head);
                }
            }
        }
        ScenarioFile {
            body: base.body,
            push: base.push,
            edit: base.edit,
            ..head
        }
    }
}

/// Whether an edit may be joined with others at the same step. An edit that adds a push may not: a TOML table sorts its
/// keys as text, `push.10` before `push.9`, and pushes must be added in the order of their numbers.
fn may_be_joined(entry: &Entry) -> bool {
    let adds = matches!(&entry.act, Act::Edit(set) if set.values().any(Value::is_table));
    !entry.from_file && !adds
}
