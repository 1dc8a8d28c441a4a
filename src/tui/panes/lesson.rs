//! The page of a lesson next to the run: its text, the question with its answers, the goals, and the keys.

use super::{PaneRow, below_rule, longest, rule, shortened, write};
use crate::engine::text::wrap::{columns, wrapped};
use crate::lab::Lab;
use crate::lab::action::Direction;
use crate::lab::sheet::{Emphasis, Paragraph, Sheet, SheetLineKind};
use crate::lab::view::theme::Marker;
use crate::lab::view::theme::Theme;
use crate::lab::view::{Pane, View};
use crate::tui::keymap;
use crate::tui::theme::Role;
use ratatui::buffer::Buffer;
use ratatui::layout::{Position, Rect};
use ratatui::style::{Modifier, Style};
use std::iter::Peekable;

pub const LESSON_ROW: PaneRow = PaneRow {
    id: Pane::Lesson,
    title: "lesson",
    draw,
    keys: keymap::LESSON_KEYS,
    arrows: None,
};

/// Columns before the words of an answer.
const CHOICE_INDENT: u16 = 4;
/// Columns before the words of a list entry.
const LIST_INDENT: u16 = 2;
/// Placeholder for a blank that must not be broken.
const KEPT_BLANK: char = '\u{e000}';
/// Units of numbers in the texts of lessons.
const UNITS: [&str; 16] = [
    "m", "mm", "m/s", "m²", "s", "ms", "N", "kg", "J", "rad/s", "rad", "°", "degrees", "degree",
    "%", "times",
];

/// A line of the page: its first column, and its pieces of text.
#[derive(Default)]
struct LessonLine {
    /// Number of its paragraph; `None` for an empty line between two.
    paragraph: Option<usize>,
    x: u16,
    pieces: Vec<(String, Style)>,
    /// Mark at its end.
    mark: &'static str,
    /// True for the selected answer or entry, which is reversed over the whole width.
    is_selected: bool,
}

fn draw(lab: &Lab, area: Rect, buf: &mut Buffer) {
    let view = lab.view();
    let Some(sheet) = &view.sheet else {
        return;
    };
    let page = ScrolledPage::new(sheet, below_rule(area), view);
    // On a page without a free row, the rule has the status of the class in its shortest form.
    let class_words = match sheet.border.lines().last() {
        Some(shortest) if page.is_full => shortest,
        _ => "",
    };
    let framed_room = area.width.saturating_sub(columns(class_words) as u16 + 5);
    let framed = longest(sheet.framed.lines().map(str::to_owned), framed_room.into());
    let (title, place) = match framed.as_str() {
        "" => (&sheet.title, sheet.place.as_str()),
        _ => (&framed, class_words),
    };
    // The page number has priority over a long title.
    let room = area.width.saturating_sub(columns(place) as u16 + 5);
    let title = shortened(title, room.into());
    let right = Some((place, Role::Label)).filter(|_| !place.is_empty());
    let is_marked = view.marks_focus_of(LESSON_ROW.id);
    let inside = rule(&title, right, is_marked, area, &view.theme, buf);
    if inside.is_empty() {
        return;
    }
    for (line, row) in page.shown().zip(inside.rows()) {
        draw_line(line, row, &view.theme, buf);
    }
    let quiet = view.theme.style(Role::Label);
    let below = page.has_more();
    let has_focus = view.focus == LESSON_ROW.id;
    let more = match (page.first > 0, below, has_focus) {
        (_, true, true) => " PgDn: more ",
        (true, false, true) => " PgUp: back ",
        (_, true, false) => " Tab, PgDn: more ",
        (_, false, _) => "",
    };
    let border = Rect {
        y: area.bottom() - 1,
        height: 1,
        ..inside
    };
    if !page.is_full {
        write_border(&sheet.border, more, border, quiet, buf);
    }
}

fn draw_line(line: &LessonLine, row: Rect, theme: &Theme, buf: &mut Buffer) {
    let mut x = line.x;
    for (text, style) in &line.pieces {
        x = write(row, (x, 0), text, *style, buf);
    }
    let at = row.width.saturating_sub(columns(line.mark) as u16);
    if !line.mark.is_empty() && at > x {
        write(row, (at, 0), line.mark, theme.style(Role::Heading), buf);
    }
    if line.is_selected {
        buf.set_style(row, theme.style(Role::Selected));
    }
}

/// Writes the status of the class, and `more` if both fit.
fn write_border(status: &str, more: &str, border: Rect, style: Style, buf: &mut Buffer) {
    let room = border.width.saturating_sub(columns(more) as u16 + 1);
    let status = longest(status.lines().map(|form| format!(" {form} ")), room.into());
    write(border, (0, 0), &status, style, buf);
    if columns(&status) <= room.into() && !more.is_empty() {
        write(border, (room, 0), more, style, buf);
    }
}

