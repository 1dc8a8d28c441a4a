//! The request for the figure of a table: options of the command line, completed by the `[figure]` of a sweep.

use crate::plot::chart::{Chart, ChartAxis, Panel};
use crate::report::figure::spec::FigureSpec;
use crate::studies::sweep::{MAP, SweepFigure};
use crate::studies::table::{TableSource, TableSubject};

/// Kind of a table's figure.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum TableKind {
    /// Columns over another column, as points and lines.
    #[default]
    Curves,
    /// A column of a sweep over two keys, as colors.
    Map,
    /// The error of a comparison over its cost.
    WorkPrecision,
}

const WORK_PRECISION: &str = "work-precision";

/// Names of the kinds of figures of tables. Other figures are named by their columns.
pub const TABLE_KIND_NAMES: [&str; 2] = [MAP, WORK_PRECISION];

/// The request for the figure of a table.
#[derive(Clone, Debug, Default)]
pub struct TableView {
    pub kind: TableKind,
    /// Columns on the vertical axis, or shown as colors; if empty, all that make sense.
    pub y: Vec<String>,
    /// Column on the horizontal axis; `None` for the default.
    pub x: Option<String>,
    /// True for each of the x axis, the y axis and the colors that is logarithmic.
    pub is_log: [bool; 3],
    pub x_range: Option<(f64, f64)>,
    pub width_pt: f64,
}

impl TableView {
    /// Creates a request for curves of these columns on a page of this width.
    pub fn of_columns(columns: &[&str], width_pt: f64) -> Self {
        Self {
            y: columns.iter().map(|name| (*name).to_owned()).collect(),
            width_pt,
            ..Self::default()
        }
    }

    /// Creates the view of `table` that `spec` requests.
    pub fn new(table: &TableSource, spec: &FigureSpec) -> Self {
        let asked = spec.kind.as_deref().unwrap_or_default();
        let named = [
            (MAP, TableKind::Map),
            (WORK_PRECISION, TableKind::WorkPrecision),
        ];
        let kind = named.into_iter().find(|(name, _)| *name == asked);
        let columns = asked
            .split(',')
            .map(str::trim)
            .filter(|name| !name.is_empty());
        let view = Self {
            kind: kind.map(|(_, kind)| kind).unwrap_or_default(),
            y: match kind {
                None if spec.y.is_empty() => columns.map(str::to_owned).collect(),
                _ => spec.y.clone(),
            },
            x: spec.x.clone(),
            is_log: [false, false, spec.labels.is_log_color],
            x_range: spec.x_range,
            width_pt: spec.page_width_pt(),
        };
        match &table.subject {
            TableSubject::Sweep(swept) => view.completed(&swept.figure, asked.is_empty()),
            TableSubject::Comparison(_) | TableSubject::Fit(_) => view,
        }
    }

    /// Completes missing options from `figure`, unless the figure's kind differs from the requested kind. `is_any_kind`
    /// is true if no kind is requested.
    fn completed(self, figure: &SweepFigure, is_any_kind: bool) -> Self {
        let kind = match figure.kind.as_deref() {
            Some(MAP) => TableKind::Map,
            _ => TableKind::Curves,
        };
        if !is_any_kind && kind != self.kind {
            return self;
        }
        let log = figure.log.as_deref().unwrap_or_default();
        let is_log = ["x", "y", "z"].map(|axis| log.contains(axis));
        Self {
            kind,
            is_log: [0, 1, 2].map(|axis| self.is_log[axis] || is_log[axis]),
            x_range: self.x_range.or(figure.x_range.map(Into::into)),
            y: if self.y.is_empty() {
                figure.y.clone().unwrap_or_default()
            } else {
                self.y
            },
            x: self.x.or_else(|| figure.x.clone()),
            width_pt: self.width_pt,
        }
    }

    /// Applies the requested axes to `chart`.
    ///
    /// # Errors
    /// Returns an error if no point is within the range of the x axis.
    pub(super) fn set_axes(&self, chart: &mut Chart) -> Result<(), String> {
        chart.x.is_log |= self.is_log[0];
        for panel in &mut chart.panels {
            panel.y.is_log |= self.is_log[1];
        }
        let Some((low, high)) = self.x_range else {
            return Ok(());
        };
        if chart.x.is_log && low <= 0.0 {
            return Err("--x-range of a logarithmic axis begins above 0".to_owned());
        }
        chart.x.range = Some((low, high));
        let mut is_empty = true;
        for panel in &mut chart.panels {
            let inside = values_within(panel, (low, high));
            is_empty &= inside.is_empty() && panel.map.is_none();
            panel.y = ChartAxis {
                range: Some(panel.y.range_of(inside.into_iter())),
                ..panel.y.clone()
            };
        }
        if is_empty {
            return Err(format!(
                "no point of this table lies within --x-range {low}..{high}"
            ));
        }
        Ok(())
    }
}

/// Returns the y values of the points of `panel` between two positions on the x axis, including their error bars.
fn values_within(panel: &Panel, (low, high): (f64, f64)) -> Vec<f64> {
    let of_series = panel.series.iter().flat_map(|series| {
        let points = series.points.iter().enumerate();
        let inside = points.filter(move |(_, [x, _])| (low..=high).contains(x));
        inside.flat_map(|(place, _)| series.ends(place, 1).map(|[_, y]| y))
    });
    of_series.filter(|value| value.is_finite()).collect()
}
