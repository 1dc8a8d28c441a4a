//! The advice about doubtful numbers: what is offered, and the run that follows it.

use super::Lab;
use super::answer::{Answer, Done};
use super::player::Player;
use crate::analysis::health::{Advice, advise};
use crate::journal::restart::{as_advised, replaced};
use crate::playback::background::Job;
use crate::run::Simulation;
use crate::scenario::Scenario;
use crate::text::number::shortest;
use std::sync::Arc;

/// What would mend the present run, and can be done to it.
pub(super) struct Offer {
    /// In words: a scheme and a time step.
    what: String,
    /// " from the start" where the run has it already from an edit on; otherwise empty.
    since: &'static str,
    /// The run from its start, as advised.
    scenario: Arc<Scenario>,
}

impl Player {
    /// The run for which advice is sought, up to the later of its end and the step that it has reached. After an edit
    /// of the time step at step 0 the scenario has as many steps as before, but the lab plays as many seconds.
    pub(super) fn to_be_mended(&self) -> Arc<Scenario> {
        let scenario = self.run().scenario();
        let end_s = self.playback.end_s().max(self.run().now().time_s);
        let steps = Simulation::step_at(scenario, end_s).max(1);
        if steps == scenario.steps {
            return Arc::clone(scenario);
        }
        Arc::new(Scenario {
            steps,
            ..(**scenario).clone()
        })
    }

    /// The offer that `advice` makes; `None` where nothing is to be done, or where this run cannot be changed so.
    fn offered(&self, advice: &Advice) -> Option<Offer> {
        let (time_step_s, scheme) = match *advice {
            Advice::TimeStep(time_step_s) => (time_step_s, None),
            Advice::Scheme {
                name, time_step_s, ..
            } => (time_step_s, Some(name)),
            Advice::Holds | Advice::Nothing | Advice::BoundToItsTimeStep => return None,
        };
        let end_s = self.playback.end_s();
        let scenario = as_advised(self.run().scenario(), time_step_s, scheme, end_s).ok()?;
        let motion = self.motion();
        let is_in_force = motion.time_step_s == time_step_s
            && scheme.is_none_or(|name| motion.scheme.name == name);
        let scheme = scheme.map_or(String::new(), |scheme| format!("{scheme}, "));
        let since = if is_in_force { " from the start" } else { "" };
        Some(Offer {
            what: format!("{scheme}dt {} s", shortest(time_step_s)),
            since,
            scenario: Arc::new(scenario),
        })
    }

    /// Takes the answer of the search for advice, if it has just come. Returns whether it has.
    pub(super) fn take_advice_news(&mut self) -> bool {
        let has_come = self.advisor.as_mut().is_some_and(Job::take_news);
        if has_come {
            self.offer = self.advice().and_then(|advice| self.offered(advice));
        }
        has_come
    }

    /// Whether a search for what would mend the numbers is under way.
    pub fn is_seeking_advice(&self) -> bool {
        self.advisor.is_some() && self.advice().is_none()
    }

    /// Why there is no advice to take now; `None` where there may be.
    pub(super) fn why_no_advice(&self) -> Option<&'static str> {
        let is_believed = self.reading.readouts.health.is_believed();
        match (is_believed, self.is_seeking_advice()) {
            (Some(true), _) => Some("there is nothing to mend: the run keeps to the exact motion"),
            (None, _) => {
                Some("whether there is something to mend is not known: nothing is advised")
            }
            (Some(false), true) => {
                Some("what mends the numbers is being sought: press a again in a moment")
            }
            (Some(false), false) => None,
        }
    }

    /// What would mend doubtful numbers, with the key that does it, at length and in short; `None` where no remedy is
    /// known, or where this run cannot be changed so.
    pub fn offer(&self) -> Option<[String; 2]> {
        let is_doubted = self.reading.readouts.health.is_believed() == Some(false);
        let Offer { what, since, .. } = self.offer.as_ref().filter(|_| is_doubted)?;
        Some([
            format!("{what}{since} mends it: a takes it"),
            format!("a: {what}{since} mends it"),
        ])
    }
}

impl Lab {
    /// Begins the run anew as the advice says, and plays it to the same time. Where no advice has come yet, it is looked for
    /// at once.
    pub(super) fn follow_advice(&mut self) -> Answer {
        let reason = self.player.why_no_advice();
        if let Some(reason) = reason.filter(|_| !self.player.is_seeking_advice()) {
            return Err(reason.into());
        }
        if self.player.offer.is_none() {
            let known = self.player.advice().copied();
            let advice = known.unwrap_or_else(|| advise(&self.player.to_be_mended()));
            self.player.offer = self.player.offered(&advice);
        }
        let Some(Offer { what, scenario, .. }) = self.player.offer.take() else {
            return Err("no time step or scheme is known that mends this run".into());
        };
        let left_at = self.player.step_to_leave_at();
        let replaced = replaced(self.player.run().scenario());
        let replaced = replaced.map_or(String::new(), |edits| format!(", in place of {edits}"));
        self.work.leave_at(left_at, &self.values.next_push);
        self.work.begin_as_advised(&scenario);
        self.values.suit(&scenario);
        self.player.begin(scenario, false);
        self.scenario_has_changed();
        let said =
            format!("{what} from the start{replaced}; the run before is dotted, u goes back to it");
        Ok(self.on_its_way(Done::saying(said)))
    }
}
