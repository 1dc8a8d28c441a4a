//! Compares schemes and time steps with the exact motion: a table of errors, drifts, cost and measured order.
//!
//! A new column is a field of [`ComparisonRow`], set in `ComparisonTrial::row`.

use super::cost::has_closed_form;
use super::deviation::Deviation;
use super::predictability::{Predictability, predictability};
use crate::cores;
use crate::physics::{SchemeInfo, State};
use crate::run::{Clock, EnergyUnit, NotFinite, Simulation, Step, Truth, resampled};
use crate::scenario::Scenario;
use crate::text::number::{NOT_AVAILABLE, exponent, fixed, shortest};
use serde::{Serialize, Serializer};
use serde_json::{Map, Value, json};
use std::fmt;
use std::ops::ControlFlow;
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::{Duration, Instant};

/// Results of one scheme at one time step, over the whole scenario.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ComparisonRow {
    pub scheme: &'static str,
    pub time_step_s: f64,
    /// Number of completed steps. It is less than requested if the numbers stopped being finite.
    pub steps: u64,
    /// Largest distance of the traced point from the exact motion, m, while the motion can be predicted. `None` if the
    /// run or the exact motion stopped being finite.
    #[serde(serialize_with = "or_na")]
    pub error_m: Option<f64>,
    /// Distance at the end, or at the time until which the motion can be predicted, m.
    #[serde(serialize_with = "or_na")]
    pub error_at_end_m: Option<f64>,
    /// Order measured between the previous row of the same scheme and this one, from `error_m`: ln(error ratio)/ln(time
    /// step ratio). `None` if the error is at the level of rounding.
    #[serde(serialize_with = "or_na")]
    pub order: Option<f64>,
    /// Largest |(E − E0 − W)/S|; see [`Step::energy_drift`].
    #[serde(serialize_with = "or_na")]
    pub energy_drift: Option<f64>,
    /// Largest deviation of L·axle from the exact motion, divided by |L| at the start. `None` if it is not finite.
    #[serde(rename = "L_axle_drift", serialize_with = "or_na")]
    pub spin_drift: Option<f64>,
    /// Largest deviation of L_z from the exact motion, divided by |L| at the start. `None` if it is not finite.
    #[serde(rename = "Lz_drift", serialize_with = "or_na")]
    pub lz_drift: Option<f64>,
    /// Cost of a step in the fastest block of steps, ns.
    pub ns_per_step: f64,
    /// Time spent on stepping alone, s.
    pub wall_s: f64,
}

fn or_na<S: Serializer>(number: &Option<f64>, serializer: S) -> Result<S::Ok, S::Error> {
    match number {
        Some(number) => serializer.serialize_f64(*number),
        None => serializer.serialize_str(NOT_AVAILABLE),
    }
}

