//! What edits and pushes replace as they begin to act on a step, for the case that the step fails.

use crate::physics::Loads;
use crate::run::step::{EnergyAccount, Step};
use crate::scenario::Motion;

#[derive(Clone, Default)]
pub(super) struct Replaced {
    /// The step at which the run stood then; `None` while nothing has been replaced.
    at: Option<u64>,
    loads: Loads,
    rest: Option<Rest>,
}

/// What else there is besides the loads, whose memory is used again.
#[derive(Clone, Copy)]
struct Rest {
    motion: Motion,
    energy: EnergyAccount,
    segment: u64,
    changes: u64,
}

impl Replaced {
    /// Keeps what `now` has, before the first change at this step.
    pub fn keep(&mut self, now: &Step) {
        if self.at == Some(now.number) {
            return;
        }
        self.at = Some(now.number);
        self.loads.clone_from(&now.loads);
        self.rest = Some(Rest {
            motion: now.motion,
            energy: now.energy,
            segment: now.segment,
            changes: now.changes,
        });
    }

    /// Gives `now` what it had before the changes at this step, if there were any.
    pub fn put_back(&self, now: &mut Step) {
        if let Some(rest) = self.rest.filter(|_| self.at == Some(now.number)) {
            now.loads.clone_from(&self.loads);
            (now.motion, now.energy) = (rest.motion, rest.energy);
            (now.segment, now.changes) = (rest.segment, rest.changes);
        }
    }
}
