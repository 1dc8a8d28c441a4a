//! The help: keys and words of the glossary, searched by typing. Enter carries out the selected key. Keys are grouped
//! by purpose.

use super::{SELECTED_MARK, below_rule, carry_out, popup_rule, rows, write};
use crate::engine::text::wrap::{columns, wrapped};
use crate::lab::action::Action;
use crate::lab::values::list::Match;
use crate::lab::view::Pane;
use crate::lab::{Lab, LabRequest, Mode};
use crate::tui::keymap::{BINDINGS, Binding, KeyEffect, PURPOSES};
use crate::tui::theme::Role;
use ratatui::buffer::Buffer;
use ratatui::layout::{Position, Rect};

/// Column of keys and words.
const NAMES_COLUMN: usize = 2;
/// Columns between them and their texts.
const COLUMN_GAP: usize = 2;
/// Minimum width of the column of texts. If a text has less room, it is written below its key.
const LEAST_TEXT: usize = 40;

fn selected(lab: &Lab) -> Option<HelpEntry> {
    let found = find_entries(&lab.popups().help.text);
    found.get(lab.popups().help.selected).copied()
}

/// Keeps the selection of the help among the matching entries.
pub fn limit(lab: &mut Lab) {
    if lab.popups().mode == Mode::Help {
        let entries = find_entries(&lab.popups().help.text).len();
        lab.popups_mut().help.limit(entries);
    }
}

/// Closes the help and carries out the selected key.
///
/// For a key of a pane, it moves the focus to that pane first. If the entry has no effect here, a message says why.
pub fn do_entry(lab: &mut Lab) -> Option<LabRequest> {
    let Some(entry) = selected(lab) else {
        lab.refuse("nothing is selected; press Esc to clear the search");
        return None;
    };
    let Some(binding) = entry.binding else {
        lab.refuse("this entry only explains a word; press Esc to close");
        return None;
    };
    if !binding.modes.contains(&lab.popups().under_help) {
        lab.refuse(format!("this key works elsewhere: {}", entry.group));
        return None;
    }
    while lab.popups().mode == Mode::Help {
        lab.update(Action::Help);
    }
    if let Some(pane) = entry.pane
        && (pane != Pane::Lesson || lab.view().sheet.is_some())
    {
        lab.turn_to(pane);
    }
    match binding.does {
        KeyEffect::Action(Action::Help) => None,
        does => carry_out(does, lab),
    }
}

pub fn draw(lab: &Lab, area: Rect, buf: &mut Buffer) {
    let theme = &lab.view().theme;
    let search = lab.popups().help.text.as_str();
    let found = find_entries(search);
    let title = match search {
        "" => "help: type to search, Enter: do it".to_owned(),
        search => format!("help: {search}_ ({})", found.len()),
    };
    let inside = popup_rule(&title, area, theme, buf);
    if found.is_empty() {
        let text = "no entry found; press Esc to clear the search";
        write(inside, (1, 0), text, theme.style(Role::Text), buf);
    }
    let selected = selected_of(&found, lab);
    let (lines, first) = shown_lines(&found, lab, inside);
    for (line, place) in lines.iter().skip(first).zip(inside.rows()) {
        for (x, text, role) in &line.pieces {
            write(place, (*x as u16, 0), text, theme.style(*role), buf);
        }
        if line.entry == Some(selected) {
            buf.set_style(place, theme.style(Role::Selected));
            if line.is_first {
                write(
                    place,
                    (0, 0),
                    SELECTED_MARK,
                    theme.style(Role::Heading),
                    buf,
                );
            }
        }
    }
}

fn selected_of(found: &[HelpEntry], lab: &Lab) -> usize {
    let selected = lab.popups().help.selected;
    selected.min(found.len().saturating_sub(1))
}

/// Returns the lines of the entries `found`, and the number of the first visible line on `inside`.
fn shown_lines(found: &[HelpEntry], lab: &Lab, inside: Rect) -> (Vec<HelpLine>, usize) {
    let is_grouped = lab.popups().help.text.is_empty();
    let lines = help_lines(found, is_grouped, inside.width as usize);
    let first = first_shown(&lines, selected_of(found, lab), inside.height as usize);
    (lines, first)
}

