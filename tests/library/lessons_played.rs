//! Tasks of lessons done with the keys that their pages name, on a screen of 80x24, with the run in view all the time.

use crate::support::stage::{SMALL, Stage};
use gyrolab::lab::sheet::SheetLineKind;
use gyrolab::lab::view::Pane;
use gyrolab::lessons::shipped;
use gyrolab::tui::screen;

/// The task on this page of a lesson.
fn task(lesson: &str, page: usize) -> Stage {
    let mut stage = Stage::open("method-2", &[], SMALL);
    stage.lesson(lesson, page).arrive();
    stage.shows("Your turn");
    stage
}

/// Presses `keys`, each of which leaves page and run in view.
#[track_caller]
fn press(stage: &mut Stage, keys: &str) {
    for key in keys.chars() {
        stage.press(&key.to_string());
        let layout = screen::layout(&stage.lab, true, stage.size);
        for pane in [Pane::Lesson, Pane::Traces] {
            let is_seen = layout.place_of(pane).is_some();
            assert!(is_seen, "{key:?} hides a pane:\n{}", stage.picture());
        }
    }
}

/// Whether every goal of the page is reached.
fn is_reached(stage: &Stage) -> bool {
    let sheet = stage.lab.view().sheet.as_ref().unwrap();
    let mut goals = sheet
        .paragraphs
        .iter()
        .filter(|one| matches!(one.kind, SheetLineKind::Goal { .. }))
        .peekable();
    goals.peek().is_some()
        && goals.all(|goal| goal.kind == SheetLineKind::Goal { is_reached: true })
}

/// The run goes on for up to `most_s` seconds of the clock, until the task is done.
#[track_caller]
fn run_until_done(stage: &mut Stage, most_s: u32) {
    assert!(!is_reached(stage));
    press(stage, " ");
    for _ in 0..10 * most_s {
        if is_reached(stage) {
            stage.shows("[x] done");
            return;
        }
        stage.wait(0.1);
    }
    panic!("the task is not done:\n{}", stage.picture());
}

#[test]
fn a_push_keeps_the_top_from_going_round() {
    let mut stage = task("why-it-does-not-fall", 8);
    press(&mut stage, "P\n32.667\n↓\nup\n↓\n10\np");
    run_until_done(&mut stage, 10);
}

#[test]
fn the_scales_show_60_newtons_with_a_push_or_a_heavier_foot() {
    let mut pushed = task("what-holds-the-weight-up", 9);
    press(&mut pushed, "P\n11\n↓↓\n20\np");
    run_until_done(&mut pushed, 10);
    let mut weaker = task("what-holds-the-weight-up", 9);
    press(&mut weaker, "/gravity\n12\n\u{1b}");
    run_until_done(&mut weaker, 10);
}

#[test]
fn the_level_wheel_turns_by_a_quarter() {
    let mut stage = task("the-wheel-one-carries", 10);
    press(&mut stage, "P\n5.55\n↓↓\n4\np");
    run_until_done(&mut stage, 10);
}

#[test]
fn an_edit_needs_no_restart_and_no_page_asks_for_one() {
    for lesson in shipped::LESSONS {
        let words = lesson.text.split_whitespace().collect::<Vec<_>>().join(" ");
        for asked in ["`r` first", "press `r`", "then `r`", "`r`, then"] {
            assert!(!words.contains(asked), "{}: {asked}", lesson.name);
        }
    }
}
