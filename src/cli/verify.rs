//! `gyrolab verify`: recomputes CSVs, figures and write-ups and reports differences, or compares a reader's own program
//! with the scheme.

use super::argument_values::{one_or_more, setting};
use super::fit::again::FitCopy;
use super::progress::{self, Interrupted, Interruption};
use super::{fit, print, reproduce, warn, writeup};
use crate::engine::export::OutputFolder;
use crate::engine::scenario::csv::{self, Renaming, renaming};
use crate::engine::scenario::{Document, Problems, Scenario};
use crate::engine::text::io_errors::unread;
use crate::engine::text::number::counted;
use crate::engine::text::printable::{PrintablePath, brief, printable_lines};
use crate::report::figure::redraw;
use crate::report::reproduce::CLAIMS_FILE;
use crate::report::writeup::fit::FIT_CSV;
use crate::report::writeup::{CSV, DocumentFormats, MEASURED_DATA, READOUTS_FILE, RUN_FILE};
use crate::studies::own_code::{self, Verdict};
use crate::studies::verify::verify as verified;
use crate::studies::verify::{FileComparison, Unverified, first_difference, other_version};
use anyhow::bail;
use clap::Args;
use std::ffi::OsString;
use std::fmt::Display;
use std::fs::File;
use std::io::Read;
use std::num::NonZeroU64;
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::sync::Arc;
use toml::Value;

#[derive(Debug, Args)]
pub(super) struct VerifyArgs {
    /// CSVs, figures and folders from gyrolab; with --against, files that your own program wrote
    #[arg(required = true, value_name = "FILE")]
    files: Vec<PathBuf>,

    /// Compare rows from your own program of the report's scheme with this scenario, and find the mistake if they
    /// differ
    #[arg(long, value_name = "SCENARIO", help_heading = OWN_CODE)]
    against: Option<String>,

    /// Name the file's columns: its own name of a column, or the column's number from 1, then gyrolab's name
    #[arg(long, value_name = "COLUMN=NAME,...", value_delimiter = ',', value_parser = renaming, requires = "against", help_heading = OWN_CODE)]
    map: Vec<Renaming>,

    /// The file has every N-th step only
    #[arg(long, value_name = "N", value_parser = one_or_more, requires = "against", help_heading = OWN_CODE)]
    every: Option<NonZeroU64>,

    /// Change a value of the scenario first, such as motion.time_step_s=0.01; may be repeated
    #[arg(long = "set", value_name = "KEY=VALUE", value_parser = setting, requires = "against", help_heading = OWN_CODE)]
    set: Vec<String>,

    /// Print the result as one JSON object per file
    #[arg(long, requires = "against", help_heading = OWN_CODE)]
    json: bool,
}

/// The version that recomputes.
const OWN_VERSION: &str = env!("CARGO_PKG_VERSION");
const RECREATED: &str = "the same, recreated";
const MISSING: &str = "it is missing or not a regular file";
/// Maximum number of bytes read from a file beyond its expected length.
const MOST_FILE_EXCESS: u64 = 1 << 20;

const OWN_CODE: &str = "Your own code";

pub(super) fn verify(args: &VerifyArgs) -> anyhow::Result<ExitCode> {
    let interruption = progress::interruption()?;
    let scenario = args
        .against
        .as_ref()
        .map(|name| scenario(name, &args.set))
        .transpose()?;
    let mut is_good = true;
    for file in &args.files {
        let result = match &scenario {
            Some(scenario) => own(file, args, scenario, &interruption),
            None if file.is_dir() => folder(file, &interruption),
            None => verify_file(file, &interruption),
        };
        is_good &= report_result(file, result)?;
    }
    Ok(if is_good {
        ExitCode::SUCCESS
    } else {
        ExitCode::FAILURE
    })
}

/// Returns true if the file is verified. Prints the reason if it cannot be verified.
fn report_result(file: &Path, result: anyhow::Result<bool>) -> anyhow::Result<bool> {
    result.or_else(|error| match error.downcast()? {
        Unverified::Stopped => bail!(Interrupted),
        Unverified::Refused(mut problems) => {
            if problems.origin.is_empty() {
                problems.origin = file.display().to_string();
            }
            warn(printable_lines(&problems.to_string()));
            Ok(false)
        }
    })
}

/// Recreates what is in `folder` and compares every file. Returns true if all are the same.
fn folder(folder: &Path, interruption: &Interruption) -> anyhow::Result<bool> {
    if folder.join(CLAIMS_FILE).is_file() {
        reproduction(folder, interruption)
    } else {
        writeup_again(folder, interruption)
    }
}