/// Returns the number of the entry at the cell `at` of the screen if the help is drawn on `area`.
pub fn row_at(lab: &Lab, area: Rect, at: Position) -> Option<usize> {
    let inside = below_rule(area);
    if !inside.contains(at) {
        return None;
    }
    let found = find_entries(&lab.popups().help.text);
    let (lines, first) = shown_lines(&found, lab, inside);
    lines.get(first + usize::from(at.y - inside.y))?.entry
}

/// A line of the screen: texts, each with its first column.
struct HelpLine {
    /// Number of the entry; `None` for a heading.
    entry: Option<usize>,
    /// True for the first line of an entry.
    is_first: bool,
    pieces: Vec<(usize, String, Role)>,
}

/// Returns the first of `lines` to show on `height` lines.
///
/// The entry `selected` is in the middle if possible, and its first line is always visible.
fn first_shown(lines: &[HelpLine], selected: usize, height: usize) -> usize {
    let mut entries = lines.iter().map(|line| line.entry);
    let length = entries
        .clone()
        .filter(|entry| *entry == Some(selected))
        .count();
    let begin = entries
        .position(|entry| entry == Some(selected))
        .unwrap_or(0);
    let above = height.saturating_sub(length) / 2;
    let most = lines.len().saturating_sub(height);
    begin.saturating_sub(above).min(most)
}

/// Returns the lines of `entries` on `width` columns, under the headings of their groups if `grouped` is true.
fn help_lines(entries: &[HelpEntry], grouped: bool, width: usize) -> Vec<HelpLine> {
    let longest = entries.iter().map(|entry| columns(&entry.name())).max();
    let column = NAMES_COLUMN + longest.unwrap_or(0) + COLUMN_GAP;
    let column = Some(column).filter(|column| width >= column + LEAST_TEXT);
    let mut lines = Vec::new();
    for (index, entry) in entries.iter().enumerate() {
        let is_new = index == 0 || entries[index - 1].group != entry.group;
        if grouped && is_new {
            lines.extend(heading(entry, width));
        }
        let of_entry = match column {
            Some(column) => beside(entry, &text_of(entry, grouped), column, width),
            None => below(entry, &text_of(entry, grouped), width),
        };
        lines.extend(
            of_entry
                .into_iter()
                .enumerate()
                .map(|(at, pieces)| HelpLine {
                    entry: Some(index),
                    is_first: at == 0,
                    pieces,
                }),
        );
    }
    lines
}

fn heading(entry: &HelpEntry, width: usize) -> Vec<HelpLine> {
    let text = match entry.pane {
        Some(_) => format!("{}: keys of this pane; Tab goes to it", entry.group),
        None => entry.group.to_owned(),
    };
    let lines = wrapped(&text, width.saturating_sub(1)).into_iter();
    lines
        .map(|line| HelpLine {
            entry: None,
            is_first: false,
            pieces: vec![(1, line, Role::Heading)],
        })
        .collect()
}

type HelpPieces = Vec<(usize, String, Role)>;

/// Returns the text of `entry`. For a key of a pane it names the pane, unless a heading does.
fn text_of(entry: &HelpEntry, grouped: bool) -> String {
    match entry.pane {
        Some(_) if !grouped => format!("{} ({})", entry.text, entry.group),
        _ => entry.text.to_owned(),
    }
}

/// Returns the name of `entry`, with its `text` in lines that begin in `column`.
fn beside(entry: &HelpEntry, text: &str, column: usize, width: usize) -> Vec<HelpPieces> {
    let text = wrapped(text, width.saturating_sub(column))
        .into_iter()
        .map(|text| vec![(column, text, Role::Text)]);
    let mut lines: Vec<HelpPieces> = text.collect();
    if let Some(first) = lines.first_mut() {
        first.push((NAMES_COLUMN, entry.name(), Role::Heading));
    }
    lines
}

/// Returns the name of `entry`, with its `text` below it.
fn below(entry: &HelpEntry, text: &str, width: usize) -> Vec<HelpPieces> {
    const HELP_INDENT: usize = NAMES_COLUMN + COLUMN_GAP - 1;
    let text = wrapped(text, width.saturating_sub(HELP_INDENT))
        .into_iter()
        .map(|text| vec![(HELP_INDENT, text, Role::Text)]);
    let name = vec![(NAMES_COLUMN, entry.name(), Role::Heading)];
    std::iter::once(name).chain(text).collect()
}

