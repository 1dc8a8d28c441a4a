//! Taking back and bringing again, by keys, where several edits meet.

#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]
use gyrolab::scenario::Document;
use gyrolab::scenario::Scenario;
use gyrolab::scenario::file::PushFile;
use gyrolab::scenario::journal::{Act, Journal};
use gyrolab::workbench::app;
use gyrolab::workbench::keymap::{Key, Mode};
use gyrolab::workbench::lab::Lab;
use gyrolab::workbench::view::View;
use gyrolab::workbench::view::markers::Marker;
use gyrolab::workbench::view::theme::{Background, Theme};
use proptest::prelude::*;
use std::sync::Arc;
use std::time::Duration;

fn scenario(name: &str) -> Arc<Scenario> {
    Arc::new(Document::open(name).unwrap().scenario().unwrap())
}
fn lab(scenario: Arc<Scenario>) -> Lab {
    let view = View::new(
        &scenario,
        Marker::Braille,
        Theme {
            colour: false,
            background: Background::Dark,
        },
    );
    Lab::new("method-2", scenario, view, false)
}
fn press(lab: &mut Lab, keys: &[Key]) {
    for &key in keys {
        app::press(key, lab);
    }
}
fn typed(lab: &mut Lab, text: &str) {
    for c in text.chars() {
        app::press(Key::Char(c), lab);
    }
}
fn settle(lab: &mut Lab) {
    let mut n = 0u64;
    while lab.playback().steps_to_go().is_some() {
        n += 1;
        lab.advance(&mut || Duration::from_millis(70 * n));
    }
}
fn go(lab: &mut Lab, to: &str) {
    typed(lab, "g");
    typed(lab, to);
    app::press(Key::Enter, lab);
    settle(lab);
}
fn select(lab: &mut Lab, label: &str, group: &str) {
    press(lab, &[Key::Char('e')]);
    let lines: Vec<_> = lab
        .editor()
        .lines()
        .iter()
        .map(|l| (l.group.clone(), l.label.clone()))
        .collect();
    let want = lines
        .iter()
        .position(|(g, l)| g == group && l == label)
        .unwrap_or_else(|| panic!("{lines:?}"));
    loop {
        let now = lab.editor().selected_index();
        if now == want {
            break;
        }
        press(lab, &[if now < want { Key::Down } else { Key::Up }]);
    }
}
fn set(lab: &mut Lab, group: &str, label: &str, text: &str) {
    select(lab, label, group);
    press(lab, &[Key::Enter]);
    typed(lab, text);
    press(lab, &[Key::Enter]);
    assert_eq!(lab.mode(), Mode::Lab, "{:?}", lab.dialog());
    settle(lab);
}

#[test]
fn a_length_taken_back_is_in_seconds_what_it_was() {
    let mut lab = lab(scenario("method-2"));
    let end = |lab: &Lab| lab.playback().end_step();
    go(&mut lab, "1000");
    set(&mut lab, "motion", "dt", "0.05");
    let before = end(&lab);
    set(&mut lab, "motion", "steps", "4000");
    assert_eq!(end(&lab), 4000);
    press(&mut lab, &[Key::Char('u')]);
    assert_eq!(end(&lab), before);
}

#[test]
fn a_run_passed_on_the_way_back_is_left_where_it_stood() {
    let mut lab = lab(scenario("method-2"));
    go(&mut lab, "100");
    set(&mut lab, "start", "tilt", "40");
    go(&mut lab, "200000");
    set(&mut lab, "start", "tilt", "30");
    go(&mut lab, "7");
    press(&mut lab, &[Key::Char('2'), Key::Char('u')]);
    settle(&mut lab);
    assert_eq!(lab.playback().step_number(), 100);
    press(&mut lab, &[Key::Char('U')]);
    settle(&mut lab);
    assert_eq!(lab.playback().step_number(), 200000);
    press(&mut lab, &[Key::Char('2'), Key::Char('U')]);
    settle(&mut lab);
    assert_eq!(lab.playback().step_number(), 7);
}

#[test]
fn a_push_that_an_edit_of_the_file_adds_is_listed() {
    let mut file = gyrolab::scenario::presets::find("method-2")
        .unwrap()
        .text
        .to_owned();
    file +=
        "\n[[edit]]\nstep=5\nset={ 'push.0' = {point='top',force_N=[0,0,-1],from_s=1,for_s=1} }\n";
    let s = Arc::new(
        Document::parse("x.toml", &file)
            .unwrap()
            .scenario()
            .unwrap(),
    );
    let mut lab = lab(s);
    assert!(!lab.editor().lines().iter().any(|l| l.group == "push 1"));
    go(&mut lab, "10");
    assert!(lab.editor().lines().iter().any(|l| l.group == "push 1"));
}

