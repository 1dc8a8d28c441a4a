//! Times at which pushes act on a run, and at which it was edited.

use super::Clock;
use super::pushes::acts_s;
use crate::scenario::{Push, Scenario};

#[derive(Clone, Debug, Default, PartialEq)]
pub struct Marks {
    /// Start and end of each interval in which at least one push acts, s. Intervals do not touch. The last end may be
    /// infinite.
    pub pushes: Vec<(f64, f64)>,
    pub edits: Vec<f64>,
}

impl Marks {
    pub fn new(scenario: &Scenario) -> Self {
        let mut edits = Vec::new();
        let mut intervals = Vec::new();
        let (mut begin_s, mut pushes) = (0.0, &scenario.pushes);
        for (time_s, edit) in Clock::edits(scenario) {
            if edits.last() != Some(&time_s) {
                edits.push(time_s);
            }
            if !edit.set_pushes.is_empty() {
                let acting = pushes.iter();
                intervals.extend(acting.filter_map(|push| acts(push, scenario, begin_s, time_s)));
                (begin_s, pushes) = (time_s, &edit.pushes);
            }
        }
        let last = pushes.iter();
        intervals.extend(last.filter_map(|push| acts(push, scenario, begin_s, f64::INFINITY)));
        Self {
            pushes: joined(intervals),
            edits,
        }
    }
}

/// Returns the time for which `push` acts between two times, s.
fn acts(push: &Push, scenario: &Scenario, from_s: f64, to_s: f64) -> Option<(f64, f64)> {
    let (begin, end) = acts_s(push, scenario);
    let (begin, end) = (begin.max(from_s), end.min(to_s));
    (begin < end && push.force.norm() > 0.0).then_some((begin, end))
}

fn joined(mut intervals: Vec<(f64, f64)>) -> Vec<(f64, f64)> {
    intervals.sort_by(|a, b| a.0.total_cmp(&b.0));
    let mut joined: Vec<(f64, f64)> = Vec::with_capacity(intervals.len());
    for (begin, end) in intervals {
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
    use crate::scenario::{Document, presets};

    /// Returns the pushes and edits of a preset with these edits. Each edit has a step and the values it sets.
    fn marks(preset: &str, edits: &[(u64, &str)]) -> Marks {
        let mut text = presets::find(preset).unwrap().text.to_owned();
        for (step, set) in edits {
            text += &format!("\n[[edit]]\nstep = {step}\nset = {{ {set} }}");
        }
        let document = Document::parse("marks.toml", &text).unwrap();
        Marks::new(&document.scenario().unwrap())
    }

    #[test]
    fn push_times_in_seconds_allow_for_edits() {
        let endless = [(0.0, f64::INFINITY)];
        assert_eq!(marks("wobble-push-accumulating", &[]).pushes, endless);
        // Step 40 is at 4 s; from there on a step is 0.05 s long.
        let shorter = [
            (40, "'motion.time_step_s' = 0.05"),
            (60, "'motion.gravity_m_per_s2' = 9"),
        ];
        let another = "'push.0' = { point = 'top', force_N = [1, 0, 0], from_s = 6, for_s = 2 }";
        let taken_away = [(50, "'push.0.force_N' = [0, 0, 0]"), (55, another)];
        for (edits, pushes, edits_s) in [
            (&[][..], &[(0.0, 20.0)][..], &[][..]),
            (&shorter, &[(0.0, 20.0)], &[4.0, 5.0]),
            (&taken_away, &[(0.0, 5.0), (6.0, 8.0)], &[5.0, 5.5]),
        ] {
            let marks = marks("wobble-push", edits);
            assert_eq!(marks.pushes.len(), pushes.len(), "{edits:?}: {marks:?}");
            for (interval, expected) in marks.pushes.iter().zip(pushes) {
                let off_s = (interval.0 - expected.0)
                    .abs()
                    .max((interval.1 - expected.1).abs());
                assert!(off_s < 1e-9, "{edits:?}: {marks:?}");
            }
            assert_eq!(marks.edits, edits_s, "{edits:?}");
        }
    }
}
