//! Scenarios of a journal that have been checked already.
//!
//! Checking a whole run file takes a time that grows with its length. An act changes little of it: the scenario after
//! the act is made from the scenario before, and only the addition is checked. Undo and redo use the same.

use super::run_file::Edits;
use super::{Act, Entry, Journal};
use crate::scenario::file::EditFile;
use crate::scenario::{Document, Problems, Scenario, growing};
use std::sync::Arc;

/// The name of the run in a refusal.
pub(super) const ORIGIN: &str = "the run";

/// The most scenarios that are kept.
const MOST: usize = 8;

/// The most edits that they may have together; it limits the memory for long run files.
const MOST_EDITS: usize = 400_000;

/// The most entries for which a debug build compares with the check of the whole run file.
#[cfg(debug_assertions)]
const MOST_COMPARED: usize = 300;

/// A scenario that has been checked.
#[derive(Clone, Debug)]
struct Known {
    /// How many entries the journal had.
    length: usize,
    /// Those in force.
    entries: Vec<Arc<Entry>>,
    scenario: Arc<Scenario>,
}

/// The last few checked scenarios: of the present journal, and of those that undo and redo lead to. They follow from
/// the journal: two journals are equal whatever scenarios are kept with them.
#[derive(Clone, Debug, Default)]
pub(super) struct Checked(Vec<Arc<Known>>);

impl PartialEq for Checked {
    fn eq(&self, _: &Self) -> bool {
        true
    }
}

impl Checked {
    /// The scenario of a journal of `length` entries, or else the one of the nearest length.
    fn nearest(&self, length: usize) -> Option<&Known> {
        let near = self
            .0
            .iter()
            .min_by_key(|known| known.length.abs_diff(length));
        near.map(|known| &**known)
    }

    /// Adds `known`; it replaces what was known of a journal of its length.
    fn add(&mut self, known: Known) {
        self.0.retain(|old| old.length != known.length);
        self.0.push(Arc::new(known));
        let edits = |known: &Arc<Known>| known.scenario.edits.len();
        while self.0.len() > MOST
            || (self.0.len() > 1 && self.0.iter().map(edits).sum::<usize>() > MOST_EDITS)
        {
            self.0.remove(0);
        }
    }

    /// Forgets what is known of journals longer than `length` entries: others will stand there.
    pub(super) fn cut_back(&mut self, length: usize) {
        self.0.retain(|known| known.length <= length);
    }
}

impl Journal {
    /// The checked scenario of the run file.
    ///
    /// # Errors
    /// What is wrong with the run file. A journal that was changed by [`act`](Self::act) alone has no errors.
    pub fn scenario(&self) -> Result<Arc<Scenario>, Problems> {
        self.scenario_of(&self.in_force())
    }

    /// As [`scenario`](Self::scenario). The next act is then checked by itself.
    ///
    /// # Errors
    /// As [`scenario`](Self::scenario).
    pub(in crate::work) fn check(&mut self) -> Result<Arc<Scenario>, Problems> {
        let entries = self.in_force();
        let scenario = self.scenario_of(&entries)?;
        let entries = entries.into_iter().cloned().collect();
        self.add_known(entries, &scenario);
        Ok(scenario)
    }

    /// Notes that all entries are in force and lead to `scenario`.
    pub(super) fn is_checked_as(&mut self, scenario: &Arc<Scenario>) {
        self.add_known(self.log.clone(), scenario);
    }

    fn add_known(&mut self, entries: Vec<Arc<Entry>>, scenario: &Arc<Scenario>) {
        let is_known = |known: &Known| {
            known.length == self.log.len() && Arc::ptr_eq(&known.scenario, scenario)
        };
        if self.checked.nearest(self.log.len()).is_some_and(is_known) {
            return;
        }
        self.checked.add(Known {
            length: self.log.len(),
            entries,
            scenario: Arc::clone(scenario),
        });
    }

    /// The checked scenario that `entries` lead to.
    pub(super) fn scenario_of(&self, entries: &[&Arc<Entry>]) -> Result<Arc<Scenario>, Problems> {
        let whole = || {
            let scenario = Document::check_file(ORIGIN, self.file_with(entries));
            scenario.map(Arc::new)
        };
        let known = self.checked.nearest(self.log.len());
        match known.and_then(|known| self.changed(known, entries)) {
            Some(result) => {
                #[cfg(debug_assertions)]
                if entries.len() <= MOST_COMPARED {
                    assert_same(&result, &whole());
                }
                result
            }
            None => whole(),
        }
    }

