//! The table of readouts: every number that is read from a run, with its name, unit and meaning. The JSON, the summary,
//! the lab, and everyone who asks for a number by name use this table. A new readout is a row of it.
//!
//! A bare name is the value at the run's last step. A name with `predicted_` is theory's value, and `measured_` is the
//! run's. A value that is unknown is [`ReadoutValue::Nothing`], null in JSON. No number is ever NaN or infinite.

mod summary_row;
mod table;
mod value_row;

pub use summary_row::{SummaryPart, SummaryRow, summary_rows};
pub use table::{READOUTS, Readout, ReadoutSource, find, names, nearest};
pub use value_row::{
    ShownValue, ValueGroup, ValueRow, four_digits, passes_through_vertical, value_rows,
};

use super::health::{Advice, advise};
use super::report_theory::ReportTheory;
use super::theory::TheoryAxis;
use super::{Extremes, Health, MeasuredNumber, Monitor, Theory, WithoutNutation};
use crate::physics::SymmetricTop;
use crate::run::{Clock, Sample, Simulation};
use crate::scenario::{Scenario, Window};
use serde::ser::{Serialize, SerializeMap, Serializer};
use std::f64::consts::PI;
use std::sync::Arc;
use std::time::Duration;

/// A run at one step, with its measurements and the predictions of theory.
#[derive(Clone, Debug, PartialEq)]
pub struct Readouts {
    pub title: String,
    /// Name of the scheme in force.
    pub scheme: &'static str,
    /// Variant of the scheme that the run used, if the scheme has more than one.
    pub scheme_kind: Option<String>,
    pub time_step_s: f64,
    pub sample: Sample,
    /// L·axle, J s.
    pub axle_momentum: f64,
    /// Rate of the spin about the axle, rad/s. If the scenario names a rotor, the rate of the rotor alone.
    pub spin_rad_per_s: f64,
    /// True if a rotor spins in a frame that does not.
    pub has_rotor: bool,
    /// I3/I1 of a symmetric or nearly symmetric body. I1 is then the mean of its moments of inertia across the axle.
    pub kappa: Option<f64>,
    /// Asymmetry of such a body.
    pub asymmetry: Option<f64>,
    pub health: Health,
    /// Advice that would fix the run, if it was searched for.
    pub advice: Option<Advice>,
    /// Theory of the exact motion now, about the axis that it names.
    pub theory: Option<Theory>,
    pub extremes: Extremes,
    /// M g, N.
    pub weight: f64,
    /// Mean force on the foot over whole nutations since the forces last changed, N.
    pub mean_foot_force: Option<MeasuredNumber>,
    /// That mean by Newton's second law, N.
    pub predicted_mean_foot_force: Option<f64>,
    /// Precession since the forces last changed, rad/s.
    pub precession: Option<MeasuredNumber>,
    /// Nutation period since the forces last changed, s.
    pub nutation: Option<MeasuredNumber>,
    /// Reason why there is no such period.
    pub without_nutation: Option<WithoutNutation>,
    /// Swing of the tilt since the forces last changed, degrees.
    pub tilt_swing: Option<MeasuredNumber>,
    /// Linear theory of the report's scheme for the motion since the forces last changed.
    pub report_theory: Option<ReportTheory>,
    /// Step at which the forces last changed.
    pub since: u64,
    /// Time spent on stepping alone, if it was measured.
    pub stepping: Option<Duration>,
}

impl Readouts {
    /// Returns the readouts of `simulation` at its present step. `monitor` has followed it, and `health` and `advice`
    /// belong to this step.
    pub fn new(
        simulation: &Simulation,
        monitor: &mut Monitor,
        health: &Health,
        advice: Option<&Advice>,
    ) -> Self {
        let step = simulation.now();
        let state = step.after();
        let is_smooth = health.slowing.is_none();
        let top = SymmetricTop::nearly(&step.scenario().body.mechanics);
        let mut readouts = Self {
            title: step.scenario().file.title.clone(),
            scheme: step.motion().scheme.name,
            scheme_kind: simulation.remark(),
            time_step_s: step.motion().time_step_s,
            sample: step.sample(),
            axle_momentum: state.momentum.dot(&state.axle()),
            spin_rad_per_s: step.scenario().spin_rad_per_s(state),
            has_rotor: step.scenario().rotor().is_some(),
            kappa: top.map(|(top, _)| top.kappa()),
            asymmetry: top.map(|(_, asymmetry)| asymmetry),
            health: *health,
            advice: advice.copied(),
            theory: monitor.theory(state.time_s),
            extremes: monitor.extremes,
            weight: step.scenario().body.mechanics.mass() * step.loads().gravity,
            mean_foot_force: None,
            predicted_mean_foot_force: is_smooth.then(|| monitor.predicted_mean_foot_force(step)),
            precession: None,
            nutation: None,
            without_nutation: None,
            tilt_swing: None,
            report_theory: monitor.report_theory,
            since: monitor.since,
            stepping: None,
        };
        readouts.read_measured(monitor);
        readouts
    }

