//! What was measured, on the model that was fitted to it; below, what is left of it.

use super::{Rows, grouped, numbers, within_room};
use crate::figure::chart::legend::longest_name;
use crate::figure::chart::ticks::{power_of_ten, with_minus};
use crate::figure::chart::{Axis, Panel, Series, Style};
use crate::figure::page::letters;
use crate::figure::quantity;
use crate::figure::table::{Found, Table};
use crate::measured::quantity::TIME;
use crate::measured::{self, Curve, Point, Quantity};
use crate::scenario::Document;
use crate::text::number::{significant, uncertain};
use std::sync::Arc;

/// Points on the curve of a model over time: several for each dot of a column's width.
const POINTS: u32 = 1500;
/// The most runs under several settings that can be distinguished.
const MOST_GROUPS: usize = 6;

/// What was fitted, and what was found.
pub(super) struct Fitted<'a> {
    settings: &'a [String],
    run_file: &'a str,
    found: &'a [Found],
    /// The run file, in which the keys have their names.
    scenario: toml::Table,
    /// The longest name in the legend, pt.
    room_pt: f64,
}

impl<'a> Fitted<'a> {
    pub(super) fn new(
        settings: &'a [String],
        run_file: &'a str,
        found: &'a [Found],
        width_pt: f64,
    ) -> Self {
        Self {
            settings,
            run_file,
            found,
            scenario: run_file.parse().unwrap_or_default(),
            room_pt: longest_name(width_pt),
        }
    }

    /// `key` with what stands for its value, such as "*z* of weight = 0.1555 m".
    fn said(&self, key: &str, value: &str) -> String {
        let axes = key
            .split('+')
            .map(|key| quantity::axis_in(&self.scenario, key));
        let (names, units): (Vec<_>, Vec<_>) = axes.map(|axis| (axis.name, axis.unit)).unzip();
        let unit = units.first().map_or("", String::as_str);
        let said = format!("{} = {value} {unit}", names.join(" = "));
        said.trim_end().to_owned()
    }

    fn within_room(&self, markup: String, plain: &str) -> String {
        within_room(markup, plain, self.room_pt)
    }

    /// What the legend says of the model: the value of each free key.
    fn model(&self) -> Vec<String> {
        let lines = self.found.iter().enumerate().map(|(index, found)| {
            let model = if index == 0 { "model: " } else { "" };
            let value = stated(found);
            let said = format!("{model}{}", self.said(&found.key, &value));
            let value = significant(found.value, DIGITS);
            self.within_room(said, &format!("{model}{} = {value}", found.key))
        });
        let mut lines: Vec<_> = lines.collect();
        if lines.is_empty() {
            lines.push("model".to_owned());
        }
        let scheme = self.scenario.get("motion").and_then(|it| it.get("scheme"));
        if let Some(scheme) = scheme.and_then(toml::Value::as_str) {
            let said = format!("scheme: {}", letters::escape(scheme));
            lines.push(self.within_room(said, scheme));
        }
        lines
    }
}

/// Digits of a value whose uncertainty cannot be stated.
const DIGITS: usize = 6;

/// The value with its uncertainty, as markup.
fn stated(found: &Found) -> String {
    let stated = found
        .uncertainty
        .and_then(|sigma| uncertain(found.value, sigma));
    match stated {
        Some(stated) if stated.exponent == 0 => with_minus(&stated.digits),
        Some(stated) => {
            let power = power_of_ten(stated.exponent);
            format!("{} · {power}", with_minus(&stated.digits))
        }
        None => with_minus(&significant(found.value, DIGITS)),
    }
}

