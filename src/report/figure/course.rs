//! Sampling of a run for a figure, either by playing it again or while it is played for another purpose.

use super::arcs::StepArcs;
use super::path::{self, TracedPath};
use crate::engine::analysis::predictability::predictability;
use crate::engine::analysis::{DistanceMeter, ExactReference, Health};
use crate::engine::export::CsvColumn;
use crate::engine::export::columns::DISTANCE;
use crate::engine::export::stream::{self, Ended};
use crate::engine::recording::{Extent, Recording, RecordingBin};
use crate::engine::run::{Clock, NotFinite, Sample, Simulation, Step, Truth};
use crate::engine::scenario::Scenario;
use crate::physics::exact::LagrangeTop;
use crate::physics::observables::{self, Azimuth};
use crate::physics::{Loads, State};
use nalgebra::Vector3;
use std::f64::consts::TAU;
use std::io;
use std::ops::ControlFlow;
use std::sync::Arc;

const EXACT_TOGETHER: usize = 4;
/// Number of bins of a curve over time: more than the widest page has dots across.
const CURVE_BINS: f64 = 8192.0;

#[derive(Clone, Debug)]
pub struct SampleRequest {
    pub columns: Vec<&'static CsvColumn>,
    pub path: bool,
    pub from_s: f64,
    pub to_s: Option<f64>,
}

#[derive(Clone, Debug)]
pub struct SampledRun {
    wanted: SampleRequest,
    curves: Arc<Vec<Recording>>,
    pub path: Arc<TracedPath>,
    /// The path seen from above, with z = 0. It is not interrupted where the path goes up and down in one place.
    pub above: Arc<TracedPath>,
    pub end_s: f64,
    /// True if the time range contains no sample.
    pub is_empty: bool,
    /// The step at which numbers stopped being finite, if any.
    pub broke: Option<NotFinite>,
    /// Accuracy at the last step; `None` if the run was not compared with the exact motion.
    pub health: Option<Health>,
    /// Time after which no computation can predict the motion, s. `None` if the run ends before it, or if it is
    /// unknown.
    pub predictable_until_s: Option<f64>,
    /// Period of the nutation of the exact motion, s, if known: there may be too few samples to count its swings.
    pub swing_s: Option<f64>,
}

/// The values of a column in a bin of time.
#[derive(Clone, Copy, Debug)]
pub(super) struct Bin {
    /// First and last time, s.
    pub times_s: [f64; 2],
    pub extent: Extent,
    last: f64,
    /// Number of times the curve turned up or down.
    pub turns: u32,
}

impl SampleRequest {
    /// Returns true if a column is requested that the exact motion does not have: the number of the step, or of the
    /// segment between edits.
    pub fn counts_steps(&self) -> bool {
        let mut columns = self.columns.iter();
        columns.any(|column| ["step", "segment"].contains(&column.name))
    }

    pub fn end_s(&self, scenario: &Scenario) -> f64 {
        let end_s = Clock::end_s(scenario);
        self.to_s.map_or(end_s, |to_s| to_s.min(end_s))
    }
}

impl SampledRun {
    /// Returns the `wanted` samples of the run of `scenario`, if this sampled run contains all of them.
    pub(super) fn part(&self, scenario: &Scenario, wanted: &SampleRequest) -> Option<Self> {
        let end_s = wanted.end_s(scenario);
        let mut columns = wanted.columns.iter();
        let is_all = self.wanted.from_s == wanted.from_s
            && self.end_s <= end_s + rounding_s(end_s)
            && end_s <= self.wanted.end_s(scenario)
            && (self.wanted.path || !wanted.path)
            && columns.all(|column| self.place(column).is_some());
        is_all.then(|| Self {
            end_s: self.end_s.min(end_s),
            ..self.clone()
        })
    }

    fn place(&self, column: &CsvColumn) -> Option<usize> {
        let mut columns = self.wanted.columns.iter();
        columns.position(|it| it.name == column.name)
    }

    /// Returns the bins of `column` in order of time.
    pub(super) fn parts(&self, column: &CsvColumn) -> Vec<Bin> {
        let Some(place) = self.place(column) else {
            return Vec::new();
        };
        let blocks = in_parts(&self.curves[place / EXACT_TOGETHER]);
        let curve = place % EXACT_TOGETHER;
        let parts = blocks.iter().map(|block| Bin {
            times_s: [block.begin_s, block.end_s],
            extent: block.extents[curve],
            last: block.last[curve],
            turns: block.turned[curve],
        });
        parts
            .filter(|part| (part.extent.min + part.extent.max + part.last).is_finite())
            .collect()
    }

