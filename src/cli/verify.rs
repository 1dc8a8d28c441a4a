//! `gyrolab verify`: whether a CSV is what its header says.

use super::progress::{self, Meter};
use super::{INTERRUPTED, fit, print, tell};
use crate::study::verify::{Unverified, Verified, verify as verified};
use crate::text::printable::{Shown, printable_lines};
use clap::Args;
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::sync::{Mutex, PoisonError};

#[derive(Debug, Args)]
pub(super) struct VerifyArgs {
    /// CSVs that gyrolab run, compare, sweep, fit or the lab wrote
    #[arg(required = true, value_name = "FILE")]
    files: Vec<PathBuf>,
}

pub(super) fn verify(args: &VerifyArgs) -> anyhow::Result<ExitCode> {
    let (_, interruption) = progress::open(None, false)?;
    let mut code = ExitCode::SUCCESS;
    for file in &args.files {
        let meter = Mutex::new(Meter::new());
        let fit = |command: &str| fit::again(command, &interruption);
        let result = verified(file, fit, |step, steps| {
            let meter = meter.lock();
            meter
                .unwrap_or_else(PoisonError::into_inner)
                .show(step, steps);
            interruption.go_on()
        });
        meter.lock().unwrap_or_else(PoisonError::into_inner).clear();
        match result {
            Ok(result) => {
                if result.difference.is_some() {
                    code = ExitCode::FAILURE;
                }
                print(&told(file, &result))?;
            }
            Err(Unverified::Stopped) => return Ok(ExitCode::from(INTERRUPTED)),
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
