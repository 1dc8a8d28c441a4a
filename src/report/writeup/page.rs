//! The first page of a write-up, `README.md`: what was run, what came out, whether to believe it, how to make it again.

use super::quantities::rows;
use super::{
    AGAIN, CSV, MeasuredComparison, PREDICTED_SINCE, READOUTS_FILE, RUN_FILE, Writeup,
    WriteupFigure,
};
use crate::engine::analysis::Theory;
use crate::engine::export::summary::steps_in_words;
use crate::engine::scenario::Scenario;
use crate::engine::text::number::{NOT_AVAILABLE, fixed, shortest, significant};
use crate::physics::{SchemeInfo, SymmetricTop};
use std::fmt::{self, Write};

const HOW_TO_READ_QUANTITIES: &str = "The numbers of this run are simulated: read off its steps, and no data. Theory is that \
    of the exact motion under the forces at the end of the run. Digits in parentheses are one standard error of reading \
    the number off the steps, in units of the last digits: 0.886033(24) is 0.886033 ± 0.000024. \"In errors\" is the \
    difference in standard errors. Up to about 3 of them, reading alone explains it (exactly ±1.00: the reading's own known \
    error, stated and not taken away). What is more is the doing of the scheme and its time step, which the standard error \
    does not hold: it may be many errors and still be tiny.";
/// What the verdict is of.
const OF_THE_TIME_STEP: &str = "This is of the scheme and its time step alone: the run is held against the exact motion of \
    the same body under the same forces.";
const NOT_OF_DATA: &str = " Whether the run agrees with the measured data is told below.";
const IS_THEORY: &str = "The scheme exact computes the exact motion, which theory speaks of too: no time step can show here, \
    and where the two differ it is by rounding.";
const OF_ASYMMETRY: &str = "The difference between this run and theory is also an effect of the asymmetry, so it is not \
    stated in standard errors.";
/// A longer run file is not printed on the page.
const MOST_PRINTED_LINES: usize = 120;
/// A part of L that is smaller than this part of |L| is zero.
const MOMENTUM_ROUNDING: f64 = 1e-14;

pub fn page(writeup: &Writeup) -> Result<String, fmt::Error> {
    let mut page = String::new();
    let readouts = &writeup.readouts;
    writeln!(page, "# {}\n", escaped(&readouts.title))?;
    let file = &writeup.scenario.file;
    let look_at = file.viewed_text("look_at").map(sentence);
    for text in file.about.iter().chain(&look_at) {
        writeln!(page, "{}\n", escaped(text))?;
    }
    if let Some(source) = &file.source {
        writeln!(page, "Source: {}\n", escaped(source))?;
    }
    writeln!(page, "## What was run\n")?;
    write_setup(&mut page, writeup)?;
    writeln!(page, "\n## Is the time step short enough?\n")?;
    if let Some(broken) = &writeup.broken {
        writeln!(page, "{}.\n", escaped(&sentence(&broken.to_string())))?;
    }
    let of_data = writeup.beside.as_ref().map_or("", |_| NOT_OF_DATA);
    let verdict = escaped(&writeup.verdict());
    writeln!(page, "{verdict}\n\n{OF_THE_TIME_STEP}{of_data}\n")?;
    writeln!(page, "## This run beside theory\n")?;
    let theory = readouts.theory.as_ref();
    if let Some(asymmetry) = theory.and_then(Theory::of_mean_moment) {
        writeln!(page, "Asymmetry of the body: {asymmetry}. {OF_ASYMMETRY}\n")?;
    } else if writeup.scenario.motion.scheme.order.is_none() {
        writeln!(page, "{IS_THEORY}\n")?;
    }
    write_quantities(&mut page, writeup)?;
    if let Some(beside) = &writeup.beside {
        writeln!(page, "\n## Measured data beside the run\n")?;
        beside.write(&mut page)?;
    }
    writeln!(page, "\n## Figures\n")?;
    write_drawings(&mut page, &writeup.drawings)?;
    writeln!(page, "## How to make it again\n")?;
    write_again(&mut page, writeup.beside.as_ref())?;
    write_run_file(&mut page, &writeup.scenario.to_toml())?;
    Ok(page)
}

