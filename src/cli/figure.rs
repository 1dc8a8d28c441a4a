//! `gyrolab figure`: runs, or a table of runs, drawn on paper.

use super::args::{Changes, LengthArgs, MeasuredArgs, ScenarioArgs, positive, scenario_of, time};
use super::progress::{self, Interrupted, Interruption};
use super::{ended_by, refuse, tell};
use crate::analysis::cost;
use crate::data;
use crate::figure::kind::Kind;
use crate::figure::labels::Labels;
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

    /// Draw the exact motion beneath it, as a wide pale line
    #[arg(long)]
    exact: bool,

    #[command(flatten)]
    beside: MeasuredArgs,

    /// Width of the page: 86mm for a column, 178mm for a page
    #[arg(long, value_name = "MM", default_value = "86mm", value_parser = width)]
    width: f64,

    /// Draw the run by each of these schemes
    #[arg(long, value_name = "A,B", value_delimiter = ',', conflicts_with = "scheme", value_parser = PossibleValuesParser::new(scheme::names()))]
    schemes: Vec<String>,

    #[command(flatten)]
    labels: LabelArgs,

    #[command(flatten)]
    changes: Changes,

    #[command(flatten)]
    length: LengthArgs,

    /// Replace an existing file
    #[arg(long)]
    force: bool,
}

#[derive(Debug, Args)]
struct LabelArgs {
    /// Write this above the figure
    #[arg(long, value_name = "TEXT")]
    title: Option<String>,

    /// Call a run this in the legend: once per run, in order
    #[arg(long, value_name = "TEXT", allow_hyphen_values = true)]
    label: Vec<String>,

    /// Write this along the axis below
    #[arg(long, value_name = "TEXT", allow_hyphen_values = true)]
    x_label: Option<String>,

    /// Write this along the axis at the left: once per panel, from the top
    #[arg(long, value_name = "TEXT", allow_hyphen_values = true)]
    y_label: Vec<String>,

    /// Make these axes logarithmic
    #[arg(long, value_name = "AXES", value_parser = ["x", "y", "xy"])]
    log: Option<String>,

    /// Show this range of the axis at the left, such as 0..1
    #[arg(long, value_name = "A..B", allow_hyphen_values = true, value_parser = range)]
    y_range: Option<(f64, f64)>,

    /// In SVG write text as text, in the reader's fonts: it can be selected [default: outlines]
    #[arg(long)]
    text: bool,
}

impl LabelArgs {
    fn labels(&self) -> Labels {
        let log = self.log.as_deref().unwrap_or_default();
        Labels {
            title: self.title.clone(),
            names: self.label.clone(),
            x: self.x_label.clone(),
            y: self.y_label.clone(),
            is_log: ["x", "y"].map(|axis| log.contains(axis)),
            y_range: self.y_range,
        }
    }

    /// The form in which `output` is written.
    fn format(&self, output: &Path) -> anyhow::Result<Format> {
        match (Format::of(output)?, self.text) {
            (Format::Svg, true) => Ok(Format::SvgText),
            (_, true) => {
                bail!("--text is for .svg: the words of a .pdf can be selected as they are")
            }
            (format, false) => Ok(format),
        }
    }
}

/// Two numbers, the lower one first: 0..1.
fn range(text: &str) -> Result<(f64, f64), String> {
    let ends = text.split_once("..").and_then(|(low, high)| {
        let end = |text: &str| text.trim().parse().ok().filter(|end: &f64| end.is_finite());
        Some((end(low)?, end(high)?))
    });
    let ends = ends.filter(|(low, high)| low < high && (high - low).is_finite());
    ends.ok_or_else(|| "must be two numbers, the lower one first, such as 0..1".to_owned())
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
    let format = args.labels.format(&args.output)?;
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
            let request = request(args)?;
            let (runs, named) = (runs(args)?, args.labels.label.len());
            ensure!(
                named == 0 || named == runs.len(),
                "--label is given {named} times for {} runs: give it once per run, in order",
                runs.len()
            );
            Ok(Subject::Runs(runs, request))
        }
        (Some(_), 2..) => {
            bail!("the table of a comparison, of a sweep or of a fit is drawn alone: give one file")
        }
        (Some(table), _) => {
            let is_changed = args.exact
                || args.from.or(args.to).is_some()
                || args.beside.measured.is_some()
                || !args.schemes.is_empty()
                || !args.labels.label.is_empty()
                || args.changes.is_some()
                || args.length.is_some();
            ensure!(
                !is_changed,
                "{}: the numbers of a table are drawn as they are: of a figure's options, --kind, --width, --force, --title, --text and those of its axes are for it",
                args.runs[0]
            );
            Ok(Subject::Table(table))
        }
    }
}

fn request(args: &FigureArgs) -> anyhow::Result<Request> {
    let kind = args.kind.as_deref().map(Kind::named).transpose();
    let kind = kind.unwrap_or_else(|refusal| no_kind(args, &refusal));
    let MeasuredArgs { measured, columns } = &args.beside;
    let open = |name| data::open_with(name, &columns.map);
    let measured = measured.as_deref().map(open).transpose()?;
    if let Some(left_out) = measured
        .as_ref()
        .and_then(data::Measured::left_out_in_words)
    {
        tell(format_args!("gyrolab: {left_out}"));
    }
    let usual = match &measured {
        Some(measured) => Kind::measured(measured.series()?),
        None => Kind::traces(),
    };
    Ok(Request {
        kind: kind.unwrap_or(usual),
        from_s: args.from.unwrap_or(0.0),
        to_s: args.to,
        exact: args.exact,
        measured: measured.map(Arc::new),
        width_pt: args.width * PT_PER_MM,
        labels: args.labels.labels(),
    })
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
    let refused = |refusal| anyhow::anyhow!("{}: {refusal}", args.runs[0]);
    let mut chart = chart.map_err(refused)?;
    let labels = args.labels.labels();
    let hidden = labels.apply(&mut chart).map_err(refused)?;
    let mut scene = chart.scene();
    labels.write_title(&mut scene);
    let mut warnings = of_table::warnings(table, &columns);
    warnings.extend(hidden);
    Ok(Figure {
        scene,
        warnings,
        dense: None,
        broke: None,
    })
}
