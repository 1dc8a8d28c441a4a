//! The session of a lab: coming back to one, beginning one, and what is said of it on the shell's screen.

use super::{PATIENCE, new};
use crate::cli::args::{Look, WorkbenchArgs};
use crate::cli::new_lab::{DEFAULT, marker, theme};
use crate::cli::tell;
use crate::lab::view::View;
use crate::lab::{Lab, Summary};
use crate::scenario::Scenario;
use crate::storage::confined::Confined;
use crate::storage::session::{self, LeftAlone, Session};
use crate::text::printable::{Shown, printable};
use crate::tui::panes;
use anyhow::{Context, bail};
use std::io::{self, Write};
use std::path::{Path, PathBuf};

/// Says on the shell's screen what can be come back to, as the disk has it; and what was not kept, and why.
pub(super) fn tell_of_session(
    session: Result<Session, String>,
    folder: Option<&Path>,
) -> anyhow::Result<()> {
    let name = session.as_ref().map_or("", Session::name).to_owned();
    let closed = session.map(|session| session.close(PATIENCE));
    let (kept, trouble) = match closed {
        Ok(closed) => (closed.kept, closed.trouble),
        Err(trouble) => (None, Some(trouble)),
    };
    let trouble = trouble.as_deref().map(printable);
    let Some(summary) = kept.and_then(|content| Summary::of(&content).ok()) else {
        tell(format_args!(
            "gyrolab: there is no session to come back to: {}",
            trouble.unwrap_or_else(|| "nothing was kept".into())
        ));
        return Ok(());
    };
    if let Some(trouble) = trouble {
        tell(format_args!(
            "gyrolab: what was done last is lost: {trouble}"
        ));
    }
    let folder = folder.map_or(String::new(), |folder| {
        format!(" --folder {}", Shown(folder))
    });
    let Summary { title, step, .. } = summary;
    writeln!(
        io::stdout(),
        "gyrolab{folder} --resume comes back to step {step} of {} (session {name})",
        printable(&title)
    )?;
    Ok(())
}

/// The lab that a session has kept, as the command line wants it to look.
fn resumed(
    content: &session::Content,
    look: Look,
    confined: Option<&Confined>,
) -> Result<Lab, String> {
    let view =
        |scenario: &Scenario| View::new(scenario, marker(look.markers), theme(look), &panes::IDS);
    Lab::resumed(content, confined, view).map_err(|error| error.to_string())
}

/// The session called `name`, or an error that says why it cannot be had.
pub(super) fn come_back_to(
    name: &str,
    args: &WorkbenchArgs,
    confined: Option<&Confined>,
    folder: Result<PathBuf, String>,
) -> anyhow::Result<(Lab, Result<Session, String>)> {
    let folder = folder.map_err(anyhow::Error::msg)?;
    let name_shown = printable(name);
    let read = |content: &session::Content| resumed(content, args.look, confined);
    let found = session::resume(&folder, Some(name), read)
        .with_context(|| format!("--resume {name_shown} (gyrolab sessions lists what there is)"))?;
    let passed_over = left_alone(&found.left_alone);
    let why = match (found.resumed, found.in_use_by.first()) {
        (Some((session, lab)), _) => return Ok((lab, Ok(session))),
        (None, Some(process)) => format!("it is open in another lab, process {process}"),
        (None, None) if passed_over.is_empty() => "it is open in another lab".to_owned(),
        (None, None) => printable(passed_over.trim_end_matches("; ")).into_owned(),
    };
    bail!("--resume {name_shown}: {why}")
}

/// The newest session that is not in use; where there is none, a new lab that says so. What is damaged, or cannot be
/// kept, never keeps the lab from opening.
pub(super) fn come_back(
    args: &WorkbenchArgs,
    confined: Option<&Confined>,
    folder: Result<PathBuf, String>,
) -> anyhow::Result<(Lab, Result<Session, String>)> {
    let read = |content: &session::Content| resumed(content, args.look, confined);
    let found = folder
        .clone()
        .and_then(|folder| session::resume(&folder, None, read).map_err(|error| error.to_string()));
    let why_none = match found {
        Ok(found) => {
            let passed_over = left_alone(&found.left_alone) + &in_use(&found.in_use_by);
            if let Some((session, mut lab)) = found.resumed {
                if !passed_over.is_empty() {
                    lab.messages_mut()
                        .keep_saying_first(&(passed_over + "this is an older one, "));
                }
                return Ok((lab, Ok(session)));
            }
            let none = if found.in_use_by.is_empty() {
                "no session to come back to: "
            } else {
                ""
            };
            format!("{passed_over}{none}this is a new one")
        }
        Err(trouble) => trouble,
    };
    let mut lab = new(args, DEFAULT)?;
    lab.tell(why_none);
    Ok((lab, begun(folder)))
}

/// Says that newer sessions are open in other labs, of the processes `owners`. A line that has died without a word keeps
/// its lab alive for as long as the system believes in it.
fn in_use(owners: &[u32]) -> String {
    if owners.is_empty() {
        return String::new();
    }
    let numbers: Vec<_> = owners.iter().map(ToString::to_string).collect();
    format!(
        "newer sessions are open in other labs (where the line is dead, kill frees them: {}); ",
        numbers.join(" ")
    )
}

pub(super) fn begun(folder: Result<PathBuf, String>) -> Result<Session, String> {
    Session::begin(&folder?).map_err(|error| error.to_string())
}

fn left_alone(sessions: &[LeftAlone]) -> String {
    let names = sessions
        .iter()
        .map(|one| format!("{} is left alone ({}); ", Shown(&one.path), one.reason));
    names.collect()
}
