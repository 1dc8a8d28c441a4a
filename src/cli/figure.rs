//! `gyrolab figure`: runs, or a table of runs, drawn on paper.

use super::args::{LengthArgs, MapArgs, SetArgs, changed};
use super::argument_values::{positive, time};
use super::progress::{self, Interrupted};
use super::writeup::measured;
use super::{ended_by, refuse, tell, tell_notes, warn};
use crate::engine::analysis::cost;
use crate::engine::data::doubts;
use crate::engine::export::columns::DISTANCE;
use crate::engine::provenance;
use crate::engine::scenario::head::is_file;
use crate::engine::scenario::{Document, Problem, Problems};
use crate::engine::text::printable::{PrintablePath, printable};
use crate::physics::scheme;
use crate::plot::chart::MOST_CURVES;
use crate::plot::{PT_PER_MM, PageFormat};
use crate::report::figure::kind::{ERROR, FIGURE_KIND_NAMES, FigureKind};
use crate::report::figure::of_runs::FigureRun;
use crate::report::figure::of_table::TABLE_KIND_NAMES;
use crate::report::figure::{
    FONT_SIZES_PT, FigureSource, FigureSpec, PAGE_STYLE_NAMES, PageStyle, WIDTHS_MM,
};
use crate::studies::sweep::{TIME_STEP, axis};
use crate::studies::table::TableSource;
use anyhow::{bail, ensure};
use clap::Args;
use clap::builder::PossibleValuesParser;
use clap::error::ErrorKind;
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::sync::Arc;
use toml::Value;

#[derive(Debug, Args)]
pub(super) struct FigureArgs {
    /// Presets' names, or files: what gyrolab run takes, or the CSV of compare, of a sweep or of a fit
    ///
    /// Of a figure its own options hold where none is given. Of compare the slope is told where the error falls evenly over
    /// three time steps or more.
    #[arg(required = true, value_name = "RUN")]
    pub(super) runs: Vec<String>,

    /// Write the figure to this file; its name's end says in which form: .svg, .pdf or .png (600 dpi)
    #[arg(short, long, value_name = "FILE")]
    output: PathBuf,

    #[arg(long, value_name = "KIND", help = kind_help(), long_help = long_kind_help())]
    kind: Option<String>,

    /// Draw a table over this column: a key that varied, or a readout
    #[arg(long, value_name = "COLUMN")]
    x: Option<String>,

    /// Draw these columns of a table, as --kind COLUMN,... does; with --kind map as colors
    #[arg(long, value_name = "COLUMN,...", value_delimiter = ',')]
    y: Vec<String>,

    /// Show this range of the axis below of a table, such as 0..1
    #[arg(long, value_name = "A..B", allow_hyphen_values = true, value_parser = range)]
    x_range: Option<(f64, f64)>,

    /// Begin at this time of the run, s
    #[arg(long, value_name = "S", allow_negative_numbers = true, value_parser = time)]
    from: Option<f64>,

    /// End at this time of the run, s
    #[arg(long, value_name = "S", allow_negative_numbers = true, value_parser = positive)]
    to: Option<f64>,

    /// Draw the exact motion too, as a dashed line on top of the runs
    #[arg(long)]
    exact: bool,

    /// Draw measured data with it: a CSV with a column t_s, or data that come with gyrolab (heidelberg-spin-decay)
    #[arg(long, value_name = "FILE")]
    measured: Option<String>,

    #[command(flatten)]
    columns: MapArgs,

    /// Width of the page: 86mm for a column, 178mm for a page [default: 86mm]
    #[arg(long, value_name = "MM", value_parser = width)]
    width: Option<f64>,

    /// Draw the run by each of these schemes
    #[arg(long, value_name = "A,B", value_delimiter = ',', conflicts_with = "scheme", value_parser = PossibleValuesParser::new(scheme::names()))]
    schemes: Vec<String>,

    /// Draw the run with each of these values of a key, or with N from A to B; may be repeated
    #[arg(long, value_name = "KEY=V1,V2|A..B:N")]
    vary: Vec<String>,

    #[command(flatten)]
    labels: LabelArgs,

    #[command(flatten)]
    changes: SetArgs,

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

    /// Make these axes logarithmic: x, y, or z for the colors of a map, or several of them
    #[arg(long, value_name = "AXES", value_parser = axes)]
    log: Option<String>,

    /// Show this range of the axis at the left, such as 0..1, or of one panel, such as z_m=0..1; may be repeated
    #[arg(long, value_name = "[NAME=]A..B", allow_hyphen_values = true, value_parser = panel_range)]
    y_range: Vec<(Option<String>, (f64, f64))>,

    /// Height of the page [default: as the figure needs it]
    #[arg(long, value_name = "MM", value_parser = width)]
    height: Option<f64>,

