//! Journeys of a user through the lab, from its opening to its end, with what is on the screen and the disk then. The
//! program itself runs in a pty.

use crate::support::dice::Dice;
use crate::support::ground::{Ground, done};
use crate::support::pty::{LEAVES_ALTERNATE_SCREEN, SHOWS_CURSOR, Terminal};
use crate::support::words::has;
use std::fs;
use std::thread;
use std::time::{Duration, Instant};

const RIGHT: &str = "\u{1b}[C";
const LEFT: &str = "\u{1b}[D";
const ESC: &str = "\u{1b}";
const CTRL_Z: &str = "\u{1a}";
/// Ctrl-U: clears the field of a dialog.
const CLEAR: &str = "\u{15}";
/// The message of a lab that has resumed a session.
const AS_LEFT: &str = "session resumed";

/// The lab with Method 2, standing still at `step`.
fn paused_at(ground: &Ground, step: u64) -> Terminal {
    let step = step.to_string();
    let lab = ground.open(&format!("--paused --at {step}"));
    lab.wait_for("L lessons");
    lab
}

/// The lab of the newest session, once it has arrived at the step where it was left.
fn resumed(ground: &Ground) -> Terminal {
    let lab = ground.open("--resume");
    lab.wait_for(AS_LEFT);
    lab.wait_for("paused");
    lab
}

/// Types `text` into the dialog that is open, in place of what is there.
fn answer(lab: &mut Terminal, text: &str) {
    lab.press(&format!("{CLEAR}{text}\r"));
}

/// Selects the value that is found by `name`.
#[track_caller]
fn select(lab: &mut Terminal, name: &str) {
    lab.press("/");
    lab.ask(name, &format!("/{name}_"));
    lab.press(ESC);
    lab.wait_until("all values", |shown| {
        !shown.words().contains(&format!("/{name}"))
    });
}

/// Types `value` for the value that is selected: the run begins again with it.
fn set(lab: &mut Terminal, value: &str) {
    lab.ask("\r", "Enter: ");
    answer(lab, value);
}

/// Types `value` for the value that is selected, from the next step on.
fn set_from_now_on(lab: &mut Terminal, value: &str) {
    lab.ask("\r", "Enter: rerun from the start");
    lab.ask("\t", "Enter: from now on");
    answer(lab, value);
}

/// Goes to `step`, once all that was pressed before has been done.
#[track_caller]
fn go_to(lab: &mut Terminal, step: u64) {
    lab.ask(&step.to_string(), &format!("{step}: press a key"));
    lab.press("g");
    let goal = format!("step {step}");
    lab.wait_until(&goal, |lab| {
        lab.step() == Some(step) && !lab.screen().contains("press a key")
    });
}

/// Presses the keys of steps, and waits for the step to which they lead.
#[track_caller]
fn steps(lab: &mut Terminal, keys: &str, step: u64) {
    lab.press(keys);
    lab.wait_for_step(step);
}

/// Gives the push to come, and waits for the message about it.
#[track_caller]
fn push(lab: &mut Terminal) {
    lab.ask("1", "1: press a key"); // what was said of the push before has gone
    lab.press("p");
    lab.wait_until("a push", |lab| {
        let words = lab.words();
        words.contains("pushed: ") || words.contains("discarded")
    });
}

/// Saves the run file as `name`, and reads it.
#[track_caller]
fn saved(lab: &mut Terminal, name: &str) -> String {
    lab.ask("s", "save the run file");
    answer(lab, name);
    lab.wait_for("the run is in");
    lab.ground().read(name)
}

/// Exports every row as `name`, and reads it.
#[track_caller]
fn exported(lab: &mut Terminal, name: &str) -> Vec<u8> {
    lab.ask("x", "export steps 0 to");
    answer(lab, name);
    lab.wait_for("wrote ");
    assert!(!lab.screen().contains("scp "), "not over SSH");
    fs::read(lab.ground().file(name)).unwrap()
}

/// The CSV that `gyrolab run` writes for the file `name`.
fn run(ground: &Ground, name: &str) -> Vec<u8> {
    done(ground.run(&format!("run {name} -o -"))).stdout
}