    fn read_measured(&mut self, monitor: &Monitor) {
        // With friction neither rate is constant, so there is no single number to measure.
        if self.health.slowing.is_none() {
            self.precession = monitor.instruments.precession_rad_per_s();
            (self.nutation, self.without_nutation) = match monitor.instruments.nutation_period_s() {
                Ok(measured) => (Some(measured), None),
                Err(why) => (None, Some(why)),
            };
            // If the rows do not show the turning points, they do not show the momentum there either.
            let is_seen = self.nutation_is_resolved() != Some(false);
            self.mean_foot_force = monitor.mean_foot_force().filter(|_| is_seen);
        }
        self.tilt_swing = monitor.tilt_swing_deg();
    }

    /// Reads the readouts of `source` from `simulation` again, after `monitor` has followed it further. The other
    /// readouts keep their values if reading them too would cost more.
    pub fn read_again(
        &mut self,
        source: ReadoutSource,
        simulation: &Simulation,
        monitor: &mut Monitor,
    ) {
        match source {
            ReadoutSource::EveryStep => self.extremes = monitor.extremes,
            ReadoutSource::Measured => self.read_measured(monitor),
            ReadoutSource::Exact => {
                let deviation = monitor.beside.deviation(simulation.state());
                self.health.deviation = deviation;
                self.health.most_distance_m = monitor.beside.most_distance_m();
                self.health.predictability = monitor.beside.predictability();
                self.health.swing = monitor.beside.swing();
            }
            ReadoutSource::Scenario
            | ReadoutSource::State
            | ReadoutSource::Scheme
            | ReadoutSource::Theory
            | ReadoutSource::Clock => {
                let health = monitor.health(simulation.now());
                *self = Self::new(simulation, monitor, &health, self.advice.as_ref());
            }
        }
    }

    /// Returns the number of the readout `name`. `None` if there is no such readout, it is a text, or it is unknown.
    pub fn number(&self, name: &str) -> Option<f64> {
        find(name)?.read_from(self).number()
    }

    /// Returns the theory if its axis is +z, which is also the axis of the measured numbers.
    pub fn theory_about_z(&self) -> Option<&Theory> {
        self.theory
            .as_ref()
            .filter(|theory| theory.axis == TheoryAxis::Z)
    }

    /// Returns the same theory if it predicts the motion to come, that is, without friction.
    fn lasting_theory(&self) -> Option<&Theory> {
        self.theory_about_z()
            .filter(|theory| !theory.is_of_a_moment)
    }

    /// Returns the minimum and maximum tilt of the exact motion that follows under the present forces, degrees. `None`
    /// if theory does not predict it.
    pub fn predicted_tilt_range_deg(&self) -> Option<(f64, f64)> {
        self.lasting_theory().map(|theory| theory.tilt_range_deg)
    }

    /// Returns the same range for the whole run so far. It is also `None` if the forces have changed after the first
    /// step, because theory does not cover the time before.
    fn predicted_tilts_of_run(&self) -> Option<(f64, f64)> {
        let is_whole_run = self.since <= 1;
        self.predicted_tilt_range_deg().filter(|_| is_whole_run)
    }

    /// Returns true if the time step resolves the nutation, and false if the measured nutation is under-sampled. `None`
    /// if the step is short and theory predicts no period.
    pub fn nutation_is_resolved(&self) -> Option<bool> {
        let period_s = self
            .theory_about_z()
            .and_then(|theory| theory.nutation_period_s);
        let is_short = period_s.map(|period_s| 2.0 * self.time_step_s < period_s);
        // If the body turns by half a turn per step or more, the axle's swing about L is sampled too seldom as well.
        // Schemes that turn the body exactly still follow a nutation whose predicted period is longer.
        let turns_exactly = self.health.scheme.turns_exactly;
        let follows = self.turn_rad() < PI || (turns_exactly && period_s.is_some());
        match is_short {
            _ if !follows => Some(false),
            Some(is_short) => Some(is_short),
            None => None,
        }
    }

