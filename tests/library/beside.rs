//! Comparison of runs: the rerun after an edit, the previous run, the pinned run, and advice.

use crate::support::desk::Desk;
use crate::support::stage::{LARGE, SMALL, Stage};
use crate::support::words::has;
use gyrolab::lab::Lab;
use gyrolab::lab::playback::ghost::Ghost;
use gyrolab::tui::keymap::Key;
use gyrolab::tui::screen;

fn time_s(desk: &Desk) -> f64 {
    desk.lab.player().run().now().time_s
}

fn is_believed(desk: &Desk) -> Option<bool> {
    desk.lab.player().reading.readouts.health.is_believed()
}

/// The end of the previous run, s.
fn ghost_s(lab: &Lab) -> Option<f64> {
    lab.comparison().ghost().map(Ghost::end_s)
}

#[test]
fn editing_body_or_start_reruns_to_the_same_time() {
    let mut desk = Desk::open("method-2");
    desk.commands("go_to = '40 s'\nset = { 'start.tilt_deg' = 40 }");
    assert_eq!((desk.step(), time_s(&desk)), (400, 40.0));
    assert_eq!(ghost_s(&desk.lab), Some(40.0));
    desk.commands("set = { 'body.rim.radius_m' = 0.7 }");
    assert_eq!(desk.step(), 400);
    assert_eq!(desk.lab.player().run().recording().samples(), 401);
    desk.commands("undo = 1");
    assert_eq!(desk.step(), 400);
    assert_eq!(desk.scenario().file.start.tilt_deg, Some(40.0));
}

#[test]
fn an_edit_at_step_0_reruns_to_the_end_of_the_old_run() {
    for (set, step) in [
        ("'motion.gravity_m_per_s2' = 5", 400),
        ("'motion.time_step_s' = 0.05", 800),
        ("'motion.time_step_s' = 0.03", 1333),
        ("'motion.scheme' = 'exact'", 400),
        ("'start.tilt_deg' = 30", 400),
    ] {
        let mut desk = Desk::open("method-2");
        desk.commands("go_to = '40 s'\ngo_to = 'start'");
        desk.commands(&format!("set = {{ {set} }}"));
        assert_eq!(desk.step(), step, "{set}");
        assert!((time_s(&desk) - 40.0).abs() < 0.015, "{set}");
        assert_eq!(ghost_s(&desk.lab), Some(40.0), "{set}");
        // The journal entry still belongs to step 0, and undo returns there.
        desk.commands("undo = 1");
        assert_eq!(desk.step(), 0, "{set}");
    }
}

#[test]
fn editing_a_push_at_step_0_reruns_but_adding_one_does_not() {
    let mut desk = Desk::open("wobble-push");
    desk.commands("go_to = '20 s'\ngo_to = 'start'\nset = { 'push.0.force_N.2' = -50 }");
    assert_eq!(time_s(&desk), 20.0);
    desk.commands("go_to = 'start'\npush = true");
    assert_eq!(desk.step(), 0);
}

#[test]
fn a_later_edit_of_motion_takes_effect_from_its_step() {
    let mut desk = Desk::open("method-2");
    desk.commands("go_to = '40 s'\nset = { 'motion.gravity_m_per_s2' = 5 }");
    assert_eq!((desk.step(), ghost_s(&desk.lab)), (400, None));
    assert_eq!(desk.scenario().file.edit[0].step, 400);
}

#[test]
fn consecutive_nudges_keep_the_time_and_the_previous_run() {
    let mut desk = Desk::open("method-2");
    desk.commands("go_to = '40 s'\ngo_to = 'start'");
    for times in [1, 1, -3, 10] {
        let key = "motion.gravity_m_per_s2";
        desk.commands(&format!("nudge = {{ key = '{key}', times = {times} }}"));
        assert_eq!((desk.step(), ghost_s(&desk.lab)), (400, Some(40.0)));
        assert_eq!(
            desk.lab
                .comparison()
                .ghost()
                .map(|ghost| ghost.recording.samples()),
            Some(401)
        );
    }
    let edits = desk.scenario().file.edit;
    assert!(edits.iter().all(|edit| edit.step == 0), "{edits:?}");
    let gravity = desk.lab.player().motion().gravity;
    assert!((gravity - 10.7).abs() < 1e-9, "{gravity}");
    desk.commands("undo = 1");
    assert_eq!(desk.step(), 0);
    assert_eq!(desk.lab.player().motion().gravity, 9.8);
}

