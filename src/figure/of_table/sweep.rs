//! Readouts over what was varied: points that were measured, and the theory of them.

mod columns;
mod curves;
mod theory;

use super::{numbers, within_room};
use crate::figure::chart::legend::longest_name;
use crate::figure::chart::{Axis, Panel, Series, Style};
use crate::figure::quantity;
use crate::figure::table::Table;
use columns::{Part, Quantity, Role};
use curves::Curve;

/// Panels on a page where none was asked for by name.
const MOST_PANELS: usize = 7;
/// The most series of one quantity that can be distinguished.
const MOST_SERIES: usize = 12;

/// A sweep: its rows, the keys that were varied, and the scenario in which these have their names.
pub(super) struct Swept<'a> {
    pub table: &'a Table,
    pub varied: &'a [String],
    pub scenario: &'a toml::Table,
}

/// The axis of what was varied, and a panel for each quantity.
pub(super) fn drawn(
    swept: &Swept<'_>,
    columns: &[&str],
    width_pt: f64,
) -> Result<(Axis, Vec<Panel>), String> {
    let &Swept {
        table,
        varied,
        scenario,
    } = swept;
    // The key that runs fastest and is a number goes to the right; the others make curves.
    let along = varied.iter().rev().find_map(|key| {
        let values = table.numbers(key)?;
        Some((key, values))
    });
    let Some((key, along)) = along else {
        return Err(format!(
            "none of the varied keys is a number: {}",
            varied.join(", ")
        ));
    };
    let curves = curves::curves(swept, key);
    if curves.len() > MOST_SERIES {
        return Err(format!(
            "{} curves would stand beside each other, and {MOST_SERIES} can be told apart: vary {} at fewer values, or name the key with the most values last, which makes it the horizontal axis",
            curves.len(),
            varied
                .iter()
                .filter(|other| *other != key)
                .cloned()
                .collect::<Vec<_>>()
                .join(", ")
        ));
    }
    let quantities = columns::quantities(table, varied, columns);
    if columns.is_empty() && quantities.len() > MOST_PANELS {
        return Err(too_many(&quantities));
    }
    let drawing = Drawing {
        table,
        along: &along,
        curves: &curves,
        width_pt,
        has: Roles::of(&quantities),
        has_gaps: !lines_with_gaps(table, columns, varied).is_empty(),
    };
    let panels = quantities.iter().map(|quantity| drawing.panel(quantity));
    let mut panels = panels.collect::<Result<Vec<_>, _>>()?;
    let Some(first) = panels.first_mut() else {
        return Err("no column of this sweep is a number that can be drawn".to_owned());
    };
    first.series.extend(drawing.failed(&quantities)?);
    let x = Axis {
        is_log: spans_decades(along.iter().copied(), 30.0) && is_geometric(&along),
        ..quantity::axis_in(scenario, key)
    };
    Ok((x, panels))
}

fn too_many(quantities: &[Quantity]) -> String {
    let parts = quantities.iter().flat_map(|quantity| &quantity.parts);
    let names: Vec<_> = parts.map(|part| part.name.as_str()).collect();
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
/// What the legend calls values that were neither measured nor are theory, beside those that were measured.
const OTHER: &str = "other values";

/// The rows of `table` whose runs did not fail.
fn rows_run(table: &Table, varied: &[String]) -> Vec<usize> {
    let readouts = table.names().iter().filter(|name| !varied.contains(name));
    let readouts: Vec<_> = readouts.filter_map(|name| table.texts(name)).collect();
    let has_run = |row: &usize| readouts.iter().any(|texts| !texts[*row].is_empty());
    (0..table.count()).filter(has_run).collect()
}

/// The columns of theory that have no value in some rows, and in how many.
fn lines_with_gaps<'a>(
    table: &'a Table,
    columns: &'a [&'a str],
    varied: &[String],
) -> Vec<(&'a str, usize)> {
    let rows = rows_run(table, varied);
    let with_gaps = columns::theory(table, columns).filter_map(|name| {
        let values = table.numbers(name)?;
        let missing = rows.iter().filter(|row| values[**row].is_nan()).count();
        (1..rows.len())
            .contains(&missing)
            .then_some((name, missing))
    });
    with_gaps.collect()
}

