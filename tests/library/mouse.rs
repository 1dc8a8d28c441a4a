//! The mouse on a screen without a terminal: the effects of presses, drags and the wheel.

use crate::support::stage::{LARGE, SMALL, Stage};
use gyrolab::lab::Mode;
use gyrolab::lab::sheet::SheetLineKind;
use gyrolab::plot::camera::Camera;
use gyrolab::tui::app;
use gyrolab::tui::layout::ScreenLayout;
use gyrolab::tui::mouse::Pointer;
use gyrolab::tui::mouse::{Did, Mouse};
use gyrolab::tui::panes::overview::Overview;
use gyrolab::tui::screen;
use ratatui::layout::Rect;

/// A stage and its mouse.
struct Desk {
    stage: Stage,
    pointer: Pointer,
}

impl Desk {
    fn open(scenario: &str, size: Rect) -> Self {
        let mut stage = Stage::open(scenario, &[], size);
        stage.wait(2.0).commands("pause = true");
        Self {
            stage,
            pointer: Pointer::default(),
        }
    }

    fn does(&mut self, did: Did, (x, y): (u16, u16)) -> &mut Self {
        let (size, stage) = (self.stage.size, &mut self.stage);
        if let Some(request) = self.pointer.act(Mouse { did, x, y }, size, &mut stage.lab) {
            app::do_in_class(request, &mut stage.lab, &mut stage.class, size);
        }
        self.stage.wait(0.0);
        self
    }

    fn layout(&self) -> ScreenLayout {
        screen::layout(&self.stage.lab, true, self.stage.size)
    }

    fn pane(&self, id: &str) -> Rect {
        let layout = self.layout();
        let mut panes = layout.panes.into_iter();
        panes.find(|(pane, _)| pane.id() == id).unwrap().1
    }

    /// Returns the cell in which `words` begin on the screen.
    fn place(&self, words: &str) -> (u16, u16) {
        let picture = self.stage.picture();
        let found = picture.lines().zip(0..).find_map(|(line, y)| {
            let (before, _) = line.split_once(words)?;
            Some((before.chars().count() as u16, y))
        });
        found.unwrap_or_else(|| panic!("no {words} in\n{picture}"))
    }

    fn cursor_s(&self) -> Option<f64> {
        let cursor = self.stage.lab.player().cursor();
        cursor.map(|sample| sample.time_s)
    }
}

#[test]
fn a_press_on_the_traces_sets_the_cursor_and_a_drag_moves_it() {
    for size in [SMALL, LARGE] {
        let mut desk = Desk::open("method-2", size);
        let traces = desk.pane("traces");
        let at = |share: u16| (traces.x + traces.width * share / 10, traces.bottom() - 3);
        desk.does(Did::Press, at(4));
        let early = desk.cursor_s().unwrap();
        desk.does(Did::Press, at(9));
        let late = desk.cursor_s().unwrap();
        let now_s = desk.stage.lab.player().run().now().time_s;
        assert!(early < late && late <= now_s, "{early}, {late} of {now_s}");
        assert_eq!(desk.stage.focus(), "traces");
        desk.does(Did::Drag, at(6));
        let dragged = desk.cursor_s().unwrap();
        assert!(early < dragged && dragged < late, "{dragged}");
        desk.does(Did::Release, at(2));
        desk.does(Did::Drag, at(9));
        assert_eq!(desk.cursor_s(), Some(dragged), "the button was released");
    }
}

#[test]
fn the_cursor_is_drawn_in_the_pressed_column() {
    let mut desk = Desk::open("cusps", LARGE);
    let traces = desk.pane("traces");
    let y = traces.bottom() - 3;
    let mut pressed = 0;
    for x in traces.x + 16..traces.x + 26 {
        desk.does(Did::Press, (x, y));
        let picture = desk.stage.picture();
        let line = picture.lines().nth(y as usize).unwrap();
        let found = line.chars().position(|sign| sign == '│');
        // A curve may hide the cursor here.
        if let Some(found) = found {
            assert!(found.abs_diff(x.into()) <= 1, "{x}: {line}");
            pressed += 1;
        }
    }
    assert!(pressed > 3, "{}", desk.stage.picture());
}