#[test]
fn nudges_during_playback_rerun_to_their_time_and_continue() {
    let mut stage = Stage::open("method-2", &[], SMALL);
    stage.wait(2.0);
    let stood = stage.step();
    for _ in 0..3 {
        stage.commands("nudge = { key = 'start.tilt_deg', times = 1 }");
        assert_eq!(stage.step(), stood);
        assert!(stage.lab.player().is_running());
        stage.wait(0.3);
        assert!(stage.step() > stood);
    }
}

#[test]
fn reruns_of_100_000_steps_finish_within_a_frame() {
    let mut desk = Desk::open("method-2");
    desk.commands("go_to = 100000");
    let mut nudge = "nudge = { key = 'start.tilt_deg', times = 1 }\n".to_owned();
    for _ in 0..2 {
        for command in crate::support::desk::commands(&nudge) {
            desk.lab.carry_out(&command).unwrap();
            assert_eq!(desk.step(), 100_000);
        }
        nudge = nudge.replace("= 1", "= -2");
    }
}

#[test]
fn a_longer_rerun_is_interruptible_by_keys() {
    let mut stage = Stage::open("method-2", &[], SMALL);
    stage.commands("speed = 'top'\ngo_to = 600000").wait(1.0);
    while stage.lab.player().steps_to_go().is_some() {
        stage.wait(1.0);
    }
    stage.commands("run = true");
    let stood = stage.step();
    stage.commands("nudge = { key = 'start.tilt_deg', times = 1 }");
    let under_way = stage.step();
    assert!((100_000..stood).contains(&under_way), "{under_way}");
    stage.shows("playing the new run to the same time");
    // A session saved now continues toward that step.
    let kept = stage.lab.content(&Default::default()).place;
    assert!(kept.contains(&format!("step = {stood}\n")), "{kept}");
    // Another nudge during the rerun keeps the target time.
    stage.commands("nudge = { key = 'start.tilt_deg', times = 1 }");
    assert_eq!(ghost_s(&stage.lab), Some(stood as f64 * 0.1));
    while stage.lab.player().steps_to_go().is_some() {
        stage.wait(0.0);
    }
    assert!(stage.lab.player().is_running());
    assert!((stood..stood + 200_000).contains(&stage.step()));
    // Esc stops the rerun.
    stage.commands("pause = true\nset = { 'start.tilt_deg' = 20 }");
    stage.press("\u{1b}").shows("stopped with");
    let stopped = stage.step();
    stage.wait(1.0);
    assert_eq!(stage.step(), stopped);
    // One undo restores the interrupted run.
    stage.commands("undo = 1");
    let bound_for = stage.step() + stage.lab.player().steps_to_go().unwrap_or(0);
    assert!(bound_for >= stood);
}

#[test]
fn the_pinned_run_stays_until_it_is_unpinned() {
    let mut stage = Stage::open("method-2", &[], LARGE);
    stage.commands("pause = true\ngo_to = '10 s'");
    stage.press("i").shows("this run is pinned");
    // The pinned run is still recorded while it plays.
    stage.commands("go_to = '40 s'");
    assert!(stage.lab.comparison().pinned().is_none() && stage.lab.comparison().is_pinned());
    let pinned_s = |of: &Stage| of.lab.comparison().pinned().map(Ghost::end_s);
    for index in 0..100 {
        let tilt = 20 + index % 40;
        stage.commands(&format!("set = {{ 'start.tilt_deg' = {tilt} }}"));
    }
    assert_eq!(pinned_s(&stage), Some(40.0));
    stage.wait(6.0).shows("-- pinned run");
    for command in ["undo = 50", "redo = 7", "open = 'cusps'", "go_to = '1 s'"] {
        stage.commands(command);
        assert_eq!(pinned_s(&stage), Some(40.0), "{command}");
    }
    stage.shows("pinned").press("i").shows("unpinned");
    assert!(!stage.lab.comparison().is_pinned());
    stage.wait(6.0).shows_no("pinned");
}

