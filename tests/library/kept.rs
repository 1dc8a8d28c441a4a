//! The lab as a session keeps it: what was done comes back, however much it was.

use crate::support::desk::Desk;
use gyrolab::lab::Lab;
use gyrolab::lab::view::View;
use gyrolab::lab::view::markers::Marker;
use gyrolab::lab::view::theme::{Background, Theme};
use gyrolab::scenario::Scenario;
use gyrolab::storage::session::{Content, resume};
use gyrolab::tui::keymap::Key;
use gyrolab::tui::panes;
use std::fs;
use std::path::Path;

fn view(scenario: &Scenario) -> View {
    let theme = Theme {
        colour: false,
        background: Background::Dark,
    };
    View::new(scenario, Marker::Braille, theme, &panes::IDS)
}

/// The lab as `content` has it, arrived where it was left.
#[track_caller]
fn resumed(content: &Content) -> Desk {
    Lab::check(content).unwrap();
    let mut desk = Desk::of(Lab::resumed(content, view).unwrap());
    desk.wait(2);
    desk
}

/// Goes to a step and then gives `count` pushes, each one step earlier than the one before.
fn pushed_backwards(count: usize) -> Desk {
    let mut desk = Desk::open("method-2");
    desk.go("600");
    for _ in 0..count {
        desk.press(&[Key::Char('p'), Key::Char(',')]);
    }
    desk
}

#[test]
fn any_number_of_acts_each_earlier_than_the_one_before_comes_back() {
    let mut desk = pushed_backwards(200);
    let content = desk.lab.content();
    let mut back = resumed(&content);
    assert_eq!(back.step(), 400);
    for step in 402..=600 {
        back.press(&[Key::Char('u')]);
        assert_eq!(back.step(), step - 1, "the undo of the push there");
    }
    assert_eq!(back.scenario().file.push.len(), 1);
    back.press(&[Key::Char('u')]);
    assert_eq!(back.scenario().file.push.len(), 0);
    back.press(&[Key::Char('u')]);
    assert_eq!(back.lab.notice().as_deref(), Some("nothing to undo"));
}

#[test]
fn what_is_kept_grows_with_the_number_of_acts() {
    let length = |count| pushed_backwards(count).lab.content().work.len();
    let (few, more, most) = (length(50), length(100), length(200));
    let (first, second) = (more - few, most - more);
    assert!(
        second.abs_diff(2 * first) < first / 10,
        "{few} {more} {most}"
    );
}

/// The times (s) at which the pushes of the run begin that have been given in the lab, and how many edits there are.
fn done(desk: &Desk) -> (Vec<f64>, usize) {
    let file = desk.scenario().file;
    let from = file.push.iter().filter_map(|push| push.from_s);
    (from.collect(), file.edit.len())
}

/// A session that version 0.1.0 wrote, before journals were flat, and what that version had on its screen after each
/// undo.
#[test]
fn a_session_of_form_1_comes_back_with_all_that_can_be_undone() {
    let folder = tempfile::tempdir().unwrap();
    for name in ["1.work", "1.place"] {
        let fixture = Path::new("tests/fixtures/session-1").join(name);
        fs::copy(fixture, folder.path().join(name)).unwrap();
    }
    let found = resume(folder.path(), |content| Ok(content.clone())).unwrap();
    assert!(found.kept_aside.is_empty(), "{:?}", found.kept_aside);
    let content = found.resumed.unwrap().what;
    let back = || {
        let mut desk = Desk::of(Lab::resumed(&content, view).unwrap());
        desk.wait(2);
        desk
    };
    let mut desk = back();
    let wanted: [(&[f64], usize); 9] = [
        (&[10.3, 11.3], 0),
        (&[10.3], 0),
        (&[13.3], 1),
        (&[13.3], 0),
        (&[14.200000000000001], 0),
        (&[15.700000000000001, 16.2], 0),
        (&[15.700000000000001, 16.2], 0), // the length was taken back
        (&[15.700000000000001], 0),
        (&[], 0),
    ];
    for (undone, (from, edits)) in wanted.into_iter().enumerate() {
        if undone > 0 {
            desk.press(&[Key::Char('u')]);
        }
        assert_eq!(done(&desk), (from.to_vec(), edits), "{undone} undone");
    }
    desk.press(&[Key::Char('u')]);
    let start = |desk: &Desk| desk.scenario().file.start.tilt_deg;
    assert_eq!(start(&desk), Some(45.0), "the run before");
    assert_eq!(done(&desk), (vec![6.0], 0));

    let mut desk = back();
    assert_eq!((desk.step(), start(&desk)), (113, Some(46.0)));
    desk.press(&[Key::Char('U')]);
    assert_eq!(done(&desk), (vec![7.300000000000001], 0), "brought again");

    // Kept anew it is of the present form, and the same.
    let mut again = resumed(&back().lab.content());
    again.press(&[Key::Char('u'), Key::Char('u')]);
    assert_eq!(done(&again), (vec![13.3], 1));
}

#[test]
fn the_focus_that_earlier_versions_kept_comes_back() {
    for (earlier, present) in [
        ("traces", "traces"),
        ("from-above", "above"),
        ("three-d", "3d"),
        ("parameters", "parameters"),
    ] {
        let mut content = Desk::open("loops").lab.content();
        assert!(content.place.contains("focus = \"traces\""));
        content.place = content
            .place
            .replace("focus = \"traces\"", &format!("focus = \"{earlier}\""));
        let mut back = resumed(&content);
        assert_eq!(back.lab.view().focus.id(), present);
        let again = resumed(&back.lab.content());
        assert_eq!(again.lab.view().focus.id(), present);
    }
    let mut content = Desk::open("loops").lab.content();
    content.place = content.place.replace("\"traces\"", "\"nowhere\"");
    let refused = Lab::resumed(&content, view).err().unwrap().to_string();
    assert_eq!(refused, "there is no pane nowhere");
}