#[test]
fn a_press_selects_a_pane_seeks_in_the_overview_and_acts_as_a_key() {
    let mut desk = Desk::open("method-2", LARGE);
    for id in ["above", "3d", "parameters", "traces"] {
        let pane = desk.pane(id);
        desk.does(Did::Press, (pane.x + 2, pane.y));
        assert_eq!(desk.stage.focus(), id);
    }
    let overview = desk.layout().overview;
    let has_time = |x: &u16| {
        let drawn = Overview::new(&desk.stage.lab, overview);
        drawn.is_some_and(|drawn| drawn.time_s(*x).is_some())
    };
    let first = (overview.left()..overview.right()).find(has_time).unwrap();
    let last = (overview.left()..overview.right()).rfind(has_time).unwrap();
    desk.does(Did::Press, (first, overview.y + 1));
    assert_eq!(desk.stage.step(), 0);
    desk.does(Did::Drag, (last, overview.y + 1));
    // A drag does not go beyond the furthest step of the run.
    assert_eq!(desk.stage.step(), 400);
    desk.does(Did::Release, (last, overview.y + 1));
    desk.does(Did::Press, (last, overview.y + 1));
    desk.stage.wait(1.0);
    assert_eq!(desk.stage.step(), 2300);
    let help = desk.place("? help");
    desk.does(Did::Press, (help.0 + 3, help.1));
    desk.stage.shows("Esc close ");
    let close = desk.place("Esc close ");
    desk.does(Did::Press, close);
    desk.stage.shows_no("Esc close ");
}

#[test]
fn the_wheel_zooms_and_a_drag_turns_the_3d_view() {
    let mut desk = Desk::open("method-2", LARGE);
    let traces = desk.pane("traces");
    let length_s = |of: &Desk| of.stage.lab.view().window.length_s();
    let before = length_s(&desk);
    let middle = (traces.x + traces.width / 2, traces.y + 5);
    desk.does(Did::WheelUp, middle);
    assert!(length_s(&desk) < before);
    desk.does(Did::WheelDown, middle);
    assert!((length_s(&desk) / before - 1.0).abs() < 1e-6);
    let scene = desk.pane("3d");
    let camera = desk.stage.lab.view().camera;
    let from = (scene.x + 10, scene.y + 5);
    desk.does(Did::Press, from);
    desk.does(Did::Drag, (from.0 + 4, from.1 + 1));
    let turned = desk.stage.lab.view().camera;
    let direction = |seen_from: Camera| (seen_from.yaw_deg, seen_from.pitch_deg);
    assert_ne!(direction(turned), direction(camera));
    desk.does(Did::Drag, from);
    let back = desk.stage.lab.view().camera;
    assert!((back.yaw_deg - camera.yaw_deg).abs() < 1e-9);
}

#[test]
fn a_press_in_the_browser_selects_and_a_double_click_opens() {
    let mut desk = Desk::open("method-2", SMALL);
    desk.stage.press("o");
    let cusps = desk.place("cusps");
    desk.does(Did::Press, cusps);
    let selected = desk.stage.lab.popups().browser.choice().cloned().unwrap();
    assert_eq!(selected.name, "cusps");
    desk.does(Did::Press, cusps);
    desk.stage.shows("Cusps  rk4");
    assert_eq!(desk.stage.lab.popups().mode, Mode::Lab);
}

#[test]
fn a_click_selects_a_row_of_any_list_and_a_double_click_opens_it() {
    let mut desk = Desk::open("method-2", LARGE);
    desk.stage.press("L");
    let title = "Cusps, loops";
    let row = desk.place(title);
    desk.does(Did::Press, row);
    let sheet = desk.stage.lab.view().sheet.clone().unwrap();
    let mut rows = sheet.paragraphs.iter();
    let chosen = rows.find(|paragraph| {
        matches!(
            paragraph.kind,
            SheetLineKind::Choice {
                is_selected: true,
                ..
            }
        )
    });
    assert!(chosen.unwrap().text().starts_with(title));
    assert!(desk.stage.class.open_lesson().is_none());
    desk.does(Did::Press, row);
    let open = desk.stage.class.open_lesson().unwrap();
    assert!(open.lesson.title.starts_with(title));
}