/// The table of what was run: body, start, scheme and length. Forces and edits stand in the run file.
fn write_setup(page: &mut String, writeup: &Writeup) -> fmt::Result {
    let scenario = &writeup.scenario;
    let body = &scenario.body.mechanics;
    let mass = significant(body.mass(), 6);
    let centre = significant(body.first_moment().norm() / body.mass(), 6);
    let traced = scenario.traced_name();
    let from_pivot = significant(body.points()[scenario.trace].at.norm(), 6);
    let gravity = shortest(scenario.motion.gravity);
    let SchemeInfo { name, about, .. } = scenario.motion.scheme;
    let rows = [
        ("", String::new()),
        ("---", "---".to_owned()),
        (
            "body",
            format!("{mass} kg; centre of mass {centre} m from the pivot"),
        ),
        ("moments of inertia about the pivot", moments(scenario)),
        (
            "traced point",
            format!("{traced}, {from_pivot} m from the pivot"),
        ),
        ("start", start(scenario)),
        ("gravity", format!("{gravity} m/s^2")),
        ("scheme", format!("{name}: {about}")),
        (
            "time steps",
            steps_in_words(scenario, writeup.readouts.sample.step),
        ),
    ];
    for (label, text) in rows {
        writeln!(page, "| {label} | {} |", escaped(&text))?;
    }
    writeln!(
        page,
        "\nIts parts, pushes, friction and edits stand in the run file, `{RUN_FILE}`."
    )
}

fn moments(scenario: &Scenario) -> String {
    let Some((top, asymmetry)) = SymmetricTop::nearly(&scenario.body.mechanics) else {
        return "lopsided: not symmetric about the axle".to_owned();
    };
    let mean = if asymmetry > 0.0 { " (mean)" } else { "" };
    let of = if scenario.rotor().is_some() {
        "of the rotor"
    } else {
        "about it"
    };
    format!(
        "I1 = {} kg m^2 across the axle{mean}, I3 = {} kg m^2 {of}, kappa = I3/I1 = {}",
        significant(top.across, 6),
        significant(top.along, 6),
        significant(top.kappa(), 6)
    )
}

fn start(scenario: &Scenario) -> String {
    let tilt_deg = libm::acos(scenario.start.axle().z.clamp(-1.0, 1.0)).to_degrees();
    let momentum = &scenario.start.momentum;
    // What is left of a zero by the turn from the body frame is rounding.
    let rounding = MOMENTUM_ROUNDING * momentum.norm();
    let [x, y, z] = [0, 1, 2].map(|axis| match momentum[axis] {
        part if part.abs() < rounding => significant(0.0, 9),
        part => significant(part, 9),
    });
    format!(
        "axle tilted by {} degrees, L = ({x}, {y}, {z}) J s in the world frame",
        fixed(tilt_deg, 4)
    )
}

fn write_quantities(page: &mut String, writeup: &Writeup) -> fmt::Result {
    let since_s = writeup.forces_changed_s();
    let rows = rows(&writeup.readouts, since_s);
    if rows.is_empty() {
        return writeln!(
            page,
            "The run is too short for that: nothing could be read off it."
        );
    }
    writeln!(
        page,
        "| what | this run | theory | difference | in errors | unit |"
    )?;
    writeln!(page, "| --- | --- | --- | --- | --- | --- |")?;
    for row in &rows {
        writeln!(page, "| {} |", row.cells.join(" | "))?;
    }
    writeln!(page)?;
    for row in &rows {
        writeln!(page, "- {} (`{}`)", escaped(&row.meaning), row.readout)?;
    }
    let theirs = since_s.map_or(String::new(), |since_s| {
        let since_s = significant(since_s, 9);
        format!(" The least and the greatest values are those of the whole run; theory, here and there, is of the motion since t = {since_s} s (`{PREDICTED_SINCE}`), when the forces last changed.")
    });
    writeln!(
        page,
        "\n{HOW_TO_READ_QUANTITIES} {NOT_AVAILABLE}: there is no such number, or none that can be stated. Every readout is in \
         `{READOUTS_FILE}`, also those of this run under names that begin with `measured_`.{theirs}"
    )
}

