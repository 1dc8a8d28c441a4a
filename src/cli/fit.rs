//! `gyrolab fit`: finds values of scenario keys whose runs come closest to measured data.

pub(super) mod again;
mod throws;

use super::args::{LengthArgs, MapArgs, STDIN, STDIN_WORDS, SetArgs, change, change_length, open};
use super::argument_values::{positive, time};
use super::progress::{self, Interrupted, Interruption, Meter};
use super::{one_on_stdout, print, print_result, refuse, tell_notes, tell_of_rows, warn};
use crate::engine::data::{self, DataKind, MeasuredData};
use crate::engine::export::Destination;
use crate::engine::scenario::{Document, Problem, Problems, csv};
use crate::engine::text::number::significant;
use crate::engine::text::printable::{PrintablePath, brief, printable};
use crate::studies::fit::flights::{self, Found};
use crate::studies::fit::report::FitReport;
use crate::studies::fit::{Fit, Free, Model, NoFit, fit as fitted, thrown};
use again::write;
use anyhow::{Context, bail};
use clap::Args;
use clap::error::ErrorKind;
use serde_json::json;
use std::io;
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use throws::{Throw, Thrown};
use toml::Value;

#[derive(Clone, Debug, Args)]
pub(super) struct FitArgs {
    /// Measured data: a CSV file (a time series or a table of runs), - for stdin, or shipped data such as
    /// heidelberg-precession
    pub(super) measured: String,

    /// The scenario to fit: a preset's name, a file (.toml or .csv), or - for stdin
    #[arg(long = "in", value_name = "SCENARIO")]
    pub(super) scenario: String,

    /// The keys to fit, each starting from its value in the scenario, optionally within FROM..TO [default for a thrown
    /// body: two of its moments, and its three rates at the start]
    #[arg(long, value_name = "KEY[=FROM..TO],...", value_delimiter = ',')]
    pub(super) free: Vec<String>,

    #[command(flatten)]
    pub(super) changes: SetArgs,

    #[command(flatten)]
    pub(super) length: LengthArgs,

    #[command(flatten)]
    pub(super) columns: MapArgs,

    /// Fit only these rows of the data, counted from 1, such as 1,3,5-8
    #[arg(long, value_name = "ROWS")]
    pub(super) rows: Option<RowRange>,

    /// Fit only this free flight of a recording of throws, counted from 1 [default without --from and --to: every
    /// flight]
    #[arg(long, value_name = "N", conflicts_with_all = ["rows", "from", "to"], value_parser = clap::value_parser!(u64).range(1..))]
    pub(super) flight: Option<u64>,

    /// Start at this time of the recording, s, which becomes t = 0 of the run, without a search for flights
    #[arg(long, value_name = "S", conflicts_with = "rows", value_parser = time)]
    pub(super) from: Option<f64>,

    /// End at this time of the recording, s, without a search for flights
    #[arg(long, value_name = "S", conflicts_with = "rows", value_parser = positive)]
    pub(super) to: Option<f64>,

    /// Write data, model and residuals as CSV to this file, or to stdout for -; gyrolab figure draws the file
    #[arg(short, long, value_name = "FILE")]
    pub(super) output: Option<PathBuf>,

    /// Print the result as one JSON object
    #[arg(long)]
    pub(super) json: bool,

    /// Replace an existing file
    #[arg(long)]
    pub(super) force: bool,
}

/// Rows of the data, counted from 1, as typed.
#[derive(Clone, Debug)]
pub(super) struct RowRange {
    text: String,
    ranges: Vec<(usize, usize)>,
}

impl std::str::FromStr for RowRange {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let number = |part: &str| part.trim().parse().ok().filter(|&row: &usize| row > 0);
        let ranges: Option<Vec<_>> = text
            .split(',')
            .map(|part| {
                let (first, last) = part.split_once('-').unwrap_or((part, part));
                let (first, last) = (number(first)?, number(last)?);
                (first <= last).then_some((first, last))
            })
            .collect();
        Ok(Self {
            text: text.to_owned(),
            ranges: ranges
                .ok_or_else(|| "must be rows counted from 1, such as 1,3,5-8".to_owned())?,
        })
    }
}

