//! `gyrolab verify`: whether a CSV is what its header says.

use super::progress::{self, Meter};
use super::{INTERRUPTED, print, tell};
use crate::study::verify::{Kind, Unverified, Verified, verify as verified};
use crate::text::printable::{Shown, printable_lines};
use clap::Args;
use std::fmt::Write;
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::sync::{Mutex, PoisonError};

#[derive(Debug, Args)]
pub(super) struct VerifyArgs {
    /// CSVs that gyrolab run, compare, sweep or the lab wrote
    #[arg(required = true, value_name = "FILE")]
    files: Vec<PathBuf>,
}

pub(super) fn verify(args: &VerifyArgs) -> anyhow::Result<ExitCode> {
    let (_, interruption) = progress::open(None, false)?;
    let mut code = ExitCode::SUCCESS;
    for file in &args.files {
        let meter = Mutex::new(Meter::new());
        let result = verified(file, |step, steps| {
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

/// What has come out for `file`, a line each for the rows, the versions and the run.
fn told(file: &Path, result: &Verified) -> String {
    let (file, rows) = (Shown(file), result.rows);
    let mut text = match (&result.difference, rows) {
        (Some(difference), _) => format!("{file}: differs: {difference}\n"),
        (None, 1) => format!("{file}: the same: its row, computed again\n"),
        (None, _) => format!("{file}: the same: all {rows} rows, computed again\n"),
    };
    let mut line = |line: String| {
        // Writing to a text does not fail.
        let _ = writeln!(text, "    {line}");
    };
    if let Some(version) = &result.written_by {
        let own = env!("CARGO_PKG_VERSION");
        line(format!(
            "written by gyrolab {version}, computed again by gyrolab {own}"
        ));
    }
    if let Some(end) = &result.not_finite {
        line(format!("its run ends early: {end}"));
    }
    match result.kind {
        Kind::Run if result.difference.is_some() => {
            line(format!("of the run in its header: {}", result.verdict));
        }
        Kind::Run => line(result.verdict.clone()),
        Kind::Sweep { failures: 0 } => {}
        Kind::Sweep { failures } => line(format!("runs that failed, and have empty rows: {failures}")),
        Kind::Comparison => line(
            "a comparison: ns_per_step and wall_s are times by the clock, which nothing can compute again"
                .to_owned(),
        ),
    }
    text
}
