//! The wobble caused by the report's scheme: its prediction with frozen L, and the measured swing.

use crate::support::dice::Dice;
use crate::support::scenarios::preset;
use gyrolab::engine::analysis::{Monitor, Readouts};
use gyrolab::engine::run::Simulation;
use gyrolab::engine::scenario::Scenario;
use std::sync::Arc;

fn played(scenario: &Scenario) -> Readouts {
    let scenario = Arc::new(scenario.clone());
    let mut simulation = Simulation::new(Arc::clone(&scenario));
    let mut monitor = Monitor::new(simulation.now());
    while simulation.step_number() < scenario.steps {
        simulation.step().unwrap();
        monitor.measure(simulation.now());
    }
    let health = monitor.health(simulation.now());
    Readouts::new(&simulation, &mut monitor, &health, None)
}

fn at(time_step_s: f64) -> Readouts {
    let steps = (100.0 / time_step_s).round();
    let sets = [
        format!("motion.time_step_s={time_step_s:?}"),
        format!("motion.steps={steps}"),
    ];
    played(&preset("method-2", &sets.each_ref().map(String::as_str)))
}

/// Method 2 computed by hand: kappa = 1, I = 3.2 kg m², |L| = 1000 J s, so |Omega| = 312.5 rad/s; the torque at 45 degrees
/// is 5 kg · 9.8 m/s² · 0.4 m = 19.6 N m; |1 - A| = 2 |sin(psi/2)|.
#[test]
fn lag_and_swing_match_a_calculation_by_hand() {
    for (time_step_s, lag_deg) in [
        // psi = 0.3125: 1.96e-5 / 0.311232 rad
        (0.001, 0.003_608_2),
        // psi = 15.625, 5 pi - 0.083: 9.8e-4 / 1.998279 rad
        (0.05, 0.028_099),
        // psi = 31.25, 10 pi - 0.165927: 1.96e-3 / 0.165736 rad
        (0.1, 0.677_58),
    ] {
        let readouts = at(time_step_s);
        let number = |name| readouts.number(name);
        let lag = number("predicted_lag_deg").unwrap();
        assert!((lag / lag_deg - 1.0).abs() < 1e-4, "{time_step_s}: {lag}");
        // A full swing about the lag is twice its size, except at 0.05 s, where the steps sample only two phases of the swing.
        match number("predicted_tilt_swing_deg") {
            Some(swing) => assert!((swing / (2.0 * lag) - 1.0).abs() < 2e-2, "{swing}"),
            None => assert_eq!(time_step_s, 0.05),
        }
    }
}

#[test]
fn predicted_swings_are_measured_and_unpredictable_ones_are_null() {
    let (mut predicted, mut least, mut most) = (0, f64::INFINITY, 0.0_f64);
    for index in 1..=60 {
        let time_step_s = 0.01 + 0.0015 * f64::from(index);
        let readouts = at(time_step_s);
        let number = |name| readouts.number(name);
        let measured = number("measured_tilt_swing_deg").unwrap();
        let Some(swing) = number("predicted_tilt_swing_deg") else {
            continue;
        };
        predicted += 1;
        least = least.min(swing);
        most = most.max(swing);
        assert!(
            (swing / measured - 1.0).abs() < 0.1,
            "{time_step_s}: {swing} and {measured}"
        );
    }
    assert!(predicted > 45, "{predicted}");
    assert!(most > 10.0 * least, "the comb has teeth: {least} to {most}");
    // At five turns per step, the swing changes its own frequency, and linear theory does not apply.
    let resonant = at(0.100_531);
    assert_eq!(resonant.number("predicted_lag_deg"), None);
    assert_eq!(resonant.number("predicted_tilt_swing_deg"), None);
    assert!(resonant.number("measured_tilt_swing_deg").unwrap() > 3.0);
}

#[test]
fn predictions_need_the_report_scheme_and_a_lasting_nutation() {
    let null = |name: &str, set: &[&str]| {
        let readouts = played(&preset(name, set));
        let of = |readout| readouts.number(readout);
        (
            of("predicted_lag_deg").is_none(),
            of("predicted_tilt_swing_deg").is_none(),
        )
    };
    assert_eq!(null("method-2", &["motion.scheme=exact"]), (true, true));
    // kappa = 0.38: each step damps the nutation.
    let damped = [
        "motion.scheme=report",
        "motion.time_step_s=0.001",
        "motion.steps=20000",
    ];
    assert_eq!(null("fast-top", &damped), (false, true));
    // kappa = 1.4: each step amplifies the nutation until the axle is perpendicular to L.
    let fed = ["body.rim.height_m=0.3", "motion.time_step_s=0.003"];
    assert_eq!(null("method-2", &fed), (true, true));
    let sideways = "push.0={point='top',force_N=[5,0,0],from_s=0,for_s=1e3}";
    assert_eq!(null("method-2", &[sideways]), (true, true));
    let few = ["motion.scheme=exact", "motion.steps=3"];
    assert_eq!(
        played(&preset("cusps", &few)).number("measured_tilt_swing_deg"),
        None
    );
}

/// Compares with the exact motion at 6 to 60 rows per nutation.
#[test]
fn the_uncertainty_of_the_swing_covers_sampling() {
    let mut dice = Dice(20);
    let mut ratios = Vec::new();
    while ratios.len() < 1000 {
        let sets = [
            format!("start.tilt_deg={}", dice.between(10.0, 120.0)),
            format!(
                "start.momentum_Js=[0,{},{}]",
                dice.between(-3.0, 3.0),
                dice.scale(30.0, 300.0)
            ),
            "motion.scheme=exact".to_owned(),
            "motion.steps=1".to_owned(),
        ];
        let scenario = preset("cusps", &sets.each_ref().map(String::as_str));
        let theory = played(&scenario).theory.unwrap();
        let (low, high) = theory.tilt_range_deg;
        let Some(period_s) = theory.nutation_period_s.filter(|_| high - low > 1e-3) else {
            continue;
        };
        let time_step_s = period_s / dice.scale(6.5, 60.0);
        let mut longer = scenario.clone();
        longer.motion.time_step_s = time_step_s;
        longer.written_for_s = time_step_s;
        longer.steps = (dice.between(2.6, 6.0) * period_s / time_step_s) as u64;
        let readouts = played(&longer);
        let swing = readouts.number("measured_tilt_swing_deg").unwrap();
        let sigma = readouts
            .number("measured_tilt_swing_uncertainty_deg")
            .unwrap();
        ratios.push((swing - (high - low)).abs() / sigma);
    }
    ratios.sort_by(f64::total_cmp);
    let within = ratios.iter().filter(|&&ratio| ratio <= 2.0).count();
    println!(
        "within {within}, median {}, most {}",
        ratios[500], ratios[999]
    );
    assert!(
        within >= 930 && ratios[999] <= 6.0 && ratios[500] >= 0.2,
        "{within} {} {}",
        ratios[500],
        ratios[999]
    );
}
