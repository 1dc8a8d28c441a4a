//! Texts on screens with few rows and columns are shown completely.

use crate::support::stage::Stage;
use gyrolab::engine::scenario::presets::PRESETS;
use gyrolab::tui::screen;
use ratatui::layout::Rect;

const TEACHERS: Rect = Rect {
    x: 0,
    y: 0,
    width: 40,
    height: 12,
};
/// Returns the words between the panes and the footer.
fn said(stage: &Stage) -> String {
    let layout = screen::layout(&stage.lab, true, stage.size);
    let picture = stage.picture();
    let rows = usize::from(layout.overview.bottom())..usize::from(layout.keys.y);
    let lines: Vec<_> = picture.lines().collect();
    let text = lines[rows].join(" ").replace("80x24 shows more", "");
    text.split_whitespace().collect::<Vec<_>>().join(" ")
}

#[test]
fn the_note_shows_whole_sentences() {
    for preset in PRESETS {
        let mut stage = Stage::open(preset.name, &[], TEACHERS);
        stage.wait(0.3).commands("pause = true");
        stage.wait(6.0);
        let note = stage.lab.note().into_owned();
        let first = note.split_inclusive(". ").next().unwrap().trim_end();
        let said = said(&stage);
        let is_whole = said.contains(first) && said.ends_with('.');
        assert!(is_whole, "{}: {note:?} in {said:?}", preset.name);
    }
}

#[test]
fn a_warning_is_shown_together_with_the_look_at_text() {
    let mut stage = Stage::open("method-2", &[], TEACHERS);
    stage.wait(1.0).commands("pause = true");
    stage.wait(6.0).shows("NOT RELIABLE").shows("z swing by");
}

#[test]
fn a_hidden_verdict_frees_its_row_for_the_page() {
    let mut stage = Stage::open("method-2", &[], TEACHERS);
    stage.lesson("is-the-wobble-real", 10).settle().wait(6.0);
    let rows = |shown: &Stage| {
        screen::layout(&shown.lab, true, shown.size).panes[0]
            .1
            .height
    };
    let before = rows(&stage);
    stage.commands("hide = ['health', 'look_at']");
    assert!(rows(&stage) > before);
}

#[test]
fn a_form_shows_how_to_cancel_it() {
    for key in ["g", "S", "X", "x"] {
        let mut stage = Stage::open("cusps", &[], TEACHERS);
        stage.wait(0.3).commands("pause = true");
        stage.press(key).shows("Enter").shows("Esc: cancel");
    }
}

#[test]
fn a_long_message_gets_the_rows_it_needs() {
    let mut stage = Stage::open("cusps", &[], TEACHERS);
    stage.wait(0.3).commands("pause = true");
    stage.wait(6.0).press("t");
    let notice = stage.lab.notice().unwrap();
    assert!(
        notice.len() > 38 && said(&stage).contains(&notice),
        "{notice}"
    );
    // Without a note, the message has one row of its own and the row of the verdict, which is shown again afterwards.
    stage.commands("hide = ['look_at']").wait(6.0);
    stage.shows("reliable:").press("m");
    let alone = stage.lab.notice().unwrap();
    assert!(alone.len() > 38 && said(&stage).contains(&alone), "{alone}");
    stage.shows_no("reliable:").wait(6.0);
    stage.shows("reliable:");
}
