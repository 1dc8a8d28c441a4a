//! Fits that are made again: the CSV of a fit has its command in the header.

use super::{FitArgs, Task, measured};
use crate::cli::args::{STDIN, open};
use crate::cli::progress::Interruption;
use crate::engine::export::layout::above_run_file;
use crate::engine::scenario::Document;
use crate::engine::text::number::shortest;
use crate::report::writeup::DocumentFormats;
use crate::report::writeup::fit::{FIT_CSV, FitWriteup, SCENARIO_FILE};
use crate::report::writeup::measured::name_of_copy;
use crate::studies::fit::report::{self, FitCommand, FitReport, Header};
use crate::studies::fit::{Fit, Model, NoFit, fit as fitted};
use crate::studies::verify::Unverified;
use anyhow::anyhow;
use clap::{Args, FromArgMatches};
use std::fs;
use std::io::Write;
use std::path::Path;

/// The files of a write-up, each with its name and its bytes.
type NamedFiles = Vec<(String, Vec<u8>)>;

/// Returns the CSV of the fit that the command line `command` makes. Its files are looked for in `folder` first.
pub(in crate::cli) fn csv(
    command: &str,
    folder: &Path,
    interruption: &Interruption,
) -> Result<Vec<u8>, Unverified> {
    let args = parsed(command)?;
    let task = task_in(&args, folder)?;
    let (model, found) = fit_again(&args, &task, interruption)?;
    csv_of(&args, &model, &found)
}

/// Returns the command in the header of the CSV of a fit; `None` if `document` is none.
pub(in crate::cli) fn command_of(document: &Document) -> Option<String> {
    let header = document.header_of_csv()?;
    let header: Header = toml::from_str(&above_run_file(header)).ok()?;
    Some(header.fit.command)
}

/// A fit whose data and scenario are copied into a folder, with the command that fits them there.
pub(in crate::cli) struct FitCopy {
    args: FitArgs,
}

impl FitCopy {
    /// Copies data and scenario of the fit `command`, which are looked for in the folder `from` first, into `folder`.
    pub fn begin(command: &str, from: &Path, folder: &Path) -> anyhow::Result<Self> {
        let args = located(&parsed(command)?, from);
        let data = measured(&args)?;
        let name = name_of_copy(&data.origin);
        let scenario = open(&args.scenario)?.scenario()?;
        fs::write(folder.join(&name), data.text.as_bytes())?;
        fs::write(folder.join(SCENARIO_FILE), scenario.to_toml())?;
        Ok(Self {
            args: FitArgs {
                measured: name,
                scenario: SCENARIO_FILE.to_owned(),
                ..args
            },
        })
    }

    /// Finds the fit whose CSV is in `folder`.
    pub fn in_folder(folder: &Path) -> Result<Self, Unverified> {
        let document = Document::read(&folder.join(FIT_CSV)).map_err(Unverified::from)?;
        let command = command_of(&document).ok_or_else(|| cannot("its header has no fit"))?;
        Ok(Self {
            args: parsed(&command)?,
        })
    }

    /// Returns the names of the data and of the scenario in the folder.
    pub fn copies(&self) -> [&str; 2] {
        [&self.args.measured, &self.args.scenario]
    }

    /// Fits the data in `folder`, and returns the files of the write-up but the copies.
    pub fn files(
        &self,
        folder: &Path,
        formats: DocumentFormats,
        interruption: &Interruption,
    ) -> anyhow::Result<NamedFiles> {
        let task = task_in(&self.args, folder)?;
        let held = toml::Table::try_from(&task.document.scenario()?.file)?;
        let (model, fit) = fit_again(&self.args, &task, interruption)?;
        let csv = csv_of(&self.args, &model, &fit)?;
        let report = FitReport {
            fit: &fit,
            model: &model,
            instead_of: task.other_scheme(&model),
        };
        let writeup = FitWriteup::new(report, held, csv, interruption.meter());
        let writeup = writeup.map_err(|error| anyhow!(error))?;
        Ok(writeup.ok_or(Unverified::Stopped)?.files(formats)?)
    }
}

fn cannot(why: &str) -> Unverified {
    format!("cannot be recomputed: {why}").into()
}

