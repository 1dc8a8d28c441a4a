//! The mouse: what a press, a drag or the wheel does where it points. Nothing needs it; every act has keys too.

use super::keymap::{KeyEffect, Mode, narrower, wider, zoomed_in, zoomed_out};
use super::layout::ScreenLayout;
use super::panes::{PlotInputs, browser, carry_out, chrome, timeline::Timeline, traces::Traces};
use super::press::press;
use super::screen;
use crate::engine::run::Clock;
use crate::lab::action::{Action, Direction, LessonKey};
use crate::lab::command::{Command, CursorTo, SeekTarget};
use crate::lab::view::Pane;
use crate::lab::{Lab, LabRequest};
use ratatui::layout::{Position, Rect};

/// Degrees by which the 3-D view turns where it is dragged by a column, and by a row, which is twice as high.
const DEGREES_A_COLUMN: f64 = 3.0;
const DEGREES_A_ROW: f64 = 6.0;
/// Lines that one notch of the wheel moves a list by.
const LINES: usize = 3;

/// What the mouse did, and at which cell of the screen.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Mouse {
    pub did: Did,
    /// The column and the line, from 0.
    pub x: u16,
    pub y: u16,
}

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

#[derive(Debug, Default)]
pub struct Pointer {
    held: Option<Held>,
}

impl Pointer {
    /// Does in `lab`, on a screen of this `area`, what `mouse` stands for; outside the screen that is nothing.
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
        match lab.popups().mode {
            Mode::Lab => {}
            Mode::Browser | Mode::Filter => return press_in_browser(layout, at, lab),
            Mode::Help | Mode::Find | Mode::Dialog => return None,
        }
        if layout.timeline.contains(at) {
            self.held = Some(Held::Place);
            let time_s = Timeline::new(lab).time_s(layout.timeline, at.x)?;
            lab.carry_out_now(&Command::GoTo(SeekTarget::Time(time_s)));
            return None;
        }
        let (pane, place) = pane_at(layout, at)?;
        lab.turn_to(pane);
        if pane == Pane::Traces {
            self.held = Some(Held::Cursor);
            read_off(place, at, lab);
        } else if pane == Pane::ThreeD {
            self.held = Some(Held::Camera(at));
        }
        None
    }

    fn drag(&mut self, layout: &ScreenLayout, at: Position, lab: &mut Lab) {
        if lab.popups().mode != Mode::Lab {
            return;
        }
        match self.held {
            None => {}
            Some(Held::Cursor) => {
                if let Some(place) = layout.place_of(Pane::Traces) {
                    read_off(place, at, lab);
                }
            }
            Some(Held::Place) => {
                let run = lab.player().run();
                let furthest = run.furthest();
                let furthest_s = Clock::at(run.scenario(), furthest).time_s(furthest);
                let time_s = Timeline::new(lab).time_s(layout.timeline, at.x);
                if let Some(time_s) = time_s {
                    // Time that the run has not reached would take long: a press goes there.
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

/// Sets the cursor on the traces to the time at `at`, where there is one.
fn read_off(place: Rect, at: Position, lab: &mut Lab) {
    if let Some(time_s) = Traces(PlotInputs::from_lab(lab)).time_s(place, at) {
        let to = CursorTo::Place(SeekTarget::Time(time_s));
        lab.carry_out_now(&Command::Cursor(to));
    }
}

/// Selects the entry at `at`, or opens it if it is selected already.
fn press_in_browser(layout: &ScreenLayout, at: Position, lab: &mut Lab) -> Option<LabRequest> {
    let row = browser::row_at(&lab.popups().browser, screen::popup_place(lab, layout), at)?;
    if lab.popups().browser.selected == row {
        return lab.update(Action::Choose);
    }
    lab.clear();
    lab.popups_mut().browser.select(row);
    None
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
    let (pane, _) = pane_at(layout, at)?;
    let does = match pane {
        Pane::Traces if up => KeyEffect::Commands(narrower),
        Pane::Traces => KeyEffect::Commands(wider),
        Pane::Above | Pane::ThreeD if up => KeyEffect::Commands(zoomed_in),
        Pane::Above | Pane::ThreeD => KeyEffect::Commands(zoomed_out),
        Pane::Lesson => KeyEffect::Action(Action::Lesson(LessonKey::Move(page))),
        _ if lab.view().focus == pane => lines,
        _ => return None,
    };
    lab.turn_to(pane);
    carry_out(does, lab)
}