/// Step, time and place of the axle top, as they are shown.
fn shown(lab: &Terminal) -> [Option<String>; 3] {
    let shown = ["x m", "y m", "z m"].map(|label| lab.value(label));
    let is_whole = shown.iter().all(Option::is_some);
    assert!(is_whole, "{}", lab.screen());
    shown
}

#[test]
fn a_value_is_nudged_and_typed_refused_and_taken_back() {
    let ground = Ground::new();
    let mut lab = paused_at(&ground, 100);
    select(&mut lab, "dt");
    lab.wait_for("dt 0.1 s");
    lab.ask(RIGHT, "dt 0.2 s");
    set(&mut lab, "0.05");
    lab.wait_for("dt 0.05 s");
    for (value, why) in [("-1", "greater than zero"), ("soon", "number")] {
        set(&mut lab, value);
        lab.wait_for(why);
        lab.wait_for(&format!("{value}_")); // it stays, to be corrected
        lab.ask(ESC, "L lessons");
        lab.wait_for("dt 0.05 s");
    }
    set(&mut lab, "-1");
    lab.wait_for("greater than zero");
    answer(&mut lab, "0.02");
    lab.wait_for("dt 0.02 s");
    for dt in ["0.05", "0.2", "0.1"] {
        lab.ask("u", &format!("dt {dt} s"));
    }
    lab.ask("u", "nothing to undo");
    for dt in ["0.2", "0.05"] {
        lab.ask("U", &format!("dt {dt} s"));
    }
    lab.wait_for_step(200);
    let run = saved(&mut lab, "run.toml");
    assert_eq!(run.matches("[[edit]]").count(), 0, "{run}");
    has(&run, "\ntime_step_s = 0.05\n");
    set_from_now_on(&mut lab, "0.1");
    lab.wait_for("dt 0.1 s");
    steps(&mut lab, ".", 201);
    let edited = saved(&mut lab, "edited.toml");
    has(&edited, "[[edit]]\nstep = 200\n");
    has(&edited, "\"motion.time_step_s\" = 0.1");
    lab.quit();
}

/// The run that is exported has every kind of change in it.
#[test]
fn an_export_is_the_run_that_was_saved() {
    let ground = Ground::new();
    let mut lab = paused_at(&ground, 50);
    push(&mut lab);
    select(&mut lab, "gravity");
    steps(&mut lab, "30.", 80);
    lab.press(RIGHT);
    steps(&mut lab, "20.", 100);
    lab.press("15,");
    lab.wait_for_step(85);
    select(&mut lab, "dt");
    set_from_now_on(&mut lab, "0.025");
    lab.wait_for("dt 0.025 s");
    steps(&mut lab, "200.", 285);
    lab.ask("x", "286 rows, about");
    lab.ask("\t", "every 1_");
    for (every, words) in [("7", "42 rows, about"), ("0", "whole number, 1 or more")] {
        lab.press(CLEAR);
        lab.ask(every, words);
    }
    lab.press(ESC);
    lab.wait_for("L lessons");
    assert_eq!(ground.files(), ["state"], "what is left of a cancelled one");
    let csv = exported(&mut lab, "run.csv");
    saved(&mut lab, "run.toml");
    assert!(csv == run(&ground, "run.toml"), "other bytes");
    assert!(csv == run(&ground, "run.csv"), "other bytes from the CSV");

    // A file that exists goes at the second word only.
    fs::write(ground.file("mine.csv"), "mine").unwrap();
    lab.ask("x", "file method-2.csv_");
    lab.press(ESC);
    lab.wait_for("L lessons");
    lab.ask("x", "export steps 0 to 285");
    answer(&mut lab, "mine.csv");
    lab.wait_for("exists: press Enter again to replace it");
    assert_eq!(ground.read("mine.csv"), "mine");
    lab.ask("\r", "wrote ");
    assert!(fs::read(ground.file("mine.csv")).unwrap() == csv);
    lab.quit();
    lab.wait_for("mine.csv: 286 rows");
}

