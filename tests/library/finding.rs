//! Search in the help, and the filter of the values pane.

use crate::support::stage::{LARGE, SMALL, Stage};
use gyrolab::lab::{LabRequest, Mode};
use gyrolab::tui::keymap::Key;
use gyrolab::tui::panes;
use ratatui::layout::Rect;

const ESC: &str = "\u{1b}";

fn open(size: Rect) -> Stage {
    let mut stage = Stage::open("method-2", &[], size);
    stage.wait(1.0).commands("pause = true").wait(6.0);
    stage
}

#[test]
fn enter_in_the_help_executes_the_found_entry() {
    let mut stage = open(SMALL);
    let step = stage.step();
    stage.press("?/one time step forward");
    stage
        .shows("help: one time step forward_")
        .press("\n")
        .wait(0.1);
    assert_eq!(
        (stage.lab.popups().mode, stage.step()),
        (Mode::Lab, step + 1)
    );
    stage.press("?export\n").shows("export steps 0 to");
    stage.press(ESC);
    stage.press("?\u{1b}");
    assert_eq!(stage.lab.popups().mode, Mode::Lab);
    for key in "?quit".chars() {
        stage.key(Key::Char(key));
    }
    assert_eq!(stage.key(Key::Enter), Some(LabRequest::Quit));
}

#[test]
fn the_help_finds_line_styles_and_colors() {
    for word in ["dashed", "dotted", "light", "dark"] {
        let mut stage = open(SMALL);
        stage.press(&format!("?{word}"));
        stage.shows_no("no entry found");
    }
}

#[test]
fn letters_in_the_help_are_typed_and_esc_first_clears_them() {
    let mut stage = open(SMALL);
    stage.press("?").shows("help: type to search").shows("►");
    stage.press("qkj").shows("help: qkj_ (0)");
    stage.shows("no entry found").press("\n");
    stage.shows("nothing is selected");
    stage.press(ESC).shows("help: type to search").press(ESC);
    stage.shows_no("help: ");
    stage.press("?undo?").shows_no("help: ");
}

#[test]
fn ctrl_u_clears_the_search() {
    let mut stage = open(SMALL);
    stage.press("?qkj").shows("help: qkj_ (0)");
    stage.key(Key::Ctrl('u'));
    stage.shows("help: type to search").press(ESC);
    stage.press("ofast").shows("fast_");
    stage.key(Key::Ctrl('u'));
    stage.shows_no("fast_").press("loops").shows("loops_");
    stage.press(ESC).press(ESC).press("/gravity");
    stage.shows("/gravity_");
    stage.key(Key::Ctrl('u'));
    stage
        .shows("/_")
        .shows("6 of ")
        .press("tilt")
        .shows("/tilt_");
}

#[test]
fn the_help_explains_terms_in_sentences() {
    for size in [SMALL, LARGE, Rect::new(0, 0, 40, 12)] {
        open(size)
            .press("?under-sampled")
            .shows("as under a strobe");
    }
}

#[test]
fn the_help_lists_pane_keys_under_its_title_and_focuses_it() {
    let mut stage = Stage::open("method-2", &[], Rect::new(0, 0, 100, 150));
    stage.press("?");
    for pane in panes::rows().filter(|pane| !pane.keys.is_empty()) {
        stage.shows(&format!("{}: keys of this pane", pane.title));
    }
    let mut small = open(SMALL);
    small.press("\t");
    assert_eq!(small.focus(), "above");
    small.press("?the next phase of\n");
    assert_eq!(small.focus(), "step");
}

#[test]
fn a_key_that_works_elsewhere_is_explained_and_not_executed() {
    let mut stage = open(SMALL);
    stage.press("?apply; in the settings\n");
    stage.shows("this key works elsewhere: in a dialog");
    assert_eq!(stage.lab.popups().mode, Mode::Help);
}

