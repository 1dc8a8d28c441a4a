//! Messages of the lab and the summary that newcomers misunderstood before.

use crate::support::desk::Desk;
use crate::support::scenarios::preset;
use crate::support::stage::{LARGE, SMALL, Stage};
use crate::support::words::has;
use gyrolab::engine::analysis::Monitor;
use gyrolab::engine::analysis::health::Health;
use gyrolab::engine::analysis::verdict::{Verdict, VerdictWord};
use gyrolab::engine::run::Simulation;
use gyrolab::engine::scenario::Document;
use gyrolab::lab::command;
use gyrolab::tui::keymap::Key;
use std::ops::ControlFlow;
use std::sync::Arc;
use std::time::Duration;

/// Returns the verdict at the end of the run of `scenario` with `set`.
fn health(scenario: &str, set: &[&str]) -> Health {
    let mut simulation = Simulation::new(Arc::new(preset(scenario, set)));
    let mut monitor = Monitor::new(simulation.now());
    let end = simulation.scenario().steps;
    while simulation.step_number() < end && simulation.step().is_ok() {
        monitor.record(simulation.now());
    }
    monitor.health(simulation.now())
}

/// Waits until the search for advice has ended.
fn wait_for_advice(stage: &Stage) {
    while stage.lab.adviser().is_seeking() {
        std::thread::sleep(Duration::from_millis(5));
    }
}

/// Returns the long form of the reasons of the verdict on a run.
fn reasons(scenario: &str, set: &[&str]) -> Vec<String> {
    let verdict = Verdict::new(&health(scenario, set));
    verdict.reasons.into_iter().map(|it| it.long).collect()
}

#[test]
fn the_verdict_names_a_damped_nutation() {
    let reasons = reasons("cusps", &["motion.scheme=report"]);
    assert_eq!(reasons[0], "nutation damped by 0.00441 % per step");
}

#[test]
fn a_lost_nutation_does_not_contradict_the_opening_words() {
    let health = health("fast-top", &["motion.scheme=report"]);
    let sentence = health.sentence(None);
    let begin = "The traced point is right, but not the nutation";
    assert!(sentence.starts_with(begin), "{sentence}");
}

#[test]
fn the_verdict_on_an_unreliable_run_states_turns_and_distance() {
    let verdict = Verdict::new(&health("method-2", &[]));
    assert_eq!(verdict.word, VerdictWord::Badge("NOT RELIABLE".to_owned()));
    let [turns, distance] = &verdict.reasons[..] else {
        panic!("{verdict:?}");
    };
    assert_eq!(
        turns.long,
        "wheel turns 4.97 times per step (under-sampled)"
    );
    assert_eq!(turns.short, "4.97 wheel turns per step");
    assert!(
        distance.long.ends_with(" m from the exact motion"),
        "{distance:?}"
    );
    assert!(distance.short.ends_with(" m off"), "{distance:?}");
}

/// From a tenth of a turn per step on, the wheel's ten points move to earlier positions of others. The run itself is right.
#[test]
fn a_wheel_that_looks_slow_does_not_make_a_run_unreliable() {
    let verdict = Verdict::new(&health("method-1", &[]));
    assert_eq!(verdict.word, VerdictWord::Reliable);
    assert_eq!(
        verdict.reasons[0].long,
        "within 8.2e-6 m of the exact motion"
    );
    let hint = verdict.hint.unwrap().long;
    assert_eq!(hint, "the wheel looks slow: it is seen once per step");
    let exact = Verdict::new(&health("fast-top", &["motion.scheme=exact"]));
    assert_eq!(exact.reasons[0].long, "the run is the exact motion");
}

