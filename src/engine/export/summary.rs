//! The summary of a finished run, as text for a reader and as JSON for a program.

use crate::analysis::Readouts;
use crate::analysis::readouts::{SummaryPart, summary_rows};
use crate::scenario::Scenario;
use crate::text::number::shortest;
use serde::Serialize;
use std::fmt;
use std::time::Duration;

/// The summary of a finished run. As JSON it is the table of [readouts](crate::analysis::readouts).
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(transparent)]
pub struct RunSummary {
    readouts: Readouts,
    /// How many steps of which time step it had, in words, where it had several.
    #[serde(skip)]
    steps: Option<String>,
    /// Whether its text says theory, lag and what else is known too.
    #[serde(skip)]
    is_full: bool,
}

impl RunSummary {
    /// The summary of a run that has `readouts` at its end and spent the time `wall` on stepping.
    pub fn new(readouts: Readouts, wall: Duration) -> Self {
        Self {
            readouts: Readouts {
                stepping: Some(wall),
                ..readouts
            },
            steps: None,
            is_full: false,
        }
    }

    /// The same summary, whose text leaves nothing out if `is_full`.
    pub fn in_full(self, is_full: bool) -> Self {
        Self { is_full, ..self }
    }

    /// The same summary with all time steps that the run of `scenario` has had, not the last one only.
    pub fn with_time_steps_of(self, scenario: &Scenario) -> Self {
        let steps = steps_in_words(scenario, self.readouts.sample.step);
        Self {
            steps: Some(steps),
            ..self
        }
    }

    /// The lines of `part` that this run has.
    fn lines(&self, part: SummaryPart) -> String {
        let rows = summary_rows(part).into_iter();
        rows.filter_map(|(readout, row)| {
            let several = self.steps.as_ref().filter(|_| readout.name == "steps");
            let text = several.cloned().or_else(|| row.read(&self.readouts))?;
            Some(format!("  {:<14}{text}\n", row.label))
        })
        .collect()
    }
}

/// The first `steps` steps of `scenario` with their time steps: "2300 of 0.1 s", or "2300: 40 of 0.1 s, then 2260 of
/// 0.05 s" where edits have changed the time step.
pub fn steps_in_words(scenario: &Scenario, steps: u64) -> String {
    let mut parts: Vec<(u64, f64)> = Vec::new();
    let (mut begin, mut time_step_s) = (0, scenario.motion.time_step_s);
    let edits = scenario.edits.iter().filter(|edit| edit.sets_time_step);
    for edit in edits.take_while(|edit| edit.step < steps) {
        parts.push((edit.step - begin, time_step_s));
        (begin, time_step_s) = (edit.step, edit.motion.time_step_s);
    }
    parts.push((steps - begin.min(steps), time_step_s));
    parts.retain(|(count, _)| *count > 0);
    parts.dedup_by(|next, before| {
        let is_same = next.1 == before.1;
        before.0 += if is_same { next.0 } else { 0 };
        is_same
    });
    match &parts[..] {
        [] => format!("{steps} of {} s", shortest(time_step_s)),
        [(count, step_s)] => format!("{count} of {} s", shortest(*step_s)),
        few if few.len() <= 4 => {
            let few: Vec<_> = few
                .iter()
                .map(|(count, step_s)| format!("{count} of {} s", shortest(*step_s)))
                .collect();
            format!("{steps}: {}", few.join(", then "))
        }
        many => {
            let least = many.iter().map(|part| part.1).fold(f64::INFINITY, f64::min);
            let most = many.iter().map(|part| part.1).fold(0.0, f64::max);
            let (least, most) = (shortest(least), shortest(most));
            format!(
                "{steps} of {least} to {most} s, changed {} times",
                many.len() - 1
            )
        }
    }
}

impl fmt::Display for RunSummary {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let readouts = &self.readouts;
        let first = self.lines(SummaryPart::Motion);
        let verdict = readouts.health.sentence(readouts.advice.as_ref());
        let mut rest = self.lines(SummaryPart::State);
        if self.is_full {
            rest += &self.lines(SummaryPart::Further);
        }
        let title = &readouts.title;
        write!(f, "{title}\n{first}\n{verdict}\n\n{}", rest.trim_end())
    }
}
