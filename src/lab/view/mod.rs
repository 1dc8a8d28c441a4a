//! How a run is shown: the panes and the focus among them, the time that the traces show, markers and colors. `tui`
//! draws accordingly. No number of a run depends on it.
//!
//! [`pane`] names the parts of the screen, and `focus` moves between them. `commands` carries out the commands of the
//! view. [`theme`] contains the choices of markers and colors, and [`step`] the pages of the step pane.

mod commands;
mod focus;
pub mod pane;
pub mod step;
mod swings;
pub mod theme;
pub mod window;

use super::sheet::{AskedAnswer, Sheet};
use crate::engine::data::RunQuantity;
use crate::engine::scenario::screen::AUTO;
use crate::engine::scenario::{Scenario, keys};
use crate::plot::camera::{Camera, Zoom};
pub use pane::{HideablePart, Pane};
use serde::de::{DeserializeOwned, Error};
use serde::{Deserialize, Deserializer, Serialize, Serializer};
use std::sync::Arc;
use step::StepPageChoice;
use theme::{Marker, Theme};
use toml::{Table, Value};
use window::TimeWindow;

/// The panes of a bare screen, unless others are chosen.
const BARE: [Pane; 2] = [Pane::Traces, Pane::Above];
/// Number of swings in the traces if there is room for them.
pub const USUAL_SWINGS: usize = 8;
/// Default maximum frame rate, frames per second.
pub const FPS: u32 = 15;

/// The display settings of a run, from `[view]` of a scenario, from a session and from commands. Serde reads and writes
/// them under the keys of `[view]`.
///
/// [`patched`](Self::patched) returns new settings with some of the keys changed.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct ViewSettings {
    /// Time span of the overview, s; `None` for the whole run.
    pub window_s: Option<f64>,
    /// Length of the traces, s; `None` for a few swings, or the whole run.
    #[serde(deserialize_with = "value_or_word")]
    pub detail_s: Option<f64>,
    /// The strip below the strips of x, y and z.
    pub detail_of: FourthStrip,
    /// Minimum and maximum of that strip, in its unit; `None` for the range of the run.
    #[serde(deserialize_with = "value_or_word")]
    pub detail_range: Option<[f64; 2]>,
    /// Minimum and maximum of the strip of z, m; `None` for the range of the run.
    #[serde(deserialize_with = "value_or_word")]
    pub z_range_m: Option<[f64; 2]>,
    /// The chosen camera of the 3-D view. With `None` the camera is turned so that the axle is seen at an angle.
    pub camera: Option<Camera>,
    /// Magnification of the path from above and of the 3-D view; 1 shows the whole picture.
    pub zoom: Zoom,
    /// The panes that share the screen. If empty, as many as there is room for.
    pub show: Vec<Pane>,
    pub hide: Vec<HideablePart>,
    /// The page of the step pane.
    pub phase: StepPageChoice,
    /// Number of table rows that the step pane adds up; `None` for all.
    #[serde(deserialize_with = "value_or_word")]
    pub sum_to: Option<usize>,
    /// The line about what to look at, if a command has set it. Otherwise the scenario's line is shown.
    pub look_at: Option<String>,
    /// The line about what to try after the run, if a command has set it. Otherwise the line of the scenario or the
    /// preset is shown.
    pub next: Option<String>,
    /// True for a bare screen: few panes, with only title and time around them.
    pub bare: bool,
    /// True to show residuals: measured values minus the run.
    pub residuals: bool,
}

/// The strip of the traces below the strips of x, y and z.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum FourthStrip {
    /// The distance from the exact motion if that is shown, or else the tilt. Only a large screen has this strip.
    #[default]
    Auto,
    None,
    X,
    Y,
    Z,
    Tilt,
    /// The distance from the exact motion.
    Distance,
    /// The column with this name in the run's CSV.
    Column(&'static str),
}

impl FourthStrip {
    /// The strips with names of their own in files. All others are CSV columns.
    const NAMED: [(Self, &str); 7] = [
        (Self::Auto, AUTO),
        (Self::None, "none"),
        (Self::X, "x"),
        (Self::Y, "y"),
        (Self::Z, "z"),
        (Self::Tilt, "tilt"),
        (Self::Distance, "distance"),
    ];

