//! Creates labs: one with the scenario, colors and dots of the command line, and one without a terminal for playing a
//! lesson. Also writes the output of lessons.

use super::args::{DisplayArgs, LessonArgs, SetArgs, WorkbenchArgs, change};
use super::progress::{self, Interrupted};
use super::{print, refuse, tell};
use crate::engine::export::Destination;
use crate::engine::scenario::{Document, Problem, Problems};
use crate::engine::text::printable::PrintablePath;
use crate::lab::Lab;
use crate::lab::view::View;
use crate::lab::view::theme::Marker;
use crate::lab::view::theme::Theme;
use crate::lessons::handout::PaperFormat;
use crate::lessons::{Lesson, play};
use crate::tui::theme;
use anyhow::{Context, bail};
use clap::error::ErrorKind;
use std::ops::ControlFlow;
use std::path::Path;
use std::process::ExitCode;
use std::sync::Arc;

/// The scenario that is opened by default.
pub(super) const DEFAULT: &str = "method-2";

/// Creates a lab with the scenario `name` and these changes.
pub(super) fn open_lab(
    name: &str,
    changes: &SetArgs,
    markers: Option<Marker>,
    theme: Theme,
    running: bool,
) -> anyhow::Result<Lab> {
    // Read only once, because a FIFO cannot be read again.
    let mut document = Document::open(name)?;
    // A file that is valid only after the changes has no note that they could make obsolete.
    let file = document.scenario().ok();
    change(&mut document, changes)?;
    let scenario = Arc::new(document.scenario()?);
    let view = View::new(&scenario, marker(markers), theme);
    let mut lab = Lab::new(name, scenario, view, running);
    if let Some(file) = file {
        lab.set_file(&Arc::new(file));
    }
    Ok(lab)
}

/// Returns the environment variable `name`, if it is set to valid Unicode.
pub(super) fn variable(name: &str) -> Option<String> {
    std::env::var(name).ok()
}

/// Returns the theme that `look` requests, or one that suits the terminal.
pub(super) fn theme_for(look: DisplayArgs) -> Theme {
    let suited = theme::theme(look.color.unwrap_or_default(), variable);
    Theme {
        background: look.background.unwrap_or(suited.background),
        ..suited
    }
}

/// Returns the requested markers, or the ones that suit locale and terminal.
pub(super) fn marker(markers: Option<Marker>) -> Marker {
    markers.unwrap_or_else(|| theme::marker(variable))
}

/// Creates a lab with the scenario `name` as the command line requests.
pub(super) fn of_workbench(args: &WorkbenchArgs, name: &str) -> anyhow::Result<Lab> {
    let (markers, theme) = (args.look.markers, theme_for(args.look));
    let mut lab = open_lab(name, &args.changes, markers, theme, !args.paused)?;
    if let Some(step) = args.at {
        // No signal handler is installed yet. A signal that ends the process here leaves nothing to clean up.
        lab.begin_at(step, |_, _| ControlFlow::Continue(()))
            .with_context(|| name.to_owned())?;
    }
    Ok(lab)
}

/// Creates a lab without colors.
pub(super) fn new_lab(look: DisplayArgs) -> anyhow::Result<Lab> {
    let changes = SetArgs::default();
    open_lab(DEFAULT, &changes, look.markers, Theme::PLAIN, false)
}

pub(super) fn refused(lesson: &Lesson, problem: Problem) -> anyhow::Error {
    Problems::one(lesson.origin.clone(), problem).into()
}

/// Returns the format of the requested file: HTML if its name says so, else Markdown or text.
///
/// Ends the process with a message, as clap does, if the file is a PDF.
pub(super) fn paper_format(args: &LessonArgs) -> PaperFormat {
    let extension = args.output.as_deref().and_then(Path::extension);
    let lower = extension.map(|name| name.to_string_lossy().to_lowercase());
    match lower.as_deref() {
        Some("pdf") => {
            let message = "-o FILE.pdf: PDF is not supported; write FILE.html and save it as PDF from a browser";
            refuse("lesson", ErrorKind::ValueValidation, message)
        }
        Some("html" | "htm") => PaperFormat::Html,
        _ => PaperFormat::Markdown,
    }
}

/// Writes the result of `make` to the requested file, or prints it. `make` calls its argument regularly to check if it
/// should stop.
pub(super) fn write(
    args: &LessonArgs,
    make: impl FnOnce(play::LessonProgressCallback<'_>) -> anyhow::Result<String>,
) -> anyhow::Result<ExitCode> {
    let (output, interruption) = progress::open(args.output.as_deref(), args.force)?;
    let text = make(&mut interruption.meter());
    if interruption.has_come() {
        bail!(Interrupted);
    }
    match (output, &args.output) {
        (None | Some(Destination::Stdout(_)), _) | (_, None) => print(&text?),
        (Some(output), Some(path)) => {
            interruption.keep(output, text?.as_bytes())?;
            tell(format_args!("gyrolab: wrote {}", PrintablePath(path)));
            Ok(ExitCode::SUCCESS)
        }
    }
}