/// Recreates the reproduced report in `folder` and compares every file.
fn reproduction(folder: &Path, interruption: &Interruption) -> anyhow::Result<bool> {
    let version = version_of_claims(&folder.join(CLAIMS_FILE));
    let files = reproduce::files(interruption)?;
    let mut is_good = true;
    for (name, made) in &files {
        let file = folder.join(name);
        let difference = file_difference(&file, made, &version, interruption)?;
        is_good &= print_file_result(&file, RECREATED, difference.as_ref(), &[])?;
    }
    if let Some(note) = other_version(&version) {
        print(&format!("    {note}\n"))?;
    }
    Ok(is_good)
}

/// Returns the version that wrote the claims in `file`, or this one if it is not stated.
fn version_of_claims(file: &Path) -> String {
    let text = csv::text(file).unwrap_or_default();
    let claims: serde_json::Value = serde_json::from_str(&text).unwrap_or_default();
    let version = claims.get("gyrolab").and_then(serde_json::Value::as_str);
    version.unwrap_or(OWN_VERSION).to_owned()
}

/// Recreates the write-up in `folder` and compares every file.
fn writeup_again(folder: &Path, interruption: &Interruption) -> anyhow::Result<bool> {
    let [run_file, csv, fit_csv] = [RUN_FILE, CSV, FIT_CSV].map(|name| folder.join(name));
    if !run_file.is_file() && fit_csv.is_file() {
        return folder_of_fit(folder, interruption);
    }
    if !run_file.is_file() {
        let rule = format!(
            "is not a write-up, because it contains no {RUN_FILE}: name the files in it instead"
        );
        bail!(Unverified::from(rule));
    }
    let document = Document::read(&run_file).map_err(Unverified::from)?;
    let scenario = Arc::new(document.scenario().map_err(Unverified::from)?);
    let version = document
        .table()
        .get("gyrolab")
        .and_then(Value::as_str)
        .unwrap_or(OWN_VERSION);
    let data = measured_in(folder);
    let (again, compared) = writeup::again(scenario, data.as_deref(), &csv, interruption)?;
    let notes = Vec::from_iter(other_version(version).into_iter().chain([again.verdict()]));
    let mut is_good = match compared.map(FileComparison::end).transpose()? {
        Some((rows, difference)) => print_rows_result(&csv, rows, difference.as_ref(), &notes)?,
        None => print_file_result(&csv, "", Some(&MISSING), &notes)?,
    };
    let files = again.files(DocumentFormats::in_folder(folder))?;
    for (name, made) in &files {
        let file = folder.join(name);
        let same = if data.as_ref().is_some_and(|data| Path::new(data) == file) {
            "the same: measured data, which is not recomputed"
        } else {
            RECREATED
        };
        let difference = file_difference(&file, made, version, interruption)?;
        is_good &= print_file_result(&file, same, difference.as_ref(), &[])?;
    }
    print_other_files(folder, files.iter().map(|(name, _)| name.into()))?;
    Ok(is_good)
}

/// Repeats the fit in the write-up in `folder`, and compares every file. Returns true if all are the same.
fn folder_of_fit(folder: &Path, interruption: &Interruption) -> anyhow::Result<bool> {
    let fit = FitCopy::in_folder(folder)?;
    let files = fit.files(folder, DocumentFormats::in_folder(folder), interruption)?;
    let mut is_good = true;
    for (name, made) in &files {
        let file = folder.join(name);
        let difference = file_difference(&file, made, OWN_VERSION, interruption)?;
        is_good &= print_file_result(&file, RECREATED, difference.as_ref(), &[])?;
    }
    let own = files.iter().map(|(name, _)| name.as_str());
    let own = own.chain(fit.copies()).map(OsString::from);
    print_other_files(folder, own)?;
    Ok(is_good)
}

/// Prints the names of files in `folder` that do not belong to the write-up's `own` files.
fn print_other_files(folder: &Path, own: impl Iterator<Item = OsString>) -> anyhow::Result<()> {
    let of_writeup: Vec<_> = own.chain([CSV.into()]).collect();
    let others = OutputFolder::others(folder, &of_writeup)?;
    if !others.is_empty() {
        let count = counted(others.len() as u64, "file");
        let (folder, others) = (PrintablePath(folder), brief(&others.join(", "), 200));
        print(&format!(
            "{folder}: {count} not part of the write-up: {others}\n"
        ))?;
    }
    Ok(())
}

/// Describes the difference between the file of a write-up and its recreated content `made`. For a write-up by another
/// version, only the pixels of a figure count, and texts may name that version.
fn file_difference(
    file: &Path,
    made: &[u8],
    version: &str,
    interruption: &Interruption,
) -> anyhow::Result<Option<String>> {
    if !file.is_file() {
        return Ok(Some(MISSING.to_owned()));
    }
    let (mut there, most) = (Vec::new(), made.len() as u64 + MOST_FILE_EXCESS);
    let read = File::open(file).and_then(|file| file.take(most).read_to_end(&mut there));
    if let Err(error) = read {
        return Ok(Some(unread(&error)));
    }
    if there == made {
        return Ok(None);
    }
    if file
        .extension()
        .is_some_and(|it| it == "svg" || it == "pdf" || it == "png")
    {
        return Ok(match redraw(file, interruption.meter()) {
            Err(Unverified::Stopped) => bail!(Interrupted),
            Err(Unverified::Refused(problems)) => Some(problems.in_one_line()),
            Ok(Some((Some(difference), _))) => Some(difference),
            Ok(_) => (version == OWN_VERSION)
                .then(|| "it is a figure of another run or time range".to_owned()),
        });
    }
    let [there, made] = [&there, made].map(String::from_utf8_lossy);
    Ok(first_difference(
        &there,
        &made.replace(OWN_VERSION, version),
    ))
}