    /// Returns the points of `column`, including every extreme.
    pub fn points(&self, column: &CsvColumn) -> Vec<[f64; 2]> {
        let mut points: Vec<[f64; 2]> = Vec::new();
        for part in self.parts(column) {
            let ([begin_s, end_s], Extent { min, max }) = (part.times_s, part.extent);
            let before = points.last().map_or(min, |point| point[1]);
            let (early, late) = if max - before < before - min {
                (max, min)
            } else {
                (min, max)
            };
            let middle = (late != part.last).then_some([0.5 * (begin_s + end_s), late]);
            let part = [Some([begin_s, early]), middle, Some([end_s, part.last])];
            for point in part.into_iter().flatten() {
                if points.last() != Some(&point) {
                    points.push(point);
                }
            }
        }
        points
    }
}

/// Returns the bins of `curves`, merged within each part of the time.
fn in_parts(curves: &Recording) -> Vec<RecordingBin> {
    let mut blocks: Vec<RecordingBin> = Vec::new();
    let Some(whole) = curves.whole() else {
        return blocks;
    };
    for block in curves.finest() {
        match blocks.last_mut() {
            Some(last) if part_at(&whole, last.begin_s) == part_at(&whole, block.end_s) => {
                *last = last.and(block);
            }
            _ => blocks.push(block),
        }
    }
    blocks
}

/// Returns the part of `whole` that contains the time `time_s`.
fn part_at(whole: &RecordingBin, time_s: f64) -> u64 {
    let length_s = (whole.end_s - whole.begin_s).max(f64::MIN_POSITIVE);
    (CURVE_BINS * ((time_s - whole.begin_s) / length_s)) as u64
}

#[derive(Clone)]
pub struct RunSampler {
    wanted: SampleRequest,
    scenario: Arc<Scenario>,
    stretch_end_s: f64,
    arcs: StepArcs,
    /// The azimuth at the latest step.
    azimuth: Azimuth,
    curves: Vec<Recording>,
    path: path::PathRecorder,
    above: path::PathRecorder,
    /// Computes the distance from the exact motion, if it is one of the columns.
    meter: Option<DistanceMeter>,
    end_s: f64,
    is_empty: bool,
}

impl RunSampler {
    /// Creates a sampler of the `wanted` samples of the run of `scenario`, before its start.
    pub fn new(scenario: &Arc<Scenario>, wanted: SampleRequest) -> Self {
        Self {
            arcs: StepArcs::new(scenario, &wanted),
            azimuth: Azimuth::start(&scenario.start.axle()),
            stretch_end_s: wanted.end_s(scenario),
            curves: vec![Recording::default(); wanted.columns.len().div_ceil(EXACT_TOGETHER)],
            path: path::PathRecorder::new(false),
            above: path::PathRecorder::new(false),
            meter: wanted
                .columns
                .iter()
                .any(|column| column.name == DISTANCE)
                .then(|| DistanceMeter::new(scenario)),
            end_s: 0.0,
            is_empty: true,
            scenario: Arc::clone(scenario),
            wanted,
        }
    }

    /// Creates a sampler of the exact motion, whose path is a line.
    fn of_exact_motion(scenario: &Arc<Scenario>, wanted: SampleRequest) -> Self {
        Self {
            path: path::PathRecorder::new(true),
            above: path::PathRecorder::new(true),
            ..Self::new(scenario, wanted)
        }
    }

    /// Samples `step`. Call it for the start and for every step up to the first one at or after the end of the time
    /// range. The curves also include one step before and after the range, so that they reach both edges.
    pub fn follow(&mut self, step: &Step) {
        let beyond_s = step.motion().time_step_s;
        for state in self.arcs.within(step) {
            self.azimuth.turn_to(&state.axle());
            let numbers = sample(&self.scenario, &state, &self.azimuth, step.loads());
            self.take(state.time_s, beyond_s, &numbers.position, || numbers);
        }
        self.azimuth = *step.azimuth();
        self.take(step.time_s(), beyond_s, step.position(), || step.sample());
    }

    /// Records one sample. The curves include it if it is less than `beyond_s` (s) outside the time range. `sample` is
    /// only called if its numbers are needed.
    fn take(
        &mut self,
        time_s: f64,
        beyond_s: f64,
        position: &Vector3<f64>,
        sample: impl FnOnce() -> Sample,
    ) {
        let rounding = rounding_s(self.stretch_end_s);
        let outside_s = (self.wanted.from_s - time_s).max(time_s - self.stretch_end_s);
        if outside_s > rounding && outside_s >= beyond_s - rounding {
            return;
        }
        self.end_s = time_s.min(self.stretch_end_s);
        let is_inside = outside_s <= rounding;
        self.is_empty &= !is_inside;
        if self.wanted.path && is_inside {
            self.path.push([position.x, position.y, position.z]);
            self.above.push([position.x, position.y, 0.0]);
        }
        if self.curves.is_empty() {
            return;
        }
        let mut numbers = sample();
        if let Some(meter) = &mut self.meter {
            numbers.distance_m = meter.distance_m(&numbers.state());
        }
        let columns = self.wanted.columns.chunks(EXACT_TOGETHER);
        for (together, curves) in columns.zip(&mut self.curves) {
            let mut values = [0.0; EXACT_TOGETHER];
            for (value, column) in values.iter_mut().zip(together) {
                *value = column.value(&self.scenario, &numbers);
            }
            curves.push_values(time_s, values);
        }
    }

