//! `gyrolab sessions` and `--resume`: lists, opens and starts sessions of the lab, and prints messages on them to the
//! shell.

use super::args::{DisplayArgs, WorkbenchArgs};
use super::new_lab::{DEFAULT, marker, of_workbench, theme_for};
use super::{print, tell, warn};
use crate::engine::text::printable::{PrintablePath, printable};
use crate::lab::storage::confined::Confined;
use crate::lab::storage::session::{self, LeftAlone, ListedSession, Session};
use crate::lab::view::View;
use crate::lab::{Lab, SessionSummary, lessons_in};
use anyhow::{Context, bail};
use std::fmt::Write as _;
use std::io::{self, Write as _};
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::time::{Duration, SystemTime};
use toml::Table;

/// Time to wait for the disk at the end before the session is reported as not saved.
const SESSION_SAVE_LIMIT: Duration = Duration::from_secs(3);

pub(super) fn list(folder: Option<&Path>) -> anyhow::Result<ExitCode> {
    let confined = folder
        .map(|path| Confined::within(path).with_context(|| named(path)))
        .transpose()?;
    let sessions_folder = folder_of(confined.as_ref()).map_err(anyhow::Error::msg)?;
    let sessions = session::list(&sessions_folder)?;
    if sessions.is_empty() {
        tell(format_args!(
            "gyrolab: there are no sessions in {}",
            PrintablePath(&sessions_folder)
        ));
        return Ok(ExitCode::SUCCESS);
    }
    let now = SystemTime::now();
    let head = ["NAME", "WRITTEN", "STEP", "IN USE", "RUN"].map(str::to_owned);
    let rows = sessions.iter().map(|session| row(session, now));
    let rows: Vec<_> = [head].into_iter().chain(rows).collect();
    let [a, b, c, d] = [0, 1, 2, 3].map(|column| {
        rows.iter()
            .map(|row| row[column].chars().count())
            .max()
            .unwrap_or(0)
    });
    let mut text = String::new();
    for [name, written, step, in_use, run] in &rows {
        writeln!(
            text,
            "{name:<a$}  {written:<b$}  {step:>c$}  {in_use:<d$}  {run}"
        )?;
    }
    print(&text)
}

/// Returns the folder of the sessions: the user's folder, or the folder of a confined lab.
pub(super) fn folder_of(confined: Option<&Confined>) -> Result<PathBuf, String> {
    match confined {
        Some(confined) => confined.sessions(),
        None => session::folder(),
    }
}

pub(super) fn named(folder: &Path) -> String {
    format!("--folder {}", PrintablePath(folder))
}

