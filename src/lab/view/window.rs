//! The time that the traces show.

use crate::engine::recording::{Extent, RecordedCurve};

/// The window of the traces: all strips share it. From above and in 3-D, the path in the window is bright.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TimeWindow {
    pub begin_s: f64,
    pub end_s: f64,
    /// Period of the swings that the window was chosen by, s; `None` if nothing swings.
    pub swing_s: Option<f64>,
    /// Whether the run is longer than the window, so that an overview of the whole run is shown below the panes.
    pub has_overview: bool,
    /// Whether the window is replaced only once a second, because its time passes too fast to be followed.
    pub is_held: bool,
    /// The range of values that each strip shows, in the order of [`RecordedCurve::ALL`]: m, and degrees for the tilt.
    pub ranges: [Extent; 4],
    /// The time that the overview spans, s, and its range of z, m.
    pub span_begin_s: f64,
    pub span_end_s: f64,
    pub overview: Extent,
}

impl Default for TimeWindow {
    fn default() -> Self {
        Self {
            begin_s: 0.0,
            end_s: 1.0,
            swing_s: None,
            has_overview: false,
            is_held: false,
            ranges: [Extent::single(0.0); 4],
            span_begin_s: 0.0,
            span_end_s: 1.0,
            overview: Extent::single(0.0),
        }
    }
}

impl TimeWindow {
    pub fn length_s(&self) -> f64 {
        self.end_s - self.begin_s
    }

    pub fn contains(&self, time_s: f64) -> bool {
        (self.begin_s..=self.end_s).contains(&time_s)
    }

    pub fn range(&self, curve: RecordedCurve) -> Extent {
        self.ranges[curve as usize]
    }
}