    /// The scenario that `wanted` lead to, made from a known one. `None` where it has to be made from the whole file.
    fn changed(
        &self,
        known: &Known,
        wanted: &[&Arc<Entry>],
    ) -> Option<Result<Arc<Scenario>, Problems>> {
        if !self.base.edit.is_empty() {
            return None;
        }
        let pairs = known.entries.iter().zip(wanted);
        let same = pairs.take_while(|(old, new)| Arc::ptr_eq(old, new)).count();
        let (old, new) = (&known.entries[same..], &wanted[same..]);
        if old.is_empty() && new.is_empty() {
            return Some(Ok(Arc::clone(&known.scenario)));
        }
        let mut edits = Edits::default();
        let mut pushes = self.base.push.len();
        let mut first_of_last = 0; // number of the entry with which the last edit begins
        for (index, entry) in wanted[..same].iter().enumerate() {
            match entry.act {
                Act::Describe(_) => {}
                Act::Push(_) => pushes += 1,
                Act::Edit(_) => {
                    if !edits.add(entry) {
                        first_of_last = index;
                    }
                }
            }
        }
        // An edit that later ones may join is made again, without those that had joined it.
        let mut open = None;
        if edits.last_may_be_joined() {
            for entry in &wanted[first_of_last..same] {
                join(&mut open, entry);
            }
        }
        let kept = edits.count - usize::from(open.is_some());
        let mut scenario = known.scenario.cut_to(kept, pushes)?;
        let is_sure = new.len() <= 1;
        let refused = |problems: Problems| is_sure.then_some(Err(problems));
        for entry in new {
            match &entry.act {
                Act::Describe(_) => {}
                Act::Push(push) => {
                    if let Err(problems) = scenario.add_push(ORIGIN, push)? {
                        return refused(problems);
                    }
                }
                Act::Edit(_) => {
                    if !edits.add(entry)
                        && let Some(whole) = open.take()
                        && let Err(problems) = scenario.add_edit(ORIGIN, whole)
                    {
                        return refused(problems);
                    }
                    join(&mut open, entry);
                }
            }
        }
        if let Some(last) = open
            && let Err(problems) = scenario.add_edit(ORIGIN, last)
        {
            return refused(problems);
        }
        let is_described = old.iter().any(|entry| entry.is_description())
            || new.iter().any(|entry| entry.is_description());
        if is_described {
            let sets = wanted.iter().filter_map(|entry| entry.description());
            let head = growing::described(ORIGIN, &growing::head(&self.base), sets);
            scenario.describe_by(head.ok()?);
        }
        Some(Ok(Arc::new(scenario)))
    }
}

/// Joins the edit `entry` with `open`, or begins a new edit with it.
fn join(open: &mut Option<EditFile>, entry: &Entry) {
    let Act::Edit(set) = &entry.act else { return };
    match open {
        Some(open) => Arc::make_mut(&mut open.set).extend(set.clone()),
        None => {
            *open = Some(EditFile {
                step: entry.step,
                set: Arc::new(set.clone()),
            });
        }
    }
}

/// Asserts that both ways to check give the same scenario, or the same refusal.
#[cfg(any(debug_assertions, test))]
#[allow(clippy::panic, reason = "it is in debug builds and tests alone")]
pub(super) fn assert_same(
    changed: &Result<Arc<Scenario>, Problems>,
    whole: &Result<Arc<Scenario>, Problems>,
) {
    match (changed, whole) {
        (Ok(one), Ok(other)) => {
            assert_eq!(one.file, other.file);
            assert_eq!(one.edits, other.edits);
            assert_eq!(one.pushes, other.pushes);
            assert_eq!(
                (one.steps, one.motion, one.written_for_s, one.trace),
                (other.steps, other.motion, other.written_for_s, other.trace)
            );
        }
        (Err(one), Err(other)) => assert_eq!(one, other),
        (Ok(_), Err(problems)) | (Err(problems), Ok(_)) => {
            panic!("one of two checks refuses the run: {problems}")
        }
    }
}
