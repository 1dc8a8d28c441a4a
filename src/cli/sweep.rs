//! `gyrolab sweep`: a grid of runs, a row each.

use super::args::{LengthArgs, SetArgs, change, change_length};
use super::info::listed;
use super::progress::{self, Interrupted, Interruption, Meter};
use super::{print, refuse, tell, tell_of_rows, warn};
use crate::engine::scenario::presets::{self, PRESETS};
use crate::engine::scenario::problem::nearest;
use crate::engine::scenario::{Document, Problem, Problems};
use crate::engine::text::number::counted;
use crate::engine::text::printable::{PrintablePath, printable_lines};
use crate::studies::sweep::in_order::in_order;
use crate::studies::sweep::join::join;
use crate::studies::sweep::part::{Opened, PartialSweep, SweepFileError};
use crate::studies::sweep::{self, RowTally, SWEEPS, Shard, Sweep, SweepFile, axis};
use crate::studies::verify::write_rows;
use anyhow::bail;
use clap::Args;
use clap::error::ErrorKind;
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

#[derive(Debug, Args)]
pub(super) struct SweepArgs {
    /// A shipped sweep's or preset's name, or a file (.toml or .csv): a sweep file, a sweep's CSV, or what run takes
    /// [without it: the list of the shipped sweeps]
    #[arg(requires = "output")]
    pub(super) scenario: Option<String>,

    #[command(flatten)]
    pub(super) changes: SetArgs,

    #[command(flatten)]
    pub(super) length: LengthArgs,

    /// Vary a key over N values from A to B, or over these values; may be repeated
    ///
    /// A and B are among the N values, which have equal distances, or with A..B:N:log equal ratios. Keys with + between them
    /// vary together: KEY+KEY=V1,V2 gives each of them the same value, KEY+KEY=[A1,B1],[A2,B2] each its own. The last key
    /// that varies runs fastest.
    #[arg(long, value_name = "KEY=A..B:N[:log]|V1,V2", requires = "scenario")]
    pub(super) vary: Vec<String>,

    /// The readouts to write, of those that gyrolab readouts lists [default: those of the sweep file, or every number]
    #[arg(
        long,
        value_name = "READOUT,...",
        value_delimiter = ',',
        requires = "scenario"
    )]
    pub(super) measure: Vec<String>,

    /// Only the K-th of N parts of the points, in their order; --join puts the parts together
    #[arg(long, value_name = "K/N", requires = "scenario")]
    pub(super) shard: Option<Shard>,

    /// Join these CSVs, which are all shards of one sweep, into one
    #[arg(long, value_name = "PART.csv", num_args = 1.., requires = "output", conflicts_with_all = ["scenario", "set", "time_step", "scheme", "steps", "duration"])]
    pub(super) join: Vec<PathBuf>,

    /// Write the CSV to this file; until it is complete, the rows are in FILE.part, and the same command continues it
    #[arg(short, long, value_name = "FILE")]
    pub(super) output: Option<PathBuf>,

    /// Replace what another sweep has left under these names
    #[arg(long, requires = "output")]
    pub(super) force: bool,
}

pub(super) fn sweep(args: &SweepArgs) -> anyhow::Result<ExitCode> {
    match (&args.scenario, &args.output) {
        (Some(name), Some(output)) => run(&sweep_of(name, args)?, output, args.force),
        (None, Some(output)) if !args.join.is_empty() => {
            let (sweep, tally) = join(&args.join, output, args.force)?;
            tell_of_empty(&tally, &sweep, &progress::interruption()?);
            tell_of_rows(sweep.rows(), output);
            tell_of_reliability(&tally);
            Ok(ExitCode::SUCCESS)
        }
        (None, Some(_)) => refuse(
            "sweep",
            ErrorKind::MissingRequiredArgument,
            "--output needs a sweep, a scenario, or --join; gyrolab sweep alone lists the sweeps",
        ),
        _ => print(&list()?),
    }
}

