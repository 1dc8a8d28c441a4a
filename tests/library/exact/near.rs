//! The closed form at several times at once, compared with the closed form itself.

use gyrolab::engine::run::{Simulation, Truth};
use gyrolab::engine::scenario::Document;
use gyrolab::physics::exact::AT_ONCE;
use nalgebra::Vector3;
use std::sync::Arc;

#[test]
fn positions_at_several_times_equal_the_closed_form_up_to_rounding() {
    let mut waving = 0;
    for preset in [
        "wobble-push",
        "cusps",
        "loops",
        "torque-free",
        "method-1",
        "method-2",
        "fast-top",
    ] {
        let scenario = Arc::new(Document::open(preset).unwrap().scenario().unwrap());
        let mut truth = Truth::new(Arc::clone(&scenario));
        let start = *Simulation::new(scenario).state();
        let _ = truth.state_at(start.time_s);
        let top = truth.motion().closed_form().unwrap();
        let mut most = 0.0_f64;
        for at in [Vector3::z(), Vector3::new(0.6, 0.0, 0.8)] {
            for number in 0..2_500 {
                // Up to eight days.
                let begin = 0.1096 * f64::from(number) * f64::from(1 + number) - 3.0;
                let times = std::array::from_fn(|place| begin + 0.0137 * place as f64);
                let Some(near) = top.positions_near(&at, &times) else {
                    continue;
                };
                waving += 1;
                for (place, t) in times.into_iter().enumerate() {
                    let exact = top.orientation_at(t) * at;
                    let near = Vector3::from(near.map(|axis| axis[place]));
                    most = most.max((exact - near).norm());
                }
            }
        }
        assert!(most < 3e-15, "{preset}: {most:e}");
    }
    assert!(waving > 20_000, "{waving}");
}

#[test]
fn extremely_late_times_are_rejected() {
    let scenario = Arc::new(Document::open("cusps").unwrap().scenario().unwrap());
    let truth = Truth::new(scenario);
    let top = truth.motion().closed_form().unwrap();
    assert!(top.positions_near(&Vector3::z(), &[1e3; AT_ONCE]).is_some());
    assert!(
        top.positions_near(&Vector3::z(), &[1e15; AT_ONCE])
            .is_none()
    );
}