/// The scheme of the fitted runs if none is named. It follows the true motion, without errors of the time step.
const FITTED_SCHEME: &str = "exact";

pub(super) fn fit(args: &FitArgs) -> anyhow::Result<ExitCode> {
    one_on_stdout("fit", args.output.as_deref(), args.json);
    if args.measured == STDIN && args.scenario == STDIN {
        let message = "only one of the data and the scenario can be read from standard input";
        refuse("fit", ErrorKind::ArgumentConflict, message);
    }
    let task = Task::read(args)?;
    tell_notes(&task.measured.notes());
    let Some(keys) = task.usual_keys()?.filter(|_| args.free.is_empty()) else {
        if args.free.is_empty() {
            let message = "name the keys to fit with --free KEY,...; only a recording of a thrown body has default keys";
            refuse("fit", ErrorKind::MissingRequiredArgument, message);
        }
        return fit_all(args, &task);
    };
    let free = keys.map(str::to_owned).into();
    fit_all(
        &FitArgs {
            free,
            ..args.clone()
        },
        &task,
    )
}

/// Fits each flight of the recording, or the whole recording.
fn fit_all(args: &FitArgs, task: &Task) -> anyhow::Result<ExitCode> {
    let Some(throws) = task.throws(args)? else {
        return fit_one(args, task, None);
    };
    if let [throw] = &throws[..] {
        return fit_one(&throw.args(args), task, Some(throw));
    }
    if args.output.is_some() {
        bail!(
            "{} has {} free flights, but -o holds only one fit: choose a flight with --flight N\n{}",
            args.measured,
            throws.len(),
            throws
                .iter()
                .map(Throw::to_string)
                .collect::<Vec<_>>()
                .join("\n")
        );
    }
    fit_each(args, task, &throws)
}

/// Fits each of the `throws`. Prints an error for a flight that cannot be fitted, and continues.
fn fit_each(args: &FitArgs, task: &Task, throws: &[Throw]) -> anyhow::Result<ExitCode> {
    let (_, interruption) = progress::open(None, false)?;
    if !args.json {
        let list: String = throws.iter().map(|throw| format!("  {throw}\n")).collect();
        let count = throws.len();
        print(&format!(
            "{count} free flights in {}:\n{list}",
            printable(&args.measured)
        ))?;
    }
    let (mut all, mut code) = (Vec::new(), ExitCode::SUCCESS);
    for throw in throws {
        let of_throw = task.model(args, Some(throw));
        let fitted = of_throw.map_err(anyhow::Error::new).and_then(|model| {
            tell_notes(&model.doubts());
            let fit = task.found(args, &model, &interruption)?;
            Ok((model, fit))
        });
        match fitted {
            Ok((model, fit)) => {
                let report = FitReport {
                    fit: &fit,
                    model: &model,
                    instead_of: task.other_scheme(&model),
                };
                let thrown = Thrown {
                    report,
                    throw: Some(throw),
                };
                if args.json {
                    all.push(thrown.json()?);
                } else {
                    print(&format!("\n{thrown}\n"))?;
                }
            }
            Err(error) if error.is::<Interrupted>() => return Err(error),
            Err(error) => {
                code = ExitCode::FAILURE;
                all.push(json!({ "flight": throw.json(), "error": format!("{error:#}") }));
                warn(format_args!("gyrolab: flight {}: {error:#}", throw.number));
            }
        }
    }
    if args.json {
        print(&format!("{}\n", json!({ "flights": all })))?;
    }
    interruption.may_act_at_once()?;
    Ok(code)
}