#[test]
fn two_slow_clicks_are_not_a_double_click() {
    let mut desk = Desk::open("method-2", SMALL);
    desk.stage.press("c");
    let setting = desk.place("background");
    desk.does(Did::Press, setting);
    desk.stage.wait(2.0);
    desk.does(Did::Press, setting).stage.shows("dark");
    desk.does(Did::Press, setting).stage.shows("light");
    desk.stage.press("\u{1b}?");
    let of_help = desk.place("pause or resume the run");
    desk.does(Did::Press, of_help);
    assert_eq!(desk.stage.lab.popups().mode, Mode::Help);
}

#[test]
fn events_outside_or_with_the_mouse_off_are_ignored() {
    let mut desk = Desk::open("method-2", SMALL);
    let before = desk.stage.picture();
    use Did::{Drag, Press, Release, WheelDown, WheelUp};
    let all = [Press, Drag, Release, WheelUp, WheelDown];
    const MAX: u16 = u16::MAX;
    for did in all {
        for at in [(MAX, MAX), (80, 3), (3, 24), (MAX, 3), (3, MAX)] {
            desk.does(did, at);
        }
    }
    assert_eq!(desk.stage.picture(), before);
    desk.stage
        .press("c↑→")
        .shows("selects text in the terminal");
    desk.stage.press("\u{1b}");
    let selecting = desk.stage.picture();
    for did in all {
        desk.does(did, (10, 10));
    }
    assert_eq!(desk.stage.picture(), selecting);
    // No event panics, for any open window and any size of the screen.
    for size in [(1, 1), (9, 3), (40, 12), (80, 24), (200, 50)] {
        let mut small = Desk::open("wobble-push", Rect::new(0, 0, size.0, size.1));
        for keys in ["", "?", "\u{1b}o", "\u{1b}\u{1b}x", "\u{1b}e", "c"] {
            small.stage.press(keys);
            for did in all {
                for x in (0..size.0).step_by(7) {
                    small.does(did, (x, size.1 / 2)).does(did, (x, size.1 - 1));
                }
            }
            small.stage.picture();
        }
    }
}

#[test]
fn settings_hide_verdict_theory_and_all_but_two_panes() {
    let mut stage = Stage::open("method-2", &[], SMALL);
    stage.wait(3.0).commands("pause = true");
    stage.shows("turns per step").shows("1.588");
    stage.press("c\n\u{1b}").shows_no("turns per step");
    stage.press("c\n\u{1b}").shows("turns per step");
    stage.press("c↓→\u{1b}").shows_no("1.588");
    stage.press("c↓←\u{1b}").shows("1.588");
    stage.press("c↓↓\n\u{1b}").wait(6.0);
    stage.shows("from above").shows("z (m)");
    stage.shows("Method 2 ");
    for words in "values,L lessons,turns per step,lmost a circle,report,step 6".split(',') {
        stage.shows_no(words);
    }
    let title = format!("Method 2{:>71}", "t     60.0 s");
    assert_eq!(stage.picture().lines().next().unwrap().trim_end(), title);
    stage.press("c↓↓\n\u{1b}").shows("values");
    stage.shows("L lessons");
}

#[test]
fn every_preset_suggests_a_next_step_that_fits_the_screen() {
    for preset in gyrolab::engine::scenario::presets::PRESETS {
        assert!((20..=84).contains(&preset.next.len()), "{}", preset.name);
        for word in preset.next.split([' ', ':', ',']) {
            let named = gyrolab::engine::scenario::presets::find(word);
            assert!(named.is_none_or(|other| other.name != preset.name));
        }
    }
    let set = ["motion.steps=20", "view.next=\"look again\""];
    Stage::open("method-2", &set, SMALL)
        .wait(3.0)
        .shows("Next: look again");
    // The preset's line no longer applies after a change.
    let mut changed = Stage::open("method-2", &["motion.steps=20"], SMALL);
    changed.commands("set = { 'motion.gravity_m_per_s2' = 9.0 }");
    changed.wait(3.0).shows("end of the scenario's run");
    changed.shows_no("Next");
}
