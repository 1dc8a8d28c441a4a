//! The least and the greatest tilt and height of the exact motion over a whole run.

use crate::physics::exact::LagrangeTop;
use crate::physics::observables;
use crate::run::Truth;
use crate::scenario::Scenario;
use std::sync::Arc;

/// Moments in a nutation that are looked at; between them the motion is taken for a parabola.
const A_NUTATION: f64 = 64.0;
/// Of a run with more moments than this nothing is said.
const MOST: f64 = 4e6;

/// The least and the greatest values of the exact motion from the start to the end of a run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ExactRange {
    /// Of the axle's tilt from +z, degrees.
    pub tilt_deg: (f64, f64),
    /// Of the traced point's z, m.
    pub z_m: (f64, f64),
}

impl ExactRange {
    /// That of the exact motion beside the run of `scenario` up to `end_s`, s. `None` where the motion has no period of
    /// nutation that is known, or too many nutations.
    pub fn new(scenario: &Arc<Scenario>, end_s: f64) -> Option<Self> {
        let mut truth = Truth::new(Arc::clone(scenario));
        let (mut tilts, mut heights) = (Range::default(), Range::default());
        let (mut time_s, mut changes, mut apart_s) = (0.0, None, 0.0);
        for _ in 0..MOST as u64 {
            let state = truth.state_at(time_s);
            if changes.replace(truth.changes()) != Some(truth.changes()) {
                // The forces have changed: it is another curve from here on.
                (tilts.before, heights.before) = (None, None);
                let form = truth.motion().closed_form();
                apart_s = form.and_then(LagrangeTop::nutation_period)? / A_NUTATION;
            }
            if time_s >= end_s {
                // The last moment is nearer to the one before it: no parabola goes through it.
                (tilts.before, heights.before) = (None, None);
            }
            tilts.take(observables::tilt_deg(&state));
            let body = &scenario.body.mechanics;
            heights.take(observables::position(body, &state, scenario.trace).z);
            if time_s >= end_s {
                let ranges = [tilts.range, heights.range];
                let is_finite = ranges.iter().all(|(low, high)| (high - low).is_finite());
                return is_finite.then_some(Self {
                    tilt_deg: tilts.range,
                    z_m: heights.range,
                });
            }
            time_s = (time_s + apart_s).min(end_s);
        }
        None
    }

    /// The end of the range that the readout of that name has of a run's steps.
    pub fn of(&self, readout: &str) -> Option<f64> {
        match readout {
            "measured_lowest_tilt_deg" => Some(self.tilt_deg.0),
            "measured_highest_tilt_deg" => Some(self.tilt_deg.1),
            "measured_lowest_z_m" => Some(self.z_m.0),
            "measured_highest_z_m" => Some(self.z_m.1),
            _ => None,
        }
    }
}

/// The least and the greatest value of a curve through values that are equally far apart.
#[derive(Clone, Copy, Debug)]
struct Range {
    range: (f64, f64),
    /// The value before the last one, where there is one of the same curve, and the last one.
    before: Option<(Option<f64>, f64)>,
}

impl Default for Range {
    fn default() -> Self {
        Self {
            range: (f64::INFINITY, f64::NEG_INFINITY),
            before: None,
        }
    }
}

impl Range {
    fn take(&mut self, value: f64) {
        self.widen(value);
        if let Some((Some(first), second)) = self.before {
            let (rise, bend) = (0.5 * (value - first), value - 2.0 * second + first);
            if (value - second) * (second - first) < 0.0 {
                // The vertex of the parabola through the three.
                self.widen(second - 0.5 * rise * rise / bend);
            }
        }
        self.before = Some((self.before.map(|(_, last)| last), value));
    }

    fn widen(&mut self, value: f64) {
        self.range = (self.range.0.min(value), self.range.1.max(value));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scenario::Document;

    fn range(name: &str, end_s: f64) -> ExactRange {
        let scenario = Document::open(name).unwrap().scenario().unwrap();
        ExactRange::new(&Arc::new(scenario), end_s).unwrap()
    }

    #[test]
    fn without_a_push_it_is_that_of_the_formula() {
        let scenario = Document::open("cusps").unwrap().scenario().unwrap();
        let truth = Truth::new(Arc::new(scenario));
        let (low, high) = truth.motion().closed_form().unwrap().tilt_range();
        let tilt_deg = range("cusps", 20.0).tilt_deg;
        let is_near = |a: f64, b: f64| (a - b).abs() < 1e-5;
        assert!(
            is_near(tilt_deg.0, low.to_degrees()) && is_near(tilt_deg.1, high.to_degrees()),
            "{tilt_deg:?}"
        );
    }

    #[test]
    fn without_a_nutation_nothing_is_said() {
        // Its axle goes round L, which is not vertical: its tilt from +z changes all the time.
        let mut document = Document::open("torque-free").unwrap();
        document.set("start.momentum_Js=[10,20,60]").unwrap();
        let scenario = document.scenario().unwrap();
        assert_eq!(ExactRange::new(&Arc::new(scenario), 10.0), None);
    }

    #[test]
    fn a_push_that_has_ended_counts() {
        // Of the steps of `gyrolab run wobble-push --scheme exact --time-step 0.0005`.
        let found = range("wobble-push", 230.0);
        let is_near = |a: f64, b: f64| (a - b).abs() < 3e-8;
        let (low, high) = found.z_m;
        assert!(
            is_near(low, 0.799_489_397) && is_near(high, 0.800_079_771),
            "{found:?}"
        );
        let (low, high) = found.tilt_deg;
        assert!(
            (low - 44.994_286_54).abs() < 2e-6 && (high - 45.036_557_57).abs() < 2e-6,
            "{found:?}"
        );
        // Until the push ends the axle only sinks.
        let before = range("wobble-push", 19.9);
        assert!(before.tilt_deg.0 > 44.999_99, "{before:?}");
    }
}
