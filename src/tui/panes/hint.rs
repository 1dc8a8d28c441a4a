//! The note on what to look at, or for a while a message.

use super::chrome::SEPARATOR;
use super::{step, wrapped_to, write};
use crate::engine::text::wrap::{columns, wrapped};
use crate::lab::dialog::Dialog;
use crate::lab::view::Pane;
use crate::lab::{Lab, MOST_COUNTED};
use crate::tui::layout::{FULL_LAB, NOTE_COLUMNS, ScreenLayout};
use crate::tui::theme::Role;
use ratatui::buffer::Buffer;
use ratatui::layout::Rect;
use ratatui::widgets::{Clear, Widget};

/// Text on a screen that is too small for everything.
const CRAMPED: &str = "80x24 shows more";
/// Maximum rows of a message.
const MOST_HINT_LINES: u16 = 4;

/// Returns the rows of the note on a screen of this width while there is no message.
pub fn lines_of_note(lab: &Lab, width: u16) -> u16 {
    lines_of(whole_sentences(&lab.note(), width), width)
}

/// Returns the sentences of `note` that fit on a screen of this width: in one row, or in two or three rows of a narrow
/// screen.
///
/// Returns the whole note if not even the first sentence fits.
fn whole_sentences(note: &str, width: u16) -> &str {
    let most_rows = match width {
        width if width < NOTE_COLUMNS.0 => 3,
        width if width < FULL_LAB.0 => 2,
        _ => 1,
    };
    let ends = note.match_indices(". ").map(|(at, _)| &note[..=at]);
    ends.chain([note])
        .filter(|begin| lines_of(begin, width) <= most_rows)
        .last()
        .unwrap_or(note)
}

fn lines_of(text: &str, width: u16) -> u16 {
    let lines = wrapped(text, width.saturating_sub(2) as usize).len();
    lines.min(u16::MAX.into()) as u16
}

/// Returns the area of the note or message of `lab`.
///
/// A message that needs more lines covers the verdict and the last lines of a pane while it is shown.
pub fn place(lab: &Lab, layout: &ScreenLayout) -> Rect {
    let place = layout.note;
    let needed = if has_message(lab) {
        lines_of(&note_text(lab, place.width).0, place.width)
    } else {
        0
    };
    if needed <= place.height || place.is_empty() {
        return place;
    }
    let own = place.union(layout.verdict).height;
    let most = if lab.view().look.bare {
        place.height + 1
    } else {
        own.max(MOST_HINT_LINES)
    };
    let height = needed
        .min(most)
        .min(place.bottom().saturating_sub(2))
        .max(place.height);
    Rect {
        y: place.bottom() - height,
        height,
        ..place
    }
}

/// Draws the message, or else the note. On a small screen it adds, if there is room, that a larger screen shows more.
pub fn draw(lab: &Lab, is_cramped: bool, area: Rect, buf: &mut Buffer) {
    let (text, role) = note_text(lab, area.width);
    let theme = &lab.view().theme;
    let width = area.width.saturating_sub(2) as usize;
    let lines = if columns(&text) <= width {
        vec![text]
    } else {
        wrapped_to(&text, width, area.height as usize)
    };
    if has_message(lab) {
        Clear.render(area, buf); // it may cover the panes
    }
    let mut end = 0;
    for (line, y) in lines.iter().zip(0..area.height) {
        end = write(area, (1, y), line, theme.style(role), buf);
    }
    let last = area.height.saturating_sub(1);
    if lines.len() < area.height as usize {
        end = 0; // the last line is empty
    }
    let x = area.width.saturating_sub(CRAMPED.len() as u16 + 1);
    if is_cramped && x >= end + 2 {
        write(area, (x, last), CRAMPED, theme.style(Role::Label), buf);
    }
}

/// Returns true if there is a message, a typed count or a typed value to show.
pub fn has_message(lab: &Lab) -> bool {
    let (popups, messages) = (lab.popups(), lab.messages());
    let types_value = popups.dialog().is_some_and(Dialog::is_of_value);
    types_value || popups.count.is_some() || lab.notice().is_some() || messages.trouble().is_some()
}

const NOT_KEPT: &str = "session not saved";

/// Returns the text of the note on a screen of this width. It mentions an unsaved session as long as saving fails.
fn note_text(lab: &Lab, width: u16) -> (String, Role) {
    let (popups, messages) = (lab.popups(), lab.messages());
    if let Some(typed) = popups.dialog().and_then(typed_value) {
        return typed;
    }
    let message = match popups.count {
        Some(MOST_COUNTED) => Some(format!(
            "{MOST_COUNTED} is the largest count; press a key, or Esc to cancel"
        )),
        Some(count) => Some(format!(
            "{count}: press a key, such as . for this number of steps; Esc cancels"
        )),
        None => lab.notice(),
    };
    match (message, messages.trouble()) {
        (Some(text), Some(_)) => (format!("{NOT_KEPT}{SEPARATOR}{text}"), Role::Text),
        (Some(text), None) => (text, Role::Text),
        (None, Some(trouble)) => (trouble.to_owned(), Role::Off),
        (None, None) => {
            let note = about_selected(lab)
                .or_else(|| step::about_point(lab))
                .unwrap_or_else(|| whole_sentences(&lab.note(), width).to_owned());
            (note, Role::Label)
        }
    }
}

/// Returns the value being typed with its keys, or its error message. Returns `None` in other dialogs.
fn typed_value(dialog: &Dialog) -> Option<(String, Role)> {
    let form = &dialog.form;
    let field = form.fields.first().filter(|_| dialog.is_of_value())?;
    Some(match &form.complaint {
        Some(complaint) => (complaint.clone(), Role::Off),
        None => {
            let (label, unit) = field.label.split_once(", ").unwrap_or((&field.label, ""));
            let value = format!("{label} = {} {unit}", field.text());
            (format!("{}  {}", value.trim_end(), form.keys), Role::Text)
        }
    })
}

/// Returns the key, the text with all digits, and the meaning of the selected value, while the values have the focus.
fn about_selected(lab: &Lab) -> Option<String> {
    let view = lab.view();
    let selected = lab.values().list.selected()?;
    (view.marks_focus_of(Pane::Parameters) && view.sheet.is_none()).then(|| {
        let key = selected.file_key().unwrap_or(&selected.label);
        format!("{key}={}   {}", selected.text, selected.about())
    })
}
