//! The closed form against motions known to many digits, and its readouts against the textbook table.

use super::common::{Known, Start, greatest, table, tilted};
use gyrolab::physics::exact::LagrangeTop;
use nalgebra::Vector3;

fn textbook(tilt_degrees: f64, momentum_body: [f64; 3]) -> LagrangeTop {
    let orientation = tilted(tilt_degrees);
    LagrangeTop::new(
        6.6,
        3.2,
        Vector3::new(0.0, 0.0, -49.0),
        orientation,
        orientation * Vector3::from(momentum_body),
    )
}

/// Rows: t (s), axle, L (J s), first body axis.
fn worst_of_reference(text: &str, momentum_body: [f64; 3]) -> f64 {
    let orientation = tilted(45.0);
    let momentum = orientation * Vector3::from(momentum_body);
    let top = LagrangeTop::new(
        8.35,
        3.2,
        Vector3::new(0.0, 0.0, -63.7),
        orientation,
        momentum,
    );
    greatest(text.lines().skip(1).flat_map(|line| {
        let v: Vec<f64> = line
            .split(',')
            .map(|x| x.parse().expect("a number"))
            .collect();
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
    let cusped = worst_of_reference(
        include_str!("../../reference/exact/cusped.csv"),
        [0.0, 0.0, 100.0],
    );
    let looping = worst_of_reference(
        include_str!("../../reference/exact/looping.csv"),
        [0.0, -20.0, 30.0],
    );
    println!("cusped {cusped:.1e}, looping {looping:.1e}");
    assert!(
        cusped < 1e-12 && looping < 1e-12,
        "cusped {cusped:e}, looping {looping:e}"
    );
}

/// Rounding of the start, as far as the motion magnifies it.
///
/// A top that comes from afar lingers near the upright rest for a time that depends on its energy's distance from the
/// separatrix: for ever on it (where a neighbour parts as exp(rate t)), else rounding counts against the least tilt squared.
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
fn a_million_seconds_cost_no_more_than_rounding_of_the_frequencies() {
    for (start, known) in table(include_str!("../../reference/exact/far.csv")) {
        let error = greatest(known.errors(&start.top().at(known.t), start.momentum_scale()));
        let unit = f64::EPSILON * known.t * start.rates();
        println!("{:28} {error:.1e} = {:.2} units", start.name, error / unit);
        assert!(
            error < 4.0 * unit,
            "{}: {error:e}, unit {unit:e}",
            start.name
        );
    }
}

/// Tilt from, tilt to (degrees), nutation period (s), mean precession (rad/s): textbook set, to the digits given there.
const TABLE: [(f64, [f64; 3], [f64; 4]); 8] = [
    (
        30.0,
        [0.0, 0.0, 60.0],
        [30.0, 36.689_122, 0.822_521_09, 0.886_032_86],
    ),
    (
        30.0,
        [0.0, -3.0, 60.0],
        [30.0, 43.326_768, 0.809_721_64, 0.872_935_38],
    ),
    (
        30.0,
        [0.0, 1.5, 60.0],
        [30.0, 33.300_271, 0.827_518_10, 0.890_195_12],
    ),
    (
        30.0,
        [0.0, 2.945_444_198_542_434_7, 60.0],
        [30.0, 30.0, 0.831_313_82, 0.892_558_85],
    ),
    (
        30.0,
        [0.0, 31.695_571_952_835_103, 60.0],
        [30.0, 30.0, 0.702_529_98, 9.604_718_77],
    ),
    (
        1.0,
        [0.0, 0.0, 40.0],
        [1.0, 2.283_364, 2.365_916_37, 1.703_420_95],
    ),
    (
        1.0,
        [0.0, 0.0, 34.0],
        [1.0, 38.187_812, 8.725_835_95, 2.366_842_57],
    ),
    (
        10.0,
        [0.0, 0.0, 15.0],
        [10.0, 130.944_391, 2.937_805_82, 1.611_481_35],
    ),
];

#[test]
fn readouts_agree_with_the_textbook_table() {
    for (tilt, momentum, [from, to, period, precession]) in TABLE {
        let top = textbook(tilt, momentum);
        let (least, greatest) = top.tilt_range();
        assert!(
            (least.to_degrees() - from).abs() < 1e-6 && (greatest.to_degrees() - to).abs() < 1e-6
        );
        let nutation = top.nutation_period().expect("this top nutates");
        assert!(
            (nutation - period).abs() < 1e-8,
            "period {nutation}, table {period}"
        );
        assert!(
            (top.mean_precession() - precession).abs() < 1e-8,
            "{}, table {precession}",
            top.mean_precession()
        );
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
    let top = LagrangeTop::new(
        6.6,
        3.2,
        Vector3::new(0.0, 0.0, -49.0),
        tilted(80.0),
        Vector3::zeros(),
    );
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
    // The tilt returns twice in each full swing.
    let period = top.nutation_period().expect("it swings");
    assert!(
        (2.0 * period / swing - 1.0).abs() < 1e-14,
        "{period} against {}",
        swing / 2.0
    );
}
