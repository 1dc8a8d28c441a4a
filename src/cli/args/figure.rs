//! The arguments of `gyrolab figure`.

use super::{Changes, LengthArgs, positive};
use crate::physics::scheme;
use clap::Args;
use clap::builder::PossibleValuesParser;
use std::path::PathBuf;

#[derive(Debug, Args)]
#[command(after_help = FIGURES)]
pub(in crate::cli) struct FigureArgs {
    /// Presets' names, or files (.toml or .csv): what gyrolab run takes, or the CSV of compare or of a sweep
    #[arg(required = true, value_name = "RUN")]
    pub(in crate::cli) runs: Vec<String>,

    /// Write the figure to this file; its name's end says in which form: .svg, .pdf or .png (600 dpi)
    #[arg(short, long, value_name = "FILE")]
    pub(in crate::cli) output: PathBuf,

    /// What to draw: traces (x, y, z over time), above, 3d, or columns of the CSV over time with commas between them
    /// [default: traces]
    #[arg(long, value_name = "KIND")]
    pub(in crate::cli) kind: Option<String>,

    /// Begin at this time of the run, s
    #[arg(long, value_name = "S", allow_negative_numbers = true, value_parser = not_negative)]
    pub(in crate::cli) from: Option<f64>,

    /// End at this time of the run, s
    #[arg(long, value_name = "S", allow_negative_numbers = true, value_parser = positive)]
    pub(in crate::cli) to: Option<f64>,

    /// Draw the exact motion beside it, dashed
    #[arg(long)]
    pub(in crate::cli) exact: bool,

    /// Width of the page: 86mm for a column, 178mm for a page
    #[arg(long, value_name = "MM", default_value = "86mm", value_parser = width)]
    pub(in crate::cli) width: f64,

    /// Draw the run by each of these schemes
    #[arg(long, value_name = "A,B", value_delimiter = ',', conflicts_with = "scheme", value_parser = PossibleValuesParser::new(scheme::names()))]
    pub(in crate::cli) schemes: Vec<String>,

    #[command(flatten)]
    pub(in crate::cli) changes: Changes,

    #[command(flatten)]
    pub(in crate::cli) length: LengthArgs,

    /// Replace an existing file
    #[arg(long)]
    pub(in crate::cli) force: bool,
}

const FIGURES: &str = "\
Examples:
  gyrolab figure wobble-push -o wobble.pdf                        x, y and z over time
  gyrolab figure cusps --kind 3d -o cusps.svg
  gyrolab figure method-2 --kind tilt_deg --exact -o tilt.pdf     beside the exact motion
  gyrolab figure method-2 --schemes report,rk4 --kind z_m --to 20 -o schemes.png
  gyrolab compare cusps -o error.csv && gyrolab figure error.csv -o error.pdf";

/// The narrowest and the widest page, mm.
const WIDTHS_MM: (f64, f64) = (30.0, 1000.0);

/// A width in mm: 86mm, 8.6cm or 86.
fn width(text: &str) -> Result<f64, String> {
    let (number, unit) = match (text.strip_suffix("mm"), text.strip_suffix("cm")) {
        (Some(number), _) => (number, 1.0),
        (_, Some(number)) => (number, 10.0),
        _ => (text, 1.0),
    };
    let width_mm = number.trim().parse().map(|number: f64| number * unit);
    let (least, most) = WIDTHS_MM;
    match width_mm {
        Ok(width_mm) if (least..=most).contains(&width_mm) => Ok(width_mm),
        _ => Err(format!(
            "must be a width such as 86mm, from {least}mm to {most}mm"
        )),
    }
}

fn not_negative(text: &str) -> Result<f64, String> {
    match text.parse() {
        Ok(number) if number >= 0.0 && f64::is_finite(number) => Ok(number),
        _ => Err("must be a number not below zero".to_owned()),
    }
}
