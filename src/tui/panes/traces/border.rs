//! What stands on the frame: the title above, which says what is drawn, and below bars with a word at each, where pushes
//! act on the run and where the time is that the strip of the fast motion shows.

use super::super::longest;
use super::groups::StripContent;
use super::{TRACES_ROW, Traces, ZOOM_MARK, write};
use crate::engine::text::number::decimal;
use crate::lab::playback::ghost::Ghost;
use crate::lab::playback::marks::Marks;
use crate::lab::playback::strip::Strip;
use crate::tui::theme::Role;
use ratatui::buffer::Buffer;
use ratatui::layout::Rect;
use ratatui::style::Style;
use std::ops::Range;

/// What the title says of bands: at length, and in short.
const BANDS: [&str; 2] = [
    "hatched band: from lowest to highest of fast swings",
    "band: lowest to highest of swings",
];
/// What the title says of the exact motion, the run before and the pinned run: at length, in short and shorter.
const EXACT_TITLES: [&str; 3] = ["dashed: exact motion", "- - exact", "-- exact"];
const NO_EXACT: [&str; 3] = [
    "no exact motion: too long to integrate",
    "no exact",
    "no exact",
];
const OTHER_RUN_TITLES: [&str; 3] = ["dotted: all of the other run", "··· other run", "··· other"];
const PINNED_TITLES: [&str; 3] = [
    "long and short: all of the pinned run",
    "-- - pinned",
    "-- - pin",
];

const BORDER_BAR: &str = "═";
const WORD: &str = "push";
/// The mark of the time that the strip of the fast motion shows.
const ZOOM_BAR: &str = "▀";

impl Traces<'_> {
    /// What is drawn: the point, the runs beside it, and a band, as far as there is room.
    pub(super) fn title(&self, has_band: bool, room: usize) -> String {
        if let Some(cursor) = self.0.cursor {
            let (step, time_s) = (cursor.step, decimal(cursor.time_s));
            return format!("step {step} at {time_s} s");
        }
        let scenario = self.0.run.scenario();
        let point = if scenario.traces_top() {
            "axle top"
        } else {
            scenario.traced_name()
        };
        let has_exact = self.0.run.overlay().is_some();
        let beside = [
            (has_exact, EXACT_TITLES),
            (self.0.run.shows_exact() && !has_exact, NO_EXACT),
            (self.0.ghost.is_some(), OTHER_RUN_TITLES),
            (self.0.pinned.is_some(), PINNED_TITLES),
        ];
        let shown: Vec<_> = beside.iter().filter(|(is_shown, _)| *is_shown).collect();
        let legend = |length: usize| shown.iter().map(move |(_, legends)| legends[length]);
        let long: Vec<_> = [TRACES_ROW.title].into_iter().chain(legend(0)).collect();
        let long = format!("{point} {}", long.join(", "));
        let mut titles = Vec::new();
        if has_band && self.0.ghost.is_none() && self.0.pinned.is_none() {
            titles.push(format!("{long}; {}", BANDS[0]));
            titles.extend((!has_exact).then(|| format!("{point}; {}", BANDS[1])));
        }
        titles.push(long);
        let mut shortest = TRACES_ROW.title.to_owned();
        for length in [1, 2].into_iter().filter(|_| !shown.is_empty()) {
            shortest = legend(length).collect::<Vec<_>>().join(" ");
            titles.push(format!("{point} {shortest}"));
        }
        titles.push(shortest);
        longest(titles, room)
    }

    /// Draws where pushes act, and the time of the strip `zoomed`, on the `border` below `strip`, with the words beside them
    /// where there is room.
    pub(super) fn below(
        &self,
        marks: &Marks,
        zoomed: Option<&Strip>,
        strip: &Strip,
        border: Rect,
        buf: &mut Buffer,
    ) {
        let mut pushed = self.pushed(marks, strip, border.width);
        let of_push = self.0.view.theme.style(Role::Push);
        let mut put = |x: usize, text, style: Style| write(border, (x as u16, 0), text, style, buf);
        for x in (0..pushed.len()).filter(|x| pushed[*x]) {
            put(x, BORDER_BAR, of_push);
        }
        for x in words(&pushed) {
            put(x, WORD, of_push);
            let end = (x + WORD.len()).min(pushed.len());
            pushed[x..end].fill(true);
        }
        let dots = zoomed.map(|zoomed| strip.shown(zoomed.begin_s, zoomed.end_s()));
        let Some(dots) = dots.filter(|dots| !dots.is_empty()) else {
            return;
        };
        let across = self.0.view.marker.dots().0;
        let cells = dots.start / across..(dots.end - 1) / across + 1;
        let role = StripContent::Curve(self.0.detail.curve).role();
        let of_zoom = self.0.view.theme.style(role);
        for x in cells.clone() {
            put(x, ZOOM_BAR, of_zoom);
        }
        if let Some(x) = word(&pushed, cells, 0) {
            put(x, ZOOM_MARK, of_zoom);
        }
    }

    /// Which of `width` cells of `strip` show times at which a push acts, up to where there is something to see.
    fn pushed(&self, marks: &Marks, strip: &Strip, width: u16) -> Vec<bool> {
        let across = self.0.view.marker.dots().0;
        let before_s = self.0.ghost.map_or(0.0, Ghost::end_s);
        let reach_s = self.0.run.now().time_s.max(before_s);
        let mut pushed = vec![false; width as usize];
        for column in marks
            .pushes
            .iter()
            .flat_map(|&(begin_s, end_s)| strip.shown(begin_s, end_s.min(reach_s)))
        {
            if let Some(cell) = pushed.get_mut(column / across) {
                *cell = true;
            }
        }
        pushed
    }
}

