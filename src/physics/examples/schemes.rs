//! Steps a heavy top for ten seconds by every scheme, and prints how far each is from the exact motion.

use gyrolab_physics::nalgebra::Vector3;
use gyrolab_physics::scheme::SCHEMES;
use gyrolab_physics::{
    Body, ExactMotion, Loads, PlacedSolid, Shape, State, SteppedMotion, rotation,
};
use std::error::Error;

fn main() -> Result<(), Box<dyn Error>> {
    let axle = Vector3::z();
    let disk = Shape::Cylinder {
        radius: 0.1,
        length: 0.02,
    };
    let wheel = PlacedSolid::new(disk, 1.2, 0.2 * axle, &axle)?;
    let rod = PlacedSolid::new(Shape::Rod { length: 0.3 }, 0.1, 0.15 * axle, &axle)?;
    let body = Body::from_solids(&[wheel, rod])?;
    let loads = Loads {
        gravity: 9.81,
        ..Loads::default()
    };
    let tilted = rotation::about(&Vector3::x(), 45.0_f64.to_radians());
    let start = State::spinning(&body, tilted, 150.0);

    println!("scheme     dt (s)   error of the axle   energy error (J)");
    for scheme in SCHEMES {
        for dt in [0.02, 0.01, 0.005] {
            let mut motion = SteppedMotion::new(scheme.name, &body, &loads, &start)?;
            for _ in 0..(10.0 / dt) as u32 {
                motion.step(dt);
            }
            let state = motion.state();
            let exact = ExactMotion::new(&body, &loads, &start).at(state.time_s);
            let off = (state.axle() - exact.axle()).norm();
            let error = motion.energy_error();
            println!("{:10} {dt:<8} {off:<19.2e} {error:.2e}", scheme.name);
        }
    }
    Ok(())
}
