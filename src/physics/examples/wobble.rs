//! Shows how a long time step makes a wobble: a ring of ten points spins five times per step of the report's scheme. The
//! tilt then swings by degrees. In the exact motion it stays almost constant.

use gyrolab_physics::nalgebra::Vector3;
use gyrolab_physics::observables::tilt_deg;
use gyrolab_physics::{Body, ExactMotion, Loads, PointMass, State, SteppedMotion, rotation};
use std::error::Error;
use std::f64::consts::PI;

fn main() -> Result<(), Box<dyn Error>> {
    let hub = 0.32_f64.sqrt();
    let points = (0..10).map(|j| {
        let around = rotation::about(&Vector3::z(), 0.2 * PI * f64::from(j));
        PointMass {
            at: around * Vector3::new(0.8, 0.0, hub),
            mass: 0.5,
        }
    });
    let body = Body::new(points.collect())?;
    let loads = Loads {
        gravity: 9.8,
        ..Loads::default()
    };
    let tilted = rotation::about(&Vector3::x(), 45.0_f64.to_radians());
    let start = State {
        time_s: 0.0,
        orientation: tilted,
        momentum: 1000.0 * tilted.column(2),
    };

    println!("time step (s)   tilt in 30 s (degrees)");
    for (dt, steps) in [(0.1, 300), (0.01, 3_000), (0.001, 30_000)] {
        let mut motion = SteppedMotion::new("report", &body, &loads, &start)?;
        let tilts = (0..steps).map(|_| {
            motion.step(dt);
            tilt_deg(motion.state())
        });
        print_range(&dt.to_string(), tilts);
    }
    let mut exact = ExactMotion::new(&body, &loads, &start);
    let times = (1..=30_000).map(|step| 0.001 * f64::from(step));
    print_range("exact", times.map(|time_s| tilt_deg(&exact.at(time_s))));
    Ok(())
}

fn print_range(name: &str, tilts: impl Iterator<Item = f64>) {
    let (least, greatest) = tilts.fold((f64::MAX, f64::MIN), |(least, greatest), tilt| {
        (tilt.min(least), tilt.max(greatest))
    });
    println!("{name:<15} {least:.3} to {greatest:.3}");
}
