//! The run that follows an advice: the same run from its start, with another time step or scheme throughout.

use crate::run::Clock;
use crate::scenario::dotted::number_of_push;
use crate::scenario::file::EditFile;
use crate::scenario::rescale::{MOST_STEPS, at_time_step};
use crate::scenario::{Document, Problem, Problems, Scenario};
use toml::{Table, Value};

const ORIGIN: &str = "the run as advised";
/// The keys of an edit that another time step or scheme throughout replaces.
const REPLACED: [&str; 2] = ["motion.time_step_s", "motion.scheme"];
/// The keys of a push that count in steps.
const COUNTED: [&str; 3] = ["first_step", "steps", "accumulates"];

/// The run of `scenario` with the time step `time_step_s` (s) and, where one is named, `scheme` throughout. It has the
/// pushes and the edits of gravity and pushes at the same times, and no edits of time step and scheme. It ends at
/// `end_s` (s).
///
/// # Errors
/// Where steps have a meaning that seconds cannot hold: a push that accumulates, or an edit that counts in steps.
pub fn mended(
    scenario: &Scenario,
    time_step_s: f64,
    scheme: Option<&str>,
    end_s: f64,
) -> Result<Scenario, Problems> {
    let refused = |problem| Problems::one(ORIGIN.to_owned(), problem);
    let mut file = scenario.file.clone();
    let edits = std::mem::take(&mut file.edit);
    let is_other = time_step_s != file.motion.time_step_s;
    if is_other {
        file = at_time_step(&file, time_step_s).map_err(refused)?;
    }
    if let Some(scheme) = scheme {
        file.motion.scheme = Some(scheme.to_owned());
    }
    file.motion.steps = (end_s / time_step_s).round().clamp(1.0, MOST_STEPS) as u64;
    for ((time_s, _), edit) in Clock::edits(scenario).zip(edits) {
        let mut set = edit.set;
        set.retain(|key, _| !REPLACED.contains(&key));
        let counted = set.iter().find(|(key, value)| counts(key, value));
        if let Some((key, _)) = counted.filter(|_| is_other) {
            let rule = "is counted in steps, which are others at another time step";
            return Err(refused(Problem::at(key.clone(), rule)));
        }
        if !set.is_empty() {
            let step = (time_s / time_step_s).round() as u64;
            file.edit.push(EditFile { step, set });
        }
    }
    Document::from_file(ORIGIN, &file)?.scenario()
}

/// The edits of `scenario` that a run as advised leaves out, in words: time step, scheme or both. `None` where it has
/// none.
pub fn replaced(scenario: &Scenario) -> Option<&'static str> {
    let edits = |key: &str| (scenario.file.edit.iter()).any(|edit| edit.set.contains_key(key));
    match REPLACED.map(edits) {
        [true, true] => Some("the edits of dt and scheme"),
        [true, false] => Some("the edits of dt"),
        [false, true] => Some("the edits of the scheme"),
        [false, false] => None,
    }
}

/// Whether `value`, set at `key`, makes a push count in steps.
fn counts(key: &str, value: &Value) -> bool {
    let is_counted = |name: &str| COUNTED.contains(&name);
    let last = key.rsplit('.').next().unwrap_or_default();
    let inside = value.as_table().into_iter().flat_map(Table::keys);
    number_of_push(key).is_some()
        && (is_counted(last) || inside.into_iter().any(|name| is_counted(name)))
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

    #[test]
    fn edits_keep_their_seconds_and_those_of_the_time_step_go() {
        let run = run(
            "\n[[edit]]\nstep = 40\nset = { 'motion.time_step_s' = 0.05 }\n\
             [[edit]]\nstep = 60\nset = { 'motion.scheme' = 'rk4', 'motion.gravity_m_per_s2' = 1 }\n",
        );
        let step_s = run.motion.time_step_s;
        let other = mended(&run, 0.1 * step_s, None, 30.0).unwrap();
        let edit = &other.file.edit[..];
        assert_eq!(edit.len(), 1);
        let time_s = 40.0 * step_s + 20.0 * 0.05;
        assert_eq!(edit[0].step, (time_s / (0.1 * step_s)).round() as u64);
        assert_eq!(other.motion.scheme.name, run.motion.scheme.name);
        assert_eq!(other.edits[0].motion.gravity, 1.0);
        assert!((Clock::end_s(&other) - 30.0).abs() < 1e-9);
        assert_eq!(replaced(&run), Some("the edits of dt and scheme"));
        assert_eq!(replaced(&other), None);
    }

    #[test]
    fn what_is_counted_in_steps_is_refused() {
        let run = run("\n[[edit]]\nstep = 40\nset = { 'push.0.steps' = 7 }\n");
        let own = run.motion.time_step_s;
        assert!(mended(&run, 0.5 * own, None, 30.0).is_err());
        assert!(mended(&run, own, Some("strang"), 30.0).is_ok());
    }
}
