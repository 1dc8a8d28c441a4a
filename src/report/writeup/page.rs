//! The document of a write-up: what was run, what came out, whether to believe it, how to make it again.

use super::quantities::{QuantityRow, RunNumbers};
use super::{
    AGAIN, CSV, MeasuredComparison, PREDICTED_SINCE, READOUTS_FILE, RUN_FILE, Writeup,
    WriteupFigure,
};
use crate::engine::analysis::Theory;
use crate::engine::export::summary::steps_in_words;
use crate::engine::scenario::Scenario;
use crate::engine::text::number::{fixed, shortest, significant};
use crate::physics::{SchemeInfo, SymmetricTop};
use crate::report::document::{Column, Document, Entry, Reference, Text, escape, quantity};

/// How to read the table of numbers.
const HOW_TO_READ: &str = "Digits in parentheses are one standard uncertainty, in units of the last digits [@gum]: \
    0.886033(24) is 0.886033 ± 0.000024. It is the uncertainty of reading the number off the steps, and does not contain the \
    error of the scheme. The other numbers of a row end at the same digit; without an uncertainty, they have six digits.";
const HOW_TO_JUDGE: &str = "The verdict compares this run with the exact motion. A number agrees if the difference is at most \
    three uncertainties, or within the limits by which gyrolab accepts a run: 1 % of the traced point's distance from the \
    pivot for places, 5 % of the exact swing for tilts, 5 % for the nutation period, 1 % for other numbers.";
const OF_THE_TIME_STEP: &str = "This verdict is about the scheme and its time step: it compares the run with the exact motion \
    of the same body under the same forces.";
const NOT_OF_DATA: &str = " [#measured-data] compares the run with the measured data.";
const OF_ASYMMETRY: &str = "Theory takes the mean of the two moments of inertia across the axle, so that the asymmetry makes a \
    part of the difference.";
/// The table that compares the run with measured data.
pub(super) const MEASURED_TABLE: &str = "measured-data";
/// A longer run file is not printed.
const MOST_PRINTED_LINES: usize = 60;
/// A part of L that is smaller than this part of |L| is zero.
const MOMENTUM_ROUNDING: f64 = 1e-14;

pub(super) const GUM: Reference = Reference {
    key: "gum",
    entry: Entry::Other,
    author: "{Joint Committee for Guides in Metrology}",
    title: "Evaluation of measurement data – Guide to the expression of uncertainty in measurement",
    published: "JCGM 100:2008, BIPM",
    volume: "",
    pages: "",
    year: "2008",
};

pub fn document(writeup: &Writeup) -> Document {
    let mut document = Document::new(Text::plain(&writeup.readouts.title));
    document.references = vec![gyrolab(), GUM];
    add_words(&mut document, writeup);
    document.section("What was run");
    add_setup(&mut document, writeup);
    document.section("Is the time step short enough?");
    add_verdict(&mut document, writeup);
    document.section("Numbers of the run");
    add_quantities(&mut document, writeup);
    if let Some(beside) = &writeup.beside {
        document.section("Measured data");
        beside.add_to(&mut document);
    }
    document.section("Figures");
    add_figures(&mut document, &writeup.drawings);
    document.section("How to make it again");
    add_commands(&mut document, writeup.beside.as_ref());
    document.section("The run file");
    add_run_file(&mut document, &writeup.scenario.to_toml());
    document
}

/// Adds what the scenario says of itself.
fn add_words(document: &mut Document, writeup: &Writeup) {
    let file = &writeup.scenario.file;
    let look_at = file.viewed_text("look_at").map(sentence);
    for text in file.about.iter().chain(&look_at) {
        document.paragraph(&escape(text));
    }
    if let Some(source) = &file.source {
        document.paragraph(&format!("Source: {}", escape(source)));
    }
}

