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
        let mut ranges = [Range::EMPTY; 2];
        let (mut time_s, mut changes, mut apart_s) = (0.0, None, 0.0);
        for _ in 0..MOST as u64 {
            let state = truth.state_at(time_s);
            let is_end = time_s >= end_s;
            let is_new = changes.replace(truth.changes()) != Some(truth.changes());
            if is_new {
                let form = truth.motion().closed_form();
                apart_s = form.and_then(LagrangeTop::nutation_period)? / A_NUTATION;
            }
            let z_m = observables::position(&scenario.body.mechanics, &state, scenario.trace).z;
            for (range, value) in ranges.iter_mut().zip([observables::tilt_deg(&state), z_m]) {
                // Where the forces have changed it is another curve, and the last moment is nearer to the one before it:
                // no parabola goes through these.
                range.take(value, is_new || is_end);
            }
            if is_end {
                let [tilt_deg, z_m] = ranges.map(|range| (range.low, range.high));
                let ends = [tilt_deg.0, tilt_deg.1, z_m.0, z_m.1];
                let is_finite = ends.into_iter().all(f64::is_finite);
                return is_finite.then_some(Self { tilt_deg, z_m });
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
    /// The last two values of the same curve; NaN where there are none.
    before: [f64; 2],
}

impl Range {
    const EMPTY: Self = Self {
        low: f64::INFINITY,
        high: f64::NEG_INFINITY,
        before: [f64::NAN; 2],
    };

    fn take(&mut self, value: f64, is_first: bool) {
        if is_first {
            self.before = [f64::NAN; 2];
        }
        self.widen(value);
        let [first, second] = self.before;
        let (rise, bend) = (0.5 * (value - first), value - 2.0 * second + first);
        if (value - second) * (second - first) < 0.0 {
            // The vertex of the parabola through the three.
            self.widen(second - 0.5 * rise * rise / bend);
        }
        self.before = [second, value];
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
        let is_near = |a: f64, b: f64| (a - b.to_degrees()).abs() < 1e-5;
        let are_near = is_near(tilt_deg.0, low) && is_near(tilt_deg.1, high);
        assert!(are_near, "{tilt_deg:?}");
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
