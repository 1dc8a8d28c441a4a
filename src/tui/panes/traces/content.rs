//! The contents of the strips, and the range of values of each.

use super::Traces;
use crate::engine::data::compared::ComparedPoint;
use crate::engine::recording::{Extent, RecordedCurve};
use crate::lab::comparison::DataComparison;
use crate::lab::playback::scale::StripScale;
use crate::lab::view::FourthStrip;

/// Minimum rows of a strip, including its rule.
const LEAST_ROWS: u16 = 4;
/// Minimum rows for x and y next to a lesson's page.
const ROWS_BESIDE_PAGE: u16 = 16;
/// Minimum rows per strip for a fourth strip that was not chosen.
const ROWS_OF_FOURTH: u16 = 9;
/// Minimum range of measured quantities, as a fraction of their size.
const SHARE_LEAST: f64 = 1e-3;
/// Minimum range of the distance from the exact motion, as a fraction of the distance between pivot and traced point.
const DISTANCE_LEAST: f64 = 1e-9;
/// Minimum range of residuals before any point has been compared.
const RESIDUAL_LEAST: f64 = 1e-9;

/// Quantity shown by a strip.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum StripContent {
    Curve(RecordedCurve),
    /// The measured quantity with this index, if it is not one of those curves.
    Measured(usize),
    /// Distance from the exact motion.
    Distance,
    /// The CSV column that is recorded with the run.
    Column,
}