fn list() -> anyhow::Result<String> {
    let mut text = String::new();
    for shipped in SWEEPS {
        let sweep = Sweep::open(&open_document(shipped.name)?)?;
        text += &listed(shipped.name, sweep.title(), sweep.about());
    }
    text.push_str(
        "gyrolab sweep NAME -o FILE.csv runs one; gyrolab presets NAME prints it as TOML.\n",
    );
    Ok(text)
}

/// What `name` names: a shipped sweep, or what a run may be made of.
fn open_document(name: &str) -> Result<Document, Problems> {
    match sweep::find(name) {
        Some(found) => Document::parse(&format!("presets/sweeps/{name}.toml"), found.text),
        None if !name.contains(['/', '.']) && presets::find(name).is_none() => {
            let sweeps = SWEEPS.iter().map(|sweep| sweep.name);
            let near = nearest(name, sweeps.chain(PRESETS.iter().map(|preset| preset.name)));
            let rule = format!(
                "no sweep and no preset of that name: {near} (a file's name contains a / or ends in .toml or .csv)"
            );
            Err(Problems::one(name, Problem::at("", rule)))
        }
        None => Document::open(name),
    }
}

/// Changes `base`, from which the points of a sweep differ, as the command line says.
fn change_base(base: &mut Document, args: &SweepArgs) -> Result<(), Problems> {
    change(base, &args.changes)?;
    change_length(base, &args.length)
}

fn sweep_of(name: &str, args: &SweepArgs) -> Result<Sweep, Problems> {
    let mut document = open_document(name)?;
    let (mut file, base) = if document.is_sweep() {
        let file = SweepFile::read(&document)?;
        let base = Sweep::base(&file, &document, |base| change_base(base, args))?;
        (file, base)
    } else {
        change_base(&mut document, args)?;
        let base = document.scenario()?;
        (SweepFile::default(), base)
    };
    let from_file = file.vary.len();
    for argument in &args.vary {
        let vary = axis::parse(argument)?;
        let mut of_file = file.vary[..from_file].iter_mut();
        match of_file.find(|other| other.key == vary.key) {
            Some(same) => *same = vary,
            None => file.vary.push(vary),
        }
    }
    if !args.measure.is_empty() {
        file.measure = Some(args.measure.clone());
        file.gyrolab = None; // it is another sweep than that of a header
    }
    if let Some(shard) = args.shard {
        file.shard = Some(shard.to_string());
    }
    let keys: Vec<_> = file.vary.iter().map(|vary| vary.key.clone()).collect();
    Sweep::new(file, &base, &|problems| {
        let mut placed = document.placed(problems);
        for problem in &mut placed.list {
            place(problem, &keys, args);
        }
        placed
    })
}

/// Says of `problem` that it is about an option, if it is; `keys` are those that vary, in their order.
fn place(problem: &mut Problem, keys: &[String], args: &SweepArgs) {
    let place = problem.key.strip_prefix("vary.");
    let number = place.and_then(|place| place.split('.').next()?.parse::<usize>().ok());
    let key = number
        .and_then(|number| keys.get(number))
        .unwrap_or(&problem.key);
    if let Some(argument) = args.vary.iter().rev().find(|argument: &&String| {
        let varied = argument.split('=').next().unwrap_or_default();
        varied.trim() == key || axis::split_keys(varied).any(|own| own == key)
    }) {
        return axis::place(problem, argument);
    }
    let option = match problem.key.as_str() {
        "measure" if !args.measure.is_empty() => {
            format!("--measure {}", problem.value.trim_matches('"'))
        }
        "vary" if !args.vary.is_empty() => "--vary".to_owned(),
        _ => return,
    };
    problem.place = Some(option);
    problem.key.clear();
}

