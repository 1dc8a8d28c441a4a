//! `gyrolab fit`: keys of a scenario, so that its runs come nearest to measured data.

use super::args::{Changes, MapArgs, STDIN, STDIN_WORDS, change, open, positive, time};
use super::progress::{self, Interrupted, Interruption, Meter};
use super::{one_on_stdout, print_result, refuse, tell_notes, tell_of_rows};
use crate::data::{self, Measured};
use crate::export::Destination;
use crate::fit::report::{self, Asked, Report};
use crate::fit::{Fit, Free, Model, NoFit, fit as fitted};
use crate::scenario::{Document, Problem, Problems, csv};
use crate::text::number::{shortest, significant};
use crate::text::printable::{Shown, brief};
use crate::verify::Unverified;
use anyhow::{Context, anyhow, bail};
use clap::error::ErrorKind;
use clap::{Args, FromArgMatches};
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use toml::Value;

#[derive(Debug, Args)]
pub(super) struct FitArgs {
    /// Measured data: a CSV file, a time series or a table of runs, - for stdin, or shipped data such as heidelberg-precession
    pub(super) measured: String,

    /// The scenario that is fitted: a preset's name, a file (.toml or .csv), or - for stdin
    #[arg(long = "in", value_name = "SCENARIO")]
    pub(super) scenario: String,

    /// The keys whose values are looked for, each from its value in the scenario on, and within FROM..TO where that is given
    #[arg(
        long,
        value_name = "KEY[=FROM..TO],...",
        value_delimiter = ',',
        required = true
    )]
    pub(super) free: Vec<String>,

    #[command(flatten)]
    pub(super) changes: Changes,

    #[command(flatten)]
    pub(super) columns: MapArgs,

    /// Fit these rows of the data alone, counted from 1, such as 1,3,5-8
    #[arg(long, value_name = "ROWS")]
    pub(super) rows: Option<Rows>,

    /// Begin at this time of the recording, s, which is the run's t = 0: of several throws, where one begins
    #[arg(long, value_name = "S", conflicts_with = "rows", value_parser = time)]
    pub(super) from: Option<f64>,

    /// End at this time of the recording, s
    #[arg(long, value_name = "S", conflicts_with = "rows", value_parser = positive)]
    pub(super) to: Option<f64>,

    /// Write data, model and residuals as CSV to this file, or to stdout for -; gyrolab figure draws it
    #[arg(short, long, value_name = "FILE")]
    pub(super) output: Option<PathBuf>,

    /// Give the result as one JSON object
    #[arg(long)]
    pub(super) json: bool,

    /// Replace an existing file
    #[arg(long)]
    pub(super) force: bool,
}

/// Rows of the data, counted from 1, as they were given.
#[derive(Clone, Debug)]
pub(super) struct Rows {
    text: String,
    ranges: Vec<(usize, usize)>,
}

impl std::str::FromStr for Rows {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let wrong = || "must be rows counted from 1, such as 1,3,5-8".to_owned();
        let number = |text: &str| text.trim().parse().ok().filter(|&row: &usize| row > 0);
        let range = |part: &str| {
            let (first, last) = part.split_once('-').unwrap_or((part, part));
            let (first, last) = (number(first)?, number(last)?);
            (first <= last).then_some((first, last))
        };
        let ranges: Option<Vec<_>> = text.split(',').map(range).collect();
        Ok(Self {
            text: text.to_owned(),
            ranges: ranges.ok_or_else(wrong)?,
        })
    }
}

/// What is fitted when nothing says by which scheme: the true motion, and not the artefacts of a time step.
const SCHEME: &str = "exact";