    /// Size of the axis titles, pt; other letters, lines and marks change with it [default: 8]
    #[arg(long, value_name = "PT", value_parser = font_size)]
    font_size: Option<f64>,

    /// Make the figure for a paper, or for a slide: 254mm x 143mm with letters of 18 pt [default: paper]
    #[arg(long, value_name = "STYLE", value_parser = PossibleValuesParser::new(PAGE_STYLE_NAMES))]
    style: Option<String>,

    /// Write numbers with a decimal comma: 0,5
    #[arg(long)]
    decimal_comma: bool,

    /// In SVG write text as text, in the reader's fonts: it can be selected [default: outlines]
    #[arg(long)]
    text: bool,
}

impl LabelArgs {
    /// The form in which `output` is written.
    fn format(&self, output: &Path) -> anyhow::Result<PageFormat> {
        match (PageFormat::from_path(output)?, self.text) {
            (PageFormat::Svg, true) => Ok(PageFormat::SvgText),
            (_, true) => {
                bail!("--text is for .svg: the words of a .pdf can be selected as they are")
            }
            (format, false) => Ok(format),
        }
    }
}

fn kind_help() -> String {
    let kinds = FIGURE_KIND_NAMES.join(", ");
    let of_tables = TABLE_KIND_NAMES.join(", ");
    format!(
        "What to draw: {kinds}, or columns with commas between them; of a table {of_tables}, or columns"
    )
}

fn long_kind_help() -> String {
    format!(
        "{}\n\nTraces are x, y, z over time, residuals are measured less run, columns are those of the CSV, over time \
         [default: traces, or with --measured what was measured].",
        kind_help()
    )
}

/// Axes, each at most once: x, xy.
fn axes(text: &str) -> Result<String, String> {
    let is_axis = |axis: char| "xyz".contains(axis) && text.matches(axis).count() == 1;
    if text.is_empty() || !text.chars().all(is_axis) {
        return Err("must be x, y or z, or several of them, such as xy".to_owned());
    }
    Ok(text.to_owned())
}

/// Two numbers, the lower one first: 0..1.
fn range(text: &str) -> Result<(f64, f64), String> {
    let ends = text
        .split_once("..")
        .and_then(|(low, high)| {
            let end = |part: &str| part.trim().parse().ok().filter(|end: &f64| end.is_finite());
            Some((end(low)?, end(high)?))
        })
        .filter(|(low, high)| low < high && (high - low).is_finite());
    ends.ok_or_else(|| "must be two numbers, the lower one first, such as 0..1".to_owned())
}

/// A range of one panel or of all: z_m=0..1, 0..1.
fn panel_range(text: &str) -> Result<(Option<String>, (f64, f64)), String> {
    match text.split_once('=') {
        Some((name, text)) => Ok((Some(name.trim().to_owned()), range(text)?)),
        None => Ok((None, range(text)?)),
    }
}

/// A size of letters in pt: 8 or 8pt.
fn font_size(text: &str) -> Result<f64, String> {
    let number = text.strip_suffix("pt").unwrap_or(text).trim().parse();
    number
        .ok()
        .filter(|pt| FONT_SIZES_PT.contains(pt))
        .ok_or_else(|| {
            format!(
                "must be a size of letters such as 8, from {} to {} pt",
                FONT_SIZES_PT.start(),
                FONT_SIZES_PT.end()
            )
        })
}

/// A length in mm: 86mm, 8.6cm or 86.
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
            "must be a length such as 86mm, from {}mm to {}mm",
            WIDTHS_MM.start(),
            WIDTHS_MM.end()
        )),
    }
}

pub(super) fn figure(args: &FigureArgs) -> anyhow::Result<ExitCode> {
    let mut format = args.labels.format(&args.output)?;
    let source = read_source(args)?;
    if format == PageFormat::Svg && source.spec.text {
        format = PageFormat::SvgText;
    }
    let (output, interruption) = progress::open_for(&args.output, args.force)?;
    for line in said(&source) {
        tell(format_args!("gyrolab: {line}"));
    }
    let figure = source
        .draw(interruption.meter())
        .map_err(anyhow::Error::msg)?
        .ok_or(Interrupted)?;
    let bytes = progress::with_clock("writing the figure", || source.write(&figure.scene, format))?;
    interruption.keep(output, &bytes)?;
    for warning in figure.told() {
        warn(format_args!("gyrolab: {warning}"));
    }
    let mm = |pt: f64| (pt / PT_PER_MM).round();
    tell(format_args!(
        "gyrolab: {} mm x {} mm in {}",
        mm(figure.scene.width_pt),
        mm(figure.scene.height_pt),
        PrintablePath(&args.output)
    ));
    Ok(ended_by(figure.broke.map(anyhow::Error::msg)))
}

