//! The lab saved in a session and resumed from it.

use crate::support::desk::Desk;
use crate::support::scenarios::{self, preset};
use gyrolab::lab::command::Command;
use gyrolab::lab::storage::session::SessionContent;
use gyrolab::tui::keymap::Key;
use gyrolab::tui::screen;

/// Resumes the lab of `content` and waits until it has reached its step.
#[track_caller]
fn resumed(content: &SessionContent) -> Desk {
    let mut desk = Desk::from_lab(scenarios::resumed(content));
    desk.wait(2);
    desk
}

/// Jumps to a step and then adds `count` pushes, each one step earlier than the previous one.
fn pushed_backwards(count: usize) -> Desk {
    let mut desk = Desk::open("method-2");
    desk.commands("go_to = 600");
    desk.commands(&"push = true\nstep = -1\n".repeat(count));
    desk
}

#[test]
fn undo_restores_backdated_edits_after_resume() {
    let mut desk = pushed_backwards(200);
    let content = desk.lab.content(&Default::default());
    let mut back = resumed(&content);
    assert_eq!(back.step(), 400);
    for step in 402..=600 {
        back.commands("undo = 1");
        assert_eq!(back.step(), step - 1, "undoes the push at that step");
    }
    assert_eq!(back.scenario().file.push.len(), 1);
    back.commands("undo = 1");
    assert_eq!(back.scenario().file.push.len(), 0);
    let refused = back.carry_out(&Command::Undo(1)).unwrap_err();
    assert_eq!(refused.to_string(), "nothing to undo");
}

#[test]
fn the_size_of_a_session_is_linear_in_the_number_of_actions() {
    let length = |count| {
        pushed_backwards(count)
            .lab
            .content(&Default::default())
            .work
            .len()
    };
    let (few, more, most) = (length(50), length(100), length(200));
    let (first, second) = (more - few, most - more);
    let is_even = second.abs_diff(2 * first) < first / 10;
    assert!(is_even, "{few} {more} {most}");
}

#[test]
fn shown_and_hidden_items_are_restored() {
    fn picture(desk: &mut Desk) -> String {
        desk.wait(100);
        screen::text(&desk.lab, true, (120, 40))
    }
    let mut desk = Desk::open("loops");
    desk.commands("step = 300\nshow = ['traces', '3d']\nhide = ['health', 'predicted']");
    desk.commands("look_at = 'the dip'\ncamera = { yaw_deg = 75, pitch_deg = -10 }");
    for fill in ["none", "3d"] {
        desk.commands(&format!("fill = '{fill}'"));
        let mut back = resumed(&desk.lab.content(&Default::default()));
        desk.press(&[Key::Esc]); // clears the message that covers the line
        back.press(&[Key::Esc]);
        desk.commands(&format!("fill = '{fill}'"));
        back.commands(&format!("fill = '{fill}'"));
        assert_eq!(picture(&mut back), picture(&mut desk));
        assert_eq!(back.lab.view().focus, desk.lab.view().focus);
    }
    // An item that the file hides and the lab has shown again.
    let hiding = preset("loops", &["view.hide=['traces']"]);
    let mut hides = Desk::with("loops", hiding);
    hides.commands("hide = []");
    let back = resumed(&hides.lab.content(&Default::default()));
    assert_eq!(back.lab.view().look.hide, []);
}

/// Waits until the pinned run has been recomputed.
#[track_caller]
fn await_pinned(desk: &mut Desk) {
    for _ in 0..4000 {
        if desk.lab.comparison().pinned().is_some() {
            return;
        }
        std::thread::sleep(std::time::Duration::from_millis(5));
        desk.wait(1);
    }
    panic!("the pinned run was not restored");
}

#[test]
fn the_pinned_run_is_restored_with_its_edits() {
    let mut desk = Desk::open("method-2");
    desk.commands("go_to = '20 s'\npush = true\ngo_to = '40 s'\npin = true");
    desk.commands("set = { 'start.tilt_deg' = 30 }\ngo_to = '10 s'");
    let before = desk.lab.comparison().pinned().unwrap().clone();
    let content = desk.lab.content(&Default::default());
    let mut back = resumed(&content);
    assert!(back.lab.comparison().is_pinned());
    let is_same = |now: SessionContent| now.place == content.place && **now.work == **content.work;
    let made_again = back.lab.content(&Default::default());
    assert!(is_same(made_again), "saved while it is recomputed");
    await_pinned(&mut back);
    assert!(is_same(back.lab.content(&Default::default())));
    let again = back.lab.comparison().pinned().unwrap();
    assert_eq!(again.furthest, before.furthest);
    assert_eq!(again.end_s(), before.end_s());
    assert_eq!(again.marks, before.marks);
    assert_eq!(again.scenario.file.push.len(), 1);
    let dots = |ghost: &gyrolab::lab::playback::ghost::Ghost| ghost.path.dots().collect::<Vec<_>>();
    assert_eq!(dots(again), dots(&before), "the same numbers");
    back.press(&[Key::Char('i')]);
    let none = resumed(&back.lab.content(&Default::default()));
    assert!(!none.lab.comparison().is_pinned());
}

#[test]
fn the_current_run_is_restored_as_pinned() {
    let mut desk = Desk::open("method-2");
    desk.commands("go_to = '40 s'\npin = true");
    let mut back = resumed(&desk.lab.content(&Default::default()));
    assert!(back.lab.comparison().is_pinned() && back.lab.comparison().pinned().is_none());
    back.commands("set = { 'start.tilt_deg' = 30 }");
    assert_eq!(back.lab.comparison().pinned().unwrap().end_s(), 40.0);
}
