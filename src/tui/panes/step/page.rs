//! A page of text in sections, of which the least important are left out where the screen is too small for all.

use super::super::{leave_one_out, write};
use crate::engine::text::wrap::wrapped;
use crate::lab::view::theme::Theme;
use crate::tui::theme::Role;
use ratatui::buffer::Buffer;
use ratatui::layout::Rect;
use ratatui::style::Modifier;

/// A line: texts with the columns where they begin.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct StepPageLine {
    pub pieces: Vec<(usize, String, Role)>,
    pub is_chosen: bool,
}

#[derive(Clone, Debug, Default)]
pub struct StepPageSection {
    /// The section of the highest rank is left out first; those of rank 0 never are.
    pub rank: u8,
    /// Whether an empty line stands before it where there is room for all such lines.
    pub is_apart: bool,
    /// The index of the quantity that is the table of these lines.
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

    /// `text` in as many lines of `width` columns as it takes; those after the first begin in the column `indent`.
    pub fn text(rank: u8, text: &str, width: usize, indent: usize, role: Role) -> Self {
        let lines = wrapped(text, width.saturating_sub(indent)).into_iter();
        let indented = lines.enumerate().map(|(line, words)| {
            let column = if line == 0 { 0 } else { indent };
            StepPageLine::new(column, words, role)
        });
        Self::new(rank, indented.collect())
    }

    /// The same with an empty line before it where there is room.
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

/// Leaves sections out, those of the highest rank first, until no more than `room` lines are left, or only those of rank 0.
pub fn fit(sections: &mut Vec<StepPageSection>, room: usize) {
    while height(sections) > room && leave_one_out(sections, |section| section.rank) {}
}

/// Puts an empty line before each section that wants one, if `room` holds all of them.
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