/// Scrolls the sheet of `lab`, whose pane has the area `place`.
pub fn scroll(lab: &mut Lab, direction: Direction, place: Rect) {
    let Some(sheet) = lab.view().sheet.clone() else {
        return;
    };
    let page = ScrolledPage::new(&sheet, below_rule(place), lab.view());
    let (first, shown, all) = (page.first, page.height, page.lines.len());
    let page_rows = shown.saturating_sub(1).max(1) as isize;
    lab.view_mut()
        .scroll_sheet(direction.rows(page_rows), first, shown, all);
}

/// Returns true if the page of `lab`, whose pane has the area `place`, continues below the visible lines.
pub fn has_more(lab: &Lab, place: Rect) -> bool {
    let sheet = lab.view().sheet.as_ref();
    sheet.is_some_and(|sheet| ScrolledPage::new(sheet, below_rule(place), lab.view()).has_more())
}

/// Returns the number of the answer or list entry at the cell `at` of the screen, if the page of `lab` has the area
/// `place`.
pub fn choice_at(lab: &Lab, place: Rect, at: Position) -> Option<usize> {
    let (sheet, inside) = (lab.view().sheet.as_ref()?, below_rule(place));
    if !inside.contains(at) {
        return None;
    }
    let page = ScrolledPage::new(sheet, inside, lab.view());
    let line = page.shown().nth(usize::from(at.y - inside.y))?;
    let paragraph = line.paragraph?;
    let choices = sheet.paragraphs.iter().take(paragraph + 1);
    let up_to_here = choices.filter(|other| matches!(other.kind, SheetLineKind::Choice { .. }));
    let is_choice = matches!(
        sheet.paragraphs.get(paragraph)?.kind,
        SheetLineKind::Choice { .. }
    );
    is_choice.then(|| up_to_here.count() - 1)
}

/// A page in lines, scrolled.
struct ScrolledPage {
    lines: Vec<LessonLine>,
    first: usize,
    /// Number of visible lines. The last row stays free for the status of the class and, on a longer page, for its
    /// keys.
    height: usize,
    /// True if the page needs every row.
    is_full: bool,
}

impl ScrolledPage {
    /// Creates the lines of `sheet` for the area `inside`. They are scrolled as `view` says, or else so that
    /// `sheet.seen` is visible.
    fn new(sheet: &Sheet, inside: Rect, view: &View) -> Self {
        let mut lines: Vec<LessonLine> = Vec::new();
        let mut seen = (0, 0);
        let mut before: Option<&SheetLineKind> = None;
        for (index, paragraph) in sheet.paragraphs.iter().enumerate() {
            if before.is_some_and(|before| are_apart(before, &paragraph.kind)) {
                lines.push(LessonLine::default());
            }
            let begin = lines.len();
            let is_ascii = view.marker == Marker::Ascii;
            let plain = is_ascii.then(|| paragraph.in_ascii());
            let paragraph = plain.as_ref().unwrap_or(paragraph);
            let of_paragraph = lines_of(paragraph, inside.width, &view.theme);
            lines.extend(of_paragraph.into_iter().map(|line| LessonLine {
                paragraph: Some(index),
                ..line
            }));
            before = Some(&sheet.paragraphs[index].kind);
            if sheet.seen.is_some_and(|(first, _)| first == index) {
                seen.0 = begin;
            }
            if sheet.seen.is_some_and(|(_, last)| last == index) {
                seen.1 = lines.len();
            }
        }
        let rows = inside.height as usize;
        let is_full = lines.len() == rows;
        let has_last_row = lines.len() > rows || !is_full && !sheet.border.is_empty();
        let shown = rows.saturating_sub(usize::from(has_last_row));
        let last = lines.len().saturating_sub(shown);
        let usual = seen.1.saturating_sub(shown).min(seen.0);
        let first = view.sheet_scrolled.unwrap_or(usual).min(last);
        Self {
            lines,
            first,
            height: shown,
            is_full,
        }
    }

    fn shown(&self) -> impl Iterator<Item = &LessonLine> {
        self.lines.iter().skip(self.first).take(self.height)
    }

    fn has_more(&self) -> bool {
        self.lines.len() > self.first + self.height
    }
}