#[test]
fn the_present_state_is_saved_as_a_scenario_that_runs() {
    let ground = Ground::new();
    let mut lab = paused_at(&ground, 50);
    push(&mut lab);
    steps(&mut lab, "100.", 150);
    lab.ask("S", "save the present state");
    answer(&mut lab, "here.toml");
    lab.wait_for("the scenario is in");
    let z = shown(&lab)[2].clone();
    lab.quit();
    ground.stdout("check here.toml");
    assert!(run(&ground, "here.toml").starts_with(b"# "));
    let begins = ground.open("here.toml --paused");
    begins.wait_until("the z of the saved state", |begins| {
        begins.value("z m") == z
    });
}

#[test]
fn an_export_that_cannot_be_says_why_and_loses_nothing() {
    let ground = Ground::new();
    let mut lab = paused_at(&ground, 50);
    fs::create_dir(ground.file("gone")).unwrap();
    lab.ask("x", "export steps 0 to 50");
    lab.press(&format!("{CLEAR}gone/run.csv"));
    lab.wait_for("gone/run.csv_");
    fs::remove_dir(ground.file("gone")).unwrap();
    lab.ask("\r", "there is no folder");
    answer(&mut lab, "state");
    lab.wait_for("is a folder");
    let locked = ground.file("locked");
    fs::create_dir(&locked).unwrap();
    let mut rights = fs::metadata(&locked).unwrap().permissions();
    rights.set_readonly(true);
    fs::set_permissions(&locked, rights).unwrap();
    if fs::write(locked.join("probe"), "").is_err() {
        answer(&mut lab, "locked/run.csv");
        lab.wait_for("Permission denied");
    }
    answer(&mut lab, "/dev/full");
    lab.wait_for("not a regular file");
    answer(&mut lab, "run.csv");
    lab.wait_for("wrote ");
    lab.wait_for_step(50);
    lab.quit();
}

#[test]
fn an_export_whose_folder_goes_away_says_so_and_the_lab_stays() {
    let ground = Ground::new();
    fs::create_dir(ground.file("gone")).unwrap();
    let mut lab = long_run(&ground);
    lab.ask("x", "export steps 0 to");
    answer(&mut lab, "gone/run.csv");
    lab.wait_for("in the background");
    fs::remove_dir_all(ground.file("gone")).unwrap();
    lab.wait_for("cannot write");
    steps(&mut lab, ".", LONG + 1);
    lab.quit();
}

/// A run of this many steps is played in less than a second, and its export takes seconds.
const LONG: u64 = 1_000_000;

fn long_run(ground: &Ground) -> Terminal {
    let step = LONG.to_string();
    let lab = ground.open(&format!("--paused --at {step}"));
    lab.wait_for_step(LONG);
    lab
}

fn begin_export(lab: &mut Terminal) {
    lab.ask("x", "export steps 0 to");
    answer(lab, "run.csv");
    lab.wait_for("in the background");
}

#[test]
fn an_export_is_stopped_by_esc_and_by_the_second_q_and_leaves_nothing() {
    let ground = Ground::new();
    let mut lab = long_run(&ground);
    begin_export(&mut lab);
    lab.press(ESC); // it may close the notice
    lab.wait_until("the line without the notice", |lab| {
        !lab.words().contains("in the background")
    });
    lab.ask(ESC, "the export was stopped, and nothing was written");
    assert_eq!(ground.files(), ["state"]);
    begin_export(&mut lab);
    lab.ask("q", "press q again to stop it");
    lab.quit();
    assert_eq!(ground.files(), ["state"]);
    resumed(&ground).wait_for_step(LONG);
}

#[test]
fn a_line_that_is_lost_in_an_export_leaves_no_part_and_is_told_of() {
    all_at_once(&["HUP", "line"], |end| {
        let ground = Ground::new();
        let mut lab = long_run(&ground);
        begin_export(&mut lab);
        ended(&mut lab, end);
        assert_eq!(ground.files(), ["state"], "{end}");
        let resumed_lab = ground.open("--resume");
        resumed_lab.wait_for("run.csv was cut off, x starts another");
        resumed_lab.wait_for_step(LONG);
    });
}

