//! The figure of a fit: measured values with the model, and residuals below.

use super::view::TableView;
use super::{RowIndices, grouped, numbers, points, within_room};
use crate::engine::data::quantity::TIME_COLUMN;
use crate::engine::data::{self, MeasuredCurve, MeasuredPoint, RunQuantity};
use crate::engine::scenario::Document;
use crate::engine::text::number::{significant, uncertain};
use crate::plot::chart::legend::longest_name;
use crate::plot::chart::ticks::{power_of_ten, with_minus};
use crate::plot::chart::{ChartAxis, ChartSeries, Panel, SeriesStyle};
use crate::plot::extent;
use crate::plot::letters;
use crate::report::figure::quantity;
use crate::studies::table::{FitTable, FittedKey, TableSource};
use std::sync::Arc;

/// Number of points on the model's curve over time: several per dot of a column's width.
const MODEL_CURVE_POINTS: u32 = 1500;
/// The column with the row numbers of the measured data.
const ROW_COLUMN: &str = "row";
/// Maximum number of groups of settings that can be distinguished.
const MOST_GROUPS: usize = 6;

/// The figure of a fit that is being drawn.
struct FitFigure<'a> {
    table: &'a TableSource,
    fit: &'a FitTable,
    /// The run file that the keys belong to.
    scenario: toml::Table,
    /// Maximum length of a name in the legend, pt.
    room_pt: f64,
    /// The column on the horizontal axis. `x` holds its values.
    along: &'a str,
    x: Vec<f64>,
}

/// Returns the axis of the time or of a setting, and two panels per quantity: its values and its residuals.
pub(super) fn drawn(
    table: &TableSource,
    fit: &FitTable,
    view: &TableView,
) -> Result<(ChartAxis, Vec<Panel>), String> {
    let (along, x) = match &view.x {
        Some(column) => (column.as_str(), numbers(table, column)?),
        None => along(table, &fit.settings)?,
    };
    let drawing = FitFigure {
        table,
        fit,
        scenario: fit.run_file.parse().unwrap_or_default(),
        room_pt: longest_name(view.width_pt),
        along,
        x,
    };
    let mut panels = Vec::new();
    for (name, rows) in grouped(&table.texts("quantity").unwrap_or_default()) {
        if view.y.is_empty() || view.y.contains(&name) {
            let groups = drawing.groups(rows);
            panels.push(drawing.values(&name, &groups)?);
            panels.push(drawing.residuals(&name, &groups)?);
        }
    }
    if panels.is_empty() {
        Err("none of these is a quantity that was fitted".to_owned())
    } else {
        Ok((quantity::axis(along), panels))
    }
}

impl FitFigure<'_> {
    /// Formats `key` with its `value`, such as "*z* of weight = 0.1555 m".
    fn said(&self, key: &str, value: &str) -> String {
        let axes = key
            .split('+')
            .map(|key| quantity::axis_in(&self.scenario, key));
        let (names, units): (Vec<_>, Vec<_>) = axes.map(|axis| (axis.name, axis.unit)).unzip();
        let unit = units.first().map_or("", String::as_str);
        let said = format!("{} = {value} {unit}", names.join(" = "));
        said.trim_end().to_owned()
    }

    /// Returns the legend's lines for the model: the value of each free key, and the scheme.
    fn model(&self) -> Vec<String> {
        let mut lines = Vec::new();
        for found in &self.fit.found {
            let model = if lines.is_empty() { "model: " } else { "" };
            let said = format!("{model}{}", self.said(&found.key, &stated(found)));
            let value = significant(found.value, FIT_VALUE_DIGITS);
            let plain = format!("{model}{} = {value}", found.key);
            lines.push(within_room(said, &plain, self.room_pt));
        }
        if lines.is_empty() {
            lines.push("model".to_owned());
        }
        let scheme = self.scenario.get("motion").and_then(|it| it.get("scheme"));
        if let Some(scheme) = scheme.and_then(toml::Value::as_str) {
            let said = format!("scheme: {}", letters::escape(scheme));
            lines.push(within_room(said, scheme, self.room_pt));
        }
        lines
    }
}

/// Digits of a value without an uncertainty.
const FIT_VALUE_DIGITS: usize = 6;

/// Formats the value with its uncertainty, as markup.
fn stated(found: &FittedKey) -> String {
    let stated = found
        .uncertainty
        .and_then(|sigma| uncertain(found.value, sigma));
    match stated {
        Some(stated) if stated.exponent == 0 => with_minus(&stated.digits),
        Some(stated) => {
            let power = power_of_ten(stated.exponent);
            format!("{} · {power}", with_minus(&stated.digits))
        }
        None => with_minus(&significant(found.value, FIT_VALUE_DIGITS)),
    }
}

/// Returns the column for the horizontal axis: the setting with the most different numbers, with these numbers. Returns
/// the row number if no setting is a number.
fn along<'a>(table: &TableSource, settings: &'a [String]) -> Result<(&'a str, Vec<f64>), String> {
    let settings = settings.iter().rev().filter_map(|name| {
        let numbers = table.numbers(name)?;
        let is_whole = numbers.iter().all(|number| number.is_finite());
        is_whole.then_some((name.as_str(), numbers))
    });
    // Of columns with equal counts, the first wins.
    let most = settings.max_by_key(|(_, numbers)| {
        let mut distinct = numbers.clone();
        distinct.sort_by(f64::total_cmp);
        distinct.dedup();
        distinct.len()
    });
    match most {
        Some(most) => Ok(most),
        None => Ok((ROW_COLUMN, numbers(table, ROW_COLUMN)?)),
    }
}

