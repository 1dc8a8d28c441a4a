//! The title of the traces: what is drawn, and how the other runs differ from the run.

use super::{ALL, ROW, Traces};
use crate::text::number::decimal;

/// What the title says of bands: at length, and in short.
const BANDS: [&str; 2] = [
    "hatched band: from lowest to highest of fast swings",
    "band: lowest to highest of swings",
];
/// What the title says of the exact motion, the run before and the pinned run: at length, in short and shorter.
const EXACT: [&str; 3] = ["dashed: exact motion", "- - exact", "-- exact"];
const NO_EXACT: [&str; 3] = [
    "no exact motion: too long to integrate",
    "no exact",
    "no exact",
];
const OTHER: [&str; 3] = ["dotted: all of the other run", "··· other run", "··· other"];
const PINNED: [&str; 3] = [
    "long and short: all of the pinned run",
    "-- - pinned",
    "-- - pin",
];

impl Traces<'_> {
    /// What is drawn: the point, and the runs beside it where there are any, as far as there is room.
    pub(super) fn title(&self, room: usize) -> String {
        if let Some(cursor) = self.cursor {
            let (step, time_s) = (cursor.step, decimal(cursor.time_s));
            return format!("step {step} at {time_s} s");
        }
        let named = self.run.scenario().file.trace.as_deref();
        let point = named.unwrap_or("axle top");
        let has_exact = self.run.overlay().is_some();
        let beside = [
            (has_exact, EXACT),
            (self.run.shows_exact() && !has_exact, NO_EXACT),
            (self.ghost.is_some(), OTHER),
            (self.pinned.is_some(), PINNED),
        ];
        let legend = |length: usize, between: &str| {
            let shown = beside.iter().filter(|(is_shown, _)| *is_shown);
            let words: Vec<_> = shown.map(|(_, legends)| legends[length]).collect();
            words.join(between)
        };
        let long = [ROW.title.to_owned(), legend(0, ", ")];
        let long = long.into_iter().filter(|part| !part.is_empty());
        let long = long.collect::<Vec<_>>().join(", ");
        let mut titles = vec![format!("{point} {long}")];
        let is_divided = self.detail.window_s < ALL * self.view.window_s;
        if self.ghost.is_none() && self.pinned.is_none() && (is_divided || has_exact) {
            titles.insert(0, format!("{point} {long}; {}", BANDS[0]));
            if !has_exact {
                titles.insert(1, format!("{point}; {}", BANDS[1]));
            }
        }
        let shortest = match legend(2, " ") {
            none if none.is_empty() => ROW.title.to_owned(),
            shortest => {
                titles.push(format!("{point} {}", legend(1, " ")));
                titles.push(format!("{point} {shortest}"));
                shortest
            }
        };
        let fits = |title: &String| title.chars().count() <= room;
        titles.into_iter().find(fits).unwrap_or(shortest)
    }
}