fn fit_one(args: &FitArgs, task: &Task, throw: Option<&Throw>) -> anyhow::Result<ExitCode> {
    let model = task.model(args, throw)?;
    tell_notes(&model.doubts());
    let (output, interruption) = progress::open(args.output.as_deref(), args.force)?;
    let found = task.found(args, &model, &interruption)?;
    let report = FitReport {
        fit: &found,
        model: &model,
        instead_of: task.other_scheme(&model),
    };
    if let Some(mut output) = output {
        let path = args.output.as_deref().unwrap_or(Path::new("the output"));
        let cannot_write = || format!("cannot write {}", PrintablePath(path));
        write(&mut output, &report, args).with_context(cannot_write)?;
        interruption.may_keep()?;
        output.keep().with_context(cannot_write)?;
    }
    interruption.may_act_at_once()?;
    tell_of(&Thrown { report, throw }, args)
}

/// The data and the scenario of a fit, before a flight is chosen.
struct Task {
    /// The rows that --rows, --from and --to select.
    measured: MeasuredData,
    document: Document,
    /// The scenario's own scheme, if the command line names none.
    own_scheme: Option<&'static str>,
}

impl Task {
    fn read(args: &FitArgs) -> Result<Self, Problems> {
        let mut measured = chosen(measured(args)?, args.rows.as_ref())?;
        if args.from.or(args.to).is_some() {
            measured.series()?;
            let (from_s, to_s) = (args.from.unwrap_or(0.0), args.to.unwrap_or(f64::INFINITY));
            if !measured.keep_between(from_s, to_s) {
                let rule = "has no measured value between --from and --to";
                return Err(Problems::one(args.measured.clone(), Problem::at("", rule)));
            }
        }
        let (document, own_scheme) = scenario(args)?;
        Ok(Self {
            measured,
            document,
            own_scheme,
        })
    }

    /// Returns the keys that are free by default; `None` if the data are not a recording of a thrown body.
    fn usual_keys(&self) -> Result<Option<[&'static str; 5]>, Problems> {
        match &self.measured.data {
            DataKind::Series(series) => Ok(thrown::usual_keys(series, &self.document.scenario()?)),
            DataKind::Table(_) => Ok(None),
        }
    }

    /// Returns the flights to fit one by one; `None` if the whole recording is fitted.
    fn throws(&self, args: &FitArgs) -> Result<Option<Vec<Throw>>, Problems> {
        let is_asked = args.flight.is_some();
        if args.rows.is_some() || args.from.or(args.to).is_some() {
            return Ok(None);
        }
        let refused = |rule: String| Problems::one(args.measured.clone(), Problem::at("", rule));
        let found = match &self.measured.data {
            DataKind::Series(series) => flights::find(series, &self.document.scenario()?),
            DataKind::Table(_) => Found::NotThrown,
        };
        let flights = match found {
            Found::NotThrown if is_asked => {
                let rule = "--flight needs a recording of w1_rad_per_s, w2_rad_per_s and w3_rad_per_s, and a scenario of a body that flies freely, such as thrown-phone";
                return Err(refused(rule.to_owned()));
            }
            Found::Whole if args.flight.is_some_and(|number| number > 1) => {
                return Err(refused(
                    "is one free flight from start to end: omit --flight".to_owned(),
                ));
            }
            Found::NotThrown | Found::Whole => return Ok(None),
            Found::Flights(flights) => flights,
        };
        if flights.is_empty() {
            return Err(refused("has no free flight: the rates never stay above 2 rad/s for 0.2 s and change like the rates of a free body. Give the time of a flight with --from and --to; --from 0 alone fits the whole recording".to_owned()));
        }
        let of = flights.len();
        let throws =
            flights
                .into_iter()
                .zip(1..)
                .map(|(flight, number)| Throw { number, of, flight });
        let (chosen, others): (Vec<Throw>, Vec<Throw>) =
            throws.partition(|throw| args.flight.is_none_or(|it| it == throw.number as u64));
        if chosen.is_empty() {
            let list: Vec<String> = others.iter().map(Throw::to_string).collect();
            return Err(refused(format!(
                "has no free flight {}; choose one of these:\n{}",
                args.flight.unwrap_or_default(),
                list.join("\n")
            )));
        }
        Ok(Some(chosen))
    }