/// Computes the fitted run's curve of the quantity `name` over the time range of `x`.
fn curve(run_file: &str, name: &str, x: &[f64]) -> Option<Vec<[f64; 2]>> {
    let scenario = Document::parse_header("", run_file).ok()?.scenario().ok()?;
    let quantity = RunQuantity::find(name)?;
    let (begin, end) = extent(x.iter().copied())?;
    let times_s: Vec<f64> = (0..=MODEL_CURVE_POINTS)
        .map(|index: u32| {
            begin + (end - begin) * (f64::from(index) / f64::from(MODEL_CURVE_POINTS))
        })
        .collect();
    let series = data::TimeSeries {
        curves: vec![MeasuredCurve {
            quantity,
            points: (0..times_s.len())
                .map(|row| MeasuredPoint {
                    row,
                    value: 0.0,
                    sigma: None,
                })
                .collect(),
        }],
        times_s,
    };
    let values = data::at_times(&series, &Arc::new(scenario), &|| true);
    let values = values.ok()??.pop()?;
    let pairs = series.times_s.iter().zip(values);
    Some(pairs.map(|(&time_s, value)| [time_s, value]).collect())
}

impl FitFigure<'_> {
    /// Groups `rows` by the other settings, with their values as names. Returns a single group if there are too many.
    fn groups(&self, rows: RowIndices) -> Vec<(String, RowIndices)> {
        let others = self.fit.settings.iter().filter(|name| *name != self.along);
        let columns: Vec<(&str, Vec<&str>)> = others
            .filter_map(|name| Some((name.as_str(), self.table.texts(name)?)))
            .collect();
        // A setting with the same value in every row distinguishes nothing.
        let telling: Vec<_> = columns
            .iter()
            .filter(|(_, texts)| rows.iter().any(|&row| texts[row] != texts[rows[0]]))
            .collect();
        let names = rows.iter().map(|row| {
            let (said, values): (Vec<_>, Vec<_>) = telling
                .iter()
                .map(|(key, texts)| {
                    let value = texts[*row].trim_end_matches(".0");
                    (self.said(key, &letters::escape(value)), value)
                })
                .unzip();
            within_room(said.join(", "), &values.join(", "), self.room_pt)
        });
        let mut groups = grouped(&names.collect::<Vec<String>>());
        if groups.len() > MOST_GROUPS {
            return vec![(String::new(), rows)];
        }
        let places = groups.iter_mut().flat_map(|(_, places)| places);
        places.for_each(|place| *place = rows[*place]);
        groups
    }

    /// Returns the values of `column` in `rows`, from left to right, with the errors of the measured values.
    fn series(&self, column: &str, rows: &RowIndices) -> Result<ChartSeries, String> {
        let values = numbers(self.table, column)?;
        let errors = numbers(self.table, "uncertainty")?;
        let errors = points(rows, &self.x, &errors).into_iter();
        Ok(ChartSeries {
            points: points(rows, &self.x, &values),
            errors: [Vec::new(), errors.map(|[_, error]| error).collect()],
            ..ChartSeries::default()
        })
    }

    /// Creates the panel of the measured values and the model.
    fn values(&self, name: &str, groups: &[(String, RowIndices)]) -> Result<Panel, String> {
        let curve = (self.along == TIME_COLUMN).then(|| curve(&self.fit.run_file, name, &self.x));
        let curve = curve.flatten();
        let mut series = Vec::new();
        let mut said = self.model().into_iter();
        for (index, (group, rows)) in groups.iter().enumerate() {
            let points = self.series("model", rows)?.points;
            let style = SeriesStyle {
                dash_pt: &[],
                ..SeriesStyle::theory(index, 0)
            };
            let model = curve.clone().unwrap_or(points);
            series.push(ChartSeries::new(
                said.next().unwrap_or_default(),
                model,
                style,
            ));
            // The values of further keys are lines of the legend without a curve.
            series.extend(said.by_ref().map(ChartSeries::named));
            series.push(ChartSeries {
                name: match groups {
                    [_] => "measured".to_owned(),
                    _ => group.clone(),
                },
                style: SeriesStyle::points(index),
                ..self.series("measured", rows)?
            });
        }
        Ok(Panel::new(quantity::axis(name), series).of_column(name))
    }

    /// Creates the panel of the residuals, in units of the uncertainties if all are stated.
    fn residuals(&self, name: &str, groups: &[(String, RowIndices)]) -> Result<Panel, String> {
        let all_rows = groups.iter().flat_map(|(_, rows)| rows);
        let errors = numbers(self.table, "uncertainty")?;
        let are_stated = all_rows.clone().all(|&row| errors[row].is_finite());
        let (column, unit) = if are_stated {
            ("residual_sigmas", letters::escape("σ"))
        } else {
            ("residual", quantity::axis(name).unit)
        };
        let ends = extent(all_rows.map(|&row| self.x[row]));
        let mut series: Vec<_> = ends.map(ChartSeries::level).into_iter().collect();
        for (index, (_, rows)) in groups.iter().enumerate() {
            let mut left = self.series(column, rows)?;
            if are_stated {
                left.errors[1].fill(1.0);
            }
            left.style = SeriesStyle::points(index);
            series.push(left);
        }
        Ok(Panel::new(ChartAxis::new("residual", unit), series).of_column(column))
    }
}
