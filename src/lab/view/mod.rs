//! How a run is shown: which panes, which of them has the focus, how much time the traces show, and which dots and
//! colors. `tui` draws accordingly. No number of a run depends on it.
//!
//! [`pane`] names the parts of the screen, `focus` moves between them; `commands` carries out the commands of the view;
//! [`theme`] has the choices of markers and colors, [`step`] the pages of the step pane.

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

/// The panes of a bare screen, where none are chosen.
const BARE: [Pane; 2] = [Pane::Traces, Pane::Above];
/// How many swings the traces show where they have room for them.
pub const USUAL_SWINGS: usize = 8;
/// Frames a second at most, where nothing is chosen.
pub const FPS: u32 = 15;

/// What is looked at: what `[view]` of a scenario, a session and commands say of the screen. serde reads and writes it
/// under the keys of `[view]`, and [`patched`](Self::patched) with some of them makes another one.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct ViewSettings {
    /// Length of time that the overview spans, s; `None`: the whole run.
    pub window_s: Option<f64>,
    /// Length of time that the traces show, s; `None`: a few swings, or the whole run.
    #[serde(deserialize_with = "where_known")]
    pub detail_s: Option<f64>,
    /// The strip below those of x, y and z.
    pub detail_of: FourthStrip,
    /// Least and greatest value that it shows, in its unit; `None`: those of the run.
    #[serde(deserialize_with = "where_known")]
    pub detail_range: Option<[f64; 2]>,
    /// Least and greatest z that the strip of z shows, m; `None`: those of the run.
    #[serde(deserialize_with = "where_known")]
    pub z_range_m: Option<[f64; 2]>,
    /// Where the 3-D view is looked at from, if that was chosen. Otherwise it is turned so that the axle is seen aslant.
    pub camera: Option<Camera>,
    /// How much larger than the whole the round pictures are shown.
    pub zoom: Zoom,
    /// The panes that share the screen; if empty, as many as there is room for.
    pub show: Vec<Pane>,
    pub hide: Vec<HideablePart>,
    /// The page that the step pane shows.
    pub phase: StepPageChoice,
    /// How many rows of a table the step pane adds up; `None`: all.
    #[serde(deserialize_with = "where_known")]
    pub sum_to: Option<usize>,
    /// The line about what there is to see, if a command has set it; otherwise the scenario's line is shown.
    pub look_at: Option<String>,
    /// The line about what to try after the run, if a command has set it; otherwise the scenario's or the preset's.
    pub next: Option<String>,
    /// Whether the screen is bare: few panes, and nothing around them but title and time.
    pub bare: bool,
    /// Whether what was measured is shown less what the run says.
    pub residuals: bool,
}

/// The strip of the traces below those of x, y and z.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum FourthStrip {
    /// The distance from the exact motion if that is shown, or else the tilt; on a large screen only.
    #[default]
    Auto,
    None,
    X,
    Y,
    Z,
    Tilt,
    /// From the exact motion.
    Distance,
    /// The column of the run's CSV with this name.
    Column(&'static str),
}

impl FourthStrip {
    /// Those that are no column of the CSV, and x, y, z and the tilt, with the names that files give them.
    const NAMED: [(Self, &str); 7] = [
        (Self::Auto, AUTO),
        (Self::None, "none"),
        (Self::X, "x"),
        (Self::Y, "y"),
        (Self::Z, "z"),
        (Self::Tilt, "tilt"),
        (Self::Distance, "distance"),
    ];

    /// Returns the name that files give it.
    pub fn name(self) -> &'static str {
        let mut named = Self::NAMED.iter();
        match self {
            Self::Column(name) => name,
            _ => named
                .find(|(own, _)| *own == self)
                .map_or(AUTO, |(_, name)| name),
        }
    }

    /// Returns the quantity of its column; `None` for what is recorded in any case.
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

/// What a value says, or `None` for a word such as "auto" or "all".
fn where_known<'de, T: DeserializeOwned, D: Deserializer<'de>>(
    deserializer: D,
) -> Result<Option<T>, D::Error> {
    Ok(Value::deserialize(deserializer)?.try_into().ok())
}

/// Whether `[view]` has the key or table `name`.
pub fn is_key(name: &str) -> bool {
    let path = format!("view.{name}");
    keys::find(&path).is_ok() || keys::SCENARIO.is_table(&path)
}

impl ViewSettings {
    /// Whether `key` of `[view]` is of a look. Speed, measured data, exact motion and the pane that fills the screen are
    /// not.
    pub fn has(key: &str) -> bool {
        const OTHER_VIEW_KEYS: [&str; 4] = ["speed", "exact", "measured", "fill"];
        !OTHER_VIEW_KEYS.contains(&key) && is_key(key)
    }

    /// The look with the values of `patch`, a table as `[view]` is one.
    pub fn patched(&self, patch: &Table) -> Result<Self, String> {
        let mut all = Table::try_from(self).map_err(|error| error.to_string())?;
        all.extend(patch.clone());
        if patch.contains_key("phase") && !patch.contains_key("sum_to") {
            all.remove("sum_to"); // all rows of the table on another page
        }
        if patch.contains_key("detail_of") && !patch.contains_key("detail_range") {
            all.remove("detail_range"); // it is of another column
        }
        all.try_into()
            .map_err(|error: toml::de::Error| error.message().to_owned())
    }
}

