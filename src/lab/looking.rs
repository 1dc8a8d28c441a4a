//! How the run is looked at: what moves under the arrows, the window of time, dots and colours.

use super::Lab;
use crate::lab::action::Direction;
use crate::lab::view::Pane;
use crate::tui::keymap::Mode;

/// Rows of a page in lists.
const PAGE: isize = 10;
/// Degrees the camera turns at a key.
const TURN_DEG: f64 = 10.0;

impl Lab {
    pub(super) fn toggle_exact(&mut self) {
        let shown = self.run().overlay().is_none();
        self.playback.set_exact(shown);
        self.say(match shown {
            true => "the exact motion of the same start is drawn in dashes; t takes it away",
            false => "without the exact motion",
        });
    }

    pub(super) fn shift(&mut self, direction: Direction, times: i32) {
        let rows = rows(direction) * times as isize;
        match (self.mode, self.view.focus) {
            (Mode::Browser | Mode::Filter, _) => self.browser.shift(rows),
            (Mode::Lab, Pane::ThreeD) => self.turn_camera(direction, f64::from(times) * TURN_DEG),
            (Mode::Lab, Pane::Parameters) => self.move_in_parameters(direction, times),
            (Mode::Lab, Pane::Traces | Pane::FromAbove) => {
                self.say("arrows change values (e), turn the 3-D view (d) and move in lists");
            }
            _ => self.view.scroll = self.view.scroll.saturating_add_signed(rows),
        }
    }

    /// Every pane that can have the focus: those on the screen, or all where there is room for one or two.
    fn focusable(&self) -> Vec<Pane> {
        if self.view.filled || self.side_by_side.len() <= 2 {
            Pane::ALL.to_vec()
        } else {
            self.side_by_side.clone()
        }
    }

    pub(super) fn shift_focus(&mut self, forward: bool) {
        let focusable = self.focusable();
        self.view.shift_focus(&focusable, forward);
    }

    pub(super) fn keep_focus(&mut self) {
        let focusable = self.focusable();
        self.view.keep_focus(&focusable);
    }

    pub(super) fn turn_to(&mut self, pane: Pane) {
        let focusable = self.focusable();
        self.view.turn_to(pane, &focusable);
    }

    fn turn_camera(&mut self, direction: Direction, degrees: f64) {
        let (yaw, pitch) = match direction {
            Direction::Left => (-degrees, 0.0),
            Direction::Right => (degrees, 0.0),
            Direction::Up | Direction::PageUp => (0.0, degrees),
            Direction::Down | Direction::PageDown => (0.0, -degrees),
        };
        self.view.camera.turn(yaw, pitch);
    }

    pub(super) fn zoom(&mut self, wider: bool) {
        self.view
            .zoom(wider, self.run().simulation().motion().time_step_s);
        self.say(format!("the traces show {} s", self.view.window_s));
    }

    pub(super) fn next_marker(&mut self) {
        self.view.marker = self.view.marker.next();
        self.say(format!("dots: {}", self.view.marker.name()));
    }

    pub(super) fn toggle_colour(&mut self) {
        self.view.theme.colour = !self.view.theme.colour;
        self.say(if self.view.theme.colour {
            "with colours"
        } else {
            "without colours"
        });
    }

    pub(super) fn toggle_background(&mut self) {
        self.view.toggle_background();
        self.say(match self.view.theme.colour {
            true => format!("colours for a {:?} screen", self.view.theme.background).to_lowercase(),
            false => "there are no colours: c turns them on".to_owned(),
        });
    }
}

fn rows(direction: Direction) -> isize {
    match direction {
        Direction::Up | Direction::Left => -1,
        Direction::Down | Direction::Right => 1,
        Direction::PageUp => -PAGE,
        Direction::PageDown => PAGE,
    }
}
