//! A page of text in sections. The least important ones are omitted if the screen is too small for all.

use super::super::{remove_least_important, write};
use crate::engine::text::wrap::wrapped;
use crate::lab::view::theme::Theme;
use crate::tui::theme::Role;
use ratatui::buffer::Buffer;
use ratatui::layout::Rect;
use ratatui::style::Modifier;

/// A line: texts, each with its first column.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct StepPageLine {
    pub pieces: Vec<(usize, String, Role)>,
    pub is_chosen: bool,
}

/// A section of a page.
#[derive(Clone, Debug, Default)]
pub struct StepPageSection {
    /// Importance. The section of the highest rank is omitted first; sections of rank 0 are never omitted.
    pub rank: u8,
    /// True if an empty line precedes the section when there is room for all such lines.
    pub is_apart: bool,
    /// Index of the quantity whose table these lines show.
    pub table: Option<usize>,
    pub lines: Vec<StepPageLine>,
}

impl StepPageLine {
    pub fn new(column: usize, text: impl Into<String>, role: Role) -> Self {
        Self::default().and(column, text, role)
    }

    pub fn and(mut self, column: usize, text: impl Into<String>, role: Role) -> Self {
        self.pieces.push((column, text.into(), role));
        self
    }

    pub fn is_blank(&self) -> bool {
        self.pieces.iter().all(|(_, text, _)| text.is_empty())
    }
}

impl StepPageSection {
    pub fn new(rank: u8, lines: Vec<StepPageLine>) -> Self {
        Self {
            rank,
            lines,
            ..Self::default()
        }
    }

    /// Creates a section of `text` on `width` columns. Lines after the first begin in the column `indent`.
    pub fn text(rank: u8, text: &str, width: usize, indent: usize, role: Role) -> Self {
        let lines = wrapped(text, width.saturating_sub(indent)).into_iter();
        let indented = lines.enumerate().map(|(line, words)| {
            let column = if line == 0 { 0 } else { indent };
            StepPageLine::new(column, words, role)
        });
        Self::new(rank, indented.collect())
    }

    /// Returns the section with an empty line before it, if there is room.
    pub fn apart(self) -> Self {
        Self {
            is_apart: true,
            ..self
        }
    }
}

pub fn height(sections: &[StepPageSection]) -> usize {
    sections.iter().map(|section| section.lines.len()).sum()
}

/// Removes sections, highest rank first, until at most `room` lines or only those of rank 0 are left.
pub fn fit(sections: &mut Vec<StepPageSection>, room: usize) {
    while height(sections) > room && remove_least_important(sections, |section| section.rank) {}
}

/// Inserts an empty line before each section with `is_apart`, if `room` is enough for all of them.
pub fn spread(sections: &mut [StepPageSection], room: usize) {
    let occupied = height(sections);
    let others = sections.iter_mut().skip(1);
    let apart: Vec<_> = others.filter(|section| section.is_apart).collect();
    if occupied + apart.len() <= room {
        for section in apart {
            section.lines.insert(0, StepPageLine::default());
        }
    }
}

pub fn draw(sections: &[StepPageSection], area: Rect, theme: &Theme, buf: &mut Buffer) {
    let lines = sections.iter().flat_map(|section| &section.lines);
    for (line, place) in lines.zip(area.rows()) {
        for (column, text, role) in &line.pieces {
            write(place, (*column as u16, 0), text, theme.style(*role), buf);
        }
        if line.is_chosen {
            let tint = theme.style(Role::WindowTint).add_modifier(Modifier::BOLD);
            let chosen = Some(tint).filter(|tint| tint.bg.is_some());
            buf.set_style(place, chosen.unwrap_or(theme.style(Role::Selected)));
        }
    }
}
