//! Edits in the lab: they rerun with the new value to the same time.

use crate::support::desk::{Desk, commands};
use crate::support::stage::{SMALL, Stage};
use crate::support::words::has;
use gyrolab::engine::scenario::Scenario;
use gyrolab::lab::command::Command;
use gyrolab::lab::playback::ghost::Ghost;
use gyrolab::tui::keymap::Key;

/// Opens the preset `name` at `time`, paused.
fn desk_at(name: &str, time: &str) -> Desk {
    let mut desk = Desk::open(name);
    desk.commands(&format!("go_to = '{time}'"));
    desk
}

/// Selects the value `name`, types `text` into its field and presses `keys`.
fn edit(desk: &mut Desk, name: &str, text: &str, keys: &[Key]) {
    desk.type_text("/");
    desk.type_text(name);
    desk.press(&[Key::Enter]);
    desk.type_text(text);
    desk.press(keys);
    assert!(desk.lab.popups().dialog().is_none(), "{name} {text}");
    desk.press(&[Key::Esc, Key::Esc]);
}

fn time_s(desk: &Desk) -> f64 {
    desk.lab.player().run().now().time_s
}

fn previous_s(desk: &Desk) -> Option<f64> {
    desk.lab.comparison().ghost().map(Ghost::end_s)
}

fn time_step_s(scenario: &Scenario) -> f64 {
    scenario.motion.time_step_s
}

#[test]
fn dt_scheme_gravity_body_and_start_rerun_to_the_same_time() {
    for (name, text, step) in [
        ("dt", "0.05", 800),
        ("dt", "0.2", 200),
        ("scheme", "rk4", 2),
        ("gravity", "5", 400),
        ("tilt", "40", 400),
        ("rim radius", "0.7", 400),
    ] {
        let mut desk = desk_at("method-2", "40 s");
        edit(&mut desk, name, text, &[Key::Enter]);
        assert_eq!(desk.step(), step, "{name} {text}");
        let is_same_time = (time_s(&desk) - 40.0).abs() < 1e-9;
        assert!(is_same_time || desk.simulation().has_ended(), "{name}");
        assert_eq!(previous_s(&desk), Some(40.0), "{name}");
        assert!(desk.scenario().file.edit.is_empty(), "{name}");
        desk.commands("undo = 1");
        assert_eq!((desk.step(), time_s(&desk)), (400, 40.0), "{name}");
        desk.commands("redo = 1");
        assert_eq!(desk.step(), step, "{name}");
    }
}

#[test]
fn tab_in_the_field_applies_the_value_from_now_on() {
    let mut desk = desk_at("method-2", "40 s");
    edit(&mut desk, "dt", "0.05", &[Key::Tab, Key::Enter]);
    assert_eq!((desk.step(), previous_s(&desk)), (400, None));
    assert_eq!(desk.scenario().file.edit[0].step, 400);
    assert_eq!(desk.lab.player().motion().time_step_s, 0.05);
    // A second Tab switches back to the start.
    edit(&mut desk, "gravity", "5", &[Key::Tab, Key::Tab, Key::Enter]);
    assert_eq!(previous_s(&desk), Some(40.0));
    let file = desk.scenario().file;
    assert_eq!(file.motion.gravity_m_per_s2, Some(5.0));
    // The edit at the later step stays there.
    assert_eq!((file.edit.len(), file.edit[0].step), (1, 400));
}

#[test]
fn the_field_explains_enter_and_tab() {
    let mut stage = Stage::open("method-2", &[], SMALL);
    stage.wait(2.0).commands("pause = true");
    stage.press("/dt\n");
    stage
        .shows("Enter: rerun from the start")
        .shows("Tab: from now on");
    stage.press("\t").shows("Enter: from now on");
    stage.press("\u{1b}\u{1b}\u{1b}/tilt\n");
    stage
        .shows("Enter: rerun from the start")
        .shows_no("Tab: from");
}

#[test]
fn pushes_keep_their_times_in_a_rerun() {
    let mut desk = desk_at("method-2", "10 s");
    desk.commands("push = { force_N = [0, 0, -50], for_s = 2 }\ngo_to = '40 s'");
    edit(&mut desk, "dt", "0.05", &[Key::Enter]);
    let push = &desk.scenario().file.push[0];
    assert_eq!((push.from_s, push.for_s), (Some(10.0), Some(2.0)));
    assert_eq!(time_s(&desk), 40.0);
    // Pushes counted in steps keep their seconds, and so does the run.
    let mut pushed = desk_at("wobble-push", "40 s");
    let end_s = pushed.lab.player().end_s;
    edit(&mut pushed, "dt", "0.05", &[Key::Enter]);
    let by_steps = &pushed.scenario().file.push[0];
    assert_eq!((by_steps.from_s, by_steps.for_s), (Some(0.0), Some(20.0)));
    assert_eq!(pushed.lab.player().end_s, end_s);
}

#[test]
fn editing_a_push_of_the_scenario_reruns_from_the_start() {
    let mut desk = desk_at("wobble-push", "40 s");
    edit(&mut desk, "push fz", "-50", &[Key::Enter]);
    assert_eq!(desk.scenario().file.push[0].force_N[2], -50.0);
    assert_eq!((time_s(&desk), previous_s(&desk)), (40.0, Some(40.0)));
}