/// Runs `test` with all `cases` at once: they wait more than they compute.
fn all_at_once(cases: &[&str], test: impl Fn(&str) + Sync) {
    thread::scope(|scope| {
        for case in cases {
            scope.spawn(|| test(case));
        }
    });
}

/// Ends the lab by the signal `by`, or by the loss of its line; gives its exit code.
fn ended(lab: &mut Terminal, by: &str) -> u32 {
    match by {
        "line" => lab.lose_line(),
        signal => lab.signal(signal),
    }
    lab.wait_for_end().exit_code()
}

/// The content of all session files.
fn kept(ground: &Ground) -> String {
    let folder = ground.state().join("gyrolab");
    let names = ground.kept(".session").into_iter();
    let texts = names.filter_map(|name| fs::read_to_string(folder.join(name)).ok());
    texts.collect()
}

#[test]
fn all_of_it_at_every_size_and_back_with_resume() {
    let ground = Ground::new();
    let mut lab = paused_at(&ground, 40);
    push(&mut lab);
    lab.resize((1, 1));
    lab.press("20.");
    lab.resize((200, 50));
    lab.wait_for_step(60);
    select(&mut lab, "dt");
    lab.resize((40, 10));
    lab.press("\r");
    lab.press("\t");
    answer(&mut lab, "0.05");
    lab.resize((1, 1));
    lab.press("40.");
    lab.press("s"); // a dialog that nobody sees
    lab.resize((5, 3));
    lab.press(CLEAR);
    lab.press("small.toml\r");
    lab.resize((80, 24));
    lab.wait_for("the run is in");
    lab.wait_for("dt 0.05 s");
    lab.press(" ");
    lab.wait_until("a run that plays", |lab| {
        lab.step().is_some_and(|step| step > 105)
    });
    lab.resize((1, 1));
    lab.press(" ");
    lab.resize((80, 24));
    lab.wait_for("paused");
    let before = saved(&mut lab, "before.toml");
    assert!(before.contains("[[push]]") && before.contains("[[edit]]"));
    let step = lab.step().unwrap();
    lab.quit();

    let mut second = resumed(&ground);
    assert_eq!(second.step(), Some(step));
    assert_eq!(saved(&mut second, "after.toml"), before);
    second.ask("u", "undone: motion.time_step_s = 0.05, at step 60");
    second.wait_for("dt 0.1 s");
    second.ask("u", "undone: the push on top, at step 40");
    second.wait_for_step(40);
    second.ask("u", "nothing to undo");
    second.press("U");
    second.press("U");
    second.wait_for("dt 0.05 s");
    second.press("q");
    second.wait_for_end();

    // What was taken back stays so, and the other run is still there.
    let mut third = resumed(&ground);
    third.press("u");
    third.wait_for("dt 0.1 s");
    third.quit();
    let mut fourth = resumed(&ground);
    fourth.press("U");
    fourth.wait_for("dt 0.05 s");
    go_to(&mut fourth, step);
    assert_eq!(saved(&mut fourth, "again.toml"), before);
    fourth.quit();
}

#[test]
fn a_screen_that_is_small_for_a_moment_is_drawn_again() {
    let ground = Ground::new();
    let mut lab = paused_at(&ground, 40);
    for small in [(1, 1), (79, 1), (40, 10), (1, 24)].repeat(3) {
        lab.resize(small);
        lab.resize((80, 24));
        for words in ["Method 2", "values", "L lessons"] {
            lab.wait_for(words);
        }
    }
    lab.quit();
}

#[test]
fn no_key_is_lost_when_the_size_changes_at_the_same_moment() {
    let ground = Ground::new();
    let mut lab = paused_at(&ground, 40);
    for step in 41..100 {
        lab.resize((80, 24 + step as u16 % 2));
        steps(&mut lab, ".", step);
    }
    lab.quit();
}

/// Keys may arrive together with the end of the program, from a fast typist on a slow line.
#[test]
fn what_is_pressed_just_before_the_end_is_kept() {
    all_at_once(&["q", "\u{3}"], |end| {
        let ground = Ground::new();
        let mut lab = paused_at(&ground, 30);
        lab.press(&format!("p{end}"));
        drop(lab.wait_for_end());
        let mut after = resumed(&ground);
        let run = saved(&mut after, "run.toml");
        assert!(run.contains("[[push]]"), "{end:?}: {run}");
    });
}