/// What is said before the figure is drawn.
fn said(source: &FigureSource) -> Vec<String> {
    let from_csv = source.runs.iter().filter(|run| run.named.ends_with(".csv"));
    let computed = from_csv.map(|run| {
        let (named, steps) = (printable(&run.named), run.scenario.steps);
        format!("{named}: its {steps} steps are computed anew from its header")
    });
    let files = source.origin(PageFormat::Svg).files.into_iter();
    let left_behind = files.filter(|file| file.sha256.is_some()).map(|file| {
        let name = printable(&file.name);
        format!("{name}: more than 1 MB when compressed, it does not travel with the figure: keep it beside")
    });
    computed.chain(left_behind).collect()
}

/// What the RUNs name, with what the command line changes.
pub(super) fn read_source(args: &FigureArgs) -> anyhow::Result<FigureSource> {
    let mut source = FigureSource::default();
    for name in &args.runs {
        add(&mut source, name, args)?;
    }
    if source.table.is_some() {
        refuse_for_table(args)?;
    } else {
        refuse_for_runs(args)?;
        if let Some(kind) = &args.kind {
            FigureKind::named(kind).unwrap_or_else(|refusal| no_kind(args, &refusal));
        }
    }
    if let Some(name) = &args.measured {
        let data = measured(name, &args.columns)?;
        if let Some(run) = source.runs.first() {
            tell_notes(&doubts(&data, &run.scenario));
        }
        source.measured = Some(Arc::new(data));
        (source.spec.measured_until_s, source.spec.kind) = (None, None);
    }
    let spec = &mut source.spec;
    if spec.labels.names.len() != source.runs.len() {
        spec.labels.names.clear(); // those of a figure are of other runs
    }
    ask(args, spec);
    let kind = spec.kind.as_deref().unwrap_or_default();
    let shows_error = kind == ERROR || kind.split(',').any(|name| name.trim() == DISTANCE);
    ensure!(
        !(spec.exact && kind == ERROR),
        "--kind error shows the distance from the exact motion: --exact adds nothing to it"
    );
    for run in source.runs.iter().filter(|_| spec.exact || shows_error) {
        if let Some(why) = cost::why_exact_unavailable(&run.scenario) {
            let option = if spec.exact { "--exact" } else { kind };
            bail!(
                "{}: {why}: leave {option} out, or give a shorter --duration",
                run.named
            );
        }
    }
    source.check()?;
    Ok(source)
}

/// The figure of a `table` that no file holds yet.
pub(super) fn of_table(args: &FigureArgs, table: TableSource) -> anyhow::Result<FigureSource> {
    refuse_for_table(args)?;
    let mut source = FigureSource {
        table: Some(table),
        ..FigureSource::default()
    };
    ask(args, &mut source.spec);
    source.check()?;
    Ok(source)
}

/// Adds to `source` what a RUN of the command line names.
fn add(source: &mut FigureSource, name: &str, args: &FigureArgs) -> anyhow::Result<()> {
    let path = Path::new(name);
    if let Some(table) = TableSource::read(path)? {
        source.table = Some(table);
        return Ok(());
    }
    let figure_file = if is_file(name) {
        provenance::FigureFile::open(path)
            .map_err(|rule| Problems::one(name, Problem::at("", rule)))?
    } else {
        None
    };
    let Some(figure) = figure_file else {
        return add_runs(
            source,
            &provenance::name_of(name),
            &Document::open(name)?,
            args,
        );
    };
    let folder = path.parent().unwrap_or(Path::new(""));
    let one = FigureSource::from_origin(&figure.origin, folder)
        .map_err(|problems| problems.in_file(name))?;
    for run in one.runs {
        let document = Document::from_file(&run.named, &run.scenario.file)?;
        add_runs(source, &run.named, &document, args)?;
    }
    source.measured = source.measured.take().or(one.measured);
    source.table = source.table.take().or(one.table);
    source.spec = one.spec;
    Ok(())
}

/// Adds the run of `document`, changed, by every scheme and with every value of the keys that vary.
fn add_runs(
    source: &mut FigureSource,
    named: &str,
    document: &Document,
    args: &FigureArgs,
) -> anyhow::Result<()> {
    let by_scheme = args.schemes.iter().map(Some);
    let as_it_is = args.schemes.is_empty().then_some(None);
    for scheme in by_scheme.chain(as_it_is) {
        let mut changes = args.changes.clone();
        changes.scheme = scheme.cloned().or(changes.scheme);
        for values in combinations(&args.vary)? {
            let mut varied = changes.clone();
            for (key, value) in values {
                if key == TIME_STEP {
                    // As --time-step does: pushes and the run keep their seconds.
                    varied.time_step = value.as_float();
                } else {
                    varied.set.push(format!("{key}={value}"));
                }
            }
            source.runs.push(FigureRun {
                scenario: Arc::new(changed(document.clone(), &varied, &args.length)?),
                named: named.to_owned(),
            });
            ensure!(
                source.runs.len() <= MOST_CURVES,
                "more than {MOST_CURVES} runs: a figure tells no more apart; gyrolab sweep takes many"
            );
        }
    }
    Ok(())
}

