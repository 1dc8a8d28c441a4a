//! The kinds of figures of runs, named after the lab's panes and the columns of a CSV.

use crate::engine::analysis::readouts;
use crate::engine::data::TimeSeries;
use crate::engine::export::CsvColumn;
use crate::engine::export::columns::DISTANCE;
use crate::engine::recording::RecordedCurve;
use crate::engine::scenario::problem;
use crate::engine::scenario::screen::{ABOVE, THREE_D, TRACES};

#[derive(Clone, Debug)]
pub enum FigureKind {
    OverTime(Vec<&'static CsvColumn>),
    /// The distance from the exact motion over time, on a logarithmic axis.
    Error(Vec<&'static CsvColumn>),
    /// Measured values minus the values of a run, with one panel per quantity.
    Residuals,
    Above,
    ThreeD,
}

const MOST_FIGURE_COLUMNS: usize = 30;

pub const RESIDUALS: &str = "residuals";
pub const ERROR: &str = "error";

/// Names of the kinds of figures that any run can have.
pub const RUN_FIGURE_NAMES: [&str; 4] = [TRACES, ABOVE, THREE_D, ERROR];
/// These names, and the kind that needs measured data. A list of columns also names a figure.
pub const FIGURE_KIND_NAMES: [&str; 5] = {
    let [traces, above, three_d, error] = RUN_FIGURE_NAMES;
    [traces, above, three_d, error, RESIDUALS]
};

fn find(name: &str) -> Option<&'static CsvColumn> {
    CsvColumn::all().find(|column| column.name == name)
}

impl FigureKind {
    pub fn traces() -> Self {
        let columns = RecordedCurve::OF_POINT.iter().map(|curve| curve.column());
        Self::OverTime(columns.filter_map(find).collect())
    }

    pub fn columns(&self) -> &[&'static CsvColumn] {
        match self {
            Self::OverTime(columns) | Self::Error(columns) => columns,
            Self::Above | Self::ThreeD | Self::Residuals => &[],
        }
    }

    pub fn name(&self) -> String {
        match self {
            Self::OverTime(columns) => {
                let names: Vec<_> = columns.iter().map(|column| column.name).collect();
                names.join(",")
            }
            Self::Error(_) => ERROR.to_owned(),
            Self::Above => ABOVE.to_owned(),
            Self::ThreeD => THREE_D.to_owned(),
            Self::Residuals => RESIDUALS.to_owned(),
        }
    }

    /// Returns the kind that shows the measured quantities of `series` over time.
    pub fn measured(series: &TimeSeries) -> Self {
        let names = series.curves.iter().map(|curve| curve.quantity.name);
        Self::OverTime(names.filter_map(find).collect())
    }

    /// Parses the name of a kind: one of [`FIGURE_KIND_NAMES`], or columns separated by commas.
    ///
    /// # Errors
    /// Returns an error if there is no such kind or column, with a suggestion if there is a similar name.
    pub fn named(name: &str) -> Result<Self, String> {
        match name {
            TRACES => return Ok(Self::traces()),
            ABOVE => return Ok(Self::Above),
            THREE_D => return Ok(Self::ThreeD),
            RESIDUALS => return Ok(Self::Residuals),
            ERROR => return Ok(Self::Error(find(DISTANCE).into_iter().collect())),
            _ => {}
        }
        let is_list = name.contains(',');
        let count = name.split(',').count();
        if count > MOST_FIGURE_COLUMNS {
            return Err(format!(
                "names {count} columns: a figure shows at most {MOST_FIGURE_COLUMNS}"
            ));
        }
        let columns = name.split(',').map(str::trim).map(|name| {
            // The caller's message already names the whole list.
            column(name).map_err(|rule| {
                if is_list {
                    format!("{name} {rule}")
                } else {
                    rule
                }
            })
        });
        columns.collect::<Result<_, _>>().map(Self::OverTime)
    }
}

fn column(name: &str) -> Result<&'static CsvColumn, String> {
    if name.is_empty() {
        let kinds = FIGURE_KIND_NAMES.join(", ");
        return Err(format!(
            "lacks a name: {kinds}, or columns of the CSV with commas between them"
        ));
    }
    if FIGURE_KIND_NAMES.contains(&name) {
        return Err("is a figure of its own: no columns can stand beside it".to_owned());
    }
    let columns: Vec<&str> = CsvColumn::all().map(|column| column.name).collect();
    find(name).ok_or_else(|| if readouts::find(name).is_some() {
        format!(
            "is a readout, one number of a run, and no column: a sweep's table is drawn by its readouts; over time there is {}",
            columns.join(", ")
        )
    } else {
        let near = problem::nearest(name, FIGURE_KIND_NAMES.into_iter().chain(columns));
        let kinds = FIGURE_KIND_NAMES.join(", ");
        format!("is no kind of figure ({kinds}) and no column of the CSV: {near}")
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn figure_kinds_are_named_after_panes_and_columns() {
        assert_eq!(FigureKind::named("traces").unwrap().name(), "x_m,y_m,z_m");
        let two = FigureKind::named("tilt_deg, energy_J").unwrap();
        assert_eq!(two.name(), "tilt_deg,energy_J");
        assert!(matches!(FigureKind::named("above"), Ok(FigureKind::Above)));
        assert!(matches!(FigureKind::named("3d"), Ok(FigureKind::ThreeD)));
    }

    #[test]
    fn an_unknown_kind_is_rejected_with_the_nearest_name() {
        for (wrong, near) in [
            ("tilt_dg", "tilt_deg"),
            ("abov", "above"),
            ("x_m,energy", "energy_J"),
            ("x_m,above", "of its own"),
        ] {
            let refusal = FigureKind::named(wrong).unwrap_err();
            assert!(refusal.contains(near), "{refusal}");
        }
    }
}
