//! Figures of sweeps: readouts over the varied keys, as measured points and theory.

mod columns;
mod curves;
pub(super) mod map;

use super::view::TableView;
use super::{RELIABLE, numbers, points, within_room};
use crate::engine::text::number::counted;
use crate::plot::chart::legend::longest_name;
use crate::plot::chart::{ChartAxis, ChartSeries, MOST_CURVES, Panel, SeriesStyle};
use crate::plot::extent;
use crate::plot::ink::paler;
use crate::report::figure::quantity;
use crate::report::figure::setting::{self, CurveSetting};
use crate::studies::table::{SweepTable, TableSource};
use columns::{QuantityColumn, QuantityColumns, QuantityOwner};
use curves::SweepCurve;

/// Maximum number of panels on a page, unless columns are requested by name.
const MOST_PANELS: usize = 7;

/// Returns the axis of the varied key or the requested column, and one panel per quantity.
pub(super) fn drawn(
    table: &TableSource,
    swept: &SweepTable,
    view: &TableView,
) -> Result<(ChartAxis, Vec<Panel>), String> {
    let columns: Vec<&str> = view.y.iter().map(String::as_str).collect();
    let along = Along::new(table, swept, view.x.as_deref())?;
    let curves = curves::curves(table, swept, &along.key);
    if curves.len() > MOST_CURVES {
        return Err(too_many_curves(table, swept, curves.len(), &along.key));
    }
    let quantities = columns::quantities(table, swept, &columns);
    if columns.is_empty() && quantities.len() > MOST_PANELS {
        return Err(too_many(&quantities));
    }
    let roles: Vec<QuantityOwner> = quantities.iter().flatten().map(|part| part.role).collect();
    let has_measured = roles.contains(&QuantityOwner::Measured);
    let drawing = SweepFigure {
        table,
        along: &along.x,
        has_lines: along.has_lines(&curves),
        curves: &curves,
        room_pt: longest_name(view.width_pt),
        width_pt: view.width_pt,
        has_theory: roles.contains(&QuantityOwner::Theory),
        has_measured,
        has_points: has_measured || roles.contains(&QuantityOwner::Value),
        rows_run: rows_run(table, swept),
    };
    let mut panels = quantities
        .iter()
        .map(|quantity| drawing.panel(quantity))
        .collect::<Result<Vec<_>, _>>()?;
    let Some(first) = panels.first_mut() else {
        return Err("no column of this sweep is a number that can be drawn".to_owned());
    };
    first.series.extend(drawing.failed(&quantities)?);
    Ok((along.axis(swept), panels))
}

/// The horizontal axis of a sweep's figure.
struct Along {
    /// The key that varies along a curve. `values` holds its values.
    key: String,
    values: Vec<f64>,
    /// The column on the horizontal axis: this key or a readout. `x` holds its values.
    column: String,
    x: Vec<f64>,
}

impl Along {
    /// Uses the key or readout named `asked`. By default, uses the fastest-varying key with numbers; the other keys
    /// distinguish the curves.
    fn new(table: &TableSource, swept: &SweepTable, asked: Option<&str>) -> Result<Self, String> {
        let column = asked.filter(|name| !swept.has_varied(name));
        let key = asked.filter(|name| swept.has_varied(name));
        let (key, values) = match key {
            Some(key) => (key, numbers(table, key)?),
            None => fastest(table, swept)?,
        };
        let x = match column {
            Some(column) => numbers(table, column)?,
            None => values.clone(),
        };
        Ok(Self {
            key: key.to_owned(),
            column: column.unwrap_or(key).to_owned(),
            values,
            x,
        })
    }

    /// Returns true if lines may join the points of `curves`: along each curve, the horizontal axis is monotonic in the
    /// key.
    fn has_lines(&self, curves: &[SweepCurve]) -> bool {
        self.column == self.key
            || curves.iter().all(|curve| {
                let mut rows = curve.rows.clone();
                rows.sort_by(|a, b| self.values[*a].total_cmp(&self.values[*b]));
                let x = rows.iter().map(|row| self.x[*row]);
                let x: Vec<f64> = x.filter(|x| x.is_finite()).collect();
                x.is_sorted() || x.iter().rev().is_sorted()
            })
    }

