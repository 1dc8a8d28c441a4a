//! An axis on the page: the positions of values, and the ticks that have room.

use super::ChartAxis;
use super::ticks::{Tick, Ticks};
use crate::plot::ink::{self, LABEL_PT};

/// Minimum distance between two labels side by side, and between two labels on top of each other, pt.
pub const BESIDE: f64 = 6.0;
const AXIS_HEADROOM: f64 = 7.5;

#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AxisScale {
    pub range: (f64, f64),
    pub is_log: bool,
    pub places: (f64, f64),
}

impl AxisScale {
    pub fn new(axis: &ChartAxis, range: (f64, f64), places: (f64, f64)) -> Self {
        Self {
            range,
            is_log: axis.is_log,
            places,
        }
    }

    /// Returns the position of `value`, pt. It is far outside or not finite if the value cannot be shown.
    pub fn place(&self, value: f64) -> f64 {
        let (low, high) = self.range;
        let share = if self.is_log {
            libm::log(value / low) / libm::log(high / low)
        } else {
            (value - low) / (high - low)
        };
        self.places.0 + share * (self.places.1 - self.places.0)
    }

    fn length(&self) -> f64 {
        (self.places.1 - self.places.0).abs()
    }

    fn shows(&self, value: f64) -> bool {
        let (low, high) = self.places;
        let place = self.place(value);
        place >= low.min(high) - 0.01 && place <= low.max(high) + 0.01
    }

    /// Returns the ticks of an axis below the picture, whose labels are side by side.
    pub fn ticks_below(&self, axis: &ChartAxis) -> Ticks {
        self.ticks(axis, |ticks| {
            ticks.array_windows().all(|[a, b]| {
                let apart = (self.place(b.at) - self.place(a.at)).abs();
                a.half_width() + b.half_width() + BESIDE <= apart
            })
        })
    }

    /// Returns the ticks of an axis on the left, whose labels are on top of each other.
    pub fn ticks_beside(&self, axis: &ChartAxis) -> Ticks {
        let apart = ink::height(LABEL_PT) + AXIS_HEADROOM;
        self.ticks(axis, |ticks| {
            ticks
                .windows(2)
                .all(|pair| (self.place(pair[1].at) - self.place(pair[0].at)).abs() >= apart)
        })
    }

    fn ticks(&self, axis: &ChartAxis, fits: impl Fn(&[Tick]) -> bool) -> Ticks {
        let (low, high) = self.range;
        let mut ticks = if axis.is_log {
            Ticks::log(low, high, fits)
        } else {
            Ticks::linear(low, high, fits)
        };
        ticks.major.retain(|tick| self.shows(tick.at));
        ticks.minor.retain(|at| self.shows(*at));
        // Minor ticks that almost touch are not helpful.
        if ticks.minor.len() as f64 * 1.6 > self.length() {
            ticks.minor.clear();
        }
        ticks
    }
}

pub fn widest(ticks: &Ticks) -> f64 {
    let widths = ticks
        .major
        .iter()
        .map(|tick| ink::width(&tick.label, LABEL_PT));
    widths.fold(0.0, f64::max)
}