pub(super) fn fit(args: &FitArgs) -> anyhow::Result<ExitCode> {
    one_on_stdout("fit", args.output.as_deref(), args.json);
    if args.measured == STDIN && args.scenario == STDIN {
        let message = "only one of the data and the scenario can be read from standard input";
        refuse("fit", ErrorKind::ArgumentConflict, message);
    }
    let (model, own) = model(args)?;
    tell_notes(&model.measured.notes());
    tell_notes(&model.doubts());
    let (output, interruption) = progress::open(args.output.as_deref(), args.force)?;
    let meter = Meter::counting("run");
    let told = |step: u64, sum: f64| {
        let (runs, sum) = (model.runs(), significant(sum, 4));
        meter.say(&format!("{runs} runs, step {step}, chi^2 {sum}"));
    };
    let found = fitted(&model, &|| !interruption.has_come(), &told);
    drop(meter);
    let found = match found {
        Ok(found) => found,
        Err(NoFit::Interrupted) => bail!(Interrupted),
        Err(error) => {
            let what = format!("{} in {}", args.measured, args.scenario);
            return Err(anyhow::Error::new(error).context(what));
        }
    };
    let report = Report {
        fit: &found,
        model: &model,
        instead_of: own.filter(|own| *own != model.scheme),
    };
    if let Some(mut output) = output {
        let path = args.output.as_deref().unwrap_or(Path::new("the output"));
        let cannot_write = || format!("cannot write {}", Shown(path));
        write(&mut output, &report, args).with_context(cannot_write)?;
        interruption.may_keep()?;
        output.keep().with_context(cannot_write)?;
    }
    interruption.may_act_at_once()?;
    tell_of(&report, args)
}

/// The CSV of the fit that the command line `command` makes.
pub(super) fn again(command: &str, interruption: &Interruption) -> Result<Vec<u8>, Unverified> {
    let cannot = |why: String| Unverified::from(format!("cannot be recomputed: {why}"));
    let words = shlex::split(command).unwrap_or_default();
    let words = words
        .get(1..)
        .filter(|words| words.first().is_some_and(|word| word == "fit"));
    let line = FitArgs::augment_args(clap::Command::new("fit"));
    let matches = line.try_get_matches_from(words.unwrap_or_default());
    let args = matches.and_then(|matches| FitArgs::from_arg_matches(&matches));
    let Ok(args) = args else {
        let why = "the line command at its top is no command line of a fit";
        return Err(cannot(why.to_owned()));
    };
    if [&args.measured, &args.scenario].contains(&&STDIN.to_owned()) {
        return Err(cannot(
            "it was fitted to what stood on standard input, which no file holds".to_owned(),
        ));
    }
    let (model, _) = model(&args).map_err(|problems| cannot(problems.to_string()))?;
    let found = match fitted(&model, &|| !interruption.has_come(), &|_, _| {}) {
        Ok(found) => found,
        Err(NoFit::Interrupted) => return Err(Unverified::Stopped),
        Err(error) => return Err(cannot(error.to_string())),
    };
    let report = Report {
        fit: &found,
        model: &model,
        instead_of: None,
    };
    let mut csv = Vec::new();
    write(&mut csv, &report, &args).map_err(|error| cannot(error.to_string()))?;
    Ok(csv)
}

/// What is fitted, and the scenario's own scheme, where no other was asked for.
fn model(args: &FitArgs) -> Result<(Model, Option<&'static str>), Problems> {
    let measured = measured(args)?;
    let mut measured = chosen(measured, args.rows.as_ref())?;
    if args.from.or(args.to).is_some() {
        measured.series()?;
        let (from_s, to_s) = (args.from.unwrap_or(0.0), args.to.unwrap_or(f64::INFINITY));
        if !measured.keep_between(from_s, to_s) {
            let rule = "has no value measured in the time that --from and --to leave";
            return Err(Problems::one(args.measured.clone(), Problem::at("", rule)));
        }
    }
    let (document, own) = scenario(args)?;
    let keys = args.free.iter();
    let keys = keys.map(|argument| Free::parse(argument, &document));
    let keys = keys.collect::<Result<Vec<_>, _>>()?;
    Ok((Model::new(&document, keys, measured)?, own))
}

fn measured(args: &FitArgs) -> Result<Measured, Problems> {
    let options = args.columns.options();
    if args.measured != STDIN {
        return data::open_with(&args.measured, &options);
    }
    let text = csv::text_from(io::stdin().lock());
    let text = text.map_err(|problem| Problems::one(STDIN_WORDS, problem))?;
    data::read_with(STDIN_WORDS, &text, &options)
}