/// What is said of lines of theory that have gaps, and of runs that failed.
pub(super) fn gaps(table: &Table, columns: &[&str], varied: &[String]) -> Vec<String> {
    let rows = rows_run(table, varied);
    let gaps = lines_with_gaps(table, columns, varied);
    let gaps = gaps.into_iter().map(|(name, missing)| {
        format!(
            "the line of {name} has gaps: in {missing} of {} rows theory states no value, for a reason that gyrolab man numbers gives",
            rows.len()
        )
    });
    let unmeasured = unmeasured(table, columns, varied, &rows);
    let failed = table.count() - rows.len();
    let failed = (failed > 0).then(|| {
        format!(
            "the runs of {failed} of {} rows failed: they have no points",
            table.count()
        )
    });
    gaps.chain(unmeasured).chain(failed).collect()
}

/// What is said of `rows` whose run did give no number, or one that its axis cannot show.
fn unmeasured(table: &Table, columns: &[&str], varied: &[String], rows: &[usize]) -> Vec<String> {
    let quantities = columns::quantities(table, varied, columns);
    let parts = quantities.iter().flat_map(|quantity| &quantity.parts);
    let parts = parts.filter(|part| part.role != Role::Theory);
    let told = parts.filter_map(|part| {
        let values = table.numbers(&part.name)?;
        let count = |is: &dyn Fn(f64) -> bool| rows.iter().filter(|row| is(values[**row])).count();
        let missing = count(&|value| !value.is_finite());
        let zeros = count(&|value| value == 0.0);
        if missing > 0 {
            return Some(format!(
                "there is no {} in {missing} of {} rows: no point is drawn for them",
                part.name,
                rows.len()
            ));
        }
        let is_log = spans_decades(values.into_iter(), DECADES);
        (zeros > 0 && is_log).then(|| {
            format!(
                "in {zeros} of {} rows {} is 0, which a logarithmic axis does not show",
                rows.len(),
                part.name
            )
        })
    });
    told.collect()
}

/// Whose numbers a chart has.
struct Roles {
    theory: bool,
    measured: bool,
    value: bool,
}

impl Roles {
    fn of(quantities: &[Quantity]) -> Self {
        let has = |role| {
            let mut parts = quantities.iter().flat_map(|quantity| &quantity.parts);
            parts.any(|part| part.role == role)
        };
        Self {
            theory: has(Role::Theory),
            measured: has(Role::Measured),
            value: has(Role::Value),
        }
    }
}

/// What is drawn, and over what.
struct Drawing<'a> {
    table: &'a Table,
    along: &'a [f64],
    curves: &'a [Curve],
    width_pt: f64,
    has: Roles,
    /// Whether a line of theory has gaps.
    has_gaps: bool,
}

