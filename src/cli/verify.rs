//! `gyrolab verify`: whether a CSV or a figure is what the run in it gives, or whether somebody's own program agrees with the scheme.

use super::args::{one_or_more, setting};
use super::progress::{self, Interrupted, Interruption};
use super::{fit, print, tell};
use crate::own_code::{self, Uncompared, Verdict};
use crate::scenario::csv::{self, Renaming, renaming};
use crate::scenario::{Document, Problems, Scenario};
use crate::text::printable::{Shown, printable_lines};
use crate::verify::{Unverified, redraw, verify as verified};
use anyhow::bail;
use clap::Args;
use std::fmt::Display;
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
    let mut code = ExitCode::SUCCESS;
    for file in &args.files {
        let result = match &scenario {
            Some(scenario) => own(file, args, scenario, &interruption),
            None => made_again(file, &interruption),
        };
        match result {
            Ok(is_good) if is_good => {}
            Ok(_) => code = ExitCode::FAILURE,
            Err(Unverified::Stopped) => bail!(Interrupted),
            Err(Unverified::Refused(problems)) => {
                tell(printable_lines(&problems.to_string()));
                code = ExitCode::FAILURE;
            }
        }
    }
    Ok(code)
}

/// Computes or draws `file` again and prints what has come out. Returns whether it is the same.
fn made_again(file: &Path, interruption: &Interruption) -> Result<bool, Unverified> {
    if let Some(redrawn) = redraw(file, interruption.meter())? {
        let same = "the same: drawn again from the run in it";
        printed(&told(
            file,
            same,
            redrawn.difference.as_ref(),
            &redrawn.notes,
        ))?;
        return Ok(redrawn.difference.is_none());
    }
    let fit = |command: &str| fit::again(command, interruption);
    let result = verified(file, fit, interruption.meter())?;
    let same = match result.rows {
        1 => "the same: its row, computed again".to_owned(),
        rows => format!("the same: all {rows} rows, computed again"),
    };
    printed(&told(
        file,
        &same,
        result.difference.as_ref(),
        &result.notes,
    ))?;
    Ok(result.difference.is_none())
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
        Uncompared::Refused(problems) => {
            Unverified::Refused(problems.of(file.display().to_string()))
        }
        Uncompared::Stopped => Unverified::Stopped,
    })?;
    if args.json {
        let json = serde_json::to_string(&verdict).unwrap_or_default();
        printed(&format!("{json}\n"))?;
    } else {
        let lines = printable_lines(&verdict.lines.join("\n")).into_owned();
        printed(&format!("{}: {lines}\n", Shown(file)))?;
    }
    Ok(verdict.agrees)
}

fn verdict(
    file: &Path,
    args: &VerifyArgs,
    scenario: &Arc<Scenario>,
    interruption: &Interruption,
) -> Result<Verdict, Uncompared> {
    let text = csv::text(file).map_err(|problem| Problems::from(vec![problem]))?;
    let every = args.every.map(NonZeroU64::get);
    let time_step_s = scenario.motion.time_step_s;
    let rows = own_code::rows::read(&text, &args.map, every, time_step_s)?;
    let name = args.against.as_deref().unwrap_or_default();
    own_code::compare(&rows, name, scenario, &|| !interruption.has_come())
}

/// What has come out for `file`: a line that says whether it is the `same`, and a line for each note.
fn told(file: &Path, same: &str, difference: Option<&impl Display>, notes: &[String]) -> String {
    let file = Shown(file);
    let mut text = match difference {
        Some(difference) => format!("{file}: differs: {difference}\n"),
        None => format!("{file}: {same}\n"),
    };
    for note in notes {
        text += &format!("    {note}\n");
    }
    text
}
