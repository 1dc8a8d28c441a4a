//! The commands that tell: presets, schemes, keys, readouts, check, completions, man.

use super::args::Cli;
use super::{lesson, print, tell};
use crate::analysis::readouts::READOUTS;
use crate::export::summary::steps_in_words;
use crate::lab::command::{self, COMMANDS};
use crate::physics::scheme::SCHEMES;
use crate::run::Clock;
use crate::scenario::keys::{KEYS, Key, Kind};
use crate::scenario::presets::{self, PRESETS, Preset};
use crate::scenario::problem::nearest;
use crate::scenario::{Document, Problems, Scenario, Window};
use crate::storage::settings;
use crate::teach::shipped;
use crate::text::number::{decimal, shortest};
use crate::text::printable::{Shown, printable, printable_lines};
use crate::tui::panes::help;
use anyhow::{Context, bail};
use clap::CommandFactory;
use std::fmt::Write as _;
use std::io::Write as _;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

pub(super) fn presets(name: Option<&str>) -> anyhow::Result<ExitCode> {
    let Some(name) = name else {
        return print(&preset_list()?);
    };
    match presets::find(name) {
        Some(preset) => print(preset.text),
        None => {
            let near = nearest(name, PRESETS.iter().map(|preset| preset.name));
            bail!("no preset named {}: {near}", printable(name))
        }
    }
}

fn preset_list() -> anyhow::Result<String> {
    let mut text = String::new();
    for Preset { name, .. } in PRESETS {
        let file = Document::open(name)?.scenario()?.file;
        writeln!(text, "{name}: {}", file.title)?;
        for line in file.about.unwrap_or_default().lines() {
            writeln!(text, "    {line}")?;
        }
        text.push('\n');
    }
    text.push_str("gyrolab run NAME runs one; gyrolab presets NAME prints it as TOML.\n");
    Ok(text)
}

pub(super) fn schemes() -> anyhow::Result<ExitCode> {
    let mut text = String::new();
    for scheme in SCHEMES {
        let order = scheme
            .order
            .map_or("exact".to_owned(), |order| format!("order {order}"));
        writeln!(text, "{:<8} {order:<8} {}", scheme.name, scheme.about)?;
        writeln!(text, "{:<17} {}", "", scheme.source)?;
    }
    print(&text)
}

pub(super) fn keys() -> anyhow::Result<ExitCode> {
    let mut text = String::new();
    for Key {
        path,
        required,
        instead,
        about,
        ..
    } in KEYS
    {
        let must = match (required, instead.is_empty()) {
            (false, _) => String::new(),
            (true, true) => " (required)".to_owned(),
            (true, false) => format!(" (required, or {})", instead.join(" or ")),
        };
        writeln!(text, "{path}{must}\n    {about}")?;
    }
    text.push_str("\nA * stands for a number from 0: [[body.point]], [[body.part]], [[push]], [[expected]] and [[edit]] may be repeated.\n");
    text.push_str("A table may be left out whole where none of its keys is wanted, but [start] and [motion].\n");
    print(&text)
}

pub(super) fn readouts() -> anyhow::Result<ExitCode> {
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
    text.push_str("\nBehind \"from:\" stands where each number comes from; predicted_... is theory's, measured_... the run's own.\n");
    text.push_str("gyrolab run SCENARIO --json gives all of them; null is a number that there is not, or that cannot be stated.\n");
    print(&text)
}

pub(super) fn check(files: &[PathBuf]) -> anyhow::Result<ExitCode> {
    let mut code = ExitCode::SUCCESS;
    for file in files {
        let checked = match lesson::is_named_as_one(file) {
            true => lesson::checked(file)?,
            false => Document::read(file).and_then(|document| checked(&document)),
        };
        match checked {
            Ok(described) => {
                print(&format!("{}: {described}\n", Shown(file)))?;
            }
            Err(problems) => {
                tell(printable_lines(&problems.to_string()));
                if let Some(hint) = hint_of_preset(file) {
                    tell(hint);
                }
                code = ExitCode::FAILURE;
            }
        }
    }
    Ok(code)
}

/// What to do instead where `file`, which is not there, is the name of a preset or a lesson.
fn hint_of_preset(file: &Path) -> Option<String> {
    let name = file.to_str().filter(|_| !file.exists())?;
    let preset = presets::find(name).map(|_| {
        format!(
            "gyrolab check takes files, and {name} is a preset: gyrolab run {name} runs it, gyrolab presets {name} prints it"
        )
    });
    preset.or_else(|| {
        shipped::find(name)?;
        Some(format!(
            "gyrolab check takes files, and {name} is a shipped lesson, which is good: gyrolab lesson {name} opens it"
        ))
    })
}