/// Returns what to `--set` for each combination of the values that `vary`, arguments of `--vary`, names.
fn combinations(vary: &[String]) -> anyhow::Result<Vec<Vec<(String, Value)>>> {
    let mut all = vec![Vec::new()];
    for argument in vary {
        let axis = axis::axis(argument)?;
        let mut longer = Vec::new();
        for before in &all {
            for values in axis.points.iter().take(MOST_CURVES + 1) {
                let mut all_values: Vec<(String, Value)> = before.clone();
                let pairs = axis.keys.iter().cloned().zip(values.iter().cloned());
                all_values.extend(pairs);
                longer.push(all_values);
            }
        }
        longer.truncate(MOST_CURVES + 1); // more are refused
        all = longer;
    }
    Ok(all)
}

/// Writes what the command line asks for over `spec`.
fn ask(args: &FigureArgs, spec: &mut FigureSpec) {
    spec.kind = args.kind.clone().or(spec.kind.take());
    spec.x = args.x.clone().or(spec.x.take());
    if !args.y.is_empty() {
        spec.y.clone_from(&args.y);
    }
    spec.x_range = args.x_range.or(spec.x_range);
    spec.from_s = args.from.unwrap_or(spec.from_s);
    spec.to_s = args.to.or(spec.to_s);
    spec.exact |= args.exact;
    spec.text |= args.labels.text;
    spec.width_pt = args.width.map(|mm| mm * PT_PER_MM).or(spec.width_pt);
    spec.height_pt = args
        .labels
        .height
        .map(|mm| mm * PT_PER_MM)
        .or(spec.height_pt);
    spec.font_pt = args.labels.font_size.or(spec.font_pt);
    let style = args.labels.style.as_deref().and_then(PageStyle::named);
    spec.style = style.unwrap_or(spec.style);
    spec.decimal_comma |= args.labels.decimal_comma;
    let (given, labels) = (&args.labels, &mut spec.labels);
    labels.title = given.title.clone().or(labels.title.take());
    labels.x = given.x_label.clone().or(labels.x.take());
    for (texts, list) in [
        (&given.label, &mut labels.names),
        (&given.y_label, &mut labels.y),
    ] {
        if !texts.is_empty() {
            list.clone_from(texts);
        }
    }
    if let Some(log) = &given.log {
        labels.is_log = ["x", "y"].map(|axis| log.contains(axis));
        labels.is_log_color = log.contains('z');
    }
    for (name, range) in &given.y_range {
        match name {
            Some(name) => {
                labels.y_ranges.insert(name.clone(), *range);
            }
            None => labels.y_range = Some(*range),
        }
    }
}

fn refuse_for_table(args: &FigureArgs) -> anyhow::Result<()> {
    ensure!(
        args.runs.len() == 1,
        "the table of a comparison, of a sweep or of a fit is drawn alone: give one file"
    );
    let is_changed = args.exact
        || args.from.or(args.to).is_some()
        || args.measured.is_some()
        || !args.schemes.is_empty()
        || !args.vary.is_empty()
        || !args.labels.label.is_empty()
        || args.changes.is_some()
        || args.length.is_some();
    ensure!(
        !is_changed,
        "{}: the numbers of a table are drawn as they are: of a figure's options, --kind, --x, --y, --x-range, --width, --force, --title, --text and those of its axes are for it",
        args.runs[0]
    );
    Ok(())
}

fn refuse_for_runs(args: &FigureArgs) -> anyhow::Result<()> {
    ensure!(
        args.x.is_none() && args.y.is_empty(),
        "{}: --x and --y are for tables, such as the CSV of a sweep: --kind COLUMN,... draws columns of a run over time",
        args.runs[0]
    );
    ensure!(
        args.x_range.is_none(),
        "{}: --x-range is for tables: --from and --to choose a time of a run",
        args.runs[0]
    );
    Ok(())
}

/// Refuses `--kind` as clap refuses a value.
fn no_kind(args: &FigureArgs, refusal: &str) -> ! {
    let kind = printable(args.kind.as_deref().unwrap_or_default());
    let message = format!("invalid value '{kind}' for '--kind <KIND>': {refusal}");
    refuse("figure", ErrorKind::ValueValidation, &message)
}