/// Returns true if an empty line separates the two paragraphs.
fn are_apart(before: &SheetLineKind, after: &SheetLineKind) -> bool {
    fn is_list(kind: &SheetLineKind) -> bool {
        matches!(
            kind,
            SheetLineKind::Item { .. } | SheetLineKind::Choice { .. }
        )
    }
    match (before, after) {
        (SheetLineKind::Goal { .. }, SheetLineKind::Goal { .. })
        | (SheetLineKind::Caption, _)
        | (SheetLineKind::Said, SheetLineKind::Result)
        | (SheetLineKind::Question, SheetLineKind::Choice { .. }) => false,
        _ => !is_list(before) || !is_list(after),
    }
}

/// Returns the mark before a paragraph's first line, its indent in columns, and the role of its words.
fn paragraph_style(kind: &SheetLineKind) -> (String, u16, Role) {
    fn plain(mark: &str, role: Role) -> (String, u16, Role) {
        (mark.to_owned(), 0, role)
    }
    match kind {
        SheetLineKind::Heading | SheetLineKind::Caption => plain("", Role::Heading),
        SheetLineKind::Text | SheetLineKind::Question | SheetLineKind::Said => {
            plain("", Role::Text)
        }
        SheetLineKind::Item { mark, depth } => {
            (format!("{mark} "), 2 * depth.saturating_sub(1), Role::Text)
        }
        SheetLineKind::Code => (String::new(), 2, Role::Text),
        SheetLineKind::Choice { mark, .. } => {
            let role = match *mark {
                "" => Role::Text,
                _ => Role::Heading,
            };
            (String::new(), CHOICE_INDENT, role)
        }
        SheetLineKind::Result => plain("", Role::Heading),
        SheetLineKind::Goal { is_reached: true } => plain("[x] ", Role::Text),
        SheetLineKind::Goal { is_reached: false } => plain("[ ] ", Role::Text),
        SheetLineKind::Hint => plain("", Role::Label),
        SheetLineKind::Note => plain("| ", Role::Text),
    }
}

fn lines_of(paragraph: &Paragraph, width: u16, theme: &Theme) -> Vec<LessonLine> {
    let (lead, indent, role) = paragraph_style(&paragraph.kind);
    let style = theme.style(role);
    let hanging = indent + columns(&lead) as u16;
    let room = width.saturating_sub(hanging).max(1) as usize;
    let text = paragraph.text();
    let texts: Vec<String> = match paragraph.kind {
        SheetLineKind::Code => text
            .lines()
            .flat_map(|line| code_lines(line, room))
            .collect(),
        _ => wrapped_with_units(&text, room),
    };
    let mut letters = letters_of(paragraph).peekable();
    let mut lines = Vec::with_capacity(texts.len());
    for (index, line) in texts.iter().enumerate() {
        let mut pieces = styled_pieces(line, &mut letters, style, theme);
        let is_marked = index == 0 || paragraph.kind == SheetLineKind::Note;
        if is_marked && !lead.is_empty() {
            pieces.insert(0, (lead.clone(), style));
        }
        lines.push(LessonLine {
            x: if is_marked { indent } else { hanging },
            pieces,
            ..LessonLine::default()
        });
    }
    if let SheetLineKind::Choice {
        number,
        is_selected,
        mark,
    } = paragraph.kind
    {
        as_choice(&mut lines, number, is_selected, mark, theme);
    }
    lines
}

/// Turns `lines` into an answer or a list entry.
fn as_choice(
    lines: &mut [LessonLine],
    number: Option<usize>,
    is_selected: bool,
    mark: &'static str,
    theme: &Theme,
) {
    for line in lines.iter_mut() {
        line.is_selected = is_selected;
        if number.is_none() {
            line.x = LIST_INDENT;
        }
    }
    if let Some(last) = lines.last_mut() {
        last.mark = mark;
    }
    let Some(first) = lines.first_mut() else {
        return;
    };
    let style = theme.style(Role::Heading);
    match number {
        Some(number) => {
            let label = format!("{number:<width$}", width = usize::from(CHOICE_INDENT) - 1);
            first.x = 1;
            first.pieces.insert(0, (label, style));
        }
        None if is_selected => {
            first.x = 0;
            first.pieces.insert(0, ("> ".to_owned(), style));
        }
        None => {}
    }
}

/// Wraps `text` like [`wrapped`], but never between a number and its unit.
fn wrapped_with_units(text: &str, room: usize) -> Vec<String> {
    let words: Vec<&str> = text.split_whitespace().collect();
    let mut joined = String::with_capacity(text.len());
    let mut follows_number = false;
    for (index, word) in words.iter().enumerate() {
        let is_unit = UNITS.contains(&word.trim_end_matches(['.', ',', ';', ':', ')', '?']));
        let is_kept = follows_number && is_unit;
        match index {
            0 => {}
            _ if is_kept => joined.push(KEPT_BLANK),
            _ => joined.push(' '),
        }
        joined += word;
        // In J s, the unit of L, the second follows the joule.
        let is_number = word.ends_with(|letter: char| letter.is_ascii_digit());
        follows_number = is_number || is_kept && *word == "J";
    }
    let lines = wrapped(&joined, room).into_iter();
    lines.map(|line| line.replace(KEPT_BLANK, " ")).collect()
}

