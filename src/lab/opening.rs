//! Opening another preset or file, and going from one run to another.

use super::Lab;
use crate::export::Destination;
use crate::scenario::{Document, Problem, Problems, Scenario, presets};
use crate::work::changed;
use crate::work::next_push::NextPush;
use std::path::Path;
use std::sync::Arc;

impl Lab {
    /// Leaves the present run for that of `scenario`, opened as `name`, which stands still at step 0.
    pub(super) fn open(&mut self, name: &str, scenario: Arc<Scenario>) {
        self.stands();
        self.history.begin(name, &scenario);
        self.show_another(scenario);
    }

    /// The history is to know where the run stands, or is on its way back to: it may be left.
    pub(super) fn stands(&mut self) {
        self.history
            .set_left_at(self.player.step_to_keep(), self.values.next_push());
    }

    /// Shows the run of `scenario`, which is none of the present scenario's.
    pub(super) fn show_another(&mut self, scenario: Arc<Scenario>) {
        self.view.fit(&scenario);
        self.file = Arc::clone(&scenario);
        self.values.set_next_push(NextPush::of(&scenario));
        self.player.open(scenario);
        self.is_another();
    }

    /// Begins the run of `scenario`, which differs from the present one by an edit: that one stays as a ghost.
    pub(super) fn begin_run(&mut self, scenario: Arc<Scenario>) {
        self.values.suit(&scenario);
        self.player.begin(scenario);
        self.is_another();
    }

    /// Shows the run of `scenario` again, from which the present one differs by an edit that is taken back or brought
    /// again.
    pub(super) fn go_over_to(&mut self, scenario: Arc<Scenario>) {
        self.values.suit(&scenario);
        self.player.go_over_to(scenario);
        self.is_another();
    }

    /// What was known of the scenario before no longer holds.
    pub(super) fn is_another(&mut self) {
        self.player.forget_advice();
        self.work = None;
        self.changed_from_file = changed::changed(&self.file, self.run().scenario());
        self.list_parameters();
    }

    /// SCENARIO as it was opened.
    pub(super) fn name(&self) -> &str {
        &self.history.present().name
    }
}

/// Opens what `name` names while the lab is on the screen: a FIFO or a device, which may have nothing to give for as long
/// as it likes, is read at the command line only.
pub(super) fn again(name: &str) -> Result<Document, Problems> {
    if presets::find(name).is_none() && Destination::may_wait(Path::new(name)) {
        let rule = "is not a regular file: it can be opened at the command line only";
        return Err(Problems::one(name, Problem::at("", rule)));
    }
    Document::open(name)
}
