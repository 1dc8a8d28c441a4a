//! `gyrolab figure`: runs, or a table of runs, drawn on paper.

use super::args::{Changes, LengthArgs, changed, positive, time};
use super::progress::{self, Interrupted};
use super::{ended_by, refuse, tell};
use crate::analysis::cost;
use crate::data;
use crate::export::Destination;
use crate::figure::kind::Kind;
use crate::figure::labels::Labels;
use crate::figure::of_runs::{Request, Run};
use crate::figure::table::Table;
use crate::figure::{COLUMN_PT, Format, OfTable, PT_PER_MM, Source, WIDTHS_MM};
use crate::origin;
use crate::physics::scheme;
use crate::scenario::head::is_file;
use crate::scenario::{Document, Problem, Problems};
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
    /// Presets' names, or files: what gyrolab run takes, the CSV of compare, of a sweep or of a fit, or a figure, whose own
    /// options hold where none is given.
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

    /// Draw measured data with it: a CSV with a column t_s, or data that come with gyrolab (heidelberg-spin-decay)
    #[arg(long, value_name = "FILE")]
    measured: Option<String>,

    /// Width of the page: 86mm for a column, 178mm for a page [default: 86mm]
    #[arg(long, value_name = "MM", value_parser = width)]
    width: Option<f64>,

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
    /// Writes what is given over `labels`.
    fn change(&self, labels: &mut Labels) {
        let given = |list: &Vec<String>| (!list.is_empty()).then(|| list.clone());
        labels.title = self.title.clone().or(labels.title.take());
        labels.names = given(&self.label).unwrap_or(std::mem::take(&mut labels.names));
        labels.x = self.x_label.clone().or(labels.x.take());
        labels.y = given(&self.y_label).unwrap_or(std::mem::take(&mut labels.y));
        if let Some(log) = &self.log {
            labels.is_log = ["x", "y"].map(|axis| log.contains(axis));
        }
        labels.y_range = self.y_range.or(labels.y_range);
    }

    /// The form in which `output` is written; `had_text` says whether the figure that is drawn again had text as text.
    fn format(&self, output: &Path, had_text: bool) -> anyhow::Result<Format> {
        match (Format::of(output)?, self.text) {
            (Format::Svg, text) if text || had_text => Ok(Format::SvgText),
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

/// A width in mm: 86mm, 8.6cm or 86.
fn width(text: &str) -> Result<f64, String> {
    let (number, unit) = match (text.strip_suffix("mm"), text.strip_suffix("cm")) {
        (Some(number), _) => (number, 1.0),
        (_, Some(number)) => (number, 10.0),
        _ => (text, 1.0),
    };
    let width_mm = number.trim().parse().map(|number: f64| number * unit);
    match width_mm {
        Ok(width_mm) if WIDTHS_MM.contains(&width_mm) => Ok(width_mm),
        _ => Err(format!(
            "must be a width such as 86mm, from {}mm to {}mm",
            WIDTHS_MM.start(),
            WIDTHS_MM.end()
        )),
    }
}

pub(super) fn figure(args: &FigureArgs) -> anyhow::Result<ExitCode> {
    args.labels.format(&args.output, false)?;
    let (source, had_text) = source(args)?;
    let format = args.labels.format(&args.output, had_text)?;
    let (output, interruption) = progress::open_for(&args.output, args.force)?;
    for line in said(&source) {
        tell(format_args!("gyrolab: {line}"));
    }
    let figure = source.draw(interruption.meter());
    let figure = figure.map_err(anyhow::Error::msg)?.ok_or(Interrupted)?;
    output.write_and_keep(&source.write(&figure.scene, format)?)?;
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

/// What is said before the figure is drawn.
fn said(source: &Source) -> Vec<String> {
    let mut said = Vec::new();
    if let Source::Runs(runs, _) = source {
        for run in runs.iter().filter(|run| run.named.ends_with(".csv")) {
            said.push(format!(
                "{}: its {} steps are computed anew from its header",
                printable(&run.named),
                run.scenario.steps
            ));
        }
    }
    for file in source.origin(Format::Svg).left_behind() {
        said.push(format!(
            "{}: longer than 1 MB when compressed, it does not travel with the figure: keep it beside",
            printable(file)
        ));
    }
    said
}

/// What a RUN of the command line names.
enum Named {
    Table(Table),
    Run(Document),
    Figure(Source, bool),
}

fn named(name: &str) -> anyhow::Result<Named> {
    let path = Path::new(name);
    if let Some(table) = Table::read(path)? {
        return Ok(Named::Table(table));
    }
    if is_file(name) && !Destination::may_wait(path) {
        let refused = |rule: String| Problems::one(name, Problem::at("", rule));
        if let Some(figure) = origin::Figure::open(path).map_err(refused)? {
            let folder = path.parent().unwrap_or(Path::new(""));
            let source = Source::of(&figure.origin, folder);
            let (source, text) = source.map_err(|problems| problems.of(name))?;
            return Ok(Named::Figure(source, text));
        }
    }
    Ok(Named::Run(Document::open(name)?))
}

/// What is drawn, and whether it was drawn before with text as text.
fn source(args: &FigureArgs) -> anyhow::Result<(Source, bool)> {
    let (mut documents, mut tables) = (Vec::new(), Vec::new());
    let mut before: Option<(Request, bool)> = None;
    for name in &args.runs {
        match named(name)? {
            Named::Run(document) => documents.push((origin::name_of(name), document)),
            Named::Table(table) => {
                let asked = OfTable {
                    kind: None,
                    width_pt: COLUMN_PT,
                    labels: Labels::default(),
                };
                tables.push((table, asked, false));
            }
            Named::Figure(Source::Table(table, asked), text) => tables.push((table, asked, text)),
            Named::Figure(Source::Runs(runs, request), text) => {
                for run in runs {
                    let document = Document::from_file(&run.named, &run.scenario.file)?;
                    documents.push((run.named, document));
                }
                before.get_or_insert((request, text));
            }
        }
    }
    match (tables.pop(), args.runs.len()) {
        (None, _) => {
            let (request, text) = before.unwrap_or_default();
            let mut request = asked(args, request)?;
            let runs = runs(args, documents)?;
            if args.labels.label.is_empty() && request.labels.names.len() != runs.len() {
                request.labels.names.clear(); // those of the figure are of other runs
            }
            let named = request.labels.names.len();
            ensure!(
                named == 0 || named == runs.len(),
                "--label is given {named} times for {} runs: give it once per run, in order",
                runs.len()
            );
            Ok((Source::Runs(runs, request), text))
        }
        (Some(_), 2..) => {
            bail!("the table of a comparison, of a sweep or of a fit is drawn alone: give one file")
        }
        (Some((table, mut asked, text)), _) => {
            refuse_for_table(args)?;
            asked.kind = args.kind.clone().or(asked.kind);
            asked.width_pt = args.width.map_or(asked.width_pt, |mm| mm * PT_PER_MM);
            args.labels.change(&mut asked.labels);
            Ok((Source::Table(table, asked), text))
        }
    }
}

fn refuse_for_table(args: &FigureArgs) -> anyhow::Result<()> {
    let is_changed = args.exact
        || args.from.or(args.to).is_some()
        || args.measured.is_some()
        || !args.schemes.is_empty()
        || !args.labels.label.is_empty()
        || args.changes.is_some()
        || args.length.is_some();
    ensure!(
        !is_changed,
        "{}: the numbers of a table are drawn as they are: of a figure's options, --kind, --width, --force, --title, --text and those of its axes are for it",
        args.runs[0]
    );
    Ok(())
}

/// What is asked for: `before` with what the command line changes in it.
fn asked(args: &FigureArgs, before: Request) -> anyhow::Result<Request> {
    let mut request = before;
    let kind = args.kind.as_deref().map(Kind::named).transpose();
    let kind = kind.unwrap_or_else(|refusal| no_kind(args, &refusal));
    if let Some(name) = &args.measured {
        let measured = data::open(name)?;
        if let Some(left_out) = measured.left_out_in_words() {
            tell(format_args!("gyrolab: {left_out}"));
        }
        request.kind = Kind::measured(measured.series()?);
        request.measured = Some(Arc::new(measured));
    }
    request.kind = kind.unwrap_or(request.kind);
    request.from_s = args.from.unwrap_or(request.from_s);
    request.to_s = args.to.or(request.to_s);
    request.exact |= args.exact;
    request.width_pt = args.width.map_or(request.width_pt, |mm| mm * PT_PER_MM);
    args.labels.change(&mut request.labels);
    Ok(request)
}

/// Refuses `--kind` as clap refuses a value.
fn no_kind(args: &FigureArgs, refusal: &str) -> ! {
    let kind = printable(args.kind.as_deref().unwrap_or_default());
    let message = format!("invalid value '{kind}' for '--kind <KIND>': {refusal}");
    refuse("figure", ErrorKind::ValueValidation, &message)
}

/// Every run of `documents`, by every scheme that is named.
fn runs(args: &FigureArgs, documents: Vec<(String, Document)>) -> anyhow::Result<Vec<Run>> {
    let mut runs = Vec::new();
    for (named, document) in documents {
        let by_scheme = args.schemes.iter().map(Some);
        let as_it_is = args.schemes.is_empty().then_some(None);
        for scheme in by_scheme.chain(as_it_is) {
            let mut changes = args.changes.clone();
            changes.scheme = scheme.cloned().or(changes.scheme);
            let scenario = changed(document.clone(), &changes, &args.length)?;
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
