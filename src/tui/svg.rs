//! The picture of the lab as SVG, in color, for a slide. Dots and lines become paths, everything else text.

use super::screen;
use crate::engine::text::printable::xml;
use crate::lab::Lab;
use crate::lab::view::Pane;
use crate::lab::view::theme::Background;
use ratatui::buffer::{Buffer, Cell};
use ratatui::layout::Rect;
use ratatui::style::{Color, Modifier};
use ratatui::symbols::pixel::OCTANTS;
use std::fmt::Write; // writing to a `String` cannot fail

/// Size of a cell, px.
const CELL_WIDTH: u32 = 8;
const CELL_HEIGHT: u32 = 16;
/// Distance from a cell's upper edge to the baseline of its letter, px.
const BASELINE: u32 = 12;
/// Fonts whose letters are about as wide as a cell at [`FONT_SIZE`]. The width of each text is set as well.
const CELL_FONTS: &str = "DejaVu Sans Mono,Menlo,Consolas,Liberation Mono,monospace";
/// Size of the letters, px.
const FONT_SIZE: f64 = 13.3;

/// Returns the picture of `lab` on a screen of this width and height.
pub fn svg(lab: &Lab, (columns, rows): (u16, u16), background: Background) -> String {
    let area = Rect::new(0, 0, columns, rows);
    let mut buf = Buffer::empty(area);
    screen::draw(lab, true, area, &mut buf);
    let title = &lab.player().run().scenario().file.title;
    of_cells(&buf, title, background)
}

/// Returns the picture of one `pane` of `lab` on white paper, without its title and without blank lines above and
/// below.
pub fn pane(lab: &Lab, pane: Pane, (columns, rows): (u16, u16)) -> String {
    let mut whole = Buffer::empty(Rect::new(0, 0, columns, rows));
    screen::draw_pane(lab, pane, whole.area, &mut whole);
    let lines = whole.content.chunks(columns.into()).skip(1);
    let is_blank = |line: &&[Cell]| line.iter().all(|cell| cell.symbol() == " ");
    let mut shown: Vec<&[Cell]> = lines.skip_while(is_blank).collect();
    while shown.last().is_some_and(is_blank) {
        shown.pop();
    }
    let buf = Buffer {
        area: Rect::new(0, 0, columns, shown.len() as u16),
        content: shown.concat(),
    };
    let scenario = &lab.player().run().scenario().file.title;
    let title = format!("The pane {} of the lab: {scenario}", pane.id());
    of_cells(&buf, &title, Background::Light)
}

fn of_cells(buf: &Buffer, title: &str, background: Background) -> String {
    let page = match background {
        Background::Dark => PageColors {
            ink: "#e4e4e4",
            paper: "#1b1d21",
        },
        Background::Light => PageColors {
            ink: "#1d1f23",
            paper: "#ffffff",
        },
    };
    let (columns, rows) = (buf.area.width, buf.area.height);
    let width = u32::from(columns) * CELL_WIDTH;
    let height = u32::from(rows) * CELL_HEIGHT;
    let title = xml(title);
    let mut out = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width}\" height=\"{height}\" viewBox=\"0 0 {width} {height}\" \
         font-family=\"{CELL_FONTS}\" font-size=\"{FONT_SIZE}\">\n<title>{title}</title>\n\
         <rect width=\"{width}\" height=\"{height}\" fill=\"{}\"/>\n",
        page.paper
    );
    for y in 0..rows {
        let row: Vec<(u32, &Cell)> = (0..columns)
            .filter_map(|x| Some((u32::from(x) * CELL_WIDTH, buf.cell((x, y))?)))
            .collect();
        for cells in row.chunk_by(|a, b| look_of(a.1) == look_of(b.1)) {
            put(&mut out, cells, u32::from(y) * CELL_HEIGHT, page);
        }
    }
    out + "</svg>\n"
}

/// Colors that stand for the terminal's own text and background colors, #rrggbb.
#[derive(Clone, Copy)]
struct PageColors {
    ink: &'static str,
    paper: &'static str,
}

fn look_of(cell: &Cell) -> (CellKind, Color, Color, Modifier) {
    (kind(cell), cell.fg, cell.bg, cell.modifier)
}

#[derive(Clone, Copy, PartialEq)]
enum CellKind {
    Blank,
    /// Dots, lines and blocks.
    Shape,
    Letter,
}

