//! The focus: the pane that has it, and full screen.

use super::{Pane, View};
use crate::lab::command::Command;

impl View {
    /// Returns the commands that show `pane`, which is shown on request only, or hide it.
    pub(in crate::lab) fn toggled(&self, pane: Pane) -> Vec<Command> {
        let with_it = [Pane::Traces, Pane::ThreeD, pane];
        let mut commands = Vec::new();
        if self.fullscreen {
            commands.push(Command::Fill(None));
        }
        if self.look.show.contains(&pane) == self.shows(pane) {
            let mut panes = self.look.show.clone();
            panes.retain(|other| *other != pane && self.look.show != with_it);
            if self.look.show.is_empty() {
                panes = with_it.to_vec();
            } else if !self.look.show.contains(&pane) {
                panes.push(pane);
            }
            commands.push(Command::look("show", panes));
        }
        commands
    }

    /// Fills the screen with `pane` and moves the focus there. With `None`, leaves full screen.
    pub fn fill(&mut self, pane: Option<Pane>) {
        self.fullscreen = pane.is_some();
        self.focus_on(pane.unwrap_or(self.focus));
        self.is_touched |= self.fullscreen;
    }

    /// Returns true if the title of `pane` is marked as having the focus. It is not marked before the user has moved to
    /// a pane.
    pub fn marks_focus_of(&self, pane: Pane) -> bool {
        self.focus == pane && self.is_touched
    }

    pub fn is_filled_by(&self, pane: Pane) -> bool {
        self.fullscreen && self.focus == pane
    }

    /// Returns the panes that can have the focus, from left to right. A pane that is not on the screen appears with the
    /// focus.
    ///
    /// Next to a page, these are the panes that the page names and the one that the user has moved to.
    fn focusable(&self) -> Vec<Pane> {
        Pane::ALL
            .into_iter()
            .filter(|pane| {
                let is_chosen = self.names(*pane) || self.focus == *pane;
                is_chosen && self.may_show(*pane) || self.is_filled_by(*pane)
            })
            .collect()
    }

    /// Moves the focus to `pane`.
    fn focus_on(&mut self, pane: Pane) {
        self.focus = pane;
        if [Pane::Above, Pane::ThreeD].contains(&pane) {
            self.path_view = pane;
        }
    }

    /// Moves the focus to the next pane that can have it, or to the previous one. The order is circular.
    pub fn shift_focus(&mut self, forward: bool) {
        let panes = self.focusable();
        let count = panes.len();
        let here = panes.iter().position(|&pane| pane == self.focus);
        let next = match (here, forward) {
            (Some(here), true) => (here + 1) % count,
            (Some(here), false) => (here + count - 1) % count,
            (None, _) => 0,
        };
        self.focus_on(panes.get(next).copied().unwrap_or(self.focus));
        self.is_touched = true;
    }

    /// Moves the focus to `pane`. It fills the screen if it cannot be shown next to others.
    pub fn turn_to(&mut self, pane: Pane) {
        let is_filled = self.is_filled_by(pane);
        self.focus_on(pane);
        self.fullscreen = is_filled || !self.may_show(pane);
        self.is_touched = true;
    }

    /// Moves the focus to the 3-D view, which replaces the path from above if there is room for only one. From the 3-D
    /// view, moves the focus back; in a lesson, to its page.
    pub(in crate::lab) fn toggle_three_d(&mut self) {
        if self.focus == Pane::ThreeD {
            self.turn_to(Pane::Above);
            self.turn_to_sheet();
        } else {
            self.turn_to(Pane::ThreeD);
        }
    }

    /// Moves the focus from the values to the first other pane that can have it. Returns true if it did.
    pub fn leave_parameters(&mut self) -> bool {
        let mut others = self.focusable().into_iter();
        let other = others.find(|&pane| pane != Pane::Parameters);
        let (true, Some(other)) = (self.focus == Pane::Parameters, other) else {
            return false;
        };
        self.turn_to(other);
        self.is_touched = false;
        true
    }

    /// Moves the focus to the page, if there is one, after full screen was left.
    ///
    /// On a screen without room for the values next to the run, the values fill it. Leaving them shows the run again.
    pub(in crate::lab) fn leave_filled(&mut self) {
        self.turn_to_sheet();
        if !self.side_by_side.contains(&Pane::Parameters) {
            self.leave_parameters();
        }
    }

    /// Moves the focus to the first pane that can have it, if the present one no longer can.
    pub fn keep_focus(&mut self) {
        self.keep_focus_among(&self.focusable());
        if ![Pane::Lesson, Pane::Parameters].contains(&self.focus) && !self.fullscreen {
            self.beside = Some(self.focus);
        }
    }

    pub(super) fn keep_focus_among(&mut self, panes: &[Pane]) {
        if !panes.contains(&self.focus) {
            self.focus = panes.first().copied().unwrap_or(Pane::Traces);
            self.is_touched = false;
        }
    }
}
