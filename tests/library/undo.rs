//! Undo and redo of interacting edits.

use crate::support::desk::Desk;
use gyrolab::engine::journal::{Act, Journal};
use gyrolab::engine::scenario::Document;
use gyrolab::engine::scenario::file::PushFile;
use gyrolab::lab::command::Command;
use gyrolab::tui::keymap::{Key, Mode};
use proptest::prelude::*;
use std::time::Duration;
use toml::{Table, Value};

#[test]
fn undoing_an_edit_of_the_length_restores_its_seconds() {
    fn end(desk: &Desk) -> u64 {
        desk.lab.player().end_step()
    }
    let mut desk = Desk::open("method-2");
    desk.commands("go_to = 1000\nset = { 'motion.time_step_s' = 0.05 }");
    let before = end(&desk);
    desk.commands("set = { 'motion.steps' = 4000 }");
    assert_eq!(end(&desk), 4000);
    desk.commands("undo = 1");
    assert_eq!(end(&desk), before);
}

#[test]
fn runs_skipped_by_undo_keep_their_steps() {
    let mut desk = Desk::open("method-2");
    desk.commands("go_to = 100\nset = { 'start.tilt_deg' = 40 }");
    desk.commands("go_to = 200000\nset = { 'start.tilt_deg' = 30 }\ngo_to = 7");
    desk.commands("undo = 2");
    assert_eq!(desk.step(), 100);
    desk.commands("redo = 1");
    assert_eq!(desk.step(), 200_000);
    desk.commands("redo = 1");
    assert_eq!(desk.step(), 7);
    assert!(desk.carry_out(&Command::Redo(1)).is_err());
}

#[test]
fn a_push_added_by_an_edit_in_the_file_is_listed() {
    let mut file = gyrolab::engine::scenario::presets::find("method-2")
        .unwrap()
        .text
        .to_owned();
    file +=
        "\n[[edit]]\nstep=5\nset={ 'push.0' = {point='top',force_N=[0,0,-1],from_s=1,for_s=1} }\n";
    let scenario = Document::parse("x.toml", &file).and_then(|document| document.scenario());
    let mut desk = Desk::with("x.toml", scenario.unwrap());
    assert!(
        !desk
            .lab
            .values()
            .list
            .values
            .iter()
            .any(|value| value.group == "push 0")
    );
    desk.commands("go_to = 10");
    assert!(
        desk.lab
            .values()
            .list
            .values
            .iter()
            .any(|value| value.group == "push 0")
    );
}

#[test]
fn steps_of_the_next_push_use_the_current_time_step() {
    let mut desk = Desk::open("method-2");
    desk.commands("go_to = 10\nset = { 'motion.time_step_s' = 0.05 }");
    // Only typed values can be in steps.
    desk.press(&[Key::Char('P'), Key::Down, Key::Down, Key::Enter]);
    desk.type_text("20 steps");
    desk.press(&[Key::Enter]);
    let value = desk.lab.values().list.selected().unwrap();
    assert_eq!((value.label.as_str(), value.text.as_str()), ("for", "1"));
}

#[test]
fn a_push_ends_by_its_seconds() {
    let mut desk = Desk::open("wobble-push");
    desk.commands("go_to = 40\nset = { 'motion.time_step_s' = 0.05 }\ngo_to = 250");
    let said = desk.commands("set = { 'push.0.force_N.0' = 1 }").unwrap();
    assert!(said.contains("from the next step on"), "{said}");
    desk.commands("go_to = 400");
    let over = desk.commands("set = { 'push.0.force_N.0' = 2 }").unwrap();
    assert!(over.contains("is over"), "{over}");
}

fn one(key: &str, value: Value) -> Table {
    Table::from_iter([(key.to_owned(), value)])
}

/// Returns an action of one of four kinds, with the number `value`.
fn act(kind: u8, value: f64) -> Act {
    match kind {
        0 => Act::Edit(one("motion.gravity_m_per_s2", value.into())),
        1 => Act::Metadata(one("title", format!("title {value}").into())),
        2 => Act::Edit(one("push.0.force_N.1", value.into())),
        _ => Act::Push(PushFile {
            point: "top".to_owned(),
            force_N: [value, 0.0, 0.0],
            from_s: Some(value),
            for_s: Some(1.0),
            ..PushFile::default()
        }),
    }
}

proptest! {
    /// Kinds 0 to 3 are actions, 4 and 5 undo, 6 and 7 redo.
    #[test]
    fn undo_and_redo_pass_through_the_same_files(
        ways in prop::collection::vec((0..8u8, 0..100u64, 1..50u32), 1..30)
    ) {
        let edits = "\n[[edit]]\nstep = 60\nset = { 'motion.gravity_m_per_s2' = 1 }\n\
                     [[edit]]\nstep = 60\nset = { 'push.0.force_N' = [0, 0, -1] }\n";
        let text = gyrolab::engine::scenario::presets::find("wobble-push").unwrap().text;
        let document = Document::parse("edited", &format!("{text}{edits}")).unwrap();
        let mut journal = Journal::new("edited", &document.scenario().unwrap());
        let (mut past, mut future) = (Vec::new(), Vec::new());
        for (kind, step, value) in ways {
            let before = journal.file();
            match kind {
                4 | 5 => {
                    let Some(file) = past.pop() else { break };
                    prop_assert!(!journal.undo().is_empty());
                    prop_assert_eq!(journal.file(), file);
                    future.push(before);
                }
                6 | 7 => {
                    prop_assert_eq!(journal.redo().is_empty(), future.is_empty());
                    let Some(file) = future.pop() else { continue };
                    prop_assert_eq!(journal.file(), file);
                    past.push(before);
                }
                kind => {
                    journal.perform(step, vec![act(kind, f64::from(value))], false).unwrap();
                    past.push(before);
                    future.clear();
                }
            }
        }
    }
}

#[test]
fn a_time_with_a_sign_is_relative_to_the_current_step() {
    let mut desk = Desk::open("method-2");
    desk.commands("go_to = 100");
    for (to, step) in [
        ("+5 s", 150),
        ("-2.5 s", 125),
        ("12.5 s", 125),
        ("1e2", 100),
        ("-30", 70),
    ] {
        desk.type_text("g"); // typed, since the command accepts no sign
        desk.type_text(to);
        desk.press(&[Key::Enter]);
        assert_eq!(desk.lab.popups().mode, Mode::Lab, "{to}");
        assert_eq!(desk.step(), step, "{to}");
    }
}

#[test]
fn consecutive_nudges_are_undone_together_and_later_ones_separately() {
    fn gravity(desk: &Desk) -> f64 {
        desk.lab.player().motion().gravity
    }
    let mut desk = Desk::open("method-2");
    desk.commands("go_to = 100");
    let nudge = "nudge = 'motion.gravity_m_per_s2'\n";
    desk.commands(&nudge.repeat(3));
    assert_eq!(gravity(&desk), 10.1);
    desk.pass(Duration::from_secs(60));
    desk.commands(nudge);
    assert_eq!(gravity(&desk), 10.2);
    desk.commands("undo = 1");
    assert_eq!(gravity(&desk), 10.1);
    desk.commands("undo = 1");
    assert_eq!(gravity(&desk), 9.8);
}
