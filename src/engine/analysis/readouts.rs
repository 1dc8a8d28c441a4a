//! The one table of readouts: every number that is read off a run, under the name by which it leaves the program, with
//! its unit and its meaning. The JSON, the summary, the lab and whoever asks for a number by its name read this table.
//!
//! A bare name is the live value of the run's last step. `predicted_...` is theory's, `measured_...` the run's own. What
//! cannot be stated honestly is [`ReadoutValue::Nothing`], null in JSON: no number of it is ever NaN or infinite.

mod summary_row;
mod table;
mod value_row;

pub use summary_row::{SummaryPart, SummaryRow, summary_rows};
pub use table::{READOUTS, Readout, ReadoutSource, find, names, nearest};
pub use value_row::{ShownValue, ValueGroup, ValueRow, four_digits, value_rows};

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

/// A run at one step, with what has been measured on it and what theory says of it.
#[derive(Clone, Debug, PartialEq)]
pub struct Readouts {
    pub title: String,
    /// The name of the scheme in force.
    pub scheme: &'static str,
    /// How the scheme went about it, where it has more than one way.
    pub scheme_kind: Option<String>,
    pub time_step_s: f64,
    pub sample: Sample,
    /// L·axle, J s.
    pub axle_momentum: f64,
    /// The rate of the spin about the axle, rad/s; of the rotor alone where the scenario names one.
    pub spin_rad_per_s: f64,
    /// Whether a rotor spins in a frame that does not.
    pub has_rotor: bool,
    /// I3/I1 of a symmetric body, or of a nearly symmetric one, I1 the mean of its moments across.
    pub kappa: Option<f64>,
    /// The asymmetry of such a body.
    pub asymmetry: Option<f64>,
    pub health: Health,
    /// What would mend it, where that has been sought.
    pub advice: Option<Advice>,
    /// What theory says of the exact motion now, about the axis that it names.
    pub theory: Option<Theory>,
    pub extremes: Extremes,
    /// M g, N.
    pub weight: f64,
    /// Its mean over whole nutations since the forces last changed, N.
    pub mean_foot_force: Option<MeasuredNumber>,
    /// That mean by Newton's second law, N.
    pub predicted_mean_foot_force: Option<f64>,
    /// Precession since the forces last changed, rad/s.
    pub precession: Option<MeasuredNumber>,
    /// Nutation period since the forces last changed, s.
    pub nutation: Option<MeasuredNumber>,
    /// Why there is no such period.
    pub without_nutation: Option<WithoutNutation>,
    /// Swing of the tilt since the forces last changed, degrees.
    pub tilt_swing: Option<MeasuredNumber>,
    /// What the linear theory of the report's scheme says of the motion since the forces last changed.
    pub report_theory: Option<ReportTheory>,
    /// The step at which they did.
    pub since: u64,
    /// Time spent on stepping alone, where it was measured.
    pub stepping: Option<Duration>,
}

