//! The picture of the lab as SVG, in colour, for a slide: dots of Braille are drawn, everything else is text.

use super::screen;
use super::theme::{DARK_CYAN, DARK_GREEN};
use crate::engine::text::printable::xml;
use crate::lab::Lab;
use crate::lab::view::theme::Background;
use ratatui::buffer::{Buffer, Cell};
use ratatui::layout::Rect;
use ratatui::style::{Color, Modifier};
use std::fmt::Write; // which cannot fail on a `String`

/// A cell, px.
const CELL_WIDTH_PX: u32 = 8;
const CELL_HEIGHT_PX: u32 = 16;
/// From a cell's upper edge to the line on which letters stand, px.
const BASE: u32 = 12;
/// Fonts whose letters are as wide as a cell at this size, px.
const CELL_FONTS: &str = "DejaVu Sans Mono,Menlo,Consolas,Liberation Mono,monospace";
const SIZE: f64 = 13.3;

/// The picture of `lab` on a screen of this width and height.
pub fn svg(lab: &Lab, (columns, lines): (u16, u16), background: Background) -> String {
    let area = Rect::new(0, 0, columns, lines);
    let mut buf = Buffer::empty(area);
    screen::draw(lab, false, area, &mut buf);
    let paper = match background {
        Background::Dark => ["#e5e5e5", "#1e1e1e"],
        Background::Light => ["#1e1e1e", "#ffffff"],
    };
    let [width, height] = [
        u32::from(columns) * CELL_WIDTH_PX,
        u32::from(lines) * CELL_HEIGHT_PX,
    ];
    let title = xml(&lab.player().run().scenario().file.title);
    let mut out = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width}\" height=\"{height}\" viewBox=\"0 0 {width} {height}\" \
         font-family=\"{CELL_FONTS}\" font-size=\"{SIZE}\">\n<title>{title}</title>\n\
         <rect width=\"{width}\" height=\"{height}\" fill=\"{}\"/>\n",
        paper[1]
    );
    for y in 0..lines {
        let row: Vec<(u32, &Cell)> = (0..columns)
            .filter_map(|x| Some((u32::from(x) * CELL_WIDTH_PX, buf.cell((x, y))?)))
            .collect();
        for run in row.chunk_by(|a, b| look_of(a.1) == look_of(b.1)) {
            put(&mut out, run, u32::from(y) * CELL_HEIGHT_PX, paper);
        }
    }
    out + "</svg>\n"
}

fn look_of(cell: &Cell) -> (CellMark, Color, Color, Modifier) {
    (mark(cell), cell.fg, cell.bg, cell.modifier)
}

#[derive(Clone, Copy, PartialEq)]
enum CellMark {
    Blank,
    Dots,
    Letter,
}

fn mark(cell: &Cell) -> CellMark {
    match cell.symbol().chars().next() {
        None | Some(' ') => CellMark::Blank,
        Some('\u{2800}'..='\u{28ff}') => CellMark::Dots,
        Some(_) => CellMark::Letter,
    }
}

/// Cells that look alike, each with its left edge, in the line whose upper edge is at `top`.
fn put(out: &mut String, cells: &[(u32, &Cell)], top: u32, paper: [&'static str; 2]) {
    let Some((left, first)) = cells.first() else {
        return;
    };
    let mut colours = [colour(first.fg, paper[0]), colour(first.bg, paper[1])];
    if first.modifier.contains(Modifier::REVERSED) {
        colours.reverse();
    }
    let [ink, ground] = colours;
    if ground != paper[1] {
        let width = cells.len() as u32 * CELL_WIDTH_PX;
        *out += &format!(
            "<path fill=\"{ground}\" d=\"M{left} {top}h{width}v{CELL_HEIGHT_PX}h-{width}z\"/>\n"
        );
    }
    let dim = if first.modifier.contains(Modifier::DIM) {
        " opacity=\".65\""
    } else {
        ""
    };
    let bold = if first.modifier.contains(Modifier::BOLD) {
        " font-weight=\"bold\""
    } else {
        ""
    };
    match mark(first) {
        CellMark::Blank => {}
        CellMark::Dots => {
            let dots: String = cells
                .iter()
                .map(|(edge, cell)| dots(cell, *edge, top))
                .collect();
            let _ = writeln!(out, "<path fill=\"{ink}\"{dim} d=\"{dots}\"/>");
        }
        CellMark::Letter => {
            let text: String = cells.iter().map(|(_, cell)| cell.symbol()).collect();
            let (y, text) = (top + BASE, xml(&text));
            let _ = writeln!(
                out,
                "<text x=\"{left}\" y=\"{y}\" fill=\"{ink}\"{bold}{dim}>{text}</text>"
            );
        }
    }
}

/// The dots of a Braille letter as the data of a path.
fn dots(cell: &Cell, left: u32, top: u32) -> String {
    let bits = cell.symbol().chars().next().map_or(0, u32::from);
    let dots = (0..8).filter(|dot| bits >> dot & 1 == 1).map(|dot| {
        let [column, line] = if dot < 6 {
            [dot / 3, dot % 3]
        } else {
            [dot - 6, 3]
        };
        format!("M{} {}h2v2h-2z", left + 4 * column + 1, top + 4 * line + 1)
    });
    dots.collect()
}

/// A colour of the theme as most terminals show it; `otherwise` where the terminal's own is meant.
fn colour(colour: Color, otherwise: &'static str) -> &'static str {
    match colour {
        Color::Red => "#cd3131",
        Color::Green => "#0dbc79",
        Color::Yellow => "#e5e510",
        Color::Blue => "#2472c8",
        Color::Magenta => "#bc3fbc",
        Color::Cyan => "#11a8cd",
        Color::LightRed => "#f14c4c",
        Color::LightYellow => "#f5f543",
        Color::LightBlue => "#3b8eea",
        Color::Indexed(DARK_CYAN) => "#008787",
        Color::Indexed(DARK_GREEN) => "#008700",
        _ => otherwise,
    }
}
