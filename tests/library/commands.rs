//! Commands as values: TOML round trips, error messages with line, key and the nearest name, and execution.

use crate::support::desk::{Desk, commands};
use crate::support::stage::{LARGE, SMALL, Stage};
use crate::support::words::has_all;
use gyrolab::engine::scenario::Document;
use gyrolab::lab::Refusal;
use gyrolab::lab::command::{self, COMMANDS, Command};
use gyrolab::lab::view::{HideablePart, Pane};
use gyrolab::tui::keymap::Key;
use gyrolab::tui::screen;
use std::collections::BTreeSet;
use std::time::Duration;
use toml::{Table, Value};

fn read(text: &str) -> Result<Vec<Command>, String> {
    let document = Document::parse("demo.toml", text).map_err(|problems| problems.to_string())?;
    let read = command::read(&document).map_err(|problems| problems.to_string())?;
    Ok(read.list.into_iter().map(|placed| placed.command).collect())
}

/// One command for each row of the table.
const EXAMPLES: &str = "
    open = 'cusps'
    set = { 'motion.time_step_s' = 0.05 }
    nudge = 'motion.time_step_s'
    push = true
    next_push = { for_s = 1 }
    step = -2
    go_to = '60 s'
    run_until = 't_s >= 60'
    run = true
    pause = true
    wait_s = 2.5
    chapter = 'the push'
    undo = 1
    redo = 1
    export = 'run.csv'
    figure = 'run.svg'
    save = 'run.toml'
    speed = 'top'
    since_s = 12.5
    magnify = 4
    cursor = 'next turn'
    measured = 'heidelberg-spin-decay'
    pin = true
    take_advice = true
    point_at = 'above'
    camera = { yaw_deg = 30 }
    zoom = { above = 4, 3d = 2 }
    look_at = 'the dip'
    next = 'raise the tilt'
    window_s = 60
    detail_s = 0.5
    detail_of = 'z'
    detail_range = [-9, 9]
    z_range_m = [0.6, 0.95]
    exact = true
    show = ['traces', '3d']
    hide = ['health']
    fill = 'above'
    phase = 'torque'
    sum_to = 4
    bare = true
    residuals = true";

/// Commands with numbers and names that are hard to write as TOML.
const OTHER_VALUES: &str = r#"
    open = './my run.toml'
    set = { 'motion.time_step_s' = 1e300, 'push.3.force_N.2' = -5e-324, 'start.momentum_Js' = [0.1, 0, 1], 'view.hide' = ['health'] }
    nudge = { key = 'push.1.force_N.0', times = -10000 }
    push = { point = 'top', force_N = [1, -2, 0.5], from_s = 0.1, for_s = 1e300 }
    next_push = { force_N = 3, toward = '1 -2 0.5' }
    go_to = 421
    go_to = 'start'
    go_to = 'end'
    run_until = 'abs(tilt_deg - 3) < 1e-3 or step > motion.steps'
    export = { path = 'ü "x" y.csv', every = 7, columns = ['t_s', 'z_m'], from_s = 0.1, to_s = 1e300, to_step = 3, force = true }
    export = { path = '-', points = true, excel = true }
    figure = { path = 'dir/x.pdf', kind = 'above', exact = true, to_step = 3, force = true }
    save = { path = "x\"y'.toml", to_step = 3, force = true }
    save = { path = 'x.toml', from_here = true }
    speed = 1e-6
    since_s = 'none'
    cursor = 421
    cursor = 'turn before'
    cursor = 'mark'
    cursor = 'none'
    measured = 'none'
    pin = false
    point_at = 'none'
    look_at = "a \"b\" = 'c' # d"
    exact = false
    fill = 'none'
    phase = 1000
    phase = 'last'
    phase = 'why'"#;

#[test]
fn commands_survive_a_toml_round_trip() {
    for command in commands(EXAMPLES).into_iter().chain(commands(OTHER_VALUES)) {
        let tables = vec![Value::Table(command.to_table())];
        let file = Table::from_iter([("do".to_owned(), Value::Array(tables))]);
        let text = toml::to_string(&file).unwrap();
        assert_eq!(read(&text), Ok(vec![command]), "{text}");
    }
}

