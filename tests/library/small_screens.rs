//! What is said on screens with few rows and columns can be read there to its end.

use crate::support::stage::Stage;
use gyrolab::engine::scenario::presets::PRESETS;
use ratatui::layout::Rect;

const TEACHERS: Rect = Rect {
    x: 0,
    y: 0,
    width: 40,
    height: 12,
};
/// Rows above which the lines below the panes begin: the title and the least that panes have.
const ABOVE: usize = 7;

/// The words of the lines below the panes, without the one about a larger screen and without the keys.
fn said(stage: &Stage) -> String {
    let picture = stage.picture();
    let lines: Vec<_> = picture.lines().skip(ABOVE).collect();
    let (_keys, lines) = lines.split_last().unwrap();
    let text = lines.join(" ").replace("80x24 shows more", "");
    text.split_whitespace().collect::<Vec<_>>().join(" ")
}

#[test]
fn what_there_is_to_see_is_said_to_its_end() {
    for preset in PRESETS {
        let mut stage = Stage::open(preset.name, &[], TEACHERS);
        stage.wait(0.3).commands("pause = true");
        stage.wait(6.0);
        let note = stage.lab.note().into_owned();
        let said = said(&stage);
        assert!(
            said.contains(&note),
            "{}: {note:?} in {said:?}",
            preset.name
        );
        let frames = stage
            .picture()
            .lines()
            .filter(|line| line.ends_with('┘'))
            .count();
        assert_eq!(frames, 1, "{}: the pane is whole", preset.name);
    }
}

#[test]
fn a_warning_stands_beside_what_there_is_to_see() {
    let mut stage = Stage::open("method-2", &[], TEACHERS);
    stage.wait(1.0).commands("pause = true");
    stage.wait(6.0).shows("strobed").shows("that swing.");
}

#[test]
fn a_hidden_line_leaves_its_row_to_the_page() {
    let mut stage = Stage::open("method-2", &[], TEACHERS);
    stage.lesson("is-the-wobble-real", 1).wait(6.0);
    stage.commands("hide = ['health', 'look_at']");
    let picture = stage.picture();
    let inside = picture.lines().filter(|line| line.starts_with('│')).count();
    assert_eq!(inside, 7, "{picture}");
}

#[test]
fn a_form_says_how_it_is_left() {
    for key in ["g", "S", "X", "x"] {
        let mut stage = Stage::open("cusps", &[], TEACHERS);
        stage.wait(0.3).commands("pause = true");
        stage.press(key).shows("Enter").shows("Esc leaves it");
    }
}

#[test]
fn a_long_message_has_the_rows_that_it_needs() {
    let mut stage = Stage::open("cusps", &[], TEACHERS);
    stage.wait(0.3).commands("pause = true");
    stage.wait(6.0).press("t");
    let notice = stage.lab.notice().unwrap();
    assert!(
        notice.len() > 38 && said(&stage).contains(&notice),
        "{notice}"
    );
    // Without a hint there is one line for it, and that about the numbers' health, which comes back.
    stage.commands("hide = ['look_at']").wait(6.0);
    stage.shows("turns a step").press("m");
    let again = stage.lab.notice().unwrap();
    assert!(again.len() > 38 && said(&stage).contains(&again), "{again}");
    stage.shows_no("turns a step").wait(6.0);
    stage.shows("turns a step");
}
