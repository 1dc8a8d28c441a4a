//! `gyrolab` and `gyrolab show`: the lab, live or as one picture.

use super::args::{Changes, Color, Look, Markers, Screen, ShowArgs, WorkbenchArgs};
use super::scenario::changed;
use crate::scenario::Document;
use crate::workbench::lab::Lab;
use crate::workbench::markers::Marker;
use crate::workbench::surroundings::{self, ColourChoice};
use crate::workbench::theme::{Background, Theme};
use crate::workbench::view::View;
use crate::workbench::{app, screen};
use anyhow::Context;
use ratatui::layout::Rect;
use std::io::{self, IsTerminal, Write};
use std::process::ExitCode;
use std::sync::Arc;

/// What is opened where nothing is named.
const DEFAULT: &str = "method-2";

/// Opens the lab; without a terminal shows its picture instead.
pub(super) fn open(args: &WorkbenchArgs) -> anyhow::Result<ExitCode> {
    let name = args.scenario.as_deref().unwrap_or(DEFAULT);
    if !(io::stdin().is_terminal() && io::stdout().is_terminal()) {
        writeln!(
            io::stderr(),
            "gyrolab: no terminal, so this is the picture that gyrolab show {name} prints"
        )?;
        return print(name, &args.changes, args.at, (80, 24), args.look.markers);
    }
    let mut lab = lab(
        name,
        &args.changes,
        args.look.markers,
        theme(args.look),
        !args.paused,
    )?;
    if let Some(step) = args.at {
        lab.begin_at(step).with_context(|| name.to_owned())?;
    }
    lab.take_advice();
    app::run(lab, args.fps).context("the terminal cannot be used")?;
    Ok(ExitCode::SUCCESS)
}

/// Prints the lab's picture at the end of a run.
pub(super) fn show(args: &ShowArgs) -> anyhow::Result<ExitCode> {
    let ShowArgs {
        scenario,
        at,
        size,
        markers,
    } = args;
    print(&scenario.scenario, &scenario.changes, *at, *size, *markers)
}

fn print(
    name: &str,
    changes: &Changes,
    at: Option<u64>,
    (width, height): (u16, u16),
    markers: Option<Markers>,
) -> anyhow::Result<ExitCode> {
    let plain = Theme {
        colour: false,
        background: Background::Dark,
    };
    let mut lab = lab(name, changes, markers, plain, false)?;
    let end = at.unwrap_or(lab.run().scenario().steps);
    let ended = lab.begin_at(end);
    let picture = screen::text(&lab, false, Rect::new(0, 0, width, height));
    let mut stdout = io::stdout().lock();
    stdout.write_all(picture.as_bytes())?;
    stdout.flush()?;
    ended.with_context(|| name.to_owned())?; // the picture up to there is shown all the same
    Ok(ExitCode::SUCCESS)
}

/// A lab with what `name` names, changed.
fn lab(
    name: &str,
    changes: &Changes,
    markers: Option<Markers>,
    theme: Theme,
    running: bool,
) -> anyhow::Result<Lab> {
    let scenario = Arc::new(changed(name, changes)?.scenario()?);
    let view = View::new(&scenario, marker(markers), theme);
    let mut lab = Lab::new(name, scenario, view, running);
    // What a change has mended is no scenario before it, and has no note to lose.
    if let Ok(file) = Document::open(name).and_then(|document| document.scenario()) {
        lab.set_file(Arc::new(file));
    }
    Ok(lab)
}

fn variable(name: &str) -> Option<String> {
    std::env::var(name).ok()
}

fn theme(look: Look) -> Theme {
    let choice = match look.color {
        Color::Auto => ColourChoice::Auto,
        Color::Always => ColourChoice::Always,
        Color::Never => ColourChoice::Never,
    };
    let theme = surroundings::theme(choice, variable);
    let background = match look.background {
        None => theme.background,
        Some(Screen::Dark) => Background::Dark,
        Some(Screen::Light) => Background::Light,
    };
    Theme {
        background,
        ..theme
    }
}

fn marker(markers: Option<Markers>) -> Marker {
    match markers {
        None => surroundings::marker(variable),
        Some(Markers::Braille) => Marker::Braille,
        Some(Markers::HalfBlock) => Marker::HalfBlock,
        Some(Markers::Dot) => Marker::Dot,
        Some(Markers::Ascii) => Marker::Ascii,
    }
}
