//! `gyrolab figure`: runs, or a table of runs, drawn on paper.

use super::args::{Changes, LengthArgs, ScenarioArgs};
use super::layout::time;
use super::progress::{self, Interrupted, Interruption};
use super::scenario::scenario_of;
use super::values::positive;
use super::{ended_by, refuse, tell};
use crate::analysis::cost;
use crate::data;
use crate::figure::kind::Kind;
use crate::figure::of_runs::{self, Figure, Request, Run};
use crate::figure::table::Table;
use crate::figure::{self, Format, PT_PER_MM, of_table};
use crate::physics::scheme;
use crate::text::printable::{Shown, printable};
use anyhow::{bail, ensure};
use clap::Args;
use clap::builder::PossibleValuesParser;
use clap::error::ErrorKind;
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::sync::Arc;

#[derive(Debug, Args)]
pub(super) struct FigureArgs {
    /// Presets' names, or files (.toml or .csv): what gyrolab run takes, or the CSV of compare, of a sweep or of a fit.
    /// Of compare the slope is told where the error falls evenly over three time steps or more
    #[arg(required = true, value_name = "RUN")]
    runs: Vec<String>,

    /// Write the figure to this file; its name's end says in which form: .svg, .pdf or .png (600 dpi)
    #[arg(short, long, value_name = "FILE")]
    output: PathBuf,

    /// What to draw: traces (x, y, z over time), above, 3d, columns of the CSV over time with commas between them, or
    /// residuals (measured less run) [default: traces, or with --measured what was measured]
    #[arg(long, value_name = "KIND")]
    kind: Option<String>,

    /// Begin at this time of the run, s
    #[arg(long, value_name = "S", allow_negative_numbers = true, value_parser = time)]
    from: Option<f64>,

    /// End at this time of the run, s
    #[arg(long, value_name = "S", allow_negative_numbers = true, value_parser = positive)]
    to: Option<f64>,

    /// Draw the exact motion beside it, dashed
    #[arg(long)]
    exact: bool,

    /// Draw measured data with it: a CSV with a column t_s, or data that come with gyrolab (heidelberg-spin-decay)
    #[arg(long, value_name = "FILE")]
    measured: Option<String>,

    /// Width of the page: 86mm for a column, 178mm for a page
    #[arg(long, value_name = "MM", default_value = "86mm", value_parser = width)]
    width: f64,

    /// Draw the run by each of these schemes
    #[arg(long, value_name = "A,B", value_delimiter = ',', conflicts_with = "scheme", value_parser = PossibleValuesParser::new(scheme::names()))]
    schemes: Vec<String>,

    #[command(flatten)]
    changes: Changes,

    #[command(flatten)]
    length: LengthArgs,

    /// Replace an existing file
    #[arg(long)]
    force: bool,
}

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

pub(super) fn figure(args: &FigureArgs) -> anyhow::Result<ExitCode> {
    let format = Format::of(&args.output)?;
    let subject = subject(args)?;
    let (output, interruption) = progress::open_for(&args.output, args.force)?;
    let figure = drawn(&subject, args, &interruption)?;
    let bytes = figure::write(&figure.scene, format)?;
    output.write_and_keep(&bytes)?;
    interruption.may_act_at_once()?;
    for warning in figure.told() {
        tell(format_args!("gyrolab: {warning}"));
    }
    let mm = |pt: f64| (pt / PT_PER_MM).round();
    tell(format_args!(
        "gyrolab: {} mm x {} mm in {}",
        mm(figure.scene.width_pt),
        mm(figure.scene.height_pt),
        Shown(&args.output)
    ));
    Ok(ended_by(figure.broke.map(anyhow::Error::msg)))
}

enum Subject {
    Runs(Vec<Run>, Request),
    Table(Table),
}

