//! What was measured, on the model that was fitted to it; below, what is left of it.

use super::{Rows, grouped, numbers};
use crate::figure::chart::legend::longest_name;
use crate::figure::chart::{Axis, Panel, Series, Style};
use crate::figure::page::ink::LABEL_PT;
use crate::figure::page::letters;
use crate::figure::quantity;
use crate::figure::table::Table;
use crate::measured::quantity::TIME;
use crate::measured::{self, Curve, Point, Quantity};
use crate::scenario::Document;
use crate::text::unit::Unit;
use std::sync::Arc;

/// So many points are on the curve of a model over time: several for each dot of a column's width.
const POINTS: u32 = 1500;
/// Runs under several settings that are still told apart.
const MOST_GROUPS: usize = 6;

/// The axis of the time or of a setting, and for each quantity a panel with its values and one with what is left of them.
pub(super) fn drawn(
    table: &Table,
    settings: &[String],
    run_file: &str,
    columns: &[&str],
    width_pt: f64,
) -> Result<(Axis, Vec<Panel>), String> {
    let quantities = table.texts("quantity").unwrap_or_default();
    let (along, x) = along(table, settings)?;
    let mut panels = Vec::new();
    for (name, rows) in grouped(&quantities) {
        if !columns.is_empty() && !columns.contains(&name.as_str()) {
            continue;
        }
        let mut groups = groups(table, settings, along, &rows);
        if groups.len() > MOST_GROUPS {
            groups = vec![(String::new(), rows.clone())];
        }
        let curve = match along == TIME {
            true => curve(run_file, &name, &x),
            false => None,
        };
        let drawing = Drawing {
            table,
            x: &x,
            room_pt: longest_name(width_pt),
        };
        panels.push(drawing.values(&name, &groups, curve.as_deref())?);
        panels.push(drawing.residuals(&name, &groups)?);
    }
    match panels.is_empty() {
        true => Err("none of these is a quantity that was fitted".to_owned()),
        false => Ok((quantity::axis(along), panels)),
    }
}

/// The column over which a fit is drawn, the one with the most different numbers, and these.
fn along<'a>(table: &Table, settings: &'a [String]) -> Result<(&'a str, Vec<f64>), String> {
    let count = |numbers: &[f64]| {
        let mut sorted = numbers.to_vec();
        sorted.sort_by(f64::total_cmp);
        sorted.dedup();
        sorted.len()
    };
    let numbers = settings.iter().filter_map(|name| {
        let numbers = table.numbers(name)?;
        let is_whole = numbers.iter().all(|number| number.is_finite());
        is_whole.then_some((name.as_str(), numbers))
    });
    // Of columns with as many, the first.
    let most = numbers.reduce(|most, next| match count(&next.1) > count(&most.1) {
        true => next,
        false => most,
    });
    most.ok_or_else(|| "no column that says where its values were measured is a number".to_owned())
}

/// `rows` by what else was set, each with its values as its name.
fn groups(table: &Table, settings: &[String], along: &str, rows: &Rows) -> Vec<(String, Rows)> {
    let others = settings.iter().filter(|name| *name != along);
    let columns: Vec<(&str, Vec<&str>)> = others
        .filter_map(|name| {
            let unit = Unit::of(name.trim_end_matches(|c: char| c == '.' || c.is_ascii_digit()));
            Some((unit.map_or("", |unit| unit.name), table.texts(name)?))
        })
        .collect();
    // What is the same in every row tells no two apart.
    let differs = |texts: &Vec<&str>| rows.iter().any(|&row| texts[row] != texts[rows[0]]);
    let named = |row: &usize| {
        let parts = columns.iter().filter(|(_, texts)| differs(texts));
        let parts =
            parts.map(|(unit, texts)| format!("{} {unit}", texts[*row].trim_end_matches(".0")));
        parts
            .map(|part| part.trim().to_owned())
            .collect::<Vec<_>>()
            .join(", ")
    };
    let names: Vec<String> = rows.iter().map(named).collect();
    let groups = grouped(&names).into_iter();
    groups
        .map(|(name, places)| (name, places.into_iter().map(|place| rows[place]).collect()))
        .collect()
}