/// What is in `document`, in words: commands, or else a scenario.
fn checked(document: &Document) -> Result<String, Problems> {
    if command::is_file_of_commands(document) {
        let commands = command::read(document)?.list.len();
        let plural = if commands == 1 { "" } else { "s" };
        return Ok(format!("good: {commands} command{plural}"));
    }
    document.scenario().map(|scenario| described(&scenario))
}

fn described(scenario: &Scenario) -> String {
    let edits = match scenario.edits.len() {
        0 => String::new(),
        1 => ", 1 edit".to_owned(),
        more => format!(", {more} edits"),
    };
    let points = scenario.body.points_before_parts();
    let plural = if points == 1 { "" } else { "s" };
    let parts = match scenario.body.parts.len() {
        0 => String::new(),
        1 => "1 part and ".to_owned(),
        more => format!("{more} parts and "),
    };
    format!(
        "good: \"{}\", {parts}{points} point{plural}, scheme {}, steps: {}{edits}{}",
        scenario.file.title,
        scenario.motion.scheme.name,
        steps_in_words(scenario, scenario.steps),
        pushes_without_effect(scenario),
    )
}

/// Which pushes of `scenario` never act, since they begin when its run is over.
fn pushes_without_effect(scenario: &Scenario) -> String {
    let (steps, end_s) = (scenario.steps, Clock::end_s(scenario));
    let idle = scenario.pushes.iter().enumerate();
    let idle = idle.filter_map(|(index, push)| match push.window {
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

pub(super) fn completions(shell: clap_complete::Shell) -> anyhow::Result<ExitCode> {
    let mut script = Vec::new();
    clap_complete::generate(shell, &mut Cli::command(), "gyrolab", &mut script);
    print(&String::from_utf8(script).context("the completion script is not text")?)
}

/// The manual's section about files of commands, one paragraph for each command.
fn commands_page() -> String {
    let plain = |text: &str| text.replace('\\', "\\e").replace('-', "\\-");
    let mut page = ".SH \"FILES OF COMMANDS\"\n\
        A file for \\-\\-do is a list of [[do]] tables with one command each, carried out in order:\n.PP\n.nf\n\
        [[do]]\nset = { \"motion.time_step_s\" = 0.05 }\n\n[[do]]\ngo_to = \"60 s\"\n.fi\n\
        .PP\nThe next begins when the one before is done. Refusals count the commands from 0: do.0 is the first. Conditions hold numbers, the names of the CSV's columns and \
        of the scenario's keys, + \\- * / ( ), abs, comparisons, and, or.\n"
        .to_owned();
    for row in COMMANDS {
        let (value, about) = (plain(row.value), plain(row.about));
        page += &format!(".TP\n\\fB{} = {value}\\fR\n{about}\n", row.name);
    }
    page
}

/// The manual's section about the files of settings, one paragraph for each key.
fn settings_page() -> String {
    let mut page = ".SH \"SETTINGS\"\n\
        The lab's settings, each a line of $XDG_CONFIG_HOME/gyrolab/config.toml (by default ~/.config/gyrolab/config.toml). What is chosen in the lab is \
        remembered in settings.toml beside the sessions; config.toml wins, and is never written; options win over both. \
        No setting changes a number, and show reads none.\n"
        .to_owned();
    for (key, kind, about) in settings::KEYS {
        let value = match kind {
            Kind::OneOf(words) => format!("\"{}\"", words.join("\", \"")),
            Kind::Whole(least, most) => format!("{least} to {most}"),
            _ => "true, false".to_owned(),
        };
        let value = value.replace('-', "\\-");
        page += &format!(".TP\n\\fB{key} = {value}\\fR\n{about}\n");
    }
    page
}

/// The manual's section about the keys of the lab, those of each purpose, pane and place under its name.
fn keys_page() -> String {
    let plain = |text: &str| text.replace('\\', "\\e").replace('-', "\\-");
    let entries = help::entries();
    let keys: Vec<_> = entries
        .iter()
        .filter(|entry| matches!(entry.what, help::What::Key(_)))
        .collect();
    let mut page = ".SH \"KEYS IN THE LAB\"\n\
        The same list is shown by ? in the lab, with the words on its screen.\n"
        .to_owned();
    for group in keys.chunk_by(|one, next| one.group == next.group) {
        let name = match group[0].pane {
            Some(_) => format!("{}, while this pane has the focus", group[0].group),
            None => group[0].group.to_owned(),
        };
        page += &format!(".SS \"{}\"\n", plain(&name));
        for entry in group {
            let (keys, text) = (plain(&entry.name()), plain(entry.text()));
            page += &format!(".TP\n\\fB\\&{keys}\\fR\n\\&{text}\n");
        }
    }
    page
}

/// The manual's synopsis of `command`: every option with its value.
fn synopsis(command: &clap::Command) -> String {
    let plain = |text: &str| text.replace('-', "\\-");
    let mut line = format!("\\fB{}\\fR", plain(command.get_name()));
    if let Some(name) = command.get_bin_name() {
        line = format!("\\fB{}\\fR", plain(name));
    }
    let options = command.get_arguments().filter(|arg| !arg.is_hide_set());
    let (places, options): (Vec<_>, Vec<_>) = options.partition(|arg| arg.is_positional());
    for arg in options {
        let names: Vec<_> = [
            arg.get_short().map(|short| format!("-{short}")),
            arg.get_long().map(|long| format!("--{long}")),
        ]
        .into_iter()
        .flatten()
        .collect();
        let names = format!("\\fB{}\\fR", plain(&names.join("|")));
        let value = match (takes_value(arg), arg.get_num_args()) {
            (None, _) => String::new(),
            (Some(value), Some(number)) if number.min_values() == 0 => {
                format!(" [\\fI{}\\fR]", plain(&value))
            }
            (Some(value), _) => format!(" \\fI{}\\fR", plain(&value)),
        };
        line += &format!(" [{names}{value}]");
    }
    for arg in places {
        let name = arg.get_value_names().and_then(|names| names.first());
        let name = name.map_or_else(|| arg.get_id().to_string(), ToString::to_string);
        line += &match arg.is_required_set() {
            true => format!(" <\\fI{}\\fR>", plain(&name)),
            false => format!(" [\\fI{}\\fR]", plain(&name)),
        };
    }
    if command.has_subcommands() {
        line += "\n.br\n\\fBgyrolab\\fR <\\fICOMMAND\\fR> ...";
    }
    format!(".SH SYNOPSIS\n{line}\n")
}

/// What the option `arg` is given; `None` of a flag.
fn takes_value(arg: &clap::Arg) -> Option<String> {
    let takes = arg.get_action().takes_values();
    let name = arg.get_value_names()?.first()?;
    takes.then(|| name.to_string())
}

/// The topics of the manual: name, and text.
const TOPICS: &[(&str, &str)] = &[("class", include_str!("topics/class.txt"))];

/// The manual page, or what it says about `topic`.
pub(super) fn man(topic: Option<&str>) -> anyhow::Result<ExitCode> {
    let Some(topic) = topic else {
        return man_page();
    };
    match TOPICS.iter().find(|(name, _)| *name == topic) {
        Some((_, text)) => print(text),
        None => {
            let near = nearest(topic, TOPICS.iter().map(|(name, _)| *name));
            bail!("no topic named {}: {near}", printable(topic))
        }
    }
}

/// The manual: the page of the program, then one section for each command.
fn man_page() -> anyhow::Result<ExitCode> {
    let mut command = Cli::command();
    command.build();
    let mut page = Vec::new();
    let main = clap_mangen::Man::new(command.clone());
    main.render_title(&mut page)?;
    main.render_name_section(&mut page)?;
    page.extend(synopsis(&command).as_bytes());
    main.render_description_section(&mut page)?;
    main.render_options_section(&mut page)?;
    main.render_subcommands_section(&mut page)?;
    main.render_extra_section(&mut page)?;
    main.render_version_section(&mut page)?;
    for sub in command
        .get_subcommands()
        .filter(|sub| !sub.is_hide_set() && sub.get_name() != "help")
    {
        let title = format!("gyrolab {}", sub.get_name());
        let man = clap_mangen::Man::new(sub.clone());
        writeln!(page, ".SH \"{}\"", title.to_uppercase())?;
        man.render_description_section(&mut page)?;
        page.extend(synopsis(sub).as_bytes());
        man.render_options_section(&mut page)?;
    }
    page.extend(keys_page().as_bytes());
    page.extend(commands_page().as_bytes());
    page.extend(settings_page().as_bytes());
    print(&String::from_utf8(page).context("the manual is not text")?)
}
