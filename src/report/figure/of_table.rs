//! Figures of tables. A comparison shows errors over time steps, with slopes, or over cost. A sweep shows readouts over
//! the varied keys, or as a map. A fit shows measured values, the model and residuals.

mod comparison;
mod fit;
mod sweep;
mod view;

use crate::engine::scenario::problem;
use crate::plot::chart::Chart;
use crate::plot::ink::{self, LABEL_PT};
use crate::plot::letters;
use crate::studies::table::{TableSource, TableSubject};
pub use view::{TABLE_KIND_NAMES, TableKind, TableView};

/// The column of a sweep that says if the other numbers of a row are reliable.
const RELIABLE: &str = "reliable";

/// Indices of rows.
type RowIndices = Vec<usize>;

/// Draws `table` as `view` requests.
///
/// # Errors
/// Returns an error if the table lacks a requested column, or if the figure cannot be drawn.
pub fn chart(table: &TableSource, view: &TableView) -> Result<Chart, String> {
    for column in view.y.iter().chain(&view.x) {
        if !table.names().contains(column) {
            let near = problem::nearest(column, table.names().iter().map(String::as_str));
            return Err(format!("{column} is no column of this table: {near}"));
        }
    }
    let (x, panels) = match (&table.subject, view.kind) {
        (
            TableSubject::Comparison(source),
            kind @ (TableKind::Curves | TableKind::WorkPrecision),
        ) => comparison::drawn(table, source, view, kind)?,
        (TableSubject::Sweep(swept), TableKind::Curves) => sweep::drawn(table, swept, view)?,
        (TableSubject::Sweep(swept), TableKind::Map) => sweep::map::drawn(table, swept, view)?,
        (TableSubject::Fit(fit), TableKind::Curves) => fit::drawn(table, fit, view)?,
        (TableSubject::Comparison(_) | TableSubject::Fit(_), TableKind::Map) => {
            return Err("--kind map is for the table of a sweep over two keys".to_owned());
        }
        (TableSubject::Sweep(_) | TableSubject::Fit(_), TableKind::WorkPrecision) => {
            return Err("--kind work-precision is for the table of gyrolab compare".to_owned());
        }
    };
    let mut chart = Chart {
        title: table.title.clone(),
        width_pt: view.width_pt,
        x,
        panels,
        is_true_to_scale: false,
        are_read_off: matches!(table.subject, TableSubject::Sweep(_)),
        ..Chart::default()
    };
    view.set_axes(&mut chart)?;
    Ok(chart)
}

/// Returns a warning with the number of values in the `chart` of `table` that are not shown.
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

/// Returns a warning with the number of runs in a sweep's `table` that are not reliable, if there are any.
pub fn unreliable(table: &TableSource) -> Option<String> {
    let texts = table.texts(RELIABLE)?;
    let count = texts.iter().filter(|text| **text == "false").count();
    (count > 0).then(|| {
        let all = texts.len();
        format!("{count} of {all} runs are not reliable: their column {RELIABLE} is false")
    })
}

fn numbers(table: &TableSource, name: &str) -> Result<Vec<f64>, String> {
    table
        .numbers(name)
        .ok_or_else(|| format!("{name}: its values are no numbers, and cannot be drawn"))
}

/// Returns `markup` if it fits into `room_pt`, else `plain`, shortened if necessary.
pub(super) fn within_room(markup: String, plain: &str, room_pt: f64) -> String {
    if ink::width(&markup, LABEL_PT) <= room_pt {
        markup
    } else {
        letters::shortened(plain, LABEL_PT, room_pt)
    }
}

/// Returns the points of the `rows` that have a position on the horizontal axis, from left to right.
fn points(rows: &RowIndices, along: &[f64], values: &[f64]) -> Vec<[f64; 2]> {
    let mut points: Vec<_> = rows
        .iter()
        .map(|&row| [along[row], values[row]])
        .filter(|[x, _]| x.is_finite())
        .collect();
    points.sort_by(|a, b| a[0].total_cmp(&b[0]));
    points
}

/// Groups rows by their text, in order of the first occurrence.
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
