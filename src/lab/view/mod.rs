//! How the user looks at a run: which pane has the focus, how much time the traces show, and which dots and colours
//! are chosen. All of it is plain values: the terminal gives them their places and their looks. A run's numbers never
//! depend on them.
//!
//! [`markers`] lists the kinds of dots, [`theme`] the choice of colours.

pub mod markers;
pub mod theme;

use crate::observe::camera::Camera;
use crate::run::Clock;
use crate::scenario::{Scenario, keys};
use markers::Marker;
use serde::{Deserialize, Serialize};
use theme::{Background, Theme};

/// A sweep that takes longer than this to be drawn, s, is no picture of the run.
const LONGEST_SWEEP_S: f64 = 120.0;

/// The panes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Pane {
    /// x, y, z and tilt over time.
    Traces,
    /// The path from above.
    FromAbove,
    /// The scene in space.
    ThreeD,
    /// The scenario's values and the readouts.
    Parameters,
}

impl Pane {
    /// Every pane, in the order in which the focus goes through them.
    pub const ALL: [Self; 4] = [
        Self::Traces,
        Self::FromAbove,
        Self::ThreeD,
        Self::Parameters,
    ];
}

/// Options of the view.
#[derive(Clone, Debug, PartialEq)]
pub struct View {
    /// The pane in focus.
    pub focus: Pane,
    /// Whether it fills the screen.
    pub filled: bool,
    /// What dots are made of.
    pub marker: Marker,
    /// Colours.
    pub theme: Theme,
    /// Length of time the traces show, s.
    pub window_s: f64,
    /// Where the 3-D view is looked at from.
    pub camera: Camera,
    /// First line shown of a pane or list that is longer than its place.
    pub scroll: usize,
}

impl View {
    /// What a lab starts with: the traces show the run of `scenario`.
    pub fn new(scenario: &Scenario, marker: Marker, theme: Theme) -> Self {
        Self {
            focus: Pane::Traces,
            filled: false,
            marker,
            theme,
            window_s: first_window_s(scenario),
            camera: Camera::default(),
            scroll: 0,
        }
    }

    /// For another scenario: the traces show its run.
    pub fn fit(&mut self, scenario: &Scenario) {
        self.window_s = first_window_s(scenario);
    }

    /// Twice the time on the traces (`wider`), or half of it; at least two steps of `time_step_s` (s) remain.
    pub fn zoom(&mut self, wider: bool, time_step_s: f64) {
        let window_s = if wider {
            self.window_s * 2.0
        } else {
            self.window_s / 2.0
        };
        if window_s >= 2.0 * time_step_s && window_s.is_finite() {
            self.window_s = window_s;
        }
    }

    /// The focus on the next pane of `shown`, or on the one before.
    pub fn shift_focus(&mut self, shown: &[Pane], forward: bool) {
        let (count, here) = (
            shown.len(),
            shown.iter().position(|&pane| pane == self.focus),
        );
        let next = match (here, forward) {
            (Some(here), true) => (here + 1) % count,
            (Some(here), false) => (here + count - 1) % count,
            (None, _) => 0,
        };
        if let Some(&pane) = shown.get(next) {
            self.focus = pane;
            self.scroll = 0;
        }
    }

    /// The focus on `pane`; it fills the screen where it is not among the panes `shown`.
    pub fn turn_to(&mut self, pane: Pane, shown: &[Pane]) {
        self.filled = (self.filled && self.focus == pane) || !shown.contains(&pane);
        self.focus = pane;
    }

    /// The focus on one of `shown`.
    pub fn keep_focus(&mut self, shown: &[Pane]) {
        if !shown.contains(&self.focus) {
            self.focus = Pane::Traces;
        }
    }

    /// The pane in focus fills the screen, or no longer.
    pub fn toggle_filled(&mut self) {
        self.filled = !self.filled;
    }

    /// The 3-D view fills the screen, or no longer.
    pub fn toggle_three_d(&mut self) {
        let shown = self.filled && self.focus == Pane::ThreeD;
        (self.focus, self.filled) = if shown {
            (Pane::Traces, false)
        } else {
            (Pane::ThreeD, true)
        };
    }

    /// For a dark screen, or for a light one.
    pub fn toggle_background(&mut self) {
        self.theme.background = match self.theme.background {
            Background::Dark => Background::Light,
            Background::Light => Background::Dark,
        };
    }
}

/// The time the traces show at first, s: the whole run, or as much of it as is played in a while.
fn first_window_s(scenario: &Scenario) -> f64 {
    let speed = scenario
        .file
        .view
        .as_ref()
        .and_then(|view| view.speed)
        .unwrap_or(keys::SPEED);
    let whole = Clock::end_s(scenario);
    whole
        .min(LONGEST_SWEEP_S * speed)
        .max(2.0 * scenario.motion.time_step_s)
}
