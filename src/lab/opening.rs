//! Opening another preset or file, and going from one run to another.

use super::Lab;
use crate::export::Destination;
use crate::observe::ghost::Ghost;
use crate::observe::playback::Playback;
use crate::scenario::{Document, Problem, Problems, Scenario, presets};
use crate::tui::keymap::Mode;
use crate::work::changed;
use crate::work::next_push::NextPush;
use std::path::Path;
use std::sync::Arc;

/// A run that has come less than this part as far as its ghost is no ghost itself: a value was nudged once more.
const SHORT: f64 = 0.1;

impl Lab {
    pub(super) fn browse(&mut self) {
        let folder = self.folder.as_deref().unwrap_or(Path::new("."));
        let name = &self.history.present().name;
        let confined = self.confined.as_ref();
        self.browser.begin(folder, name, |path| {
            confined.is_none_or(|folder| folder.check(path).is_ok())
        });
        self.mode = Mode::Browser;
    }

    pub(super) fn choose(&mut self) {
        let Some(name) = self.browser.choice().map(|entry| entry.name.clone()) else {
            return self.say("nothing is selected: Esc clears the filter");
        };
        if let Err(reason) = self.admit(Path::new(&name)) {
            return self.say(reason);
        }
        match again(&name).and_then(|document| document.scenario()) {
            Ok(scenario) => self.open(&name, Arc::new(scenario)),
            Err(problems) => self.say(format!("{}: {}", problems.origin, problems.in_one_line())),
        }
    }

    fn open(&mut self, name: &str, scenario: Arc<Scenario>) {
        self.mode = Mode::Lab;
        self.stands();
        self.history.begin(name, &scenario);
        self.show_another(scenario, true);
    }

    /// The history is to know where the run stands, or is on its way back to: it may be left.
    pub(super) fn stands(&mut self) {
        self.history.stands(self.step_to_keep(), &self.next_push);
    }

    /// Shows the run of `scenario`, which is none of the present scenario's.
    pub(super) fn show_another(&mut self, scenario: Arc<Scenario>, running: bool) {
        let shows_exact = self.run().overlay().is_some();
        self.ghost = None;
        self.view.fit(&scenario);
        self.file = Arc::clone(&scenario);
        self.next_push = NextPush::of(&scenario);
        self.playback = Playback::new(scenario, running);
        self.playback.set_exact(shows_exact);
        self.is_another();
    }

    /// Begins the run of `scenario`, which differs from the present one by an edit: that one stays as a ghost.
    pub(super) fn begin_run(&mut self, scenario: Arc<Scenario>) {
        let left = Ghost::of(self.run());
        let is_short = |before: &Ghost| left.end_s() < SHORT * before.end_s();
        if left.end_s() > 0.0 && !self.ghost.as_ref().is_some_and(is_short) {
            self.ghost = Some(left);
        }
        self.next_push = self.next_push.clone().suited_to(&scenario);
        self.playback.begin(scenario);
        self.is_another();
    }

    /// Shows the run of `scenario` again, from which the present one differs by an edit that is taken back or brought
    /// again: the present one stays as a ghost, if it was played.
    pub(super) fn go_over_to(&mut self, scenario: Arc<Scenario>) {
        self.ghost = None;
        self.begin_run(scenario);
    }

    /// What was known of the scenario before no longer holds.
    pub(super) fn is_another(&mut self) {
        self.advisor = None;
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