/// Computes the CSV that the command writes.
pub(super) fn csv(args: &SweepArgs, interruption: &Interruption) -> anyhow::Result<Vec<u8>> {
    let sweep = sweep_of(args.scenario.as_deref().unwrap_or_default(), args)?;
    let mut csv = sweep.header().into_bytes();
    write_rows(&sweep, &mut csv, interruption.meter())?;
    Ok(csv)
}

/// Makes the file whole, or as much of it as there is time for.
fn run(sweep: &Sweep, output: &Path, may_replace: bool) -> anyhow::Result<ExitCode> {
    let interruption = progress::interruption()?;
    let mut part = match PartialSweep::open(output, sweep, may_replace)? {
        Opened::Whole(tally) => {
            tell_of_empty(&tally, sweep, &interruption);
            let rows = counted(sweep.rows(), "row");
            tell(format_args!(
                "gyrolab: {} is complete: {rows}",
                PrintablePath(output)
            ));
            tell_of_reliability(&tally);
            return Ok(ExitCode::SUCCESS);
        }
        Opened::Part(part) => part,
    };
    tell_of_part(sweep, &part);
    let added = add_rows(sweep, &mut part, &interruption);
    let (rows, all) = (part.rows, sweep.rows());
    let tally = part.tally.clone();
    tell_of_empty(&tally, sweep, &interruption);
    if added.is_err() || rows < all {
        tell(format_args!(
            "gyrolab: {rows} of {} are in {}: run the same command again to continue",
            counted(all, "row"),
            PrintablePath(&part.path)
        ));
        added?;
        bail!(Interrupted);
    }
    part.keep()?;
    tell_of_rows(sweep.rows(), output);
    tell_of_reliability(&tally);
    Ok(ExitCode::SUCCESS)
}

/// Says how many rows an earlier command has left.
fn tell_of_part(sweep: &Sweep, part: &PartialSweep) {
    if part.rows == 0 {
        return;
    }
    let (rows, all, path) = (part.rows, sweep.rows(), PrintablePath(&part.path));
    let empty = match part.tally.empty.count {
        0 => String::new(),
        empty => format!(", {empty} of them without readouts"),
    };
    tell(format_args!(
        "gyrolab: continuing after {rows} of {all} rows in {path}{empty}"
    ));
}

/// Prints how many runs are reliable, if the rows say so.
fn tell_of_reliability(tally: &RowTally) {
    let count = tally.reliability;
    match count.in_words() {
        Some(words) if count.unreliable > 0 => warn(format_args!("gyrolab: {words}")),
        Some(words) => tell(format_args!("gyrolab: {words}")),
        None => {}
    }
}

/// Prints how many rows hold no readouts, and of the first few which points they are, and why.
fn tell_of_empty(tally: &RowTally, sweep: &Sweep, interruption: &Interruption) {
    let empty = &tally.empty;
    if empty.count == 0 {
        return;
    }
    let (count, all) = (empty.count, sweep.rows());
    warn(format_args!(
        "gyrolab: rows without readouts: {count} of {all}"
    ));
    let lines = empty.in_words(sweep, || !interruption.has_come());
    for line in &lines {
        warn(format_args!("  {}", printable_lines(line)));
    }
    let more = count - lines.len() as u64;
    if more > 0 {
        warn(format_args!("  and {more} more"));
    }
}

/// Computes the rows that are not there yet and adds them to `part`, until a signal comes.
fn add_rows(
    sweep: &Sweep,
    part: &mut PartialSweep,
    interruption: &Interruption,
) -> Result<(), SweepFileError> {
    let (begin, all) = (part.rows, sweep.rows());
    let mut meter = Meter::counting("row");
    meter.begin(begin, all);
    let mut added = Ok(());
    in_order(
        begin..all,
        |row: u64, goes_on: &dyn Fn() -> bool| {
            sweep.row(row, &|| goes_on() && !interruption.has_come())
        },
        |rows| {
            added = part.add(rows);
            if added.is_err() {
                return ControlFlow::Break(());
            }
            meter.show(part.rows, all);
            interruption.go_on()
        },
    );
    added
}
