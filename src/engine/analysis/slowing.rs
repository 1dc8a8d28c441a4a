//! Effect of friction on a run: its work so far, and how fast it reduces spin and swing.

use crate::physics::{Friction, SymmetricTop};
use crate::run::Step;
use crate::text::number::short;
use std::fmt;

/// A spin below this fraction of |L| is a rounding error.
const SPIN_ROUNDING: f64 = 1e-12;

/// Effect of friction on a run at one step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FrictionEffect {
    /// Work of friction since the start, J. It is never positive.
    pub work: f64,
    /// Time in which viscous friction alone reduces the spin to 1/e, I3/k1, s.
    pub spin_decay_s: Option<f64>,
    /// Time in which dry friction alone would stop the present spin, L3/k0, s. It is 0 if the spin has stopped, except
    /// for rounding.
    pub spin_stop_s: Option<f64>,
    /// Time in which friction on the swing reduces a fast top's nutation to 1/e, I1/k4, s.
    pub swing_decay_s: Option<f64>,
}

impl FrictionEffect {
    /// Returns the effect of friction on the run at `step`. `None` without friction. For a lopsided body, the times are
    /// `None`.
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

/// Returns the time in which friction that removes `rate` per second removes `amount`, s. `None` if it never does.
fn time_s(amount: Option<f64>, rate: f64) -> Option<f64> {
    Some(amount? / rate).filter(|s| s.is_finite())
}

impl fmt::Display for FrictionEffect {
    /// Writes one line: "work -5.47 J so far; viscous: the spin falls to 1/e in 3.3 s".
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
                "; on the swing: a nutation falls to 1/e in {seconds} s, and a precessing axle sinks"
            )?;
        }
        Ok(())
    }
}