#[test]
fn the_selection_stops_at_both_ends_of_the_help() {
    let mut stage = open(Rect::new(0, 0, 40, 12));
    stage.press("?").press(&"↓".repeat(500)).press("↑");
    let at = stage.lab.popups().help.selected;
    stage.press("↓");
    assert_eq!(stage.lab.popups().help.selected, at + 1);
    stage.press("cusps").press(ESC).press("↑");
    assert_eq!(stage.lab.popups().help.selected, 0);
}

#[test]
fn values_are_found_by_their_names() {
    let mut stage = open(SMALL);
    stage.press("/grav").shows("/grav_").shows("1 of 1");
    stage.shows("gravity").shows_no("|L| J s");
    assert_eq!(stage.focus(), "parameters");
    // A found value can be nudged and typed at once.
    stage.press("→").shows("9.9");
    stage.press("\n").shows("gravity = 9.9 m/s2  Enter:");
    stage.press("1.6\n");
    assert_eq!(stage.lab.player().motion().gravity, 1.6);
    stage.shows("/grav").press(ESC).shows_no("/grav");
    stage.shows("values").shows("L tilt");
    assert_eq!(stage.focus(), "parameters");
    let selected = stage.lab.values().list.selected().unwrap();
    assert_eq!(selected.label, "gravity");
}

#[test]
fn readouts_are_found_by_their_names() {
    let mut stage = open(SMALL);
    stage.press("/turns").shows("no editable value");
    stage.shows("turns/dt").shows_no("E error");
    stage.press(ESC).press("/energy").shows("E error");
    stage.shows_no("turns/dt");
    let mut large = open(LARGE);
    large.press("/azimuth").shows("azimuth °");
}

#[test]
fn a_filter_without_matches_is_reported_and_cleared() {
    let mut stage = open(SMALL);
    stage.press("e/qz").shows("/qz_");
    stage.shows("no editable value");
    stage.press("\n→");
    stage.lab.paste("x\n");
    stage.shows("/qzx_");
    stage.key(Key::Backspace);
    stage.shows("/qz_").press(ESC);
    assert_eq!(stage.lab.popups().mode, Mode::Lab);
    stage.shows("values").press("/").press(ESC);
    assert_eq!(
        (stage.focus(), stage.lab.popups().mode),
        ("parameters", Mode::Lab)
    );
    // The next push is found whatever the filter was.
    stage.press("/dt").press("\u{1b}").press("/dt\n\u{1b}");
    stage.press("P").shows("next push");
}

#[test]
fn values_show_all_their_digits() {
    let mut stage = open(SMALL);
    stage.press("/rim height");
    stage.shows("body.rim.height_m=0.565685424949238");
    // A given number is not rounded if there is room.
    let set = [
        "start.tilt_deg=0.000123456",
        "motion.gravity_m_per_s2=9.80665",
    ];
    let large = &mut Stage::open("method-2", &set, LARGE);
    large.shows("0.000123456").shows("9.80665");
    let steps = ["push=[{point='top', force_N=[0,0,1], first_step=123456789, steps=1}]"];
    let mut small = Stage::open("method-2", &steps, SMALL);
    small.press("/first step").shows("=123456789");
}

#[test]
fn the_frame_of_l_is_shown_and_kept_when_edited() {
    let mut stage = open(SMALL);
    stage.press("/lz").shows("Lz body").press("→\n");
    stage.shows("Lz body = ").press("500\n");
    let file = stage.lab.player().run().scenario().file.clone();
    assert_eq!(
        file.start.momentum_frame,
        Some(gyrolab::engine::scenario::file::VectorFrame::Body)
    );
    assert_eq!(file.start.momentum_Js, Some([0.0, 0.0, 500.0]));
    Stage::open("method-1", &[], SMALL)
        .press("/lz")
        .shows("Lz world");
}

#[test]
fn prefix_matches_come_first() {
    let mut stage = open(SMALL);
    stage.press("/L");
    let selected = stage.lab.values().list.selected().unwrap();
    assert_eq!(selected.label, "|L|");
    let mut other = open(SMALL);
    other.press("/Lz").shows("Lz J s").shows("Lz body");
}