#[test]
fn every_command_of_the_table_has_an_example() {
    let named: BTreeSet<_> = commands(EXAMPLES)
        .iter()
        .map(|command| command.to_table().keys().next().unwrap().clone())
        .collect();
    let rows: BTreeSet<_> = COMMANDS.iter().map(|row| row.name.to_owned()).collect();
    let lacking: Vec<_> = rows.difference(&named).collect();
    assert!(
        lacking.is_empty(),
        "EXAMPLES in tests/library/commands.rs lacks {lacking:?}"
    );
    // Every command has a row.
    let nothing = Table::from_iter([("nothing".to_owned(), Value::Boolean(true))]);
    let refused = nothing.try_into::<Command>().unwrap_err();
    let (_, known) = refused.message().split_once("expected one of ").unwrap();
    let known = known
        .split(", ")
        .map(|name| name.trim_matches('`').to_owned());
    let without_row: Vec<_> = known.filter(|name| !rows.contains(name)).collect();
    assert!(
        without_row.is_empty(),
        "own() in src/lab/command.rs lacks {without_row:?}"
    );
}

#[test]
fn mistakes_are_reported_with_line_and_nearest_name() {
    for (text, told) in [
        (
            "[[do]]\nstep = 1\n[[do]]\ngoto = 3",
            "demo.toml:4: do.1.goto: unknown command: did you mean go_to?",
        ),
        (
            "[[do]]\nrun = true\nstep = 1",
            "demo.toml:1: do.0: contains run, step: write each command",
        ),
        ("[[do]]", "demo.toml:1: do.0: contains no command"),
        (
            "do = 3",
            "demo.toml:1: do (3) must be an array of tables: write [[do]]",
        ),
        (
            "[[do]]\nstep = 1\n[motion]\nsteps = 3",
            "demo.toml:3: motion: unknown key",
        ),
        ("x = 1", "unknown key: a file of commands"),
        (
            "[[do]]\nset = { \"motion.time_step\" = 1 }",
            "demo.toml:2: do.0.set.\"motion.time_step\": unknown key: did you mean motion.time_step_s?",
        ),
        (
            "[[do]]\nset = { \"motion.time_step_s\" = -1 }",
            "(-1) must be greater than zero",
        ),
        (
            "[[do]]\nset = { \"start.momentum_Js.3\" = 1 }",
            ".0, .1 and .2",
        ),
        ("[[do]]\nset = {}", "must contain a key"),
        (
            "[[do]]\nset = { motion.time_step_s = 0.05 }",
            "do.0.set.motion: would be set as a whole: write each key in quotes, \"motion.time_step_s\"",
        ),
        (
            "[[do]]\nset = { push.0.force_N = [0, 0, 1] }",
            "in quotes, \"push.0.force_N\"",
        ),
        (
            "[[do]]\nexport = \"x.csv\"\nevery = 10",
            "do.0.every: unknown command: values for export go inside its own value: \"run.csv\", or { path",
        ),
        ("[[do]]\nopen = \"wobble-pus\"", "did you mean wobble-push?"),
        ("[[do]]\nstep = 0", "do.0.step (0) must not be 0"),
        ("[[do]]\nrun = false", "must be true"),
        (
            "[[do]]\ngo_to = \"soon\"",
            "do.0.go_to (\"soon\") must be a step",
        ),
        ("[[do]]\ngo_to = -3", "must be a step"),
        ("[[do]]\nrun_until = \"t_s >\"", "column 6"),
        (
            "[[do]]\nrun_until = \"tilt_dg > 3\"",
            "column 1: there is no number named tilt_dg: did you mean tilt_deg?",
        ),
        (
            "[[do]]\nrun_until = \"motion.scheme > 3\"",
            "no number named",
        ),
        ("[[do]]\nwait_s = -1", "must be from 0 to 86400"),
        ("[[do]]\nundo = 0", "must be 1 or more"),
        (
            "[[do]]\nexport = { path = \"x.csv\", evry = 3 }",
            "do.0.export.evry: unknown key: did you mean every?",
        ),
        (
            "[[do]]\nexport = { every = 3 }",
            "do.0.export.path: is missing",
        ),
        (
            "[[do]]\nexport = { path = \"x.csv\", every = 0 }",
            "do.0.export.every (0) must be 1 or more",
        ),
        (
            "[[do]]\nsave = { path = \"x\", from_here = true, to_step = 3 }",
            "do.0.save.to_step (3) cannot be used with from_here",
        ),
        ("[[do]]\nspeed = \"fast\"", "or \"top\""),
        ("[[do]]\nshow = [\"trace\"]", "did you mean traces?"),
        ("[[do]]\nhide = [\"helth\"]", "did you mean health?"),
        ("[[do]]\nfill = \"abve\"", "did you mean above?"),
        ("[[do]]\ncamera = { yaw = 3 }", "did you mean yaw_deg?"),
        ("[[do]]\nzoom = { above = 0 }", "must be from 0.5 to 100"),
        (
            "[[do]]\npush = { force_N = [0, 0, 1], toward = \"down\" }",
            "do.0.push.toward (\"down\") cannot be used with a force",
        ),
        (
            "[[do]]\npush = { force_N = -1 }",
            "do.0.push.force_N (-1) must be greater than zero",
        ),
        (
            "[[do]]\npush = { toward = \"left\" }",
            "toward must be one of down",
        ),
        (
            "[[do]]\nnudge = { key = \"start.momentum_Js\" }",
            "start.momentum_Js.0",
        ),
        (
            "[[do]]\nnudge = { times = 3 }",
            "do.0.nudge.key: is missing",
        ),
        ("[[do]]\nstep = ", "demo.toml:2"),
    ] {
        let wrong = read(text).unwrap_err();
        assert!(wrong.contains(told), "{text}\n  {wrong}\n  {told}");
    }
}