/// Runs `scenario` with every scheme at every time step (s), and compares each run with the exact motion.
///
/// The runs use all cores, or one if no threads are available. Everything that is counted in steps keeps its time in
/// seconds. `watch` receives the steps taken so far and their total number. If it breaks, the result is `None`.
pub fn compare(
    scenario: &Scenario,
    schemes: &[&'static SchemeInfo],
    time_steps: &[f64],
    watch: impl Fn(u64, u64) -> ControlFlow<()> + Sync,
) -> Option<Vec<ComparisonRow>> {
    let cells: Vec<Arc<Scenario>> = schemes
        .iter()
        .flat_map(|scheme| {
            time_steps
                .iter()
                .map(|&step| Arc::new(resampled(scenario, step, scheme)))
        })
        .collect();
    let end_s = Clock::end_s(scenario);
    let until_s = predictability(&Arc::new(scenario.clone()), end_s).until_s;
    let total = cells
        .iter()
        .map(|cell| cell.steps)
        .fold(0, u64::saturating_add);
    let steps_taken = AtomicU64::new(0);
    let rows: Option<Vec<ComparisonRow>> = cores::map(&cells, |cell: &Arc<Scenario>| {
        let mut before = 0;
        let trial = ComparisonTrial::run(cell, until_s.unwrap_or(f64::INFINITY), |step| {
            let now = steps_taken.fetch_add(step - before, Ordering::Relaxed) + (step - before);
            before = step;
            watch(now, total)
        });
        trial.map(|trial| trial.row(cell))
    });
    rows.map(|rows| with_orders(rows, ERROR_ROUNDING * scenario.arm_m()))
}

/// Number of steps per run, evenly spread, at which the energy is read. The distance is read at every step.
const ENERGY_SAMPLES: u64 = 1000;
/// Maximum steps between checks of the clock, the exact motion and the watcher.
const COMPARISON_BLOCK_STEPS: u64 = 4096;
/// The same if a step may have to be integrated, which can be slow.
const BLOCK_OF_INTEGRATIONS: u64 = 16;
/// Minimum number of steps for a meaningful timing.
const TIMED: u64 = 1000;

/// A run compared with the exact motion, with the numbers for its [`ComparisonRow`].
#[derive(Default)]
struct ComparisonTrial {
    steps: u64,
    most_distance_m: f64,
    end_distance_m: f64,
    energy_drift: Option<f64>,
    spin_drift: f64,
    lz_drift: f64,
    stepping: Duration,
    /// Time per step in the fastest block, s. It excludes delays caused by other work on the machine.
    fastest_s: f64,
    has_broken: bool,
}

impl ComparisonTrial {
    /// Plays `scenario` to its end, and records its errors up to `until_s`. `watch` is called regularly. If it breaks,
    /// the result is `None`.
    fn run(
        scenario: &Arc<Scenario>,
        until_s: f64,
        mut watch: impl FnMut(u64) -> ControlFlow<()>,
    ) -> Option<Self> {
        let mut simulation = Simulation::new(Arc::clone(scenario));
        let mut truth = Truth::new(Arc::clone(scenario));
        let mut trial = Self {
            fastest_s: f64::INFINITY,
            ..Self::default()
        };
        let steps_between = stride(scenario.steps);
        let block = if has_closed_form(scenario) {
            COMPARISON_BLOCK_STEPS
        } else {
            BLOCK_OF_INTEGRATIONS
        };
        let momentum = scenario.start.momentum.norm();
        let scale = if momentum > 0.0 { momentum } else { 1.0 };
        let mut states = Vec::new();
        let mut timed = (0, Duration::ZERO);
        while simulation.step_number() < scenario.steps && !trial.has_broken {
            let readings = simulation.step_number() / steps_between + 1;
            let next_reading = scenario.steps.min(readings.saturating_mul(steps_between));
            let next = next_reading.min(simulation.step_number() + block);
            states.clear();
            let begin = Instant::now();
            trial.has_broken = take_steps(&mut simulation, next, &mut states).is_err();
            timed = (timed.0 + states.len() as u64, timed.1 + begin.elapsed());
            if timed.0 >= TIMED {
                trial.time(timed);
                timed = (0, Duration::ZERO);
            }
            for state in states.iter().filter(|state| state.time_s <= until_s) {
                trial.compare_step(state, &mut truth, scale);
            }
            if next == next_reading || trial.has_broken {
                trial.read_energy(simulation.now());
            }
            watch(simulation.step_number()).continue_value()?;
        }
        trial.steps = simulation.step_number();
        trial.time(timed);
        Some(trial)
    }

    fn row(&self, scenario: &Scenario) -> ComparisonRow {
        let [error_m, error_at_end_m] = [self.most_distance_m, self.end_distance_m]
            .map(|error| (!self.has_broken && error.is_finite()).then_some(error));
        ComparisonRow {
            scheme: scenario.motion.scheme.name,
            time_step_s: scenario.motion.time_step_s,
            steps: self.steps,
            error_m,
            error_at_end_m,
            order: None,
            energy_drift: self.energy_drift,
            spin_drift: Some(self.spin_drift).filter(|drift| drift.is_finite()),
            lz_drift: Some(self.lz_drift).filter(|drift| drift.is_finite()),
            ns_per_step: Some(self.fastest_s * 1e9)
                .filter(|ns| ns.is_finite())
                .unwrap_or(0.0),
            wall_s: self.stepping.as_secs_f64(),
        }
    }

    /// Records that `steps` steps took `duration`.
    fn time(&mut self, (steps, duration): (u64, Duration)) {
        self.stepping += duration;
        // The remainder at the end may be too short for a timing.
        if steps >= TIMED || (steps > 0 && self.fastest_s.is_infinite()) {
            self.fastest_s = self.fastest_s.min(duration.as_secs_f64() / steps as f64);
        }
    }

    /// Compares one step of the run with the exact motion.
    fn compare_step(&mut self, state: &State, truth: &mut Truth, scale: f64) {
        let off = Deviation::between(state, truth);
        self.end_distance_m = off.distance_m;
        self.most_distance_m = greater(self.most_distance_m, off.distance_m);
        self.spin_drift = greater(self.spin_drift, (off.axle_momentum / scale).abs());
        self.lz_drift = greater(self.lz_drift, (off.lz / scale).abs());
    }

    fn read_energy(&mut self, step: &Step) {
        let drift = step.energy_drift().map(f64::abs);
        self.energy_drift = drift.map(|drift| drift.max(self.energy_drift.unwrap_or(0.0)));
    }
}

/// Steps up to step `end`, and collects the states.
fn take_steps(run: &mut Simulation, end: u64, states: &mut Vec<State>) -> Result<(), NotFinite> {
    while run.step_number() < end {
        states.push(*run.step()?.after());
    }
    Ok(())
}

/// Returns the greater of two numbers, or NaN if either is NaN because the run could not be followed.
fn greater(most: f64, now: f64) -> f64 {
    if most.is_nan() || now <= most {
        most
    } else {
        now
    }
}

/// Returns the number of steps between two energy readings. It is odd, so that a run with an even period is not always
/// read at the same phase.
fn stride(steps: u64) -> u64 {
    match steps / ENERGY_SAMPLES {
        0 => 1,
        stride => stride | 1,
    }
}

/// Errors below this fraction of the traced point's arm are rounding errors, and say nothing about the scheme.
const ERROR_ROUNDING: f64 = 1e-12;

fn with_orders(mut rows: Vec<ComparisonRow>, least_m: f64) -> Vec<ComparisonRow> {
    for index in 1..rows.len() {
        let (coarse, fine) = (&rows[index - 1], &rows[index]);
        rows[index].order = (coarse.scheme == fine.scheme)
            .then(|| order(coarse, fine, least_m))
            .flatten();
    }
    rows
}

fn order(coarse: &ComparisonRow, fine: &ComparisonRow, least_m: f64) -> Option<f64> {
    let (larger, smaller) = (coarse.error_m?, fine.error_m?);
    let order = libm::log(larger / smaller) / libm::log(coarse.time_step_s / fine.time_step_s);
    (smaller > least_m && order.is_finite()).then_some(order)
}

/// The rows as a table to print.
#[derive(Clone, Copy, Debug)]
pub struct ComparisonTable<'a> {
    pub rows: &'a [ComparisonRow],
    /// Unit of the energy drifts. `None` if there is no energy to measure them by.
    pub energy_unit: Option<EnergyUnit>,
    /// Limits on predicting the exact motion.
    pub predictability: Predictability,
}

