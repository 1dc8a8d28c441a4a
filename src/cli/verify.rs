//! `gyrolab verify`: whether a CSV or a figure is what the run in it gives, or whether somebody's own program agrees with the scheme.

use super::args::{one_or_more, setting};
use super::progress::{self, Interrupted, Interruption};
use super::{fit, print, tell, writeup};
use crate::own_code::{self, Verdict};
use crate::scenario::csv::{self, Renaming, renaming};
use crate::scenario::{Document, Problems, Scenario};
use crate::text::printable::{Shown, brief, printable_lines};
use crate::verify::{Unverified, redraw, verify as verified};
use crate::writeup::{BELIEVED, CSV, MEASURED_DATA, PAGE, READOUTS_FILE, RUN_FILE};
use anyhow::{Context, bail};
use clap::Args;
use std::collections::HashSet;
use std::fmt::Display;
use std::fs;
use std::io;
use std::num::NonZeroU64;
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::sync::Arc;

#[derive(Debug, Args)]
pub(super) struct VerifyArgs {
    /// CSVs and figures that gyrolab wrote, or folders of them such as a write-up; with --against what your own program wrote
    #[arg(required = true, value_name = "FILE")]
    files: Vec<PathBuf>,

    /// Hold rows that your own program of the report's scheme wrote against this scenario: do they agree, and if not, which
    /// slip makes them
    #[arg(long, value_name = "SCENARIO", help_heading = OWN_CODE)]
    against: Option<String>,

    /// What the file's columns are: its own name or number (from 1) of each, and gyrolab's
    #[arg(long, value_name = "COLUMN=NAME,...", value_delimiter = ',', value_parser = renaming, requires = "against", help_heading = OWN_CODE)]
    map: Vec<Renaming>,

    /// The file has every N-th step only
    #[arg(long, value_name = "N", value_parser = one_or_more, requires = "against", help_heading = OWN_CODE)]
    every: Option<NonZeroU64>,

    /// Change a value of the scenario first, such as motion.time_step_s=0.01; may be repeated
    #[arg(long = "set", value_name = "KEY=VALUE", value_parser = setting, requires = "against", help_heading = OWN_CODE)]
    set: Vec<String>,

    /// Give the result as one JSON object a file
    #[arg(long, requires = "against", help_heading = OWN_CODE)]
    json: bool,
}

const OWN_CODE: &str = "Your own code";

pub(super) fn verify(args: &VerifyArgs) -> anyhow::Result<ExitCode> {
    let interruption = progress::interruption()?;
    let scenario = args.against.as_ref().map(|name| scenario(name, &args.set));
    let scenario = scenario.transpose()?;
    let mut is_good = true;
    for file in &args.files {
        is_good &= match &scenario {
            Some(scenario) => judged(own(file, args, scenario, &interruption))?,
            None if file.is_dir() => folder(file, &interruption)?,
            None => judged(made_again(file, &interruption))?,
        };
    }
    Ok(if is_good {
        ExitCode::SUCCESS
    } else {
        ExitCode::FAILURE
    })
}

/// Whether it is good; why it cannot be judged is told.
fn judged(result: Result<bool, Unverified>) -> anyhow::Result<bool> {
    match result {
        Ok(is_good) => Ok(is_good),
        Err(Unverified::Stopped) => bail!(Interrupted),
        Err(Unverified::Refused(problems)) => {
            tell(printable_lines(&problems.to_string()));
            Ok(false)
        }
    }
}

/// Makes every CSV and figure in `folder` again, and the numbers of a write-up. Returns whether all are the same.
fn folder(folder: &Path, interruption: &Interruption) -> anyhow::Result<bool> {
    let entries = fs::read_dir(folder).and_then(Iterator::collect::<io::Result<Vec<_>>>);
    let entries = entries.with_context(|| format!("{}: cannot be read", Shown(folder)))?;
    let mut files: Vec<PathBuf> = entries.iter().map(fs::DirEntry::path).collect();
    files.sort();
    let data = measured_in(folder);
    let is_made = |file: &&PathBuf| {
        let ending = file.extension().and_then(|ending| ending.to_str());
        let is_made = ending.is_some_and(|ending| ["csv", "svg", "pdf", "png"].contains(&ending));
        is_made && file.is_file() && data.as_ref() != Some(*file)
    };
    let (mut is_good, mut count) = (true, 0);
    for file in files.iter().filter(is_made) {
        is_good &= judged(made_again(file, interruption))?;
        count += 1;
    }
    if let Some(data) = data.as_deref().filter(|data| data.is_file()) {
        print(&format!(
            "{}: measured data, which nothing computes\n",
            Shown(data)
        ))?;
    }
    if folder.join(RUN_FILE).is_file() {
        is_good &= judged(numbers(folder, data.as_deref(), interruption))?;
        count += 1;
    }
    if count == 0 {
        tell(format_args!(
            "{}: holds no CSV and no figure to make again",
            Shown(folder)
        ));
    }
    Ok(is_good && count > 0)
}

/// The measured data in the folder of a write-up.
fn measured_in(folder: &Path) -> Option<PathBuf> {
    let readouts = fs::read_to_string(folder.join(READOUTS_FILE)).ok()?;
    let readouts: serde_json::Value = serde_json::from_str(&readouts).ok()?;
    let name = Path::new(readouts.get(MEASURED_DATA)?.get("file")?.as_str()?);
    Some(folder.join(name.file_name()?))
}