#[test]
fn setting_several_keys_succeeds_or_fails_as_one_edit() {
    let mut desk = Desk::open("method-2");
    desk.commands("step = 100");
    let untouched = desk.scenario().file;
    desk.commands(
        "set = { 'motion.time_step_s' = 0.05, 'motion.gravity_m_per_s2' = 5, 'title' = 'mine' }",
    );
    let motion = desk.lab.player().motion();
    assert_eq!((motion.time_step_s, motion.gravity), (0.05, 5.0));
    assert_eq!(desk.scenario().file.title, "mine");
    desk.commands("undo = 1");
    assert_eq!(desk.scenario().file, untouched);
    // The second key is invalid, so nothing is changed.
    let wrong = commands("set = { 'motion.time_step_s' = 0.05, 'trace' = 'nobody' }").remove(0);
    assert!(desk.carry_out(&wrong).is_err());
    let unknown = commands("set = { 'title' = 'mine', 'push.7.force_N.0' = 5 }").remove(0);
    assert!(desk.carry_out(&unknown).is_err());
    assert_eq!((desk.scenario().file, desk.step()), (untouched, 100));
}

#[test]
fn setting_body_and_start_starts_one_new_run() {
    let mut desk = Desk::open("method-2");
    desk.commands("step = 100");
    desk.commands(
        "set = { 'start.tilt_deg' = 30, 'body.rim.radius_m' = 0.5, 'motion.time_step_s' = 0.05 }",
    );
    let file = desk.scenario().file;
    assert_eq!(desk.step(), 200, "played to the same time");
    assert_eq!(file.start.tilt_deg, Some(30.0));
    assert_eq!(file.body.rim.unwrap().radius_m, 0.5);
    assert_eq!(desk.lab.player().motion().time_step_s, 0.05);
    desk.commands("undo = 2");
    assert_eq!(desk.step(), 100);
    // A rejected edit leaves the run unchanged.
    let wrong = commands("set = { 'start.tilt_deg' = 30, 'push.7.force_N.0' = 5 }").remove(0);
    assert!(desk.carry_out(&wrong).is_err());
    assert_eq!(
        (desk.step(), desk.scenario().file.start.tilt_deg),
        (100, Some(45.0))
    );
}

