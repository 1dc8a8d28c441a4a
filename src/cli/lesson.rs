//! `gyrolab lesson`: lists lessons, opens one in the lab, or prints it; and `check` of a lesson.

use super::args::{DisplayArgs, LessonArgs};
use super::new_lab::{new_lab, paper_format, refused, write};
use super::{notes, print, progress, sessions, tell, warn, workbench};
use crate::engine::scenario::Problems;
use crate::engine::text::number::counted;
use crate::engine::text::printable::{PrintablePath, printable_lines};
use crate::engine::text::wrap::columns;
use crate::lab::Lab;
use crate::lab::storage::confined::Confined;
use crate::lab::view::Pane;
use crate::lessons::handout::{self, Handout, LabPictures, Paper};
use crate::lessons::lesson::LessonLevel;
use crate::lessons::play::{self, LessonWalk};
use crate::lessons::state::files_in;
use crate::lessons::{Lesson, LessonPage, opening, shipped, teacher};
use anyhow::Context;
use std::io::{self, IsTerminal};
use std::path::Path;
use std::process::ExitCode;

/// Size of the pictures, in columns and rows.
const PICTURE: (u16, u16) = (80, 24);
/// Size of a pane's picture on paper.
const SPACE_PICTURE: (u16, u16) = (72, 26);
const STEP_PICTURE: (u16, u16) = (80, 29);

pub(super) fn lesson(args: &LessonArgs) -> anyhow::Result<ExitCode> {
    if let Some(session) = &args.notes {
        return notes::notes(session);
    }
    if args.template {
        return write(args, |_| Ok(shipped::TEMPLATE.to_owned()));
    }
    let confined = args
        .folder
        .as_deref()
        .map(|folder| Confined::enter(folder).with_context(|| sessions::named(folder)))
        .transpose()?;
    let Some(name) = &args.name else {
        let listed = if args.list { long_list } else { list };
        return print(&listed(confined.as_ref())?);
    };
    if let Some(folder) = &confined {
        admit(name, folder)?;
    }
    if args.answers {
        return notes::answers(args, name, confined.as_ref());
    }
    if let Some(language) = &args.frame {
        return print_frame(args, name, language);
    }
    let lesson = opening::open(name)?;
    if args.handout || args.teacher {
        return on_paper(&lesson, args);
    }
    let page = page_of(&lesson, args)?;
    if io::stdin().is_terminal() && io::stdout().is_terminal() {
        return workbench::open_lesson(&lesson, page, args, confined);
    }
    print_page(&lesson, page, args.look)
}

/// Writes or prints the worksheet, the results or the teacher's sheet of `lesson`.
fn on_paper(lesson: &Lesson, args: &LessonArgs) -> anyhow::Result<ExitCode> {
    let format = paper_format(args);
    write(args, |go_on| {
        let lab = new_lab(args.look)?;
        let made = if args.teacher {
            let sheet = teacher::sheet(lesson, lab, go_on);
            sheet.map(|markdown| format.written(&lesson.title, markdown))
        } else {
            let handout = Handout {
                lesson,
                paper: if args.results {
                    Paper::Results
                } else {
                    Paper::Worksheet
                },
                format,
                pictures: LabPictures {
                    screen: picture,
                    pane: pane_picture,
                },
            };
            handout.write(lab, go_on)
        };
        made.map_err(|problem| refused(lesson, problem))
    })
}

/// Checks that the lesson `name` is shipped with the program or is in `folder`.
pub(super) fn admit(name: &str, folder: &Confined) -> anyhow::Result<()> {
    if opening::is_file_name(name) {
        let name = opening::full_name(name);
        let inside = folder.check_reading(Path::new(&name));
        inside.map_err(anyhow::Error::msg)?;
    }
    Ok(())
}

fn print_frame(args: &LessonArgs, name: &str, language: &str) -> anyhow::Result<ExitCode> {
    let frame = shipped::frame(name, language)
        .with_context(|| format!("{name}: has no program to write; use write-it-yourself"))?;
    write(args, |_| Ok(frame.to_owned()))
}

fn print_page(lesson: &Lesson, page: &LessonPage, look: DisplayArgs) -> anyhow::Result<ExitCode> {
    tell(format_args!(
        "gyrolab: no terminal is available, so page {} of {} is printed",
        page.number,
        lesson.pages.len()
    ));
    let interruption = progress::interruption()?;
    let mut walk = LessonWalk::new(lesson, new_lab(look)?);
    let walked = walk.jump(page, &mut interruption.meter());
    walked.map_err(|problem| refused(lesson, problem))?;
    let text = handout::page(page, &walk, picture);
    interruption.may_act_at_once()?;
    print(&text)
}

