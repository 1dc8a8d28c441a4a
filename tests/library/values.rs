//! The values pane: its contents, and setting values in it.

use crate::support::scenarios::preset;
use crate::support::stage::{LARGE, SMALL, Stage};
use gyrolab::engine::analysis::readouts::four_digits;
use gyrolab::engine::journal::derived::DerivedValue;
use gyrolab::engine::journal::parameters::changed;
use gyrolab::lab::view::Pane;
use gyrolab::tui::mouse::{Did, Mouse, Pointer};
use gyrolab::tui::panes::parameters::PARAMETERS_ROW;
use gyrolab::tui::screen;
use gyrolab::tui::theme::Role;
use ratatui::buffer::{Buffer, Cell};
use ratatui::layout::Rect;

const ESC: &str = "\u{1b}";

/// Draws the values pane of `stage` alone on `width` columns and `height` rows.
fn pane(stage: &Stage, width: u16, height: u16) -> (Vec<String>, Buffer) {
    let mut buf = Buffer::empty(Rect::new(0, 0, width, height));
    (PARAMETERS_ROW.draw)(&stage.lab, buf.area, &mut buf);
    let rows = buf.content.chunks(width.into());
    let text = rows
        .map(|row| row.iter().map(Cell::symbol).collect())
        .collect();
    (text, buf)
}

/// Returns the words of the row that begins with `label`.
#[track_caller]
fn row(rows: &[String], label: &str) -> Vec<String> {
    let found = rows.iter().find(|row| row.starts_with(label));
    let row = found.unwrap_or_else(|| panic!("no {label} in {rows:#?}"));
    row[label.len()..]
        .split_whitespace()
        .map(str::to_owned)
        .collect()
}

fn wobble(size: Rect) -> Stage {
    let mut stage = Stage::open("wobble-push", &[], size);
    stage.commands("go_to = 900\npause = true").wait(20.0);
    stage
}

#[test]
fn run_and_exact_motion_are_shown_side_by_side_without_t() {
    let stage = wobble(SMALL);
    assert!(!stage.lab.player().run().shows_exact());
    let (rows, _) = pane(&stage, 24, 16);
    for (label, shown) in [
        ("x", ["m", "−0.726", "−0.799"]),
        ("z", ["m", "0.860", "0.800"]),
        ("tilt", ["°", "40.49", "45.01"]),
    ] {
        assert_eq!(row(&rows, label), shown, "{rows:#?}");
    }
    let labels = [
        "x ",
        "y ",
        "z ",
        "tilt",
        "prec. °/s",
        "nutat s",
        "E error",
        "start",
        "tilt",
        "|L|",
        "L tilt",
        "dt",
    ];
    let begins = rows[1..].iter().zip(labels);
    assert!(
        begins.clone().all(|(row, label)| row.starts_with(label)),
        "{rows:#?}"
    );
}

#[test]
fn a_wide_pane_shows_differences_and_more_rows() {
    let (rows, _) = pane(&wobble(LARGE), 115, 13);
    assert!(rows[0].contains("now") && rows[0].contains("exact") && rows[0].contains("off by"));
    assert!(rows[0].contains("start and motion") && rows[0].contains("body"));
    assert_eq!(row(&rows, "x")[..4], ["m", "−0.7258", "−0.7993", "0.0735"]);
    assert_eq!(row(&rows, "turns per step")[..3], ["<", "0.5", "5.048"]);
}

#[test]
fn deviations_are_marked_and_editable_values_underlined() {
    let mut stage = wobble(SMALL);
    let style_of = |shown: &Stage, label: &str| {
        let (rows, buf) = pane(shown, 24, 16);
        let y = rows.iter().rposition(|row| row.starts_with(label)).unwrap();
        buf[(15, y as u16)].style()
    };
    let theme = stage.lab.view().theme;
    assert_eq!(style_of(&stage, "z ").fg, theme.style(Role::Off).fg);
    assert_eq!(
        style_of(&stage, "|L|").add_modifier,
        theme.style(Role::Editable).add_modifier
    );
    stage.commands("hide = [\"predicted\"]");
    assert_eq!(style_of(&stage, "z ").fg, theme.style(Role::Text).fg);
    let (rows, _) = pane(&stage, 24, 16);
    assert_eq!(row(&rows, "z"), ["m", "0.860"]);
}

#[test]
fn values_at_the_cursor_are_shown_with_their_time() {
    let mut stage = wobble(LARGE);
    stage.commands("cursor = 863");
    let (narrow, _) = pane(&stage, 30, 31);
    assert!(narrow[0].contains("◊ 86.3 s"), "{narrow:#?}");
    assert_eq!(row(&narrow, "x"), ["m", "−0.6664", "−0.7988"]);
    let (wide, _) = pane(&stage, 115, 13);
    assert_eq!(
        row(&wide, "x")[1..5],
        ["−0.7258", "−0.7993", "−0.6664", "−0.7988"]
    );
}

