//! The commands that print information: presets, schemes, keys, readouts, check.

use super::{lesson, print, warn};
use crate::engine::analysis::readouts::READOUTS;
use crate::engine::data;
use crate::engine::export::summary::steps_in_words;
use crate::engine::journal::changed::Original;
use crate::engine::run::Clock;
use crate::engine::scenario::keys::KEYS;
use crate::engine::scenario::presets::{self, PRESETS, Preset};
use crate::engine::scenario::problem::nearest;
use crate::engine::scenario::{Document, Problems, Scenario, Window};
use crate::engine::text::number::{counted, decimal, shortest};
use crate::engine::text::printable::{PrintablePath, printable, printable_lines};
use crate::lab::command;
use crate::lessons::shipped;
use crate::physics::scheme::SCHEMES;
use crate::studies::sweep::{self, SWEEPS, Sweep};
use anyhow::bail;
use std::fmt::Write;
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::sync::Arc;

pub(super) fn presets(name: Option<&str>) -> anyhow::Result<ExitCode> {
    let Some(name) = name else {
        return print(&preset_list()?);
    };
    let preset = presets::find(name)
        .map(|preset| preset.text)
        .or_else(|| sweep::find(name).map(|sweep| sweep.text));
    match preset.or_else(|| data::find_shipped(name).map(|data| data.text)) {
        Some(text) => print(text),
        None => {
            let sweeps = SWEEPS.iter().map(|sweep| sweep.name);
            let recordings = data::SHIPPED.iter().map(|data| data.name);
            let names = PRESETS.iter().map(|shipped| shipped.name);
            let near = nearest(name, names.chain(sweeps).chain(recordings));
            bail!("no preset named {}: {near}", printable(name))
        }
    }
}

fn preset_list() -> anyhow::Result<String> {
    let mut text = String::new();
    for Preset { name, .. } in PRESETS {
        let file = Document::open(name)?.scenario()?.file;
        text += &listed(name, &file.title, file.about.as_deref());
    }
    text.push_str("gyrolab run NAME runs one; gyrolab presets NAME prints it as TOML.\n");
    text.push_str("gyrolab sweep lists the sweeps, grids of many runs.\n");
    Ok(text)
}

/// Formats an entry of a list: name, title, and description.
pub(super) fn listed(name: &str, title: &str, about: Option<&str>) -> String {
    let lines: String = about
        .unwrap_or_default()
        .lines()
        .map(|line| format!("    {line}\n"))
        .collect();
    format!("{name}: {title}\n{lines}\n")
}

pub(super) fn scheme_list() -> Result<String, std::fmt::Error> {
    let mut text = String::new();
    for scheme in SCHEMES {
        let order = scheme
            .order
            .map_or("exact".to_owned(), |order| format!("order {order}"));
        writeln!(text, "{:<8} {order:<8} {}", scheme.name, scheme.about)?;
        writeln!(text, "{:<17} {}", "", scheme.source)?;
    }
    Ok(text)
}

pub(super) fn key_list() -> Result<String, std::fmt::Error> {
    let mut text = String::new();
    for row in KEYS {
        let must = match (row.required, row.instead.is_empty()) {
            (false, _) => String::new(),
            (true, true) => " (required)".to_owned(),
            (true, false) => format!(" (required, or {})", row.instead.join(" or ")),
        };
        writeln!(text, "{}{must}\n    {}", row.path, row.description())?;
    }
    text.push_str("\nReplace a * by a number from 0: [[body.point]], [[body.part]], [[push]], [[expected]] and [[edit]] can be repeated.\n");
    text.push_str("All tables except [start] and [motion] are optional.\n");
    Ok(text)
}

pub(super) fn readout_list() -> Result<String, std::fmt::Error> {
    let mut text = String::new();
    for readout in READOUTS {
        let unit = match readout.unit {
            "" => String::new(),
            unit => format!(" ({unit})"),
        };
        let source = readout.source.words();
        writeln!(text, "{}{unit}", readout.name)?;
        writeln!(text, "    {}; from: {source}", readout.meaning)?;
    }
    text.push_str("\n\"from:\" is followed by the source of each number; predicted_... comes from theory, measured_... from the run.\n");
    text.push_str("gyrolab run SCENARIO --json prints all of them; null means that a number does not exist or cannot be determined.\n");
    Ok(text)
}