#[test]
fn a_push_command_applies_the_given_force() {
    let mut desk = Desk::open("method-2");
    let said = desk
        .commands("go_to = '10 s'\npush = { force_N = [1, -2, 0.3], for_s = 2 }")
        .unwrap();
    assert!(
        said.contains("on top") && said.contains("for 2 s"),
        "{said}"
    );
    let push = desk.scenario().file.push[0].clone();
    assert_eq!(
        (push.force_N, push.from_s, push.for_s),
        ([1.0, -2.0, 0.3], Some(10.0), Some(2.0))
    );
    let before = desk.lab.values().list.values.to_vec();
    desk.commands("next_push = { force_N = 70, toward = 'around' }\npush = true");
    assert_ne!(desk.lab.values().list.values, before);
    let [x, y, z] = desk.scenario().file.push[1].force_N;
    assert!((x.hypot(y) - 70.0).abs() < 1e-9 && z == 0.0, "{x} {y} {z}");
    let nobody = commands("push = { point = 'nobody' }").remove(0);
    assert!(
        desk.carry_out(&nobody)
            .unwrap_err()
            .to_string()
            .contains("must be one of")
    );
}

#[test]
fn go_to_accepts_times_and_names_and_impossible_commands_fail() {
    let mut desk = Desk::open("method-2");
    desk.commands("go_to = '12.5 s'");
    assert_eq!(desk.step(), 125);
    desk.commands("go_to = 'end'");
    assert_eq!(desk.step(), 2300);
    desk.commands("go_to = 'start'");
    let back = desk.carry_out(&Command::Step(-1));
    assert_eq!(
        back,
        Err(Refusal::Because("the run begins here".to_owned()))
    );
    assert!(desk.carry_out(&Command::Undo(1)).is_err());
    assert!(
        desk.carry_out(&Command::look("window_s", 0.1))
            .unwrap_err()
            .to_string()
            .contains("two time steps")
    );
    let nobody = Command::Nudge {
        key: "push.4.force_N.0".to_owned(),
        times: 1,
        rerun: false,
    };
    assert!(
        desk.carry_out(&nobody)
            .unwrap_err()
            .to_string()
            .contains("not a value of this scenario")
    );
}

/// Executes the commands in `text` in a lab without a clock.
fn finished(preset: &str, text: &str) -> (Desk, Result<(), String>) {
    let mut desk = Desk::open(preset);
    let document = Document::parse("demo.toml", text).unwrap();
    desk.lab.take_commands(command::read(&document).unwrap());
    let end = desk
        .lab
        .finish_script_while(|_, _| std::ops::ControlFlow::Continue(()));
    (desk, end)
}

#[test]
fn run_until_plays_until_the_condition_holds() {
    let (desk, end) = finished(
        "method-2",
        "[[do]]\nrun_until = \"t_s >= 60\"\n[[do]]\nstep = 3",
    );
    assert_eq!((end, desk.step()), (Ok(()), 603));
    // It may lie beyond the scenario's end; if it already holds, no step is taken.
    let text = "[[do]]\nrun_until = \"step >= 2 * motion.steps and abs(z_m) > 0\"\n[[do]]\nrun_until = \"t_s > 0\"";
    let (past_the_end, at_last) = finished("method-2", text);
    assert_eq!((at_last, past_the_end.step()), (Ok(()), 4600));
}

#[test]
#[ignore = "takes ten million steps: seconds"]
fn run_until_gives_up_after_ten_million_steps() {
    let (desk, end) = finished(
        "cusps",
        "[[do]]\nrun_until = \"z_m > 1000\"\n[[do]]\nstep = 1",
    );
    let told = end.unwrap_err();
    assert!(
        told.contains(
            "demo.toml:1: run_until: did not hold on any of 10,000,000 steps; the command after it"
        ),
        "{told}"
    );
    assert_eq!(desk.step(), 10_000_000);
    // The limit is for all conditions together.
    let (both, given_up) = finished(
        "cusps",
        "[[do]]\ngo_to = 9000000\n[[do]]\ngo_to = \"start\"\n[[do]]\nrun_until = \"z_m > 1000\"",
    );
    let in_all = given_up.unwrap_err();
    let limit = "run_until: commands take at most 10,000,000 steps in total";
    assert!(in_all.contains(limit), "{in_all}");
    assert!(both.step() < 2_000_000, "{}", both.step());
}