    /// Returns its name in files.
    pub fn name(self) -> &'static str {
        let mut named = Self::NAMED.iter();
        match self {
            Self::Column(name) => name,
            _ => named
                .find(|(own, _)| *own == self)
                .map_or(AUTO, |(_, name)| name),
        }
    }

    /// Returns the quantity of its column; `None` for strips that are always recorded.
    pub fn column(self) -> Option<&'static RunQuantity> {
        match self {
            Self::Column(name) => RunQuantity::find(name),
            _ => None,
        }
    }
}

impl Serialize for FourthStrip {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.serialize_str(self.name())
    }
}

impl<'de> Deserialize<'de> for FourthStrip {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let name = String::deserialize(deserializer)?;
        let named = Self::NAMED.iter().find(|(_, own)| *own == name);
        match (named, RunQuantity::find(&name)) {
            (Some((strip, _)), _) => Ok(*strip),
            (None, Some(quantity)) => Ok(Self::Column(quantity.name)),
            (None, None) => Err(D::Error::custom(format!("there is no column {name}"))),
        }
    }
}

/// Deserializes a value, or `None` from a word such as "auto" or "all".
fn value_or_word<'de, T: DeserializeOwned, D: Deserializer<'de>>(
    deserializer: D,
) -> Result<Option<T>, D::Error> {
    Ok(Value::deserialize(deserializer)?.try_into().ok())
}

/// Returns true if `[view]` has the key or table `name`.
pub fn is_key(name: &str) -> bool {
    let path = format!("view.{name}");
    keys::find(&path).is_ok() || keys::SCENARIO.is_table(&path)
}

impl ViewSettings {
    /// Returns true if `key` of `[view]` is a field of this type. Speed, measured data, exact motion and the
    /// full-screen pane are not.
    pub fn has(key: &str) -> bool {
        const OTHER_VIEW_KEYS: [&str; 4] = ["speed", "exact", "measured", "fill"];
        !OTHER_VIEW_KEYS.contains(&key) && is_key(key)
    }

    /// Returns the settings changed by `patch`, a table with keys of `[view]`.
    ///
    /// # Errors
    /// Returns an error if a value of `patch` is not valid.
    pub fn patched(&self, patch: &Table) -> Result<Self, String> {
        let mut all = Table::try_from(self).map_err(|error| error.to_string())?;
        all.extend(patch.clone());
        if patch.contains_key("phase") && !patch.contains_key("sum_to") {
            all.remove("sum_to"); // another page adds up all rows of its table
        }
        if patch.contains_key("detail_of") && !patch.contains_key("detail_range") {
            all.remove("detail_range"); // it belongs to the previous column
        }
        all.try_into()
            .map_err(|error: toml::de::Error| error.message().to_owned())
    }
}

#[derive(Clone, Debug, PartialEq)]
pub struct View {
    pub look: ViewSettings,
    pub focus: Pane,
    /// True if the user moved the focus there or pressed a key of that pane. The footer then lists the keys of the
    /// pane.
    pub is_touched: bool,
    pub fullscreen: bool,
    pub marker: Marker,
    pub theme: Theme,
    /// The time window of the traces.
    pub window: TimeWindow,
    /// Maximum number of swings in the traces.
    pub swings: usize,
    /// Time at the left edge of the traces, s. With `None` they follow the run.
    pub since_s: Option<f64>,
    /// Magnification of the traces' values, about the value at the cursor, or else about the present value of the run.
    pub magnified: f64,
    /// The step at which the traces are read.
    pub cursor: Option<u64>,
    /// The step of a turning point of the tilt from which swings are counted.
    pub swing_mark: Option<u64>,
    /// The camera of the 3-D view.
    pub camera: Camera,
    /// The phase to which the step pane returns from its last page.
    pub page_before: StepPageChoice,
    pub pointed_at: Option<Pane>,
    /// The pane next to the text if there is room for only one: the last with the focus, or the first that was chosen.
    pub beside: Option<Pane>,
    /// The path from above or the 3-D view: the last with the focus. It is shown if there is room for only one.
    pub path_view: Pane,
    /// The text next to the panes.
    pub sheet: Option<Arc<Sheet>>,
    /// The first visible row of the text; `None` for the row that brings its important paragraph into view.
    pub sheet_scrolled: Option<usize>,
    /// True if measured data are shown with the run. A line then describes them.
    pub measured: bool,
    pub fps: u32,
    /// True if the lab receives the mouse. Otherwise the terminal uses it to select text.
    pub mouse: bool,
    /// The panes that fit side by side on the present screen, from left to right, in the order of the focus. They
    /// include all panes until the size of the screen is known.
    pub side_by_side: Vec<Pane>,
}

