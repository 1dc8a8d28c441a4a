//! Readouts over what was varied: points that were measured, on the line that was predicted.

use super::{Rows, grouped, numbers};
use crate::figure::chart::legend::longest_name;
use crate::figure::chart::{Axis, Panel, Series, Style};
use crate::figure::page::ink::LABEL_PT;
use crate::figure::page::letters;
use crate::figure::quantity;
use crate::figure::table::Table;

const MEASURED: &str = "measured_";
const PREDICTED: &str = "predicted_";
const UNCERTAINTY: &str = "_uncertainty";

/// The axis of what was varied, and a panel for each quantity.
pub(super) fn drawn(
    table: &Table,
    varied: &[String],
    columns: &[&str],
    width_pt: f64,
) -> Result<(Axis, Vec<Panel>), String> {
    // The key that runs fastest and is a number goes to the right; the others make series.
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
    let groups = series_of(table, varied, key);
    if groups.len() > MOST_SERIES {
        return Err(format!(
            "{} curves would stand beside each other, and {MOST_SERIES} can be told apart: vary {} at fewer values",
            groups.len(),
            varied
                .iter()
                .filter(|other| *other != key)
                .cloned()
                .collect::<Vec<_>>()
                .join(", ")
        ));
    }
    let quantities = quantities(table, varied, columns);
    if columns.is_empty() && quantities.len() > MOST_PANELS {
        let names = quantities
            .iter()
            .map(|quantity| quantity.parts[0].name.as_str());
        return Err(format!(
            "{} quantities do not fit on a page: choose some with --kind A,B; there are {}",
            quantities.len(),
            names.collect::<Vec<_>>().join(", ")
        ));
    }
    let mut panels = Vec::new();
    for quantity in &quantities {
        let mut panel = Panel {
            y: quantity.axis(),
            ..Panel::default()
        };
        for (index, (name, rows)) in groups.iter().enumerate() {
            for part in &quantity.parts {
                let series = part.series(table, &along, rows, index)?;
                let what = if quantity.parts.len() > 1 {
                    part.word()
                } else {
                    ""
                };
                let words = [what, name.as_str()];
                let words: Vec<_> = words.into_iter().filter(|word| !word.is_empty()).collect();
                panel.series.push(Series {
                    name: letters::shortened(&words.join(", "), LABEL_PT, longest_name(width_pt)),
                    ..series
                });
            }
        }
        let values = panel.series.iter().flat_map(|series| &series.points);
        panel.y.is_log = spans_decades(values.map(|point| point[1]), 1e3);
        panels.push(panel);
    }
    if panels.is_empty() {
        return Err("no column of this sweep is a number that can be drawn".to_owned());
    }
    let x = Axis {
        is_log: spans_decades(along.iter().copied(), 30.0) && is_geometric(&along),
        ..quantity::axis(key)
    };
    Ok((x, panels))
}

/// Panels on a page of which none was asked for by name.
const MOST_PANELS: usize = 7;
/// Series of one quantity that are still told apart.
const MOST_SERIES: usize = 12;

/// The rows of each curve, by what else was varied.
fn series_of(table: &Table, varied: &[String], along: &str) -> Vec<(String, Rows)> {
    let others: Vec<_> = varied.iter().filter(|key| *key != along).collect();
    let row_name = |row: usize| {
        let part = |key: &&String| {
            let text = table.texts(key).map_or("", |texts| texts[row]).to_owned();
            match key.as_str() {
                "motion.scheme" => text,
                key => format!("{} = {text}", key.rsplit('.').next().unwrap_or(key)),
            }
        };
        others.iter().map(part).collect::<Vec<_>>().join(", ")
    };
    let names: Vec<String> = match others.is_empty() {
        true => vec![String::new(); table.count()],
        false => (0..table.count()).map(row_name).collect(),
    };
    grouped(&names)
}

/// A quantity of a sweep: what was measured of it, and what was predicted.
struct Quantity {
    parts: Vec<Part>,
}

/// One of its columns.
struct Part {
    name: String,
    /// The column of its standard errors.
    uncertainty: Option<String>,
}

/// What a name is without saying whose number it is.
fn bare(name: &str) -> &str {
    let measured = name.strip_prefix(MEASURED);
    measured
        .or_else(|| name.strip_prefix(PREDICTED))
        .unwrap_or(name)
}

