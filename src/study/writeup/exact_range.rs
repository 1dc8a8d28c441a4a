//! The least and the greatest tilt and height of the exact motion over a whole run.

use crate::physics::exact::LagrangeTop;
use crate::physics::observables;
use crate::run::Truth;
use crate::scenario::Scenario;
use std::sync::Arc;

/// Samples per nutation, joined by parabolas.
const A_NUTATION: f64 = 64.0;
/// Most samples of a run; beyond them there is no range.
const MOST: f64 = 4e6;

/// The least and the greatest values of the exact motion from the start to the end of a run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ExactRange {
    pub tilt_deg: (f64, f64),
    pub z_m: (f64, f64),
}

impl ExactRange {
    /// The range beside the run of `scenario` up to `end_s`, s. `None` where the motion has no period of nutation that is
    /// known, or too many nutations.
    pub fn new(scenario: &Arc<Scenario>, end_s: f64) -> Option<Self> {
        let mut truth = Truth::new(Arc::clone(scenario));
        let (mut tilt, mut z) = (Range::default(), Range::default());
        let (mut time_s, mut changes, mut apart_s) = (0.0, None, 0.0);
        for _ in 0..MOST as u64 {
            let state = truth.state_at(time_s);
            if changes.replace(truth.changes()) != Some(truth.changes()) {
                // The forces have changed: it is another curve from here on.
                (tilt.before, z.before) = (None, None);
                let form = truth.motion().closed_form();
                apart_s = form.and_then(LagrangeTop::nutation_period)? / A_NUTATION;
            }
            let is_end = time_s >= end_s;
            if is_end {
                // The last moment is nearer to the one before it: no parabola goes through it.
                (tilt.before, z.before) = (None, None);
            }
            let body = &scenario.body.mechanics;
            tilt.take(observables::tilt_deg(&state));
            z.take(observables::position(body, &state, scenario.trace).z);
            if is_end {
                let is_finite =
                    [tilt.low, tilt.high, z.low, z.high].map(f64::is_finite) == [true; 4];
                return is_finite.then_some(Self {
                    tilt_deg: (tilt.low, tilt.high),
                    z_m: (z.low, z.high),
                });
            }
            time_s = (time_s + apart_s).min(end_s);
        }
        None
    }
}

/// The least and the greatest value of a curve through values that are equally far apart.
#[derive(Clone, Copy, Debug)]
struct Range {
    low: f64,
    high: f64,
    /// The last value of the same curve, and the one before it.
    before: Option<(Option<f64>, f64)>,
}

impl Default for Range {
    fn default() -> Self {
        Self {
            low: f64::INFINITY,
            high: f64::NEG_INFINITY,
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
        self.low = self.low.min(value);
        self.high = self.high.max(value);
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
}