/// Adds the table of what was run: body, start, scheme and length. The run file has forces and edits.
fn add_setup(document: &mut Document, writeup: &Writeup) {
    let scenario = &writeup.scenario;
    let body = &scenario.body.mechanics;
    let mass = quantity(&significant(body.mass(), 6), "kg");
    let center = body.first_moment().norm() / body.mass();
    let center = quantity(&significant(center, 6), "m");
    let traced = escape(scenario.traced_name());
    let from_pivot = body.points()[scenario.trace].at.norm();
    let from_pivot = quantity(&significant(from_pivot, 6), "m");
    let SchemeInfo { name, about, .. } = scenario.motion.scheme;
    let steps = steps_in_words(scenario, writeup.readouts.sample.step);
    let rows = [
        (
            "body",
            format!("{mass}; center of mass {center} from the pivot"),
        ),
        ("moments of inertia about the pivot", moments(scenario)),
        (
            "traced point",
            format!("{traced}, {from_pivot} from the pivot"),
        ),
        ("start", start(scenario)),
        (
            "gravity",
            quantity(&shortest(scenario.motion.gravity), "m/s2"),
        ),
        ("scheme", format!("`{name}`: {}", escape(about))),
        ("time steps", escape(&steps)),
    ];
    document.table(
        "The run.",
        [Column::text("quantity"), Column::text("value")],
        rows.map(|(label, text)| [Text::plain(label), Text::marked(&text)]),
    );
    document.paragraph(&format!(
        "The run file, `{RUN_FILE}`, has its parts, pushes, friction and edits."
    ));
}

fn moments(scenario: &Scenario) -> String {
    let Some((top, asymmetry)) = SymmetricTop::nearly(&scenario.body.mechanics) else {
        return "not symmetric about the axle".to_owned();
    };
    let mean = if asymmetry > 0.0 { " (mean)" } else { "" };
    let of = if scenario.rotor().is_some() {
        "of the rotor"
    } else {
        "along it"
    };
    let [across, along] =
        [top.across, top.along].map(|moment| quantity(&significant(moment, 6), "kg m2"));
    format!(
        "$I_1$ = {across} across the axle{mean}, $I_3$ = {along} {of}; $κ = I_3/I_1$ = {}",
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
        "axle tilted by {}; $L$ = ({x}, {y}, {z}) J s in the world frame",
        quantity(&fixed(tilt_deg, 4), "deg")
    )
}

fn add_verdict(document: &mut Document, writeup: &Writeup) {
    if let Some(broken) = &writeup.broken {
        let broken = sentence(&broken.to_string());
        document.paragraph(&format!("{}.", escape(&broken)));
    }
    let of_data = writeup.beside.as_ref().map_or("", |_| NOT_OF_DATA);
    document.paragraph(&escape(&writeup.verdict()));
    document.paragraph(&format!("{OF_THE_TIME_STEP}{of_data}"));
}

fn add_quantities(document: &mut Document, writeup: &Writeup) {
    let numbers = writeup.numbers();
    let theory = writeup.readouts.theory.as_ref();
    if let Some(asymmetry) = theory.and_then(Theory::of_mean_moment) {
        let asymmetry = escape(&asymmetry);
        document.paragraph(&format!(
            "Asymmetry of the body: {asymmetry}. {OF_ASYMMETRY}"
        ));
    }
    let rows = numbers.rows();
    let cells = rows.iter().map(|row| {
        let [run, exact, predicted] = row.cells.clone();
        let (label, verdict) = (Text::plain(&row.label), Text::marked(&row.verdict));
        [label, run, exact, predicted, row.unit.clone(), verdict]
    });
    document.table(
        "Numbers of this run, of the exact motion, and of theory.",
        [
            Column::text("quantity"),
            Column::number("this run"),
            Column::number("exact motion"),
            Column::number("theory"),
            Column::text("unit"),
            Column::text("verdict"),
        ],
        cells,
    );
    document.paragraph(&sources(writeup, &numbers));
    document.paragraph(&format!(
        "{HOW_TO_READ} All digits are in `{READOUTS_FILE}`, under the names below."
    ));
    document.paragraph(HOW_TO_JUDGE);
    document.list(rows.iter().map(meaning));
}