fn row(session: &ListedSession, now: SystemTime) -> [String; 5] {
    let content = session.content.as_ref().map_err(Clone::clone);
    let summary = content
        .and_then(|content| SessionSummary::read(content).map_err(|error| error.to_string()));
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

/// Formats a time in the past in the largest unit that gives at least two, such as "2 hours ago".
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

/// Prints to the shell's screen which session can be resumed, and what could not be saved.
pub(super) fn tell_of_session(
    session: Result<Session, String>,
    folder: Option<&Path>,
) -> anyhow::Result<()> {
    let name = session.as_ref().map_or("", Session::name).to_owned();
    let closed = session.map(|session| session.close(SESSION_SAVE_LIMIT));
    let (kept, why) = match closed {
        Ok(closed) => (closed.kept, closed.trouble),
        Err(trouble) => (None, Some(trouble)),
    };
    let trouble = why.as_deref().map(printable);
    let Some(summary) = kept.and_then(|content| SessionSummary::read(&content).ok()) else {
        warn(format_args!(
            "gyrolab: there is no session to resume: {}",
            trouble.unwrap_or_else(|| "nothing was saved".into())
        ));
        return Ok(());
    };
    if let Some(trouble) = trouble {
        warn(format_args!(
            "gyrolab: the last changes are lost: {trouble}"
        ));
    }
    let option = folder.map_or(String::new(), |folder| {
        format!(" --folder {}", PrintablePath(folder))
    });
    let SessionSummary { title, step, .. } = summary;
    writeln!(
        io::stdout(),
        "gyrolab{option} --resume reopens step {step} of {} (session {name})",
        printable(&title)
    )?;
    Ok(())
}

/// A lab, the state of its lessons, and its session or the reason why there is none.
type SessionLab = (Lab, Table, Result<Session, String>);

/// Restores the lab of a session, with the look that the command line requests, and the state of its lessons.
fn resumed(
    content: &session::SessionContent,
    look: DisplayArgs,
    confined: Option<&Confined>,
) -> Result<(Lab, Table), String> {
    let lab = Lab::resumed(content, confined, |scenario| {
        View::new(scenario, marker(look.markers), theme_for(look))
    })
    .map_err(|error| error.to_string())?;
    Ok((lab, lessons_in(content)))
}

/// Opens the session `name`.
///
/// # Errors
/// Returns an error if the session is missing, in use or cannot be read.
pub(super) fn come_back_to(
    name: &str,
    args: &WorkbenchArgs,
    confined: Option<&Confined>,
    folder: Result<PathBuf, String>,
) -> anyhow::Result<SessionLab> {
    let sessions_folder = folder.map_err(anyhow::Error::msg)?;
    let name_shown = printable(name);
    let found = session::resume(&sessions_folder, Some(name), |content| {
        resumed(content, args.look, confined)
    })
    .with_context(|| format!("--resume {name_shown} (list sessions with gyrolab sessions)"))?;
    let passed_over = left_alone(&found.left_alone);
    let why = match (found.resumed, found.in_use_by.first()) {
        (Some((session, (lab, lessons))), _) => return Ok((lab, lessons, Ok(session))),
        (None, Some(process)) => format!("it is open in another lab, process {process}"),
        (None, None) if passed_over.is_empty() => "it is open in another lab".to_owned(),
        (None, None) => printable(passed_over.trim_end_matches("; ")).into_owned(),
    };
    bail!("--resume {name_shown}: {why}")
}

/// Opens the newest session that is not in use, or a new lab with a message if there is none. A damaged session, or a
/// folder that cannot be written, never prevents the lab from opening.
pub(super) fn come_back(
    args: &WorkbenchArgs,
    confined: Option<&Confined>,
    folder: Result<PathBuf, String>,
) -> anyhow::Result<SessionLab> {
    let found = folder.clone().and_then(|folder| {
        session::resume(&folder, None, |content: &session::SessionContent| {
            resumed(content, args.look, confined)
        })
        .map_err(|error| error.to_string())
    });
    let why_none = match found {
        Ok(found) => {
            let passed_over = left_alone(&found.left_alone) + &in_use(&found.in_use_by);
            if let Some((session, (mut lab, lessons))) = found.resumed {
                if !passed_over.is_empty() {
                    lab.messages_mut()
                        .keep_saying_first(&(passed_over + "this is an older one, "));
                }
                return Ok((lab, lessons, Ok(session)));
            }
            let none = if found.in_use_by.is_empty() {
                "no session to resume: "
            } else {
                ""
            };
            format!("{passed_over}{none}this is a new one")
        }
        Err(trouble) => trouble,
    };
    let mut lab = of_workbench(args, DEFAULT)?;
    lab.tell(why_none);
    Ok((lab, Table::new(), begun(folder)))
}

/// Describes newer sessions that are open in other labs, whose processes are `owners`. If a connection dies silently,
/// its lab stays alive until the system notices.
fn in_use(owners: &[u32]) -> String {
    if owners.is_empty() {
        return String::new();
    }
    let numbers: Vec<_> = owners.iter().map(ToString::to_string).collect();
    format!(
        "newer sessions are open in other labs (if their connection is dead, end them with kill: {}); ",
        numbers.join(" ")
    )
}

pub(super) fn begun(folder: Result<PathBuf, String>) -> Result<Session, String> {
    Session::begin(&folder?).map_err(|error| error.to_string())
}

fn left_alone(sessions: &[LeftAlone]) -> String {
    let names = sessions.iter().map(|one| {
        format!(
            "{} was skipped ({}); ",
            PrintablePath(&one.path),
            one.reason
        )
    });
    names.collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ages_use_the_largest_unit_that_fits_twice() {
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