#[test]
fn editing_the_pinned_run_keeps_the_pinned_version() {
    let mut desk = Desk::open("method-2");
    desk.commands("go_to = '40 s'\npin = true\ngo_to = '20 s'");
    desk.commands("set = { 'motion.gravity_m_per_s2' = 0 }\ngo_to = '30 s'");
    let pinned = desk.lab.comparison().pinned().unwrap();
    assert_eq!(pinned.end_s(), 40.0);
    assert!(desk.lab.comparison().ghost().is_none());
    desk.press(&[Key::Char('i')]);
    assert!(!desk.lab.comparison().is_pinned());
}

/// Returns the row of the verdict.
fn verdict(stage: &Stage) -> String {
    let row = screen::layout(&stage.lab, true, stage.size).verdict.y;
    let picture = stage.picture();
    picture.lines().nth(row.into()).unwrap().to_owned()
}

/// Waits until the background search has found advice.
fn wait_for_advice(stage: &mut Stage) {
    for _ in 0..6000 {
        if stage.wait(0.0).lab.adviser().advice().is_some() {
            return;
        }
        std::thread::sleep(std::time::Duration::from_millis(10));
    }
    panic!("no advice");
}

#[test]
fn one_key_applies_the_advice() {
    let mut stage = Stage::open("method-2", &[], LARGE);
    stage.lab.take_advice();
    stage.commands("pause = true\npush = { point = 'top', force_N = [0, 0, -100], for_s = 2 }");
    stage.commands("go_to = '40 s'");
    wait_for_advice(&mut stage);
    let line = verdict(&stage);
    assert!(line.contains("rerun with"), "{line}");
    stage.press("a");
    stage.shows("rerun from the start; u returns to the previous run");
    assert_eq!(stage.lab.player().run().now().time_s, 40.0);
    assert!(stage.lab.player().motion().time_step_s < 0.1);
    assert_eq!(stage.lab.player().run().scenario().file.push.len(), 1);
    assert_eq!(ghost_s(&stage.lab), Some(40.0));
    let mended = verdict(&stage);
    assert!(!mended.contains("rerun with"), "{mended}");
    stage.press("a").shows("nothing to fix");
    stage.press("u").wait(0.1);
    assert_eq!(stage.lab.player().motion().time_step_s, 0.1);
    assert_eq!(stage.step(), 400);
}

#[test]
fn undo_reverts_the_advice_before_an_earlier_edit() {
    let mut desk = Desk::open("method-2");
    desk.commands("go_to = 100\nset = { 'motion.gravity_m_per_s2' = 9 }\ngo_to = '40 s'");
    desk.commands("take_advice = true");
    let gravity = |of: &Desk| of.lab.player().motion().gravity;
    assert_eq!(gravity(&desk), 9.0);
    assert!(desk.lab.player().motion().time_step_s < 0.1);
    desk.press(&[Key::Char('u')]);
    desk.commands("run_until = 't_s >= 40'");
    let time_step_s = desk.lab.player().motion().time_step_s;
    assert_eq!((time_step_s, gravity(&desk)), (0.1, 9.0));
    desk.press(&[Key::Char('u')]);
    assert_eq!(gravity(&desk), 9.8);
}

#[test]
fn advice_that_replaces_edits_says_so() {
    let mut stage = Stage::open("method-2", &[], SMALL);
    stage.commands("pause = true\ngo_to = 200\nset = { 'motion.scheme' = 'rk4' }\ngo_to = '40 s'");
    stage.press("a").wait(0.1);
    stage.shows("in place of the edits of the scheme");
    assert!(stage.lab.player().run().scenario().edits.is_empty());
}

#[test]
fn available_advice_is_applied_at_once() {
    let mut stage = Stage::open("method-2", &[], LARGE);
    stage.lab.take_advice();
    stage.commands("pause = true\ngo_to = '40 s'");
    while stage.lab.adviser().advice().is_none() {
        std::thread::sleep(std::time::Duration::from_millis(10));
    }
    // The key arrives before the lab has polled for the result.
    stage.press("a").shows("from the start");
}

