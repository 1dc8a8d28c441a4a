//! Labels and axes that replace the defaults of a figure.

use crate::engine::text::number::{shortest, significant};
use crate::plot::chart::{Chart, ChartAxis, Panel};
use crate::plot::extent;
use crate::plot::ink::{self, TITLE_PT, at};
use crate::plot::letters;
use crate::plot::scene::{PageScene, TextAnchor};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct FigureLabels {
    /// Title above the figure.
    pub title: Option<String>,
    /// Names of the runs in the legend, in order.
    pub names: Vec<String>,
    pub x: Option<String>,
    /// Titles of the y axes, from the top panel down.
    pub y: Vec<String>,
    /// True for each of the x and y axes that is logarithmic.
    pub is_log: [bool; 2],
    /// True if the colors of a map are logarithmic.
    #[serde(default)]
    pub is_log_color: bool,
    /// Range of the y axis of every panel that is not in `y_ranges`.
    pub y_range: Option<(f64, f64)>,
    /// Ranges of the y axes of panels, by column.
    #[serde(default)]
    pub y_ranges: BTreeMap<String, (f64, f64)>,
}

/// Maximum length of a y axis title, pt.
const LONGEST_PT: f64 = 130.0;
/// Maximum length of an x axis title, relative to the page's width.
const AXIS_TITLE_SHARE: f64 = 0.62;
/// Margin above and below the title of a figure, pt.
const AROUND_PT: f64 = 4.0;

impl FigureLabels {
    /// Checks that all labels apply to a path in space.
    ///
    /// # Errors
    /// Returns an error for axes that a path in space does not have.
    pub fn check_in_space(&self) -> Result<(), String> {
        let is_named = self.x.is_some() || !self.y.is_empty();
        if is_named || self.is_log != [false; 2] || self.has_y_range() {
            return Err(
                "--x-label, --y-label, --log and --y-range are not for a path in space".to_owned(),
            );
        }
        Ok(())
    }

    fn check(&self, chart: &Chart) -> Result<(), String> {
        let count = chart.panels.len();
        if self.y.len() > count {
            return Err(format!(
                "--y-label is given {} times, and this figure has {count} panels: give it once per panel",
                self.y.len()
            ));
        }
        if chart.is_true_to_scale && (self.is_log != [false; 2] || self.has_y_range()) {
            return Err(
                "--log and --y-range are not for a path from above: its axes have one scale"
                    .to_owned(),
            );
        }
        let columns: Vec<&str> = chart.panels.iter().map(|panel| &*panel.column).collect();
        let unknown = self
            .y_ranges
            .keys()
            .find(|name| !columns.contains(&&***name));
        if let Some(name) = unknown {
            return Err(format!(
                "--y-range {name}=...: this figure has no panel of that name, but {}",
                columns.join(", ")
            ));
        }
        Ok(())
    }

    fn has_y_range(&self) -> bool {
        self.y_range.is_some() || !self.y_ranges.is_empty()
    }

    /// Returns the requested range of the y axis of `panel`.
    fn range_of(&self, panel: &Panel) -> Option<(f64, f64)> {
        self.y_ranges.get(&panel.column).copied().or(self.y_range)
    }

    /// Checks that each panel of `chart` shows something in the requested range.
    ///
    /// # Errors
    /// Returns an error if a panel is empty.
    pub(super) fn check_ranges(&self, chart: &Chart) -> Result<(), String> {
        for panel in &chart.panels {
            let Some((low, high)) = self.range_of(panel) else {
                continue;
            };
            let points = panel.series.iter().flat_map(|series| &series.points);
            let shown = points.filter(|[x, _]| {
                let range = chart.x.range.unwrap_or((f64::NEG_INFINITY, f64::INFINITY));
                (range.0..=range.1).contains(x)
            });
            let values = shown.map(|[_, y]| *y).filter(|y| y.is_finite());
            let outside = extent(values).filter(|(least, most)| *most < low || *least > high);
            if let Some((least, most)) = outside {
                return Err(format!(
                    "--y-range {}..{} shows nothing: the values of {} are from {} to {}",
                    shortest(low),
                    shortest(high),
                    panel.column,
                    significant(least, 6),
                    significant(most, 6)
                ));
            }
        }
        Ok(())
    }

    /// Applies the labels and axes to `chart`. Returns a warning if a logarithmic axis hides values.
    ///
    /// # Errors
    /// Returns an error if the chart cannot have these axes.
    pub fn apply(&self, chart: &mut Chart) -> Result<Option<String>, String> {
        self.check(chart)?;
        if let Some(text) = &self.x {
            rename(&mut chart.x, text, AXIS_TITLE_SHARE * chart.width_pt);
        }
        chart.x.is_log |= self.is_log[0];
        chart.x.range = chart
            .x
            .range
            .filter(|range| !chart.x.is_log || range.0 > 0.0);
        for (panel, text) in chart.panels.iter_mut().zip(&self.y) {
            rename(&mut panel.y, text, LONGEST_PT);
        }
        for panel in &mut chart.panels {
            panel.y.is_log |= self.is_log[1];
            if let Some((low, high)) = self.range_of(panel) {
                if panel.y.is_log && low <= 0.0 {
                    return Err("--y-range of a logarithmic axis begins above 0".to_owned());
                }
                panel.y.range = Some((low, high));
            }
        }
        let mut points = chart
            .panels
            .iter()
            .flat_map(|panel| &panel.series)
            .flat_map(|series| &series.points);
        let hides = points.any(|point| {
            point
                .iter()
                .zip(&self.is_log)
                .any(|(value, is_log)| *is_log && *value <= 0.0)
        });
        let hidden = "values that are not above 0 have no place on a logarithmic axis";
        Ok(hides.then(|| hidden.to_owned()))
    }

    /// Writes the title above everything else on the page.
    pub fn write_title(&self, scene: &mut PageScene) {
        let Some(title) = &self.title else {
            return;
        };
        scene.title = letters::label(&letters::markup(title), TITLE_PT).words;
        let down = self.title_height_pt();
        scene.map(|p| at(p.x, p.y + down));
        scene.height_pt += down;
        let room = scene.width_pt - 2.0 * AROUND_PT;
        let markup = letters::marked(title, TITLE_PT, room);
        let place = at(0.5 * scene.width_pt, down - AROUND_PT);
        scene.write(&markup, TITLE_PT, place, TextAnchor::Middle);
    }

    /// Returns the height of the title, pt.
    pub(super) fn title_height_pt(&self) -> f64 {
        match self.title {
            Some(_) => ink::height(TITLE_PT) + 2.0 * AROUND_PT,
            None => 0.0,
        }
    }
}

/// Replaces name and unit of `axis` by `text`.
fn rename(axis: &mut ChartAxis, text: &str, room_pt: f64) {
    axis.name = letters::marked(text, TITLE_PT, room_pt);
    axis.unit.clear();
}