/// Waits until Ctrl-Z has stopped the process.
#[track_caller]
#[test]
fn after_every_end_there_is_all_that_was_done() {
    all_at_once(&["TERM", "HUP", "INT", "QUIT", "line"], |end| {
        let ground = Ground::new();
        let mut lab = paused_at(&ground, 30);
        push(&mut lab);
        steps(&mut lab, "5.", 35);
        let code = ended(&mut lab, end);
        let signals = ["HUP", "INT", "QUIT", "TERM"]
            .iter()
            .zip([129, 130, 131, 143]);
        for (_, expected) in signals.filter(|(signal, _)| **signal == end) {
            assert_eq!(code, expected, "{end}");
            lab.has_given_the_terminal_back();
            let farewell = format!("{LEAVES_ALTERNATE_SCREEN}{SHOWS_CURSOR}");
            assert!(lab.sent_text().ends_with(&farewell), "{end}");
        }
        let mut after = resumed(&ground);
        assert_eq!(after.step(), Some(35), "{end}");
        let run = saved(&mut after, "run.toml");
        assert!(run.contains("[[push]]"), "{end}: {run}");
    });
}

#[test]
#[cfg(debug_assertions)]
fn after_a_panic_there_is_all_that_was_done() {
    let ground = Ground::new();
    let panic = ("GYROLAB_PANIC_AFTER_MS", "3000");
    let variables = [("TERM", "xterm"), ("LANG", "C.UTF-8"), panic];
    let mut lab = ground.open_with("--paused --at 30", &variables);
    lab.wait_for("L lessons");
    push(&mut lab);
    steps(&mut lab, "5.", 35);
    assert_eq!(lab.wait_for_end().exit_code(), 101);
    lab.has_given_the_terminal_back();
    lab.wait_until("the message", |lab| {
        let sent = lab.sent_text();
        let mut after = sent.split(LEAVES_ALTERNATE_SCREEN).skip(1);
        after
            .next()
            .is_some_and(|farewell| farewell.contains("a panic was asked for"))
            && after.next().is_none()
    });
    let mut after = resumed(&ground);
    assert_eq!(after.step(), Some(35));
    assert!(saved(&mut after, "run.toml").contains("[[push]]"));
}

#[test]
fn a_shell_stops_it_and_brings_it_back() {
    let ground = Ground::new();
    let mut lab = ground.open_shell();
    lab.wait_for("shell>");
    let program = env!("CARGO_BIN_EXE_gyrolab");
    lab.press(&format!("{program} --paused --at 30\r"));
    lab.wait_for("L lessons");
    push(&mut lab);
    lab.press(CTRL_Z);
    lab.has_given_the_terminal_back();
    lab.ask("\r", "shell>");
    lab.forget();
    lab.press("echo the shell $((6 * 7))\r");
    lab.wait_for("the shell 42");
    lab.press("fg\r");
    lab.wait_for("L lessons");
    lab.wait_for_step(30);
    steps(&mut lab, "5.", 35);
    lab.press("q");
    lab.has_given_the_terminal_back();
    lab.press("exit\r");
    lab.wait_for_end();
    let mut after = resumed(&ground);
    assert_eq!(after.step(), Some(35));
    assert!(saved(&mut after, "run.toml").contains("[[push]]"));
}

#[test]
fn two_labs_have_two_sessions_and_a_third_begins_anew() {
    let ground = Ground::new();
    let mut labs = [paused_at(&ground, 30), paused_at(&ground, 50)];
    assert_eq!(ground.kept(".lock").len(), 2);
    let [older, newer] = &mut labs;
    push(older);
    wait_until_kept(older, &ground);
    push(newer);
    newer.press("7.");
    newer.wait_for_step(57);
    wait_until_kept(newer, &ground);
    labs.iter_mut().for_each(Terminal::kill);
    let first = resumed(&ground);
    first.wait_for_step(57);
    let second = resumed(&ground);
    second.wait_for_step(30);
    let third = ground.open("--resume");
    third.wait_for("newer sessions are open in other labs");
    third.wait_for("this is a new one");
    third.wait_for("Method 2");
}