    /// Returns the model for the rows of `throw`, or for all rows.
    fn model(&self, args: &FitArgs, throw: Option<&Throw>) -> Result<Model, Problems> {
        let mut measured = self.measured.clone();
        if let Some(Throw { flight, .. }) = throw {
            measured.keep_between(flight.from_s, flight.to_s);
        }
        let keys = args
            .free
            .iter()
            .map(|argument| Free::parse(argument, &self.document));
        Model::new(
            &self.document,
            keys.collect::<Result<Vec<_>, _>>()?,
            measured,
        )
    }

    fn found(
        &self,
        args: &FitArgs,
        model: &Model,
        interruption: &Interruption,
    ) -> anyhow::Result<Fit> {
        let meter = Meter::counting("run");
        let found = fitted(model, &|| !interruption.has_come(), &|step, sum| {
            let (runs, sum) = (model.runs(), significant(sum, 4));
            meter.say(&format!("{runs} runs, step {step}, chi^2 {sum}"));
        });
        drop(meter);
        match found {
            Err(NoFit::Interrupted) => bail!(Interrupted),
            found => found.with_context(|| format!("{} in {}", args.measured, args.scenario)),
        }
    }

    /// Returns the scenario's own scheme, if the model uses another one.
    fn other_scheme(&self, model: &Model) -> Option<&'static str> {
        self.own_scheme.filter(|own| *own != model.scheme)
    }
}

fn measured(args: &FitArgs) -> Result<MeasuredData, Problems> {
    let options = args.columns.options();
    if args.measured != STDIN {
        return data::open_with(&args.measured, &options);
    }
    let text = csv::text_from(io::stdin().lock())
        .map_err(|problem| Problems::one(STDIN_WORDS, problem))?;
    data::read_with(STDIN_WORDS, &text, &options)
}

/// Returns the scenario with the changes of the command line, and its own scheme if the command line names none.
fn scenario(args: &FitArgs) -> Result<(Document, Option<&'static str>), Problems> {
    let mut document = open(&args.scenario)?;
    let mut own = None;
    if args.changes.scheme.is_none()
        && !args
            .changes
            .set
            .iter()
            .any(|set: &String| set.trim_start().starts_with("motion.scheme"))
    {
        // Checked first, so that errors are reported with the lines of the file.
        own = Some(document.scenario()?.motion.scheme.name);
        let written = document.set_value("motion.scheme", Value::String(FITTED_SCHEME.to_owned()));
        written.map_err(|problem| Problems::one(args.scenario.clone(), problem))?;
    }
    change(&mut document, &args.changes)?;
    change_length(&mut document, &args.length)?;
    document.scenario()?;
    Ok((document, own))
}

fn chosen(mut measured: MeasuredData, rows: Option<&RowRange>) -> Result<MeasuredData, Problems> {
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
            "there is no row {beyond}: the data have only {count}"
        )));
    }
    let kept = measured.keep_rows(|row| {
        let mut ranges = rows.ranges.iter();
        ranges.any(|(first, last)| (*first..=*last).contains(&(row + 1)))
    });
    if kept == 0 {
        return Err(refused("these rows contain no measured value".to_owned()));
    }
    Ok(measured)
}

/// Prints the result, and the path of the CSV.
fn tell_of(thrown: &Thrown<'_>, args: &FitArgs) -> anyhow::Result<ExitCode> {
    let output = args.output.as_deref();
    print_result(thrown, output, args.json)?;
    if let Some(path) = output.filter(|path| !Destination::is_for_stdout(path)) {
        tell_of_rows(thrown.report.fit.residuals.len() as u64, path);
    }
    Ok(ExitCode::SUCCESS)
}
