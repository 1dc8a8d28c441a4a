//! Makes new runs from a run: one that starts from its present state, with the settings and pushes in force there, and
//! one from its start, with other values throughout.

use crate::physics::{State, rotation};
use crate::run::Clock;
use crate::scenario::dotted::number_of_push;
use crate::scenario::file::{EditFile, MotionFile, PushFile, ScenarioFile, StartFile};
use crate::scenario::problem::{Problem, Problems};
use crate::scenario::rescale::{MOST_RUN_STEPS_BY_TIME, at_time_step};
use crate::scenario::{Document, Motion, Push, Pushes, Scenario, Window, float};
use crate::text::number;
use nalgebra::{Matrix3, Vector3};
use toml::{Table, Value};

const RERUN: &str = "the run from its start";
pub const TIME_STEP: &str = "motion.time_step_s";
pub const SCHEME: &str = "motion.scheme";
/// Keys that make a push count in steps.
const COUNTED: [&str; 3] = ["first_step", "steps", "accumulates"];
/// Fraction of a time step. A push with less than this remaining is over, because the rest is rounding.
const PUSH_END_ROUNDING: f64 = 1e-9;

/// Returns the scenario that starts with `state`, the state of the run of `scenario` at `step`.
///
/// It has the settings and pushes in force at `step`, including edits made at `step` itself. Times are counted from the
/// new start. A push that is over is omitted, one in progress is shortened, and a later one is moved. Moved pushes have
/// their times in seconds.
pub fn scenario_from(scenario: &Scenario, state: &State, step: u64) -> Result<Scenario, Problems> {
    let origin = "the scenario from here";
    let (motion, pushes) = in_force(scenario, step);
    let now = RestartPoint {
        scenario,
        state,
        step,
        motion: &motion,
    };
    let numbered = pushes.iter().enumerate();
    let push: Result<_, _> = numbered
        .filter_map(|(index, push)| now.push(index, push).transpose())
        .collect();
    let old = &scenario.file;
    let time_s = number::significant(state.time_s, 7);
    let speed = old.viewed("speed").cloned();
    let file = ScenarioFile {
        title: format!("{}, from t = {time_s} s", old.title),
        trace: old.trace.clone(),
        body: old.body.clone(),
        start: StartFile {
            rotor: old.start.rotor.clone(),
            ..start(state)
        },
        motion: MotionFile {
            gravity_m_per_s2: Some(motion.gravity),
            scheme: Some(motion.scheme.name.to_owned()),
            time_step_s: motion.time_step_s,
            steps: steps_of_same_length(scenario, &motion),
        },
        push: push.map_err(|problem| Problems::one(origin, problem))?,
        friction: old.friction,
        view: speed.map(|speed| Table::from_iter([("speed".to_owned(), speed)]).into()),
        ..ScenarioFile::default()
    };
    Document::from_file(origin, &file)?.scenario()
}

/// Returns the number of steps that makes the new run as long, in seconds, as the run of `scenario`.
fn steps_of_same_length(scenario: &Scenario, motion: &Motion) -> u64 {
    if motion.time_step_s == scenario.motion.time_step_s {
        return scenario.steps;
    }
    let length_s = scenario.steps as f64 * scenario.motion.time_step_s;
    let steps = (length_s / motion.time_step_s).round();
    steps.clamp(1.0, MOST_RUN_STEPS_BY_TIME) as u64
}

/// Returns gravity, scheme, time step and pushes in force for the step after `step`.
pub fn in_force(scenario: &Scenario, step: u64) -> (Motion, &Pushes) {
    let made = scenario.edits.partition_point(|edit| edit.step <= step);
    let last = scenario.edits[..made].last();
    last.map_or((scenario.motion, &scenario.pushes), |edit| {
        (edit.motion, &edit.pushes)
    })
}

fn start(state: &State) -> StartFile {
    let [tilt, turn, roll] = angles_deg(&state.orientation);
    StartFile {
        tilt_deg: Some(tilt),
        turn_deg: Some(turn),
        roll_deg: Some(roll),
        momentum_Js: Some(state.momentum.into()),
        ..StartFile::default()
    }
}

/// Returns tilt, turn and roll, degrees, of `orientation` = Rz(turn) Rx(tilt) Rz(roll).
///
/// Near the vertical, only the sum (or difference) of turn and roll is well determined. Roll is therefore computed from
/// the rotation that remains after tilt and turn, so that the three angles restore the orientation.
fn angles_deg(orientation: &Matrix3<f64>) -> [f64; 3] {
    let axle = orientation.column(2);
    let tilt = libm::atan2(libm::hypot(axle.x, axle.y), axle.z);
    let turn = if axle.x == 0.0 && axle.y == 0.0 {
        0.0
    } else {
        libm::atan2(axle.x, -axle.y)
    };
    let upright = rotation::about(&Vector3::z(), turn) * rotation::about(&Vector3::x(), tilt);
    let rolled = upright.tr_mul(orientation);
    let roll = libm::atan2(rolled[(1, 0)], rolled[(0, 0)]);
    [tilt, turn, roll].map(f64::to_degrees)
}

