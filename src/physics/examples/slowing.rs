//! Lets friction slow a spinning wheel, and prints how its axle sinks and precesses faster.

use gyrolab_physics::nalgebra::Vector3;
use gyrolab_physics::observables::{Azimuth, tilt_deg};
use gyrolab_physics::{Body, Friction, Loads, PlacedSolid, Shape, State, SteppedMotion, rotation};
use std::error::Error;

fn main() -> Result<(), Box<dyn Error>> {
    let axle = Vector3::z();
    let tire = Shape::Tube {
        inner: 0.08,
        outer: 0.1,
        length: 0.03,
    };
    let wheel = PlacedSolid::new(tire, 0.8, 0.15 * axle, &axle)?;
    let body = Body::from_solids(&[wheel])?;
    let loads = Loads {
        gravity: 9.81,
        friction: Friction {
            spin_dry: 1e-3,
            spin_viscous: 2e-5,
            swing_viscous: 1e-3,
            ..Friction::default()
        },
        ..Loads::default()
    };
    let start = State::spinning(&body, rotation::about(&Vector3::x(), 1.0), 200.0);

    // A scheme that cannot follow dry friction is refused, with the reason.
    if let Err(refusal) = SteppedMotion::new("rk4", &body, &loads, &start) {
        println!("{refusal}");
    }
    let mut motion = SteppedMotion::new("strang", &body, &loads, &start)?;
    let mut azimuth = Azimuth::start(&start.axle());
    println!("time (s)   tilt (deg)   azimuth (deg)   energy (J)   work of friction (J)");
    for step in 0..=60_000 {
        if step % 6_000 == 0 {
            let (state, angle) = (motion.state(), azimuth.degrees());
            let (time_s, tilt) = (state.time_s, tilt_deg(state));
            let (energy, work) = (motion.energy(), motion.work());
            println!("{time_s:<10.1} {tilt:<12.3} {angle:<15.1} {energy:<12.4} {work:.4}");
        }
        motion.step(0.001);
        azimuth.turn_to(&motion.state().axle());
    }
    Ok(())
}
