//! A lesson that a command plays without a terminal, and where what comes of it is written.

use super::args::{Changes, LessonArgs, Look};
use super::new_lab::{DEFAULT, plain_lab};
use super::print;
use super::progress::{self, Interrupted};
use crate::export::Destination;
use crate::lab::Lab;
use crate::lessons::{Lesson, play};
use crate::scenario::{Problem, Problems};
use anyhow::bail;
use std::process::ExitCode;

pub(super) fn new_lab(look: Look) -> anyhow::Result<Lab> {
    plain_lab(DEFAULT, &Changes::default(), look.markers)
}

pub(super) fn refused(lesson: &Lesson, problem: Problem) -> anyhow::Error {
    Problems::one(lesson.origin.clone(), problem).into()
}

/// Writes what `make` makes to the file that is asked for, or prints it. `make` asks now and then whether to go on.
pub(super) fn write(
    args: &LessonArgs,
    make: impl FnOnce(play::GoOn<'_>) -> anyhow::Result<String>,
) -> anyhow::Result<ExitCode> {
    let (output, interruption) = progress::open(args.output.as_deref(), args.force)?;
    let text = make(&mut interruption.meter());
    if interruption.has_come() {
        bail!(Interrupted);
    }
    match output {
        None | Some(Destination::Stdout(_)) => print(&text?),
        Some(output) => {
            output.write_and_keep(text?.as_bytes())?;
            Ok(ExitCode::SUCCESS)
        }
    }
}
