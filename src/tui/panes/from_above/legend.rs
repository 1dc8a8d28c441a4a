//! The scale of the picture from above, and the meaning of its marks and lines.

use super::{FromAbove, Plane, write};
use crate::lab::view::markers::Marker;
use crate::text::wrap::columns;
use crate::tui::theme::Role;
use ratatui::buffer::Buffer;
use ratatui::layout::Rect;

/// What stands between two words of a legend at length, and in short.
const BETWEEN: [&str; 2] = [", ", " "];
const BEFORE: [&str; 2] = ["dotted: before"; 2];

impl FromAbove<'_> {
    /// The lines of the legend on `width` columns; the last has room for the scale of `plane` beside it. Where `most` lines
    /// are too few for every mark and line of the picture, those named last are left out.
    pub(super) fn legend(&self, plane: &Plane, width: u16, most: usize) -> Vec<String> {
        let width = width as usize;
        let room = width.saturating_sub(columns(&self.bar(plane, width)) + 1);
        let words = self.words();
        let legend = Self::in_fewest_lines(&words, width, room, most);
        if words.contains(&BEFORE) || self.ghost.is_some() {
            return legend;
        }
        // The path before the last swings is dotted too: said where it costs no line.
        let longer = [&words[..], &[BEFORE]].concat();
        let longer = Self::in_fewest_lines(&longer, width, room, legend.len());
        let has_all = longer.iter().any(|line| line.contains(BEFORE[0]));
        if has_all { longer } else { legend }
    }

    fn in_fewest_lines(words: &[[&str; 2]], width: usize, room: usize, most: usize) -> Vec<String> {
        for lines in 1..=most {
            for form in [0, 1] {
                let legend = in_lines(words, form, width, room);
                if legend.len() <= lines {
                    return legend;
                }
            }
        }
        let fewer = (1..words.len()).rev();
        let mut fewer = fewer.map(|count| in_lines(&words[..count], 1, width, room));
        let fits = |legend: &Vec<String>| legend.len() <= most;
        fewer.find(fits).unwrap_or_else(|| vec![String::new()])
    }

    /// The legend and the scale on `area`, which has as many rows as the legend has lines.
    pub(super) fn write_legend(&self, plane: &Plane, area: Rect, buf: &mut Buffer) {
        let style = self.view.theme.style(Role::Quiet);
        let last = area.height.saturating_sub(1);
        let bar = self.bar(plane, area.width as usize);
        write(area, (0, last), &bar, style, buf);
        let lines = self.legend(plane, area.width, area.height as usize);
        for (line, y) in lines.iter().zip(0..) {
            let x = if y == last {
                area.width.saturating_sub(columns(line) as u16)
            } else {
                0
            };
            write(area, (x, y), line, style, buf);
        }
    }

    /// The scale: a line of a round length.
    fn bar(&self, plane: &Plane, width: usize) -> String {
        // The longer legend beside it leaves less room for the bar.
        let share = if self.run.overlay().is_some() {
            0.25
        } else {
            0.4
        };
        plane.bar(share * width as f64)
    }

    /// What is drawn, the most important first, at length and in short.
    fn words(&self) -> Vec<[&'static str; 2]> {
        let mut words = vec![["o now"; 2]];
        if self.run.overlay().is_some() {
            words.extend([["e exact"; 2], ["* both"; 2]]);
        }
        if self.pinned.is_some() {
            words.push(["long dashes: pinned", "-- pinned"]);
        }
        if self.ghost.is_some() {
            words.push(["dotted: other run", "dotted: other"]);
        }
        if !self.places().is_empty() {
            words.push(match self.view.marker {
                Marker::Ascii => ["X measured"; 2],
                _ => ["× measured"; 2],
            });
        }
        if words.len() == 1 {
            words.push(BEFORE);
        }
        words
    }
}

/// `words` in lines of at most `width` columns, the last of at most `room`.
fn in_lines(words: &[[&str; 2]], form: usize, width: usize, room: usize) -> Vec<String> {
    let between = BETWEEN[form];
    let mut lines = vec![String::new()];
    for word in words.iter().map(|word| word[form]) {
        match lines.last_mut() {
            Some(line) if line.is_empty() => *line = word.to_owned(),
            Some(line) if columns(line) + columns(between) + columns(word) <= width => {
                *line += &format!("{between}{word}");
            }
            _ => lines.push(word.to_owned()),
        }
    }
    if lines.last().is_some_and(|line| columns(line) > room) {
        lines.push(String::new());
    }
    lines
}