/// Waits until the step of `lab` is on the disk.
fn wait_until_kept(lab: &Terminal, ground: &Ground) {
    let step = format!("step = {}\n", lab.step().unwrap());
    lab.wait_until("what it does on the disk", |_| kept(ground).contains(&step));
}

#[test]
fn without_a_session_resume_opens_a_new_lab_and_says_so() {
    let ground = Ground::new();
    let mut lab = ground.open("--resume --paused");
    lab.wait_for("no session to come back to: this is a new one");
    push(&mut lab);
    lab.quit();
    assert!(resumed(&ground).words().contains("Method 2"));
}

#[test]
fn a_damaged_session_is_named_and_left_alone() {
    let ground = Ground::new();
    let mut lab = paused_at(&ground, 30);
    push(&mut lab);
    lab.quit();
    let [name] = &ground.kept(".session")[..] else {
        panic!("{:?}", ground.kept(""))
    };
    let path = ground.state().join("gyrolab").join(name);
    let text = fs::read_to_string(&path).unwrap();
    fs::write(&path, &text[..text.len() / 2]).unwrap();
    let mut after = ground.open("--resume");
    after.wait_for("is left alone (it has been cut off or changed)");
    after.wait_for("Method 2");
    after.press(" ");
    after.quit();
    assert_eq!(fs::read_to_string(&path).unwrap(), text[..text.len() / 2]);
    // The lab that was opened instead has a session of its own.
    resumed(&ground);
}

#[test]
fn without_a_place_for_sessions_the_lab_opens_and_says_so() {
    let ground = Ground::new();
    fs::write(ground.state(), "in the way").unwrap();
    for (args, words) in [
        ("--paused --at 30", "sessions cannot be saved in"),
        ("--resume", "session not saved"),
    ] {
        let mut lab = ground.open(args);
        lab.wait_for(words);
        push(&mut lab);
        lab.quit();
        assert_eq!(ground.read("state"), "in the way");
    }
}

#[test]
fn a_place_for_sessions_that_is_lost_is_told_of_and_found_again() {
    let ground = Ground::new();
    let mut lab = paused_at(&ground, 30);
    wait_until_kept(&lab, &ground);
    let folder = ground.state().join("gyrolab");
    fs::remove_dir_all(&folder).unwrap();
    fs::write(&folder, "in the way").unwrap();
    lab.press(".");
    lab.wait_for("the session cannot be saved");
    let said = lab.words();
    assert_eq!(said.matches("cannot be saved:").count(), 1, "{said}");
    fs::remove_file(&folder).unwrap();
    push(&mut lab);
    wait_until_kept(&lab, &ground);
    lab.kill();
    assert_eq!(resumed(&ground).step(), Some(31));
}

/// A lab that resumes at a far step is on its way for a second. If it ends on the way, it must still resume there.
#[test]
#[ignore = "goes 12 million steps, four times: ten seconds"]
fn an_end_on_the_way_back_costs_nothing() {
    let ground = Ground::new();
    let mut lab = paused_at(&ground, 12_000_000);
    push(&mut lab);
    wait_until_kept(&lab, &ground);
    lab.quit();
    for _ in 0..2 {
        let mut after = ground.open("--resume");
        after.wait_for("to go, Esc stops");
        after.signal("HUP");
        after.wait_for_end();
    }
    let last = resumed(&ground);
    assert_eq!(last.step(), Some(12_000_000));
}

/// On the way to a step that the user asked for, it resumes at the step that it had reached.
#[test]
fn an_end_on_the_way_further_costs_nothing_either() {
    let ground = Ground::new();
    paused_at(&ground, 40).quit();
    let mut lab = resumed(&ground);
    lab.ask("900000000.", "to go, Esc stops");
    lab.wait_until("a step further on", |lab| lab.step() > Some(1000));
    let step = lab.step();
    ended(&mut lab, "HUP");
    let after = resumed(&ground);
    assert!(after.step() >= step, "{:?} {step:?}", after.step());
}