impl ComparisonTable<'_> {
    /// Returns the table as one JSON object: the run, the exact motion, and one row for each scheme and time step.
    ///
    /// The keys of a row are the column names of the CSV. A missing number is null.
    ///
    /// # Errors
    /// Returns an error only if memory runs out.
    pub fn json(&self, title: &str, duration_s: f64, truth: &str) -> serde_json::Result<Value> {
        let rows: serde_json::Result<Vec<Value>> = self
            .rows
            .iter()
            .map(|row: &ComparisonRow| {
                let mut value = serde_json::to_value(row)?;
                for field in value.as_object_mut().into_iter().flat_map(Map::values_mut) {
                    if field == NOT_AVAILABLE {
                        *field = Value::Null;
                    }
                }
                Ok(value)
            })
            .collect();
        Ok(json!({
            "title": title,
            "duration_s": duration_s,
            "exact_motion": truth,
        "predictable_until_s": self.predictability.until_s,
            "energy_drift_unit": self.energy_unit.map(|unit| unit.to_string()),
            "rows": rows?,
        }))
    }

    fn legend(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let limits = &self.predictability;
        if *limits != Predictability::default() {
            writeln!(f, "\nThe motion is {limits}.")?;
        }
        if limits.until_s.is_some() {
            writeln!(f, "Errors and drifts of L cover the time up to then.")?;
        }
        let energy = match self.energy_unit {
            Some(unit) => format!("in units of {unit}"),
            None => format!("{NOT_AVAILABLE}: neither weight nor kinetic energy to measure it by"),
        };
        writeln!(f)?;
        writeln!(
            f,
            "order   measured from the row above; meaningful once the error falls steadily. -: first row, or rounding."
        )?;
        writeln!(
            f,
            "energy  {energy}; L.axle and L_z in units of |L|. Each is the maximum error."
        )?;
        if self.rows.iter().any(|row| row.error_m.is_none()) {
            writeln!(
                f,
                "{NOT_AVAILABLE} for an error: the numbers were no longer finite after the steps shown."
            )?;
        }
        writeln!(
            f,
            "ns/step measured with all cores busy: compare it only within this table."
        )
    }
}

impl fmt::Display for ComparisonTable<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{:<8} {:>10} {:>10}", "scheme", "dt s", "steps")?;
        write!(f, " {:>9} {:>9} {:>6}", "error m", "at end m", "order")?;
        writeln!(
            f,
            " {:>9} {:>9} {:>9} {:>8}",
            "energy", "L.axle", "L_z", "ns/step"
        )?;
        for row in self.rows {
            let order = row.order.map_or("-".to_owned(), |order| fixed(order, 2));
            let [error, at_end, energy, spin, lz] = [
                row.error_m,
                row.error_at_end_m,
                row.energy_drift,
                row.spin_drift,
                row.lz_drift,
            ]
            .map(|number| number.map_or(NOT_AVAILABLE.to_owned(), |number| exponent(number, 1)));
            let step = shortest(row.time_step_s);
            write!(f, "{:<8} {step:>10} {:>10}", row.scheme, row.steps)?;
            write!(f, " {error:>9} {at_end:>9} {order:>6}")?;
            write!(f, " {energy:>9} {spin:>9} {lz:>9}")?;
            writeln!(f, " {:>8}", fixed(row.ns_per_step, 0))?;
        }
        self.legend(f)
    }
}
