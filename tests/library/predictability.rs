//! The time for which motions can be predicted, and verdicts on longer runs.

use crate::support::scenarios::{find_scheme, parse, preset};
use crate::support::stage::{LARGE, Stage};
use crate::support::words::{has, has_all, has_no};
use gyrolab::engine::analysis::compare::{ComparisonTable, compare};
use gyrolab::engine::analysis::health::{Advice, Health, advise};
use gyrolab::engine::analysis::predictability::{Equilibrium, predictability};
use gyrolab::engine::analysis::readouts::{ReadoutValue, at_end, find};
use gyrolab::engine::analysis::verdict::{Verdict, VerdictWord};
use gyrolab::engine::analysis::{DistanceMeter, Monitor};
use gyrolab::engine::run::{Clock, Simulation, resampled};
use gyrolab::engine::scenario::Scenario;
use gyrolab::engine::scenario::presets::PRESETS;
use std::ops::ControlFlow;
use std::sync::Arc;

const PUSHED: &str = include_str!("motions/chaotic-pushed.toml");
const TOP: &str = include_str!("motions/chaotic-top.toml");
const UPRIGHT: &str = include_str!("motions/balanced-upright.toml");

const UNPREDICTABLE: &str = "no double-precision computation can predict the motion";
const BALANCED: &str = "unstable equilibrium: stays upright only in exact arithmetic";

/// Returns the verdict on the run of `scenario` at `step`, or at the step where it broke down before.
fn health_at(scenario: &Scenario, step: u64) -> Health {
    let mut simulation = Simulation::new(Arc::new(scenario.clone()));
    let mut monitor = Monitor::new(simulation.now());
    while simulation.step_number() < step && simulation.step().is_ok() {
        monitor.record(simulation.now());
    }
    monitor.health(simulation.now())
}

/// Returns the verdict on the whole run of `text` with the scheme `scheme` at `time_step_s`.
fn health(text: &str, scheme: &str, time_step_s: f64) -> Health {
    let scenario = resampled(&parse(text), time_step_s, find_scheme(scheme));
    health_at(&scenario, scenario.steps)
}

fn until_s(text: &str) -> Option<f64> {
    let scenario = parse(text);
    let end_s = Clock::end_s(&scenario);
    predictability(&Arc::new(scenario), end_s).until_s
}

#[test]
fn the_predictable_time_does_not_depend_on_the_time_step() {
    for (text, time_steps) in [
        (PUSHED, [1.29, 0.43, 0.1, 0.05]),
        (TOP, [0.5, 0.123, 0.0409, 0.01]),
    ] {
        let whole_s = until_s(text).unwrap();
        for time_step_s in time_steps {
            let health = health(text, "exact", time_step_s);
            let case = format!("{time_step_s} s: {}", health.sentence(None));
            let until_s = health.predictability.until_s.unwrap();
            // If no step falls on the times of the push, it starts and ends at neighboring steps.
            assert!((until_s / whole_s - 1.0).abs() < 0.1, "{whole_s}, {case}");
            assert_eq!(health.is_believed(), Some(true), "{case}");
            assert_eq!(health.is_reliable(), Some(false), "{case}");
            assert_eq!(health.deviation, None, "{case}");
            assert!(
                health.most_distance_m.unwrap() < 1e-3 * health.arm_m,
                "{case}"
            );
            assert!(case.contains("is predictable until t = ") && case.contains(UNPREDICTABLE));
            has_no(&case, "Not reliable");
            has_no(&case, "exact motion itself");
        }
    }
}

/// Computations with different schemes diverge at the stated time: not before, and not much later.
#[test]
fn accurate_schemes_diverge_at_the_predictable_time() {
    let scenario = parse(TOP);
    let until_s = until_s(TOP).unwrap();
    let at = scenario.body.mechanics.points()[scenario.trace].at;
    let place = |time_s: f64, time_step_s: f64| {
        let other = resampled(&scenario, time_step_s, find_scheme("srkn11b"));
        let mut simulation = Simulation::new(Arc::new(other));
        for _ in 0..(time_s / time_step_s).round() as u64 {
            simulation.step().unwrap();
        }
        simulation.state().orientation * at
    };
    let apart = |time_s: f64| {
        let [one, other] = [0.002, 0.001].map(|time_step_s| place(time_s, time_step_s));
        (one - other).norm() / scenario.arm_m()
    };
    // Both runs have steps at whole seconds.
    let (before, after) = (
        apart((0.5 * until_s).round()),
        apart((2.0 * until_s).round()),
    );
    assert!(
        before < 1e-3 && after > 0.01,
        "{until_s}: {before}, {after}"
    );
}

