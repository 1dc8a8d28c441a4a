//! Theory of the report's scheme for a heavy symmetric top, with L frozen in each step.
//!
//! The axle's small offset w from L is a complex number in the plane across L: the real axis points down, the imaginary
//! axis in the direction of the precession. With ψ = |Ω|dt, each step multiplies w by A = 1 − κ + κ e^{iψ}. The torque
//! turns L by δ = |τ|dt/|L| in the direction of the precession.
//!
//! So w' = A w − iδ: the axle lags L by w* = −iδ/(1 − A), and swings about that. The lag δ/|1 − A| is large if ψ is
//! near 2πk. The true lag is δ/(κψ).
//!
//! This theory is linear. The swing changes |L| and therefore ψ, which detunes the prediction near ψ = 2πk. The
//! resulting error is estimated, and there is no prediction if it exceeds about a tenth. The factors of the estimate
//! were found by comparison with runs (random L, tilt and ψ up to 35, κ = 1).

use crate::physics::loads::torque;
use crate::physics::{State, SymmetricTop, observables};
use crate::run::Step;
use nalgebra::Vector3;
use std::f64::consts::PI;

/// Predicted effect of the scheme on the run since the forces last changed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ReportTheory {
    /// |w*|, rad. `None` if it is too large for the linear theory.
    lag: Option<f64>,
    /// ln |A|.
    growth: f64,
    /// Swing about the lag. `None` if it is too large for the linear theory.
    swing: Option<LagSwing>,
}

/// Swing of the axle about its lag.
#[derive(Clone, Copy, Debug, PartialEq)]
struct LagSwing {
    /// w*: components downward and in the direction of the precession.
    lag: [f64; 2],
    /// w − w* at the beginning.
    offset: [f64; 2],
    /// Tilt of L, rad.
    tilt: f64,
    /// arg A.
    turn: f64,
    /// Maximum error of `turn` per step, from everything that the theory neglects, rad.
    slip: f64,
}

/// Maximum relative error of a prediction.
const THEORY_TOLERANCE: f64 = 0.1;
/// Maximum relative change of the nutation by the scheme during the run. With more, it is not the predicted nutation.
const NEUTRAL: f64 = 0.05;
/// Maximum relative decrease of the predicted swing if its steps slip a little. With more, there is no prediction.
const SURE: f64 = 0.05;
/// Maximum number of sampled phases of the swing.
const SWING_PHASES: u64 = 1024;
/// Number of sampled phases in one turn.
const IN_A_TURN: f64 = 256.0;
/// Fractions of the slip to try.
const PHASE_SLIPS: [f64; 4] = [-1.0, -0.5, 0.5, 1.0];

impl ReportTheory {
    /// Returns the theory for a run that begins, or whose forces have just changed, at `step`. `None` for another
    /// scheme, for a body that is not symmetric, or if the forces on the axle are not along z.
    pub fn new(step: &Step) -> Option<Self> {
        let scenario = step.scenario();
        let body = &scenario.body.mechanics;
        let top =
            SymmetricTop::from_body(body).filter(|_| step.motion().scheme.name == "report")?;
        let has_friction = !step.loads().friction.is_none();
        let load = step.loads().on_axle(body, &top).filter(|_| !has_friction)?;
        let (state, time_step_s) = (step.after(), step.motion().time_step_s);
        let size = state.momentum.norm();
        if load.x != 0.0 || load.y != 0.0 || !(size > 0.0 && size.is_finite()) {
            return None;
        }
        let psi = observables::angular_velocity(body, state).norm() * time_step_s;
        let kick =
            torque(&state.orientation, &step.loads().moment(body)).norm() * time_step_s / size;
        let (sin, cos) = (libm::sin(psi), libm::cos(psi));
        let kappa = top.kappa();
        // 1 - A, and -i kick/(1 - A). A load that pulls up turns L the other way.
        let off_one = [kappa * (1.0 - cos), -kappa * sin];
        let size_2 = off_one[0].powi(2) + off_one[1].powi(2);
        let kick = if load.z > 0.0 { -kick } else { kick };
        let lag = [-kick * off_one[1] / size_2, -kick * off_one[0] / size_2];
        let offset = offset_from_momentum(state)?;
        let offset = [offset[0] - lag[0], offset[1] - lag[1]];
        let (lag_size, swing_size) = (
            libm::hypot(lag[0], lag[1]),
            libm::hypot(offset[0], offset[1]),
        );
        let tilt = libm::acos(state.momentum.z / size);
        let [lag_off_by, swing_off_by] = [lag_size, lag_size.max(swing_size)].map(|angle| {
            2.5 * psi * kick.abs() * angle / size_2 + 1.5 * angle / libm::tan(tilt).abs()
        });
        Some(Self {
            lag: (lag_off_by <= THEORY_TOLERANCE).then_some(lag_size),
            growth: 0.5 * libm::log1p(-2.0 * kappa * (1.0 - kappa) * (1.0 - cos)),
            swing: (swing_off_by <= THEORY_TOLERANCE).then_some(LagSwing {
                lag,
                offset,
                tilt,
                turn: libm::atan2(kappa * sin, 1.0 - kappa + kappa * cos),
                slip: 2.0 * kick.abs() * (1.0 + 1.0 / libm::tan(tilt).abs()),
            }),
        })
    }

