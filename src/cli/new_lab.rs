//! A new lab, with the scenario, the colors and the dots that the command line asks for; one in which a lesson is played
//! without a terminal, and where what comes of it is written.

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

/// What is opened where nothing is named.
pub(super) const DEFAULT: &str = "method-2";

/// A lab with what `name` names, changed.
pub(super) fn open_lab(
    name: &str,
    changes: &SetArgs,
    markers: Option<Marker>,
    theme: Theme,
    running: bool,
) -> anyhow::Result<Lab> {
    // Read once: what is read from a FIFO is not there again.
    let mut document = Document::open(name)?;
    // What a change has mended is no scenario before it, and has no note to lose.
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

/// The environment variable `name`, if it is set to text.
pub(super) fn variable(name: &str) -> Option<String> {
    std::env::var(name).ok()
}

/// The colors that `look` asks for, or that suit the terminal.
pub(super) fn theme_for(look: DisplayArgs) -> Theme {
    let suited = theme::theme(look.color.unwrap_or_default(), variable);
    Theme {
        background: look.background.unwrap_or(suited.background),
        ..suited
    }
}

/// The dots that are asked for, or that suit locale and terminal.
pub(super) fn marker(markers: Option<Marker>) -> Marker {
    markers.unwrap_or_else(|| theme::marker(variable))
}

/// A lab with what `name` names, as the command line wants it.
pub(super) fn of_workbench(args: &WorkbenchArgs, name: &str) -> anyhow::Result<Lab> {
    let (markers, theme) = (args.look.markers, theme_for(args.look));
    let mut lab = open_lab(name, &args.changes, markers, theme, !args.paused)?;
    if let Some(step) = args.at {
        // No signal is caught yet: one that ends the process here has nothing to put right.
        lab.begin_at(step, |_, _| ControlFlow::Continue(()))
            .with_context(|| name.to_owned())?;
    }
    Ok(lab)
}

/// A lab without colors.
pub(super) fn new_lab(look: DisplayArgs) -> anyhow::Result<Lab> {
    let changes = SetArgs::default();
    open_lab(DEFAULT, &changes, look.markers, Theme::PLAIN, false)
}

pub(super) fn refused(lesson: &Lesson, problem: Problem) -> anyhow::Error {
    Problems::one(lesson.origin.clone(), problem).into()
}

/// What the file that is asked for has to hold: HTML where its name says so, else Markdown or text.
///
/// Ends the process as clap does if it is to be a PDF.
pub(super) fn paper_format(args: &LessonArgs) -> PaperFormat {
    let extension = args.output.as_deref().and_then(Path::extension);
    let lower = extension.map(|name| name.to_string_lossy().to_lowercase());
    match lower.as_deref() {
        Some("pdf") => {
            let message = "-o FILE.pdf: write FILE.html and print it from a browser, which can also save a PDF";
            refuse("lesson", ErrorKind::ValueValidation, message)
        }
        Some("html" | "htm") => PaperFormat::Html,
        _ => PaperFormat::Markdown,
    }
}

/// Writes what `make` makes to the file that is asked for, or prints it. `make` asks now and then whether to go on.
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