/// Returns the path of the measured data in the folder of a write-up.
fn measured_in(folder: &Path) -> Option<String> {
    let file = folder.join(READOUTS_FILE);
    let text = file.is_file().then(|| csv::text(&file))?.ok()?;
    let readouts: serde_json::Value = serde_json::from_str(&text).ok()?;
    let name = Path::new(readouts.get(MEASURED_DATA)?.get("file")?.as_str()?);
    Some(
        folder
            .join(name.file_name()?)
            .to_string_lossy()
            .into_owned(),
    )
}

/// Recomputes or redraws `file` and prints the result. Returns true if it is the same.
fn verify_file(file: &Path, interruption: &Interruption) -> anyhow::Result<bool> {
    if let Some((difference, notes)) = redraw(file, interruption.meter())? {
        let same = "the same: redrawn from the data in the file";
        return print_file_result(file, same, difference.as_ref(), &notes);
    }
    let folder = file.parent().unwrap_or(Path::new(""));
    let result = verified(
        file,
        |command| fit::again::csv(command, folder, interruption),
        interruption.meter(),
    )?;
    print_rows_result(file, result.rows, result.difference.as_ref(), &result.notes)
}

fn scenario(name: &str, set: &[String]) -> Result<Arc<Scenario>, Problems> {
    let mut document = Document::open(name)?;
    for argument in set {
        document.set(argument)?;
    }
    Ok(Arc::new(document.scenario()?))
}

/// Compares `file` with the scenario and prints the verdict. Returns true if they agree.
fn own(
    file: &Path,
    args: &VerifyArgs,
    scenario: &Arc<Scenario>,
    interruption: &Interruption,
) -> anyhow::Result<bool> {
    let verdict =
        compare_rows(file, args, scenario, interruption).map_err(|error| match error {
            Unverified::Refused(problems) => {
                Unverified::Refused(problems.in_file(file.display().to_string()))
            }
            stopped => stopped,
        })?;
    if args.json {
        let json = serde_json::to_string(&verdict).unwrap_or_default();
        print(&format!("{json}\n"))?;
    } else {
        let lines = printable_lines(&verdict.lines.join("\n")).into_owned();
        let (file, name) = (
            PrintablePath(file),
            args.against.as_deref().unwrap_or_default(),
        );
        print(&format!("{file}: {lines}\n"))?;
        if verdict.is_unexplained && args.set.is_empty() {
            let next = format!("gyrolab {name} --measured {file}");
            print(&format!(
                "Next: run {next} and press M to examine that step.\n"
            ))?;
        }
    }
    Ok(verdict.agrees)
}

fn compare_rows(
    file: &Path,
    args: &VerifyArgs,
    scenario: &Arc<Scenario>,
    interruption: &Interruption,
) -> Result<Verdict, Unverified> {
    let text = csv::text(file).map_err(|problem| Problems::from(vec![problem]))?;
    let every = args.every.map(NonZeroU64::get);
    let time_step_s = scenario.motion.time_step_s;
    let rows = own_code::rows::read(&text, &args.map, every, time_step_s)?;
    let name = args.against.as_deref().unwrap_or_default();
    progress::with_clock("comparing the rows with the scheme", || {
        own_code::compare(&rows, name, scenario, &|| !interruption.has_come())
    })
}

/// Prints the result for a file whose rows were recomputed; see [`print_file_result`].
fn print_rows_result(
    file: &Path,
    rows: u64,
    difference: Option<&impl Display>,
    notes: &[String],
) -> anyhow::Result<bool> {
    let same = match rows {
        1 => "the same: its row, recomputed".to_owned(),
        rows => format!("the same: all {rows} rows, recomputed"),
    };
    print_file_result(file, &same, difference, notes)
}

/// Prints the result for `file`: the text `same` or the difference, then one line per note. Returns true if there is no
/// difference.
fn print_file_result(
    file: &Path,
    same: &str,
    difference: Option<&impl Display>,
    notes: &[String],
) -> anyhow::Result<bool> {
    let file = PrintablePath(file);
    let mut text = match difference {
        Some(difference) => format!("{file}: differs: {difference}\n"),
        None => format!("{file}: {same}\n"),
    };
    for note in notes {
        text += &format!("    {note}\n");
    }
    print(&text)?;
    Ok(difference.is_none())
}
