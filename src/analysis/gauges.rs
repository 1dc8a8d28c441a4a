//! What is measured on the steps of a run themselves, without the exact motion: they may be read on another core than the
//! one that steps.

use super::extremes::Extremes;
use super::frozen::Frozen;
use super::measure::{Instruments, Measured};
use super::tilt_swing::TiltSwing;
use crate::run::Step;

/// Follows one run from its start; to be shown every step.
#[derive(Clone, Debug)]
pub struct Gauges {
    pub instruments: Instruments,
    pub extremes: Extremes,
    /// The change of forces since which the instruments measure.
    changes: u64,
    /// The step from which on they do.
    pub since: u64,
    tilt_swing: TiltSwing,
    pub frozen: Option<Frozen>,
}

impl Gauges {
    pub fn new(step: &Step) -> Self {
        Self {
            instruments: Instruments::new(step),
            extremes: Extremes::new(step),
            changes: step.changes(),
            since: step.number(),
            tilt_swing: TiltSwing::new(step),
            frozen: Frozen::new(step),
        }
    }

    #[inline]
    pub fn follow(&mut self, step: &Step) {
        self.extremes.follow(step);
        if step.changes() == self.changes {
            self.instruments.follow(step);
            self.tilt_swing.follow(step);
        } else {
            self.changes = step.changes();
            self.since = step.number();
            self.instruments = Instruments::new(step);
            self.tilt_swing = TiltSwing::new(step);
            self.frozen = Frozen::new(step);
        }
    }

    /// By how much the tilt has swung since the forces last changed, degrees; `None` before it was seen whole.
    pub fn tilt_swing_deg(&self) -> Option<Measured> {
        self.tilt_swing.measured()
    }
}
