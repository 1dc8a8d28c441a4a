//! The list of keys, from the table of keys.

use super::{frame_on_top, write};
use crate::workbench::keymap::{BINDINGS, Binding, Mode};
use crate::workbench::theme::{Role, Theme};
use ratatui::buffer::Buffer;
use ratatui::layout::Rect;
use ratatui::widgets::Widget;

/// Column of the explanations.
const TEXT: u16 = 16;

/// The keys of all modes.
pub struct Help<'a> {
    /// First line shown.
    pub scroll: usize,
    /// Colours.
    pub theme: &'a Theme,
}

impl Widget for Help<'_> {
    fn render(self, area: Rect, buf: &mut Buffer) {
        let lines = lines();
        let room = area.height.saturating_sub(2) as usize;
        let scroll = self.scroll.min(lines.len().saturating_sub(room));
        let title = match lines.len().saturating_sub(scroll + room) {
            0 => "keys: Esc closes".to_owned(),
            more => format!("keys: Esc closes, arrow down shows {more} more"),
        };
        let inside = frame_on_top(&title, area, self.theme, buf);
        for (line, y) in lines.iter().skip(scroll).zip(0..inside.height) {
            let row = Rect {
                y: inside.y + y,
                height: 1,
                ..inside
            };
            match line {
                Line::Heading(text) => drop(write(
                    row,
                    (1, 0),
                    text,
                    self.theme.style(Role::Heading),
                    buf,
                )),
                Line::Keys(binding) => {
                    write(
                        row,
                        (2, 0),
                        &keys(binding),
                        self.theme.style(Role::Focus),
                        buf,
                    );
                    write(
                        row,
                        (TEXT, 0),
                        binding.help,
                        self.theme.style(Role::Text),
                        buf,
                    );
                }
            }
        }
    }
}

enum Line {
    Heading(&'static str),
    Keys(&'static Binding),
}

/// Each binding once, under the first mode that has it.
fn lines() -> Vec<Line> {
    let mut lines = Vec::new();
    for (mode, heading) in [
        (Mode::Lab, "the lab"),
        (Mode::Browser, "the list of presets and files"),
        (Mode::Filter, "the filter"),
    ] {
        lines.push(Line::Heading(heading));
        lines.extend(
            BINDINGS
                .iter()
                .filter(|row| row.modes[0] == mode)
                .map(Line::Keys),
        );
    }
    lines
}

fn keys(binding: &Binding) -> String {
    binding
        .keys
        .iter()
        .map(ToString::to_string)
        .collect::<Vec<_>>()
        .join(" ")
}
