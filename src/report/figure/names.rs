//! What runs are called beside each other: by what differs.

use super::chords::EVERY_STEP;
use super::job::{FigureJob, FigureRun};
use crate::engine::text::number::significant;
use crate::plot::chart::legend::longest_name;
use crate::plot::ink::{self, LABEL_PT};
use crate::plot::letters;

/// A name for each of the runs, as markup with room in the legend; empty where there is nothing to tell apart.
pub(super) fn names(job: &FigureJob<'_>) -> Vec<String> {
    let &FigureJob { runs, spec, .. } = job;
    let room_pt = longest_name(spec.page_width_pt()) - ink::width(EVERY_STEP, LABEL_PT);
    let given = &spec.labels.names;
    if !given.is_empty() {
        let names = given.iter();
        return names
            .map(|name| letters::shortened(name, LABEL_PT, room_pt))
            .collect();
    }
    let mut differs = PARTS.map(|of| runs.iter().any(|run| of(run) != of(&runs[0])));
    if let ([run], true) = (runs, job.is_beside()) {
        differs = [false, true, run.scenario.motion.scheme.order.is_some()];
    }
    runs.iter()
        .map(|run| match (differs, runs) {
            ([false, false, false], [_]) => String::new(),
            ([false, false, false], _) => letters::shortened(&run.named, LABEL_PT, room_pt),
            _ => by_parts(run, differs, room_pt),
        })
        .collect()
}

/// Returns the name of `run` by those of its [`PARTS`] that differ.
fn by_parts(run: &FigureRun, differs: [bool; 3], room_pt: f64) -> String {
    let words: Vec<_> = (0..2)
        .filter(|part| differs[*part])
        .map(|part| PARTS[part](run))
        .collect();
    // The step comes as markup, and keeps its room; the title is cut.
    let step = match (differs[2], words.is_empty()) {
        (false, _) => String::new(),
        (true, true) => step(run),
        (true, false) => format!(", {}", step(run)),
    };
    let rest = room_pt - ink::width(&step, LABEL_PT);
    letters::shortened(&words.join(", "), LABEL_PT, rest) + &step
}

/// What a name consists of.
const PARTS: [fn(&FigureRun) -> String; 3] = [
    |run| run.scenario.file.title.clone(),
    |run| scheme_in_words(run.scenario.motion.scheme.name).to_owned(),
    step,
];

/// What a reader who does not know the program calls the motion of a scheme.
pub(super) fn scheme_in_words(name: &str) -> &str {
    match name {
        "report" => "the report's scheme",
        "exact" => EXACT_CURVE_NAME,
        name => name,
    }
}

pub(super) const EXACT_CURVE_NAME: &str = "exact motion";

/// "Δt = 10 ms" as markup.
fn step(run: &FigureRun) -> String {
    let seconds = run.scenario.motion.time_step_s;
    let (number, unit) = match seconds {
        s if s >= 0.1 => (s, "s"),
        s if s >= 1e-4 => (s * 1e3, "ms"),
        s if s >= 1e-7 => (s * 1e6, "µs"),
        s => (s, "s"),
    };
    let number = letters::escape(&significant(number, 6));
    format!("Δ*t* = {number} {unit}")
}