/// The axis of the time or of a setting, and for each quantity a panel with its values and one with what is left of them.
pub(super) fn drawn(
    table: &Table,
    fit: &Fitted<'_>,
    columns: &[&str],
) -> Result<(Axis, Vec<Panel>), String> {
    let quantities = table.texts("quantity").unwrap_or_default();
    let (along, x) = along(table, fit.settings)?;
    let mut panels = Vec::new();
    for (name, rows) in grouped(&quantities) {
        if !columns.is_empty() && !columns.contains(&name.as_str()) {
            continue;
        }
        let mut groups = groups(table, fit, along, &rows);
        if groups.len() > MOST_GROUPS {
            groups = vec![(String::new(), rows.clone())];
        }
        let curve = if along == TIME {
            curve(fit.run_file, &name, &x)
        } else {
            None
        };
        let drawing = Drawing { table, fit, x: &x };
        panels.push(drawing.values(&name, &groups, curve.as_deref())?);
        panels.push(drawing.residuals(&name, &groups)?);
    }
    if panels.is_empty() {
        Err("none of these is a quantity that was fitted".to_owned())
    } else {
        Ok((quantity::axis(along), panels))
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
    let most = numbers.reduce(|most, next| {
        if count(&next.1) > count(&most.1) {
            next
        } else {
            most
        }
    });
    most.ok_or_else(|| "no column that says where its values were measured is a number".to_owned())
}

/// `rows` by what else was set, each with its values as its name.
fn groups(table: &Table, fit: &Fitted<'_>, along: &str, rows: &Rows) -> Vec<(String, Rows)> {
    let others = fit.settings.iter().filter(|name| *name != along);
    let columns: Vec<(&str, Vec<&str>)> = others
        .filter_map(|name| Some((name.as_str(), table.texts(name)?)))
        .collect();
    // What is the same in every row tells no two apart.
    let differs = |texts: &Vec<&str>| rows.iter().any(|&row| texts[row] != texts[rows[0]]);
    let named = |row: &usize| {
        let parts = columns.iter().filter(|(_, texts)| differs(texts));
        let (said, values): (Vec<_>, Vec<_>) = parts
            .map(|(key, texts)| {
                let value = texts[*row].trim_end_matches(".0");
                (fit.said(key, &letters::escape(value)), value)
            })
            .unzip();
        fit.within_room(said.join(", "), &values.join(", "))
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
    fit: &'a Fitted<'a>,
    x: &'a [f64],
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
        let mut said = self.fit.model().into_iter();
        for (index, (group, rows)) in groups.iter().enumerate() {
            let (points, _) = self.points("model", "uncertainty", rows)?;
            panel.series.push(Series {
                errors_across: Vec::new(),
                name: said.next().filter(|_| index == 0).unwrap_or_default(),
                points: curve.map_or(points, <[_]>::to_vec),
                errors: Vec::new(),
                style: Style {
                    dash_pt: &[],
                    ..Style::theory(index, 0)
                },
            });
            // The values of further keys, each on a line of the legend without a curve.
            let more = said.by_ref().take_while(|_| index == 0);
            panel.series.extend(more.map(|name| Series {
                name,
                style: Style {
                    width_pt: 0.0,
                    ..Style::default()
                },
                ..Series::default()
            }));
            let (points, errors) = self.points("measured", "uncertainty", rows)?;
            panel.series.push(Series {
                errors_across: Vec::new(),
                name: if is_alone {
                    "measured".to_owned()
                } else {
                    group.clone()
                },
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
        let (column, unit) = if are_stated {
            ("residual_sigmas", letters::escape("σ"))
        } else {
            ("residual", quantity::axis(name).unit)
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
                style: Style::theory(0, 0),
                ..Series::default()
            });
        }
        for (index, (_, rows)) in groups.iter().enumerate() {
            let (points, errors) = self.points(column, "uncertainty", rows)?;
            panel.series.push(Series {
                errors_across: Vec::new(),
                name: String::new(),
                errors: if are_stated {
                    vec![1.0; points.len()]
                } else {
                    errors
                },
                points,
                style: Style::points(index),
            });
        }
        Ok(panel)
    }
}
