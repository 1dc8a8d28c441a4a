//! What friction does to a run: its work so far, and how fast it takes spin and swing.

use crate::physics::{Friction, SymmetricTop};
use crate::run::Step;
use crate::text::number::short;
use std::fmt;

/// A spin of less than this part of |L| is none but for rounding.
const SPIN_ROUNDING: f64 = 1e-12;

/// Friction on a run at one step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FrictionEffect {
    /// Work of friction since the start, J: 0, or less.
    pub work: f64,
    /// The time in which viscous friction alone takes the spin to 1/e, I3/k1, s.
    pub spin_decay_s: Option<f64>,
    /// The time in which dry friction alone would stop the present spin, L3/k0, s; 0 where it has, but for rounding.
    pub spin_stop_s: Option<f64>,
    /// The time in which friction on the swing takes a fast top's nutation to 1/e, I1/k4, s.
    pub swing_decay_s: Option<f64>,
}

impl FrictionEffect {
    /// Of the run at `step`; `None` where there is no friction. A lopsided body has no such times.
    pub fn new(step: &Step) -> Option<Self> {
        let friction = step.loads().friction;
        if friction.is_none() {
            return None;
        }
        let scenario = step.scenario();
        let top = SymmetricTop::from_body(&scenario.body.mechanics);
        let state = step.after();
        let Friction {
            spin_dry,
            spin_viscous,
            swing_viscous,
            ..
        } = friction;
        let least = SPIN_ROUNDING * state.momentum.norm();
        let along_axle = state.axle().dot(&state.momentum).abs();
        let spin = top.map(|_| if along_axle > least { along_axle } else { 0.0 });
        Some(Self {
            work: step.friction_work(),
            spin_decay_s: time_s(top.map(|top| top.along), spin_viscous),
            spin_stop_s: time_s(spin, spin_dry),
            swing_decay_s: time_s(top.map(|top| top.across), swing_viscous),
        })
    }
}

/// Returns how long friction takes that removes `rate` in a second, s, to remove `amount`; `None` without an end.
fn time_s(amount: Option<f64>, rate: f64) -> Option<f64> {
    Some(amount? / rate).filter(|s| s.is_finite())
}

impl fmt::Display for FrictionEffect {
    /// In one line: "work -5.47 J so far; on the swing: a nutation falls to 1/e in 3.3 s, and a precession sinks".
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "work {} J so far", short(self.work))?;
        if let Some(seconds) = self.spin_decay_s {
            write!(
                f,
                "; viscous: the spin falls to 1/e in {} s",
                short(seconds)
            )?;
        }
        if self.spin_stop_s == Some(0.0) {
            f.write_str("; dry: it has stopped the spin")?;
        } else if let Some(seconds) = self.spin_stop_s {
            write!(
                f,
                "; dry: alone it would stop the spin in {} s",
                short(seconds)
            )?;
        }
        if let Some(seconds) = self.swing_decay_s {
            let seconds = short(seconds);
            write!(
                f,
                "; on the swing: a nutation falls to 1/e in {seconds} s, and what precesses sinks"
            )?;
        }
        Ok(())
    }
}
