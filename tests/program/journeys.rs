//! Complete sessions of a user, with checks of the screen and the disk. The real program runs in a pty.

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

/// Opens the lab with Method 2, paused at `step`.
fn paused_at(ground: &Ground, step: u64) -> Terminal {
    let step = step.to_string();
    let lab = ground.open(&format!("--paused --at {step}"));
    lab.wait_for("L lessons");
    lab
}

/// Resumes the newest session and waits for the step at which it was closed.
fn resumed(ground: &Ground) -> Terminal {
    let lab = ground.open("--resume");
    lab.wait_for(AS_LEFT);
    lab.wait_for("paused");
    lab
}

/// Replaces the text of the open dialog with `text` and confirms it.
fn answer_dialog(lab: &mut Terminal, text: &str) {
    lab.press(&format!("{CLEAR}{text}\r"));
}

/// Selects the value `name` by the filter of the values pane.
#[track_caller]
fn select(lab: &mut Terminal, name: &str) {
    lab.press("/");
    lab.ask(name, &format!("/{name}_"));
    lab.press(ESC);
    lab.wait_until("all values", |shown| {
        !shown.words().contains(&format!("/{name}"))
    });
}

/// Sets the selected value to `value` and reruns.
fn set(lab: &mut Terminal, value: &str) {
    lab.ask("\r", "Enter: ");
    answer_dialog(lab, value);
}

/// Sets the selected value to `value` from the next step on.
fn set_from_now_on(lab: &mut Terminal, value: &str) {
    lab.ask("\r", "Enter: rerun from the start");
    lab.ask("\t", "Enter: from now on");
    answer_dialog(lab, value);
}

/// Jumps to `step` after all earlier keys have taken effect.
#[track_caller]
fn go_to(lab: &mut Terminal, step: u64) {
    lab.ask(&step.to_string(), &format!("{step}: press a key"));
    lab.press("g");
    let goal = format!("step {step}");
    lab.wait_until(&goal, |lab| {
        lab.step() == Some(step) && !lab.screen().contains("press a key")
    });
}

/// Presses `keys` that move by steps, and waits for `step`.
#[track_caller]
fn steps(lab: &mut Terminal, keys: &str, step: u64) {
    lab.press(keys);
    lab.wait_for_step(step);
}

/// Applies the next push, and waits for the message about it.
#[track_caller]
fn push(lab: &mut Terminal) {
    lab.ask("1", "1: press a key"); // clears the message about the previous push
    lab.press("p");
    lab.wait_until("a push", |lab| {
        let words = lab.words();
        words.contains("pushed: ") || words.contains("discarded")
    });
}

/// Saves the run file as `name` and returns its text.
#[track_caller]
fn save_run(lab: &mut Terminal, name: &str) -> String {
    lab.ask("s", "save the run file");
    answer_dialog(lab, name);
    lab.wait_for("the run is in");
    lab.ground().read(name)
}

/// Exports every row to `name` and returns the bytes.
#[track_caller]
fn export_run(lab: &mut Terminal, name: &str) -> Vec<u8> {
    lab.ask("x", "export steps 0 to");
    answer_dialog(lab, name);
    lab.wait_for("wrote ");
    assert!(!lab.screen().contains("scp "), "not over SSH");
    fs::read(lab.ground().file(name)).unwrap()
}

/// Returns the CSV that `gyrolab run` writes for the file `name`.
fn run(ground: &Ground, name: &str) -> Vec<u8> {
    done(ground.run(&format!("run {name} -o -"))).stdout
}

/// Returns the step, the time and the position of the axle top shown on the screen.
fn shown(lab: &Terminal) -> [Option<String>; 3] {
    let shown = ["x m", "y m", "z m"].map(|label| lab.value(label));
    let is_whole = shown.iter().all(Option::is_some);
    assert!(is_whole, "{}", lab.screen());
    shown
}

