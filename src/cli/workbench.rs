//! `gyrolab` and `gyrolab show`: opens the lab, or prints it as a picture.

use super::args::{LessonArgs, MeasuredArgs, WorkbenchArgs};
use super::new_lab::{DEFAULT, of_workbench, variable};
use super::sessions::{self, begun, come_back, come_back_to, tell_of_session};
use super::settings;
use super::show::{ShowArgs, print_picture};
use crate::class::{ClassRole, NoClass};
use crate::engine::text::printable::{PrintablePath, printable};
use crate::lab::Lab;
use crate::lab::command;
use crate::lab::storage::confined::Confined;
use crate::lab::storage::exporting;
use crate::lab::view::FPS;
use crate::lab::view::theme::Palette;
use crate::lessons::{Lesson, LessonPage, Lessons};
use crate::tui::app;
use crate::tui::theme::{self, ColorChoice};
use anyhow::Context;
use std::fs;
use std::io::{self, IsTerminal, Write};
use std::path::Path;
use std::process::ExitCode;
use std::sync::Arc;
use toml::Table;

/// Opens the lab on the terminal at a page of a lesson.
pub(super) fn open_lesson(
    lesson: &Lesson,
    page: &LessonPage,
    args: &LessonArgs,
    confined: Option<Confined>,
) -> anyhow::Result<ExitCode> {
    let args = WorkbenchArgs {
        paused: true,
        look: args.look,
        folder: args.folder.clone(),
        ..WorkbenchArgs::default()
    };
    let page = Some((lesson, page.number));
    open_at(&args, DEFAULT, confined, page, None)
}

pub(super) fn open(args: &WorkbenchArgs) -> anyhow::Result<ExitCode> {
    let name = args.scenario.as_deref().unwrap_or(DEFAULT);
    let confined = args
        .folder
        .as_deref()
        .map(|folder| Confined::enter(folder).with_context(|| sessions::named(folder)))
        .transpose()?;
    if let Some(folder) = &confined {
        folder
            .check(Path::new(name))
            .map_err(anyhow::Error::msg)
            .with_context(|| printable(name).into_owned())?;
    }
    if !(io::stdin().is_terminal() && io::stdout().is_terminal()) {
        anyhow::ensure!(args.resume.is_none(), "--resume needs a terminal");
        if let Some(file) = &args.commands
            && file != Path::new("-")
        {
            // A missing file is reported before the message below.
            fs::metadata(file)
                .with_context(|| format!("{}: cannot be read", PrintablePath(file)))?;
        }
        let why = format!(
            "gyrolab: no terminal is available, so the lab's picture {} is printed",
            moment(args)
        );
        let picture = ShowArgs {
            scenario: args.scenario.clone(),
            changes: args.changes.clone(),
            at: args.at,
            commands: args.commands.clone(),
            beside: args.beside.clone(),
            size: (80, 24),
            markers: args.look.markers,
            ..ShowArgs::default()
        };
        return print_picture(&picture, Some(&why), confined);
    }
    open_at(args, name, confined, None, None)
}

/// Opens the lab on the terminal with the scenario `name`. `lesson` is a lesson with a page number; `class_role` is the
/// lab's role in a class.
pub(super) fn open_at(
    args: &WorkbenchArgs,
    name: &str,
    confined: Option<Confined>,
    lesson: Option<(&Lesson, usize)>,
    class_role: Option<Box<dyn ClassRole>>,
) -> anyhow::Result<ExitCode> {
    let is_alone = class_role.is_none();
    let mut role = class_role.unwrap_or(Box::new(NoClass));
    // A write past `ulimit -f` then fails like a write to a full disk, instead of ending the process.
    signal_hook::flag::register(signal_hook::consts::SIGXFSZ, Arc::default())?;
    let commands = args.commands.as_deref().map(command::open).transpose()?;
    let folder = sessions::folder_of(confined.as_ref());
    let settings_in = folder.as_deref().ok();
    let chosen = settings::read(settings_in, confined.is_some());
    let args = &chosen.complete(args);
    let (mut lab, kept, session) = match args.resume.as_deref() {
        Some("") => come_back(args, confined.as_ref(), folder.clone())?,
        Some(session) => come_back_to(session, args, confined.as_ref(), folder.clone())?,
        None => {
            let lab = of_workbench(args, name)?;
            (lab, Table::new(), begun(folder.clone()))
        }
    };
    chosen.tell(&mut lab);
    lab.settings.folder = folder.ok();
    furnish(&mut lab, args, confined)?;
    lab.set_trouble(session.as_ref().err().cloned());
    lab.take_advice();
    if let Some(commands) = commands {
        lab.take_commands(commands);
    }
    let mut lessons = open_lessons(&mut lab, role.lessons(kept), lesson)?;
    let ran = app::run(&mut lab, &mut lessons, &mut *role, session.as_ref().ok());
    ran.context("the terminal cannot be used")?;
    tell_of_exports(&lab)?;
    if is_alone {
        tell_of_session(session, args.folder.as_deref())?;
        return Ok(ExitCode::SUCCESS);
    }
    drop(session);
    super::print(&(role.leave().map_err(anyhow::Error::msg)? + "\n"))
}