/// Moment at which the new scenario starts.
struct RestartPoint<'a> {
    scenario: &'a Scenario,
    state: &'a State,
    step: u64,
    motion: &'a Motion,
}

impl RestartPoint<'_> {
    /// Returns the remainder of `push`, number `index` of the run, from now on. `None` if it is over.
    fn push(&self, index: usize, push: &Push) -> Result<Option<PushFile>, Problem> {
        let file = PushFile {
            point: self.scenario.point_name(push.point).unwrap_or_default(),
            force_N: push.force.into(),
            accumulates: push.accumulates.then_some(true),
            ..PushFile::default()
        };
        // With the old start and time step, a step has the same number in both scenarios.
        let keeps_numbers = self.step == 0 && self.counts_steps();
        match push.window {
            Window::Steps { first, count } if push.accumulates || keeps_numbers => {
                let first = self.first_step(first, push.accumulates).map_err(|rule| {
                    let rule = format!("on \"{}\" {rule}", file.point);
                    Problem::at(format!("push.{index}"), rule)
                })?;
                Ok(Some(PushFile {
                    first_step: Some(first),
                    steps: Some(count),
                    ..file
                }))
            }
            window => Ok(self.seconds(window).map(|(from_s, for_s)| PushFile {
                from_s: Some(from_s),
                for_s: Some(for_s),
                ..file
            })),
        }
    }

    /// Returns true if the time step is still the one that the pushes' step numbers were written for.
    fn counts_steps(&self) -> bool {
        let mut edits = self.scenario.edits.iter();
        let is_edited = edits.any(|edit| edit.step <= self.step && edit.sets_time_step);
        !is_edited && self.scenario.written_for_s == self.motion.time_step_s
    }

    /// Returns the first step, counted from now, of a push that keeps its times in steps.
    fn first_step(&self, first: u64, accumulates: bool) -> Result<u64, &'static str> {
        match first.checked_sub(self.step).filter(|&first| first > 0) {
            _ if accumulates && !self.counts_steps() => Err(
                "accumulates in steps of a different length, and cannot be moved to a new start: remove the push first",
            ),
            None => Err(
                "accumulates and has begun, so it cannot be moved to a new start: go back to a time before it, or remove the push first",
            ),
            Some(first) => Ok(first),
        }
    }

    /// Returns the start of the remainder of `window`, counted from now, and its duration, both in s. `None` if it is
    /// over.
    fn seconds(&self, window: Window) -> Option<(f64, f64)> {
        let dt = self.scenario.written_for_s;
        let now_s = self.state.time_s;
        let [from, to] = match window {
            Window::Time { from_s, for_s } => [from_s - now_s, from_s + for_s - now_s],
            Window::Steps { first, count } => {
                let begin = first as f64 - 1.0;
                [begin, begin + count as f64].map(|steps| {
                    if self.counts_steps() {
                        // The difference of whole numbers is exact, so it is multiplied afterwards.
                        (steps - self.step as f64) * dt
                    } else {
                        steps * dt - now_s
                    }
                })
            }
        };
        let begin = from.max(0.0);
        (to - begin > PUSH_END_ROUNDING * self.motion.time_step_s).then_some((begin, to - begin))
    }
}

/// Returns the run of `scenario` from its start with the values of `set` (dotted keys) throughout. Its edits of these
/// keys are omitted. Its other edits, its pushes and its end `end_s` (s) stay at the same times.
pub fn rerun_with(scenario: &Scenario, set: &Table, end_s: f64) -> Result<Scenario, Problems> {
    let refused = |problem| Problems::one(RERUN, problem);
    let mut file = scenario.file.clone();
    let edits = std::mem::take(&mut file.edit);
    let typed = set.get(TIME_STEP).and_then(float);
    let time_step_s = typed.unwrap_or(file.motion.time_step_s);
    let is_other = time_step_s != file.motion.time_step_s;
    if is_other {
        file = at_time_step(&file, time_step_s).map_err(refused)?;
    }
    if typed.is_some() {
        file.motion.steps = (end_s / time_step_s)
            .round()
            .clamp(1.0, MOST_RUN_STEPS_BY_TIME) as u64;
    }
    for ((time_s, _), edit) in Clock::edits(scenario).zip(edits) {
        let mut kept = edit.set;
        kept.retain(|key, _| !set.keys().any(|new| is_inside(key, new)));
        let counted = kept.iter().find(|(key, value)| counts(key, value));
        if let Some((key, _)) = counted.filter(|_| is_other) {
            let rule = "is counted in steps, whose length changes with the time step";
            return Err(refused(Problem::at(key.clone(), rule)));
        }
        if !kept.is_empty() {
            let step = match typed {
                Some(_) => (time_s / time_step_s).round() as u64,
                None => edit.step,
            };
            file.edit.push(EditFile { step, set: kept });
        }
    }
    let mut document = Document::from_file(RERUN, &file)?;
    for (key, value) in set {
        document.write(key, value.clone())?;
    }
    document.scenario()
}