#[test]
fn a_run_that_fails_while_predictable_is_unreliable() {
    let health = health(PUSHED, "rk4", 0.1);
    let sentence = health.sentence(None);
    assert!(sentence.starts_with("Not reliable"), "{sentence}");
    has(&sentence, UNPREDICTABLE);
    assert_eq!(health.is_reliable(), Some(false));
}

#[test]
fn before_the_predictable_time_the_usual_verdict_applies() {
    let until_s = until_s(PUSHED).unwrap();
    let scenario = resampled(&parse(PUSHED), 0.05, find_scheme("exact"));
    let health = health_at(&scenario, (0.9 * until_s / 0.05) as u64);
    assert_eq!(health.predictability.until_s, None);
    assert_eq!(health.is_reliable(), Some(true));
    assert!(
        health
            .sentence(None)
            .starts_with("The numbers are reliable")
    );
}

#[test]
fn an_exact_run_of_a_chaotic_motion_gets_no_advice() {
    let scenario = resampled(&parse(PUSHED), 0.43, find_scheme("exact"));
    assert_eq!(advise(&scenario), Advice::Holds);
}

#[test]
fn shipped_presets_are_predictable_to_their_ends() {
    for shipped in PRESETS {
        let scenario = Arc::new(preset(shipped.name, &[]));
        let found = predictability(&scenario, Clock::end_s(&scenario));
        if shipped.name != "wobble-push-accumulating" {
            assert_eq!(found, Default::default(), "{}", shipped.name);
        }
    }
}

#[test]
fn a_balanced_upright_top_gets_no_verdict() {
    for (scheme, time_step_s) in [
        ("report", 0.513),
        ("report", 0.01),
        ("rk4", 0.01),
        ("srkn11b", 0.02),
        ("strang", 0.1),
        ("exact", 0.513),
    ] {
        let health = health(UPRIGHT, scheme, time_step_s);
        let sentence = health.sentence(None);
        let case = format!("{scheme} at {time_step_s} s: {sentence}");
        has_all(&case, &[BALANCED, UNPREDICTABLE]);
        has_no(&case, "Not reliable");
        has_no(&case, "The numbers are reliable");
        assert_eq!(health.is_believed(), None, "{case}");
        assert_eq!(health.is_reliable(), Some(false), "{case}");
        let word = Verdict::new(&health).word;
        assert_eq!(word, VerdictWord::Badge("UNSTABLE BALANCE".to_owned()));
    }
}

/// A body with unequal moments and its center of mass `above` the pivot (m), with the start and motion `rest`.
fn block(above: f64, rest: &str) -> Scenario {
    parse(&format!(
        "title = 'x'\n[[body.part]]\nshape = 'block'\nname = 'block'\nmass_kg = 1\nat_m = [0, 0, {above}]\nsize_m = [0.1, 0.2, 0.3]\n[[body.point]]\nname = 'top'\nat_m = [0, 0, 0.5]\n[start]\n{rest}\n[motion]\ntime_step_s = 0.01\nsteps = 4000\nscheme = 'exact'\n"
    ))
}

#[test]
fn an_equilibrium_is_unstable_if_an_offset_grows() {
    let spinning = |axis: [f64; 3]| format!("omega_rad_per_s = {axis:?}");
    for (above, rest, expected) in [
        (0.0, spinning([9.0, 0.0, 0.0]), None),
        (0.0, spinning([0.0, 9.0, 0.0]), Some(Equilibrium::Other)),
        (0.0, spinning([0.0, 0.0, 9.0]), None),
        (
            0.2,
            "momentum_Js = [0, 0, 0]".to_owned(),
            Some(Equilibrium::Upright),
        ),
        (-0.2, "momentum_Js = [0, 0, 0]".to_owned(), None),
        (
            0.2,
            "momentum_Js = [0, 0, 0]\ntilt_deg = 180".to_owned(),
            None,
        ),
        (
            -0.2,
            "momentum_Js = [0, 0, 0]\ntilt_deg = 180".to_owned(),
            Some(Equilibrium::Other),
        ),
        (
            0.2,
            "momentum_Js = [0, 0, 0]\ntilt_deg = 0.001".to_owned(),
            None,
        ),
        (0.2, spinning([0.0, 0.0, 3.0]), Some(Equilibrium::Upright)),
        (0.2, spinning([0.0, 0.0, 300.0]), None),
    ] {
        let scenario = Arc::new(block(above, &rest));
        let found = predictability(&scenario, Clock::end_s(&scenario));
        assert_eq!(found.unstable, expected, "{above} {rest}: {found:?}");
    }
}

