//! Advice about unreliable numbers: the background search for it, the offer to the user, and the run that follows the
//! offer.

use super::command::Command;
use super::player::Player;
use crate::engine::analysis::health::{Advice, advise};
use crate::engine::journal::restart::{SCHEME, TIME_STEP, rerun_with};
use crate::engine::run::Simulation;
use crate::engine::scenario::Scenario;
use crate::engine::text::number::shortest;
use crate::lab::playback::background::{self, BackgroundJob};
use std::sync::Arc;
use toml::Table;

/// A change that would make the present run reliable.
pub(super) struct Offer {
    /// The scheme and the time step, in words.
    pub(super) what: String,
    /// " from the start" if the run already has them since an edit; otherwise empty.
    since: &'static str,
    /// The run from its start, with the advised scheme and time step.
    pub(super) scenario: Arc<Scenario>,
}

#[derive(Default)]
pub struct Adviser {
    /// True to search for a scheme or time step whenever numbers are unreliable.
    pub(super) is_on: bool,
    search: Option<BackgroundJob<Advice>>,
    offer: Option<Offer>,
}

impl Adviser {
    pub(super) fn forget(&mut self) {
        (self.search, self.offer) = (None, None);
    }

    /// Starts the search if the numbers are unreliable.
    pub(super) fn look(&mut self, player: &Player) {
        // Not during a seek: the search would take a processor from the stepping.
        if self.is_on
            && self.search.is_none()
            && player.steps_to_go().is_none()
            && is_believed(player) == Some(false)
        {
            self.search = Some(background::advice(run_to_fix(player)));
        }
    }

    /// Searches for advice if the numbers are unreliable, and waits for the result.
    pub(super) fn look_now(&mut self, player: &Player) {
        if is_believed(player) == Some(false) {
            self.offer = offer_from(&advise(&run_to_fix(player)), player);
        }
    }

    /// Takes the result of the search if it has just ended. Returns true if it has.
    pub(super) fn advance(&mut self, player: &Player) -> bool {
        let has_come = self.search.as_mut().is_some_and(BackgroundJob::take_news);
        if has_come {
            self.offer = self.advice().and_then(|advice| offer_from(advice, player));
        }
        has_come
    }

    /// Returns the result of the search.
    pub fn advice(&self) -> Option<&Advice> {
        self.search.as_ref()?.answer()
    }

    pub fn is_seeking(&self) -> bool {
        self.search.is_some() && self.advice().is_none()
    }

    /// Returns the scheme and the time step that would make the run reliable, in words; `None` if none are known or the
    /// run cannot use them.
    pub fn offer(&self, player: &Player) -> Option<String> {
        let is_doubted = is_believed(player) == Some(false);
        let Offer { what, since, .. } = self.offer.as_ref().filter(|_| is_doubted)?;
        Some(format!("{what}{since}"))
    }

    /// Returns the command that follows the advice.
    ///
    /// # Errors
    /// Returns an error if there is no advice to follow now.
    pub fn followed(&self, player: &Player) -> Result<Command, String> {
        match self.why_none(player) {
            Some(reason) => Err(reason.to_owned()),
            None => Ok(Command::TakeAdvice),
        }
    }

    fn why_none(&self, player: &Player) -> Option<&'static str> {
        match (is_believed(player), self.is_seeking()) {
            (Some(true), _) => Some("nothing to fix: the run agrees with the exact motion"),
            (None, _) => Some("no advice: the run cannot be compared with the exact motion"),
            (Some(false), true) => {
                Some("still looking for a better time step: press a again in a moment")
            }
            (Some(false), false) => None,
        }
    }

    /// Takes the offer. If the search has not ended, searches at once and waits.
    ///
    /// # Errors
    /// Returns an error if there is nothing to fix or nothing was found.
    pub(super) fn take_offer(&mut self, player: &Player) -> Result<Offer, String> {
        if let Some(reason) = self.why_none(player).filter(|_| !self.is_seeking()) {
            return Err(reason.to_owned());
        }
        let offer = self.offer.take().or_else(|| {
            let known = self.advice().copied();
            let advice = known.unwrap_or_else(|| advise(&run_to_fix(player)));
            offer_from(&advice, player)
        });
        offer.ok_or_else(|| "no time step or scheme was found that fixes this run".to_owned())
    }
}

fn is_believed(player: &Player) -> Option<bool> {
    player.reading.readouts.health.is_believed()
}

/// Returns the run for which advice is sought, up to its end or to the present step, whichever is later.
///
/// After an edit of the time step at step 0 the scenario has as many steps as before, but the lab plays as many
/// seconds.
fn run_to_fix(player: &Player) -> Arc<Scenario> {
    let scenario = player.run().scenario();
    let end_s = player.end_s.max(player.run().now().time_s);
    let steps = Simulation::step_at(scenario, end_s).max(1);
    if steps == scenario.steps {
        return Arc::clone(scenario);
    }
    Arc::new(Scenario {
        steps,
        ..(**scenario).clone()
    })
}

/// Returns the offer that `advice` makes; `None` if there is nothing to change or this run cannot be changed that way.
fn offer_from(advice: &Advice, player: &Player) -> Option<Offer> {
    let (time_step_s, scheme) = match *advice {
        Advice::TimeStep(time_step_s) => (time_step_s, None),
        Advice::Scheme {
            name, time_step_s, ..
        } => (time_step_s, Some(name)),
        Advice::Holds | Advice::Nothing | Advice::BoundToItsTimeStep => return None,
    };
    let run = player.run().scenario();
    let own = run.motion.scheme.name;
    let is_edited = run.edits.iter().any(|edit| edit.motion.scheme.name != own);
    let throughout = scheme.or(is_edited.then_some(own));
    let mut set = Table::from_iter([(TIME_STEP.to_owned(), time_step_s.into())]);
    set.extend(throughout.map(|name| (SCHEME.to_owned(), name.into())));
    let scenario = rerun_with(run, &set, player.end_s).ok()?;
    let motion = player.motion();
    let is_in_force =
        motion.time_step_s == time_step_s && scheme.is_none_or(|name| motion.scheme.name == name);
    let scheme_text = scheme.map_or(String::new(), |scheme| format!("{scheme}, "));
    let since = if is_in_force { " from the start" } else { "" };
    Some(Offer {
        what: format!("{scheme_text}dt {} s", shortest(time_step_s)),
        since,
        scenario: Arc::new(scenario),
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lab::for_tests::{scenario, view};
    use crate::lab::player::SeekPurpose;
    use std::time::Duration;

    #[test]
    fn the_search_for_advice_waits_for_the_end_of_a_seek() {
        let view = view();
        let mut player = Player::new(scenario(), false);
        let mut adviser = Adviser {
            is_on: true,
            ..Adviser::default()
        };
        player.step(1000).unwrap();
        player.seek(100_000_000, SeekPurpose::Resume);
        player.read(Duration::ZERO, &view);
        adviser.look(&player);
        assert!(adviser.search.is_none());
        player.pause();
        player.read(Duration::ZERO, &view);
        adviser.look(&player);
        assert!(adviser.search.is_some());
        adviser.forget();
        assert!(adviser.search.is_none() && !adviser.is_seeking());
    }
}