#[derive(Clone, Debug, PartialEq)]
pub struct View {
    pub look: ViewSettings,
    pub focus: Pane,
    /// Whether the user turned to it, or pressed a key of its own: the footer then names those.
    pub is_touched: bool,
    pub fullscreen: bool,
    pub marker: Marker,
    pub theme: Theme,
    /// The time that the traces show.
    pub window: TimeWindow,
    /// How many swings of the run the traces show, if it has more.
    pub swings: usize,
    /// Time at the left edge of the traces, s; `None`: they follow the run.
    pub since_s: Option<f64>,
    /// How many times the values of the traces are magnified: about the value at the cursor, or else about the run's
    /// present one.
    pub magnified: f64,
    /// The step at which the traces are read off.
    pub cursor: Option<u64>,
    /// The step of a turn of the tilt from which swings are counted.
    pub swing_mark: Option<u64>,
    /// Where the 3-D view is looked at from.
    pub camera: Camera,
    /// The phase to which the step pane returns from its last page.
    pub page_before: StepPageChoice,
    pub pointed_at: Option<Pane>,
    /// The pane beside the text where there is room for one: the last that had the focus, or the first that was chosen.
    pub beside: Option<Pane>,
    /// From above or 3-D: the one that had the focus last, which is shown where there is room for one.
    pub path_view: Pane,
    /// The text beside the panes.
    pub sheet: Option<Arc<Sheet>>,
    /// The first row of the text that is shown; `None`: the row that brings its important paragraph into view.
    pub sheet_scrolled: Option<usize>,
    /// Whether measured data stand beside the run: a line then tells of them.
    pub measured: bool,
    pub fps: u32,
    /// Whether the lab listens to the mouse; otherwise the terminal has it, to select text.
    pub mouse: bool,
    /// The panes that stand side by side on the screen, as it is now, while none fills it: from left to right, in the
    /// order in which the focus goes through them. Until the screen is known, all panes.
    pub side_by_side: Vec<Pane>,
}

impl View {
    /// The view with which a lab starts: the first pane has the focus, and the traces show the run of `scenario`.
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

    /// Shows `sheet` beside the panes, or none. It stays scrolled as it is where title and page are the same. Returns whether
    /// it is another one.
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

    /// Scrolls the sheet by `rows`; it is `shown` rows high of `all`, and begins at the row `first` now.
    pub fn scroll_sheet(&mut self, rows: isize, first: usize, shown: usize, all: usize) {
        let last = all.saturating_sub(shown);
        let to = first.saturating_add_signed(rows).min(last);
        self.sheet_scrolled = Some(to);
    }

    /// Whether a digit is for the sheet, which has the focus.
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

    /// The panes that stand side by side on the screen while none fills it, from left to right.
    pub fn set_side_by_side(&mut self, panes: Vec<Pane>) {
        self.side_by_side = panes;
        self.keep_focus();
    }

    /// Changes to another scenario: the traces show its run, and the rest is as its `[view]` says.
    pub fn fit(&mut self, scenario: &Scenario) {
        let mut patch = scenario.file.view.clone().unwrap_or_default();
        patch.retain(|key, _| !["look_at", "next"].contains(&key)); // the scenario's, which may be edited
        let usual = ViewSettings {
            // What of these was chosen suits any run.
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

    /// Lets the camera turn to the axle once more, unless its direction was chosen.
    pub(in crate::lab) fn forget_camera(&mut self) {
        if self.look.camera.is_none() {
            self.camera = Camera::default();
        }
    }

    /// Shows the run as `look` says. A pane that is shown on request has the focus when it comes.
    pub fn set_look(&mut self, look: ViewSettings) {
        let before = std::mem::replace(&mut self.look, look);
        if before.show != self.look.show {
            self.beside = self.look.show.first().copied();
            let mut shown = self.look.show.iter();
            let path_view = shown.find(|pane| [Pane::Above, Pane::ThreeD].contains(pane));
            self.path_view = path_view.copied().unwrap_or(Pane::Above);
            self.side_by_side = self.to_show(); // until the lab is fitted to its screen again
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
        // The usual place is no choice.
        self.look
            .camera
            .take_if(|camera| *camera == Camera::default());
    }

    /// Whether `part` is hidden: what answers an open question is, too.
    pub fn hides(&self, part: HideablePart) -> bool {
        self.look.hide.contains(&part) || part.is_answer() && self.hides_answers()
    }

    /// The answer that the page beside the run waits for.
    pub fn asked(&self) -> Option<AskedAnswer> {
        self.sheet.as_ref()?.asked
    }

    /// Whether the page beside the run hides what answers its question.
    pub fn hides_answers(&self) -> bool {
        let page = self.sheet.as_ref();
        page.is_some_and(|page| page.asked.is_some() || page.is_round_open)
    }

    pub fn may_show(&self, pane: Pane) -> bool {
        let is_beside_page = self.sheet.is_some() && self.is_beside_page(pane);
        (self.names(pane) || is_beside_page) && !self.hides(HideablePart::Pane(pane))
    }

    /// Whether `pane` is among those that were chosen, or are shown where none were.
    fn names(&self, pane: Pane) -> bool {
        match (self.look.show.is_empty(), self.look.bare) {
            _ if pane == Pane::Lesson => self.sheet.is_some(),
            (true, true) => BARE.contains(&pane),
            (true, false) => !pane.is_on_request(),
            (false, _) => self.look.show.contains(&pane),
        }
    }

    /// Whether `pane` stands beside a page that does not name it: the run is always to be seen there, and whatever the user
    /// has turned to.
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

    /// Whether `pane` is on the screen, if that has room for it.
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