#[test]
fn a_sleeping_top_is_stable() {
    for (times, is_unstable) in [(0.5, true), (0.99, true), (1.01, false), (2.0, false)] {
        let momentum = format!("start.momentum_Js=[0,0,{}]", 35.967 * times);
        let set = [
            "start.tilt_deg=0",
            momentum.as_str(),
            "motion.steps=20000",
            "motion.time_step_s=0.01",
        ];
        let scenario = Arc::new(preset("sleeping-unstable", &set));
        let found = predictability(&scenario, Clock::end_s(&scenario));
        assert_eq!(found.unstable.is_some(), is_unstable, "{times}: {found:?}");
        assert_eq!(found.until_s.is_some(), is_unstable, "{times}: {found:?}");
    }
}

#[test]
fn a_push_ends_the_balance_and_restores_the_verdict() {
    let push = "push.0={point='top',force_N=[1,0,0],from_s=1,for_s=0.1}";
    let mut document = gyrolab::engine::scenario::Document::parse("x.toml", UPRIGHT).unwrap();
    for set in [
        push,
        "motion.scheme=exact",
        "motion.time_step_s=0.1",
        "motion.steps=60",
    ] {
        document.set(set).unwrap();
    }
    let scenario = document.scenario().unwrap();
    let health = health_at(&scenario, scenario.steps);
    assert_eq!(health.predictability, Default::default());
    assert_eq!(health.is_believed(), Some(true));
}

#[test]
fn readouts_state_the_predictable_time() {
    let scenario = resampled(&parse(PUSHED), 0.43, find_scheme("exact"));
    let read = |run: &Scenario, name| {
        let values = at_end(run.clone(), &[find(name).unwrap()], &|| true);
        values.unwrap().unwrap().remove(0)
    };
    let until_s = read(&scenario, "predictable_until_s").number().unwrap();
    assert!(until_s > 1.0 && until_s < 200.0, "{until_s}");
    assert_eq!(read(&scenario, "reliable"), ReadoutValue::Flag(false));
    assert_eq!(read(&scenario, "distance_m"), ReadoutValue::Nothing);
    let short = Scenario {
        steps: 10,
        ..scenario
    };
    assert_eq!(read(&short, "predictable_until_s"), ReadoutValue::Nothing);
    assert_eq!(read(&short, "reliable"), ReadoutValue::Flag(true));
}

#[test]
fn the_distance_from_the_exact_motion_is_null_beyond_the_predictable_time() {
    let scenario = Arc::new(resampled(&parse(PUSHED), 0.05, find_scheme("rk4")));
    let until_s = until_s(PUSHED).unwrap();
    let mut simulation = Simulation::new(Arc::clone(&scenario));
    let mut meter = DistanceMeter::new(&scenario);
    let mut unknown = 0;
    while simulation.step_number() < scenario.steps && simulation.step().is_ok() {
        let state = simulation.now().after();
        let distance_m = meter.distance_m(state);
        assert_eq!(
            distance_m.is_some(),
            state.time_s <= until_s,
            "{}",
            state.time_s
        );
        unknown += u32::from(distance_m.is_none());
    }
    assert!(unknown > 0, "{until_s}");
}

#[test]
fn a_comparison_covers_only_the_predictable_time() {
    let scenario = parse(TOP);
    let rows = compare(&scenario, &[find_scheme("srkn11b")], &[0.002], |_, _| {
        ControlFlow::Continue(())
    })
    .unwrap();
    assert!(
        rows[0].error_m.unwrap() < 0.01 * scenario.arm_m(),
        "{rows:?}"
    );
    let table = ComparisonTable {
        rows: &rows,
        energy_unit: None,
        predictability: predictability(&Arc::new(scenario.clone()), Clock::end_s(&scenario)),
    };
    has(table.to_string(), UNPREDICTABLE);
    let json = table.json("x", 1.0, "exact").unwrap();
    assert!(json["predictable_until_s"].as_f64().is_some());
}

#[test]
fn the_lab_shows_that_the_motion_is_unpredictable() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("chaotic.toml");
    std::fs::write(&path, PUSHED).unwrap();
    let set = ["motion.scheme=exact"];
    let mut stage = Stage::open(path.to_str().unwrap(), &set, LARGE);
    stage.commands("pause = true\ngo_to = 159").wait(1.0);
    stage
        .shows("PREDICTABLE to t = ")
        .shows("no computation can predict the motion");
}
