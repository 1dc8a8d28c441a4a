//! The mouse: effects of a click, a drag or the wheel at a position. The mouse is optional; every effect has keys too.

use super::keymap::{Key, KeyEffect, Mode, zoomed_in, zoomed_out};
use super::layout::ScreenLayout;
use super::panes::form::FormPane;
use super::panes::{
    PlotInputs, browser, carry_out, chrome, help, lesson, overview::Overview, parameters,
    traces::Traces,
};
use super::press::press;
use super::screen;
use crate::engine::run::Clock;
use crate::lab::action::{Action, Direction, LessonKey};
use crate::lab::command::{Command, CursorTo, SeekTarget};
use crate::lab::view::Pane;
use crate::lab::{Lab, LabRequest};
use ratatui::layout::{Position, Rect};
use std::time::Duration;

/// Rotation of the 3-D view per column of a drag, and per row (which is twice as high), degrees.
const DEGREES_A_COLUMN: f64 = 3.0;
const DEGREES_A_ROW: f64 = 6.0;
/// Longest time between the two clicks of a double click.
const DOUBLE_CLICK: Duration = Duration::from_millis(500);
/// Lines by which one notch of the wheel moves a list.
const LINES: usize = 3;

/// A mouse event with its cell on the screen.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Mouse {
    pub did: Did,
    /// Column and line, from 0.
    pub x: u16,
    pub y: u16,
}

/// Kind of mouse event.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Did {
    /// The left button was pressed.
    Press,
    /// The mouse was moved with the left button held.
    Drag,
    Release,
    WheelUp,
    WheelDown,
}

/// What a held button drags.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Held {
    Cursor,
    Place,
    /// The 3-D view, from this cell.
    Camera(Position),
}

/// The mouse with the state of a drag or a double click.
#[derive(Debug, Default)]
pub struct Pointer {
    held: Option<Held>,
    /// Position and time of the last press, if it selected a row of a list.
    selected: Option<(Position, Duration)>,
}

impl Pointer {
    /// Carries out the mouse event in `lab`, on a screen of this `area`. Does nothing outside the screen.
    pub fn act(&mut self, mouse: Mouse, area: Rect, lab: &mut Lab) -> Option<LabRequest> {
        let at = Position::new(mouse.x, mouse.y);
        if !lab.view().mouse || !area.contains(at) {
            return None;
        }
        let layout = screen::layout(lab, true, area);
        match mouse.did {
            Did::Press => return self.press(&layout, at, lab),
            Did::Drag => self.drag(&layout, at, lab),
            Did::Release => self.held = None,
            Did::WheelUp => return wheel(&layout, at, true, lab),
            Did::WheelDown => return wheel(&layout, at, false, lab),
        }
        None
    }

    fn press(&mut self, layout: &ScreenLayout, at: Position, lab: &mut Lab) -> Option<LabRequest> {
        self.held = None;
        if layout.keys.contains(at) {
            let key = chrome::key_at(lab, layout, at.x)?;
            return press(key, lab);
        }
        let is_double = self.is_double(at, lab.now());
        if lab.popups().mode != Mode::Lab {
            return self.press_in_list(layout, at, is_double, lab);
        }
        if layout.overview.contains(at) {
            self.held = Some(Held::Place);
            let time_s = Overview::new(lab, layout.overview)?.time_s(at.x)?;
            lab.carry_out_now(&Command::GoTo(SeekTarget::Time(time_s)));
            return None;
        }
        let (pane, place) = pane_at(layout, at)?;
        let value = (pane == Pane::Parameters)
            .then(|| parameters::value_at(lab, place, at))
            .flatten();
        lab.turn_to(pane);
        if is_double && pane == Pane::Parameters {
            return press(Key::Enter, lab);
        } else if let Some(index) = value {
            lab.select_value(index);
            self.selected = Some((at, lab.now()));
        } else if lab.mode() == Mode::Lessons {
            return self.press_in_lessons(place, at, is_double, lab);
        } else if pane == Pane::Traces {
            self.held = Some(Held::Cursor);
            move_cursor(place, at, lab);
        } else if pane == Pane::ThreeD {
            self.held = Some(Held::Camera(at));
        }
        None
    }

    /// Returns true if a press at `at` and `now` is the second of a double click whose first press selected a row.
    fn is_double(&mut self, at: Position, now: Duration) -> bool {
        let first = self.selected.take();
        first
            .is_some_and(|(place, before)| place == at && now.saturating_sub(before) < DOUBLE_CLICK)
    }