#[test]
fn values_are_nudged_typed_rejected_and_undone() {
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
        lab.wait_for(&format!("{value}_")); // the text stays for correction
        lab.ask(ESC, "L lessons");
        lab.wait_for("dt 0.05 s");
    }
    set(&mut lab, "-1");
    lab.wait_for("greater than zero");
    answer_dialog(&mut lab, "0.02");
    lab.wait_for("dt 0.02 s");
    for dt in ["0.05", "0.2", "0.1"] {
        lab.ask("u", &format!("dt {dt} s"));
    }
    lab.ask("u", "nothing to undo");
    for dt in ["0.2", "0.05"] {
        lab.ask("U", &format!("dt {dt} s"));
    }
    lab.wait_for_step(200);
    let run = save_run(&mut lab, "run.toml");
    assert_eq!(run.matches("[[edit]]").count(), 0, "{run}");
    has(&run, "\ntime_step_s = 0.05\n");
    set_from_now_on(&mut lab, "0.1");
    lab.wait_for("dt 0.1 s");
    steps(&mut lab, ".", 201);
    let edited = save_run(&mut lab, "edited.toml");
    has(&edited, "[[edit]]\nstep = 200\n");
    has(&edited, "\"motion.time_step_s\" = 0.1");
    lab.quit();
}

