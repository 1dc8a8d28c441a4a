//! The numbers of a figure, from a run that is stepped through: once more, or while something else is read off it.

use super::kind::Plotted;
use super::over_time::OverTime;
use super::path::{self, Path};
use crate::analysis::{Beside, Health};
use crate::export::stream::{self, Ended};
use crate::physics::State;
use crate::physics::exact::LagrangeTop;
use crate::physics::observables::{self, Azimuth};
use crate::run::{Clock, NotFinite, Sample, Simulation, Step, Truth};
use crate::scenario::Scenario;
use nalgebra::Vector3;
use std::io;
use std::ops::ControlFlow;
use std::sync::Arc;

/// What is asked of a run.
#[derive(Clone, Debug)]
pub struct Wanted {
    /// The curves over time.
    pub columns: Vec<Plotted>,
    /// Whether the path of the traced point is wanted.
    pub path: bool,
    /// The begin of the stretch of time, s.
    pub from_s: f64,
    /// Its end, s; `None`: the end of the run.
    pub to_s: Option<f64>,
}

/// What a run gave.
#[derive(Clone, Debug)]
pub struct Course {
    /// A curve for each column.
    pub curves: Vec<OverTime>,
    /// The path of the traced point in space.
    pub path: Arc<Path>,
    /// The same from above, of which z is 0: a path that goes up and down in one place is not interrupted there.
    pub above: Arc<Path>,
    /// The last time of the stretch that it reached, s.
    pub end_s: f64,
    /// Whether no moment lay in the stretch.
    pub is_empty: bool,
    /// Where its numbers stopped being finite, if they did.
    pub broke: Option<NotFinite>,
    /// How it stands beside the exact motion at its last step; `None` where it was not held against that.
    pub health: Option<Health>,
}

impl Wanted {
    /// The end of the stretch of a run of `scenario`, s.
    pub fn end_s(&self, scenario: &Scenario) -> f64 {
        let end_s = Clock::end_s(scenario);
        self.to_s.map_or(end_s, |to_s| to_s.min(end_s))
    }
}

/// Writes down what is asked for, step by step.
#[derive(Clone, Debug)]
pub struct Recorder {
    wanted: Wanted,
    scenario: Arc<Scenario>,
    stretch_end_s: f64,
    curves: Vec<OverTime>,
    path: path::Recorder,
    above: path::Recorder,
    end_s: f64,
    is_empty: bool,
}

impl Recorder {
    /// A recorder of what is `wanted` of the run of `scenario`, before its start.
    pub fn new(scenario: &Arc<Scenario>, wanted: Wanted) -> Self {
        Self::of_moments(scenario, wanted, scenario.least_time_step_s(), false)
    }

    /// The same of moments that are about `apart_s` apart, s; `is_exact` says whether of the exact motion, whose path is a line.
    fn of_moments(scenario: &Arc<Scenario>, wanted: Wanted, apart_s: f64, is_exact: bool) -> Self {
        Self {
            stretch_end_s: wanted.end_s(scenario),
            curves: vec![OverTime::new(apart_s); wanted.columns.len()],
            path: path::Recorder::new(is_exact),
            above: path::Recorder::new(is_exact),
            end_s: 0.0,
            is_empty: true,
            scenario: Arc::clone(scenario),
            wanted,
        }
    }

    /// Takes in `step`; to be shown the start and every step up to the first one at the end of the stretch or behind it. The
    /// curves have that one too, and the last one before the stretch, so that they come from one edge and go on to the other.
    pub fn follow(&mut self, step: &Step) {
        let beyond_s = step.motion().time_step_s;
        self.take(step.time_s(), beyond_s, step.position(), || step.sample());
    }

    /// Takes the numbers of one moment, those of the curves if it is less than `beyond_s` (s) outside of the stretch; `sample`
    /// is asked for them where they are needed.
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
        if self.wanted.columns.is_empty() {
            return;
        }
        let sample = sample();
        for (column, curve) in self.wanted.columns.iter().zip(&mut self.curves) {
            curve.push(time_s, column.value(&self.scenario, &sample));
        }
    }

    /// What was written down; `broke` says why the run ended before the stretch, where it did.
    pub fn end(self, broke: Option<NotFinite>) -> Recorded {
        Recorded {
            course: Course {
                curves: self.curves,
                path: Arc::new(self.path.end()),
                above: Arc::new(self.above.end()),
                end_s: self.end_s,
                is_empty: self.is_empty,
                broke,
                health: None,
            },
            wanted: self.wanted,
        }
    }
}

/// What was written down of a run, and what that is.
#[derive(Clone, Debug)]
pub struct Recorded {
    wanted: Wanted,
    course: Course,
}

impl Recorded {
    /// What is `wanted` of the run, which is of `scenario`, where all of it was written down.
    pub(super) fn part(&self, scenario: &Scenario, wanted: &Wanted) -> Option<Course> {
        let end_s = wanted.end_s(scenario);
        let is_all = self.wanted.from_s == wanted.from_s
            && self.course.end_s <= end_s + rounding_s(end_s)
            && end_s <= self.wanted.end_s(scenario)
            && (self.wanted.path || !wanted.path);
        let curve = |column: &Plotted| {
            let columns = &self.wanted.columns;
            let place = columns.iter().position(|it| it.name() == column.name())?;
            Some(self.course.curves[place].clone())
        };
        let curves = wanted.columns.iter().map(curve).collect::<Option<_>>()?;
        let if_path = |path: &Arc<Path>| {
            if wanted.path {
                Arc::clone(path)
            } else {
                Arc::default()
            }
        };
        is_all.then(|| Course {
            curves,
            path: if_path(&self.course.path),
            above: if_path(&self.course.above),
            end_s: self.course.end_s.min(end_s),
            is_empty: self.course.is_empty,
            broke: self.course.broke,
            health: self.course.health,
        })
    }
}

