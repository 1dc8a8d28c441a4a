//! How the run is looked at: dots and colours.

use super::Lab;
use crate::lab::view::Pane;

impl Lab {
    /// Every pane that can have the focus: those on the screen, or all where there is room for one or two.
    fn focusable(&self) -> Vec<Pane> {
        let may_have_it = |pane: &Pane| self.view.may_show(*pane) || self.is_filled_by(*pane);
        if !self.view.filled && self.side_by_side.len() > 2 {
            // What was hidden since the screen was fitted is among them still.
            let panes = self.side_by_side.iter().copied();
            let left: Vec<_> = panes.filter(may_have_it).collect();
            if !left.is_empty() {
                return left;
            }
        }
        let panes = self.view.panes.iter().copied();
        panes.filter(may_have_it).collect()
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
