//! `gyrolab verify`: whether a CSV is what its header says.

use super::progress::{self, Interrupted};
use super::{fit, print, tell};
use crate::text::printable::{Shown, printable_lines};
use crate::verify::{Unverified, Verified, verify as verified};
use anyhow::bail;
use clap::Args;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

#[derive(Debug, Args)]
pub(super) struct VerifyArgs {
    /// CSVs that gyrolab run, compare, sweep, fit or the lab wrote
    #[arg(required = true, value_name = "FILE")]
    files: Vec<PathBuf>,
}

pub(super) fn verify(args: &VerifyArgs) -> anyhow::Result<ExitCode> {
    let interruption = progress::interruption()?;
    let mut code = ExitCode::SUCCESS;
    for file in &args.files {
        let fit = |command: &str| fit::again(command, &interruption);
        match verified(file, fit, interruption.meter()) {
            Ok(result) => {
                if result.difference.is_some() {
                    code = ExitCode::FAILURE;
                }
                print(&told(file, &result))?;
            }
            Err(Unverified::Stopped) => bail!(Interrupted),
            Err(Unverified::Refused(problems)) => {
                tell(printable_lines(&problems.to_string()));
                code = ExitCode::FAILURE;
            }
        }
    }
    Ok(code)
}

/// What has come out for `file`: a line for the rows, and a line for each note.
fn told(file: &Path, result: &Verified) -> String {
    let (file, rows) = (Shown(file), result.rows);
    let mut text = match (&result.difference, rows) {
        (Some(difference), _) => format!("{file}: differs: {difference}\n"),
        (None, 1) => format!("{file}: the same: its row, computed again\n"),
        (None, _) => format!("{file}: the same: all {rows} rows, computed again\n"),
    };
    for note in &result.notes {
        text += &format!("    {note}\n");
    }
    text
}
