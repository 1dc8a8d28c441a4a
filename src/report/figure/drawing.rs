//! Draws a figure of runs or of a table.

use super::job::{DrawnFigure, KnownNumbers};
use super::of_runs;
use super::of_table::{self, TableView};
use super::source::FigureSource;
use super::spec::FigureSpec;
use crate::studies::table::TableSource;
use std::ops::ControlFlow;
use std::slice;

impl FigureSource {
    /// Draws the figure. `watch` is called with the current and the last step. Returns `None` if `watch` stopped the
    /// computation.
    ///
    /// # Errors
    /// Returns an error if the figure cannot be drawn as requested.
    pub fn draw(
        &self,
        watch: impl FnMut(u64, u64) -> ControlFlow<()>,
    ) -> Result<Option<DrawnFigure>, String> {
        self.check()?;
        match &self.table {
            Some(table) => match of_table(table, &self.spec) {
                Ok(figure) => Ok(Some(figure)),
                Err(refusal) => Err(format!("{}: {refusal}", table.origin)),
            },
            None => {
                let known = KnownNumbers::default();
                let figures = of_runs::figures(slice::from_ref(self), &known, watch)?;
                Ok(figures.and_then(|mut figures| figures.pop()))
            }
        }
    }
}

/// Draws the requested figure of `table`.
fn of_table(table: &TableSource, spec: &FigureSpec) -> Result<DrawnFigure, String> {
    let mut chart = of_table::chart(table, &TableView::new(table, spec))?;
    let without_point = of_table::warning(table, &chart);
    let hidden = spec.labels.apply(&mut chart)?;
    spec.labels.check_ranges(&chart)?;
    spec.set_height(&mut chart)?;
    chart.decimal_comma = spec.decimal_comma;
    let mut figure = DrawnFigure::without_remarks(spec.on_page(chart.scene()));
    figure
        .warnings
        .extend(without_point.into_iter().chain(hidden));
    figure.warnings.extend(of_table::unreliable(table));
    Ok(figure)
}