impl Readouts {
    /// The readouts of `simulation` as it stands: `monitor` has followed it, `health` is how it stands, and `advice`
    /// what would mend it.
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
        // Under friction neither rate lasts: there is no one number that a measurement could come near to.
        if self.health.slowing.is_none() {
            self.precession = monitor.instruments.precession_rad_per_s();
            (self.nutation, self.without_nutation) = match monitor.instruments.nutation_period_s() {
                Ok(measured) => (Some(measured), None),
                Err(why) => (None, Some(why)),
            };
            // The momentum at turning points that the rows do not show is not what is read there.
            let is_seen = self.nutation_is_resolved() != Some(false);
            self.mean_foot_force = monitor.mean_foot_force().filter(|_| is_seen);
        }
        self.tilt_swing = monitor.tilt_swing_deg();
    }

    /// Reads those of `source` off `simulation` again, which `monitor` has followed on; the others stay as they are, where
    /// reading them as well would cost more.
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

    /// The number that `name` stands for; `None` where there is none of that name, it is a text, or it cannot be stated.
    pub fn number(&self, name: &str) -> Option<f64> {
        find(name)?.read_from(self).number()
    }

    /// Theory, where its axis is +z, about which the measured numbers are too.
    pub fn theory_about_z(&self) -> Option<&Theory> {
        self.theory
            .as_ref()
            .filter(|theory| theory.axis == TheoryAxis::Z)
    }

    /// The same, where it is of the motion that does follow: there is no friction.
    fn lasting_theory(&self) -> Option<&Theory> {
        self.theory_about_z()
            .filter(|theory| !theory.is_of_a_moment)
    }

    /// Least and greatest tilt of the exact motion that follows under the present forces, degrees; `None` where theory
    /// does not know it.
    pub fn predicted_tilt_range_deg(&self) -> Option<(f64, f64)> {
        self.lasting_theory().map(|theory| theory.tilt_range_deg)
    }

    /// The same for the whole run so far: `None` too where the forces have changed after the first step, since theory
    /// does not know the time before.
    fn predicted_tilts_of_run(&self) -> Option<(f64, f64)> {
        let is_whole_run = self.since <= 1;
        self.predicted_tilt_range_deg().filter(|_| is_whole_run)
    }

    /// Whether the time step shows the nutation as it is: `Some(false)` where what is measured is strobed,
    /// `None` where the step is short and theory knows no period to hold it against.
    pub fn nutation_is_resolved(&self) -> Option<bool> {
        let period_s = self
            .theory_about_z()
            .and_then(|theory| theory.nutation_period_s);
        let is_short = period_s.map(|period_s| 2.0 * self.time_step_s < period_s);
        // Turned by half a turn a step or more, the axle's swing about L is seen too seldom as well. The schemes that
        // turn the body exactly still follow the nutation of a known period that is longer.
        let turns_exactly = self.health.scheme.turns_exactly;
        let follows = self.turn_rad() < PI || (turns_exactly && period_s.is_some());
        match is_short {
            _ if !follows => Some(false),
            Some(is_short) => Some(is_short),
            None => None,
        }
    }

    /// The period of the tilt's swings as the steps show them, s: measured, or before that predicted where the time step
    /// shows the nutation as it is; `None` where there are no swings.
    pub fn swing_s(&self) -> Option<f64> {
        let measured = self.nutation.filter(MeasuredNumber::is_settled);
        let swing_s = measured.map(|measured| measured.value).or_else(|| {
            let is_seen = self.nutation_is_resolved() != Some(false);
            self.theory_about_z()?.nutation_period_s.filter(|_| is_seen)
        });
        swing_s.filter(|swing_s| *swing_s > 0.0 && swing_s.is_finite())
    }

    /// By how much the body turns in a time step, or the axle about L where that is more, rad.
    fn turn_rad(&self) -> f64 {
        let turn = self.health.turns_per_step * 2.0 * PI;
        match (&self.theory, self.kappa) {
            // A free symmetric top's axle goes round L at |L|/I1.
            (Some(theory), Some(_)) if theory.axis == TheoryAxis::Momentum => {
                let rate = theory.precession.unwrap_or(0.0).abs();
                turn.max(rate * self.time_step_s)
            }
            _ => turn,
        }
    }
}

impl Serialize for Readouts {
    /// One object, a field a readout, in the table's order; how the scheme went about it is left out where it has one way.
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
    /// As a number: 1 and 0 for yes and no; `None` of a text.
    pub fn number(&self) -> Option<f64> {
        match self {
            Self::Number(number) => Some(*number),
            Self::Whole(count) => Some(*count as f64),
            Self::Flag(is_so) => Some(f64::from(u8::from(*is_so))),
            Self::Text(_) | Self::Nothing => None,
        }
    }
}

/// Steps that are taken without asking whether to go on.
const READOUT_BLOCK_STEPS: u64 = 4096;

/// Plays the run of `scenario` to its end and reads `wanted` off it; `None` where `go_on` said no on the way.
pub fn at_end(
    scenario: Scenario,
    wanted: &[&Readout],
    go_on: &dyn Fn() -> bool,
) -> Result<Option<Vec<ReadoutValue>>, String> {
    let scenario = Arc::new(scenario);
    // Only these need every step compared with the exact motion, which may take longer than the run.
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
    // What would mend a run is part of the one sentence about it, and takes a search.
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

/// Whether the `wanted` numbers are the same however the run gets to its end: those of theory, where nothing happens at
/// certain steps on the way, and the scheme needs none.
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
