//! How a run is shown: which panes, which of them has the focus, how much time the traces show, and which dots and
//! colours. `tui` draws accordingly. No number of a run depends on it.
//!
//! [`pane`] names the parts of the screen, `focus` moves between them; [`markers`] lists the kinds of dots, [`theme`] the
//! choice of colours, [`step`] the pages of the step pane.

mod focus;
pub mod markers;
pub mod pane;
pub mod step;
pub mod theme;

use super::action::Direction;
use super::sheet::Sheet;
use crate::observe::camera::{Camera, Zoom};
use crate::observe::recording::Curve;
use crate::run::Clock;
use crate::scenario::{Scenario, keys};
use markers::Marker;
pub use pane::{Pane, Part};
use std::sync::Arc;
use step::Page;
use theme::Theme;

/// The longest time that one sweep of the traces may take at first, seconds of wall time.
const LONGEST_SWEEP_S: f64 = 120.0;
/// The panes of a bare screen, where none are chosen.
const BARE: [Pane; 2] = [Pane::TRACES, Pane::FROM_ABOVE];
/// Frames a second at most, where nothing is chosen.
pub const FPS: u32 = 15;
/// Degrees by which one press of an arrow turns the camera.
const TURN_DEG: f64 = 10.0;

#[derive(Clone, Debug, PartialEq)]
pub struct View {
    /// Every pane there is, in the order in which the focus goes through them.
    pub panes: &'static [Pane],
    pub focus: Pane,
    /// Whether the user turned to it, or pressed a key of its own: the footer then names those.
    pub is_touched: bool,
    pub filled: bool,
    pub marker: Marker,
    pub theme: Theme,
    /// Length of time the traces show, s.
    pub window_s: f64,
    /// Length of time that the strip of the fast motion shows, s; `None`: about ten swings.
    pub detail_s: Option<f64>,
    /// What that strip shows; `None`: the tilt, or x where the tilt does not swing.
    pub detail_of: Option<Curve>,
    /// Time at the left edge of the traces, s; `None`: they follow the run.
    pub since_s: Option<f64>,
    /// How many times the values of the traces are magnified: about the value at the cursor, or else about the run's
    /// present one.
    pub magnified: f64,
    /// The step at which the traces are read off.
    pub cursor: Option<u64>,
    /// Where the 3-D view is looked at from.
    pub camera: Camera,
    /// Whether that direction was chosen by hand, a file or a command. One that was not is turned so that the axle is seen
    /// aslant.
    pub camera_is_chosen: bool,
    /// How much larger than the whole the round pictures are shown.
    pub zoom: Zoom,
    /// The panes that share the screen; if empty, as many as there is room for.
    pub shown: Vec<Pane>,
    /// The page that the step pane shows.
    pub page: Page,
    /// The phase to which the step pane returns from its last page.
    pub page_before: Page,
    /// How many rows of a table the step pane adds up; `None`: all.
    pub sum_to: Option<usize>,
    pub hidden: Vec<Part>,
    /// The line about what there is to see, if a command has set it; otherwise the scenario's line is shown.
    pub look_at: Option<String>,
    /// The line about what to try after the run, if a command has set it; otherwise the scenario's or the preset's.
    pub next: Option<String>,
    /// Whether the screen is bare: few panes, and nothing around them but title and time.
    pub bare: bool,
    pub pointed_at: Option<Pane>,
    /// The pane beside the text where there is room for one: the last that had the focus, or the first that was chosen.
    pub beside: Option<Pane>,
    /// The text beside the panes.
    pub sheet: Option<Arc<Sheet>>,
    /// The first row of the text that is shown; `None`: the row that brings its important paragraph into view.
    pub sheet_scrolled: Option<usize>,
    /// Whether measured data stand beside the run: a line then tells of them.
    pub measured: bool,
    /// Whether what was measured is shown less what the run says.
    pub residuals: bool,
    /// Frames a second at most.
    pub fps: u32,
    /// Whether the lab listens to the mouse; otherwise the terminal has it, to select text.
    pub mouse: bool,
    /// The panes that stand side by side on the screen, as it is now, while none fills it: from left to right, in the
    /// order in which the focus goes through them. Until the screen is known, all panes.
    pub side_by_side: Vec<Pane>,
}

