//! What runs are called beside each other: by what differs.

use super::chart::legend::longest_name;
use super::page::ink::LABEL_PT;
use super::page::letters;
use super::request::{Job, Run};
use crate::text::number::significant;

/// What of a run may differ from the others.
type Of<'a> = &'a dyn Fn(&Run) -> String;

/// A name for each of the runs, as markup with room in the legend; empty where there is nothing to tell apart.
pub(super) fn names(job: &Job<'_>) -> Vec<String> {
    let &Job { runs, request, .. } = job;
    let room_pt = longest_name(request.width_pt);
    let differs = |of: Of<'_>| runs.iter().any(|run| of(run) != of(&runs[0]));
    let title = |run: &Run| run.scenario.file.title.clone();
    let scheme = |run: &Run| run.scenario.motion.scheme.name.to_owned();
    let time_step = |run: &Run| step(run);
    let parts: [(bool, Of<'_>); 3] = [
        (differs(&title), &title),
        (differs(&scheme), &scheme),
        (differs(&time_step), &time_step),
    ];
    let is_alike = parts.iter().all(|(differs, _)| !differs);
    let name = |run: &Run| -> String {
        if is_alike {
            return match (runs.len(), request.is_beside()) {
                (1, false) => String::new(),
                (1, true) => letters::escape(&scheme(run)),
                _ => letters::shortened(&run.named, LABEL_PT, room_pt),
            };
        }
        let differing = parts[..2].iter().filter(|(differs, _)| *differs);
        let words: Vec<_> = differing.map(|(_, of)| of(run)).collect();
        // The step comes as markup, and keeps its room; the title is cut.
        let step = match (parts[2].0, words.is_empty()) {
            (false, _) => String::new(),
            (true, true) => time_step(run),
            (true, false) => format!(", {}", time_step(run)),
        };
        let rest = room_pt - super::page::ink::width(&step, LABEL_PT);
        letters::shortened(&words.join(", "), LABEL_PT, rest) + &step
    };
    runs.iter().map(name).collect()
}

/// "Δt = 10 ms" as markup.
fn step(run: &Run) -> String {
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