#[test]
fn commands_wait_for_earlier_commands() {
    let mut desk = Desk::open("method-2");
    let text = "[[do]]\nspeed = 20\n[[do]]\nrun_until = \"t_s >= 20\"\n[[do]]\nwait_s = 5\n[[do]]\nstep = 7";
    let document = Document::parse("demo.toml", text).unwrap();
    desk.lab.take_commands(command::read(&document).unwrap());
    fn pass_second(desk: &mut Desk) {
        (0..10).for_each(|_| desk.pass(Duration::from_millis(100)));
    }
    (0..=5).for_each(|_| desk.pass(Duration::from_millis(100)));
    assert!(
        (80..130).contains(&desk.step()),
        "it plays at its pace: {}",
        desk.step()
    );
    pass_second(&mut desk);
    assert_eq!(desk.step(), 200);
    assert!(!desk.lab.script().is_done());
    (0..3).for_each(|_| pass_second(&mut desk));
    assert_eq!(desk.step(), 200);
    (0..3).for_each(|_| pass_second(&mut desk));
    assert_eq!((desk.step(), desk.lab.script().is_done()), (207, true));
}

#[test]
fn esc_stops_the_commands_and_errors_name_the_line() {
    let mut desk = Desk::open("method-2");
    let read = |text: &str| command::read(&Document::parse("demo.toml", text).unwrap()).unwrap();
    desk.lab
        .take_commands(read("[[do]]\nrun_until = \"t_s >= 200\"\n[[do]]\nstep = 7"));
    desk.pass(Duration::from_millis(100));
    desk.press(&[Key::Esc]);
    let stopped = desk.step();
    assert_eq!(
        desk.lab.notice().unwrap(),
        "stopped: 2 commands were dropped"
    );
    desk.pass(Duration::from_secs(1));
    assert_eq!((desk.step(), desk.lab.script().is_done()), (stopped, true));
    desk.lab.take_commands(read(
        "[[do]]\nundo = 3\n\n[[do]]\nstep = 7\n[[do]]\nstep = 7",
    ));
    let told = desk.lab.notice().unwrap();
    assert_eq!(
        told,
        "demo.toml:1: undo: nothing to undo; the 2 commands after it are not carried out"
    );
    assert_eq!(desk.step(), stopped);
}

#[test]
fn commands_overwrite_files_only_with_force() {
    let folder = tempfile::tempdir().unwrap();
    let mut desk = Desk::open("method-2");
    desk.lab.files_mut().work_in(folder.path());
    let text = "[[do]]\nstep = 40\n[[do]]\nexport = { path = \"a.csv\", every = 10 }\n[[do]]\nsave = \"a.toml\"\n\
        [[do]]\nsave = { path = \"b.toml\", from_here = true }\n[[do]]\nexport = { path = \"a.csv\", force = true, to_step = 3 }\n[[do]]\nsave = \"a.toml\"";
    let read = command::read(&Document::parse("demo.toml", text).unwrap()).unwrap();
    desk.lab.take_commands(read);
    let told = desk
        .lab
        .finish_script_while(|_, _| std::ops::ControlFlow::Continue(()))
        .unwrap_err();
    assert!(
        told.contains("demo.toml:11: save: ") && told.contains("exists: force = true replaces it"),
        "{told}"
    );
    let csv = std::fs::read_to_string(folder.path().join("a.csv")).unwrap();
    assert_eq!(csv.lines().filter(|line| !line.starts_with('#')).count(), 5);
    let run = Document::read(&folder.path().join("a.toml"))
        .unwrap()
        .scenario()
        .unwrap();
    assert_eq!(run.steps, 40);
    let here = Document::read(&folder.path().join("b.toml"))
        .unwrap()
        .scenario()
        .unwrap();
    assert!(here.file.start.tilt_deg.is_some());
}

fn picture(desk: &Desk, size: (u16, u16)) -> String {
    screen::text(&desk.lab, true, size)
}

