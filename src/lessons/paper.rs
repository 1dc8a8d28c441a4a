//! A handout as sheets of A4: its Markdown set in lines, its pictures drawn cell by cell.

use super::markdown::paragraphs;
use crate::lab::sheet::{Emphasis, Paragraph, SheetLineKind};
use crate::plot::ink::{self, BLACK, circle};
use crate::plot::letters::escape;
use crate::plot::scene::at;
use crate::plot::{PageScene, Point, Unwritable, VectorPath, format};

/// A4, pt.
const SHEET_PT: (f64, f64) = (595.28, 841.89);
const MARGIN_PT: f64 = 51.0;
const TEXT_PT: f64 = 10.5;
/// From line to line, in sizes of the letters.
const LEADING: f64 = 1.36;
const INDENT_PT: f64 = 15.0;
/// A cell of a picture: 80 of them fit between the margins.
const CELL_PT: (f64, f64) = (6.0, 12.0);
const CODE_PT: f64 = 9.0;
/// A heading is followed by this much text on its sheet, or by a whole picture; so is what stands above a list.
const BELOW_HEADING_PT: f64 = 90.0;

/// Returns the PDF of a handout's `markdown`; its first heading is the title.
///
/// # Errors
/// When there is more text than a page's numbers can place.
pub fn pdf(markdown: &str) -> Result<Vec<u8>, Unwritable> {
    let paragraphs = paragraphs(markdown, &SheetLineKind::Text);
    let title = paragraphs.first().map_or(String::new(), Paragraph::text);
    let mut sheets = Sheets::new(&title);
    for (index, paragraph) in paragraphs.iter().enumerate() {
        sheets.put(paragraph, paragraphs.get(index + 1));
    }
    let count = sheets.done.len();
    for (index, sheet) in sheets.done.iter_mut().enumerate() {
        let foot = format!("{} · {} of {count}", escape(&title), index + 1);
        let place = at(SHEET_PT.0 / 2.0, SHEET_PT.1 - MARGIN_PT / 2.0);
        sheet.write(&foot, ink::LABEL_PT, place, 0.5);
    }
    format::write_sheets(&sheets.done)
}

struct Sheets {
    title: String,
    done: Vec<PageScene>,
    /// The lower edge of what stands on the last sheet, pt.
    y: f64,
}

impl Sheets {
    fn new(title: &str) -> Self {
        let mut sheets = Self {
            title: title.to_owned(),
            done: Vec::new(),
            y: 0.0,
        };
        sheets.turn();
        sheets
    }

    fn turn(&mut self) {
        let (width, height) = SHEET_PT;
        self.done.push(PageScene::new(width, height, &self.title));
        self.y = MARGIN_PT;
    }

    /// Begins a new sheet where `height_pt` does not fit on the last one any more.
    fn turn_unless(&mut self, height_pt: f64) {
        if self.y + height_pt > SHEET_PT.1 - MARGIN_PT && self.y > MARGIN_PT {
            self.turn();
        }
    }

    /// Room for a line: its sheet, and its upper edge.
    fn line(&mut self, height_pt: f64) -> (&mut PageScene, f64) {
        self.turn_unless(height_pt);
        let top = self.y;
        self.y += height_pt;
        let last = self.done.len() - 1;
        (&mut self.done[last], top)
    }

    fn put(&mut self, paragraph: &Paragraph, next: Option<&Paragraph>) {
        let is_first = self.y <= MARGIN_PT && self.done.len() == 1;
        if !is_item(paragraph) && next.is_some_and(is_item) {
            self.turn_unless(BELOW_HEADING_PT);
        }
        match &paragraph.kind {
            SheetLineKind::Code => {
                self.turn_unless(code_height_pt(paragraph));
                self.put_code(&paragraph.text());
            }
            SheetLineKind::Heading => {
                let size = if is_first { 18.0 } else { 13.0 };
                self.turn_unless(BELOW_HEADING_PT + next.map_or(0.0, code_height_pt));
                self.y += size * 0.5;
                self.put_lines(paragraph, size, 0.0, "");
            }
            SheetLineKind::Item { mark, depth } => {
                self.put_lines(paragraph, TEXT_PT, f64::from(*depth) * INDENT_PT, mark);
            }
            _ => self.put_lines(paragraph, TEXT_PT, 0.0, ""),
        }
        if !(is_item(paragraph) && next.is_some_and(is_item)) {
            self.y += TEXT_PT * 0.6;
        }
    }