fn subject(args: &FigureArgs) -> anyhow::Result<Subject> {
    let mut tables = Vec::new();
    for named in &args.runs {
        tables.extend(Table::read(Path::new(named))?);
    }
    match (tables.pop(), args.runs.len()) {
        (None, _) => {
            let kind = args.kind.as_deref().map(Kind::named).transpose();
            let kind = kind.unwrap_or_else(|refusal| no_kind(args, &refusal));
            let measured = args.measured.as_deref().map(data::open).transpose()?;
            let left_out = measured
                .as_ref()
                .and_then(data::Measured::left_out_in_words);
            left_out
                .into_iter()
                .for_each(|text| tell(format_args!("gyrolab: {text}")));
            let usual = match &measured {
                Some(measured) => Kind::measured(measured.series()?),
                None => Kind::traces(),
            };
            let request = Request {
                kind: kind.unwrap_or(usual),
                from_s: args.from.unwrap_or(0.0),
                to_s: args.to,
                exact: args.exact,
                measured: measured.map(Arc::new),
                width_pt: args.width * PT_PER_MM,
            };
            Ok(Subject::Runs(runs(args)?, request))
        }
        (Some(_), 2..) => {
            bail!("the table of a comparison, of a sweep or of a fit is drawn alone: give one file")
        }
        (Some(table), _) => {
            let is_changed = args.exact
                || args.from.or(args.to).is_some()
                || args.measured.is_some()
                || !args.schemes.is_empty()
                || args.changes.is_some()
                || args.length.is_some();
            ensure!(
                !is_changed,
                "{}: the numbers of a table are drawn as they are: of a figure's options, --kind, --width and --force are for it",
                args.runs[0]
            );
            Ok(Subject::Table(table))
        }
    }
}

/// Refuses `--kind` as clap refuses a value.
fn no_kind(args: &FigureArgs, refusal: &str) -> ! {
    let kind = printable(args.kind.as_deref().unwrap_or_default());
    let message = format!("invalid value '{kind}' for '--kind <KIND>': {refusal}");
    refuse("figure", ErrorKind::ValueValidation, &message)
}

/// Every run that is named, by every scheme that is.
fn runs(args: &FigureArgs) -> anyhow::Result<Vec<Run>> {
    let mut runs = Vec::new();
    for named in &args.runs {
        let by_scheme = args.schemes.iter().map(Some);
        let as_it_is = args.schemes.is_empty().then_some(None);
        for scheme in by_scheme.chain(as_it_is) {
            let mut changes = args.changes.clone();
            changes.scheme = scheme.cloned().or(changes.scheme);
            let scenario = ScenarioArgs {
                scenario: named.clone(),
                changes,
            };
            let scenario = scenario_of(&scenario, &args.length)?;
            if let Some(objection) = cost::objection(&scenario).filter(|_| args.exact) {
                bail!("{named}: {objection}: leave --exact out, or give a shorter --duration");
            }
            runs.push(Run {
                scenario: Arc::new(scenario),
                named: named.clone(),
            });
        }
    }
    Ok(runs)
}

fn drawn(
    subject: &Subject,
    args: &FigureArgs,
    interruption: &Interruption,
) -> anyhow::Result<Figure> {
    let (runs, request) = match subject {
        Subject::Runs(runs, request) => (runs, request),
        Subject::Table(table) => return drawn_table(table, args),
    };
    for run in runs.iter().filter(|run| run.named.ends_with(".csv")) {
        tell(format_args!(
            "gyrolab: {}: its {} steps are computed anew from its header",
            Shown(Path::new(&run.named)),
            run.scenario.steps
        ));
    }
    let figure = of_runs::figure(runs, request, interruption.meter());
    Ok(figure.map_err(anyhow::Error::msg)?.ok_or(Interrupted)?)
}

fn drawn_table(table: &Table, args: &FigureArgs) -> anyhow::Result<Figure> {
    let columns = args.kind.iter().flat_map(|kind| kind.split(','));
    let columns: Vec<_> = columns.map(str::trim).collect();
    let chart = of_table::chart(table, &columns, args.width * PT_PER_MM);
    let chart = chart.map_err(|refusal| anyhow::anyhow!("{}: {refusal}", args.runs[0]))?;
    Ok(Figure {
        scene: chart.scene(),
        warnings: of_table::warnings(table, &columns),
        dense: None,
        broke: None,
    })
}