/// The words of the lab, each explained in one sentence: words of the motion first, then of the numbers and of the
/// screen.
const GLOSSARY: &str = include_str!("help/glossary.txt");

/// Help on a key (or on several keys with the same effect), or on a word of the glossary.
#[derive(Clone, Copy, Debug)]
pub struct HelpEntry {
    /// Heading of the group.
    pub group: &'static str,
    /// Pane of the key; `None` for a key of every pane, and for a word.
    pub pane: Option<Pane>,
    /// Key; `None` for a word.
    pub binding: Option<&'static Binding>,
    /// The word, or the key's text in the footer.
    short: &'static str,
    /// Effect of the key, or meaning of the word.
    pub text: &'static str,
}

/// Groups of the keys of other modes, in order.
const PLACES: [(Mode, &str); 5] = [
    (
        Mode::Browser,
        "in lists: presets and files, lessons, help, settings",
    ),
    (Mode::Lessons, "in the list of lessons"),
    (Mode::Find, "while searching for a value"),
    (Mode::Help, "in this list"),
    (Mode::Dialog, "in a dialog"),
];
const WORDS_HEADING: &str = "words";

impl HelpEntry {
    pub fn name(&self) -> String {
        self.binding.map_or(self.short.to_owned(), |binding| {
            let keys: Vec<_> = binding.keys.iter().map(ToString::to_string).collect();
            keys.join(" ")
        })
    }

    /// Returns how well the entry matches `search` (`lower` in lower case): 0 is the best match, `None` no match.
    fn answers(&self, search: &str, lower: &str) -> Option<u8> {
        let keys = self.binding.map_or(&[][..], |binding| binding.keys);
        let is_key =
            |wanted: &dyn Fn(String) -> bool| keys.iter().any(|key| wanted(key.to_string()));
        if is_key(&|key| key == search) {
            return Some(0);
        }
        let short = self.short.to_lowercase();
        if short == lower || is_key(&|key| key.to_lowercase() == lower) {
            return Some(1);
        }
        if short.starts_with(lower) {
            return Some(2);
        }
        let further = self.binding.map_or("", |binding| binding.search);
        let all = format!("{} {short} {} {further}", self.name(), self.text);
        match Match::find(&all, lower) {
            Some(Match::Word) => Some(3),
            Some(Match::Part) => Some(4),
            None => Match::find(&format!("{all} {}", self.group), lower).map(|_| 5),
        }
    }
}

/// Returns the words that the lab uses, each with its meaning.
pub fn glossary() -> impl Iterator<Item = (&'static str, &'static str)> {
    let lines = GLOSSARY.lines();
    lines.filter_map(|line| line.split_once(" = "))
}

pub fn entries() -> Vec<HelpEntry> {
    let of_mode = |(mode, group)| {
        let rows = BINDINGS
            .iter()
            .filter(move |row| row.modes[0] == mode)
            .filter(move |row| mode != Mode::Lab || row.purpose == group);
        rows.map(move |row| key(group, None, row))
    };
    let of_lab = PURPOSES.map(|group| (Mode::Lab, group)).into_iter();
    let of_pane = rows().flat_map(|pane| {
        let rows = pane.keys.iter();
        rows.map(|row| key(pane.title, Some(pane.id), row))
    });
    let words = glossary().map(|(word, meaning)| HelpEntry {
        group: WORDS_HEADING,
        pane: None,
        binding: None,
        short: word,
        text: meaning,
    });
    let keys = of_lab.flat_map(of_mode).chain(of_pane);
    keys.chain(words)
        .chain(PLACES.into_iter().flat_map(of_mode))
        .collect()
}

/// Returns the entries that match `search`, best match first. If it is empty, returns all entries, group by group.
pub fn find_entries(search: &str) -> Vec<HelpEntry> {
    let (search, mut found) = (search.trim(), entries());
    if search.is_empty() {
        return found;
    }
    let lower = search.to_lowercase();
    found.retain(|entry| entry.answers(search, &lower).is_some());
    found.sort_by_key(|entry| entry.answers(search, &lower)); // stable: equal matches stay in the order of the groups
    found
}

fn key(group: &'static str, pane: Option<Pane>, binding: &'static Binding) -> HelpEntry {
    HelpEntry {
        group,
        pane,
        binding: Some(binding),
        short: binding.footer,
        text: binding.help,
    }
}