    /// The words of a paragraph in lines; `mark` stands before the first, and a box to be ticked where the words begin with
    /// `[ ]`.
    fn put_lines(&mut self, paragraph: &Paragraph, size: f64, indent: f64, mark: &str) {
        let all = words(paragraph);
        let is_box = all.len() > 2 && all[0] == "[" && all[1] == "]";
        let words = &all[if is_box { 2 } else { 0 }..];
        let left = MARGIN_PT + indent;
        let lines = lines(words, size, SHEET_PT.0 - MARGIN_PT - left);
        for (index, line) in lines.iter().enumerate() {
            let (sheet, top) = self.line(size * LEADING);
            let y = top + size;
            sheet.write(line, size, at(left, y), 0.0);
            if index == 0 && is_box {
                let corner = at(left - INDENT_PT * 0.8, y - size * 0.7);
                let outline = rectangle(corner, (size * 0.75, size * 0.75));
                sheet.stroke(outline, ink::pen(0.6, BLACK), None);
            } else if index == 0 {
                sheet.write(&escape(mark), size, at(left - INDENT_PT * 0.8, y), 0.0);
            }
        }
    }

    /// Code or a picture, cell by cell.
    fn put_code(&mut self, text: &str) {
        for line in text.lines() {
            let (sheet, top) = self.line(CELL_PT.1);
            for (column, c) in line.chars().enumerate() {
                put_cell(sheet, c, at(MARGIN_PT + column as f64 * CELL_PT.0, top));
            }
        }
    }
}

fn is_item(paragraph: &Paragraph) -> bool {
    matches!(paragraph.kind, SheetLineKind::Item { .. })
}

/// Returns the words of a paragraph as markup, with the signs that the letters do not have in others.
fn words(paragraph: &Paragraph) -> Vec<String> {
    let mut text = String::new();
    for part in &paragraph.words {
        let slant = ["", "*"][usize::from(part.emphasis == Emphasis::Strong)];
        for (index, word) in part.text.split(' ').enumerate() {
            if index > 0 {
                text.push(' ');
            }
            if !word.is_empty() {
                text += &format!("{slant}{}{slant}", escape(&word.replace('═', "=")));
            }
        }
    }
    let marked = text.replace('ᵀ', "^{T}");
    marked.split_whitespace().map(str::to_owned).collect()
}

/// Returns the room that code takes, at most half a sheet: what is longer goes on on the next; 0 for other paragraphs.
fn code_height_pt(paragraph: &Paragraph) -> f64 {
    let lines = match paragraph.kind {
        SheetLineKind::Code => paragraph.text().lines().count(),
        _ => 0,
    };
    (lines as f64 * CELL_PT.1).min(SHEET_PT.1 / 2.0)
}

/// `words` in lines that are at most `width_pt` wide, but for a word that is wider itself.
fn lines(words: &[String], size: f64, width_pt: f64) -> Vec<String> {
    let mut lines: Vec<String> = Vec::new();
    for word in words {
        match lines.last_mut() {
            Some(line) if ink::width(&format!("{line} {word}"), size) <= width_pt => {
                line.push(' ');
                line.push_str(word);
            }
            _ => lines.push(word.clone()),
        }
    }
    lines
}

fn rectangle(corner: Point, (width, height): (f64, f64)) -> VectorPath {
    let corners = [(0.0, 0.0), (width, 0.0), (width, height), (0.0, height)];
    VectorPath::polygon(corners.map(|(x, y)| at(corner.x + x, corner.y + y)))
}

