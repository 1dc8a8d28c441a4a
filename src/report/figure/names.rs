//! Names of runs in a legend, which tell how the runs differ.

use super::chords::EVERY_STEP;
use super::job::{FigureJob, FigureRun};
use super::setting::{self, CurveSetting};
use crate::engine::text::number::significant;
use crate::plot::chart::legend::longest_name;
use crate::plot::ink::{self, LABEL_PT};
use crate::plot::letters;
use toml::Table;

/// Returns a name for each run, as markup that fits into the legend; empty if no name is needed.
pub(super) fn names(job: &FigureJob<'_>) -> Vec<String> {
    let &FigureJob { runs, spec, .. } = job;
    let room_pt = longest_name(spec.page_width_pt()) - ink::width(EVERY_STEP, LABEL_PT);
    let given = &spec.labels.names;
    if !given.is_empty() {
        let names = given.iter();
        return names
            .map(|name| letters::marked(name, LABEL_PT, room_pt))
            .collect();
    }
    let mut differs = PARTS.map(|of| runs.iter().any(|run| of(run) != of(&runs[0])));
    if let ([run], true) = (runs, job.is_beside()) {
        differs = [
            false,
            true,
            run.scenario.first_motion().scheme.order.is_some(),
        ];
    }
    if let ([_], [false, false, false]) = (runs, differs) {
        return vec![String::new()];
    }
    let names: Vec<_> = runs
        .iter()
        .map(|run| by_parts(run, differs, room_pt))
        .collect();
    let is_told = |name: &String| names.iter().filter(|other| *other == name).count() == 1;
    if names.iter().all(is_told) {
        return names;
    }
    by_settings(runs, &names, room_pt)
}

/// Returns names of `runs` with the settings in which they differ, because some of `names` are equal. A run without
/// different settings gets the name that the user gave.
fn by_settings(runs: &[FigureRun], names: &[String], room_pt: f64) -> Vec<String> {
    let files = runs.iter().map(|run| Table::try_from(&run.scenario.file));
    let tables: Vec<Table> = files.map(Result::unwrap_or_default).collect();
    let settings = CurveSetting::that_differ(&tables);
    let all = names.iter().zip(&settings).zip(runs);
    let told = all.map(|((name, of_run), run)| match (name.as_str(), &of_run[..]) {
        ("", []) => letters::shortened(&run.named, LABEL_PT, room_pt),
        (name, of_run) => setting::name(name, of_run, room_pt),
    });
    told.collect()
}

/// Returns the name of `run`, composed of the [`PARTS`] that differ.
fn by_parts(run: &FigureRun, differs: [bool; 3], room_pt: f64) -> String {
    let words: Vec<_> = (0..2)
        .filter(|part| differs[*part])
        .map(|part| PARTS[part](run))
        .collect();
    // The time step is markup and is never shortened; the title is.
    let step = match (differs[2], words.is_empty()) {
        (false, _) => String::new(),
        (true, true) => step(run),
        (true, false) => format!(", {}", step(run)),
    };
    let rest = room_pt - ink::width(&step, LABEL_PT);
    letters::shortened(&words.join(", "), LABEL_PT, rest) + &step
}

/// The parts of a name.
const PARTS: [fn(&FigureRun) -> String; 3] = [
    |run| run.scenario.file.title.clone(),
    |run| scheme_in_words(run.scenario.first_motion().scheme.name).to_owned(),
    step,
];

/// Returns a name of a scheme's motion for readers who do not know the program.
pub(super) fn scheme_in_words(name: &str) -> &str {
    match name {
        "report" => "the report's scheme",
        "exact" => EXACT_CURVE_NAME,
        name => name,
    }
}

pub(super) const EXACT_CURVE_NAME: &str = "exact motion";

/// Formats the time step as markup, such as "Δt = 10 ms", or "Δt = 10 ms, then 1 ms" if an edit changes it.
fn step(run: &FigureRun) -> String {
    let scenario = &run.scenario;
    let changed = scenario.edits.iter().filter(|edit| edit.step > 0);
    let mut lengths: Vec<f64> = [scenario.first_motion()]
        .into_iter()
        .chain(changed.map(|edit| &edit.motion))
        .map(|motion| motion.time_step_s)
        .collect();
    lengths.dedup();
    let then = match &lengths[..] {
        [_] => String::new(),
        [_, second] => format!(", then {}", seconds_in_words(*second)),
        [.., last] => format!(", …, {}", seconds_in_words(*last)),
        [] => return String::new(),
    };
    format!("Δ*t* = {}{then}", seconds_in_words(lengths[0]))
}

/// Returns a time step in a unit in which its number is short, as markup.
fn seconds_in_words(seconds: f64) -> String {
    let (number, unit) = match seconds {
        s if s >= 0.1 => (s, "s"),
        s if s >= 1e-4 => (s * 1e3, "ms"),
        s if s >= 1e-7 => (s * 1e6, "µs"),
        s => (s, "s"),
    };
    let number = letters::escape(&significant(number, 6));
    format!("{number} {unit}")
}
