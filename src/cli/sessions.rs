//! `gyrolab sessions`: what `--resume NAME` can come back to.

use super::{print, tell};
use crate::lab::Summary;
use crate::storage::confined::Confined;
use crate::storage::session::{self, Listed};
use crate::text::printable::{Shown, printable};
use anyhow::Context;
use std::fmt::Write;
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::time::{Duration, SystemTime};

pub(super) fn list(folder: Option<&Path>) -> anyhow::Result<ExitCode> {
    let within = |folder| Confined::within(folder).with_context(|| named(folder));
    let confined = folder.map(within).transpose()?;
    let folder = folder_of(confined.as_ref()).map_err(anyhow::Error::msg)?;
    let sessions = session::list(&folder)?;
    if sessions.is_empty() {
        tell(format_args!(
            "gyrolab: there are no sessions in {}",
            Shown(&folder)
        ));
        return Ok(ExitCode::SUCCESS);
    }
    let now = SystemTime::now();
    let head = ["NAME", "WRITTEN", "STEP", "IN USE", "RUN"].map(str::to_owned);
    let rows = sessions.iter().map(|session| row(session, now));
    let rows: Vec<_> = [head].into_iter().chain(rows).collect();
    let width = |column: usize| rows.iter().map(|row| row[column].chars().count()).max();
    let [a, b, c, d] = [0, 1, 2, 3].map(|column| width(column).unwrap_or(0));
    let mut text = String::new();
    for [name, written, step, in_use, run] in &rows {
        writeln!(
            text,
            "{name:<a$}  {written:<b$}  {step:>c$}  {in_use:<d$}  {run}"
        )?;
    }
    print(&text)
}

/// The folder of the sessions: of the user, or of a confined lab.
pub(super) fn folder_of(confined: Option<&Confined>) -> Result<PathBuf, String> {
    match confined {
        Some(confined) => confined.sessions(),
        None => session::folder(),
    }
}

pub(super) fn named(folder: &Path) -> String {
    format!("--folder {}", Shown(folder))
}

fn row(session: &Listed, now: SystemTime) -> [String; 5] {
    let content = session.content.as_ref().map_err(Clone::clone);
    let summary =
        content.and_then(|content| Summary::of(content).map_err(|error| error.to_string()));
    let (step, run) = match summary {
        Ok(summary) => (
            summary.step.to_string(),
            format!("{} ({})", summary.title, summary.name),
        ),
        Err(reason) => ("-".to_owned(), format!("cannot be read: {reason}")),
    };
    let in_use = match (session.is_in_use, session.owner) {
        (true, Some(process)) => format!("by process {process}"),
        (true, None) => "yes".to_owned(),
        (false, _) => "no".to_owned(),
    };
    let written = ago(now.duration_since(session.written).unwrap_or_default());
    [session.name.clone(), written, step, in_use, run].map(|text| printable(&text).into_owned())
}

/// How long ago, in the largest unit of which it is at least two.
fn ago(time: Duration) -> String {
    let seconds = time.as_secs();
    let units = [(86_400, "days"), (3600, "hours"), (60, "minutes")];
    let unit = units.into_iter().find(|(long, _)| seconds >= 2 * long);
    match unit {
        Some((long, name)) => format!("{} {name} ago", seconds / long),
        None if seconds >= 2 => format!("{seconds} seconds ago"),
        None => "just now".to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn times_are_in_the_largest_unit_that_fits_twice() {
        for (seconds, words) in [
            (0, "just now"),
            (119, "119 seconds ago"),
            (120, "2 minutes ago"),
            (7199, "119 minutes ago"),
            (7200, "2 hours ago"),
            (259_200, "3 days ago"),
        ] {
            assert_eq!(ago(Duration::from_secs(seconds)), words);
        }
    }
}
