//! The closed form compared with reference motions, and its readouts with the textbook table.

use super::common::{Known, Start, greatest, table, tilted};
use gyrolab::physics::exact::LagrangeTop;
use nalgebra::Vector3;

fn textbook(tilt_degrees: f64, momentum_body: [f64; 3]) -> LagrangeTop {
    let orientation = tilted(tilt_degrees);
    let (weight, momentum) = (Vector3::new(0.0, 0.0, -49.0), Vector3::from(momentum_body));
    LagrangeTop::new(6.6, 3.2, weight, orientation, orientation * momentum)
}

/// Returns the maximum error over the rows of `text`: t (s), axle, L (J s), first body axis.
fn worst_of_reference(text: &str, momentum_body: [f64; 3]) -> f64 {
    let orientation = tilted(45.0);
    let momentum = orientation * Vector3::from(momentum_body);
    let weight = Vector3::new(0.0, 0.0, -63.7);
    let top = LagrangeTop::new(8.35, 3.2, weight, orientation, momentum);
    greatest(text.lines().skip(1).flat_map(|line| {
        let v: Vec<f64> = line.split(',').map(|x| x.parse().unwrap()).collect();
        let three = |k: usize| Vector3::new(v[k], v[k + 1], v[k + 2]);
        let known = Known {
            t: v[0],
            axle: three(1),
            momentum: three(4),
            body_x: three(7),
        };
        known.errors(&top.at(known.t), momentum.norm())
    }))
}

#[test]
fn cusped_and_looping_tops_agree_with_the_reference_to_rounding() {
    let cusped = include_str!("../../reference/exact/cusped.csv");
    let looping = include_str!("../../reference/exact/looping.csv");
    for (text, momentum) in [(cusped, [0.0, 0.0, 100.0]), (looping, [0.0, -20.0, 30.0])] {
        let worst = worst_of_reference(text, momentum);
        assert!(worst < 1e-12, "{momentum:?}: {worst:e}");
    }
}

/// Returns the tolerance: the rounding of the start, amplified by the motion.
///
/// A top that approaches the upright rest lingers there for a time that depends on the distance of its energy from the
/// separatrix. On the separatrix it stays forever, and neighbors diverge as exp(rate t). Otherwise the rounding is relative
/// to the square of the minimum tilt.
fn allowed(start: &Start) -> f64 {
    let rate = (start.load.norm() / start.across).sqrt();
    let (least_tilt, _) = start.top().tilt_range();
    match start.name.as_str() {
        "pendulum separatrix" | "pendulum separatrix from bottom" => {
            f64::EPSILON * (rate * 10.0).exp()
        }
        "near separatrix from afar" => f64::EPSILON / (least_tilt * least_tilt),
        _ => 5e-13,
    }
}

#[test]
fn degenerate_starts_agree_with_the_reference() {
    for (start, known) in table(include_str!("../../reference/exact/hard_starts.csv")) {
        let error = greatest(known.errors(&start.top().at(known.t), start.momentum_scale()));
        println!("{:32} {error:.1e}", start.name);
        assert!(error < allowed(&start), "{}: {error:e}", start.name);
    }
}

#[test]
fn after_a_million_seconds_only_rounding_of_the_frequencies_shows() {
    for (start, known) in table(include_str!("../../reference/exact/far.csv")) {
        let error = greatest(known.errors(&start.top().at(known.t), start.momentum_scale()));
        let unit = f64::EPSILON * known.t * start.rates();
        println!("{:28} {error:.1e} = {:.2} units", start.name, error / unit);
        let name = start.name;
        assert!(error < 4.0 * unit, "{name}: {error:e}, unit {unit:e}");
    }
}

#[test]
fn free_top_precesses_about_its_momentum_and_has_no_nutation_period() {
    let momentum = Vector3::new(0.0, 0.0, 60.0);
    let top = LagrangeTop::new(6.6, 3.2, Vector3::zeros(), tilted(30.0), momentum);
    assert_eq!(top.nutation_period(), None);
    assert!((top.mean_precession() - 60.0 / 6.6).abs() < 1e-14);
}

#[test]
fn pendulum_has_the_textbook_period() {
    // From 100 degrees above the bottom: T = 4 sqrt(I/mgl) K(sin^2 50 deg), here by its hypergeometric series.
    let top = textbook(80.0, [0.0; 3]);
    let m = 50_f64.to_radians().sin().powi(2);
    let mut term = 1.0;
    let series: f64 = (0..300)
        .map(|n| {
            let now = term;
            term *= m * ((2.0 * f64::from(n) + 1.0) / (2.0 * f64::from(n) + 2.0)).powi(2);
            now
        })
        .sum();
    let swing = std::f64::consts::TAU * (6.6_f64 / 49.0).sqrt() * series;
    // The tilt has two periods in each full swing.
    let period = top.nutation_period().expect("a period");
    let off = (2.0 * period / swing - 1.0).abs();
    assert!(off < 1e-14, "{period} against {}", swing / 2.0);
}
