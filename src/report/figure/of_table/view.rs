//! What of a table is drawn, and how: what the command line asks for, and for the rest the `[figure]` of a sweep.

use crate::plot::chart::{Chart, ChartAxis, Panel};
use crate::report::figure::spec::FigureSpec;
use crate::studies::sweep::{MAP, SweepFigure};
use crate::studies::table::{TableSource, TableSubject};

/// How a table is drawn.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum TableKind {
    /// Columns over a column, as points and lines.
    #[default]
    Curves,
    /// A column of a sweep over two keys, as colors.
    Map,
    /// The error of a comparison over its cost.
    WorkPrecision,
}

const WORK_PRECISION: &str = "work-precision";

/// The kinds of figure of tables that have a name; any other figure is named by its columns.
pub const TABLE_KIND_NAMES: [&str; 2] = [MAP, WORK_PRECISION];

/// What of a table is drawn, and how.
#[derive(Clone, Debug, Default)]
pub struct TableView {
    pub kind: TableKind,
    /// The columns along the axis at the left, or as colors; all that make sense where there are none.
    pub y: Vec<String>,
    /// The column along the axis below; what is usual where there is none.
    pub x: Option<String>,
    /// Whether the axes x and y and the colors are logarithmic.
    pub is_log: [bool; 3],
    pub x_range: Option<(f64, f64)>,
    pub width_pt: f64,
}

impl TableView {
    /// Returns the curves of these columns on a page of that width.
    pub fn of_columns(columns: &[&str], width_pt: f64) -> Self {
        Self {
            y: columns.iter().map(|name| (*name).to_owned()).collect(),
            width_pt,
            ..Self::default()
        }
    }

    /// Returns what `spec` asks for of `table`.
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

    /// Takes over from `figure` what is not asked for. A figure of another kind has nothing for it; which kind that is may be
    /// asked for or not.
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

    /// Gives `chart` the axes that are asked for.
    ///
    /// # Errors
    /// When no point lies between the ends of the axis x.
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

/// Returns the values of the points of `panel`, with their error bars, between two places along the axis x.
fn values_within(panel: &Panel, (low, high): (f64, f64)) -> Vec<f64> {
    let of_series = panel.series.iter().flat_map(|series| {
        let points = series.points.iter().enumerate();
        let inside = points.filter(move |(_, [x, _])| (low..=high).contains(x));
        inside.flat_map(|(place, _)| series.ends(place, 1).map(|[_, y]| y))
    });
    of_series.filter(|value| value.is_finite()).collect()
}