    /// Returns the samples. `broke` tells why the run ended before the end of the time range, if it did.
    pub fn end(self, broke: Option<NotFinite>) -> SampledRun {
        SampledRun {
            wanted: self.wanted,
            curves: Arc::new(self.curves),
            path: Arc::new(self.path.end()),
            above: Arc::new(self.above.end()),
            end_s: self.end_s,
            is_empty: self.is_empty,
            broke,
            health: None,
            predictable_until_s: None,
            swing_s: None,
        }
    }
}

/// Returns the tolerance for times at the edges of a range that ends at `end_s`, s.
fn rounding_s(end_s: f64) -> f64 {
    1e-9 * end_s.abs()
}

/// Plays the run of `scenario` and returns the `wanted` samples. `watch` is called with the current and the last step.
/// Returns `None` if `watch` stopped the run.
pub fn play(
    scenario: &Arc<Scenario>,
    wanted: &SampleRequest,
    mut watch: impl FnMut(u64, u64) -> ControlFlow<()>,
) -> Option<SampledRun> {
    let mut simulation = Simulation::new(Arc::clone(scenario));
    let mut recorder = RunSampler::new(scenario, wanted.clone());
    let last = Simulation::step_at(scenario, wanted.end_s(scenario)).min(scenario.steps);
    let mut beside = ExactReference::new(scenario);
    recorder.follow(simulation.now());
    let ended = stream::play::<io::Sink>(
        &mut simulation,
        last,
        None,
        |step: &Step| {
            recorder.follow(step);
            beside.hold(step.after());
        },
        &mut watch,
    );
    let broke = match ended {
        Ok((Ended::Stopped, _)) => return None,
        Ok((Ended::NotFinite(error), _)) => Some(error),
        Ok((Ended::Done, _)) | Err(_) => None, // nothing is written that could fail
    };
    let health = Health::new(simulation.now(), &mut beside);
    Some(SampledRun {
        predictable_until_s: health.limits().until_s,
        health: Some(health),
        ..recorder.end(broke)
    })
}

/// Samples of the exact motion per shortest known period, the minimum number over the whole range, and the maximum.
const A_PERIOD: f64 = 200.0;
const LEAST_EXACT_SAMPLES: f64 = 3000.0;
const MOST_EXACT_SAMPLES: f64 = 400_000.0;
/// Fraction of a period added to a sampling interval that exceeds the period: the golden section, which always meets
/// other phases. Another fraction could repeat phases and show a slow swing that the motion does not have.
const OTHER_PHASE: f64 = 0.381_966;

/// Samples the exact motion like [`play`], also between the time steps if these are too long to show it.
pub fn exact(
    scenario: &Arc<Scenario>,
    wanted: &SampleRequest,
    mut watch: impl FnMut(u64, u64) -> ControlFlow<()>,
) -> Option<SampledRun> {
    let mut truth = Truth::new(Arc::clone(scenario));
    // The azimuth is counted from the start. All other numbers are independent of earlier times.
    let mut columns = wanted.columns.iter();
    let is_counted = columns.any(|column| column.name == "azimuth_deg");
    let begin_s = if is_counted {
        0.0
    } else {
        wanted.from_s.max(0.0)
    };
    let end_s = wanted.end_s(scenario);
    truth.state_at(begin_s);
    let closed = truth.motion().closed_form();
    let (has_formula, swing_s) = (
        closed.is_some(),
        closed.and_then(LagrangeTop::nutation_period),
    );
    let look_every = if has_formula { 1024 } else { 1 };
    let period_s = if has_formula {
        swing_s
    } else {
        turn_s(scenario)
    };
    let interval_s = apart_s(end_s - begin_s, scenario.motion.time_step_s, period_s);
    let count = ((end_s - begin_s) / interval_s)
        .ceil()
        .max(LEAST_EXACT_SAMPLES) as u64;
    let mut recorder = RunSampler::of_exact_motion(scenario, wanted.clone());
    let mut azimuth = Azimuth::start(&scenario.start.axle());
    for number in 0..=count {
        let time_s = begin_s + (end_s - begin_s) * (number as f64 / count as f64);
        let state = truth.state_at(time_s);
        if !state.is_finite() {
            break; // what comes after it is no number either
        }
        azimuth.turn_to(&state.axle());
        let numbers = sample(scenario, &state, &azimuth, truth.loads());
        recorder.take(time_s, 0.0, &numbers.position, || numbers);
        if number.is_multiple_of(look_every) && watch(number, count).is_break() {
            return None;
        }
    }
    Some(SampledRun {
        swing_s,
        predictable_until_s: if has_formula {
            None
        } else {
            predictability(scenario, end_s).until_s
        },
        ..recorder.end(None)
    })
}

