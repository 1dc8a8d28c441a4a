//! Scenarios saved from the current state of a run: they continue it.

use crate::support::scenarios::{parse, preset};
use crate::support::words::has;
use gyrolab::engine::journal::restart::{in_force, scenario_from};
use gyrolab::engine::run::Simulation;
use gyrolab::engine::scenario::{Document, Scenario};
use gyrolab::physics::State;
use gyrolab::physics::observables::position;
use proptest::prelude::*;
use std::sync::Arc;
use toml::Table;

/// A scenario of a ring with a top; `lump` is a mass off the axle, kg.
fn text(scheme: &str, lump: f64, start: &str, more: &str) -> String {
    format!(
        "title = 'x'\nabout = 'y'\n[body.rim]\npoints = 7\nradius_m = 0.8\nheight_m = 1\npoint_mass_kg = 0.5\n[[body.point]]\nname = 'top'\nat_m = [0, 0, 1.5]\n[[body.point]]\nname = 'side'\nat_m = [0.4, 0.2, 0.7]\nmass_kg = {lump}\n[start]\n{start}\n[motion]\nscheme = '{scheme}'\ntime_step_s = 0.05\nsteps = 400\n{more}\n"
    )
}

fn read(text: &str) -> Arc<Scenario> {
    Arc::new(parse(text))
}

fn at(scenario: &Arc<Scenario>, step: u64) -> Simulation {
    let mut simulation = Simulation::new(Arc::clone(scenario));
    simulation.step_to(step).unwrap();
    simulation
}

fn saved_here(simulation: &Simulation) -> Result<Scenario, String> {
    let (state, step) = (simulation.state(), simulation.step_number());
    scenario_from(simulation.scenario(), state, step).map_err(|problems| problems.to_string())
}

/// Returns the largest distance of the traced point between `run` and the saved scenario over the next `steps`, m.
fn farthest_m(mut run: Simulation, steps: u64) -> f64 {
    let saved = saved_here(&run).unwrap();
    // Uses the scenario as written to a file.
    let mut saved = Simulation::new(read(&saved.to_toml()));
    let point = |state: &State, scenario: &Scenario| {
        position(&scenario.body.mechanics, state, scenario.trace)
    };
    let mut farthest = 0.0f64;
    for _ in 0..steps {
        run.step().unwrap();
        saved.step().unwrap();
        let there = point(run.state(), run.scenario());
        farthest = farthest.max((point(saved.state(), saved.scenario()) - there).norm());
    }
    farthest
}

const UPRIGHT: &str = "momentum_Js = [0, 1, 60]";
const PUSHES: &str = "[[push]]\npoint = 'top'\nforce_N = [3, -1, 2]\nfirst_step = 20\nsteps = 60
[[push]]\npoint = 'top'\nforce_N = [0, 2, 0]\nfrom_s = 2.52\nfor_s = 1.51
[[push]]\npoint = 'side'\nforce_N = [1, 0, 0]\nfirst_step = 2\nsteps = 3
";
const EDITS: &str = "[[edit]]\nstep = 12\nset = { 'motion.time_step_s' = 0.03 }
[[edit]]\nstep = 30\nset = { 'motion.gravity_m_per_s2' = 7.0, 'push.1.force_N' = [0, 4, 0] }
";

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, cases: 48, ..ProptestConfig::default() })]
    #[test]
    fn the_saved_scenario_continues_the_run(
        tilt in 0.0..180.0f64,
        momentum in prop::array::uniform3(-40.0..40.0f64),
        lump in prop_oneof![Just(0.0), 0.1..2.0f64],
        step in 0u64..120,
        more in prop_oneof![Just(String::new()), Just(PUSHES.to_owned()), Just(format!("{PUSHES}{EDITS}"))],
    ) {
        let start = format!("tilt_deg = {tilt:?}\nmomentum_Js = {momentum:?}\nturn_deg = 33");
        let edited = step < 30 && more.contains("edit");
        let exact = read(&text("exact", lump, &start, &more));
        // Later edits are not saved.
        prop_assume!(!edited);
        prop_assert!(farthest_m(at(&exact, step), 100) < 1e-9);
        let report = read(&text("report", lump, &start, &more));
        prop_assert!(farthest_m(at(&report, step), 20) < 1e-9);
    }
}

#[test]
fn the_saved_scenario_continues_the_run_near_the_vertical() {
    for tilt in [0.0, 1e-9, 1e-5, 180.0, 179.99999] {
        let start =
            format!("tilt_deg = {tilt:?}\nmomentum_Js = [0, 0, 60]\nmomentum_frame = 'body'");
        for (lump, scheme) in [(0.0, "exact"), (0.0, "report"), (0.0, "rk4")] {
            let run = at(&read(&text(scheme, lump, &start, "")), 50);
            let farthest = farthest_m(run, 20);
            assert!(farthest < 1e-9, "{tilt} {scheme}: {farthest}");
        }
    }
}