/// Runs a write-up's run file again and compares the numbers of the folder: every readout, and of the page the verdict and
/// the rows of its tables. A file of the write-up that is not there differs; only the page may be left out.
fn numbers(
    folder: &Path,
    data: Option<&Path>,
    interruption: &Interruption,
) -> Result<bool, Unverified> {
    let run_file = folder.join(RUN_FILE);
    let scenario = Document::read(&run_file)?.scenario()?;
    let csv = folder.join(CSV);
    let is_other = csv.is_file() && {
        let of_csv = Document::read(&csv)?.scenario()?;
        of_csv.to_toml() != scenario.to_toml()
    };
    let data = data.map(|data| data.to_string_lossy());
    let again = writeup::again(Arc::new(scenario), data.as_deref(), interruption);
    let again = again.map_err(|error| match error.downcast() {
        Ok(Interrupted) => Unverified::Stopped,
        Err(error) => Unverified::from(format!("{error:#}")),
    })?;
    let other = is_other.then(|| format!("it is not the run of {CSV}"));
    let mut is_good = say(&run_file, "the run of the write-up", other.as_ref(), &[])?;
    let files = again.files().map_err(|error| error.to_string())?;
    let names = files.iter().map(|(name, _)| name.as_str()).chain([CSV]);
    for name in names.filter(|name| *name != PAGE && !folder.join(name).exists()) {
        let missing = "it is missing".to_owned();
        is_good &= say(&folder.join(name), "", Some(&missing), &[])?;
    }
    for (name, text) in [(READOUTS_FILE, again.readouts_json()), (PAGE, again.page())] {
        let file = folder.join(name);
        let Ok(there) = fs::read_to_string(&file) else {
            continue;
        };
        let lines: HashSet<&str> = there.lines().collect();
        let mut is_verdict = false;
        let is_checked = |line: &&str| {
            if line.starts_with("## ") {
                is_verdict = *line == BELIEVED;
            }
            name != PAGE || line.starts_with("| ") || is_verdict
        };
        let computed: Vec<&str> = text.lines().filter(is_checked).collect();
        let missing = computed.iter().find(|line| !lines.contains(**line));
        let difference = missing.map(|line| {
            format!(
                "it lacks a line, computed again: {}",
                brief(line.trim(), 200)
            )
        });
        let same = "the same: its numbers and its verdict, computed again";
        is_good &= say(&file, same, difference.as_ref(), &[])?;
    }
    Ok(is_good)
}

/// Computes or draws `file` again and prints what has come out. Returns whether it is the same.
fn made_again(file: &Path, interruption: &Interruption) -> Result<bool, Unverified> {
    if let Some((difference, notes)) = redraw(file, interruption.meter())? {
        let same = "the same: drawn again from what it carries";
        return say(file, same, difference.as_ref(), &notes);
    }
    let fit = |command: &str| fit::again(command, interruption);
    let result = verified(file, fit, interruption.meter())?;
    let same = match result.rows {
        1 => "the same: its row, computed again".to_owned(),
        rows => format!("the same: all {rows} rows, computed again"),
    };
    say(file, &same, result.difference.as_ref(), &result.notes)
}

fn printed(text: &str) -> Result<(), Unverified> {
    print(text).map_err(|error| Unverified::from(error.to_string()))?;
    Ok(())
}

fn scenario(name: &str, set: &[String]) -> Result<Arc<Scenario>, Problems> {
    let mut document = Document::open(name)?;
    for set in set {
        document.set(set)?;
    }
    Ok(Arc::new(document.scenario()?))
}

/// Holds `file` against the scenario and prints the verdict. Returns whether they agree.
fn own(
    file: &Path,
    args: &VerifyArgs,
    scenario: &Arc<Scenario>,
    interruption: &Interruption,
) -> Result<bool, Unverified> {
    let verdict = verdict(file, args, scenario, interruption).map_err(|error| match error {
        Unverified::Refused(problems) => {
            Unverified::Refused(problems.of(file.display().to_string()))
        }
        stopped => stopped,
    })?;
    if args.json {
        let json = serde_json::to_string(&verdict).unwrap_or_default();
        printed(&format!("{json}\n"))?;
    } else {
        let lines = printable_lines(&verdict.lines.join("\n")).into_owned();
        let (file, name) = (Shown(file), args.against.as_deref().unwrap_or_default());
        printed(&format!("{file}: {lines}\n"))?;
        if verdict.is_unexplained && args.set.is_empty() {
            let next = format!("gyrolab {name} --measured {file}");
            printed(&format!("Next: {next}, then M, takes that step apart.\n"))?;
        }
    }
    Ok(verdict.agrees)
}

fn verdict(
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
    own_code::compare(&rows, name, scenario, &|| !interruption.has_come())
}

/// Prints what has come out for `file`: a line that says whether it is the `same`, and a line for each note. Returns whether
/// it is.
fn say(
    file: &Path,
    same: &str,
    difference: Option<&impl Display>,
    notes: &[String],
) -> Result<bool, Unverified> {
    let file = Shown(file);
    let mut text = match difference {
        Some(difference) => format!("{file}: differs: {difference}\n"),
        None => format!("{file}: {same}\n"),
    };
    for note in notes {
        text += &format!("    {note}\n");
    }
    printed(&text)?;
    Ok(difference.is_none())
}