/// Returns true if the dotted `key` is `whole` or a part of it.
fn is_inside(key: &str, whole: &str) -> bool {
    let rest = key.strip_prefix(whole);
    rest.is_some_and(|rest| rest.is_empty() || rest.starts_with('.'))
}

/// Describes which of time step and scheme the edits of `scenario` change. `None` if there are no such edits.
pub fn edited_motion(scenario: &Scenario) -> Option<&'static str> {
    let edits = &scenario.file.edit;
    match [TIME_STEP, SCHEME].map(|key| edits.iter().any(|edit| edit.set.contains_key(key))) {
        [true, true] => Some("the edits of dt and scheme"),
        [true, false] => Some("the edits of dt"),
        [false, true] => Some("the edits of the scheme"),
        [false, false] => None,
    }
}

/// Returns true if `value`, set at `key`, makes a push count in steps.
fn counts(key: &str, value: &Value) -> bool {
    let last = key.rsplit('.').next().unwrap_or_default();
    let mut inside = value.as_table().into_iter().flat_map(Table::keys);
    number_of_push(key).is_some()
        && (COUNTED.contains(&last) || inside.any(|name| COUNTED.contains(&name.as_str())))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn run(edits: &str) -> Scenario {
        let text = crate::scenario::presets::find("wobble-push").map(|preset| preset.text);
        let text = format!("{}{edits}", text.unwrap());
        let document = Document::parse("x.toml", &text).unwrap();
        document.scenario().unwrap()
    }

    fn one(key: &str, value: impl Into<Value>) -> Table {
        Table::from_iter([(key.to_owned(), value.into())])
    }

    #[test]
    fn a_rerun_keeps_edit_times_and_drops_edits_of_the_time_step() {
        let run = run(
            "\n[[edit]]\nstep = 40\nset = { 'motion.time_step_s' = 0.05 }\n\
             [[edit]]\nstep = 60\nset = { 'motion.scheme' = 'rk4', 'motion.gravity_m_per_s2' = 1 }\n",
        );
        let step_s = run.motion.time_step_s;
        let other = rerun_with(&run, &one(TIME_STEP, 0.1 * step_s), 30.0).unwrap();
        let edit = &other.file.edit[..];
        assert_eq!(edit.len(), 1);
        let time_s = 40.0 * step_s + 20.0 * 0.05;
        assert_eq!(edit[0].step, (time_s / (0.1 * step_s)).round() as u64);
        assert_eq!(other.motion.scheme.name, run.motion.scheme.name);
        assert_eq!(other.edits[0].motion.gravity, 1.0);
        assert!((Clock::end_s(&other) - 30.0).abs() < 1e-9);
        assert_eq!(edited_motion(&run), Some("the edits of dt and scheme"));
        assert_eq!(edited_motion(&other), Some("the edits of the scheme"));
    }

    #[test]
    fn a_rerun_with_another_gravity_keeps_other_edits() {
        let run = run(
            "\n[[edit]]\nstep = 40\nset = { 'motion.time_step_s' = 0.05, 'motion.gravity_m_per_s2' = 3 }\n\
             [[edit]]\nstep = 60\nset = { 'motion.gravity_m_per_s2' = 1 }\n",
        );
        let other = rerun_with(&run, &one("motion.gravity_m_per_s2", 5.0), 30.0).unwrap();
        assert_eq!(other.motion.gravity, 5.0);
        assert_eq!(other.file.edit.len(), 1);
        assert_eq!(
            (other.edits[0].step, other.edits[0].motion.time_step_s),
            (40, 0.05)
        );
        assert_eq!(other.steps, run.steps);
    }

    #[test]
    fn a_rerun_with_another_time_step_rejects_step_counts() {
        let run = run("\n[[edit]]\nstep = 40\nset = { 'push.0.steps' = 7 }\n");
        let own = run.motion.time_step_s;
        assert!(rerun_with(&run, &one(TIME_STEP, 0.5 * own), 30.0).is_err());
        assert!(rerun_with(&run, &one(SCHEME, "strang"), 30.0).is_ok());
    }
}
