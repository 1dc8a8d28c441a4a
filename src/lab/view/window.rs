//! The time window of the traces.

use crate::engine::recording::{Extent, RecordedCurve};

/// The time window shared by all strips. In the views from above and in 3-D, the path within the window is bright.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TimeWindow {
    pub begin_s: f64,
    pub end_s: f64,
    /// Period of the swings for which the window was chosen, s; `None` if nothing swings.
    pub swing_s: Option<f64>,
    /// True if the run is longer than the window, so that an overview of the whole run is shown below the panes.
    pub has_overview: bool,
    /// True if the window stays fixed and changes only once a second, because it passes too fast to be followed.
    pub is_held: bool,
    /// Value range of each strip, in the order of [`RecordedCurve::ALL`]: m; degrees for the tilt.
    pub ranges: [Extent; 4],
    /// The time span of the overview, s. `overview` is its range of z, m.
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
