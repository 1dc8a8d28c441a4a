//! The rows of a run, and two of them with a turning point between.

use crate::analysis::swing::Swing;
use crate::physics::observables::Azimuth;
use crate::run::Step;

/// What is known of the axle after a time step.
#[derive(Clone, Copy, Debug)]
pub(super) struct Row {
    pub time_s: f64,
    /// Where the axle is, and how it moves.
    pub swing: Swing,
    pub azimuth: Azimuth,
}

impl Row {
    /// The row after `step`; `per_across` is one over the moment across the axle, 1/(kg m²).
    #[inline]
    pub fn of(step: &Step, per_across: f64) -> Self {
        let state = step.after();
        Self {
            time_s: state.time_s,
            swing: Swing {
                axle: state.axle(),
                momentum: state.momentum * per_across,
            },
            azimuth: *step.azimuth(),
        }
    }

    /// The azimuth, rad, with all full turns.
    pub fn azimuth_rad(&self) -> f64 {
        self.azimuth.degrees().to_radians()
    }
}

/// Two rows with a turning point between them, or a start that stands at one.
#[derive(Clone, Copy, Debug)]
pub(super) struct Crossing {
    pub before: Row,
    /// The row after it; `None` at a start that stands there.
    pub after: Option<Row>,
    /// Full turns of the azimuth that the rows up to `before` miss.
    pub missed: i64,
    /// Whether the axle is highest there, and not lowest.
    pub is_top: bool,
}

impl Crossing {
    /// The height of the row nearer to the turning point.
    pub fn height(&self) -> f64 {
        let [a, b] = [self.before, self.after.unwrap_or(self.before)].map(|row| row.swing.axle.z);
        if self.is_top { a.max(b) } else { a.min(b) }
    }
}
