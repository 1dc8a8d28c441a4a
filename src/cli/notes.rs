//! `gyrolab lesson --notes` and `--answers`: the teacher's notes for an open lesson, and the answers that a student
//! hands in.

use super::args::LessonArgs;
use super::new_lab::{new_lab, paper_format, refused, write};
use super::progress::{self, Interrupted, Interruption, LiveLine};
use super::sessions;
use crate::engine::text::printable::{printable, printable_lines};
use crate::engine::text::wrap::wrapped;
use crate::lab::lessons_in;
use crate::lab::storage::confined::Confined;
use crate::lab::storage::session::{self, ListedSession};
use crate::lessons::clock;
use crate::lessons::page::for_teacher;
use crate::lessons::predictions::LessonProgress;
use crate::lessons::state::KeptLessons;
use crate::lessons::{Lesson, handout, opening};
use anyhow::{bail, ensure};
use std::io::{self, IsTerminal, Stdout, Write};
use std::path::Path;
use std::process::ExitCode;
use std::thread;
use std::time::{Duration, SystemTime};

/// Width of the notes, in columns.
const NOTES_WIDTH: usize = 78;
/// Time between two checks of the session.
const NOTES_POLL_INTERVAL: Duration = Duration::from_millis(500);

/// Prints or writes the predictions in the lesson `name` next to the results.
pub(super) fn answers(
    args: &LessonArgs,
    name: &str,
    confined: Option<&Confined>,
) -> anyhow::Result<ExitCode> {
    let lesson = opening::open(name)?;
    let full_name = opening::full_name(name);
    let folder = sessions::folder_of(confined).map_err(anyhow::Error::msg)?;
    let found = session::list(&folder)?.into_iter().filter_map(|session| {
        let mut lessons = lessons_of(&session)?.lessons;
        let place = lessons.remove(&full_name)?;
        (!place.predictions.is_empty() || !place.tasks.is_empty())
            .then_some((session.written, place))
    });
    let newest: Option<(SystemTime, LessonProgress)> = found.max_by_key(|(written, _)| *written);
    let Some((_, place)) = newest else {
        let name = printable(name);
        bail!("no session contains a prediction for {name}: open it with gyrolab lesson {name}");
    };
    let format = paper_format(args);
    write(args, |go_on| {
        let markdown = handout::answers(&lesson, &place, new_lab(args.look)?, go_on)
            .map_err(|problem| refused(&lesson, problem))?;
        Ok(format.written(&lesson.title, markdown))
    })
}

/// Prints the teacher's notes for the open page in the lab of the session `name`, and follows it to the next pages
/// until Ctrl-C. An empty `name` means the newest session with an open lesson.
pub(super) fn notes(name: &str) -> anyhow::Result<ExitCode> {
    let folder = sessions::folder_of(None).map_err(anyhow::Error::msg)?;
    let interruption = progress::interruption()?;
    let Some(found) = find(&folder, name)? else {
        ensure!(
            !name.is_empty(),
            "no lesson is open in any lab of this login: open one with gyrolab lesson NAME"
        );
        bail!(
            "--notes {}: there is no such session with an open lesson (list sessions with gyrolab sessions)",
            printable(name)
        )
    };
    let line = live_line();
    let followed = watch_session(&folder, &found, line.as_ref(), &interruption);
    drop(line);
    followed?;
    bail!(Interrupted)
}

/// Returns the name of the session to follow. An empty `name` selects the session in use with an open lesson that was
/// written last.
fn find(folder: &Path, name: &str) -> anyhow::Result<Option<String>> {
    let open = session::list(folder)?
        .into_iter()
        .filter(|session| session.name == name || name.is_empty() && session.is_in_use)
        .filter(|session| open_in(session).is_some());
    let newest = open.max_by_key(|session| session.written);
    Ok(newest.map(|session| session.name))
}

fn lessons_of(session: &ListedSession) -> Option<KeptLessons> {
    let content = session.content.as_ref().ok()?;
    KeptLessons::read(&lessons_in(content)).ok()
}

/// Returns the open lesson in `session`, and its progress.
fn open_in(session: &ListedSession) -> Option<(String, LessonProgress)> {
    let mut lessons = lessons_of(session)?;
    let open = lessons.open?;
    let place = lessons.lessons.remove(&open)?;
    Some((open, place))
}

/// Returns a line at the bottom of the terminal that can be updated; `None` without a terminal.
fn live_line() -> Option<LiveLine<Stdout>> {
    let stdout = io::stdout();
    stdout.is_terminal().then(|| LiveLine::new(stdout))
}

/// Prints the notes of each page when it is opened, until a signal arrives.
fn watch_session(
    folder: &Path,
    name: &str,
    line: Option<&LiveLine<Stdout>>,
    interruption: &Interruption,
) -> io::Result<()> {
    let mut seen = None;
    let mut open: Option<(Lesson, LessonProgress)> = None;
    while !interruption.has_come() {
        let found = session::look_at(folder, name);
        let saved = found.as_ref().map(|session| session.written);
        if saved != seen {
            seen = saved;
            let now = found
                .as_ref()
                .and_then(open_in)
                .and_then(|(lesson, place)| Some((opening::open(&lesson).ok()?, place)));
            let page =
                |(lesson, place): &(Lesson, LessonProgress)| (lesson.name.clone(), place.page);
            if let Some((lesson, place)) = &now
                && now.as_ref().map(page) != open.as_ref().map(page)
            {
                tell(line, &for_teacher(lesson, place.page, |_| String::new()))?;
            }
            open = now;
        }
        let text = match &open {
            Some(_) if !found.is_some_and(|session| session.is_in_use) => {
                "the lab is closed; press Ctrl-C to stop".to_owned()
            }
            Some((lesson, place)) => times(lesson, place),
            None => "no lesson is open there; press Ctrl-C to stop".to_owned(),
        };
        if let Some(line) = line {
            line.show(&text);
        }
        thread::sleep(NOTES_POLL_INTERVAL);
    }
    Ok(())
}

/// Prints `text` above the live line, wrapped between words.
fn tell(live: Option<&LiveLine<Stdout>>, text: &str) -> io::Result<()> {
    let lines: Vec<String> = text
        .lines()
        .flat_map(|line| wrapped(line, NOTES_WIDTH))
        .collect();
    let words = lines.join("\n");
    let shown = printable_lines(&words);
    if let Some(line) = live {
        line.print_above(&shown);
        return Ok(());
    }
    let mut stdout = io::stdout();
    writeln!(stdout, "{shown}")?;
    stdout.flush()
}

fn times(lesson: &Lesson, place: &LessonProgress) -> String {
    let since = clock::unix_s().saturating_sub(place.began_unix_s);
    clock::shown(Duration::from_secs(since), lesson.minutes)
}
