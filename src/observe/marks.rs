//! The times at which pushes act on a run, and at which it was edited.

use crate::run::Clock;
use crate::run::pushes::acts_s;
use crate::scenario::{Push, Scenario};

#[derive(Clone, Debug, Default, PartialEq)]
pub struct Marks {
    /// Beginning and end of each interval in which at least one push acts, s. Intervals do not touch; the last end may be
    /// infinite.
    pub pushes: Vec<(f64, f64)>,
    pub edits: Vec<f64>,
}

impl Marks {
    pub fn of(scenario: &Scenario) -> Self {
        let mut edits = Vec::new();
        let mut stretches = Vec::new();
        let (mut begin_s, mut pushes) = (0.0, &scenario.pushes);
        for (time_s, edit) in Clock::edits(scenario) {
            if edits.last() != Some(&time_s) {
                edits.push(time_s);
            }
            if !edit.set_pushes.is_empty() {
                let acting = pushes.iter();
                stretches.extend(acting.filter_map(|push| acts(push, scenario, begin_s, time_s)));
                (begin_s, pushes) = (time_s, &edit.pushes);
            }
        }
        let last = pushes.iter();
        stretches.extend(last.filter_map(|push| acts(push, scenario, begin_s, f64::INFINITY)));
        Self {
            pushes: joined(stretches),
            edits,
        }
    }
}

/// When `push` acts between two times, s.
fn acts(push: &Push, scenario: &Scenario, from_s: f64, to_s: f64) -> Option<(f64, f64)> {
    let (begin, end) = acts_s(push, scenario);
    let (begin, end) = (begin.max(from_s), end.min(to_s));
    (begin < end && push.force.norm() > 0.0).then_some((begin, end))
}

fn joined(mut stretches: Vec<(f64, f64)>) -> Vec<(f64, f64)> {
    stretches.sort_by(|a, b| a.0.total_cmp(&b.0));
    let mut joined: Vec<(f64, f64)> = Vec::with_capacity(stretches.len());
    for (begin, end) in stretches {
        match joined.last_mut() {
            Some(last) if begin <= last.1 => last.1 = last.1.max(end),
            _ => joined.push((begin, end)),
        }
    }
    joined
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scenario::Document;

    fn marks(preset: &str, more: &str) -> Marks {
        let text = crate::scenario::presets::find(preset).unwrap().text;
        let text = format!("{text}\n{more}");
        let document = Document::parse("marks.toml", &text).unwrap();
        Marks::of(&document.scenario().unwrap())
    }

    fn near(stretch: (f64, f64), begin: f64, end: f64) -> bool {
        (stretch.0 - begin).abs() < 1e-9 && (stretch.1 - end).abs() < 1e-9
    }

    #[test]
    fn a_push_of_steps_has_the_seconds_of_its_steps() {
        let marks = marks("wobble-push", "");
        assert_eq!(marks.pushes.len(), 1);
        assert!(near(marks.pushes[0], 0.0, 20.0), "{marks:?}");
        assert!(marks.edits.is_empty());
    }

    #[test]
    fn an_accumulating_push_does_not_end() {
        let marks = marks("wobble-push-accumulating", "");
        assert_eq!(marks.pushes, [(0.0, f64::INFINITY)]);
    }

    #[test]
    fn pushes_keep_their_seconds_over_an_edit_of_the_time_step() {
        // Step 40 is at 4 s; from there on a step is 0.05 s long.
        let edits = "[[edit]]\nstep = 40\nset = { 'motion.time_step_s' = 0.05 }\n\
                     [[edit]]\nstep = 60\nset = { 'motion.gravity_m_per_s2' = 9 }";
        let marks = marks("wobble-push", edits);
        assert_eq!(marks.pushes.len(), 1);
        assert!(near(marks.pushes[0], 0.0, 20.0), "{marks:?}");
        assert_eq!(marks.edits, [4.0, 5.0]);
    }

    #[test]
    fn an_edit_of_a_push_acts_from_its_step_on() {
        // Taken away at 5 s; another one at 6 to 8 s.
        let edits = "[[edit]]\nstep = 50\nset = { 'push.0.force_N' = [0, 0, 0] }\n\
                     [[edit]]\nstep = 55\nset = { 'push.0' = \
                     { point = 'top', force_N = [1, 0, 0], from_s = 6, for_s = 2 } }";
        let marks = marks("wobble-push", edits);
        assert_eq!(marks.pushes.len(), 2);
        assert!(near(marks.pushes[0], 0.0, 5.0), "{marks:?}");
        assert!(near(marks.pushes[1], 6.0, 8.0), "{marks:?}");
        assert_eq!(marks.edits, [5.0, 5.5]);
    }
}