    fn axis(&self, swept: &SweepTable) -> ChartAxis {
        ChartAxis {
            is_log: spans_decades(self.x.iter().copied(), 30.0) && is_geometric(&self.x),
            ..quantity::axis_in(&swept.scenario, &self.column)
        }
    }
}

/// Returns the fastest-varying key whose values are numbers, and its values. Keys with a single value come last.
fn fastest<'a>(table: &TableSource, swept: &'a SweepTable) -> Result<(&'a str, Vec<f64>), String> {
    let fastest_first = swept.varied().rev();
    let numeric = fastest_first.filter_map(|key| Some((key.as_str(), table.numbers(key)?)));
    let keys: Vec<(&str, Vec<f64>)> = numeric.collect();
    let varies = |values: &[f64]| values.iter().any(|value| *value != values[0]);
    let fastest = keys.iter().find(|(_, values)| varies(values));
    fastest.or(keys.first()).cloned().ok_or_else(|| {
        let varied: Vec<_> = swept.varied().map(String::as_str).collect();
        format!("none of the varied keys is a number: {}", varied.join(", "))
    })
}

fn too_many_curves(table: &TableSource, swept: &SweepTable, count: usize, along: &str) -> String {
    let others: Vec<_> = swept
        .varied()
        .filter(|key| *key != along)
        .cloned()
        .collect();
    let longer = others.iter().find(|key| {
        let curves = table
            .numbers(key)
            .map(|_| curves::curves(table, swept, key).len());
        curves.is_some_and(|fewer| fewer <= MOST_CURVES)
    });
    let map = if swept.axes.len() == 2 {
        "--kind map draws both keys with colors for the values; "
    } else {
        ""
    };
    let turned = longer.map_or(String::new(), |key| {
        format!("--x {key} makes fewer curves; ")
    });
    format!(
        "{} are too many to be told apart, {MOST_CURVES} at most: {map}{turned}or vary {} over fewer values",
        counted(count as u64, "curve"),
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

/// Ratio of maximum to minimum above which an axis is logarithmic.
const DECADES: f64 = 1e3;

/// Fraction of white in the color of points below a line of theory.
const UNDER_THEORY_WHITE: f64 = 0.5;
/// Added to the name of a theory whose lines have gaps.
const IN_GAPS: &str = " (gaps: no prediction)";
/// Name in the legend of values of a run without a measurement error, if there are values with one.
const SIMULATED_LABEL: &str = "simulated, without error";

/// Returns the rows of `table` whose runs did not fail.
fn rows_run(table: &TableSource, swept: &SweepTable) -> Vec<usize> {
    let readouts: Vec<_> = table
        .names()
        .iter()
        .filter(|name| !swept.has_varied(name) && *name != RELIABLE)
        .filter_map(|name| table.texts(name))
        .collect();
    (0..table.count())
        .filter(|row| readouts.iter().any(|texts| !texts[*row].is_empty()))
        .collect()
}

/// The figure of a sweep that is being drawn.
struct SweepFigure<'a> {
    table: &'a TableSource,
    along: &'a [f64],
    /// True if lines may join its points.
    has_lines: bool,
    curves: &'a [SweepCurve],
    /// Maximum length of a name in the legend, pt.
    room_pt: f64,
    width_pt: f64,
    has_theory: bool,
    has_measured: bool,
    /// True if there are points in addition to theory.
    has_points: bool,
    /// The rows whose runs did not fail.
    rows_run: Vec<usize>,
}

impl SweepFigure<'_> {
    fn panel(&self, quantity: &QuantityColumns) -> Result<Panel, String> {
        let mut series: Vec<ChartSeries> = Vec::new();
        let is_theory = |part: &QuantityColumn| part.role == QuantityOwner::Theory;
        let has_both = quantity.iter().any(is_theory) && !quantity.iter().all(is_theory);
        for (place, part) in quantity.iter().enumerate() {
            let values = numbers(self.table, &part.name)?;
            let mut of_part = if is_theory(part) {
                self.theory(part, &values, place, quantity.len() == 1)
            } else {
                self.points(part, &values)?
            };
            for one in &mut of_part {
                // Theory is drawn on top of the points, because many points would hide its line.
                if has_both && !is_theory(part) {
                    one.style.is_behind = true;
                    one.style.color = paler(one.style.color, UNDER_THEORY_WHITE);
                }
                // A curve of the exact motion coincides with its theory.
                let is_on_theory = has_both && one.style.mark.is_some() && !is_theory(part);
                if is_on_theory || !self.has_lines {
                    one.style.width_pt = 0.0;
                }
            }
            series.extend(of_part);
        }
        let values = series.iter().flat_map(|series| &series.points);
        let y = ChartAxis {
            is_log: spans_decades(values.map(|point| point[1]), DECADES),
            ..columns::axis(quantity)
        };
        let column = quantity.first().map_or("", |part| &part.name);
        Ok(Panel::new(y, series).of_column(column))
    }

    /// Returns the name of a curve with these `settings` in the legend.
    fn name(&self, word: &str, settings: &[CurveSetting]) -> String {
        setting::name(word, settings, self.room_pt)
    }

    /// Returns the points of `part` with these `values`, one series per curve that has any.
    fn points(&self, part: &QuantityColumn, values: &[f64]) -> Result<Vec<ChartSeries>, String> {
        let errors = part
            .uncertainty
            .as_ref()
            .map(|name| numbers(self.table, name))
            .transpose()?;
        let is_other = part.role == QuantityOwner::Value && self.has_measured;
        let line_width_pt = if self.has_lines {
            self.width_pt
        } else {
            f64::INFINITY // no line looks smooth
        };
        let curves = self.curves.iter().map(|curve| {
            let (name, style) = match part.role {
                _ if is_other => (
                    self.name(SIMULATED_LABEL, &[]),
                    curve.style(SeriesStyle::specks(curve.index), line_width_pt),
                ),
                role => {
                    let word = self.has_theory.then(|| part.word(false));
                    let style = match role {
                        QuantityOwner::Measured => SeriesStyle::points(curve.index),
                        _ => SeriesStyle::marked_line(curve.index),
                    };
                    let name = self.name(&word.unwrap_or_default(), &curve.settings);
                    (name, curve.style(style, line_width_pt))
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

    /// Returns the lines of the theory `part`, at index `place` of its panel. Curves with the same theory share one
    /// line.
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
        let rows = self.rows_run.iter();
        let missing = rows.filter(|row| values[**row].is_nan()).count();
        let gaps = if (1..self.rows_run.len()).contains(&missing) {
            IN_GAPS
        } else {
            ""
        };
        let lines = curves::lines(each);
        let is_of_exact = lines.len() == 1 && part.is_of_exact_motion();
        let lines = lines.into_iter().map(|line| {
            // The points distinguish the curves, so the legend names each theory only once.
            let name = if self.has_points {
                self.name(&(part.word(is_alone) + gaps), &[])
            } else {
                self.name("", &line.settings)
            };
            let own = line.style(place, self.width_pt);
            let style = if is_of_exact { own.as_exact() } else { own };
            ChartSeries::new(name, line.points, style)
        });
        lines.collect()
    }

    /// Returns entries of the legend for curves without points, because all their runs failed.
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

/// Returns true if no value is below 0, and the maximum is at least `times` the minimum above 0.
fn spans_decades(values: impl Iterator<Item = f64>, times: f64) -> bool {
    let ends = extent(values.filter(|value| value.is_finite() && *value != 0.0));
    ends.is_some_and(|(low, high)| low > 0.0 && high / low >= times)
}

/// Returns true if at least a third of `values`, all above 0, lie below the geometric mean of their range: they vary by
/// factors, not by steps.
fn is_geometric(values: &[f64]) -> bool {
    let high = values.iter().copied().fold(0.0, f64::max);
    let low = values.iter().copied().fold(high, f64::min);
    let middle = (low * high).sqrt();
    let below = values.iter().filter(|value| **value < middle).count();
    3 * below >= values.len()
}