fn kind(cell: &Cell) -> CellKind {
    match cell.symbol().chars().next() {
        None | Some(' ') => CellKind::Blank,
        Some(symbol) if !shape(symbol).is_empty() => CellKind::Shape,
        Some(_) => CellKind::Letter,
    }
}

/// Draws cells of equal style, each with its left edge, in the row whose upper edge is at `top`.
fn put(out: &mut String, cells: &[(u32, &Cell)], top: u32, page: PageColors) {
    let Some((left, first)) = cells.first() else {
        return;
    };
    let (mut ink, mut ground) = (hex(first.fg, page.ink), hex(first.bg, page.paper));
    if first.modifier.contains(Modifier::REVERSED) {
        std::mem::swap(&mut ink, &mut ground);
    }
    let width = cells.len() as u32 * CELL_WIDTH;
    if ground != page.paper {
        let _ = writeln!(
            out,
            "<path fill=\"{ground}\" d=\"M{left} {top}h{width}v{CELL_HEIGHT}h-{width}z\"/>"
        );
    }
    if first.modifier.contains(Modifier::UNDERLINED) {
        let y = top + CELL_HEIGHT - 2;
        let _ = writeln!(
            out,
            "<path fill=\"{ink}\" d=\"M{left} {y}h{width}v1h-{width}z\"/>"
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
    match kind(first) {
        CellKind::Blank => {}
        CellKind::Shape => {
            let path: String = cells
                .iter()
                .flat_map(|(at, cell)| {
                    let symbol = cell.symbol().chars().next().unwrap_or(' ');
                    let bars = shape(symbol).into_iter();
                    bars.map(move |[x, y, w, h]| format!("M{} {}h{w}v{h}h-{w}z", at + x, top + y))
                })
                .collect();
            let _ = writeln!(out, "<path fill=\"{ink}\"{dim} d=\"{path}\"/>");
        }
        CellKind::Letter => {
            let text: String = cells.iter().map(|(_, cell)| cell.symbol()).collect();
            let (y, text) = (top + BASELINE, xml(&text));
            let _ = writeln!(
                out,
                "<text x=\"{left}\" y=\"{y}\" textLength=\"{width}\" fill=\"{ink}\"{bold}{dim}>{text}</text>"
            );
        }
    }
}

/// Returns the rectangles that draw `symbol`: left and upper edge, width and height, px. Returns none for a letter.
fn shape(symbol: char) -> Vec<[u32; 4]> {
    match symbol {
        '\u{2800}'..='\u{28ff}' => braille(u32::from(symbol) - 0x2800),
        '─' => vec![[0, 8, 8, 1]],
        '━' => vec![[0, 7, 8, 3]],
        '╴' => vec![[0, 8, 4, 1]],
        '│' => vec![[4, 0, 1, 16]],
        '┃' => vec![[3, 0, 3, 16]],
        '┼' => vec![[0, 8, 8, 1], [4, 0, 1, 16]],
        '├' => vec![[4, 8, 4, 1], [4, 0, 1, 16]],
        '┤' => vec![[0, 8, 4, 1], [4, 0, 1, 16]],
        '┬' => vec![[0, 8, 8, 1], [4, 8, 1, 8]],
        '┴' => vec![[0, 8, 8, 1], [4, 0, 1, 8]],
        '▏' => vec![[0, 0, 1, 16]],
        '▕' => vec![[7, 0, 1, 16]],
        _ => OCTANTS
            .iter()
            .position(|octant| *octant == symbol)
            .map_or(Vec::new(), |bits| {
                (0..8)
                    .filter(|dot| bits >> dot & 1 == 1)
                    .map(|dot| [4 * (dot % 2), 4 * (dot / 2), 4, 4])
                    .collect()
            }),
    }
}

/// Returns the dots of the Braille pattern with these `bits`.
fn braille(bits: u32) -> Vec<[u32; 4]> {
    (0..8)
        .filter(|dot| bits >> dot & 1 == 1)
        .map(|dot| {
            let [column, row] = if dot < 6 {
                [dot / 3, dot % 3]
            } else {
                [dot - 6, 3]
            };
            [4 * column + 1, 4 * row + 1, 2, 2]
        })
        .collect()
}

/// Returns the color of a cell, #rrggbb; `otherwise` if the cell has the terminal's own color.
fn hex(color: Color, otherwise: &str) -> String {
    match color {
        Color::Rgb(r, g, b) => format!("#{r:02x}{g:02x}{b:02x}"),
        _ => otherwise.to_owned(),
    }
}