#[test]
fn a_command_applies_advice_that_makes_the_run_reliable() {
    let mut desk = Desk::open("wobble-push");
    desk.commands("go_to = '10 s'\ntake_advice = true");
    assert_eq!(time_s(&desk), 10.0);
    let health = &desk.lab.player().reading.readouts.health;
    assert_ne!(health.is_believed(), Some(false));
    let again = &crate::support::desk::commands("take_advice = true")[0];
    let refusal = desk.carry_out(again).unwrap_err().to_string();
    assert!(refusal.starts_with("nothing to fix"), "{refusal}");
}

#[test]
fn accumulating_pushes_get_no_advice_on_the_time_step() {
    let mut stage = Stage::open("wobble-push-accumulating", &[], LARGE);
    stage.lab.take_advice();
    stage.wait(1.0).commands("pause = true\ngo_to = 40");
    wait_for_advice(&mut stage);
    stage.shows_no("rerun with");
    stage.press("a").shows("no time step or scheme was found");
    let command = &crate::support::desk::commands("take_advice = true")[0];
    let refusal = stage.lab.carry_out(command).unwrap_err().to_string();
    has(&refusal, "no time step or scheme was found");
}

#[test]
fn the_verdict_is_updated_immediately_after_an_edit() {
    let mut stage = Stage::open("method-2", &[], LARGE);
    stage.lab.take_advice();
    stage.commands("pause = true\ngo_to = '40 s'");
    let is_doubted = |of: &Stage| {
        let health = &of.lab.player().reading.readouts.health;
        health.is_believed() == Some(false)
    };
    let finer = "go_to = 'start'\nset = { 'motion.time_step_s' = 0.05 }";
    for (edit, turns) in [
        ("set = { 'motion.time_step_s' = 0.02 }", "0.995"),
        ("undo = 1", "4.97"),
        ("set = { 'start.tilt_deg' = 80 }", "4.98"),
        ("undo = 1", "4.97"),
        (finer, "2.49"),
        ("undo = 1\ngo_to = '40 s'", "4.97"),
    ] {
        let turns = format!("wheel turns {turns} times per step");
        if is_doubted(&stage) {
            wait_for_advice(&mut stage);
        }
        stage.commands(edit);
        let line = verdict(&stage);
        assert!(line.contains(&turns), "{edit}: {line}");
        assert!(!line.contains("rerun with"), "{edit}: {line}");
    }
}

#[test]
fn advice_on_an_edited_time_step_covers_the_whole_run() {
    let mut desk = Desk::open("method-1");
    desk.commands("set = { 'body.rim.height_m' = 1.0 }\ngo_to = '0.2 s'");
    // From step 0 on, the scenario's number of steps covers only a hundredth of its duration.
    desk.commands("go_to = 0\nset = { 'motion.time_step_s' = 1e-5 }\ngo_to = '0.2 s'");
    assert_eq!(is_believed(&desk), Some(false));
    desk.commands("take_advice = true");
    assert_eq!(time_s(&desk), 0.2);
    assert_ne!(is_believed(&desk), Some(false));
}

#[test]
fn an_exact_motion_too_slow_to_compute_is_omitted_with_a_reason() {
    let set = ["motion.time_step_s=1e6", "view.exact=true"];
    let mut stage = Stage::open("wing-nut", &set, LARGE);
    stage.commands("pause = true").shows("NO EXACT MOTION");
    assert!(stage.lab.player().run().overlay().is_none());
    let words = "its exact motion must be integrated, which would take too long for 4000000000 s: it is not shown";
    stage.press("tt").shows(words);
    // It is drawn again as soon as it can be computed.
    stage.commands("set = { 'motion.time_step_s' = 0.01 }\nstep = 3");
    assert!(stage.lab.player().run().overlay().is_some());
    stage.shows("off exact (m)");
}

#[test]
fn the_exact_motion_ends_where_it_is_not_finite() {
    for set in [
        "friction.spin_viscous_Nms=1e10",
        "start.momentum_Js=[0,1e148,100]",
    ] {
        let mut stage = Stage::open("method-2", &[set, "view.exact=true"], LARGE);
        stage.commands("step = 50");
        stage.picture();
        let run = stage.lab.player().run();
        assert!(!run.overlay_is_behind(), "{set}");
    }
}
