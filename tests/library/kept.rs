//! The lab as a session keeps it: what was done comes back, however much it was.

use crate::support::desk::Desk;
use crate::support::scenarios::{self, preset};
use gyrolab::lab::command::Command;
use gyrolab::storage::session::Content;
use gyrolab::tui::keymap::Key;
use gyrolab::tui::screen;

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
fn the_present_run_comes_back_pinned() {
    let mut desk = Desk::open("method-2");
    desk.commands("go_to = '40 s'\npin = true");
    let mut back = resumed(&desk.lab.content());
    assert!(back.lab.comparison().is_pinned() && back.lab.comparison().pinned().is_none());
    back.commands("set = { 'start.tilt_deg' = 30 }");
    assert_eq!(back.lab.comparison().pinned().unwrap().end_s(), 40.0);
}
