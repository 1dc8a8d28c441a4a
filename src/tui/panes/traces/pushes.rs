//! Bars under the time axis, with a word at each: where pushes act on a run, and the time that the upper strip shows.

use super::content::Content;
use super::{Traces, ZOOM, write};
use crate::observe::ghost::Ghost;
use crate::observe::marks::Marks;
use crate::observe::strip::Strip;
use crate::tui::theme::Role;
use ratatui::buffer::Buffer;
use ratatui::layout::Rect;

const BAR: &str = "═";
const WORD: &str = "push";
/// The mark of the time that the strip of the fast motion shows.
const ZOOM_BAR: &str = "▀";

impl Traces<'_> {
    /// Where pushes act, and the time of the strip `zoomed`, on the border below the strips, with the words beside them
    /// where there is room.
    pub(super) fn below(
        &self,
        marks: &Marks,
        zoomed: Option<&Strip>,
        strip: &Strip,
        border: Rect,
        buf: &mut Buffer,
    ) {
        let across = self.view.marker.dots().0;
        let mut pushed = vec![false; border.width as usize];
        let shown =
            |&(begin_s, end_s): &(f64, f64)| strip.shown(begin_s, end_s.min(self.reach_s()));
        for column in marks.pushes.iter().flat_map(shown) {
            if let Some(cell) = pushed.get_mut(column / across) {
                *cell = true;
            }
        }
        let style = self.view.theme.style(Role::Push);
        for (x, _) in (0..).zip(&pushed).filter(|(_, pushed)| **pushed) {
            write(border, (x, 0), BAR, style, buf);
        }
        for x in words(&pushed) {
            write(border, (x as u16, 0), WORD, style, buf);
            let end = (x + WORD.len()).min(pushed.len());
            pushed[x..end].fill(true);
        }
        let zoomed = zoomed.map(|zoomed| strip.shown(zoomed.begin_s, zoomed.end_s()));
        let Some(zoomed) = zoomed.filter(|zoomed| !zoomed.is_empty()) else {
            return;
        };
        let (begin, end) = (zoomed.start / across, (zoomed.end - 1) / across + 1);
        let style = self
            .view
            .theme
            .style(Self::role(Content::Curve(self.detail.curve)));
        for x in begin..end {
            write(border, (x as u16, 0), ZOOM_BAR, style, buf);
        }
        if let Some(x) = word(&pushed, (begin, end), 0) {
            write(border, (x as u16, 0), ZOOM, style, buf);
        }
    }

    /// The time up to which there is something to see, s.
    fn reach_s(&self) -> f64 {
        let before = self.ghost.map_or(0.0, Ghost::end_s);
        self.run.now().time_s.max(before)
    }
}

/// The columns at which [`WORD`] stands for the stretches of `pushed` columns: in the stretch, or beside it.
fn words(pushed: &[bool]) -> Vec<usize> {
    let mut places: Vec<usize> = Vec::new();
    let mut begin = 0;
    for stretch in pushed.chunk_by(|a, b| a == b) {
        let end = begin + stretch.len();
        if stretch.contains(&true) {
            let free_from = places.last().map_or(0, |last| last + WORD.len());
            places.extend(word(pushed, (begin, end), free_from));
        }
        begin = end;
    }
    places
}

/// The column of [`WORD`] for the pushed columns from `begin` to before `end`; before `free_from` there are others.
fn word(pushed: &[bool], (begin, end): (usize, usize), free_from: usize) -> Option<usize> {
    let length = WORD.len();
    if end - begin >= length + 2 {
        return Some(begin + (end - begin - length) / 2);
    }
    // With a free column at its end, lest it seem to belong to the next stretch.
    let is_free = |from: usize, to: usize| {
        let columns = pushed.get(from..to.min(pushed.len()));
        columns.is_some_and(|columns| columns.len() >= length && !columns.contains(&true))
    };
    let before = begin.checked_sub(length);
    let before = before.filter(|&at| at >= free_from && is_free(at.saturating_sub(1), begin));
    if is_free(end, end + length + 1) {
        Some(end)
    } else {
        before
    }
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