impl View {
    /// Creates the view of a new lab: the first pane has the focus, and the traces show the run of `scenario`.
    pub fn new(scenario: &Scenario, marker: Marker, theme: Theme) -> Self {
        let mut view = Self {
            look: ViewSettings::default(),
            focus: Pane::ALL[0],
            is_touched: false,
            fullscreen: false,
            marker,
            theme,
            window: TimeWindow::default(),
            swings: USUAL_SWINGS,
            since_s: None,
            magnified: 1.0,
            cursor: None,
            swing_mark: None,
            camera: Camera::default(),
            page_before: StepPageChoice::default(),
            pointed_at: None,
            beside: None,
            path_view: Pane::Above,
            sheet: None,
            sheet_scrolled: None,
            measured: false,
            fps: FPS,
            mouse: true,
            side_by_side: Pane::ALL.to_vec(),
        };
        view.fit(scenario);
        view
    }

    /// Shows `sheet` next to the panes, or removes the sheet. Returns true if that is a change.
    ///
    /// The sheet stays scrolled if title and page are the same.
    pub(super) fn set_sheet(&mut self, sheet: Option<Sheet>) -> bool {
        if self.sheet.as_deref() == sheet.as_ref() {
            return false;
        }
        let before = self.sheet.take();
        let is_same = before.zip(sheet.as_ref()).is_some_and(|(before, sheet)| {
            before.title == sheet.title && before.place == sheet.place && before.seen == sheet.seen
        });
        if !is_same {
            self.sheet_scrolled = None;
        }
        self.sheet = sheet.map(Arc::new);
        self.keep_focus();
        true
    }

    /// Scrolls the sheet by `rows`. It has `all` rows, and `shown` of them are visible from the row `first` on.
    pub fn scroll_sheet(&mut self, rows: isize, first: usize, shown: usize, all: usize) {
        let last = all.saturating_sub(shown);
        let to = first.saturating_add_signed(rows).min(last);
        self.sheet_scrolled = Some(to);
    }

    /// Returns true if the sheet has the focus and digits select or begin an answer in it.
    pub fn sheet_takes_digits(&self) -> bool {
        let takes = self.sheet.as_ref().is_some_and(|sheet| sheet.takes_digits);
        takes && self.focus == Pane::Lesson
    }

    pub fn turn_to_sheet(&mut self) {
        if self.sheet.is_some() {
            self.fullscreen &= self.focus == Pane::Lesson;
            self.focus = Pane::Lesson;
        }
    }

    /// Sets the panes that fit side by side on the screen, from left to right.
    pub fn set_side_by_side(&mut self, panes: Vec<Pane>) {
        self.side_by_side = panes;
        self.keep_focus();
    }

    /// Adapts the view to another scenario: the traces show its run, and the rest follows its `[view]`.
    pub fn fit(&mut self, scenario: &Scenario) {
        let mut patch = scenario.file.view.clone().unwrap_or_default();
        patch.retain(|key, _| !["look_at", "next"].contains(&key)); // read from the scenario, where they may be edited
        let usual = ViewSettings {
            // The user's choices of these suit any run.
            camera: self.look.camera,
            zoom: self.look.zoom,
            bare: self.look.bare,
            residuals: self.look.residuals,
            ..ViewSettings::default()
        };
        (self.since_s, self.magnified, self.cursor, self.swing_mark) = (None, 1.0, None, None);
        self.forget_camera();
        self.set_look(usual.patched(&patch).unwrap_or(usual));
        if !self.may_show(self.focus) {
            self.keep_focus_among(&self.to_show());
        }
        if let Some(fill) = patch.get("fill").and_then(Value::as_str) {
            self.fill(Pane::named(fill));
        }
    }