/// What a session must contain after a kill.
struct Kept {
    /// The step at which the run was saved, and the run file.
    step: u64,
    run: String,
    /// A step that the lab showed more than a second before the kill, and how many pushes the run had then.
    reached: u64,
    pushes: usize,
}

/// What the screen showed at some time.
struct Observed {
    at: Instant,
    step: u64,
    pushes: usize,
}

#[test]
#[ignore = "uses the lab for a second or two before each kill: ten seconds"]
fn twenty_kills_cost_no_more_than_the_last_second() {
    thread::scope(|scope| {
        for seed in 1..=4 {
            scope.spawn(move || five_kills(seed));
        }
    });
}

fn five_kills(seed: u64) {
    let mut dice = Dice(0x9e37_79b9_7f4a_7c15_u64.wrapping_mul(seed));
    let ground = Ground::new();
    let mut lab = paused_at(&ground, 20);
    for kill in 0..5 {
        let kept = is_used_until_killed(&mut lab, &mut dice, kill);
        lab = resumed(&ground);
        let context = format!("seed {seed}, kill {kill}");
        let step = lab.step().unwrap();
        assert!(step >= kept.reached, "{context}: {step} {}", kept.reached);
        let all = saved(&mut lab, &format!("all-{kill}.toml"));
        let pushes = all.matches("[[push]]").count();
        assert!(pushes >= kept.pushes, "{context}: {pushes} {}", kept.pushes);
        go_to(&mut lab, kept.step);
        let again = saved(&mut lab, &format!("again-{kill}.toml"));
        assert_eq!(again, kept.run, "{context}");
    }
}

/// Changes the run at random and saves it; then adds to it for a second or two, and is killed.
fn is_used_until_killed(lab: &mut Terminal, dice: &mut Dice, kill: usize) -> Kept {
    for _ in 0..dice.whole(1, 6) {
        changes_something(lab, dice);
    }
    let step = dice.whole(10, 400);
    go_to(lab, step);
    let run = saved(lab, &format!("run-{kill}.toml"));
    let pushes = run.matches("[[push]]").count();
    let mut seen = vec![Observed {
        at: Instant::now(),
        step,
        pushes,
    }];
    steps(lab, ".", step + 1);
    let until = Instant::now() + Duration::from_millis(dice.whole(1000, 1900));
    while Instant::now() < until {
        let given = adds_something(lab, dice);
        seen.push(Observed {
            at: Instant::now(),
            step: lab.step().unwrap(),
            pushes: seen.last().map_or(0, |seen| seen.pushes) + given,
        });
        thread::sleep(Duration::from_millis(dice.whole(0, 150)));
    }
    let killed = Instant::now();
    lab.kill();
    let old = seen
        .iter()
        .rfind(|seen| seen.at + Duration::from_secs(1) <= killed)
        .unwrap();
    Kept {
        step,
        run,
        reached: old.step,
        pushes: old.pushes,
    }
}

/// A random change of the run, at any of its steps.
fn changes_something(lab: &mut Terminal, dice: &mut Dice) {
    match dice.whole(0, 7) {
        0 => push(lab),
        1 => select(lab, "gravity"),
        2 => lab.press(&format!("3{}", dice.pick(&[LEFT, RIGHT]))),
        3 => go_to(lab, dice.whole(1, 500)),
        4 => lab.press(dice.pick(&["u", "2u", "U", "7,"])),
        5 => {
            select(lab, "dt");
            set(lab, dice.pick(&["0.05", "0.02", "0.1"]));
        }
        6 => {
            select(lab, "tilt");
            set(lab, dice.pick(&["30", "45", "60"]));
        }
        _ => lab.press(dice.pick(&[".", "30.", "m", "w", "t"])),
    }
}

/// A random action that only adds to the run; returns how many pushes it gave.
fn adds_something(lab: &mut Terminal, dice: &mut Dice) -> usize {
    match dice.whole(0, 4) {
        0 => {
            push(lab);
            return 1;
        }
        1 => lab.press(" "),
        // The speed is never raised: the run must not reach its end, whose message would replace that of a push.
        _ => lab.press(dice.pick(&[".", "5.", "-", "w"])),
    }
    0
}
