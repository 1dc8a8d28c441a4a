//! Figures of tables: error over time step with its slope; readouts over what was varied, measured beside predicted; what
//! was measured on the model that was fitted, and what is left of it.

mod comparison;
mod fit;
mod sweep;

use crate::engine::scenario::problem;
use crate::plot::chart::Chart;
use crate::plot::ink::{self, LABEL_PT};
use crate::plot::letters;
use crate::studies::table::{TableSource, TableSubject};

/// A list of rows, by their places.
type RowIndices = Vec<usize>;

/// The chart of `table` on a page of that width, pt; `columns` are the ones that are asked for, all that make sense where
/// there are none.
pub fn chart(table: &TableSource, columns: &[&str], width_pt: f64) -> Result<Chart, String> {
    for column in columns {
        if !table.names().iter().any(|name| name == column) {
            let near = problem::nearest(column, table.names().iter().map(String::as_str));
            return Err(format!("{column} is no column of this table: {near}"));
        }
    }
    let (x, panels) = match &table.subject {
        TableSubject::Comparison => comparison::drawn(table, columns, width_pt)?,
        TableSubject::Fit(fit) => fit::drawn(table, fit, columns, width_pt)?,
        TableSubject::Sweep(swept) => sweep::drawn(table, swept, columns, width_pt)?,
    };
    Ok(Chart {
        title: table.title.clone(),
        width_pt,
        x,
        panels,
        is_true_to_scale: false,
        are_read_off: matches!(table.subject, TableSubject::Sweep(_)),
        ..Chart::default()
    })
}

/// How many values of the `chart` of `table` have no point, where some have none.
pub fn warning(table: &TableSource, chart: &Chart) -> Option<String> {
    let values = chart.panels.iter().flat_map(|panel| {
        let points = panel.series.iter().flat_map(|series| &series.points);
        points.map(|point| point[1].is_finite() && (point[1] > 0.0 || !panel.y.is_log))
    });
    let (shown, hidden): (Vec<bool>, Vec<bool>) = values.partition(|is_shown| *is_shown);
    let is_fit = matches!(table.subject, TableSubject::Fit(_)); // its model is a line between its points
    (!is_fit && !hidden.is_empty()).then(|| {
        format!(
            "{} of {} values have no point: there is no number (the run failed, or theory states none: gyrolab man numbers), or it is 0 on a logarithmic axis",
            hidden.len(),
            shown.len() + hidden.len()
        )
    })
}

fn numbers(table: &TableSource, name: &str) -> Result<Vec<f64>, String> {
    table
        .numbers(name)
        .ok_or_else(|| format!("{name}: its values are no numbers, and cannot be drawn"))
}

/// `markup`, or where it is longer than `room_pt` `plain`, which is cut where that is too long as well.
pub(super) fn within_room(markup: String, plain: &str, room_pt: f64) -> String {
    if ink::width(&markup, LABEL_PT) <= room_pt {
        markup
    } else {
        letters::shortened(plain, LABEL_PT, room_pt)
    }
}

/// The points of those of `rows` that have a place along the axis below, from left to right.
fn points(rows: &RowIndices, along: &[f64], values: &[f64]) -> Vec<[f64; 2]> {
    let mut points: Vec<_> = rows
        .iter()
        .map(|&row| [along[row], values[row]])
        .filter(|[x, _]| x.is_finite())
        .collect();
    points.sort_by(|a, b| a[0].total_cmp(&b[0]));
    points
}

/// The rows of each text, in the order in which the texts come first.
fn grouped<T: AsRef<str>>(texts: &[T]) -> Vec<(String, RowIndices)> {
    let mut groups: Vec<(String, RowIndices)> = Vec::new();
    for (row, text) in texts.iter().enumerate() {
        match groups.iter_mut().find(|(other, _)| other == text.as_ref()) {
            Some((_, rows)) => rows.push(row),
            None => groups.push((text.as_ref().to_owned(), vec![row])),
        }
    }
    groups
}
