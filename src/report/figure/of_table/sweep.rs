//! Readouts over what was varied: points that were measured, and the theory of them.

mod columns;
mod curves;

use super::{numbers, points, within_room};
use crate::plot::chart::legend::longest_name;
use crate::plot::chart::{ChartAxis, ChartSeries, Panel, SeriesStyle};
use crate::plot::extent;
use crate::report::figure::quantity;
use crate::report::figure::setting::{self, CurveSetting};
use crate::studies::table::{SweepTable, TableSource};
use columns::{QuantityColumn, QuantityColumns, QuantityOwner};
use curves::SweepCurve;

/// Panels on a page where none was asked for by name.
const MOST_PANELS: usize = 7;
/// The most series of one quantity that can be distinguished.
const MOST_SWEEP_SERIES: usize = 12;

/// The axis of what was varied, and a panel for each quantity.
pub(super) fn drawn(
    table: &TableSource,
    swept: &SweepTable,
    columns: &[&str],
    width_pt: f64,
) -> Result<(ChartAxis, Vec<Panel>), String> {
    let varied = &swept.varied[..];
    // The key that runs fastest and is a number goes to the right; the others make curves.
    let along = varied.iter().rev().find_map(|key| {
        let values = table.numbers(key)?;
        Some((key, values))
    });
    let (key, along) = along
        .ok_or_else(|| format!("none of the varied keys is a number: {}", varied.join(", ")))?;
    let curves = curves::curves(table, swept, key);
    if curves.len() > MOST_SWEEP_SERIES {
        return Err(too_many_curves(curves.len(), varied, key));
    }
    let quantities = columns::quantities(table, varied, columns);
    if columns.is_empty() && quantities.len() > MOST_PANELS {
        return Err(too_many(&quantities));
    }
    let roles: Vec<QuantityOwner> = quantities.iter().flatten().map(|part| part.role).collect();
    let has_measured = roles.contains(&QuantityOwner::Measured);
    let drawing = SweepFigure {
        table,
        along: &along,
        curves: &curves,
        room_pt: longest_name(width_pt),
        width_pt,
        has_theory: roles.contains(&QuantityOwner::Theory),
        has_measured,
        has_points: has_measured || roles.contains(&QuantityOwner::Value),
        has_gaps: has_gaps(table, columns, varied),
    };
    let mut panels = quantities
        .iter()
        .map(|quantity| drawing.panel(quantity))
        .collect::<Result<Vec<_>, _>>()?;
    let Some(first) = panels.first_mut() else {
        return Err("no column of this sweep is a number that can be drawn".to_owned());
    };
    first.series.extend(drawing.failed(&quantities)?);
    let x = ChartAxis {
        is_log: spans_decades(along.iter().copied(), 30.0) && is_geometric(&along),
        ..quantity::axis_in(&swept.scenario, key)
    };
    Ok((x, panels))
}

fn too_many_curves(count: usize, varied: &[String], along: &str) -> String {
    let others: Vec<_> = varied.iter().filter(|key| *key != along).cloned().collect();
    format!(
        "{count} curves would stand beside each other, and {MOST_SWEEP_SERIES} can be told apart: vary {} at fewer values, or name the key with the most values last, which makes it the horizontal axis",
        others.join(", ")
    )
}

fn too_many(quantities: &[QuantityColumns]) -> String {
    let names: Vec<_> = quantities
        .iter()
        .flatten()
        .map(|part| part.name.as_str())
        .collect();
    format!(
        "{} quantities do not fit on a page: choose some with --kind, such as --kind {}; there are {}",
        quantities.len(),
        columns::example(quantities),
        names.join(", ")
    )
}

/// Ratio of greatest to least value from which an axis is logarithmic.
const DECADES: f64 = 1e3;

/// What follows the name of theory of which some line has gaps.
const IN_GAPS: &str = " (gaps: no prediction)";
/// What the legend calls values of the run that were not read off its steps, beside those that were.
const SIMULATED_LABEL: &str = "simulated, without error";

/// The rows of `table` whose runs did not fail.
fn rows_run(table: &TableSource, varied: &[String]) -> Vec<usize> {
    let readouts: Vec<_> = table
        .names()
        .iter()
        .filter(|name| !varied.contains(name))
        .filter_map(|name| table.texts(name))
        .collect();
    (0..table.count())
        .filter(|row| readouts.iter().any(|texts| !texts[*row].is_empty()))
        .collect()
}

/// Whether a line of theory lacks a value where the run gave numbers.
fn has_gaps(table: &TableSource, columns: &[&str], varied: &[String]) -> bool {
    let rows = rows_run(table, varied);
    let mut lines = columns::theory(table, columns).filter_map(|name| table.numbers(name));
    lines.any(|values| {
        let missing = rows.iter().filter(|row| values[**row].is_nan()).count();
        (1..rows.len()).contains(&missing)
    })
}

/// What is drawn, and over what.
struct SweepFigure<'a> {
    table: &'a TableSource,
    along: &'a [f64],
    curves: &'a [SweepCurve],
    /// The longest name in the legend, pt.
    room_pt: f64,
    width_pt: f64,
    has_theory: bool,
    has_measured: bool,
    /// Whether there are points beside theory.
    has_points: bool,
    /// Whether a line of theory has gaps.
    has_gaps: bool,
}

