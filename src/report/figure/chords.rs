//! Paths with too few points for a figure, whose bends would be cut off by straight lines between the points.
//!
//! A step of half a turn or more, and each step of a very long run, has no point within it (`arcs`). Then chords lie
//! inside the circle of the points. Compared with the exact motion this looks like an error of the run, so the points
//! are drawn without joining them. The exact motion has more points and is always a line, although over a very long
//! time they are too few as well.

use super::course::SampledRun;
use super::job::SampledRunNumbers;
use super::path::TracedPath;
use crate::plot::chart::SeriesStyle;

/// Added to a run's name in the legend if its points are not joined.
pub(super) const EVERY_STEP: &str = ", every step";

/// Returns the name and style of `drawn`. A run with too few points per turn is drawn as points, and its name says so.
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

/// Returns a warning for the first of `drawn` whose `path` has too few points per turn.
pub(super) fn warning(
    drawn: &[SampledRunNumbers],
    path: fn(&SampledRun) -> &TracedPath,
) -> Option<String> {
    drawn.iter().find_map(|drawn| {
        let a_turn = path(&drawn.course).few_a_turn?;
        Some(match (drawn.is_exact, drawn.name.as_str()) {
            (true, name) => format!(
                "the line of {name} has only about {a_turn:.0} points per turn over this long time and is straight between them"
            ),
            (false, name) => {
                let run = if name.is_empty() { "the run" } else { name };
                format!(
                    "{run} takes only about {a_turn:.0} time steps per turn, so its points are not joined: straight lines would cut off the bends"
                )
            }
        })
    })
}