    /// Lets the camera turn to the axle again, unless its direction was chosen.
    pub(in crate::lab) fn forget_camera(&mut self) {
        if self.look.camera.is_none() {
            self.camera = Camera::default();
        }
    }

    /// Sets the display settings. A pane that is newly shown on request gets the focus.
    pub fn set_look(&mut self, look: ViewSettings) {
        let before = std::mem::replace(&mut self.look, look);
        if before.show != self.look.show {
            self.beside = self.look.show.first().copied();
            let mut shown = self.look.show.iter();
            let path_view = shown.find(|pane| [Pane::Above, Pane::ThreeD].contains(pane));
            self.path_view = path_view.copied().unwrap_or(Pane::Above);
            self.side_by_side = self.to_show(); // until the lab is fitted to the screen again
        }
        let mut shown = self.look.show.iter();
        let requested = shown.find(|pane| pane.is_on_request() && !before.show.contains(pane));
        if let Some(pane) = requested
            && !self.fullscreen
        {
            self.focus = *pane;
        }
        if before.phase != StepPageChoice::Why {
            self.page_before = before.phase;
        }
        self.camera = self.look.camera.unwrap_or(self.camera);
        // The default camera does not count as a choice.
        self.look
            .camera
            .take_if(|camera| *camera == Camera::default());
    }

    /// Returns true if `part` is hidden. Parts that reveal the answer to an open question are hidden too.
    pub fn hides(&self, part: HideablePart) -> bool {
        self.look.hide.contains(&part) || part.is_answer() && self.hides_answers()
    }

    /// Returns the kind of answer for which the page next to the run waits.
    pub fn asked(&self) -> Option<AskedAnswer> {
        self.sheet.as_ref()?.asked
    }

    /// Returns true if the page next to the run hides the parts that reveal its answer.
    pub fn hides_answers(&self) -> bool {
        let page = self.sheet.as_ref();
        page.is_some_and(|page| page.asked.is_some() || page.is_round_open)
    }

    pub fn may_show(&self, pane: Pane) -> bool {
        let is_beside_page = self.sheet.is_some() && self.is_beside_page(pane);
        (self.names(pane) || is_beside_page) && !self.hides(HideablePart::Pane(pane))
    }

    /// Returns true if `pane` was chosen, or is shown by default if none were chosen.
    fn names(&self, pane: Pane) -> bool {
        match (self.look.show.is_empty(), self.look.bare) {
            _ if pane == Pane::Lesson => self.sheet.is_some(),
            (true, true) => BARE.contains(&pane),
            (true, false) => !pane.is_on_request(),
            (false, _) => self.look.show.contains(&pane),
        }
    }

    /// Returns true if `pane` is shown next to a page that does not name it. The run is always shown there, and so is
    /// the pane that the user moved to.
    fn is_beside_page(&self, pane: Pane) -> bool {
        match pane {
            Pane::Lesson | Pane::Step => false,
            Pane::Parameters => self.focus == pane,
            Pane::Traces | Pane::Above | Pane::ThreeD => {
                let is_about_step = self.look.show.contains(&Pane::Step);
                self.focus == pane || !self.look.bare && !is_about_step
            }
        }
    }

    /// Returns true if `pane` is on the screen, provided that there is room for it.
    pub fn shows(&self, pane: Pane) -> bool {
        self.is_filled_by(pane) || (!self.fullscreen && self.may_show(pane))
    }

    pub fn to_show(&self) -> Vec<Pane> {
        Pane::ALL
            .into_iter()
            .filter(|pane| self.may_show(*pane))
            .collect()
    }
}