/// The scenario with all that the command line changes in it, and its own scheme, where no other was asked for.
fn scenario(args: &FitArgs) -> Result<(Document, Option<&'static str>), Problems> {
    let mut document = open(&args.scenario)?;
    let mut own = None;
    let sets_scheme = |set: &String| set.trim_start().starts_with("motion.scheme");
    if args.changes.scheme.is_none() && !args.changes.set.iter().any(sets_scheme) {
        // What is wrong with it is told as it stands in its file.
        own = Some(document.scenario()?.motion.scheme.name);
        let written = document.set_value("motion.scheme", Value::String(SCHEME.to_owned()));
        written.map_err(|problem| Problems::one(args.scenario.clone(), problem))?;
    }
    change(&mut document, &args.changes)?;
    document.scenario()?;
    Ok((document, own))
}

fn chosen(mut measured: Measured, rows: Option<&Rows>) -> Result<Measured, Problems> {
    let Some(rows) = rows else {
        return Ok(measured);
    };
    let count = measured.lines.len();
    let refused = |rule: String| {
        let mut problem = Problem::at("", rule);
        problem.place = Some(format!("--rows {}", brief(&rows.text, 80)));
        Problems::one("", problem)
    };
    if let Some((_, beyond)) = rows.ranges.iter().find(|(_, last)| *last > count) {
        return Err(refused(format!(
            "there is no row {beyond}: the data have {count}"
        )));
    }
    let has = |number| {
        let mut ranges = rows.ranges.iter();
        ranges.any(|(first, last)| (*first..=*last).contains(&number))
    };
    if measured.keep_rows(|row| has(row + 1)) == 0 {
        return Err(refused("these rows hold no measured value".to_owned()));
    }
    Ok(measured)
}

fn command(args: &FitArgs) -> String {
    let free = args.free.join(",");
    let mut words = vec!["gyrolab", "fit", &args.measured, "--in", &args.scenario];
    words.extend(["--free", &free]);
    words.extend(args.changes.set.iter().flat_map(|set| ["--set", set]));
    let map = args
        .columns
        .map
        .iter()
        .map(|(column, name)| format!("{column}={name}"));
    let map = map.collect::<Vec<_>>().join(",");
    let sigma = args.columns.sigma.iter().map(ToString::to_string);
    let sigma = sigma.collect::<Vec<_>>().join(",");
    let time_step = args.changes.time_step.map(shortest).unwrap_or_default();
    let [from, to] = [args.from, args.to].map(|it| it.map(shortest).unwrap_or_default());
    let rows = args.rows.as_ref().map_or("", |rows| &rows.text);
    let scheme = args.changes.scheme.as_deref().unwrap_or_default();
    for (option, value) in [
        ("--time-step", &*time_step),
        ("--scheme", scheme),
        ("--rows", rows),
        ("--from", &from),
        ("--to", &to),
        ("--map", &map),
        ("--sigma", &sigma),
    ] {
        if !value.is_empty() {
            words.extend([option, value]);
        }
    }
    // No argument of a command line holds the byte that cannot be quoted.
    shlex::try_join(words).unwrap_or_default()
}

fn write(output: impl Write, report: &Report<'_>, args: &FitArgs) -> anyhow::Result<()> {
    let Fit { keys, quality, .. } = report.fit;
    let values: Vec<f64> = keys.iter().map(|key| key.value).collect();
    let scenario = report.model.as_long_as_measured(&values);
    let scenario = scenario.map_err(|why| anyhow!(why))?;
    let asked = Asked {
        command: command(args),
        measured: args.measured.clone(),
        scenario: args.scenario.clone(),
        scheme: report.model.scheme.to_owned(),
        free: args.free.clone(),
        rows: args.rows.as_ref().map(|rows| rows.text.clone()),
        chi_squared: quality.chi_squared,
        degrees_of_freedom: quality.degrees_of_freedom,
        scatter: quality.scatter,
        verdict: report.fit.sentence(report.model),
    };
    Ok(report::write_csv(output, report, &scenario, asked)?)
}

/// The result, and where its rows are written.
fn tell_of(report: &Report<'_>, args: &FitArgs) -> anyhow::Result<ExitCode> {
    let output = args.output.as_deref();
    print_result(report, output, args.json)?;
    if let Some(path) = output.filter(|path| !Destination::is_for_stdout(path)) {
        tell_of_rows(report.fit.residuals.len() as u64, path);
    }
    Ok(ExitCode::SUCCESS)
}
