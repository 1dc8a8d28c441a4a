//! Maps of readouts of a sweep over two keys.

use super::columns;
use super::{DECADES, is_geometric, spans_decades};
use crate::plot::chart::map::ColorMap;
use crate::plot::chart::{ChartAxis, Panel};
use crate::report::figure::of_table::numbers;
use crate::report::figure::of_table::view::TableView;
use crate::report::figure::quantity;
use crate::studies::table::{SweepTable, TableSource};

/// Maximum number of maps on a page.
const MOST_MAPS: usize = 4;
/// Maximum number of cells of a map.
const MOST_CELLS: usize = 40_000;

/// A key along an axis of a map.
struct MapKey {
    key: String,
    /// Value in each row of the table.
    of_rows: Vec<f64>,
    /// The distinct values, in ascending order.
    values: Vec<f64>,
}

/// Returns the axis of one key, and for each quantity a panel over it and the other key.
///
/// # Errors
/// Returns an error if the sweep does not vary two keys with numbers, or if there are too many quantities for a page.
pub(in crate::report::figure::of_table) fn drawn(
    table: &TableSource,
    swept: &SweepTable,
    view: &TableView,
) -> Result<(ChartAxis, Vec<Panel>), String> {
    let keys = keys(table, swept, view.x.as_deref())?;
    let cells = keys[0].values.len() * keys[1].values.len();
    if cells > MOST_CELLS {
        return Err(format!(
            "a map shows at most {MOST_CELLS} cells, and this one has {cells}: sweep fewer values"
        ));
    }
    let [x, y] = [0, 1].map(|place| keys[place].axis(swept, view.is_log[place]));
    let mut panels = Vec::new();
    for column in quantities(table, swept, view)? {
        let values = numbers(table, &column)?;
        let is_log = view.is_log[2] || spans_decades(values.iter().copied(), DECADES);
        let map = ColorMap {
            values: grid(&keys, &values),
            color: ChartAxis {
                is_log,
                ..quantity::axis(&column)
            },
            along: keys.each_ref().map(|key| key.values.clone()),
        };
        panels.push(Panel {
            map: Some(map),
            ..Panel::new(y.clone(), Vec::new()).of_column(&column)
        });
    }
    Ok((x, panels))
}

impl MapKey {
    /// Returns the first of the keys that vary together with at least two different numbers. The key `asked` takes
    /// precedence.
    fn new(table: &TableSource, together: &[String], asked: Option<&str>) -> Option<Self> {
        let first = together.iter().find(|key| Some(key.as_str()) == asked);
        let mut keys = first.into_iter().chain(together);
        keys.find_map(|key| {
            let of_rows = table.numbers(key)?;
            let mut values = of_rows.clone();
            values.sort_by(f64::total_cmp);
            values.dedup();
            (values.len() > 1 && values.iter().all(|value| value.is_finite())).then(|| Self {
                key: key.clone(),
                of_rows,
                values,
            })
        })
    }

    fn axis(&self, swept: &SweepTable, is_asked_log: bool) -> ChartAxis {
        let is_log = spans_decades(self.values.iter().copied(), 30.0) && is_geometric(&self.values);
        ChartAxis {
            is_log: is_log || is_asked_log,
            ..quantity::axis_in(&swept.scenario, &self.key)
        }
    }

    /// Returns the index of the value of `row` among the distinct values.
    fn place(&self, row: usize) -> Option<usize> {
        let value = self.of_rows[row];
        let found = self
            .values
            .binary_search_by(|other| other.total_cmp(&value));
        found.ok()
    }
}

/// Returns the two keys of a map. The first, for the x axis, is `asked` or the fastest-varying key.
fn keys(
    table: &TableSource,
    swept: &SweepTable,
    asked: Option<&str>,
) -> Result<[MapKey; 2], String> {
    let varying = |keys: &Vec<String>| {
        let mut texts = keys.iter().filter_map(|key| table.texts(key));
        texts.any(|texts| texts.iter().any(|text| text != &texts[0]))
    };
    let axes: Vec<&Vec<String>> = swept.axes.iter().filter(|keys| varying(keys)).collect();
    let found = axes
        .iter()
        .filter_map(|keys| MapKey::new(table, keys, asked));
    let found: Vec<MapKey> = found.collect();
    let Ok([slow, fast]) = <[MapKey; 2]>::try_from(found) else {
        return Err(not_two(&axes));
    };
    if axes.len() > 2 {
        return Err(not_two(&axes));
    }
    match asked {
        Some(key) if slow.key == key => Ok([slow, fast]),
        Some(key) if fast.key != key => Err(format!(
            "--kind map: the axis below is one of the keys that vary, {} or {}, and not {key}",
            slow.key, fast.key
        )),
        _ => Ok([fast, slow]),
    }
}

/// Describes why `axes`, the keys that vary, do not make a map.
fn not_two(axes: &[&Vec<String>]) -> String {
    let keys: Vec<String> = axes.iter().map(|keys| keys.join("+")).collect();
    format!(
        "--kind map draws a table of two keys that vary over numbers; here these vary: {}",
        keys.join(", ")
    )
}

/// Returns the columns to draw: the requested ones, or the readouts that are not theory, or else all.
fn quantities(
    table: &TableSource,
    swept: &SweepTable,
    view: &TableView,
) -> Result<Vec<String>, String> {
    let columns: Vec<&str> = view.y.iter().map(String::as_str).collect();
    let quantities = columns::quantities(table, swept, &columns);
    if view.y.is_empty() && quantities.len() > MOST_MAPS {
        return Err(super::too_many(&quantities).replace("--kind ", "--y "));
    }
    // For a measured quantity and its theory, the measured column is drawn unless the theory is requested.
    let drawn = quantities.iter().flat_map(|quantity| {
        let shown = if view.y.is_empty() {
            quantity.len() - 1
        } else {
            0
        };
        &quantity[shown..]
    });
    let names: Vec<String> = drawn.map(|part| part.name.clone()).collect();
    match names.len() {
        0 => Err("no column of this sweep is a number that can be drawn".to_owned()),
        1..=MOST_MAPS => Ok(names),
        count => Err(format!(
            "{count} maps do not fit on a page: choose {MOST_MAPS} at most with --y"
        )),
    }
}

/// Arranges `values`, one per row of the table, in cells, with one row per value of the second key.
fn grid(keys: &[MapKey; 2], values: &[f64]) -> Vec<Vec<f64>> {
    let [x, y] = keys;
    let mut cells = vec![vec![f64::NAN; x.values.len()]; y.values.len()];
    for (row, value) in values.iter().enumerate() {
        if let (Some(column), Some(line)) = (x.place(row), y.place(row)) {
            cells[line][column] = *value;
        }
    }
    cells
}