impl Traces<'_> {
    /// Returns the strips that fit into `height` rows, from the top, each with a flag for residuals.
    ///
    /// If there are measured quantities, only these are shown.
    pub(super) fn contents(&self, height: u16) -> Vec<(StripContent, bool)> {
        let measured = self.measured_contents();
        let mut contents: Vec<_> = if measured.is_empty() {
            self.curves(height)
                .into_iter()
                .map(|content| (content, false))
                .collect()
        } else {
            let is_residual = self.0.view.look.residuals;
            measured
                .into_iter()
                .map(|content| (content, is_residual))
                .collect()
        };
        contents.truncate((height / LEAST_ROWS).max(1).into());
        contents
    }

    /// Returns x, y and z, and a fourth strip if there is room.
    ///
    /// Without room, a chosen fourth strip replaces y. On few rows, only z and a chosen strip are shown.
    fn curves(&self, height: u16) -> Vec<StripContent> {
        let [x, y, z, tilt] = RecordedCurve::ALL.map(StripContent::Curve);
        let (fourth, is_chosen) = match self.0.view.look.detail_of {
            FourthStrip::None => (None, false),
            FourthStrip::Auto if self.0.overlay().is_some() => {
                (Some(StripContent::Distance), false)
            }
            FourthStrip::Auto => (Some(tilt), false),
            FourthStrip::Distance if self.0.overlay().is_some() => {
                (Some(StripContent::Distance), true)
            }
            FourthStrip::Distance => (None, false),
            FourthStrip::Tilt => (Some(tilt), true),
            FourthStrip::Column(_) => (Some(StripContent::Column), true),
            FourthStrip::X | FourthStrip::Y | FourthStrip::Z => (None, false),
        };
        let fewest = match self.0.view.sheet {
            Some(_) => ROWS_BESIDE_PAGE,
            None => 3 * LEAST_ROWS,
        };
        match fourth {
            Some(fourth) if is_chosen && height < fewest => vec![fourth, z],
            _ if height < fewest => vec![z],
            Some(fourth) if height >= 4 * ROWS_OF_FOURTH => vec![x, y, z, fourth],
            Some(fourth) if is_chosen && height >= 4 * LEAST_ROWS => vec![x, y, z, fourth],
            Some(fourth) if is_chosen => vec![x, z, fourth],
            _ => vec![x, y, z],
        }
    }

    /// Returns the measured quantities, beginning with the curves that every run has.
    fn measured_contents(&self) -> Vec<StripContent> {
        let Some(measured) = self.0.measured else {
            return Vec::new();
        };
        let others = (0..measured.quantities().count())
            .filter(|index| measured.recorded(*index).is_some())
            .map(StripContent::Measured);
        let curves = RecordedCurve::ALL.map(StripContent::Curve);
        let own = curves
            .into_iter()
            .filter(|content| self.index(*content).is_some());
        own.chain(others).collect()
    }

    /// Returns the index of `content` among the measured quantities.
    fn index(&self, content: StripContent) -> Option<usize> {
        match content {
            StripContent::Measured(index) => Some(index),
            StripContent::Distance | StripContent::Column => None,
            StripContent::Curve(curve) => {
                let mut quantities = self.0.measured?.quantities();
                quantities.position(|quantity| quantity.name == curve.column())
            }
        }
    }

    /// Returns the measured values of `content`, or `None` if it was not measured.
    pub(super) fn points(&self, content: StripContent) -> Option<&[ComparedPoint]> {
        let index = self.index(content)?;
        let curves = &self.0.measured?.compared.curves;
        curves.get(index).map(Vec::as_slice)
    }

    /// Returns the name of `content` and its unit.
    pub(super) fn named(&self, content: StripContent) -> (String, &'static str) {
        match content {
            StripContent::Curve(RecordedCurve::Tilt) => ("tilt".to_owned(), "°"),
            StripContent::Curve(curve) => (curve.name().to_owned(), curve.unit()),
            StripContent::Distance => ("off exact".to_owned(), "m"),
            StripContent::Column => self.0.column.map_or_else(Default::default, |column| {
                (column.quantity.words(), column.quantity.unit())
            }),
            StripContent::Measured(index) => {
                let quantities = self.0.measured.map(DataComparison::quantities);
                let quantity = quantities.and_then(|mut quantities| quantities.nth(index));
                quantity.map_or_else(Default::default, |quantity| {
                    (quantity.words(), quantity.unit())
                })
            }
        }
    }

    /// Returns the range of values of a strip, magnified about the value at the cursor or else about the run's current
    /// value.
    pub(super) fn scale(&self, content: StripContent, is_residual: bool) -> StripScale {
        let magnified = self.0.view.magnified;
        let (whole, about) = if is_residual {
            (residual_scale(self.points(content)), 0.0)
        } else {
            (self.whole_scale(content), self.value_now(content))
        };
        if magnified > 1.0 {
            whole.zoomed(magnified, about)
        } else {
            whole
        }
    }

    fn whole_scale(&self, content: StripContent) -> StripScale {
        let window = &self.0.view.window;
        let look = &self.0.view.look;
        let fixed = match content {
            StripContent::Curve(RecordedCurve::Z) => look.z_range_m,
            StripContent::Curve(RecordedCurve::Tilt)
            | StripContent::Distance
            | StripContent::Column => look.detail_range,
            StripContent::Curve(_) | StripContent::Measured(_) => None,
        };
        if let Some([low, high]) = fixed {
            return StripScale { low, high };
        }
        let shown = self.points(content).unwrap_or_default().iter();
        let points = shown
            .filter(|point| window.contains(point.time_s))
            .map(|point| {
                let sigma = point.sigma.unwrap_or(0.0);
                Extent {
                    min: point.value - sigma,
                    max: point.value + sigma,
                }
            })
            .reduce(Extent::and);
        let curve = match content {
            StripContent::Curve(curve) => Some(window.range(curve)),
            StripContent::Measured(_) | StripContent::Distance | StripContent::Column => {
                self.recorded_extent(content)
            }
        };
        let all = [curve, points].into_iter().flatten().reduce(Extent::and);
        let extent = all.unwrap_or(Extent::single(0.0));
        let size = extent.max.abs().max(extent.min.abs());
        let least = match content {
            StripContent::Curve(_) => 0.0,
            StripContent::Measured(_) | StripContent::Column => {
                f64::max(SHARE_LEAST * size, f64::MIN_POSITIVE)
            }
            StripContent::Distance => DISTANCE_LEAST * self.0.run.scenario().arm_m(),
        };
        let scale = StripScale::of(extent, least);
        if content == StripContent::Distance && scale.low < 0.0 {
            return StripScale {
                low: 0.0,
                high: scale.high - scale.low,
            };
        }
        scale
    }

    fn value_now(&self, content: StripContent) -> f64 {
        let now = self.0.run.now();
        match (self.0.cursor, content) {
            (Some(cursor), StripContent::Curve(curve)) => curve.at(cursor),
            (None, StripContent::Curve(curve)) => now.value(curve),
            (_, StripContent::Measured(_) | StripContent::Distance | StripContent::Column) => {
                self.value_at(content, now.time_s).unwrap_or(0.0)
            }
        }
    }
}

/// Returns the scale of the residuals of `points`, including their uncertainties.
fn residual_scale(points: Option<&[ComparedPoint]>) -> StripScale {
    let residuals = points.unwrap_or_default().iter().filter_map(|point| {
        let residual = point.residual()?;
        Some(residual.abs() + point.sigma.unwrap_or(0.0))
    });
    StripScale::about_zero(residuals.fold(RESIDUAL_LEAST, f64::max))
}