fn opened_with(set: &[&str]) -> Desk {
    let mut document = Document::open("wobble-push").unwrap();
    set.iter().for_each(|set| document.set(set).unwrap());
    Desk::with("wobble-push", document.scenario().unwrap())
}

/// The view settings of a scenario and the commands lead to the same screen.
#[test]
fn view_settings_equal_the_matching_commands() {
    for (key, value, size) in [
        ("show", "['traces', '3d']", (80, 24)),
        ("hide", "['health', 'predicted', 'look_at']", (120, 40)),
        ("hide", "['parameters']", (200, 50)),
        ("fill", "'above'", (80, 24)),
        ("window_s", "7.0", (80, 24)),
        ("detail_s", "2.0", (80, 24)),
        ("detail_of", "'tilt'", (80, 24)),
        ("detail_range", "[-1, 50]", (200, 50)),
        ("z_range_m", "[0.5, 1]", (80, 24)),
        ("exact", "true", (80, 24)),
        ("camera", "{ yaw_deg = 90.0 }", (200, 50)),
        ("zoom", "{ above = 5.0 }", (80, 24)),
        ("zoom", "{ 3d = 2 }", (200, 50)),
        ("look_at", "'the dip'", (80, 24)),
        ("bare", "true", (80, 24)),
        ("speed", "0.5", (80, 24)),
    ] {
        // The initial time window depends on the speed; a command does not change it.
        let mut begun = opened_with(&[&format!("view.{key}={value}")]);
        if key == "speed" {
            begun.commands("window_s = 230");
        }
        begun.commands("step = 30");
        let mut told = opened_with(&[]);
        told.commands(&format!("{key} = {value}\nstep = 30"));
        assert_eq!(picture(&begun, size), picture(&told, size), "{key}");
        let mut plain = opened_with(&[]);
        plain.commands("step = 30");
        assert_ne!(picture(&plain, size), picture(&told, size), "{key}");
    }
}

#[test]
fn hidden_items_appear_nowhere_on_the_screen() {
    let mut desk = opened_with(&[]);
    desk.commands("step = 300");
    let size = (200, 50);
    let seen = picture(&desk, size);
    let look_at = desk
        .scenario()
        .file
        .viewed_text("look_at")
        .unwrap()
        .to_owned();
    let first = look_at.split(' ').take(3).collect::<Vec<_>>().join(" ");
    for words in ["energy error", "values", "start and motion", "3-D ", &first] {
        assert!(seen.contains(words), "no {words} in\n{seen}");
    }
    desk.commands("hide = ['health', 'predicted', 'look_at', 'parameters']");
    desk.wait(100);
    let hidden = picture(&desk, size);
    for words in ["energy error", "start and motion", &first] {
        assert!(!hidden.contains(words), "{words} in\n{hidden}");
    }
    desk.commands("hide = []");
    assert!(picture(&desk, size).contains(&first));
    // The exact column is empty, also in the list of values.
    let exact_z = format!("{:.4}", desk.lab.player().reading.exact.unwrap().position.z);
    assert!(picture(&desk, size).contains(&exact_z));
    desk.commands("hide = ['predicted']");
    desk.press(&[Key::Char('e')]);
    assert!(!picture(&desk, size).contains(&exact_z));
}

#[test]
fn shown_panes_share_the_screen_at_every_width() {
    let mut desk = opened_with(&[]);
    desk.commands("show = ['above', '3d']");
    for (width, height) in [(80, 24), (120, 30), (200, 50), (60, 20)] {
        let area = ratatui::layout::Rect::new(0, 0, width, height);
        let layout = screen::layout(&desk.lab, true, area);
        let panes: Vec<_> = layout.panes.iter().map(|(pane, _)| *pane).collect();
        assert_eq!(panes, [Pane::Above, Pane::ThreeD], "{width}");
        let widths: u16 = layout.panes.iter().map(|(_, place)| place.width).sum();
        assert_eq!(widths + 1, width, "the panes are one column apart");
    }
    desk.commands("hide = ['above', '3d']");
    picture(&desk, (80, 24));
    desk.commands("show = []\nhide = []");
    let mut fresh = opened_with(&[]);
    fresh.commands("show = []");
    assert_eq!(picture(&desk, (80, 24)), picture(&fresh, (80, 24)));
}

