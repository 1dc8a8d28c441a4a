//! Which entries are in force, and the run file that they make of the base.

use super::{Act, Entry, Journal, ORIGIN};
use crate::scenario::file::{EditFile, ScenarioFile};
use crate::scenario::{Document, Problems};
use std::sync::Arc;
use toml::{Table, Value};

impl Journal {
    /// The entries in force, in the order in which they were done: those that no newer entry has dropped. Descriptions
    /// are never dropped and drop nothing.
    pub(super) fn in_force(&self) -> Vec<&Entry> {
        let mut earliest = u64::MAX; // smallest step of the newer entries
        let is_in_force = |entry: &&Arc<Entry>| {
            let is_in_force = !entry.is_later_than(earliest);
            if entry.drops_later_steps() {
                earliest = earliest.min(entry.step);
            }
            is_in_force
        };
        let newest_first = self.log.iter().rev().filter(is_in_force);
        let mut entries: Vec<_> = newest_first.map(|entry| &**entry).collect();
        entries.reverse();
        entries
    }

    /// The entries in force that have an effect by `step`; descriptions always do.
    pub(super) fn in_force_by(&self, step: u64) -> Vec<&Entry> {
        let mut entries = self.in_force();
        entries.retain(|entry| !entry.is_later_than(step));
        entries
    }

    pub(super) fn file_with(&self, entries: &[&Entry]) -> ScenarioFile {
        let mut file = (*self.base).clone();
        let mut descriptions = Table::new();
        // The step of the last edit, where another may be joined with it.
        let mut open = None;
        for entry in entries {
            match &entry.act {
                Act::Describe(set) => descriptions.extend(set.clone()),
                Act::Push(push) => file.push.push(push.clone()),
                Act::Edit(set) => {
                    let is_joined = open == Some(entry.step) && may_be_joined(entry);
                    match file.edit.last_mut() {
                        Some(last) if is_joined => last.set.extend(set.clone()),
                        _ => file.edit.push(EditFile {
                            step: entry.step,
                            set: set.clone(),
                        }),
                    }
                    if !is_joined {
                        open = (!entry.from_file).then_some(entry.step);
                    }
                }
            }
        }
        // Each was checked when it was made.
        let _ = describe(&mut file, &descriptions);
        file
    }
}

/// Whether an edit may be joined with others at the same step. An edit that adds a push may not: a TOML table sorts its
/// keys as text, `push.10` before `push.9`, and pushes must be added in the order of their numbers.
fn may_be_joined(entry: &Entry) -> bool {
    let adds = matches!(&entry.act, Act::Edit(set) if set.values().any(Value::is_table));
    !entry.from_file && !adds
}

/// Writes values on which no number depends into `file`.
///
/// # Errors
/// What is wrong with them; the file is then unchanged.
pub(super) fn describe(file: &mut ScenarioFile, set: &Table) -> Result<(), Problems> {
    if set.is_empty() {
        return Ok(());
    }
    // No description touches what may be long.
    let body = std::mem::take(&mut file.body);
    let (push, edit) = (
        std::mem::take(&mut file.push),
        std::mem::take(&mut file.edit),
    );
    let described = Document::from_file(ORIGIN, file).and_then(|mut document| {
        for (key, value) in set {
            document.write(key, value.clone())?;
        }
        document.check()?;
        document.file()
    });
    let described = described.map(|described| *file = described);
    (file.body, file.push, file.edit) = (body, push, edit);
    described
}
