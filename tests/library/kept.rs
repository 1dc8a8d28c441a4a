//! The lab as a session keeps it: what was done comes back, however much it was.

use crate::support::desk::Desk;
use crate::support::scenarios::{self, preset};
use gyrolab::lab::command::{self, Command};
use gyrolab::scenario::Document;
use gyrolab::storage::session::Content;
use gyrolab::tui::keymap::Key;
use gyrolab::tui::screen;
use std::time::Duration;

/// The lab as `content` has it, arrived where it was left.
#[track_caller]
fn resumed(content: &Content) -> Desk {
    let mut desk = Desk::of(scenarios::resumed(content));
    desk.wait(2);
    desk
}

/// Goes to a step and then gives `count` pushes, each one step earlier than the one before.
fn pushed_backwards(count: usize) -> Desk {
    let mut desk = Desk::open("method-2");
    desk.commands("go_to = 600");
    desk.commands(&"push = true\nstep = -1\n".repeat(count));
    desk
}

#[test]
fn any_number_of_acts_each_earlier_than_the_one_before_comes_back() {
    let mut desk = pushed_backwards(200);
    let content = desk.lab.content();
    let mut back = resumed(&content);
    assert_eq!(back.step(), 400);
    for step in 402..=600 {
        back.commands("undo = 1");
        assert_eq!(back.step(), step - 1, "the undo of the push there");
    }
    assert_eq!(back.scenario().file.push.len(), 1);
    back.commands("undo = 1");
    assert_eq!(back.scenario().file.push.len(), 0);
    let refused = back.carry_out(&Command::Undo(1)).unwrap_err();
    assert_eq!(refused.to_string(), "nothing to undo");
}

#[test]
fn what_is_kept_grows_with_the_number_of_acts() {
    let length = |count| pushed_backwards(count).lab.content().work.len();
    let (few, more, most) = (length(50), length(100), length(200));
    let (first, second) = (more - few, most - more);
    let is_even = second.abs_diff(2 * first) < first / 10;
    assert!(is_even, "{few} {more} {most}");
}

/// The times (s) at which the pushes of the run begin that have been given in the lab, and how many edits there are.
fn done(desk: &Desk) -> (Vec<f64>, usize) {
    let file = desk.scenario().file;
    let from = file.push.iter().filter_map(|push| push.from_s);
    (from.collect(), file.edit.len())
}

/// A lab that has begun to carry out the commands in `text`, the lines of a `[[do]]` each.
fn with_script(preset: &str, text: &str) -> Desk {
    let mut desk = Desk::open(preset);
    let tables = text.lines().map(|line| format!("[[do]]\n{line}\n"));
    let file: String = tables.collect();
    let document = Document::parse("demo.toml", &file).unwrap();
    desk.lab.take_commands(command::read(&document).unwrap());
    desk
}

fn seconds(desk: &mut Desk, seconds: u32) {
    (0..10 * seconds).for_each(|_| desk.pass(Duration::from_millis(100)));
}

#[test]
fn what_is_shown_and_hidden_comes_back() {
    let mut desk = Desk::open("loops");
    desk.commands("step = 300\nshow = ['traces', '3d']\nhide = ['health', 'predicted']");
    desk.commands("look_at = 'the dip'\ncamera = { yaw_deg = 75, pitch_deg = -10 }");
    for fill in ["none", "3d"] {
        desk.commands(&format!("fill = '{fill}'"));
        let mut back = resumed(&desk.lab.content());
        desk.press(&[Key::Esc]); // no message hides the line
        back.press(&[Key::Esc]);
        desk.commands(&format!("fill = '{fill}'"));
        back.commands(&format!("fill = '{fill}'"));
        let picture = |desk: &mut Desk| {
            desk.wait(100);
            screen::text(&desk.lab, true, (120, 40))
        };
        assert_eq!(picture(&mut back), picture(&mut desk));
        assert_eq!(back.lab.view().focus, desk.lab.view().focus);
    }
    // What the file hides, and the lab has shown again.
    let hiding = preset("loops", &["view.hide=['traces']"]);
    let mut desk = Desk::with("loops", hiding);
    desk.commands("hide = []");
    assert_eq!(resumed(&desk.lab.content()).lab.view().hidden, []);
}