impl View {
    /// The view with which a lab of these `panes` starts: the first has the focus, and the traces show the run of `scenario`.
    pub fn new(scenario: &Scenario, marker: Marker, theme: Theme, panes: &'static [Pane]) -> Self {
        let mut view = Self {
            panes,
            focus: panes.first().copied().unwrap_or(Pane::TRACES),
            is_touched: false,
            filled: false,
            marker,
            theme,
            window_s: first_window_s(scenario),
            detail_s: None,
            detail_of: None,
            since_s: None,
            magnified: 1.0,
            cursor: None,
            camera: Camera::default(),
            camera_is_chosen: false,
            zoom: Zoom::default(),
            shown: Vec::new(),
            page: Page::default(),
            page_before: Page::default(),
            sum_to: None,
            hidden: Vec::new(),
            look_at: None,
            next: None,
            bare: false,
            pointed_at: None,
            beside: None,
            sheet: None,
            sheet_scrolled: None,
            measured: false,
            residuals: false,
            fps: FPS,
            mouse: true,
            side_by_side: panes.to_vec(),
        };
        view.fit(scenario);
        view
    }

    /// Changes to another scenario: the traces show its run, and the rest is as its `[view]` says.
    pub fn fit(&mut self, scenario: &Scenario) {
        let file = scenario.file.view.clone().unwrap_or_default();
        self.window_s = self.usual_window_s(scenario);
        self.detail_s = file.detail_s;
        self.detail_of = file.detail_of.as_deref().and_then(Curve::of_name);
        (self.since_s, self.magnified, self.cursor) = (None, 1.0, None);
        let panes = file.show.iter().flatten();
        let panes: Vec<_> = panes.filter_map(|id| Pane::named(id)).collect();
        self.show(&panes);
        self.fit_step(&file);
        let parts = file.hide.iter().flatten();
        self.hidden = parts.filter_map(|id| Part::named(id)).collect();
        (self.look_at, self.next) = (None, None);
        self.bare = file.bare.unwrap_or(self.bare);
        self.residuals = file.residuals.unwrap_or(self.residuals);
        if !self.may_show(self.focus) {
            self.keep_focus_among(&self.to_show());
        }
        if let Some(fill) = &file.fill {
            self.fill(Pane::named(fill));
        }
        if let Some(zoom) = file.zoom {
            self.zoom = Zoom::of(zoom);
        }
        match file.camera {
            Some(camera) => self.look_from(Camera::of(camera)),
            // The camera of the last run need not suit another one.
            None if !self.camera_is_chosen => self.camera = Camera::default(),
            None => {}
        }
    }

    /// Looks at the 3-D view from where `camera` is. The usual place is no choice.
    pub fn look_from(&mut self, camera: Camera) {
        self.camera_is_chosen = camera != Camera::default();
        self.camera = camera;
    }

    /// The time that the traces show of the run of `scenario` while none is chosen by hand, s.
    pub fn usual_window_s(&self, scenario: &Scenario) -> f64 {
        let chosen = scenario.file.view.as_ref().and_then(|view| view.window_s);
        chosen.unwrap_or_else(|| first_window_s(scenario))
    }

    pub fn hides(&self, part: Part) -> bool {
        self.hidden.contains(&part)
    }

    pub fn may_show(&self, pane: Pane) -> bool {
        if pane == Pane::LESSON {
            return self.sheet.is_some() && !self.hides(Part::Pane(pane));
        }
        let is_shown = match (self.shown.is_empty(), self.bare) {
            (true, true) => BARE.contains(&pane),
            (true, false) => pane != Pane::STEP,
            (false, _) => self.shown.contains(&pane),
        };
        is_shown && !self.hides(Part::Pane(pane))
    }

    /// The panes that may be on the screen, in the order in which the focus goes through them.
    pub fn to_show(&self) -> Vec<Pane> {
        let panes = self.panes.iter().copied();
        panes.filter(|pane| self.may_show(*pane)).collect()
    }

    pub fn kept_as(&self, id: &str) -> Option<Pane> {
        self.panes.iter().copied().find(|pane| pane.id() == id)
    }

    /// Twice the time that the traces show (`wider`), or half of it, s; `None` if less than two time steps of
    /// `time_step_s` (s) would remain.
    pub fn zoomed(&self, wider: bool, time_step_s: f64) -> Option<f64> {
        let window_s = if wider {
            self.window_s * 2.0
        } else {
            self.window_s / 2.0
        };
        (window_s >= 2.0 * time_step_s && window_s.is_finite()).then_some(window_s)
    }

    /// The camera after an arrow key was pressed `times` times; each press turns it by 10 degrees.
    pub(super) fn turned(&self, direction: Direction, times: i32) -> Camera {
        let degrees = f64::from(times) * TURN_DEG;
        let (yaw_deg, pitch_deg) = match direction {
            Direction::Left => (-degrees, 0.0),
            Direction::Right => (degrees, 0.0),
            Direction::Up | Direction::PageUp => (0.0, degrees),
            Direction::Down | Direction::PageDown => (0.0, -degrees),
        };
        let mut camera = self.camera;
        camera.turn(yaw_deg, pitch_deg);
        camera
    }
}

/// The time that the traces show at first, s: the whole run, or what of it is played in two minutes.
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