    /// Selects the row at `at` of the open list or dialog.
    ///
    /// A double click does what Enter does there, with the row selected by the first click: the list may have scrolled
    /// since. It does not apply text typed into a dialog.
    fn press_in_list(
        &mut self,
        layout: &ScreenLayout,
        at: Position,
        is_double: bool,
        lab: &mut Lab,
    ) -> Option<LabRequest> {
        let popups = lab.popups();
        if is_double && (popups.mode != Mode::Dialog || popups.shows_settings()) {
            return press(Key::Enter, lab);
        }
        let place = screen::popup_place(lab, layout);
        let row = match (popups.mode, popups.dialog()) {
            (Mode::Browser, _) => browser::row_at(&popups.browser, place, at)?,
            (Mode::Help, _) => help::row_at(lab, place, at)?,
            (Mode::Dialog, Some(dialog)) => {
                let (form, theme) = (&dialog.form, &lab.view().theme);
                FormPane { form, theme }.field_at(place, at)?
            }
            _ => return None,
        };
        lab.clear();
        lab.popups_mut().select(row);
        self.selected = Some((at, lab.now()));
        None
    }

    /// Selects the lesson at `at` in the list, which has the area `place`. A double click opens the selected lesson.
    fn press_in_lessons(
        &mut self,
        place: Rect,
        at: Position,
        is_double: bool,
        lab: &mut Lab,
    ) -> Option<LabRequest> {
        if is_double {
            return lab.update(Action::Lesson(LessonKey::Take));
        }
        let row = lesson::choice_at(lab, place, at)?;
        self.selected = Some((at, lab.now()));
        lab.update(Action::Lesson(LessonKey::Select(row)))
    }

    fn drag(&mut self, layout: &ScreenLayout, at: Position, lab: &mut Lab) {
        if lab.popups().mode != Mode::Lab {
            return;
        }
        match self.held {
            None => {}
            Some(Held::Cursor) => {
                if let Some(place) = layout.place_of(Pane::Traces) {
                    move_cursor(place, at, lab);
                }
            }
            Some(Held::Place) => {
                let run = lab.player().run();
                let furthest = run.furthest();
                let furthest_s = Clock::at(run.scenario(), furthest).time_s(furthest);
                if let Some(overview) = Overview::new(lab, layout.overview) {
                    let time_s = overview.nearest_time_s(at.x);
                    // A drag goes only as far as the run has been computed: further seeking takes long and needs a
                    // press.
                    lab.carry_out_now(&Command::GoTo(SeekTarget::Time(time_s.min(furthest_s))));
                }
            }
            Some(Held::Camera(from)) => {
                let mut camera = lab.view().camera;
                let yaw_deg = DEGREES_A_COLUMN * (f64::from(from.x) - f64::from(at.x));
                let pitch_deg = DEGREES_A_ROW * (f64::from(at.y) - f64::from(from.y));
                camera.turn(yaw_deg, pitch_deg);
                self.held = Some(Held::Camera(at));
                lab.carry_out_now(&Command::look("camera", camera));
            }
        }
    }
}

fn pane_at(layout: &ScreenLayout, at: Position) -> Option<(Pane, Rect)> {
    let mut panes = layout.panes.iter().copied();
    panes.find(|(_, place)| place.contains(at))
}

/// Moves the cursor on the traces to the time at `at`, if there is one.
fn move_cursor(place: Rect, at: Position, lab: &mut Lab) {
    if let Some(time_s) = Traces(PlotInputs::from_lab(lab)).time_s(place, at) {
        let to = CursorTo::Place(SeekTarget::Time(time_s));
        lab.carry_out_now(&Command::Cursor(to));
    }
}

fn wheel(layout: &ScreenLayout, at: Position, up: bool, lab: &mut Lab) -> Option<LabRequest> {
    let (line, page) = if up {
        (Direction::Up, Direction::PageUp)
    } else {
        (Direction::Down, Direction::PageDown)
    };
    let lines = KeyEffect::Action(Action::Move(line, 1));
    if lab.popups().mode != Mode::Lab {
        for _ in 0..LINES {
            carry_out(lines, lab);
        }
        return None;
    }
    let (pane, place) = pane_at(layout, at)?;
    if pane == Pane::Traces {
        let about_s = Traces(PlotInputs::from_lab(lab)).time_s(place, at)?;
        lab.turn_to(pane);
        lab.press(|lab, _| lab.view().zoomed_window(about_s, up, lab.player()));
        return None;
    }
    let does = match pane {
        Pane::Above | Pane::ThreeD if up => KeyEffect::Commands(zoomed_in),
        Pane::Above | Pane::ThreeD => KeyEffect::Commands(zoomed_out),
        Pane::Lesson if lab.mode() == Mode::Lessons => {
            KeyEffect::Action(Action::Lesson(LessonKey::Move(line)))
        }
        Pane::Lesson => KeyEffect::Action(Action::Lesson(LessonKey::Move(page))),
        _ if lab.view().focus == pane => lines,
        _ => return None,
    };
    lab.turn_to(pane);
    carry_out(does, lab)
}