/// Times that are so near to the ends of a stretch up to `end_s` belong to it, s.
fn rounding_s(end_s: f64) -> f64 {
    1e-9 * end_s.abs()
}

/// Steps through the run of `scenario` and gives what is `wanted` of it. `watch` is told the step reached and the last one, and
/// says whether to go on; `None` where it said no.
pub fn play(
    scenario: &Arc<Scenario>,
    wanted: &Wanted,
    mut watch: impl FnMut(u64, u64) -> ControlFlow<()>,
) -> Option<Course> {
    let mut simulation = Simulation::new(Arc::clone(scenario));
    let mut recorder = Recorder::new(scenario, wanted.clone());
    let last = Simulation::step_at(scenario, wanted.end_s(scenario)).min(scenario.steps);
    let mut beside = Beside::new(scenario);
    recorder.follow(simulation.now());
    let each = |step: &Step| {
        recorder.follow(step);
        beside.hold(step.after());
    };
    let ended = stream::play::<io::Sink>(&mut simulation, last, None, each, |step, last| {
        watch(step, last)
    });
    let broke = match ended {
        Ok((Ended::Stopped, _)) => return None,
        Ok((Ended::NotFinite(error), _)) => Some(error),
        Ok((Ended::Done, _)) | Err(_) => None, // nothing is written that could fail
    };
    Some(Course {
        health: Some(Health::new(simulation.now(), &mut beside)),
        ..recorder.end(broke).course
    })
}

/// Moments of the exact motion within the shortest of its periods that is known, and at least over the whole stretch; and at
/// most, whatever the periods are.
const A_PERIOD: f64 = 32.0;
const LEAST: f64 = 3000.0;
const MOST: f64 = 400_000.0;

/// As [`play`], of the exact motion beside the run: between the time steps too, where these are too long to show it.
pub fn exact(
    scenario: &Arc<Scenario>,
    wanted: &Wanted,
    mut watch: impl FnMut(u64, u64) -> ControlFlow<()>,
) -> Option<Course> {
    let mut truth = Truth::new(Arc::clone(scenario));
    // The azimuth is counted on from the start, and nothing else needs what came before.
    let is_counted = wanted
        .columns
        .iter()
        .any(|column| column.name() == "azimuth_deg");
    let begin_s = if is_counted {
        0.0
    } else {
        wanted.from_s.max(0.0)
    };
    let end_s = wanted.end_s(scenario);
    truth.state_at(begin_s);
    let period_s = truth
        .motion()
        .closed_form()
        .and_then(LagrangeTop::nutation_period);
    let fine_s = period_s.map_or(f64::INFINITY, |period_s| period_s / A_PERIOD);
    let apart_s = fine_s.min(scenario.motion.time_step_s);
    let count = ((end_s - begin_s) / apart_s).ceil().clamp(LEAST, MOST) as u64;
    let apart_s = (end_s - begin_s) / count as f64;
    let mut recorder = Recorder::of_moments(scenario, wanted.clone(), apart_s, true);
    let mut azimuth = Azimuth::start(&scenario.start.axle());
    for number in 0..=count {
        let time_s = begin_s + (end_s - begin_s) * (number as f64 / count as f64);
        let state = truth.state_at(time_s);
        if !state.is_finite() {
            break; // what comes after it is no number either
        }
        azimuth.follow(&state.axle());
        let sample = sample(scenario, &state, &azimuth, truth.loads().gravity);
        recorder.take(time_s, 0.0, &sample.position, || sample);
        if number.is_multiple_of(1024) && watch(number, count).is_break() {
            return None;
        }
    }
    Some(recorder.end(None).course)
}

fn sample(scenario: &Scenario, state: &State, azimuth: &Azimuth, gravity: f64) -> Sample {
    let body = &scenario.body.mechanics;
    let weight = gravity * observables::weight_height(body, state);
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
        rotor_turn: 0.0, // no curve shows it
        segment: 0,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scenario::Document;

    /// Of wobble-push (steps of 0.1 s) in a stretch: the times of the curve, the number of places of the path, and the end
    /// that was reached.
    fn played(from_s: f64, to_s: f64) -> (Vec<f64>, usize, f64) {
        let scenario = Document::open("wobble-push").unwrap().scenario().unwrap();
        let wanted = Wanted {
            columns: vec![Plotted::find("z_m").unwrap()],
            path: true,
            from_s,
            to_s: Some(to_s),
        };
        let course = play(&Arc::new(scenario), &wanted, |_, _| {
            ControlFlow::Continue(())
        });
        let course = course.unwrap();
        let points = course.curves[0].points();
        let times = points
            .iter()
            .map(|point| (point[0] * 1e6).round() / 1e6)
            .collect();
        assert_eq!(course.is_empty, course.path.points.is_empty());
        (times, course.path.points.len(), course.end_s)
    }

    #[test]
    fn a_curve_reaches_both_ends_of_its_stretch() {
        assert_eq!(
            played(20.05, 20.25),
            (vec![20.0, 20.1, 20.2, 20.3], 2, 20.25)
        );
        // No step lies between them.
        assert_eq!(played(20.02, 20.08), (vec![20.0, 20.1], 0, 20.08));
        // They are at steps: nothing more is needed.
        assert_eq!(played(20.0, 20.2), (vec![20.0, 20.1, 20.2], 3, 20.2));
        assert_eq!(played(0.0, 0.15), (vec![0.0, 0.1, 0.2], 2, 0.15));
    }
}