#[test]
fn point_at_marks_a_pane_with_a_heavy_rule() {
    let mut desk = opened_with(&[]);
    let is_heavy = |shown_desk: &Desk| {
        let shown = picture(shown_desk, (80, 24));
        let rule: String = shown.lines().nth(1).unwrap().chars().skip(28).collect();
        rule.contains('━') // in the traces, a push is also a heavy rule
    };
    assert!(!is_heavy(&desk));
    desk.commands("point_at = 'above'");
    assert!(is_heavy(&desk));
    desk.commands("point_at = 'none'");
    assert!(!is_heavy(&desk));
}

#[test]
fn every_pane_has_the_id_used_in_files() {
    for pane in Pane::ALL {
        assert_eq!(Pane::named(pane.id()), Some(pane));
        assert!(Value::from(pane.id()).try_into::<HideablePart>().is_ok());
    }
    let part = |id: &str| Value::from(id).try_into::<HideablePart>();
    assert!(
        gyrolab::engine::scenario::screen::HIDEABLE
            .iter()
            .all(|id| part(id).is_ok())
    );
}

#[test]
fn the_focus_leaves_a_hidden_pane() {
    for size in [SMALL, LARGE] {
        let mut stage = Stage::open("loops", &[], size);
        stage.commands("hide = ['traces']");
        assert_eq!(stage.focus(), "above", "at {size}");
        stage.commands("show = ['3d', 'parameters']\nhide = []");
        assert_eq!(stage.focus(), "3d", "at {size}");
        stage.commands("fill = 'traces'");
        assert_eq!(stage.focus(), "traces", "the named pane fills the screen");
        stage.commands("fill = 'none'");
        assert_eq!(stage.focus(), "3d", "at {size}");
    }
}

#[test]
fn the_focus_returns_from_the_full_screen_3d_view_to_a_shown_pane() {
    let mut stage = Stage::open("loops", &[], SMALL);
    stage.commands("hide = ['traces']");
    stage.press("d");
    assert_eq!(stage.focus(), "3d");
    stage.press("d");
    assert_eq!(stage.focus(), "above");
}

#[test]
fn a_picture_of_one_pane_skips_hidden_panes() {
    // Draws like `gyrolab show`, for a screen size that the lab does not know.
    let mut desk = opened_with(&[]);
    desk.commands("hide = ['traces']");
    let seen = picture(&desk, (40, 20));
    assert!(!seen.contains("over time"), "{seen}");
    let opened = opened_with(&["view.hide=['traces']"]);
    let of_file = picture(&opened, (40, 20));
    assert!(!of_file.contains("over time"), "{of_file}");
}

#[test]
fn a_push_starts_at_its_given_time() {
    let mut desk = Desk::open("method-2");
    let pushed = "push = { force_N = 50, toward = 'down', from_s = 2, for_s = 0.5 }";
    desk.commands(pushed);
    let push = desk.scenario().file.push.last().unwrap().clone();
    assert_eq!((push.from_s, push.for_s), (Some(2.0), Some(0.5)));
    desk.commands("go_to = '3 s'");
    let late = desk
        .carry_out(&commands(pushed).remove(0))
        .unwrap_err()
        .to_string();
    has_all(&late, ["begins at 2 s, but the run is at 3 s", "g and 2 s"]);
    desk.commands("push = { from_s = 0 }");
    let late_push = desk.scenario().file.push.last().unwrap().clone();
    assert_eq!(late_push.from_s, Some(3.0));
}

#[test]
fn swings_are_counted_between_turning_points() {
    // The tilt swings with a period of 0.8225 s.
    let mut desk = Desk::open("cusps");
    desk.commands("go_to = 3000\ncursor = 0\ncursor = 'next turn'\ncursor = 'mark'");
    desk.commands(&"cursor = 'next turn'\n".repeat(4));
    let said = desk.commands("cursor = 'mark'").unwrap();
    has_all(
        &said,
        [
            "2 swings of the tilt in 1.6",
            "period 0.82",
            "theory: 0.8225",
        ],
    );
}
