//! A lesson that a command plays without a terminal, and where what comes of it is written.

use super::args::{Changes, LessonArgs, Look};
use super::new_lab::{DEFAULT, lab};
use super::progress::{self, Interruption, Meter};
use super::{INTERRUPTED, print};
use crate::export::Destination;
use crate::lab::Lab;
use crate::lab::view::theme::{Background, Theme};
use crate::scenario::{Problem, Problems};
use crate::teach::{Lesson, play};
use std::process::ExitCode;

/// A new lab, of which nothing but the pictures will be seen.
pub(super) fn new_lab(look: Look) -> anyhow::Result<Lab> {
    let plain = Theme {
        colour: false,
        background: Background::Dark,
    };
    lab(DEFAULT, &Changes::default(), look.markers, plain, false)
}

pub(super) fn refused(lesson: &Lesson, problem: Problem) -> anyhow::Error {
    Problems::one(lesson.origin.clone(), problem).into()
}

/// Does `what`, which asks now and then whether to go on, with progress where it takes long.
pub(super) fn watched<T>(
    interruption: &Interruption,
    what: impl FnOnce(play::GoOn<'_>) -> anyhow::Result<T>,
) -> anyhow::Result<T> {
    let mut meter = Meter::new();
    let done = what(&mut |step, of| {
        meter.show(step, of);
        interruption.go_on()
    });
    meter.clear();
    done
}

/// Writes what `make` makes to the file that is asked for, or prints it.
pub(super) fn write(
    args: &LessonArgs,
    make: impl FnOnce(&Interruption) -> anyhow::Result<String>,
) -> anyhow::Result<ExitCode> {
    let (output, interruption) = progress::open(args.output.as_deref(), args.force)?;
    let text = make(&interruption);
    if interruption.has_come() {
        return Ok(ExitCode::from(INTERRUPTED));
    }
    match output {
        None | Some(Destination::Stdout(_)) => print(&text?),
        Some(output) => {
            output.write_and_keep(text?.as_bytes())?;
            Ok(ExitCode::SUCCESS)
        }
    }
}