#[test]
fn non_finite_numbers_are_reported_with_a_remedy() {
    let begin = "the numbers are no longer finite at step 3: ";
    let end = |edit: &str, is_advised: bool| {
        let mut stage = Stage::open("wobble-push", &["motion.scheme=rk4"], LARGE);
        if is_advised {
            stage.lab.take_advice();
        }
        stage.commands("pause = true");
        if !edit.is_empty() {
            stage.commands(edit);
        }
        stage.commands("go_to = 1").wait(0.1);
        while is_advised && stage.lab.adviser().advice().is_none() {
            std::thread::sleep(Duration::from_millis(5));
            stage.wait(0.0);
        }
        stage.commands("go_to = 20").wait(1.0);
        stage.lab.notice().unwrap_or_default()
    };
    let cure = "a: rerun with srkn11b, dt 0.01 s";
    let back = ", u undoes the last edit";
    let edit = "set = { 'motion.gravity_m_per_s2' = 9 }";
    assert_eq!(end("", true), format!("{begin}{cure}"));
    assert_eq!(end(edit, true), format!("{begin}{cure}{back}"));
    let may = "try a shorter time step or another scheme (e)";
    assert_eq!(end("", false), format!("{begin}{may}"));
    assert_eq!(end(edit, false), format!("{begin}{may}{back}"));
}

/// The search starts when the run has broken down, and its result appears in the row of the verdict.
#[test]
fn advice_on_a_broken_run_appears_as_soon_as_it_is_found() {
    let mut stage = Stage::open("wobble-push", &["motion.scheme=rk4"], LARGE);
    stage.lab.take_advice();
    stage.commands("pause = true");
    stage.commands("go_to = 2000").wait(0.1);
    stage.shows("no longer finite at step 3: try a shorter time step or another scheme (e)");
    wait_for_advice(&stage);
    stage.wait(0.1).shows("a: rerun with srkn11b, dt 0.01 s");
}

/// A paused run is not read again by itself, so the search must start as soon as it is allowed.
#[test]
fn the_search_for_advice_starts_in_a_lab_opened_paused() {
    let mut stage = Stage::open("wobble-push", &[], SMALL);
    stage.commands("pause = true");
    stage
        .lab
        .begin_at(300, |_, _| ControlFlow::Continue(()))
        .unwrap();
    stage.lab.take_advice();
    assert!(stage.lab.adviser().is_seeking());
    wait_for_advice(&stage);
    stage.wait(0.1).shows("a: dt 0.002 s");
}

#[test]
fn advice_equal_to_the_current_time_step_reruns_from_the_start() {
    let mut stage = Stage::open("wobble-push", &[], LARGE);
    stage.commands("pause = true\ngo_to = 300\nset = { 'motion.time_step_s' = 0.002 }");
    stage.lab.take_advice();
    wait_for_advice(&stage);
    stage
        .wait(0.1)
        .shows("a: rerun with dt 0.002 s from the start");
}

#[test]
fn warnings_of_figures_in_the_lab_name_its_keys() {
    let folder = tempfile::tempdir().unwrap();
    let mut stage = Stage::open("wobble-push", &[], LARGE);
    stage.lab.files_mut().work_in(folder.path());
    stage.commands("pause = true\ngo_to = 900\nfigure = 'run.svg'");
    while stage.lab.files().is_exporting() {
        std::thread::sleep(Duration::from_millis(5));
        stage.wait(0.1);
    }
    stage.shows("off the exact motion; t, then X draws");
    stage.shows_no("--exact");
}

#[test]
fn positions_of_a_broken_scheme_are_not_shown() {
    let mut stage = Stage::open("wobble-push", &["motion.scheme=rk4"], LARGE);
    stage.commands("go_to = 20").wait(1.0);
    stage
        .shows("rk4 breaks down at this time step: the body is deformed")
        .shows("tilt °                         –")
        .shows("x m                            –")
        .shows_no("0.0000 times per step");
    let health = health("wobble-push", &["motion.scheme=rk4"]);
    let short = &Verdict::new(&health).reasons[0].short;
    has(short, "rk4 breaks down");
    let sentence = health.sentence(None);
    has(&sentence, "the scheme rk4 breaks down");
}

