//! Reads a journal from a session file, in the present format or in format 1.
//!
//! Format 1 stored only the entries in force; each contained the entries that it had dropped, and these contained
//! theirs.

use super::known::Checked;
use super::{Act, Entry, Journal};
use crate::scenario::file::ScenarioFile;
use serde::Deserialize;
use std::sync::Arc;

/// A journal in either format.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Stored {
    base: ScenarioFile,
    #[serde(default)]
    log: Vec<Arc<Entry>>,
    /// Format 1: the entries in force.
    #[serde(default)]
    done: Vec<Nested>,
    #[serde(default)]
    undone: Vec<Nested>,
}

/// An entry in format 1.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
struct Nested {
    step: u64,
    act: Act,
    #[serde(default)]
    from_file: bool,
    #[serde(default)]
    is_chained: bool,
    /// The first entry that it dropped, and all that followed. Descriptions among these stayed in force: the file repeats
    /// them just before this entry.
    #[serde(default)]
    dropped: Vec<Nested>,
}

impl From<Stored> for Journal {
    fn from(stored: Stored) -> Self {
        let mut log = stored.log;
        log.extend(in_order_of_doing(stored.done));
        Self {
            base: Arc::new(stored.base),
            log,
            undone: stored.undone.into_iter().map(Nested::alone).collect(),
            checked: Checked::default(),
        }
    }
}

/// All entries in the order in which the user did them, found by undoing one entry after another.
fn in_order_of_doing(mut done: Vec<Nested>) -> Vec<Arc<Entry>> {
    let mut log = Vec::new();
    while let Some(mut entry) = done.pop() {
        let dropped = std::mem::take(&mut entry.dropped);
        let repeated = dropped
            .iter()
            .filter(|entry| entry.is_description())
            .count();
        done.truncate(done.len().saturating_sub(repeated));
        done.extend(dropped);
        log.push(entry.alone());
    }
    log.reverse();
    log
}

impl Nested {
    fn is_description(&self) -> bool {
        matches!(self.act, Act::Describe(_))
    }

    /// The entry alone, without the entries that it dropped.
    fn alone(self) -> Arc<Entry> {
        Arc::new(Entry {
            step: self.step,
            act: self.act,
            from_file: self.from_file,
            is_chained: self.is_chained,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scenario::Document;
    use proptest::prelude::*;
    use toml::Value;

    /// The journal as the lab kept it when it wrote format 1.
    #[derive(Default)]
    struct Before {
        done: Vec<Nested>,
        undone: Vec<Nested>,
    }

    impl Before {
        fn act(&mut self, step: u64, act: &Act, is_chained: bool) {
            let is_later = |entry: &Nested| entry.step > step && !entry.is_description();
            let has_time = !matches!(act, Act::Describe(_));
            let first = self.done.iter().position(is_later).filter(|_| has_time);
            let dropped = self.done.split_off(first.unwrap_or(self.done.len()));
            self.push(Nested {
                step,
                act: act.clone(),
                from_file: false,
                is_chained,
                dropped,
            });
            self.undone.clear();
        }

        fn push(&mut self, entry: Nested) {
            let stay = entry.dropped.iter().filter(|entry| entry.is_description());
            self.done.extend(stay.cloned());
            self.done.push(entry);
        }

        fn undo(&mut self) {
            while let Some(entry) = self.done.pop() {
                let stayed = entry.dropped.iter().filter(|entry| entry.is_description());
                self.done.truncate(self.done.len() - stayed.count());
                self.done.extend(entry.dropped.iter().cloned());
                let is_chained = entry.is_chained;
                self.undone.push(entry);
                if !is_chained {
                    return;
                }
            }
        }

        fn redo(&mut self) {
            while let Some(entry) = self.undone.pop() {
                self.done.truncate(self.done.len() - entry.dropped.len());
                self.push(entry);
                if !self.undone.last().is_some_and(|next| next.is_chained) {
                    return;
                }
            }
        }
    }

    fn act(kind: u8, value: u32) -> Act {
        match kind {
            0..4 => Act::set("motion.gravity_m_per_s2", Value::Float(value.into())),
            _ => Act::set("title", Value::String(format!("title {value}"))),
        }
    }

    proptest! {
        /// Kinds 0 to 3 are edits, 4 and 5 descriptions, 6 is undo, 7 redo.
        #[test]
        fn a_journal_of_format_1_reads_as_the_same_journal(
            ways in prop::collection::vec((0..8u8, 0..100u64, 1..50u32), 1..40)
        ) {
            let file = Document::open("method-2").unwrap().scenario().unwrap().file;
            let (mut journal, mut before) = (Journal::of(file.clone()), Before::default());
            for (kind, step, value) in ways {
                match kind {
                    6 => {
                        journal.undo();
                        before.undo();
                    }
                    7 => {
                        journal.redo();
                        before.redo();
                    }
                    _ => {
                        let (act, is_chained) = (act(kind, value), value > 40);
                        let is_first = journal.log.is_empty();
                        prop_assert_eq!(is_first, before.done.is_empty());
                        if is_chained { journal.act_again(step, act.clone()).unwrap() } else { journal.act(step, act.clone()).unwrap() };
                        before.act(step, &act, is_chained && !is_first);
                    }
                }
                let alone = |entries: &[Nested]| -> Vec<Arc<Entry>> {
                    entries.iter().cloned().map(Nested::alone).collect()
                };
                let done: Vec<Arc<Entry>> = journal.in_force().into_iter().cloned().collect();
                prop_assert_eq!(done, alone(&before.done));
                let stored = Stored {
                    base: file.clone(),
                    log: Vec::new(),
                    done: before.done.clone(),
                    undone: before.undone.clone(),
                };
                prop_assert_eq!(Journal::from(stored), journal.clone());
            }
        }
    }
}