impl Drawing<'_> {
    fn panel(&self, quantity: &Quantity) -> Result<Panel, String> {
        let mut panel = Panel {
            y: quantity.axis(),
            ..Panel::default()
        };
        let is_alone = quantity.parts.len() == 1;
        for (place, part) in quantity.parts.iter().enumerate() {
            let series = match part.role {
                Role::Theory => self.theory(part, place, is_alone)?,
                Role::Measured | Role::Value => self.points(part)?,
            };
            panel.series.extend(series);
        }
        let values = panel.series.iter().flat_map(|series| &series.points);
        panel.y.is_log = spans_decades(values.map(|point| point[1]), DECADES);
        Ok(panel)
    }

    /// What a curve with these `settings` is called in the legend.
    fn name(&self, word: &str, settings: &[curves::Setting]) -> String {
        curves::name(word, settings, longest_name(self.width_pt))
    }

    /// The rows of a curve from left to right.
    fn rows(&self, curve: &Curve) -> Vec<usize> {
        let rows = curve.rows.iter().copied();
        let mut rows: Vec<usize> = rows.filter(|&row| self.along[row].is_finite()).collect();
        rows.sort_by(|&a, &b| self.along[a].total_cmp(&self.along[b]));
        rows
    }

    /// The points of `part`, a series for each curve that has some.
    fn points(&self, part: &Part) -> Result<Vec<Series>, String> {
        let values = numbers(self.table, &part.name)?;
        let errors = part.uncertainty.as_ref();
        let errors = errors.map(|name| numbers(self.table, name)).transpose()?;
        let is_other = part.role == Role::Value && self.has.measured;
        let word = match self.has.theory {
            _ if is_other => OTHER.to_owned(),
            true => part.word(false),
            false => String::new(),
        };
        let curves = self.curves.iter().map(|curve| {
            let rows = self.rows(curve);
            let errors = errors.iter().flat_map(|errors| {
                let errors = rows.iter().map(|&row| errors[row].abs());
                errors.collect::<Vec<_>>()
            });
            Series {
                name: if is_other {
                    self.name(&word, &[])
                } else {
                    self.name(&word, &curve.settings)
                },
                errors: errors.collect(),
                points: rows
                    .iter()
                    .map(|&row| [self.along[row], values[row]])
                    .collect(),
                style: match part.role {
                    Role::Measured => Style::points(curve.index),
                    _ if is_other => Style::specks(curve.index),
                    _ => Style::marked_line(curve.index),
                },
                ..Series::default()
            }
        });
        let has_some = |series: &Series| series.points.iter().any(|point| point[1].is_finite());
        Ok(curves.filter(has_some).collect())
    }

    /// The lines of the theory `part`, the one at `place` of its panel: one for all curves for which it says the same.
    fn theory(&self, part: &Part, place: usize, is_alone: bool) -> Result<Vec<Series>, String> {
        let values = numbers(self.table, &part.name)?;
        let each = self.curves.iter().map(|curve| {
            let rows = self.rows(curve).into_iter();
            (
                curve,
                rows.map(|row| [self.along[row], values[row]]).collect(),
            )
        });
        let is_beside = self.has.measured || self.has.value;
        let lines = theory::lines(each).into_iter().map(|line| Series {
            // The curves are told apart by the points: of theory it is said once how it is drawn.
            name: match is_beside {
                true if self.has_gaps => self.name(&(part.word(is_alone) + IN_GAPS), &[]),
                true => self.name(&part.word(is_alone), &[]),
                false => self.name("", &line.settings),
            },
            style: line.style(place, self.width_pt),
            points: line.points,
            ..Series::default()
        });
        Ok(lines.collect())
    }

    /// What the legend says of each curve that has no point: the names of those curves whose runs all failed.
    fn failed(&self, quantities: &[Quantity]) -> Result<Vec<Series>, String> {
        let parts = quantities.iter().flat_map(|quantity| &quantity.parts);
        let parts = parts.filter(|part| part.role != Role::Theory);
        let columns = parts.map(|part| numbers(self.table, &part.name));
        let columns = columns.collect::<Result<Vec<_>, _>>()?;
        let has_point = |curve: &Curve| {
            let mut values = curve
                .rows
                .iter()
                .flat_map(|&row| columns.iter().map(move |column| column[row]));
            columns.is_empty() || values.any(f64::is_finite)
        };
        let room_pt = longest_name(self.width_pt);
        let failed = self.curves.iter().filter(|curve| !has_point(curve));
        let failed = failed.map(|curve| {
            const FAILED: &str = "no run could be measured";
            let name = curves::name("", &curve.settings, room_pt);
            let plain = curves::name(FAILED, &curve.settings, room_pt);
            Series {
                name: within_room(format!("{name}: {FAILED}"), &plain, room_pt),
                style: Style {
                    width_pt: 0.0,
                    ..Style::default()
                },
                ..Series::default()
            }
        });
        Ok(failed.collect())
    }
}

/// Whether no value is below 0, and the greatest is at least `times` the least above 0.
fn spans_decades(values: impl Iterator<Item = f64>, times: f64) -> bool {
    let extent = values
        .filter(|value| value.is_finite() && *value != 0.0)
        .fold(None, |extent: Option<(f64, f64)>, value| {
            let (low, high) = extent.unwrap_or((value, value));
            Some((low.min(value), high.max(value)))
        });
    extent.is_some_and(|(low, high)| low > 0.0 && high / low >= times)
}

/// Whether a good part of `values`, all above 0, lies far below their greatest: they go by factors and not by steps.
fn is_geometric(values: &[f64]) -> bool {
    let high = values.iter().copied().fold(0.0, f64::max);
    let low = values.iter().copied().fold(high, f64::min);
    let middle = (low * high).sqrt();
    let below = values.iter().filter(|value| **value < middle).count();
    3 * below >= values.len()
}
