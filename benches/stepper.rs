use gyrolab::physics::*;
use nalgebra::*;
use std::time::Instant;
fn body(rim: usize) -> Body {
    let h = 0.8 / 2f64.sqrt();
    let mut points: Vec<PointMass> = (0..rim)
        .map(|j| {
            let a = std::f64::consts::TAU * j as f64 / rim as f64;
            PointMass {
                at: Vector3::new(0.8 * a.cos(), 0.8 * a.sin(), h),
                mass: 5.0 / rim as f64,
            }
        })
        .collect();
    for z in [h, 2.0 * h, 0.0, h / 2.0] {
        points.push(PointMass {
            at: Vector3::new(0., 0., z),
            mass: 0.0,
        });
    }
    Body::new(points).unwrap()
}
fn main() {
    for rim in [10usize, 1000, 100_000] {
        let body = body(rim);
        let mut scheme = scheme::SchemeInfo::find("report").unwrap().make(&body);
        let tilt = rotation::about(&Vector3::x(), std::f64::consts::FRAC_PI_4);
        let mut state = State {
            time_s: 0.0,
            orientation: tilt,
            momentum: tilt * Vector3::new(0., 0., 1000.),
        };
        scheme.load(&Loads {
            gravity: 9.8,
            pushes: vec![],
        });
        scheme.start(&state);
        let steps = 20_000_000 / rim as u64;
        let mut sink = 0.0;
        let mut rec = None;
        let t = Instant::now();
        for k in 1..=steps {
            let before = state;
            scheme.step(0.1, &mut state);
            state.time_s = k as f64 * 0.1;
            let r = StepRecord {
                step: k,
                time_step_s: 0.1,
                before,
                workings: scheme.workings(&before, &state, 0.1),
                after: state,
            };
            sink += std::hint::black_box(&r).workings.torque.x;
            rec = Some(r);
        }
        let ns = t.elapsed().as_nanos() as f64 / steps as f64;
        println!(
            "{rim}: {ns:.1} ns/step, {:.2} ns a point; {sink} {:?}",
            ns / (rim + 4) as f64,
            rec.unwrap().after.momentum.x
        );
    }
}
