//! Paths with too few points for a figure: straight lines between them would cut the bends off.
//!
//! A run that takes ten time steps for a turn of its path, drawn as chords, lies inside the circle that its points lie on.
//! Beside the exact motion that looks like an error of the run: so the points are drawn, and not joined. The exact motion is
//! a line with more points, though over a very long stretch of time they are too few as well.

use super::course::SampledRun;
use super::job::SampledRunNumbers;
use super::path::TracedPath;
use crate::plot::chart::SeriesStyle;

/// What the legend says of points that are not joined.
pub(super) const EVERY_STEP: &str = ", every step";

/// What is drawn, as its `path` is drawn: of a run with too few points to look round these alone, and its name says so.
pub(super) fn as_drawn(drawn: &SampledRunNumbers, path: &TracedPath) -> (String, SeriesStyle) {
    if path.few_a_turn.is_none() || drawn.is_exact {
        return (drawn.name.clone(), drawn.style.clone());
    }
    let name = match drawn.name.as_str() {
        "" => String::new(),
        name => format!("{name}{EVERY_STEP}"),
    };
    (name, drawn.style.clone().as_dots())
}

/// What is said of the first of `drawn` whose `path` has too few points to look round.
pub(super) fn warning(
    drawn: &[SampledRunNumbers],
    path: fn(&SampledRun) -> &TracedPath,
) -> Option<String> {
    drawn.iter().find_map(|drawn| {
        let a_turn = path(&drawn.course).few_a_turn?;
        Some(match (drawn.is_exact, drawn.name.as_str()) {
            (true, name) => format!(
                "the line of {name} has only about {a_turn:.0} points a turn in so long a stretch of time: between them it is straight"
            ),
            (false, name) => {
                let run = if name.is_empty() { "the run" } else { name };
                format!(
                    "{run} takes about {a_turn:.0} time steps for a turn: they are drawn as points, since straight lines between them would cut the bends off"
                )
            }
        })
    })
}