/// Returns the lessons in the folder and the shipped ones, each with the name that opens it.
fn lessons(folder: Option<&Confined>) -> anyhow::Result<Vec<(String, Lesson)>> {
    let mut all = Vec::new();
    for path in folder
        .map(|folder| files_in(folder.lessons()))
        .unwrap_or_default()
    {
        let name = Path::new(&path).file_name().unwrap_or_default();
        let printable = PrintablePath(Path::new(name)).to_string();
        all.push((printable, opening::open(&path)?));
    }
    for shipped in shipped::LESSONS {
        all.push((shipped.name.to_owned(), opening::open(shipped.name)?));
    }
    Ok(all)
}

/// Lists each lesson on a line: name and title.
fn list(folder: Option<&Confined>) -> anyhow::Result<String> {
    let lines = lessons(folder)?.into_iter();
    Ok(lines
        .map(|(name, lesson)| format!("{name}: {}\n", lesson.title))
        .collect())
}

/// Lists the lessons by level, in the order in which they build on each other, with their duration and requirements.
fn long_list(folder: Option<&Confined>) -> anyhow::Result<String> {
    let lessons = lessons(folder)?;
    let names = lessons.iter().map(|(name, _)| columns(name));
    let width = names.max().unwrap_or_default();
    let mut text = String::new();
    for group in lessons.chunk_by(|a, b| a.1.guide.level == b.1.guide.level) {
        let level = group.first().and_then(|(_, lesson)| lesson.guide.level);
        let heading = level.map_or("without a level", LessonLevel::name);
        text += if text.is_empty() { "" } else { "\n" };
        text += &format!("{heading}\n");
        for (name, lesson) in group {
            let minutes = lesson
                .minutes
                .map_or(String::new(), |minutes| format!("{minutes} min"));
            let padding = " ".repeat(width - columns(name));
            text += &format!("  {name}{padding}  {minutes:>6}  {}\n", lesson.title);
            if let Some(needs) = lesson.guide.needs_in_words() {
                let indent = " ".repeat(width + 12);
                text += &format!("{indent}{needs}\n");
            }
        }
    }
    Ok(text)
}

/// Returns the requested page, or the first page by default.
fn page_of<'a>(lesson: &'a Lesson, args: &LessonArgs) -> anyhow::Result<&'a LessonPage> {
    let number = args.page.map_or(1, std::num::NonZeroU64::get);
    let page = usize::try_from(number)
        .ok()
        .and_then(|place| lesson.page(place));
    let (name, last) = (&lesson.name, lesson.pages.len());
    page.with_context(|| format!("--page {number}: {name} has the pages 1 to {last}"))
}

fn picture(lab: &Lab) -> String {
    crate::tui::screen::text(lab, false, PICTURE)
}

fn pane_picture(lab: &Lab, pane: Pane) -> String {
    let size = if pane == Pane::Step {
        STEP_PICTURE
    } else {
        SPACE_PICTURE
    };
    crate::tui::svg::pane(lab, pane, size)
}

/// Plays the lesson `file` to its end. Returns a description, or the problems found.
///
/// # Errors
/// Returns an error if the preset of a new lab cannot be opened, or if a signal arrives.
pub(super) fn checked(file: &Path) -> anyhow::Result<Result<String, Problems>> {
    let lesson = match opening::read_file(file) {
        Ok(lesson) => lesson,
        Err(problems) => return Ok(Err(problems)),
    };
    let interruption = progress::interruption()?;
    let lab = new_lab(DisplayArgs::default())?;
    let played = play::check(&lesson, lab, &mut interruption.meter());
    interruption.may_act_at_once()?;
    Ok(played.map(|unstated| {
        for problem in unstated {
            let told = Problems::one(lesson.origin.clone(), problem).to_string();
            warn(printable_lines(&told));
        }
        described(&lesson)
    }))
}

fn described(lesson: &Lesson) -> String {
    let pages = lesson.pages.iter();
    let predictions: usize = pages.clone().map(|page| page.predicts().count()).sum();
    let checks: usize = pages.clone().map(|page| page.checks().count()).sum();
    format!(
        "good: \"{}\", {}, {}, {}",
        lesson.title,
        counted(pages.len() as u64, "page"),
        counted(predictions as u64, "prediction"),
        counted(checks as u64, "check"),
    )
}