#[test]
fn steps_of_a_push_to_come_are_those_of_now() {
    let mut lab = lab(scenario("method-2"));
    go(&mut lab, "10");
    set(&mut lab, "motion", "dt", "0.05");
    set(&mut lab, "next push (p)", "for", "20 steps");
    let line = lab.editor().selected().unwrap();
    assert_eq!((line.label.as_str(), line.value.as_str()), ("for", "1"));
}

#[test]
fn a_push_is_over_by_its_seconds() {
    let mut lab = lab(scenario("wobble-push"));
    go(&mut lab, "40");
    set(&mut lab, "motion", "dt", "0.05");
    go(&mut lab, "250");
    set(&mut lab, "push 1", "Fx", "1");
    assert!(
        lab.notice().unwrap().contains("from the next step on"),
        "{:?}",
        lab.notice()
    );
    go(&mut lab, "400");
    set(&mut lab, "push 1", "Fx", "2");
    assert!(
        lab.notice().unwrap().contains("is over"),
        "{:?}",
        lab.notice()
    );
}

/// One of the things that can be done, with the number `value` in it.
fn deed(kind: u8, value: f64) -> Act {
    match kind {
        0 => Act::set("motion.gravity_m_per_s2", value.into()),
        1 => Act::set("title", format!("title {value}").into()),
        2 => Act::set("push.0.force_N.1", value.into()),
        _ => Act::Push(PushFile {
            point: "top".to_owned(),
            force_N: [value, 0.0, 0.0],
            first_step: None,
            steps: None,
            from_s: Some(value),
            for_s: Some(1.0),
            accumulates: None,
        }),
    }
}

proptest! {
    /// Kinds 0 to 3 are deeds, 4 and 5 take back, 6 and 7 bring again.
    #[test]
    fn undo_and_redo_lead_through_the_same_files(
        ways in prop::collection::vec((0..8u8, 0..100u64, 1..50u32), 1..30)
    ) {
        let edits = "\n[[edit]]\nstep = 60\nset = { 'motion.gravity_m_per_s2' = 1 }\n\
                     [[edit]]\nstep = 60\nset = { 'push.0.force_N' = [0, 0, -1] }\n";
        let text = gyrolab::scenario::presets::find("wobble-push").unwrap().text;
        let document = Document::parse("edited", &format!("{text}{edits}")).unwrap();
        let mut journal = Journal::of(document.scenario().unwrap().file);
        let (mut past, mut future) = (Vec::new(), Vec::new());
        for (kind, step, value) in ways {
            let before = journal.file();
            match kind {
                4 | 5 => {
                    let Some(file) = past.pop() else { break };
                    prop_assert!(journal.undo().is_some());
                    prop_assert_eq!(journal.file(), file);
                    future.push(before);
                }
                6 | 7 => {
                    prop_assert_eq!(journal.redo().is_some(), !future.is_empty());
                    let Some(file) = future.pop() else { continue };
                    prop_assert_eq!(journal.file(), file);
                    past.push(before);
                }
                kind => {
                    journal.act(step, deed(kind, f64::from(value))).unwrap();
                    past.push(before);
                    future.clear();
                }
            }
        }
    }
}

#[test]
fn a_time_with_a_sign_counts_from_here() {
    let mut lab = lab(scenario("method-2"));
    go(&mut lab, "100");
    for (to, step) in [
        ("+5 s", 150),
        ("-2.5 s", 125),
        ("12.5 s", 125),
        ("1e2", 100),
        ("-30", 70),
    ] {
        go(&mut lab, to);
        assert_eq!(lab.playback().step_number(), step, "{to}");
    }
}

#[test]
fn nudges_that_belong_together_are_one_undo_and_later_ones_another() {
    let mut lab = lab(scenario("method-2"));
    go(&mut lab, "100");
    select(&mut lab, "gravity", "motion");
    let gravity = |lab: &Lab| lab.editor().selected().unwrap().value.clone();
    press(&mut lab, &[Key::Right, Key::Right, Key::Right]);
    assert_eq!(gravity(&lab), "10.1");
    lab.advance(&mut || Duration::from_secs(60));
    press(&mut lab, &[Key::Right]);
    assert_eq!(gravity(&lab), "10.2");
    press(&mut lab, &[Key::Char('u')]);
    assert_eq!(gravity(&lab), "10.1");
    press(&mut lab, &[Key::Char('u')]);
    assert_eq!(gravity(&lab), "9.8");
}
