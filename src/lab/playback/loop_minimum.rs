//! The first motion of a released axle: it dips, and moves sideways.

use super::live::integration_cost;
use crate::engine::run::Simulation;
use crate::engine::scenario::Scenario;
use std::sync::Arc;

const MOST_DIP_STEPS: u64 = 4000;
/// Maximum number of points in all its steps together. An integrated step costs as much as many points.
const MOST_COST: u64 = 2_000_000;
/// An axle whose tilt has a smaller sine than this counts as upright: it has no lower side.
const UPRIGHT_SINE: f64 = 1e-6;

/// The first dip of a run: the direction of the axle after each step, as a path on the sphere about the pivot.
#[derive(Clone, Debug, PartialEq)]
pub struct Dip {
    /// The displacement of the axle at each step from 0 on: sideways, in the direction of the weight's torque, and
    /// down. Both are arcs, m, whose radius is the distance of the traced point from the pivot.
    pub way_m: Vec<(f64, f64)>,
    /// True if the axle has risen again at the end. Otherwise the run ends earlier, or the computation was given up.
    pub is_whole: bool,
}

impl Dip {
    /// Computes the first dip of the run of `scenario`, or its part up to step `last`. Returns `None` if the axle is
    /// upright at the start, because it then has no lower side.
    pub fn compute(scenario: &Arc<Scenario>, last: u64) -> Option<Self> {
        let mut run = Simulation::new(Arc::clone(scenario));
        let (tilt_deg, azimuth_deg) = (run.now().tilt_deg(), run.now().azimuth().degrees());
        let across = libm::sin(tilt_deg.to_radians());
        if across < UPRIGHT_SINE {
            return None;
        }
        let arm_m = scenario.arm_m();
        let points = scenario.body.mechanics.points().len() as u64;
        let (last, mut left) = (last.min(MOST_DIP_STEPS), MOST_COST);
        let mut way_m = vec![(0.0, 0.0)];
        let mut turns = 0;
        let mut is_falling = None;
        while run.step_number() < last && turns < 2 {
            let cost = points.max(1) + integration_cost(&run, 0);
            let Some(rest) = left.checked_sub(cost) else {
                break;
            };
            left = rest;
            let Ok(step) = run.step() else { break };
            let turned = (step.azimuth().degrees() - azimuth_deg).to_radians();
            let fallen = (step.tilt_deg() - tilt_deg).to_radians();
            let now = (arm_m * across * turned, arm_m * fallen);
            let (_, before) = way_m[way_m.len() - 1];
            if now.1 != before {
                let falls = now.1 > before;
                turns += usize::from(is_falling.is_some_and(|fell: bool| fell != falls));
                is_falling = Some(falls);
            }
            way_m.push(now);
        }
        Some(Self {
            way_m,
            is_whole: turns >= 2,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lab::for_tests::preset_with as scenario;

    #[test]
    fn a_released_top_dips_and_rises_at_its_side() {
        // A nutation of the preset cusps takes 0.8225 s, and its tilt swings from 30 to 36.689 degrees.
        let cusps = scenario("cusps", &[]);
        let steps = (0.8225 / cusps.motion.time_step_s) as usize;
        let Dip { way_m, is_whole } = Dip::compute(&cusps, 1_000_000).unwrap();
        assert!(is_whole);
        assert!(
            way_m.len().abs_diff(steps) <= steps / 20 + 3,
            "{}",
            way_m.len()
        );
        let deepest = way_m.iter().map(|(_, down)| *down).fold(0.0, f64::max);
        let part = deepest / (cusps.arm_m() * libm::sin(6.689_f64.to_radians()));
        assert!((part - 1.0).abs() < 0.15, "{part}");
        let (side, down) = way_m[way_m.len() - 1];
        assert!(
            side > deepest && down.abs() < 1e-2 * deepest,
            "{side} {down}"
        );
    }
}