#[test]
fn what_is_left_of_a_script_waits_for_space_and_goes_on() {
    let text = "speed = 20\nrun_until = 't_s >= 20'\nwait_s = 5\nstep = 7\npush = true\nstep = 3";
    let mut desk = with_script("method-2", text);
    (0..5).for_each(|_| desk.pass(Duration::from_millis(100)));
    let left_at = desk.step();
    assert!((50..150).contains(&left_at), "{left_at}");
    let mut back = resumed(&desk.lab.content());
    seconds(&mut back, 20);
    assert_eq!((back.step(), back.lab.script().is_done()), (left_at, false));
    let told = back.lab.notice().unwrap();
    assert!(told.contains("5 commands of demo.toml are left"), "{told}");
    // Kept again before it goes on, it is the same.
    let mut back = resumed(&back.lab.content());
    back.press(&[Key::Char(' ')]);
    seconds(&mut back, 3);
    // It plays until the condition holds, and waits.
    assert_eq!(back.step(), 200);
    let mut waiting = resumed(&back.lab.content());
    waiting.press(&[Key::Char(' ')]);
    seconds(&mut waiting, 4);
    assert_eq!(waiting.step(), 200, "the wait begins again");
    for mut desk in [waiting, back] {
        seconds(&mut desk, 5);
        assert_eq!((desk.step(), desk.lab.script().is_done()), (210, true));
        assert_eq!(done(&desk).0.len(), 1);
    }
}

#[test]
fn steps_under_way_in_a_script_come_back() {
    let mut desk = with_script("method-2", "step = 40000\nundo = 1");
    let content = desk.lab.content();
    let mut back = resumed(&content);
    assert!(back.step() < 40_000, "it has not been told to go on");
    back.press(&[Key::Char(' ')]);
    assert_eq!(back.step(), 40_000);
    let told = back.lab.notice().unwrap();
    assert!(told.contains("demo.toml: undo: nothing to undo"), "{told}");
}

#[test]
fn esc_drops_what_is_left_of_a_script() {
    let mut desk = with_script("method-2", "wait_s = 5\nstep = 7");
    let mut back = resumed(&desk.lab.content());
    back.press(&[Key::Esc]);
    let words = "stopped: 2 commands are left out";
    assert_eq!(back.lab.notice().as_deref(), Some(words));
    seconds(&mut back, 10);
    assert_eq!((back.step(), back.lab.script().is_done()), (0, true));
    assert!(resumed(&back.lab.content()).lab.script().is_done());
    let again = desk.lab.content();
    let broken = Content {
        place: again.place.replace("step = 7", "stap = 7"),
        ..again
    };
    let back = scenarios::resumed(&broken);
    assert!(back.script().is_done());
    let told = back.notice().unwrap();
    assert!(told.contains("did you mean step?"), "{told}");
}

/// Waits until the pictures of the pinned run are there.
#[track_caller]
fn await_pinned(desk: &mut Desk) {
    for _ in 0..4000 {
        if desk.lab.comparison().pinned().is_some() {
            return;
        }
        std::thread::sleep(Duration::from_millis(5));
        desk.wait(1);
    }
    panic!("the pinned run has not come back");
}

#[test]
fn the_pinned_run_comes_back_with_what_was_done_to_it() {
    let mut desk = Desk::open("method-2");
    desk.commands("go_to = '20 s'\npush = true\ngo_to = '40 s'\npin = true");
    desk.commands("set = { 'start.tilt_deg' = 30 }\ngo_to = '10 s'");
    let before = desk.lab.comparison().pinned().unwrap().clone();
    let content = desk.lab.content();
    let mut back = resumed(&content);
    assert!(back.lab.comparison().is_pinned());
    let is_same = |now: Content| now.place == content.place && **now.work == **content.work;
    let made_again = back.lab.content();
    assert!(is_same(made_again), "it is kept while it is made again");
    await_pinned(&mut back);
    assert!(is_same(back.lab.content()));
    let again = back.lab.comparison().pinned().unwrap();
    assert_eq!(again.furthest, before.furthest);
    assert_eq!(again.end_s(), before.end_s());
    assert_eq!(again.marks, before.marks);
    assert_eq!(again.scenario.file.push.len(), 1);
    let dots = |ghost: &gyrolab::playback::ghost::Ghost| ghost.path.dots().collect::<Vec<_>>();
    assert_eq!(dots(again), dots(&before), "the same numbers");
    back.press(&[Key::Char('i')]);
    let none = resumed(&back.lab.content());
    assert!(!none.lab.comparison().is_pinned());
}

#[test]
fn the_present_run_comes_back_pinned() {
    let mut desk = Desk::open("method-2");
    desk.commands("go_to = '40 s'\npin = true");
    let mut back = resumed(&desk.lab.content());
    assert!(back.lab.comparison().is_pinned() && back.lab.comparison().pinned().is_none());
    back.commands("set = { 'start.tilt_deg' = 30 }");
    assert_eq!(back.lab.comparison().pinned().unwrap().end_s(), 40.0);
}
