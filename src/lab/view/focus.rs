//! Which pane has the focus, and whether it fills the screen.

use super::{Pane, View};
use crate::lab::command::Command;

impl View {
    /// The commands that show `pane`, one that is shown on request, beside another one, or take it away.
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

    /// Fills the screen with `pane` and moves the focus there; with `None` shows all panes again.
    pub fn fill(&mut self, pane: Option<Pane>) {
        self.fullscreen = pane.is_some();
        self.focus_on(pane.unwrap_or(self.focus));
        self.is_touched |= self.fullscreen;
    }

    /// Whether the title of `pane` shows the focus: not before the user has turned to a pane.
    pub fn marks_focus_of(&self, pane: Pane) -> bool {
        self.focus == pane && self.is_touched
    }

    pub fn is_filled_by(&self, pane: Pane) -> bool {
        self.fullscreen && self.focus == pane
    }

    /// The panes that can have the focus, from left to right. One that is not on the screen comes there with the focus. Beside
    /// a page they are those that it names, and the one that the user has turned to.
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

    /// Moves the focus to the next pane that can have it, or to the one before; after the last comes the first.
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

    /// Moves the focus to `pane`, which fills the screen if it may not stand beside others.
    pub fn turn_to(&mut self, pane: Pane) {
        let is_filled = self.is_filled_by(pane);
        self.focus_on(pane);
        self.fullscreen = is_filled || !self.may_show(pane);
        self.is_touched = true;
    }

    /// Moves the focus to the 3-D view, which takes the place of the path from above where there is room for one; or from
    /// there back, in a lesson to its page.
    pub(in crate::lab) fn toggle_three_d(&mut self) {
        if self.focus == Pane::ThreeD {
            self.turn_to(Pane::Above);
            self.turn_to_sheet();
        } else {
            self.turn_to(Pane::ThreeD);
        }
    }

    /// Moves the focus from the parameters to the first other pane that can have it; returns whether it did.
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

    /// Moves the focus to the page, where there is one, once no pane fills the screen any more. On a screen that has no place
    /// for the values beside the run, they fill it: leaving them shows the run again.
    pub(in crate::lab) fn leave_filled(&mut self) {
        self.turn_to_sheet();
        if !self.side_by_side.contains(&Pane::Parameters) {
            self.leave_parameters();
        }
    }

    /// Moves the focus to the first pane that can have it, if the one in focus no longer can.
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
