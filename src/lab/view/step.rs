//! What the step pane shows of the time step taken last: one of its phases, or why the axle goes sideways.

use super::{Pane, View};
use crate::physics::Workings;
use crate::physics::workings::NAMES;
use crate::scenario::file::{Choice, ViewFile};
use crate::scenario::screen::{LAST, WHY};

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Page {
    /// The phase of this number, from 1; the last one where there are fewer.
    Number(usize),
    /// The first phase of this name; the first phase of all if no phase has it.
    Named(&'static str),
    Last,
    /// Why sideways, not down?
    Why,
}

impl Default for Page {
    fn default() -> Self {
        Self::Number(1)
    }
}

impl Page {
    pub fn named(name: &str) -> Option<Self> {
        match name {
            LAST => Some(Self::Last),
            WHY => Some(Self::Why),
            _ => NAMES
                .into_iter()
                .find(|known| *known == name)
                .map(Self::Named),
        }
    }

    pub fn of(choice: &Choice) -> Option<Self> {
        match choice {
            Choice::Number(number) => usize::try_from(*number).ok().map(Self::Number),
            Choice::Word(name) => Self::named(name),
        }
    }

    /// The page as files write it.
    pub fn choice(self) -> Choice {
        match self {
            Self::Number(number) => Choice::Number(number as u64),
            Self::Named(name) => Choice::Word(name.to_owned()),
            Self::Last => Choice::Word(LAST.to_owned()),
            Self::Why => Choice::Word(WHY.to_owned()),
        }
    }

    /// The index of its phase in `workings`; `None` for the page that shows no phase, and where there are no phases.
    pub fn index(self, workings: &Workings) -> Option<usize> {
        let last = workings.phases().count().checked_sub(1)?;
        match self {
            Self::Number(number) => Some(number.saturating_sub(1).min(last)),
            Self::Named(name) => {
                let found = workings.phases().position(|phase| phase.name == name);
                Some(found.unwrap_or(0))
            }
            Self::Last => Some(last),
            Self::Why => None,
        }
    }
}

impl View {
    /// Sets page and sum of the step pane from `[view]`, or to their defaults.
    pub(super) fn fit_step(&mut self, file: &ViewFile) {
        self.page = file.phase.as_ref().and_then(Page::of).unwrap_or_default();
        self.sum_to = match &file.sum_to {
            Some(Choice::Number(rows)) => usize::try_from(*rows).ok(),
            _ => None,
        };
    }

    /// Whether the step pane is on the screen, if that has room for it.
    pub fn shows_step(&self) -> bool {
        self.is_filled_by(Pane::STEP) || (!self.filled && self.may_show(Pane::STEP))
    }

    /// Chooses the panes that share the screen; the step pane has the focus when it comes.
    pub fn show(&mut self, panes: &[Pane]) {
        let comes = panes.contains(&Pane::STEP) && !self.shown.contains(&Pane::STEP);
        if self.shown != panes {
            self.shown = panes.to_vec();
            self.beside = panes.first().copied();
            self.side_by_side = self.to_show(); // until the lab is fitted to its screen again
        }
        if comes && !self.filled {
            self.focus = Pane::STEP;
        }
    }

    /// The panes that share the screen once the step pane is shown beside them, or is no longer.
    pub(in crate::lab) fn with_step_toggled(&self) -> Vec<Pane> {
        const BESIDE: [Pane; 2] = [Pane::THREE_D, Pane::STEP];
        match self.shown.contains(&Pane::STEP) {
            true if self.shown == BESIDE => Vec::new(),
            true => {
                let others = self.shown.iter().copied();
                others.filter(|pane| *pane != Pane::STEP).collect()
            }
            false if self.shown.is_empty() => BESIDE.to_vec(),
            false => self.shown.iter().copied().chain([Pane::STEP]).collect(),
        }
    }
}