    /// Returns the period of the tilt's swings as the steps show them, s. It is measured, or until then predicted, if
    /// the time step resolves the nutation. `None` if there are no swings.
    pub fn swing_s(&self) -> Option<f64> {
        let measured = self.nutation.filter(MeasuredNumber::is_settled);
        let swing_s = measured.map(|measured| measured.value).or_else(|| {
            let is_seen = self.nutation_is_resolved() != Some(false);
            self.theory_about_z()?.nutation_period_s.filter(|_| is_seen)
        });
        swing_s.filter(|swing_s| *swing_s > 0.0 && swing_s.is_finite())
    }

    /// Returns the angle by which the body turns in a time step, or the axle about L if that is larger, rad.
    fn turn_rad(&self) -> f64 {
        let turn = self.health.turns_per_step * 2.0 * PI;
        match (&self.theory, self.kappa) {
            // The axle of a free symmetric top goes round L at |L|/I1.
            (Some(theory), Some(_)) if theory.axis == TheoryAxis::Momentum => {
                let rate = theory.precession.unwrap_or(0.0).abs();
                turn.max(rate * self.time_step_s)
            }
            _ => turn,
        }
    }
}

impl Serialize for Readouts {
    /// Writes one object with a field for each readout, in the order of the table. `scheme_kind` is omitted if the
    /// scheme has only one variant.
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let mut object = serializer.serialize_map(None)?;
        for readout in READOUTS {
            let value = readout.read_from(self);
            if readout.name != "scheme_kind" || value != ReadoutValue::Nothing {
                object.serialize_entry(readout.name, &value)?;
            }
        }
        object.end()
    }
}

#[derive(Clone, Debug, PartialEq, serde::Serialize)]
#[serde(untagged)]
pub enum ReadoutValue {
    /// A finite number, in the readout's unit.
    Number(f64),
    Whole(u64),
    Flag(bool),
    Text(String),
    Nothing,
}

impl ReadoutValue {
    /// Returns the value as a number, with 1 and 0 for true and false. `None` for a text.
    pub fn number(&self) -> Option<f64> {
        match self {
            Self::Number(number) => Some(*number),
            Self::Whole(count) => Some(*count as f64),
            Self::Flag(is_so) => Some(f64::from(u8::from(*is_so))),
            Self::Text(_) | Self::Nothing => None,
        }
    }
}

/// Number of steps between two calls of `go_on`.
const READOUT_BLOCK_STEPS: u64 = 4096;

/// Plays the run of `scenario` to its end and reads the `wanted` readouts. Returns `None` if `go_on` returned false on
/// the way.
pub fn at_end(
    scenario: Scenario,
    wanted: &[&Readout],
    go_on: &dyn Fn() -> bool,
) -> Result<Option<Vec<ReadoutValue>>, String> {
    let scenario = Arc::new(scenario);
    // Only these readouts need every step compared with the exact motion, which may take longer than the run.
    let is_held = wanted
        .iter()
        .any(|readout| readout.source == ReadoutSource::Exact);
    let mut simulation = Simulation::new(Arc::clone(&scenario));
    let mut monitor = Monitor::new(simulation.now());
    let jumps = needs_no_steps(&scenario, wanted);
    if jumps {
        let end_s = Clock::end_s(&scenario);
        let ended = simulation.step_to_time(end_s);
        ended.map_err(|error| error.to_string())?;
    }
    while !jumps && simulation.step_number() < scenario.steps {
        let end = scenario
            .steps
            .min(simulation.step_number() + READOUT_BLOCK_STEPS);
        while simulation.step_number() < end {
            let step = simulation.step().map_err(|error| error.to_string())?;
            if is_held {
                monitor.record(step);
            } else {
                monitor.measure(step);
            }
        }
        if !go_on() {
            return Ok(None);
        }
    }
    let health = monitor.health(simulation.now());
    // The sentence about a run includes the advice, which takes a search.
    let is_asked = wanted.iter().any(|readout| readout.name == "health");
    let is_wrong = health.is_believed() == Some(false);
    let advice = (is_asked && is_wrong).then(|| advise(&scenario));
    let read = Readouts::new(&simulation, &mut monitor, &health, advice.as_ref());
    Ok(Some(
        wanted
            .iter()
            .map(|readout| readout.read_from(&read))
            .collect(),
    ))
}

/// Returns true if the `wanted` numbers do not depend on how the run gets to its end. This holds only for theory's
/// numbers, if the scheme needs no steps and nothing happens at certain steps on the way.
fn needs_no_steps(scenario: &Scenario, wanted: &[&Readout]) -> bool {
    scenario.motion.scheme.order.is_none()
        && wanted
            .iter()
            .all(|readout| readout.source == ReadoutSource::Theory)
        && scenario.edits.is_empty()
        && !scenario
            .pushes
            .iter()
            .any(|push| matches!(push.window, Window::Steps { .. }))
}