#[test]
fn an_accumulating_push_rejects_another_time_step_with_a_reason() {
    let mut desk = desk_at("wobble-push-accumulating", "2 s");
    let before = desk.scenario().file;
    desk.type_text("/dt");
    desk.press(&[Key::Enter]);
    desk.type_text("0.05");
    desk.press(&[Key::Enter]);
    let complaint = desk.lab.popups().dialog().unwrap().form.complaint.clone();
    has(complaint.unwrap(), "accumulates per step");
    assert_eq!(desk.scenario().file, before);
    desk.press(&[Key::Tab, Key::Enter]);
    assert_eq!(desk.lab.player().motion().time_step_s, 0.05);
}

#[test]
fn nudges_by_keys_rerun_and_are_undone_as_one() {
    let mut desk = desk_at("method-2", "40 s");
    desk.type_text("/gravity");
    desk.press(&[Key::Right, Key::Right, Key::Left, Key::Right]);
    assert_eq!(desk.lab.player().motion().gravity, 10.0);
    assert_eq!((desk.step(), previous_s(&desk)), (400, Some(40.0)));
    assert!(desk.scenario().file.edit.is_empty());
    desk.commands("undo = 1");
    assert_eq!(desk.lab.player().motion().gravity, 9.8);
    assert_eq!(desk.step(), 400);
    assert!(desk.carry_out(&Command::Undo(1)).is_err());
}

#[test]
fn a_running_lab_continues_from_the_same_time() {
    let mut stage = Stage::open("method-2", &[], SMALL);
    stage.wait(2.0);
    let stood = stage.lab.player().run().now().time_s;
    stage.press("/dt\n0.05\n");
    let time_s = stage.lab.player().run().now().time_s;
    assert!((stood..stood + 0.2).contains(&time_s), "{stood} {time_s}");
    assert!(stage.lab.player().is_running());
}

#[test]
fn command_files_rerun_only_on_request() {
    let text = "[[do]]\nset = { 'motion.time_step_s' = 0.05 }\nrerun = true\n";
    let read = |commands_text: &str| {
        let document = gyrolab::engine::scenario::Document::parse("a.toml", commands_text).unwrap();
        gyrolab::lab::command::read(&document)
    };
    let list = read(text).unwrap().list;
    assert!(matches!(list[0].command, Command::Rerun(_)));
    let mut desk = desk_at("method-2", "40 s");
    desk.carry_out(&list[0].command).unwrap();
    assert_eq!((desk.step(), previous_s(&desk)), (800, Some(40.0)));
    assert_eq!(time_step_s(&desk.scenario()), 0.05);
    let as_before = read(&text.replace("true", "false")).unwrap().list;
    assert!(matches!(as_before[0].command, Command::Set(_)));
    let refused = |wrong: &str| read(wrong).unwrap_err().to_string();
    has(refused(&text.replace("true", "1")), "true or false");
    has(
        refused("[[do]]\nstep = 1\nrerun = true\n"),
        "unknown command",
    );
    let written = Command::Rerun(toml::Table::from_iter([("title".to_owned(), "x".into())]));
    assert_eq!(written.to_table()["rerun"], toml::Value::Boolean(true));
    // Without `rerun`, `set` takes effect from the next step on, as in a run file.
    let mut edited = desk_at("method-2", "40 s");
    for command in commands("set = { 'motion.time_step_s' = 0.05 }") {
        edited.carry_out(&command).unwrap();
    }
    assert_eq!(edited.scenario().file.edit[0].step, 400);
}

/// Header, verdict and journal state the same time step on both sides of an edit.
#[test]
fn header_verdict_and_journal_agree_on_the_time_step() {
    let mut stage = Stage::open("method-2", &[], SMALL);
    stage.commands("pause = true\ngo_to = 40\nset = { 'motion.time_step_s' = 0.05 }");
    for (place, time_step, turns) in [
        ("40", "dt 0.05 s", 2.49),
        ("39", "dt 0.1 s", 4.97),
        ("0", "dt 0.1 s", 4.97),
        ("41", "dt 0.05 s", 2.49),
    ] {
        stage.commands(&format!("go_to = {place}"));
        let header = stage.picture().lines().next().unwrap().to_owned();
        has(&header, time_step);
        let reading = &stage.lab.player().reading;
        let health = &reading.readouts.health;
        assert!((health.turns_per_step - turns).abs() < 0.01, "{place}");
        let list = &stage.lab.values().list;
        let mut values = list.values.iter();
        let dt = values.find(|value| value.key.as_deref() == Some("motion.time_step_s"));
        assert_eq!(format!("dt {} s", dt.unwrap().text), time_step, "{place}");
        has(stage.lab.note(), "dt 0.05 s, not 0.1, from step 40 on");
    }
}

#[test]
fn a_restart_does_not_move_the_view() {
    let mut stage = Stage::open("method-2", &[], SMALL);
    stage.wait(2.0).commands("pause = true");
    let seen = |shown: &Stage| (shown.lab.view().camera, shown.lab.view().look.clone());
    let before = seen(&stage);
    stage.press("/dt\n0.05\n").press("\u{1b}\u{1b}");
    assert_eq!(seen(&stage), before);
    stage.press("r");
    let at_start = seen(&stage);
    stage.press("r").press("/gravity\n5\n");
    assert_eq!(seen(&stage), at_start);
}

#[test]
fn undo_returns_to_an_edited_run_after_opening_another() {
    let mut stage = Stage::open("method-2", &[], SMALL);
    stage.wait(2.0).commands("pause = true");
    stage.press("ocusps\n").shows_no("u returns to it");
    stage.press("u").press("/dt\n0.05\n").press("\u{1b}\u{1b}");
    stage.press("ocusps\n").shows("u returns to it");
    stage.press("u");
    assert_eq!(time_step_s(stage.lab.player().run().scenario()), 0.05);
}