/// Parses the command line of a fit.
fn parsed(command: &str) -> Result<FitArgs, Unverified> {
    let words = shlex::split(command).unwrap_or_default();
    let words_of_fit = words
        .get(1..)
        .filter(|words| words.first().is_some_and(|word| word == "fit"));
    let line = FitArgs::augment_args(clap::Command::new("fit"));
    let args = line
        .try_get_matches_from(words_of_fit.unwrap_or_default())
        .and_then(|matches| FitArgs::from_arg_matches(&matches))
        .map_err(|_| cannot("the line command in its header is not the command line of a fit"))?;
    if [&args.measured, &args.scenario].contains(&&STDIN.to_owned()) {
        return Err(cannot(
            "its data or scenario came from standard input and are not available",
        ));
    }
    Ok(args)
}

/// Returns `args` with the paths of its files where they are in `folder`.
fn located(args: &FitArgs, folder: &Path) -> FitArgs {
    let [measured, scenario] = [&args.measured, &args.scenario].map(|name| {
        let file = folder.join(name);
        if file.is_file() {
            file.to_string_lossy().into_owned()
        } else {
            name.clone()
        }
    });
    FitArgs {
        measured,
        scenario,
        ..args.clone()
    }
}

/// Reads the data and the scenario of a fit. They keep the names that `args` has for them.
fn task_in(args: &FitArgs, folder: &Path) -> Result<Task, Unverified> {
    let mut task =
        Task::read(&located(args, folder)).map_err(|problems| cannot(&problems.to_string()))?;
    task.measured.origin.clone_from(&args.measured);
    Ok(task)
}

fn fit_again(
    args: &FitArgs,
    task: &Task,
    interruption: &Interruption,
) -> Result<(Model, Fit), Unverified> {
    let model = task
        .model(args, None)
        .map_err(|problems| cannot(&problems.to_string()))?;
    match fitted(&model, &|| !interruption.has_come(), &|_, _| {}) {
        Ok(found) => Ok((model, found)),
        Err(NoFit::Interrupted) => Err(Unverified::Stopped),
        Err(error) => Err(cannot(&error.to_string())),
    }
}

fn csv_of(args: &FitArgs, model: &Model, fit: &Fit) -> Result<Vec<u8>, Unverified> {
    let report = FitReport {
        fit,
        model,
        instead_of: None,
    };
    let mut csv = Vec::new();
    write(&mut csv, &report, args).map_err(|error| cannot(&error.to_string()))?;
    Ok(csv)
}

/// Returns the command line of `args` without its output.
fn command(args: &FitArgs) -> String {
    let free = args.free.join(",");
    let mut words = vec!["gyrolab", "fit", &args.measured, "--in", &args.scenario];
    words.extend(["--free", &free]);
    words.extend(args.changes.set.iter().flat_map(|set| ["--set", set]));
    let map = args
        .columns
        .map
        .iter()
        .map(|(column, name)| format!("{column}={name}"))
        .collect::<Vec<_>>()
        .join(",");
    let sigma = args
        .columns
        .sigma
        .iter()
        .map(ToString::to_string)
        .collect::<Vec<_>>()
        .join(",");
    let time_step = args.changes.time_step.map(shortest).unwrap_or_default();
    let steps = args.length.steps.map(|steps| steps.to_string());
    let steps = steps.unwrap_or_default();
    let [from, to, duration] =
        [args.from, args.to, args.length.duration].map(|it| it.map(shortest).unwrap_or_default());
    let rows = args.rows.as_ref().map_or("", |rows| &rows.text);
    let scheme = args.changes.scheme.as_deref().unwrap_or_default();
    for (option, value) in [
        ("--time-step", &*time_step),
        ("--scheme", scheme),
        ("--steps", &steps),
        ("--duration", &duration),
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
    // Quoting fails only for a NUL byte, which no command-line argument can contain.
    shlex::try_join(words).unwrap_or_default()
}

/// Writes the CSV of the fit `report`, which `args` asked for.
pub(super) fn write(
    output: impl Write,
    report: &FitReport<'_>,
    args: &FitArgs,
) -> anyhow::Result<()> {
    let Fit { keys, quality, .. } = report.fit;
    let values: Vec<f64> = keys.iter().map(|key| key.value).collect();
    let scenario = report
        .model
        .as_long_as_measured(&values)
        .map_err(|why| anyhow!(why))?;
    let asked = FitCommand {
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
