//! `gyrolab lesson --notes` and `--answers`: what a session holds of a lesson, for the teacher beside the lab and for the
//! student who hands it in.

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

/// Columns of the notes.
const NOTES_WIDTH: usize = 78;
/// How often the session is looked at.
const NOTES_POLL_INTERVAL: Duration = Duration::from_millis(500);

/// Prints or writes what was predicted in the lesson `args.name` beside what came out.
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
        bail!("no session holds a prediction for {name}: gyrolab lesson {name} opens it");
    };
    let format = paper_format(args);
    write(args, |go_on| {
        let markdown = handout::answers(&lesson, &place, new_lab(args.look)?, go_on)
            .map_err(|problem| refused(&lesson, problem))?;
        Ok(format.written(&lesson.title, markdown))
    })
}

/// Prints the teacher's notes of the page that is open in the lab of the session called `name`, or of the newest session
/// with an open lesson if that is empty, and goes on with the next page until Ctrl-C.
pub(super) fn notes(name: &str) -> anyhow::Result<ExitCode> {
    let folder = sessions::folder_of(None).map_err(anyhow::Error::msg)?;
    let interruption = progress::interruption()?;
    let Some(found) = find(&folder, name)? else {
        ensure!(
            !name.is_empty(),
            "no lesson is open in any lab of this login: gyrolab lesson NAME opens one"
        );
        bail!(
            "--notes {}: there is no such session with an open lesson (gyrolab sessions lists what there is)",
            printable(name)
        )
    };
    let line = live_line();
    let followed = watch_session(&folder, &found, line.as_ref(), &interruption);
    drop(line);
    followed?;
    bail!(Interrupted)
}

/// Returns the name of the session that is meant: of those with an open lesson, the one in use that was written last.
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

/// Returns the lesson that is open in `session`, and its page.
fn open_in(session: &ListedSession) -> Option<(String, LessonProgress)> {
    let mut lessons = lessons_of(session)?;
    let open = lessons.open?;
    let place = lessons.lessons.remove(&open)?;
    Some((open, place))
}

/// Returns a line at the bottom of the terminal that changes; without a terminal there is none.
fn live_line() -> Option<LiveLine<Stdout>> {
    let stdout = io::stdout();
    stdout.is_terminal().then(|| LiveLine::new(stdout))
}

/// Prints the notes of each page as it is opened, until a signal comes.
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
                "the lab was left; Ctrl-C ends this".to_owned()
            }
            Some((lesson, place)) => times(lesson, place),
            None => "no lesson is open there; Ctrl-C ends this".to_owned(),
        };
        if let Some(line) = line {
            line.show(&text);
        }
        thread::sleep(NOTES_POLL_INTERVAL);
    }
    Ok(())
}

/// Prints `text` above the live line, in lines that end between words.
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