/// Sets the folder, the measured data and the terminal's abilities of `lab`.
pub(super) fn furnish(
    lab: &mut Lab,
    args: &WorkbenchArgs,
    confined: Option<Confined>,
) -> anyhow::Result<()> {
    if let Some(folder) = confined {
        lab.files_mut().confine(folder);
    }
    let MeasuredArgs { measured, columns } = &args.beside;
    if args.resume.is_none() || measured.is_some() {
        lab.begin_with_measured(measured.as_deref(), &columns.options())?;
    }
    lab.view_mut().mouse = !args.look.no_mouse;
    lab.view_mut().fps = args.fps.unwrap_or(FPS);
    lab.settings.usual_palette = Some(theme::theme(ColorChoice::Auto, variable).palette);
    // The Linux console would print the query for the background color.
    let is_console = variable("TERM").is_none_or(|term| ["linux", "dumb"].contains(&term.as_str()));
    lab.settings.asks_background = args.look.background.is_none()
        && variable("COLORFGBG").is_none()
        && lab.view().theme.palette != Palette::Plain
        && !is_console;
    Ok(())
}

/// Restores the lessons that a session has `kept`, and opens the requested page, if any.
fn open_lessons(
    lab: &mut Lab,
    kept: Table,
    lesson: Option<(&Lesson, usize)>,
) -> anyhow::Result<Lessons> {
    let (mut lessons, opened) = Lessons::resumed(kept, lab);
    if let Err(reason) = opened {
        lab.tell(format!("the lesson cannot be reopened: {reason}"));
    }
    if let Some((lesson, page)) = lesson {
        let open = lessons.open_lesson();
        if open.is_none_or(|open| (&open.lesson.name, open.place.page) != (&lesson.name, page)) {
            lessons
                .open(&lesson.name, Some(page), lab)
                .map_err(anyhow::Error::msg)?;
        }
    }
    Ok(lessons)
}

fn moment(args: &WorkbenchArgs) -> String {
    match (&args.commands, args.at) {
        (Some(file), _) if file == Path::new("-") => "after the commands on stdin".to_owned(),
        (Some(file), _) => format!("after the commands in {}", PrintablePath(file)),
        (None, Some(step)) => format!("at step {step}"),
        (None, None) => "at the end of the run".to_owned(),
    }
}

/// Prints the exported files on the shell's screen, because the lab's last message disappears with the lab.
fn tell_of_exports(lab: &Lab) -> io::Result<()> {
    let mut stdout = io::stdout().lock();
    for written in &lab.files().written {
        let path = PrintablePath(&written.path);
        let rows = written
            .rows
            .map(|rows| format!(": {rows} rows"))
            .unwrap_or_default();
        let scp = exporting::scp_line(&written.path);
        match scp.filter(|_| !lab.files().confined().is_some_and(Confined::is_seat)) {
            Some(line) => writeln!(
                stdout,
                "{path}{rows}; to download it, run on your own computer:\n  {line}"
            ),
            None => writeln!(stdout, "{path}{rows}"),
        }?;
    }
    Ok(())
}