impl SweepFigure<'_> {
    fn panel(&self, quantity: &QuantityColumns) -> Result<Panel, String> {
        let mut series = Vec::new();
        for (place, part) in quantity.iter().enumerate() {
            let values = numbers(self.table, &part.name)?;
            if part.role == QuantityOwner::Theory {
                series.extend(self.theory(part, &values, place, quantity.len() == 1));
            } else {
                series.extend(self.points(part, &values)?);
            }
        }
        let values = series.iter().flat_map(|series| &series.points);
        let y = ChartAxis {
            is_log: spans_decades(values.map(|point| point[1]), DECADES),
            ..columns::axis(quantity)
        };
        Ok(Panel::new(y, series))
    }

    /// What a curve with these `settings` is called in the legend.
    fn name(&self, word: &str, settings: &[CurveSetting]) -> String {
        setting::name(word, settings, self.room_pt)
    }

    /// The points of `part`, which has these `values`, a series for each curve that has some.
    fn points(&self, part: &QuantityColumn, values: &[f64]) -> Result<Vec<ChartSeries>, String> {
        let errors = part
            .uncertainty
            .as_ref()
            .map(|name| numbers(self.table, name))
            .transpose()?;
        let is_other = part.role == QuantityOwner::Value && self.has_measured;
        let curves = self.curves.iter().map(|curve| {
            let (name, style) = match part.role {
                _ if is_other => (
                    self.name(SIMULATED_LABEL, &[]),
                    SeriesStyle::specks(curve.index),
                ),
                role => {
                    let word = self.has_theory.then(|| part.word(false));
                    let style = match role {
                        QuantityOwner::Measured => SeriesStyle::points(curve.index),
                        _ => SeriesStyle::marked_line(curve.index),
                    };
                    let name = self.name(&word.unwrap_or_default(), &curve.settings);
                    (name, style)
                }
            };
            let errors = errors.iter();
            let errors = errors.flat_map(|errors| points(&curve.rows, self.along, errors));
            ChartSeries {
                errors: [Vec::new(), errors.map(|[_, error]| error.abs()).collect()],
                ..ChartSeries::new(name, points(&curve.rows, self.along, values), style)
            }
        });
        Ok(curves
            .filter(|series| series.points.iter().any(|point| point[1].is_finite()))
            .collect())
    }

    /// The lines of the theory `part`, the one at `place` of its panel: one for all curves for which it says the same.
    fn theory(
        &self,
        part: &QuantityColumn,
        values: &[f64],
        place: usize,
        is_alone: bool,
    ) -> Vec<ChartSeries> {
        let each = self
            .curves
            .iter()
            .map(|curve| (curve, points(&curve.rows, self.along, values)));
        let gaps = if self.has_gaps { IN_GAPS } else { "" };
        let lines = curves::lines(each).into_iter().map(|line| {
            // The curves are told apart by the points: of theory it is said once how it is drawn.
            let name = if self.has_points {
                self.name(&(part.word(is_alone) + gaps), &[])
            } else {
                self.name("", &line.settings)
            };
            let style = line.style(place, self.width_pt);
            ChartSeries::new(name, line.points, style)
        });
        lines.collect()
    }

    /// What the legend says of each curve that has no point: the names of those curves whose runs all failed.
    fn failed(&self, quantities: &[QuantityColumns]) -> Result<Vec<ChartSeries>, String> {
        const FAILED: &str = "no run gave a number";
        let columns = quantities
            .iter()
            .flatten()
            .filter(|part| part.role != QuantityOwner::Theory)
            .map(|part| numbers(self.table, &part.name))
            .collect::<Result<Vec<_>, _>>()?;
        let without = self.curves.iter().filter(|curve| {
            let mut rows = curve.rows.iter();
            let has_point = rows.any(|&row| columns.iter().any(|column| column[row].is_finite()));
            !columns.is_empty() && !has_point
        });
        let failed = without.map(|curve| {
            let markup = format!("{}: {FAILED}", self.name("", &curve.settings));
            let plain = self.name(FAILED, &curve.settings);
            ChartSeries::named(within_room(markup, &plain, self.room_pt))
        });
        Ok(failed.collect())
    }
}

/// Whether no value is below 0, and the greatest is at least `times` the least above 0.
fn spans_decades(values: impl Iterator<Item = f64>, times: f64) -> bool {
    let ends = extent(values.filter(|value| value.is_finite() && *value != 0.0));
    ends.is_some_and(|(low, high)| low > 0.0 && high / low >= times)
}

/// Whether a good part of `values`, all above 0, lies far below their greatest: they go by factors and not by steps.
fn is_geometric(values: &[f64]) -> bool {
    let high = values.iter().copied().fold(0.0, f64::max);
    let low = values.iter().copied().fold(high, f64::min);
    let middle = (low * high).sqrt();
    let below = values.iter().filter(|value| **value < middle).count();
    3 * below >= values.len()
}
