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
use theme::{Background, Theme};

/// A sweep that takes longer than this to be drawn, s, is no picture of the run.
const LONGEST_SWEEP_S: f64 = 120.0;

/// A pane, named by its id: the same word in commands, in `[view]` and in sessions. The terminal has the table of all
/// panes; those named here are the ones that the lab itself turns to or moves something in.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Pane(&'static str);

/// What earlier versions called panes in the sessions they kept, and the present ids.
const EARLIER_IDS: [(&str, &str); 2] = [("from-above", "above"), ("three-d", "3d")];

/// What can be hidden of the screen.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Part {
    /// A pane.
    Pane(Pane),
    /// The line about the numbers' health.
    Health,
    /// The numbers that theory predicts.
    Predicted,
    /// The line that says what there is to see.
    LookAt,
}

impl Pane {
    /// x, y, z and tilt over time.
    pub const TRACES: Self = Self("traces");
    /// The path from above.
    pub const FROM_ABOVE: Self = Self("above");
    /// The scene in space.
    pub const THREE_D: Self = Self("3d");
    /// The scenario's values and the readouts.
    pub const PARAMETERS: Self = Self("parameters");

    /// The pane of this id.
    pub const fn new(id: &'static str) -> Self {
        Self(id)
    }

    /// Its name in files, commands and sessions.
    pub const fn id(self) -> &'static str {
        self.0
    }

    /// The pane of that name in files and commands.
    pub fn named(id: &str) -> Option<Self> {
        keys::PANES.into_iter().find(|pane| *pane == id).map(Self)
    }
}

impl Part {
    /// Its name in files and commands.
    pub fn id(self) -> &'static str {
        match self {
            Self::Pane(pane) => pane.id(),
            Self::Health => "health",
            Self::Predicted => "predicted",
            Self::LookAt => "look_at",
        }
    }

    /// The part of that name.
    pub fn named(id: &str) -> Option<Self> {
        let others = [Self::Health, Self::Predicted, Self::LookAt];
        let other = others.into_iter().find(|part| part.id() == id);
        other.or_else(|| Pane::named(id).map(Self::Pane))
    }
}

/// Options of the view.
#[derive(Clone, Debug, PartialEq)]
pub struct View {
    /// Every pane there is, in the order in which the focus goes through them.
    pub panes: &'static [Pane],
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
    /// The panes that share the screen; none: as many as there is room for.
    pub shown: Vec<Pane>,
    /// What is not shown.
    pub hidden: Vec<Part>,
    /// What there is to see, where it was told apart from the scenario.
    pub look_at: Option<String>,
    /// First line shown of a pane or list that is longer than its place.
    pub scroll: usize,
}

impl View {
    /// What a lab starts with that has these `panes`: the first has the focus, and the traces show the run of `scenario`.
    pub fn new(scenario: &Scenario, marker: Marker, theme: Theme, panes: &'static [Pane]) -> Self {
        let mut view = Self {
            panes,
            focus: panes.first().copied().unwrap_or(Pane::TRACES),
            filled: false,
            marker,
            theme,
            window_s: first_window_s(scenario),
            camera: Camera::default(),
            shown: Vec::new(),
            hidden: Vec::new(),
            look_at: None,
            scroll: 0,
        };
        view.fit(scenario);
        view
    }

    /// For another scenario: the traces show its run, and the screen begins as its `[view]` says.
    pub fn fit(&mut self, scenario: &Scenario) {
        let file = scenario.file.view.clone().unwrap_or_default();
        self.window_s = file.window_s.unwrap_or_else(|| first_window_s(scenario));
        let panes = file.show.iter().flatten();
        self.shown = panes.filter_map(|id| Pane::named(id)).collect();
        let parts = file.hide.iter().flatten();
        self.hidden = parts.filter_map(|id| Part::named(id)).collect();
        self.look_at = None;
        if !self.may_show(self.focus) {
            self.keep_focus(&self.to_show());
        }
        if let Some(fill) = &file.fill {
            self.fill(Pane::named(fill));
        }
        if let Some(camera) = file.camera {
            let usual = Camera::default();
            self.camera = Camera {
                yaw_deg: camera.yaw_deg.unwrap_or(usual.yaw_deg),
                pitch_deg: camera.pitch_deg.unwrap_or(usual.pitch_deg),
            };
        }
    }

    /// Whether `part` is hidden.
    pub fn hides(&self, part: Part) -> bool {
        self.hidden.contains(&part)
    }

    /// Whether `pane` may be on the screen.
    pub fn may_show(&self, pane: Pane) -> bool {
        let is_shown = self.shown.is_empty() || self.shown.contains(&pane);
        is_shown && !self.hides(Part::Pane(pane))
    }

    /// The panes that may be on the screen, in the order in which the focus goes through them.
    pub fn to_show(&self) -> Vec<Pane> {
        let panes = self.panes.iter().copied();
        panes.filter(|pane| self.may_show(*pane)).collect()
    }

    /// The pane of this id, as sessions name it: those that earlier versions kept are known too.
    pub fn kept_as(&self, id: &str) -> Option<Pane> {
        let earlier = EARLIER_IDS.iter().find(|(earlier, _)| *earlier == id);
        let id = earlier.map_or(id, |(_, present)| present);
        self.panes.iter().copied().find(|pane| pane.id() == id)
    }

    /// `pane` fills the screen, or none does.
    pub fn fill(&mut self, pane: Option<Pane>) {
        self.filled = pane.is_some();
        self.focus = pane.unwrap_or(self.focus);
    }

    /// The time on the traces, s, when they show twice as much (`wider`), or half; `None` where less than two steps of
    /// `time_step_s` (s) would remain.
    pub fn zoomed(&self, wider: bool, time_step_s: f64) -> Option<f64> {
        let window_s = if wider {
            self.window_s * 2.0
        } else {
            self.window_s / 2.0
        };
        (window_s >= 2.0 * time_step_s && window_s.is_finite()).then_some(window_s)
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
            self.focus = shown.first().copied().unwrap_or(Pane::TRACES);
        }
    }

    /// The 3-D view fills the screen, or no longer.
    pub fn toggle_three_d(&mut self) {
        let shown = self.filled && self.focus == Pane::THREE_D;
        (self.focus, self.filled) = if shown {
            (Pane::TRACES, false)
        } else {
            (Pane::THREE_D, true)
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