/// The exported run contains every kind of change.
#[test]
fn an_export_equals_the_csv_of_the_saved_run() {
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
    assert_eq!(ground.files(), ["state"], "no files of a canceled export");
    let csv = export_run(&mut lab, "run.csv");
    save_run(&mut lab, "run.toml");
    assert!(csv == run(&ground, "run.toml"), "other bytes");
    assert!(csv == run(&ground, "run.csv"), "other bytes from the CSV");

    // An existing file is replaced only after a second confirmation.
    fs::write(ground.file("mine.csv"), "mine").unwrap();
    lab.ask("x", "file method-2.csv_");
    lab.press(ESC);
    lab.wait_for("L lessons");
    lab.ask("x", "export steps 0 to 285");
    answer_dialog(&mut lab, "mine.csv");
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
    answer_dialog(&mut lab, "here.toml");
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
fn a_rejected_export_gives_the_reason_and_loses_nothing() {
    let ground = Ground::new();
    let mut lab = paused_at(&ground, 50);
    fs::create_dir(ground.file("gone")).unwrap();
    lab.ask("x", "export steps 0 to 50");
    lab.press(&format!("{CLEAR}gone/run.csv"));
    lab.wait_for("gone/run.csv_");
    fs::remove_dir(ground.file("gone")).unwrap();
    lab.ask("\r", "there is no folder");
    answer_dialog(&mut lab, "state");
    lab.wait_for("is a folder");
    let locked = ground.file("locked");
    fs::create_dir(&locked).unwrap();
    let mut rights = fs::metadata(&locked).unwrap().permissions();
    rights.set_readonly(true);
    fs::set_permissions(&locked, rights).unwrap();
    if fs::write(locked.join("probe"), "").is_err() {
        answer_dialog(&mut lab, "locked/run.csv");
        lab.wait_for("Permission denied");
    }
    answer_dialog(&mut lab, "/dev/full");
    lab.wait_for("not a regular file");
    answer_dialog(&mut lab, "run.csv");
    lab.wait_for("wrote ");
    lab.wait_for_step(50);
    lab.quit();
}

#[test]
fn an_export_into_a_deleted_folder_fails_and_the_lab_continues() {
    let ground = Ground::new();
    fs::create_dir(ground.file("gone")).unwrap();
    let mut lab = long_run(&ground);
    lab.ask("x", "export steps 0 to");
    answer_dialog(&mut lab, "gone/run.csv");
    lab.wait_for("in the background");
    fs::remove_dir_all(ground.file("gone")).unwrap();
    lab.wait_for("cannot write");
    steps(&mut lab, ".", LONG + 1);
    lab.quit();
}

/// The number of steps of a run that plays in less than a second, but takes seconds to export.
const LONG: u64 = 1_000_000;

fn long_run(ground: &Ground) -> Terminal {
    let step = LONG.to_string();
    let lab = ground.open(&format!("--paused --at {step}"));
    lab.wait_for_step(LONG);
    lab
}

fn begin_export(lab: &mut Terminal) {
    lab.ask("x", "export steps 0 to");
    answer_dialog(lab, "run.csv");
    lab.wait_for("in the background");
}

#[test]
fn esc_and_a_second_q_stop_an_export_and_leave_no_file() {
    let ground = Ground::new();
    let mut lab = long_run(&ground);
    begin_export(&mut lab);
    lab.press(ESC); // closes the notice, if it is still there
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
fn a_lost_line_during_an_export_is_reported_and_leaves_no_file() {
    all_at_once(&["HUP", "line"], |end| {
        let ground = Ground::new();
        let mut lab = long_run(&ground);
        begin_export(&mut lab);
        end_by(&mut lab, end);
        assert_eq!(ground.files(), ["state"], "{end}");
        let resumed_lab = ground.open("--resume");
        resumed_lab.wait_for("run.csv was cut off, x starts another");
        resumed_lab.wait_for_step(LONG);
    });
}

/// Runs `test` for all `cases` in parallel, since they mostly wait.
fn all_at_once(cases: &[&str], test: impl Fn(&str) + Sync) {
    thread::scope(|scope| {
        for case in cases {
            scope.spawn(|| test(case));
        }
    });
}

/// Ends the lab by the signal `by`, or by closing its line. Returns its exit code.
fn end_by(lab: &mut Terminal, by: &str) -> u32 {
    match by {
        "line" => lab.lose_line(),
        signal => lab.signal(signal),
    }
    lab.wait_for_end().exit_code()
}

/// Returns the contents of all session files.
fn kept(ground: &Ground) -> String {
    let folder = ground.state().join("gyrolab");
    let names = ground.session_files(".session").into_iter();
    let texts = names.filter_map(|name| fs::read_to_string(folder.join(name)).ok());
    texts.collect()
}

#[test]
fn a_run_edited_at_every_screen_size_is_resumed() {
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
    answer_dialog(&mut lab, "0.05");
    lab.resize((1, 1));
    lab.press("40.");
    lab.press("s"); // a dialog that the screen is too small to show
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
    let before = save_run(&mut lab, "before.toml");
    assert!(before.contains("[[push]]") && before.contains("[[edit]]"));
    let step = lab.step().unwrap();
    lab.quit();

    let mut second = resumed(&ground);
    assert_eq!(second.step(), Some(step));
    assert_eq!(save_run(&mut second, "after.toml"), before);
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

    // Undone changes stay undone, and the other run still exists.
    let mut third = resumed(&ground);
    third.press("u");
    third.wait_for("dt 0.1 s");
    third.quit();
    let mut fourth = resumed(&ground);
    fourth.press("U");
    fourth.wait_for("dt 0.05 s");
    go_to(&mut fourth, step);
    assert_eq!(save_run(&mut fourth, "again.toml"), before);
    fourth.quit();
}

#[test]
fn a_briefly_small_screen_is_redrawn() {
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
fn no_key_is_lost_during_a_resize() {
    let ground = Ground::new();
    let mut lab = paused_at(&ground, 40);
    for step in 41..100 {
        lab.resize((80, 24 + step as u16 % 2));
        steps(&mut lab, ".", step);
    }
    lab.quit();
}

/// A fast typist on a slow line may send keys together with the key that quits.
#[test]
fn keys_pressed_just_before_the_end_are_saved() {
    all_at_once(&["q", "\u{3}"], |end| {
        let ground = Ground::new();
        let mut lab = paused_at(&ground, 30);
        lab.press(&format!("p{end}"));
        drop(lab.wait_for_end());
        let mut after = resumed(&ground);
        let run = save_run(&mut after, "run.toml");
        assert!(run.contains("[[push]]"), "{end:?}: {run}");
    });
}

#[test]
fn every_way_to_end_the_lab_saves_all_changes() {
    all_at_once(&["TERM", "HUP", "INT", "QUIT", "line"], |end| {
        let ground = Ground::new();
        let mut lab = paused_at(&ground, 30);
        push(&mut lab);
        steps(&mut lab, "5.", 35);
        let code = end_by(&mut lab, end);
        let signals = ["HUP", "INT", "QUIT", "TERM"]
            .iter()
            .zip([129, 130, 131, 143]);
        for (_, expected) in signals.filter(|(signal, _)| **signal == end) {
            assert_eq!(code, expected, "{end}");
            lab.assert_terminal_restored();
            let farewell = format!("{LEAVES_ALTERNATE_SCREEN}{SHOWS_CURSOR}");
            assert!(lab.sent_text().ends_with(&farewell), "{end}");
        }
        let mut after = resumed(&ground);
        assert_eq!(after.step(), Some(35), "{end}");
        let run = save_run(&mut after, "run.toml");
        assert!(run.contains("[[push]]"), "{end}: {run}");
    });
}

#[test]
#[cfg(debug_assertions)]
fn a_panic_saves_all_changes() {
    let ground = Ground::new();
    let panic = ("GYROLAB_PANIC_AFTER_MS", "3000");
    let variables = [("TERM", "xterm"), ("LANG", "C.UTF-8"), panic];
    let mut lab = ground.open_with("--paused --at 30", &variables);
    lab.wait_for("L lessons");
    push(&mut lab);
    steps(&mut lab, "5.", 35);
    assert_eq!(lab.wait_for_end().exit_code(), 101);
    lab.assert_terminal_restored();
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
    assert!(save_run(&mut after, "run.toml").contains("[[push]]"));
}

#[test]
fn a_shell_suspends_and_resumes_the_lab() {
    let ground = Ground::new();
    let mut lab = ground.open_shell();
    lab.wait_for("shell>");
    let program = env!("CARGO_BIN_EXE_gyrolab");
    lab.press(&format!("{program} --paused --at 30\r"));
    lab.wait_for("L lessons");
    push(&mut lab);
    lab.press(CTRL_Z);
    lab.assert_terminal_restored();
    lab.ask("\r", "shell>");
    lab.clear_output();
    lab.press("echo the shell $((6 * 7))\r");
    lab.wait_for("the shell 42");
    lab.press("fg\r");
    lab.wait_for("L lessons");
    lab.wait_for_step(30);
    steps(&mut lab, "5.", 35);
    lab.press("q");
    lab.assert_terminal_restored();
    lab.press("exit\r");
    lab.wait_for_end();
    let mut after = resumed(&ground);
    assert_eq!(after.step(), Some(35));
    assert!(save_run(&mut after, "run.toml").contains("[[push]]"));
}

#[test]
fn two_labs_have_two_sessions_and_a_third_starts_a_new_one() {
    let ground = Ground::new();
    let mut labs = [paused_at(&ground, 30), paused_at(&ground, 50)];
    assert_eq!(ground.session_files(".lock").len(), 2);
    let [older, newer] = &mut labs;
    push(older);
    wait_until_saved(older, &ground);
    push(newer);
    newer.press("7.");
    newer.wait_for_step(57);
    wait_until_saved(newer, &ground);
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

/// Waits until the step of `lab` is saved.
fn wait_until_saved(lab: &Terminal, ground: &Ground) {
    let step = format!("step = {}\n", lab.step().unwrap());
    lab.wait_until("what it does on the disk", |_| kept(ground).contains(&step));
}

#[test]
fn resume_without_a_session_reports_it_and_opens_a_new_lab() {
    let ground = Ground::new();
    let mut lab = ground.open("--resume --paused");
    lab.wait_for("no session to resume: this is a new one");
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
    let [name] = &ground.session_files(".session")[..] else {
        panic!("{:?}", ground.session_files(""))
    };
    let path = ground.state().join("gyrolab").join(name);
    let text = fs::read_to_string(&path).unwrap();
    fs::write(&path, &text[..text.len() / 2]).unwrap();
    let mut after = ground.open("--resume");
    after.wait_for("was skipped (it has been cut off or changed)");
    after.wait_for("Method 2");
    after.press(" ");
    after.quit();
    assert_eq!(fs::read_to_string(&path).unwrap(), text[..text.len() / 2]);
    // The lab that opened instead has its own session.
    resumed(&ground);
}

#[test]
fn an_unusable_session_folder_is_reported_when_the_lab_opens() {
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
fn a_lost_session_folder_is_reported_and_restored() {
    let ground = Ground::new();
    let mut lab = paused_at(&ground, 30);
    wait_until_saved(&lab, &ground);
    let folder = ground.state().join("gyrolab");
    fs::remove_dir_all(&folder).unwrap();
    fs::write(&folder, "in the way").unwrap();
    lab.press(".");
    lab.wait_for("the session cannot be saved");
    let said = lab.words();
    assert_eq!(said.matches("cannot be saved:").count(), 1, "{said}");
    fs::remove_file(&folder).unwrap();
    push(&mut lab);
    wait_until_saved(&lab, &ground);
    lab.kill();
    assert_eq!(resumed(&ground).step(), Some(31));
}

/// Resuming at a distant step takes a second. If the lab ends meanwhile, the session must still resume at that step.
#[test]
#[ignore = "goes 12 million steps, four times: ten seconds"]
fn an_end_while_resuming_loses_nothing() {
    let ground = Ground::new();
    let mut lab = paused_at(&ground, 12_000_000);
    push(&mut lab);
    wait_until_saved(&lab, &ground);
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

/// A lab that ends during a seek resumes at the step that it had reached.
#[test]
fn an_end_while_seeking_loses_nothing() {
    let ground = Ground::new();
    paused_at(&ground, 40).quit();
    let mut lab = resumed(&ground);
    lab.ask("900000000.", "to go, Esc stops");
    lab.wait_until("a step further on", |lab| lab.step() > Some(1000));
    let step = lab.step();
    end_by(&mut lab, "HUP");
    let after = resumed(&ground);
    assert!(after.step() >= step, "{:?} {step:?}", after.step());
}

/// The minimum contents of a session after a kill.
struct ExpectedSession {
    /// The step at which the run file was saved.
    step: u64,
    run: String,
    /// A step that the lab showed more than a second before the kill, and how many pushes the run had then.
    reached: u64,
    pushes: usize,
}

/// The contents of the screen at some time.
struct Observed {
    at: Instant,
    step: u64,
    pushes: usize,
}

#[test]
#[ignore = "uses the lab for a second or two before each kill: ten seconds"]
fn twenty_kills_lose_at_most_the_last_second() {
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
        let kept = use_until_killed(&mut lab, &mut dice, kill);
        lab = resumed(&ground);
        let context = format!("seed {seed}, kill {kill}");
        let step = lab.step().unwrap();
        assert!(step >= kept.reached, "{context}: {step} {}", kept.reached);
        let all = save_run(&mut lab, &format!("all-{kill}.toml"));
        let pushes = all.matches("[[push]]").count();
        assert!(pushes >= kept.pushes, "{context}: {pushes} {}", kept.pushes);
        go_to(&mut lab, kept.step);
        let again = save_run(&mut lab, &format!("again-{kill}.toml"));
        assert_eq!(again, kept.run, "{context}");
    }
}

/// Changes the run at random and saves it. Then adds to it for a second or two, and kills the lab.
fn use_until_killed(lab: &mut Terminal, dice: &mut Dice, kill: usize) -> ExpectedSession {
    for _ in 0..dice.whole(1, 6) {
        make_random_change(lab, dice);
    }
    let step = dice.whole(10, 400);
    go_to(lab, step);
    let run = save_run(lab, &format!("run-{kill}.toml"));
    let pushes = run.matches("[[push]]").count();
    let mut seen = vec![Observed {
        at: Instant::now(),
        step,
        pushes,
    }];
    steps(lab, ".", step + 1);
    let until = Instant::now() + Duration::from_millis(dice.whole(1000, 1900));
    while Instant::now() < until {
        let given = make_random_addition(lab, dice);
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
    ExpectedSession {
        step,
        run,
        reached: old.step,
        pushes: old.pushes,
    }
}

/// Makes a random change to the run at any of its steps.
fn make_random_change(lab: &mut Terminal, dice: &mut Dice) {
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

/// Performs a random action that only adds to the run. Returns the number of pushes added.
fn make_random_addition(lab: &mut Terminal, dice: &mut Dice) -> usize {
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