    /// Returns the mean angle by which the axle lags L in the first `steps` steps, degrees. It is also `None` if the
    /// scheme amplifies the nutation meanwhile, until the axle swings about L and not about the lag.
    pub fn lag_deg(&self, steps: u64) -> Option<f64> {
        let is_fed = self.growth * steps as f64 > NEUTRAL;
        self.lag.filter(|_| !is_fed).map(f64::to_degrees)
    }

    /// Returns the maximum tilt minus the minimum in the first `steps` steps, degrees. `None` if the scheme changes the
    /// nutation meanwhile, or if the steps sample only a few of its phases.
    pub fn swing_deg(&self, steps: u64) -> Option<f64> {
        let swing = self
            .swing
            .filter(|_| (self.growth * steps as f64).abs() <= NEUTRAL)?;
        // Near a simple fraction of a turn, the steps sample few phases of the swing. They drift through the others as
        // slowly as the precession, which is neglected, turns them.
        let seen = swing.seen(steps, self.growth, 0.0);
        let slipped = PHASE_SLIPS.map(|part| swing.seen(steps, self.growth, part * swing.slip));
        let (least, most) = slipped.iter().fold((seen, seen), |(least, most), &seen| {
            (seen.min(least), seen.max(most))
        });
        let is_sure = least >= (1.0 - SURE) * most;
        let radius = libm::hypot(swing.offset[0], swing.offset[1]);
        (is_sure && (seen >= radius || radius == 0.0)).then_some(seen.to_degrees())
    }
}

impl LagSwing {
    /// Returns the maximum tilt minus the minimum in the first `steps` steps, rad. Each step turns the swing by `slip`
    /// in addition, and multiplies its size by exp(`growth`).
    fn seen(&self, steps: u64, growth: f64, slip: f64) -> f64 {
        let stride = (2.0 * PI / IN_A_TURN / self.turn.abs()).clamp(1.0, u32::MAX.into()) as u64;
        let phases = (steps / stride).min(SWING_PHASES);
        let tilts = (0..=phases).map(|index| self.tilt((index * stride) as f64, growth, slip));
        let (low, high) = tilts.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), tilt| {
            (low.min(tilt), high.max(tilt))
        });
        high - low
    }

    /// Returns the tilt after `steps` steps, rad, with the same `growth` and `slip`.
    fn tilt(&self, steps: f64, growth: f64, slip: f64) -> f64 {
        let size = libm::exp(growth * steps);
        let turned = (self.turn + slip) * steps;
        let (sin, cos) = (libm::sin(turned), libm::cos(turned));
        let down = self.lag[0] + size * (self.offset[0] * cos - self.offset[1] * sin);
        let along = self.lag[1] + size * (self.offset[0] * sin + self.offset[1] * cos);
        let towards = (1.0 - down * down - along * along).max(0.0).sqrt();
        libm::acos((libm::cos(self.tilt) * towards - libm::sin(self.tilt) * down).clamp(-1.0, 1.0))
    }
}

/// Returns the axle's offset from L: its components downward and along z × L. `None` if L is vertical.
fn offset_from_momentum(state: &State) -> Option<[f64; 2]> {
    let along = state.momentum.normalize();
    let way = Vector3::z().cross(&along).try_normalize(1e-9)?;
    let down = way.cross(&along);
    let axle = state.axle();
    Some([axle.dot(&down), axle.dot(&way)])
}