#[test]
fn size_and_tilt_of_l_can_be_set_separately() {
    let mut stage = Stage::open("method-1-steeper", &[], SMALL);
    stage
        .press("/|L|\n")
        .press("4308.131845707603\n")
        .press(ESC)
        .press(ESC);
    let start = |shown: &Stage| shown.lab.player().run().scenario().start.momentum;
    let momentum = start(&stage);
    assert!(
        (momentum - nalgebra::Vector3::new(1600.0, 0.0, 4000.0)).norm() < 1e-9,
        "{momentum}"
    );
    stage.press("/L tilt\n").press("90\n");
    let level = start(&stage);
    assert!(
        (level.norm() - momentum.norm()).abs() < 1e-9 && level.z.abs() < 1e-9,
        "{level}"
    );
    stage.press("uu");
    assert!((start(&stage).norm() - 2154.0659228538016).abs() < 1e-9);
}

#[test]
fn derived_values_can_be_set() {
    for name in ["method-1", "wobble-push", "falling", "cusps", "torque-free"] {
        let scenario = preset(name, &[]);
        for derived in DerivedValue::ALL {
            let Some(now) = derived.number(&scenario.file, &scenario) else {
                continue;
            };
            for wanted in [now, 1.5 * now + 1.0] {
                let Ok(set) = derived.set(wanted, &scenario.file, &scenario) else {
                    continue;
                };
                let other = changed(&scenario.file, &set).unwrap();
                let number = derived.number(&other.file, &other).unwrap();
                let case = format!("{name} {derived:?} {wanted}: {number}");
                assert!(
                    (number - wanted).abs() <= 1e-9 * wanted.abs().max(1.0),
                    "{case}"
                );
            }
        }
    }
}

#[test]
fn a_value_is_typed_in_its_row_while_the_lab_keeps_its_keys() {
    let mut stage = Stage::open("wobble-push", &[], SMALL);
    stage.press("e").press(".");
    assert_eq!(stage.focus(), Pane::Parameters.id());
    let step = stage.step();
    assert!(step > 0);
    stage.press("/dt\n").press("0.05");
    stage.shows("dt = 0.05 s  Enter: rerun from the start  Tab: from now on");
    stage.shows("0.05_").shows("x (m)").shows("from above");
    stage.press(ESC).press(ESC).shows("start ");
}

#[test]
fn the_selected_value_is_visible_at_every_size() {
    let mut stage = Stage::open("wobble-push", &[], SMALL);
    stage.press("e");
    for (width, height) in [
        (24, 5),
        (24, 9),
        (24, 16),
        (30, 31),
        (41, 12),
        (80, 19),
        (115, 13),
        (200, 45),
    ] {
        for _ in 0..60 {
            let (rows, buf) = pane(&stage, width, height);
            let selected = stage.lab.view().theme.style(Role::Selected).add_modifier;
            let is_selected =
                |y: &usize| (2..width).any(|x| buf[(x, *y as u16)].modifier.contains(selected));
            let found = (1..rows.len()).find(is_selected);
            assert!(found.is_some(), "{width}x{height} {rows:#?}");
            stage.press("↓");
        }
        stage.press(&"↑".repeat(60));
    }
}

#[test]
fn four_digit_numbers_fit_and_are_right() {
    for (number, width, text) in [
        (0.0, 6, "0"),
        (9.99999, 6, "10.00"),
        (0.0201, 6, "0.0201"),
        (168.46, 6, "168.5"),
        (2154.06, 7, "2154"),
        (3.2e-10, 7, "3.2e-10"),
        (-0.85, 6, "-0.850"),
        (1e300, 7, "1.0e300"),
    ] {
        assert_eq!(four_digits(number, width), text);
    }
}

#[test]
fn a_click_selects_a_value_and_a_double_click_edits_it() {
    let mut stage = Stage::open("wobble-push", &[], SMALL);
    let place = screen::layout(&stage.lab, true, SMALL).place_of(Pane::Parameters);
    let place = place.unwrap();
    let (rows, _) = pane(&stage, place.width, place.height);
    let dt = rows.iter().position(|row| row.starts_with("dt s")).unwrap();
    let click = Mouse {
        did: Did::Press,
        x: place.x + 2,
        y: place.y + dt as u16,
    };
    let mut pointer = Pointer::default();
    pointer.act(click, SMALL, &mut stage.lab);
    assert_eq!(stage.focus(), "parameters");
    assert_eq!(stage.lab.values().list.selected().unwrap().label, "dt");
    pointer.act(click, SMALL, &mut stage.lab);
    stage.shows("dt = 0.1 s  Enter:");
}