/// Returns the duration of one turn of the body of `scenario` at the start, s.
fn turn_s(scenario: &Scenario) -> Option<f64> {
    let rate = observables::angular_velocity(&scenario.body.mechanics, &scenario.start).norm();
    (rate > 0.0 && rate.is_finite()).then_some(TAU / rate)
}

/// Returns the interval between samples of the exact motion, s.
fn apart_s(length_s: f64, time_step_s: f64, known_period_s: Option<f64>) -> f64 {
    let period_s = known_period_s.unwrap_or(f64::INFINITY);
    let apart_s = (period_s / A_PERIOD)
        .min(time_step_s)
        .max(length_s / MOST_EXACT_SAMPLES);
    if apart_s <= OTHER_PHASE * period_s {
        return apart_s;
    }
    ((apart_s / period_s - OTHER_PHASE).floor() + OTHER_PHASE) * period_s
}

fn sample(scenario: &Scenario, state: &State, azimuth: &Azimuth, loads: &Loads) -> Sample {
    let body = &scenario.body.mechanics;
    let weight = loads.gravity * observables::weight_height(body, state);
    Sample {
        step: 0,
        time_s: state.time_s,
        orientation: state.orientation,
        position: observables::position(body, state, scenario.trace),
        momentum: state.momentum,
        angular_velocity: observables::angular_velocity(body, state),
        tilt_deg: observables::tilt_deg(state),
        azimuth_deg: azimuth.degrees(),
        energy: observables::kinetic_energy(body, state) + weight,
        foot_force: observables::pivot_force_z(body, state, loads),
        rotor_turn: 0.0, // no curve shows it
        segment: 0,
        distance_m: None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::engine::scenario::Document;

    /// Returns a time range of `scenario`, and the points of its z curve.
    fn of_z(
        scenario: &Arc<Scenario>,
        from_s: f64,
        to_s: Option<f64>,
    ) -> (SampledRun, Vec<[f64; 2]>) {
        let column = CsvColumn::find("z_m").unwrap();
        let wanted = SampleRequest {
            columns: vec![column],
            path: to_s.is_some(),
            from_s,
            to_s,
        };
        let course = play(scenario, &wanted, |_, _| ControlFlow::Continue(())).unwrap();
        let points = course.points(column);
        (course, points)
    }

    #[test]
    fn a_curve_reaches_both_ends_of_its_time_range() {
        // Its time step is 0.1 s.
        let scenario = Document::open("wobble-push").unwrap().scenario().unwrap();
        let scenario = Arc::new(scenario);
        for (from_s, to_s, times, places) in [
            (20.05, 20.25, vec![20.0, 20.1, 20.2, 20.3], 2),
            // No step lies in the range.
            (20.02, 20.08, vec![20.0, 20.1], 0),
            // Both ends are at steps: nothing more is needed.
            (20.0, 20.2, vec![20.0, 20.1, 20.2], 3),
            (0.0, 0.15, vec![0.0, 0.1, 0.2], 2),
        ] {
            let (course, points) = of_z(&scenario, from_s, Some(to_s));
            let rounded = points.iter().map(|at| (at[0] * 1e6).round() / 1e6);
            assert_eq!(rounded.collect::<Vec<_>>(), times);
            assert_eq!((course.path.points.len(), course.end_s), (places, to_s));
            assert_eq!(course.is_empty, course.path.points.is_empty());
        }
    }

    #[test]
    fn no_extreme_of_a_long_run_is_lost() {
        let mut document = Document::open("wobble-push").unwrap();
        document.set("motion.steps=50000").unwrap();
        let scenario = Arc::new(document.scenario().unwrap());
        let (_, points) = of_z(&scenario, 0.0, None);
        assert!(points.windows(2).all(|pair| pair[0][0] <= pair[1][0]));
        let mut run = Simulation::new(Arc::clone(&scenario));
        // Each fiftieth of the run has its extremes among the nearby points.
        for fiftieth in 0..50 {
            let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
            let begin_s = run.now().time_s();
            for _ in 0..1000 {
                let z = run.step().unwrap().position().z;
                (low, high) = (low.min(z), high.max(z));
            }
            let end_s = run.now().time_s();
            for extreme in [low, high] {
                let mut near = points
                    .iter()
                    .filter(|point| (begin_s - 2.0..=end_s + 2.0).contains(&point[0]));
                assert!(near.any(|point| point[1] == extreme), "{fiftieth}");
            }
        }
    }
}