/// Returns `text` in pieces of uniform style. Its letters are the next ones of `letters`, except for blanks between
/// words.
fn styled_pieces(
    text: &str,
    letters: &mut Peekable<impl Iterator<Item = (char, Emphasis)>>,
    style: Style,
    theme: &Theme,
) -> Vec<(String, Style)> {
    let mut pieces: Vec<(String, Style)> = Vec::new();
    for letter in text.chars() {
        while letters
            .next_if(|(other, _)| *other != letter && other.is_whitespace())
            .is_some()
        {}
        let emphasis = match letter {
            ' ' => letters.peek().map(|(_, emphasis)| *emphasis),
            _ => letters.next().map(|(_, emphasis)| emphasis),
        };
        let patched = style.patch(styled(emphasis.unwrap_or_default(), theme));
        match pieces.last_mut() {
            Some((piece, last)) if *last == patched => piece.push(letter),
            _ => pieces.push((letter.to_string(), patched)),
        }
    }
    pieces
}

/// Returns a line of code unchanged, or wrapped if it is longer than `room`.
fn code_lines(line: &str, room: usize) -> Vec<String> {
    if columns(line) <= room {
        vec![line.to_owned()]
    } else {
        wrapped(line, room)
    }
}

/// Returns the letters of a paragraph with their emphasis.
fn letters_of(paragraph: &Paragraph) -> impl Iterator<Item = (char, Emphasis)> {
    let pieces = paragraph.words.iter();
    pieces.flat_map(|words| words.text.chars().map(|letter| (letter, words.emphasis)))
}

fn styled(emphasis: Emphasis, theme: &Theme) -> Style {
    match emphasis {
        Emphasis::Plain => Style::new(),
        Emphasis::Strong => Style::new().add_modifier(Modifier::BOLD),
        Emphasis::Code => theme.style(Role::Heading),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lab::sheet::StyledText;

    fn texts(paragraph: &Paragraph, width: u16) -> Vec<String> {
        let lines = lines_of(paragraph, width, &Theme::PLAIN);
        lines
            .iter()
            .map(|line| {
                let pieces = line.pieces.iter().map(|(text, _)| text.as_str());
                " ".repeat(line.x as usize) + &pieces.collect::<String>()
            })
            .collect()
    }

    #[test]
    fn paragraphs_have_hanging_indents() {
        let choice = SheetLineKind::Choice {
            number: Some(2),
            is_selected: true,
            mark: "",
        };
        let item = SheetLineKind::Item {
            mark: "-".to_owned(),
            depth: 2,
        };
        let choices = [" 2  is ten", "    times", "    smaller"];
        for (kind, text, width, wanted) in [
            (choice, "is ten times smaller", 11, &choices[..]),
            (item, "one two", 8, &["  - one", "    two"]),
            (SheetLineKind::Code, "a   b\nc", 8, &["  a   b", "  c"]),
        ] {
            assert_eq!(texts(&Paragraph::new(kind, text), width), wanted);
        }
    }

    #[test]
    fn numbers_and_units_stay_together() {
        for (text, room, wanted) in [
            (
                "a push of 100 N for 20 s.",
                13,
                ["a push of", "100 N for", "20 s."],
            ),
            (
                "Take L = 36 J s, at 0.1 s.",
                14,
                ["Take L =", "36 J s, at", "0.1 s."],
            ),
        ] {
            assert_eq!(wrapped_with_units(text, room), wanted);
        }
    }

    #[test]
    fn emphasis_survives_wrapping() {
        let words = |text: &str, emphasis| StyledText {
            text: text.to_owned(),
            emphasis,
        };
        let paragraph = Paragraph {
            kind: SheetLineKind::Text,
            words: vec![
                words("the ", Emphasis::Plain),
                words("fast top", Emphasis::Strong),
                words(" sleeps", Emphasis::Plain),
            ],
        };
        let lines = lines_of(&paragraph, 10, &Theme::PLAIN);
        let pieces: Vec<Vec<(&str, bool)>> = lines
            .iter()
            .map(|line| {
                let pieces = line.pieces.iter();
                pieces
                    .map(|(text, style)| {
                        (text.as_str(), style.add_modifier.contains(Modifier::BOLD))
                    })
                    .collect()
            })
            .collect();
        assert_eq!(
            pieces,
            [
                vec![("the ", false), ("fast", true)],
                vec![("top", true), (" sleeps", false)]
            ]
        );
    }
}
