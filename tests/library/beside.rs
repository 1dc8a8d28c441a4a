//! Runs side by side: what an edit plays the run to, what stays as the run before, and the pinned run.

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

/// The end of the run before, s.
fn ghost_s(lab: &Lab) -> Option<f64> {
    lab.comparison().ghost().map(Ghost::end_s)
}

#[test]
fn an_edit_of_body_or_start_is_played_to_the_same_time() {
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
fn an_edit_at_step_0_is_played_as_far_as_the_run_was() {
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
        // The journal is as it was: the entry stands at step 0, and undo goes there.
        desk.commands("undo = 1");
        assert_eq!(desk.step(), 0, "{set}");
    }
}

#[test]
fn an_edit_of_a_push_at_step_0_is_played_too_and_a_push_given_is_not() {
    let mut desk = Desk::open("wobble-push");
    desk.commands("go_to = '20 s'\ngo_to = 'start'\nset = { 'push.0.force_N.2' = -50 }");
    assert_eq!(time_s(&desk), 20.0);
    desk.commands("go_to = 'start'\npush = true");
    assert_eq!(desk.step(), 0);
}

#[test]
fn an_edit_of_motion_later_on_acts_from_there() {
    let mut desk = Desk::open("method-2");
    desk.commands("go_to = '40 s'\nset = { 'motion.gravity_m_per_s2' = 5 }");
    assert_eq!((desk.step(), ghost_s(&desk.lab)), (400, None));
    assert_eq!(desk.scenario().file.edit[0].step, 400);
}

#[test]
fn nudges_that_follow_each_other_keep_the_first_ones_time_and_ghost() {
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
fn nudges_of_a_running_lab_come_back_to_the_first_ones_time_and_go_on() {
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
fn a_hundred_thousand_steps_are_played_before_the_next_frame() {
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
fn a_longer_way_is_gone_in_parts_while_keys_are_answered() {
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
    // A session that is kept now is on its way there.
    let kept = stage.lab.content(&Default::default()).place;
    assert!(kept.contains(&format!("step = {stood}\n")), "{kept}");
    // One more nudge under way goes to the same time.
    stage.commands("nudge = { key = 'start.tilt_deg', times = 1 }");
    assert_eq!(ghost_s(&stage.lab), Some(stood as f64 * 0.1));
    while stage.lab.player().steps_to_go().is_some() {
        stage.wait(0.0);
    }
    assert!(stage.lab.player().is_running());
    assert!((stood..stood + 200_000).contains(&stage.step()));
    // Esc stops on the way.
    stage.commands("pause = true\nset = { 'start.tilt_deg' = 20 }");
    stage.press("\u{1b}").shows("stopped with");
    let stopped = stage.step();
    stage.wait(1.0);
    assert_eq!(stage.step(), stopped);
    // The run that was left on its way is one undo away.
    stage.commands("undo = 1");
    let bound_for = stage.step() + stage.lab.player().steps_to_go().unwrap_or(0);
    assert!(bound_for >= stood);
}

#[test]
fn the_pinned_run_stays_until_it_is_unpinned() {
    let mut stage = Stage::open("method-2", &[], LARGE);
    stage.commands("pause = true\ngo_to = '10 s'");
    stage.press("i").shows("this run is pinned");
    // It is recorded while it is played on.
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
fn a_pinned_run_that_is_edited_is_kept_as_it_was() {
    let mut desk = Desk::open("method-2");
    desk.commands("go_to = '40 s'\npin = true\ngo_to = '20 s'");
    desk.commands("set = { 'motion.gravity_m_per_s2' = 0 }\ngo_to = '30 s'");
    let pinned = desk.lab.comparison().pinned().unwrap();
    assert_eq!(pinned.end_s(), 40.0);
    assert!(desk.lab.comparison().ghost().is_none());
    desk.press(&[Key::Char('i')]);
    assert!(!desk.lab.comparison().is_pinned());
}

/// The row of the verdict.
fn verdict(stage: &Stage) -> String {
    let row = screen::layout(&stage.lab, true, stage.size).verdict.y;
    let picture = stage.picture();
    picture.lines().nth(row.into()).unwrap().to_owned()
}

/// Waits until the search for advice, which goes on in the background, has found some.
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
fn advice_is_taken_by_one_key() {
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
fn undo_takes_the_advice_back_before_an_earlier_edit() {
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
fn advice_that_takes_the_place_of_an_edit_says_so() {
    let mut stage = Stage::open("method-2", &[], SMALL);
    stage.commands("pause = true\ngo_to = 200\nset = { 'motion.scheme' = 'rk4' }\ngo_to = '40 s'");
    stage.press("a").wait(0.1);
    stage.shows("in place of the edits of the scheme");
    assert!(stage.lab.player().run().scenario().edits.is_empty());
}

#[test]
fn advice_that_has_come_is_taken_at_once() {
    let mut stage = Stage::open("method-2", &[], LARGE);
    stage.lab.take_advice();
    stage.commands("pause = true\ngo_to = '40 s'");
    while stage.lab.adviser().advice().is_none() {
        std::thread::sleep(std::time::Duration::from_millis(10));
    }
    // The key comes before the lab has looked whether there is news.
    stage.press("a").shows("from the start");
}

#[test]
fn advice_is_taken_by_a_command_and_holds() {
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
fn accumulating_pushes_offer_no_other_time_step() {
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
fn the_line_about_the_numbers_is_right_as_soon_as_an_edit_is_made() {
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
fn advice_on_an_edited_time_step_is_for_the_whole_run() {
    let mut desk = Desk::open("method-1");
    desk.commands("set = { 'body.rim.height_m' = 1.0 }\ngo_to = '0.2 s'");
    // From step 0 on: the scenario's number of steps then makes a hundredth of its seconds.
    desk.commands("go_to = 0\nset = { 'motion.time_step_s' = 1e-5 }\ngo_to = '0.2 s'");
    assert_eq!(is_believed(&desk), Some(false));
    desk.commands("take_advice = true");
    assert_eq!(time_s(&desk), 0.2);
    assert_ne!(is_believed(&desk), Some(false));
}

#[test]
fn an_exact_motion_that_would_take_too_long_is_left_out_and_said() {
    let set = ["motion.time_step_s=1e6", "view.exact=true"];
    let mut stage = Stage::open("wing-nut", &set, LARGE);
    stage.commands("pause = true").shows("NO EXACT MOTION");
    assert!(stage.lab.player().run().overlay().is_none());
    let words = "its exact motion must be integrated, which would take too long for 4000000000 s: it is not shown";
    stage.press("tt").shows(words);
    // It is drawn again where it can be.
    stage.commands("set = { 'motion.time_step_s' = 0.01 }\nstep = 3");
    assert!(stage.lab.player().run().overlay().is_some());
    stage.shows("off exact (m)");
}

#[test]
fn the_exact_motion_ends_where_it_is_no_number() {
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