#[test]
fn the_saved_scenario_has_a_new_title_and_omits_past_pushes() {
    let view = format!(
        "{PUSHES}[view]\nspeed = 5\nlook_at = 'z'\n[[expected]]\nreadout = 'z_m'\nat_step = 3\nvalue = 1\ntolerance = 9\n"
    );
    let run = at(&read(&text("rk4", 0.0, UPRIGHT, &view)), 42);
    let saved = saved_here(&run).unwrap();
    let file = &saved.file;
    assert_eq!(file.title, "x, from t = 2.1 s");
    assert_eq!((&file.about, file.motion.steps), (&None, 400));
    assert!(file.expected.is_empty());
    let kept = file.view.as_ref().unwrap();
    assert_eq!(
        *kept,
        Table::from_iter([("speed".to_owned(), 5.0.into())]).into()
    );
    // Steps 20 to 79 last until t = 3.95 s; the last push has ended.
    let expected = [(0.0, 3.95 - 2.1), (2.52 - 2.1, 1.51)];
    assert_eq!(file.push.len(), 2);
    for (push, (from_s, for_s)) in file.push.iter().zip(expected) {
        assert!((push.from_s.unwrap() - from_s).abs() < 1e-12, "{push:?}");
        assert!((push.for_s.unwrap() - for_s).abs() < 1e-12, "{push:?}");
    }
}

#[test]
fn view_settings_are_written_in_key_order_with_floats() {
    let view = "\n[view]\nspeed = 20.0\nlook_at = \"l\"\nexact = true\nshow = [\"traces\"]\nphase = 3\nbare = false\n\
        \n[view.camera]\nyaw_deg = 3.0\npitch_deg = 20.0\n\n[view.zoom]\nabove = 4.0\n3d = 2.0\n";
    let mut document = Document::parse("x.toml", &text("rk4", 0.0, UPRIGHT, view)).unwrap();
    assert!(document.scenario().unwrap().to_toml().ends_with(view));
    document.set("view.speed=20").unwrap();
    assert!(document.scenario().unwrap().to_toml().ends_with(view));
}

#[test]
fn pushes_in_steps_stay_in_steps_at_the_start() {
    let scenario = read(&text("report", 0.0, UPRIGHT, PUSHES));
    let pushes = saved_here(&at(&scenario, 0)).unwrap().file.push;
    let steps = (pushes[0].first_step, pushes[0].steps);
    assert_eq!(steps, (Some(20), Some(60)));
    assert_eq!(pushes[1].from_s, Some(2.52));
}

#[test]
fn an_accumulating_push_can_be_moved_only_before_it_starts() {
    let push = "[[push]]\npoint = 'top'\nforce_N = [0, 0.1, 0]\nfirst_step = 20\nsteps = 6\naccumulates = true\n";
    let scenario = read(&text("report", 0.0, UPRIGHT, push));
    let moved = saved_here(&at(&scenario, 5)).unwrap().file.push;
    assert_eq!(moved[0].first_step, Some(15));
    assert!(farthest_m(at(&scenario, 19), 20) < 1e-9);
    for step in [20, 21, 300] {
        let refused = saved_here(&at(&scenario, step)).unwrap_err();
        has(&refused, "push.0: on \"top\" accumulates and has begun");
    }
    let edits = EDITS.replace("'push.1.force_N'", "'push.0.force_N'");
    let edited = read(&text("report", 0.0, UPRIGHT, &format!("{push}{edits}")));
    has(
        saved_here(&at(&edited, 13)).unwrap_err(),
        "steps of a different length",
    );
}

#[test]
fn forces_and_settings_in_force_include_edits() {
    let more = format!("{PUSHES}{EDITS}");
    let run = read(&text("exact", 0.0, UPRIGHT, &more));
    let force = |step| in_force(&run, step).1[1].force.y;
    assert_eq!((force(29), force(30)), (2.0, 4.0));
    let time_step_s = |step| in_force(&run, step).0.time_step_s;
    assert_eq!((time_step_s(11), time_step_s(12)), (0.05, 0.03));
}

#[test]
fn the_saved_scenario_lasts_as_long_at_an_edited_time_step() {
    let edit = "edit=[{step=50, set={\"motion.time_step_s\"=0.01}}]";
    let scenario = Arc::new(preset("method-2", &[edit]));
    let run = at(&scenario, 60);
    let saved = scenario_from(&scenario, run.state(), 60).unwrap();
    assert_eq!((saved.motion.time_step_s, saved.steps), (0.01, 23_000));
}
