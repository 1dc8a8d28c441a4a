//! The picture of the lab as SVG, in colour, for a slide: dots of Braille are drawn, everything else is text.

use super::screen;
use crate::lab::Lab;
use crate::lab::view::theme::Background;
use crate::text::printable::xml;
use ratatui::buffer::{Buffer, Cell};
use ratatui::layout::Rect;
use ratatui::style::{Color, Modifier};
use std::fmt::Write; // which cannot fail on a `String`

/// A cell, px.
const WIDTH: u16 = 8;
const HEIGHT: u16 = 16;
/// From a cell's upper edge to the line on which letters stand, and how large they are, px.
const BASE: u16 = 12;
const SIZE: f64 = 13.3;
const FONTS: &str = "DejaVu Sans Mono,Menlo,Consolas,Liberation Mono,monospace";
/// The picture of `lab` on a screen of this width and height.
pub fn svg(lab: &Lab, (columns, lines): (u16, u16), background: Background) -> String {
    let area = Rect::new(0, 0, columns, lines);
    let mut buf = Buffer::empty(area);
    screen::draw(lab, false, area, &mut buf);
    let paper = match background {
        Background::Dark => ["#e5e5e5", "#1e1e1e"],
        Background::Light => ["#1e1e1e", "#ffffff"],
    };
    let (width, height) = (
        u32::from(columns * WIDTH),
        u32::from(lines) * u32::from(HEIGHT),
    );
    let title = xml(&lab.player().run().scenario().file.title);
    let mut out = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width}\" height=\"{height}\" viewBox=\"0 0 {width} {height}\" \
         font-family=\"{FONTS}\" font-size=\"{SIZE}\">\n<title>{title}</title>\n\
         <rect width=\"{width}\" height=\"{height}\" fill=\"{}\"/>\n",
        paper[1]
    );
    for y in 0..lines {
        let row: Vec<&Cell> = (0..columns).filter_map(|x| buf.cell((x, y))).collect();
        let mut x = 0;
        for run in row.chunk_by(|a, b| (a.fg, a.bg, a.modifier) == (b.fg, b.bg, b.modifier)) {
            put(&mut out, run, (x, y), paper);
            x += run.len() as u16;
        }
    }
    out + "</svg>\n"
}

/// Cells of one style, from the one at this column and line on.
fn put(out: &mut String, cells: &[&Cell], (column, line): (u16, u16), paper: [&str; 2]) {
    let Some(first) = cells.first() else {
        return;
    };
    let mut colours = [colour(first.fg, paper[0]), colour(first.bg, paper[1])];
    if first.modifier.contains(Modifier::REVERSED) {
        colours.reverse();
    }
    let [ink, ground] = colours;
    let (left, top) = (column * WIDTH, u32::from(line) * u32::from(HEIGHT));
    if ground != paper[1] {
        let width = cells.len() as u16 * WIDTH;
        let _ = writeln!(
            out,
            "<rect x=\"{left}\" y=\"{top}\" width=\"{width}\" height=\"{HEIGHT}\" fill=\"{ground}\"/>"
        );
    }
    let (mut text, mut places, mut dots) = (String::new(), String::new(), String::new());
    for (cell, x) in cells.iter().zip((left..).step_by(usize::from(WIDTH))) {
        match cell.symbol().chars().next() {
            None | Some(' ') => {}
            Some(c @ '\u{2800}'..='\u{28ff}') => braille(&mut dots, c, u32::from(x), top),
            Some(_) => {
                text += cell.symbol();
                let _ = write!(places, "{x} ");
            }
        }
    }
    let is_dim = first.modifier.contains(Modifier::DIM);
    let opacity = if is_dim { " opacity=\".65\"" } else { "" };
    if !dots.is_empty() {
        let _ = writeln!(out, "<path fill=\"{ink}\"{opacity} d=\"{dots}\"/>");
    }
    if !text.is_empty() {
        let is_bold = first.modifier.contains(Modifier::BOLD);
        let weight = if is_bold { " font-weight=\"bold\"" } else { "" };
        let (y, places, text) = (top + u32::from(BASE), places.trim_end(), xml(&text));
        let _ = writeln!(
            out,
            "<text x=\"{places}\" y=\"{y}\" fill=\"{ink}\"{weight}{opacity}>{text}</text>"
        );
    }
}

/// The dots of a Braille letter in the cell at this place, as a path.
fn braille(path: &mut String, letter: char, left: u32, top: u32) {
    /// The column and the line of each dot, in the order of the letter's bits.
    const DOTS: [[u32; 2]; 8] = [
        [0, 0],
        [0, 1],
        [0, 2],
        [1, 0],
        [1, 1],
        [1, 2],
        [0, 3],
        [1, 3],
    ];
    let bits = u32::from(letter) - 0x2800;
    for (_, [column, line]) in DOTS
        .iter()
        .enumerate()
        .filter(|(bit, _)| bits >> bit & 1 == 1)
    {
        let (x, y) = (left + 4 * column + 1, top + 4 * line + 1);
        let _ = write!(path, "M{x} {y}h2v2h-2z");
    }
}

/// The colour as most terminals have it; `otherwise` where the terminal's own is meant.
fn colour(colour: Color, otherwise: &str) -> String {
    let named = match colour {
        Color::Red => "#cd3131",
        Color::Green => "#0dbc79",
        Color::Yellow => "#e5e510",
        Color::Blue => "#2472c8",
        Color::Magenta => "#bc3fbc",
        Color::Cyan => "#11a8cd",
        Color::LightRed => "#f14c4c",
        Color::LightBlue => "#3b8eea",
        Color::LightYellow => "#f5f543",
        Color::Indexed(index @ 16..=231) => {
            let part = |step: u8| if step == 0 { 0 } else { 55 + 40 * step };
            let cube = index - 16;
            let [red, green, blue] = [cube / 36, cube / 6 % 6, cube % 6].map(part);
            return format!("#{red:02x}{green:02x}{blue:02x}");
        }
        _ => otherwise,
    };
    named.to_owned()
}