/// The columns at which [`WORD`] stands for the stretches of `pushed` columns: in the stretch, or beside it.
fn words(pushed: &[bool]) -> Vec<usize> {
    let mut places: Vec<usize> = Vec::new();
    let mut begin = 0;
    for stretch in pushed.chunk_by(|a, b| a == b) {
        let end = begin + stretch.len();
        if stretch[0] {
            let free_from = places.last().map_or(0, |last| last + WORD.len());
            places.extend(word(pushed, begin..end, free_from));
        }
        begin = end;
    }
    places
}

/// The column of [`WORD`] for the pushed columns `at`; before `free_from` there are others.
fn word(pushed: &[bool], at: Range<usize>, free_from: usize) -> Option<usize> {
    let length = WORD.len();
    if at.len() >= length + 2 {
        return Some(at.start + (at.len() - length) / 2);
    }
    // With a free column at its end, lest it seem to belong to the next stretch.
    let is_free = |from: usize, to: usize| {
        let columns = pushed.get(from..to.min(pushed.len()));
        columns.is_some_and(|columns| columns.len() >= length && !columns.contains(&true))
    };
    if is_free(at.end, at.end + length + 1) {
        return Some(at.end);
    }
    let before = at.start.checked_sub(length);
    before.filter(|&before| before >= free_from && is_free(before.saturating_sub(1), at.start))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_word_stands_in_its_stretch_or_beside_it() {
        let places = |picture: &str| {
            let pushed: Vec<bool> = picture.chars().map(|sign| sign == '=').collect();
            words(&pushed)
        };
        assert_eq!(places("..======...."), [3]);
        assert_eq!(places(".==........."), [3]);
        assert_eq!(places("........==.."), [4]);
        assert!(places(".=.=.=.=.=.=").is_empty());
        assert_eq!(places("==.....=...."), [2, 8]);
        assert_eq!(places("==.....=..."), [2]);
        assert_eq!(places("==....=....."), [7]);
        assert!(places("===").is_empty());
        assert!(places("").is_empty());
    }
}
