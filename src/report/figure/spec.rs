//! What a figure shows, in words of its options.

use super::labels::FigureLabels;
use super::page::PageStyle;
use serde::{Deserialize, Serialize};
use std::ops::RangeInclusive;

/// The narrowest and the widest page, mm.
pub const WIDTHS_MM: RangeInclusive<f64> = 30.0..=1000.0;

/// What a figure shows of its runs; of a table kind, width and labels. The file of a figure holds it, `gyrolab figure` and
/// the lab's command `figure` make one.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct FigureSpec {
    /// The name of a [`FigureKind`](super::kind::FigureKind), or the columns of a table; what is usual where there is none.
    pub kind: Option<String>,
    /// The columns of a table that are drawn, where `kind` does not name them.
    pub y: Vec<String>,
    /// The column of a table along the axis below.
    pub x: Option<String>,
    /// From where to where that axis goes.
    pub x_range: Option<(f64, f64)>,
    pub from_s: f64,
    /// Until when, s; `None`: to the end of the longest run.
    pub to_s: Option<f64>,
    /// Whether the exact motion is drawn beside the runs.
    pub exact: bool,
    /// What was measured later is not shown, s.
    pub measured_until_s: Option<f64>,
    /// The width of a column where there is none.
    pub width_pt: Option<f64>,
    /// The height that the figure needs if there is none.
    pub height_pt: Option<f64>,
    /// The size of the letters of axis titles, pt; other letters change with it.
    pub font_pt: Option<f64>,
    pub style: PageStyle,
    /// Whether numbers have a decimal comma.
    pub decimal_comma: bool,
    /// Whether an SVG has its text as text.
    pub text: bool,
    pub labels: FigureLabels,
}

impl FigureSpec {
    /// Whether all of its numbers can be those of a figure: no command line gives others.
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
