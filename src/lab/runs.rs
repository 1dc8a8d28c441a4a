//! The journal of the session, the scenario as the user opened it, and the differences between the present run and that
//! scenario.

use crate::engine::journal::changed::Original;
use crate::engine::journal::{Journal, RunRecord};
use crate::engine::scenario::Scenario;
use crate::lab::storage::session::SharedText;
use std::sync::Arc;

/// The journal of the lab, and the scenario as it was opened.
pub struct Runs {
    journal: Journal,
    /// The scenario for which the texts of the opened file were written.
    original: Original,
    /// The differences between the present run and that scenario, in words; `None` if there are none.
    changed_from_file: Option<String>,
    /// The journal as written for the session; `None` if it has changed since.
    kept: Option<SharedText>,
    /// The pinned run written with it.
    kept_reference: Option<Reference>,
    /// Number of acts at the start of the journal that undo does not touch: those before the page of a lesson began.
    floor: Option<usize>,
}

/// The data with which a session pins a run again.
#[derive(Clone, Default)]
pub(super) struct Reference {
    /// The step up to which it was played; unused if the present run is pinned.
    pub(super) step: u64,
    /// Its scenario; `None` if the present run is pinned.
    pub(super) run: Option<Arc<Scenario>>,
}

impl PartialEq for Reference {
    fn eq(&self, other: &Self) -> bool {
        let [own, others] = [self, other].map(|it| it.run.as_ref().map(Arc::as_ptr));
        (self.step, own) == (other.step, others)
    }
}

impl Runs {
    /// Creates the journal of a run of `scenario`, opened as `name`, without edits.
    pub(super) fn new(name: &str, scenario: &Arc<Scenario>) -> Self {
        Self::resumed(Journal::new(name, scenario), scenario)
    }

    /// Restores the journal of a session. The present run was opened from `file`.
    pub(super) fn resumed(journal: Journal, file: &Arc<Scenario>) -> Self {
        Self {
            original: Original::find(&journal.present().name, file),
            journal,
            changed_from_file: None,
            kept: None,
            kept_reference: None,
            floor: None,
        }
    }

    /// Returns the name under which the user opened the present run: a preset or a file.
    pub fn name(&self) -> &str {
        &self.present().name
    }

    pub fn present(&self) -> &RunRecord {
        self.journal.present()
    }

    pub fn journal(&self) -> &Journal {
        &self.journal
    }

    /// Returns the journal for changes, and discards its written form.
    pub(super) fn journal_mut(&mut self) -> &mut Journal {
        self.kept = None;
        &mut self.journal
    }

    /// Stops undo at the present act if `is_here` is true, or removes that limit.
    pub(super) fn set_floor(&mut self, is_here: bool) {
        self.floor = is_here.then(|| self.journal.done());
    }

    pub(super) fn is_at_floor(&self) -> bool {
        self.floor == Some(self.journal.done())
    }

    /// Returns true if the journal differs from its state when the limit of undo was set.
    pub fn is_above_floor(&self) -> bool {
        self.floor.is_some_and(|floor| floor != self.journal.done())
    }

    /// Returns the differences between the present run and the scenario as it was opened, in words; `None` if there are
    /// none.
    pub fn changed_from_file(&self) -> Option<&str> {
        self.changed_from_file.as_deref()
    }

    /// Sets `file` as the scenario that the user opened.
    pub(super) fn set_file(&mut self, file: &Arc<Scenario>) {
        self.original = Original::find(self.name(), file);
    }

    /// Returns the present `scenario` for writing to a file. Texts that describe another motion are marked.
    pub(super) fn flag_stale_text(&self, scenario: &Arc<Scenario>) -> Arc<Scenario> {
        self.original.flag_stale_text(scenario)
    }

    /// Compares the present `scenario` with the scenario as it was opened, and records the differences.
    pub(super) fn compare_with_file(&mut self, scenario: &Scenario) {
        self.changed_from_file = self.original.difference(scenario);
    }

    /// Returns the text of the journal and the pinned run for the session, written by `write`. Unchanged text is
    /// reused.
    pub(super) fn kept(
        &mut self,
        reference: Option<Reference>,
        write: fn(&Journal, Option<&Reference>) -> SharedText,
    ) -> SharedText {
        if self.kept_reference != reference {
            self.kept = None;
            self.kept_reference = reference;
        }
        let (journal, pinned) = (&self.journal, self.kept_reference.as_ref());
        let kept = self.kept.get_or_insert_with(|| write(journal, pinned));
        kept.clone()
    }

    /// Returns the scenario of the run from step 0 to `step`, with all edits up to there.
    ///
    /// # Errors
    /// Returns an error if `step` is 0. The verb `to` says in the message what the run was needed for.
    pub(super) fn run_up_to(&self, step: u64, to: &str) -> Result<Arc<Scenario>, String> {
        if step == 0 {
            return Err(format!(
                "there is nothing to {to} yet: the run is at step 0"
            ));
        }
        let run = self.journal().scenario_until(step);
        run.map_err(|problems| problems.in_one_line())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::engine::journal::Act;
    use crate::lab::for_tests::scenario;
    use toml::Table;

    fn runs() -> Runs {
        Runs::new("method-2", &scenario())
    }

    fn kept(runs: &mut Runs) -> SharedText {
        runs.kept(None, crate::lab::session::written)
    }

    #[test]
    fn the_saved_text_reflects_every_change() {
        let mut runs = runs();
        let first = kept(&mut runs);
        assert_eq!(**first, **kept(&mut runs));
        let time_step = Table::from_iter([("motion.time_step_s".to_owned(), 0.05.into())]);
        let acts = Act::set(time_step);
        runs.journal_mut().perform(40, acts, false).unwrap();
        let second = kept(&mut runs);
        assert_ne!(**first, **second);
        runs.journal_mut().undo();
        assert_ne!(**second, **kept(&mut runs));
    }

    #[test]
    fn a_run_at_step_0_cannot_be_exported() {
        let runs = runs();
        let refused = runs.run_up_to(0, "export").unwrap_err();
        assert!(refused.starts_with("there is nothing to export yet"));
        assert_eq!(runs.run_up_to(7, "export").unwrap().steps, 7);
    }
}