pub(super) fn check(files: &[PathBuf]) -> anyhow::Result<ExitCode> {
    let mut code = ExitCode::SUCCESS;
    for file in files {
        let checked = if file.extension().is_some_and(|extension| extension == "md") {
            lesson::checked(file)?
        } else {
            Document::read(file).and_then(|document| checked(&document))
        };
        match checked {
            Ok(described) => {
                print(&format!("{}: {described}\n", PrintablePath(file)))?;
            }
            Err(problems) => {
                warn(printable_lines(&problems.to_string()));
                if let Some(hint) = hint_of_preset(file) {
                    warn(hint);
                }
                code = ExitCode::FAILURE;
            }
        }
    }
    Ok(code)
}

/// Suggests a command if `file` does not exist but names a preset or a lesson.
fn hint_of_preset(file: &Path) -> Option<String> {
    let name = file.to_str().filter(|_| !file.exists())?;
    let (what, instead) = if presets::find(name).is_some() {
        let instead = format!("gyrolab run {name} runs it, gyrolab presets {name} prints it");
        ("a preset", instead)
    } else {
        shipped::find(name)?;
        let instead = format!("gyrolab lesson {name} opens it");
        ("a shipped lesson", instead)
    };
    Some(format!(
        "gyrolab check needs files, but {name} is {what}: {instead}"
    ))
}

/// Describes the content of `document`: commands, a sweep or a scenario.
fn checked(document: &Document) -> Result<String, Problems> {
    if command::is_file_of_commands(document) {
        let commands = command::read(document)?.list.len() as u64;
        return Ok(format!("good: {}", counted(commands, "command")));
    }
    if document.is_sweep() {
        return Sweep::open(document).map(|sweep| described_sweep(&sweep));
    }
    let scenario = Arc::new(document.scenario()?);
    let words = Original::find("", &scenario)
        .difference(&scenario)
        .map(|difference| {
            format!(
                "\n  its look_at line or its about text describes another motion: this one {difference}"
            )
        });
    Ok(described(&scenario) + &words.unwrap_or_default())
}

fn described_sweep(sweep: &Sweep) -> String {
    let axes: Vec<_> = sweep
        .axes
        .iter()
        .map(|axis| format!("{} ({})", axis.keys.join(" + "), axis.points.len()))
        .collect();
    let (rows, measured) = (sweep.rows(), sweep.measure.len());
    format!(
        "good: the sweep \"{}\", rows: {rows}, over {}, readouts: {measured}",
        sweep.title(),
        axes.join(" and ")
    )
}

fn described(scenario: &Scenario) -> String {
    let edits = match scenario.edits.len() {
        0 => String::new(),
        edits => format!(", {}", counted(edits as u64, "edit")),
    };
    let points = counted(scenario.body.points_before_parts() as u64, "point");
    let parts = match scenario.body.parts.len() {
        0 => String::new(),
        parts => counted(parts as u64, "part") + " and ",
    };
    format!(
        "good: \"{}\", {parts}{points}, scheme {}, steps: {}{edits}{}",
        scenario.file.title,
        scenario.motion.scheme.name,
        steps_in_words(scenario, scenario.steps),
        pushes_without_effect(scenario),
    )
}

/// Describes the pushes of `scenario` that never act because they begin after the end of its run.
fn pushes_without_effect(scenario: &Scenario) -> String {
    let (steps, end_s) = (scenario.steps, Clock::end_s(scenario));
    let idle = scenario.pushes.iter().enumerate().filter_map(|(index, push)| match push.window {
        Window::Steps { first, .. } if first > steps => Some(format!(
            "; push.{index} never acts: it begins at step {first}, and the run ends at step {steps}"
        )),
        Window::Time { from_s, .. } if from_s >= end_s => Some(format!(
            "; push.{index} never acts: it begins at {} s, and the run ends at {} s",
            shortest(from_s),
            decimal(end_s)
        )),
        _ => None,
    });
    idle.collect()
}
