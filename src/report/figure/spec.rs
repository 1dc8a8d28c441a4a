//! The request for a figure, as given by its options.

use super::labels::FigureLabels;
use super::page::PageStyle;
use serde::{Deserialize, Serialize};
use std::ops::RangeInclusive;

/// The range of page widths, mm.
pub const WIDTHS_MM: RangeInclusive<f64> = 30.0..=1000.0;

/// The request for a figure: what to show of runs, or the kind, width and labels of a table's figure. It is embedded in
/// the figure's file. `gyrolab figure` and the lab's command `figure` create it.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct FigureSpec {
    /// The name of a [`FigureKind`](super::kind::FigureKind), or the columns of a table; `None` for the default.
    pub kind: Option<String>,
    /// The columns of a table to draw, if `kind` does not name them.
    pub y: Vec<String>,
    /// The column of a table on the horizontal axis.
    pub x: Option<String>,
    /// The range of the horizontal axis.
    pub x_range: Option<(f64, f64)>,
    pub from_s: f64,
    /// End of the time range, s; `None` for the end of the longest run.
    pub to_s: Option<f64>,
    /// True to draw the exact motion with the runs.
    pub exact: bool,
    /// Measured data after this time are not shown, s.
    pub measured_until_s: Option<f64>,
    /// Width of the page, pt; `None` for the width of a column.
    pub width_pt: Option<f64>,
    /// Height of the page, pt; `None` for the height that the figure needs.
    pub height_pt: Option<f64>,
    /// Font size of axis titles, pt. Other letters are scaled accordingly.
    pub font_pt: Option<f64>,
    pub style: PageStyle,
    /// True to write numbers with a decimal comma.
    pub decimal_comma: bool,
    /// True to write the text of an SVG as text.
    pub text: bool,
    pub labels: FigureLabels,
}

impl FigureSpec {
    /// Returns true if all numbers are valid. Command lines allow no other numbers.
    pub(super) fn is_sound(&self) -> bool {
        let times_s = [Some(self.from_s), self.to_s, self.measured_until_s];
        times_s
            .into_iter()
            .flatten()
            .all(|time_s| time_s >= 0.0 && time_s.is_finite())
            && self.has_page()
            && self.labels.y_range.is_none_or(is_range)
            && self.labels.y_ranges.values().copied().all(is_range)
            && self.x_range.is_none_or(is_range)
    }
}

fn is_range((low, high): (f64, f64)) -> bool {
    low < high && (high - low).is_finite()
}