/// Says where the columns of the table come from.
fn sources(writeup: &Writeup, numbers: &RunNumbers<'_>) -> String {
    let exact = match numbers.exact.readouts() {
        Some(exact) => format!(
            "The exact motion is that of the same body under the same forces, read off every {}, `exact_motion` in \
             `{READOUTS_FILE}`.",
            quantity(&significant(exact.time_step_s, 6), "s")
        ),
        None => format!(
            "There is no exact motion to compare with: {}.",
            escape(numbers.exact.reason())
        ),
    };
    let since = numbers.since_s.map_or(String::new(), |since_s| {
        let since = quantity(&significant(since_s, 9), "s");
        format!(
            " It speaks of the motion since {since} (`{PREDICTED_SINCE}`), when the forces last changed; minimum and maximum \
             are those of the whole run."
        )
    });
    let theory = if writeup.readouts.theory.is_some() {
        "Theory is that of the heavy symmetric top; – means that it has no formula for the number."
    } else {
        "Theory has no formula for this motion (–)."
    };
    format!("The numbers of this run are simulated, not measured. {exact} {theory}{since}")
}

fn meaning(row: &QuantityRow) -> String {
    format!("{} (`{}`)", escape(&row.meaning), row.readout.name)
}

fn add_figures(document: &mut Document, drawings: &[WriteupFigure]) {
    let labels: Vec<_> = drawings
        .iter()
        .map(|drawing| format!("[#{}]", drawing.name))
        .collect();
    match labels.split_last() {
        None => document.paragraph("There are no figures."),
        Some((only, [])) => document.paragraph(&format!("{only} shows the run.")),
        Some((last, others)) => {
            document.paragraph(&format!("{} and {last} show the run.", others.join(", ")));
        }
    }
    for drawing in drawings {
        document.figure(drawing.name, drawing.width_mm(), &drawing.caption);
        if let Some(remark) = &drawing.remark {
            document.paragraph(remark);
        }
    }
}

fn add_commands(document: &mut Document, beside: Option<&MeasuredComparison>) {
    let measured = beside
        .map(|beside| format!(" --measured {}", beside.name()))
        .unwrap_or_default();
    let commands = [
        (
            "verify .".to_owned(),
            "recompute everything and compare".to_owned(),
        ),
        (
            format!("run {CSV} -o {AGAIN}"),
            format!("the same bytes as {CSV}"),
        ),
        (
            format!("writeup {CSV}{measured} -o again"),
            "this folder".to_owned(),
        ),
        (
            format!("{RUN_FILE}{measured}"),
            "the run, live in the terminal".to_owned(),
        ),
    ];
    let version = env!("CARGO_PKG_VERSION");
    document.paragraph(&format!(
        "In this folder, with gyrolab {version} [@gyrolab]:"
    ));
    add_code(document, &commands);
    document
        .paragraph("`gyrolab man csv` shows how to read the CSV in Python, R, MATLAB and Octave.");
}

/// Adds commands of gyrolab, each with what it does.
pub(super) fn add_code(document: &mut Document, commands: &[(String, String)]) {
    let widths = commands.iter().map(|(command, _)| command.len());
    let width = widths.max().unwrap_or_default();
    let lines = commands
        .iter()
        .map(|(command, what)| format!("gyrolab {command:width$}   # {what}\n"));
    document.code("sh", &lines.collect::<String>());
}

/// Returns the reference to this program; year and authors are those of its license.
pub(super) fn gyrolab() -> Reference {
    const COPYRIGHT_MARK: &str = "Copyright (c) ";
    let license = include_str!("../../../LICENSE");
    let line = license
        .lines()
        .find_map(|line| line.strip_prefix(COPYRIGHT_MARK));
    let (year, author) = line
        .and_then(|line| line.split_once(' '))
        .unwrap_or_default();
    Reference {
        key: "gyrolab",
        entry: Entry::Other,
        author,
        title: env!("CARGO_PKG_DESCRIPTION"),
        published: concat!("gyrolab, version ", env!("CARGO_PKG_VERSION")),
        year,
        ..Reference::default()
    }
}

fn add_run_file(document: &mut Document, run_file: &str) {
    let lines = run_file.lines().count();
    if lines > MOST_PRINTED_LINES {
        document.paragraph(&format!("`{RUN_FILE}` has {lines} lines."));
        return;
    }
    document.paragraph(&format!("`{RUN_FILE}`:"));
    document.code("toml", run_file);
}

/// `text` with a capital letter at its beginning.
pub(super) fn sentence(text: &str) -> String {
    let mut letters = text.chars();
    let first = letters.next().map(char::to_uppercase);
    first.into_iter().flatten().chain(letters).collect()
}