fn write_drawings(page: &mut String, drawings: &[WriteupFigure]) -> fmt::Result {
    if drawings.is_empty() {
        return writeln!(page, "None.\n");
    }
    for drawing in drawings {
        writeln!(
            page,
            "![{0}]({1}.svg)\n\n{0}: `{1}.pdf` and `{1}.svg`.\n",
            drawing.caption, drawing.name
        )?;
        if let Some(remark) = &drawing.remark {
            writeln!(page, "{remark}\n")?;
        }
    }
    Ok(())
}

fn write_again(page: &mut String, beside: Option<&MeasuredComparison>) -> fmt::Result {
    let measured = beside
        .map(|beside| format!(" --measured {}", beside.name()))
        .unwrap_or_default();
    let same = format!("the same bytes as {CSV}");
    let commands = [
        (
            "verify .".to_owned(),
            "makes rows, figures and numbers anew and says whether they are the same",
        ),
        (format!("run {RUN_FILE} -o {AGAIN}"), same.as_str()),
        (
            format!("writeup {RUN_FILE}{measured} -o again"),
            "this folder",
        ),
        (
            format!("{RUN_FILE}{measured}"),
            "the run, live in the terminal",
        ),
    ];
    let width = commands
        .iter()
        .map(|(command, _)| command.len())
        .max()
        .unwrap_or_default();
    let version = env!("CARGO_PKG_VERSION");
    writeln!(page, "In this folder, with gyrolab {version}:\n\n```sh")?;
    for (command, what) in commands {
        writeln!(page, "gyrolab {command:width$}   # {what}")?;
    }
    let (year, authors) = copyright();
    writeln!(
        page,
        "```\n\nTo cite it: {authors}, *gyrolab*, version {version} ({year}): {}. \
         `gyrolab man csv` has lines that read the CSV in Python, R, MATLAB and Octave.\n",
        env!("CARGO_PKG_DESCRIPTION")
    )
}

/// The year and the authors, from the licence.
fn copyright() -> (&'static str, &'static str) {
    const COPYRIGHT_MARK: &str = "Copyright (c) ";
    let licence = include_str!("../../../LICENSE");
    let line = licence
        .lines()
        .find_map(|line| line.strip_prefix(COPYRIGHT_MARK));
    line.and_then(|line| line.split_once(' '))
        .unwrap_or_default()
}

fn write_run_file(page: &mut String, run_file: &str) -> fmt::Result {
    writeln!(page, "## The run file\n")?;
    let (lines, run_file) = (run_file.lines().count(), run_file.trim_end());
    if lines > MOST_PRINTED_LINES {
        return writeln!(page, "`{RUN_FILE}`, {lines} lines.");
    }
    writeln!(page, "`{RUN_FILE}`:\n\n```toml\n{run_file}\n```")
}

/// `text` with a capital letter at its beginning.
fn sentence(text: &str) -> String {
    let mut letters = text.chars();
    let first = letters.next().map(char::to_uppercase);
    first.into_iter().flatten().chain(letters).collect()
}

/// `text` so that Markdown shows it as it stands, in a table too.
fn escaped(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    for c in text.chars() {
        match c {
            '\n' => out.push(' '),
            '\\' | '`' | '*' | '_' | '[' | ']' | '<' | '>' | '#' | '|' | '~' | '&' | '$' => {
                out.extend(['\\', c]);
            }
            c => out.push(c),
        }
    }
    out
}