#[test]
fn space_pauses_and_resumes_commands() {
    let read = |text: &str| command::read(&Document::parse("demo.toml", text).unwrap()).unwrap();
    let mut desk = Desk::open("method-2");
    let commands = "[[do]]\nrun_until = \"t_s >= 50\"\n[[do]]\nstep = 7";
    desk.lab.take_commands(read(commands));
    desk.pass(Duration::from_millis(100));
    desk.press(&[Key::Char(' ')]);
    let paused = desk.step();
    assert!(paused < 500);
    assert_eq!(
        desk.lab.notice().unwrap(),
        "paused: 2 commands of demo.toml are left: space continues, Esc drops them"
    );
    desk.pass(Duration::from_secs(1));
    assert_eq!((desk.step(), desk.lab.script().count()), (paused, 2));
    desk.press(&[Key::Char(' ')]);
    (0..40).for_each(|_| desk.pass(Duration::from_secs(1)));
    assert_eq!((desk.step(), desk.lab.script().is_done()), (507, true));
    // Esc drops the commands that space has paused.
    desk.lab.take_commands(read(commands));
    desk.press(&[Key::Char('r'), Key::Char(' '), Key::Esc]);
    assert!(desk.lab.script().is_done());
}

#[test]
fn a_pause_keeps_the_remaining_wait_and_playback() {
    let mut desk = Desk::open("method-2");
    let commands = "[[do]]\nrun = true\n[[do]]\nwait_s = 3\n[[do]]\nstep = 7";
    desk.lab
        .take_commands(command::read(&Document::parse("demo.toml", commands).unwrap()).unwrap());
    desk.pass(Duration::from_secs(1));
    desk.press(&[Key::Char(' ')]);
    let paused = desk.step();
    desk.pass(Duration::from_secs(10));
    assert_eq!((desk.step(), desk.lab.script().count()), (paused, 2));
    desk.press(&[Key::Char(' ')]);
    desk.pass(Duration::from_secs(1));
    assert!(desk.step() > paused, "the run plays again");
    assert!(
        !desk.lab.script().is_done(),
        "one second of the wait remains"
    );
    desk.pass(Duration::from_secs(2));
    assert!(desk.lab.script().is_done());
}

#[test]
fn terms_on_the_screen_are_explained_in_the_help() {
    for (word, meaning) in [
        ("window", "the time that the strips of the traces show"),
        ("other run", "the previous run, or the pinned one"),
        ("pinned", "the run that i keeps"),
        ("steady", "in steady precession"),
        ("═", "a push, an edit"),
        ("×20", "the playback speed"),
        ("kappa", "I3/I1"),
        ("bright", "the path in the window"),
        ("dashes", "the exact motion beside the run"),
        ("dotted", "the previous run"),
    ] {
        let mut stage = Stage::open("method-2", &[], LARGE);
        stage.press("?").press(word).shows(meaning);
    }
    Stage::open("method-2", &[], LARGE)
        .press("?zoom in on")
        .shows("(from above)")
        .shows("(3-D)");
}

#[test]
fn undo_names_the_run_that_it_restores() {
    let mut stage = Stage::open("method-2", &[], LARGE);
    stage.commands("pause = true\ngo_to = 10\nset = { 'start.tilt_deg' = 30 }");
    stage.press("u");
    let words = "undone: this is the previous run; U redoes it";
    assert_eq!(stage.lab.notice().as_deref(), Some(words));
}

#[test]
fn a_wrong_number_in_the_export_is_reported_once() {
    let mut stage = Stage::open("method-2", &[], LARGE);
    stage.commands("pause = true\ngo_to = 10");
    stage.press("xabc");
    stage.press("\t0\n");
    let picture = stage.picture();
    assert_eq!(picture.matches("every must be").count(), 1, "{picture}");
}

#[test]
fn a_count_that_is_too_large_is_reported() {
    Stage::open("method-2", &[], LARGE)
        .press("99999999999")
        .shows("999999999 is the largest count");
}

#[test]
fn a_missing_precession_is_shown_as_none() {
    Stage::open("method-1", &[], LARGE)
        .commands("pause = true\ngo_to = 1000")
        .wait(1.0)
        .shows("precession °/s              none       none")
        .press("?precession none")
        .shows("goes round L and not round z");
}