/// Draws `c` in the cell whose upper left corner is `corner`: dots of Braille, lines and blocks as such, and else a letter.
fn put_cell(sheet: &mut PageScene, c: char, corner: Point) {
    let (width, height) = CELL_PT;
    let to = |x: f64, y: f64| at(corner.x + x * width, corner.y + y * height);
    let polygon =
        |corners: &[(f64, f64)]| VectorPath::polygon(corners.iter().map(|&(x, y)| to(x, y)));
    match c {
        ' ' => {}
        '\u{2800}'..='\u{28ff}' => {
            for dot in (0..8).filter(|dot| u32::from(c) >> dot & 1 == 1) {
                let (column, line) = if dot < 6 {
                    (dot / 3, dot % 3)
                } else {
                    (dot - 6, 3)
                };
                let middle = to(
                    0.25 + 0.5 * f64::from(column),
                    0.125 + 0.25 * f64::from(line),
                );
                sheet.fill(circle(middle, 0.9), BLACK);
            }
        }
        '█' => sheet.fill(rectangle(corner, CELL_PT), BLACK),
        '▀' => sheet.fill(rectangle(corner, (width, height / 2.0)), BLACK),
        '■' => sheet.fill(rectangle(to(0.1, 0.3), (0.8 * width, 0.8 * width)), BLACK),
        '▲' => sheet.fill(polygon(&[(0.5, 0.3), (1.0, 0.75), (0.0, 0.75)]), BLACK),
        '▼' => sheet.fill(polygon(&[(0.5, 0.75), (1.0, 0.3), (0.0, 0.3)]), BLACK),
        '►' => sheet.fill(polygon(&[(0.0, 0.3), (1.0, 0.5), (0.0, 0.7)]), BLACK),
        '◄' => sheet.fill(polygon(&[(1.0, 0.3), (0.0, 0.5), (1.0, 0.7)]), BLACK),
        _ => match arms(c) {
            Some((ends, width_pt)) => {
                for &(x, y) in ends {
                    sheet.line([to(0.5, 0.5), to(x, y)], width_pt, BLACK);
                }
            }
            None => sheet.write(&escape(&c.to_string()), CODE_PT, to(0.5, 0.75), 0.5),
        },
    }
}

/// Returns where the lines of a character that draws boxes end, in cells, and how wide they are, pt.
fn arms(c: char) -> Option<(&'static [(f64, f64)], f64)> {
    const LEFT: (f64, f64) = (0.0, 0.5);
    const RIGHT: (f64, f64) = (1.0, 0.5);
    const UP: (f64, f64) = (0.5, 0.0);
    const DOWN_STROKE: (f64, f64) = (0.5, 1.0);
    let ends: &[_] = match c {
        '─' | '╌' => &[LEFT, RIGHT],
        '╴' => &[LEFT],
        '═' | '━' => return Some((&[LEFT, RIGHT], 1.5)),
        '│' | '▏' | '▕' => &[UP, DOWN_STROKE],
        '┃' => return Some((&[UP, DOWN_STROKE], 1.5)),
        '┴' => &[LEFT, RIGHT, UP],
        '┌' => &[RIGHT, DOWN_STROKE],
        '┐' => &[LEFT, DOWN_STROKE],
        '└' => &[RIGHT, UP],
        '┘' => &[LEFT, UP],
        '├' => &[UP, DOWN_STROKE, RIGHT],
        '┤' => &[UP, DOWN_STROKE, LEFT],
        _ => return None,
    };
    Some((ends, 0.5))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sheets(markdown: &str) -> usize {
        let pdf = pdf(markdown).unwrap();
        let page = b"/Type /Page\n";
        pdf.windows(page.len())
            .filter(|bytes| bytes == page)
            .count()
    }

    #[test]
    fn words_stand_as_close_as_they_are_written() {
        let read = paragraphs(
            "`steps = 10`, and **two words**: r rᵀ ═",
            &SheetLineKind::Text,
        );
        let expected = "steps = 10, and *two* *words*: r r^{T} =";
        assert_eq!(words(&read[0]).join(" "), expected);
    }

    #[test]
    fn what_does_not_fit_goes_on_on_the_next_sheet() {
        let lines = |count| "```text\n│⢰ p\n".to_owned() + &"x\n".repeat(count) + "```\n\n";
        assert_eq!(sheets("# A\n\n- [ ] `b` **c**\n"), 1);
        assert_eq!(sheets(&format!("# A\n\n{}", lines(200))), 4);
        // Text of 20 lines leaves no room for a heading and its picture, which stay together.
        let text = "word\n\n".repeat(20);
        assert_eq!(sheets(&format!("{text}## B\n\n{}", lines(24))), 2);
        assert_eq!(sheets(&format!("{text}{}", lines(24))), 1);
    }
}