/// The quantities of a sweep in the order of its columns: all of them, or those that are asked for.
fn quantities(table: &Table, varied: &[String], columns: &[&str]) -> Vec<Quantity> {
    let is_asked = |name: &str| columns.is_empty() || columns.contains(&name);
    let is_number = |name: &str| {
        let numbers = table.numbers(name);
        numbers.is_some_and(|numbers| numbers.iter().any(|number| number.is_finite()))
    };
    let names = table.names.iter().filter(|name| {
        !varied.contains(name) && is_asked(name) && is_number(name) && !name.contains(UNCERTAINTY)
    });
    let mut quantities: Vec<Quantity> = Vec::new();
    for name in names {
        let part = Part {
            name: name.clone(),
            uncertainty: uncertainty_of(table, name),
        };
        let is_same = |other: &&mut Quantity| bare(&other.parts[0].name) == bare(name);
        match quantities.iter_mut().find(is_same) {
            Some(quantity) => quantity.parts.push(part),
            None => quantities.push(Quantity { parts: vec![part] }),
        }
    }
    // Theory is drawn first: the points stand on it.
    for quantity in &mut quantities {
        quantity.parts.sort_by_key(|part| !part.is_theory());
    }
    quantities
}

/// What is said of lines of theory that have gaps.
pub(super) fn gaps(table: &Table, columns: &[&str]) -> Vec<String> {
    let is_drawn = |name: &str| columns.is_empty() || columns.contains(&name);
    let names = table.names.iter();
    let theory = names.filter(|name| name.starts_with(PREDICTED) && is_drawn(name));
    let gaps = theory.filter_map(|name| {
        let values = table.numbers(name)?;
        let missing = values.iter().filter(|value| value.is_nan()).count();
        let is_line = (1..values.len()).contains(&missing);
        is_line.then(|| {
            format!(
                "the line of {name} has gaps: in {missing} of {} rows theory states no value, for a reason that gyrolab man numbers gives",
                values.len()
            )
        })
    });
    gaps.collect()
}

/// The column of the standard errors of `name`: measured_precession_uncertainty_rad_per_s of measured_precession_rad_per_s.
fn uncertainty_of(table: &Table, name: &str) -> Option<String> {
    let of_name = |other: &&String| {
        let Some((begin, unit)) = other.split_once(UNCERTAINTY) else {
            return false;
        };
        name.starts_with(begin) && name.ends_with(unit)
    };
    table.names.iter().find(of_name).cloned()
}

impl Quantity {
    /// Its axis: that of the quantity where both are drawn, else that of the column.
    fn axis(&self) -> Axis {
        let own = quantity::axis(&self.parts[0].name);
        // Words say whose number it is; the legend says so already where both stand beside each other.
        match self.parts.len() {
            1 => own,
            _ => {
                let word = letters::escape(PREDICTED.trim_end_matches('_')) + " ";
                let name = own.name.strip_prefix(&word).map(str::to_owned);
                Axis {
                    name: name.unwrap_or(own.name),
                    ..own
                }
            }
        }
    }
}

impl Part {
    fn is_theory(&self) -> bool {
        self.name.starts_with(PREDICTED)
    }

    fn word(&self) -> &'static str {
        match self.is_theory() {
            true => "predicted",
            false if self.name.starts_with(MEASURED) => "measured",
            false => "",
        }
    }

    fn series(
        &self,
        table: &Table,
        along: &[f64],
        rows: &[usize],
        index: usize,
    ) -> Result<Series, String> {
        let values = numbers(table, &self.name)?;
        let errors = match &self.uncertainty {
            Some(name) => numbers(table, name)?,
            None => Vec::new(),
        };
        let mut rows: Vec<usize> = rows
            .iter()
            .copied()
            .filter(|&row| along[row].is_finite())
            .collect();
        rows.sort_by(|&a, &b| along[a].total_cmp(&along[b]));
        let style = match (self.is_theory(), self.word()) {
            (true, _) => Style::theory(index),
            (false, "") => Style::marked_line(index),
            (false, _) => Style::points(index),
        };
        Ok(Series {
            name: String::new(),
            points: rows.iter().map(|&row| [along[row], values[row]]).collect(),
            errors: match errors.is_empty() {
                true => Vec::new(),
                false => rows.iter().map(|&row| errors[row].abs()).collect(),
            },
            errors_across: Vec::new(),
            style,
        })
    }
}

/// Whether all `values` are above 0, and the greatest is so many times the least.
fn spans_decades(values: impl Iterator<Item = f64>, times: f64) -> bool {
    let extent =
        values
            .filter(|value| value.is_finite())
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