/// The fitted run's own curve of the quantity `name` over the times that `x` spans.
fn curve(run_file: &str, name: &str, x: &[f64]) -> Option<Vec<[f64; 2]>> {
    let scenario = Document::parse("", run_file).ok()?.scenario().ok()?;
    let quantity = Quantity::find(name)?;
    let end = x.iter().copied().fold(0.0, f64::max);
    let begin = x.iter().copied().fold(end, f64::min);
    let time = |index: u32| begin + (end - begin) * (f64::from(index) / f64::from(POINTS));
    let times_s: Vec<f64> = (0..=POINTS).map(time).collect();
    let point = |row| Point {
        row,
        value: 0.0,
        sigma: None,
    };
    let series = measured::Series {
        lines: vec![0; times_s.len()],
        curves: vec![Curve {
            quantity,
            points: (0..times_s.len()).map(point).collect(),
        }],
        times_s,
    };
    let values = measured::at_times(&series, &Arc::new(scenario), &|| true);
    let values = values.ok()??.pop()?;
    let times_s = series.times_s.iter();
    Some(
        times_s
            .zip(values)
            .map(|(&time_s, value)| [time_s, value])
            .collect(),
    )
}

/// What is drawn, and over what.
struct Drawing<'a> {
    table: &'a Table,
    x: &'a [f64],
    room_pt: f64,
}

impl Drawing<'_> {
    /// The numbers of `column` in `rows`, from left to right, and their errors.
    fn points(
        &self,
        column: &str,
        errors: &str,
        rows: &Rows,
    ) -> Result<(Vec<[f64; 2]>, Vec<f64>), String> {
        let (values, errors) = (numbers(self.table, column)?, numbers(self.table, errors)?);
        let mut rows = rows.clone();
        rows.sort_by(|&a, &b| self.x[a].total_cmp(&self.x[b]));
        let points = rows.iter().map(|&row| [self.x[row], values[row]]).collect();
        Ok((points, rows.iter().map(|&row| errors[row]).collect()))
    }

    /// The panel of the values on the model.
    fn values(
        &self,
        name: &str,
        groups: &[(String, Rows)],
        curve: Option<&[[f64; 2]]>,
    ) -> Result<Panel, String> {
        let mut panel = Panel {
            y: quantity::axis(name),
            ..Panel::default()
        };
        let is_alone = groups.len() == 1;
        for (index, (group, rows)) in groups.iter().enumerate() {
            let (points, _) = self.points("model", "uncertainty", rows)?;
            panel.series.push(Series {
                errors_across: Vec::new(),
                name: if is_alone {
                    "model".to_owned()
                } else {
                    String::new()
                },
                points: curve.map_or(points, <[_]>::to_vec),
                errors: Vec::new(),
                style: Style {
                    dash_pt: &[],
                    ..Style::theory(index)
                },
            });
            let (points, errors) = self.points("measured", "uncertainty", rows)?;
            let own = letters::shortened(&letters::escape(group), LABEL_PT, self.room_pt);
            panel.series.push(Series {
                errors_across: Vec::new(),
                name: if is_alone { "measured".to_owned() } else { own },
                points,
                errors,
                style: Style::points(index),
            });
        }
        Ok(panel)
    }

    /// The panel of what is left, in units of the uncertainties where all are stated.
    fn residuals(&self, name: &str, groups: &[(String, Rows)]) -> Result<Panel, String> {
        let all = groups.iter().flat_map(|(_, rows)| rows.iter().copied());
        let errors = numbers(self.table, "uncertainty")?;
        let are_stated = all.clone().all(|row| errors[row].is_finite());
        let (column, unit) = match are_stated {
            true => ("residual_sigmas", letters::escape("σ")),
            false => ("residual", quantity::axis(name).unit),
        };
        let ends = all
            .map(|row| self.x[row])
            .fold(None, |ends: Option<(f64, f64)>, x| {
                let (low, high) = ends.unwrap_or((x, x));
                Some((low.min(x), high.max(x)))
            });
        let mut panel = Panel {
            y: Axis::new("residual", unit),
            ..Panel::default()
        };
        if let Some((low, high)) = ends {
            panel.series.push(Series {
                points: vec![[low, 0.0], [high, 0.0]],
                style: Style::theory(0),
                ..Series::default()
            });
        }
        for (index, (_, rows)) in groups.iter().enumerate() {
            let (points, errors) = self.points(column, "uncertainty", rows)?;
            panel.series.push(Series {
                errors_across: Vec::new(),
                name: String::new(),
                errors: match are_stated {
                    true => vec![1.0; points.len()],
                    false => errors,
                },
                points,
                style: Style::points(index),
            });
        }
        Ok(panel)
    }
}
