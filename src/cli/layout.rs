//! The options that say which rows and columns a CSV has.

use super::refuse;
use super::values::{IN_SECONDS, bare, one_or_more};
use crate::export::Layout;
use crate::export::layout::LayoutFile;
use clap::Args;
use clap::error::ErrorKind;
use std::num::NonZeroU64;

/// Which rows and columns a CSV has, and how its numbers are written.
#[derive(Debug, Args)]
pub(super) struct LayoutArgs {
    /// Write every N-th row only, and the last
    #[arg(long, value_name = "N", default_value = "1", allow_negative_numbers = true, value_parser = one_or_more)]
    every: NonZeroU64,

    /// Write these columns only, in this order; gyrolab man csv lists them
    #[arg(
        long,
        value_name = "A,B",
        value_delimiter = ',',
        requires = "output",
        help_heading = ROWS
    )]
    columns: Vec<String>,

    /// Leave out the rows before this time, s; the run begins at 0 all the same
    #[arg(long, value_name = "SECONDS", requires = "output", allow_negative_numbers = true, value_parser = time, help_heading = ROWS)]
    from: Option<f64>,

    /// Leave out the rows after this time, s; the run goes on to its end all the same
    #[arg(long, value_name = "SECONDS", requires = "output", allow_negative_numbers = true, value_parser = time, help_heading = ROWS)]
    to: Option<f64>,

    /// Write a row for each point of the body at each step: its name, mass, place and velocity
    #[arg(long, requires = "output", help_heading = ROWS)]
    points: bool,

    /// Write decimal commas, with semicolons between the columns, for Excel in German and other such languages
    #[arg(long, requires = "output", help_heading = ROWS)]
    excel: bool,
}

const ROWS: &str = "Rows and columns of the CSV";

/// A time from the beginning of the run on, s.
pub(super) fn time(text: &str) -> Result<f64, String> {
    let fits = |seconds: &f64| *seconds >= 0.0 && seconds.is_finite();
    bare(
        text,
        fits,
        IN_SECONDS,
        "must be a time in seconds, 0 or more",
    )
}

impl LayoutArgs {
    /// The layout; the process ends where there is none such, as it does where clap refuses.
    pub(super) fn layout(&self) -> Layout {
        let file = LayoutFile {
            every: Some(self.every),
            from_s: self.from,
            to_s: self.to,
            columns: (!self.columns.is_empty()).then(|| self.columns.clone()),
            points: self.points,
            excel: self.excel,
            note: None,
        };
        file.check().unwrap_or_else(|error| {
            let option = error.key.trim_end_matches("_s");
            let message = format!("--{option}: {}", error.rule);
            refuse("run", ErrorKind::ValueValidation, &message)
        })
    }
}
