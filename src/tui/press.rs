//! Carries out a key press in the lab.

use super::keymap::{self, BINDINGS, Key, KeyEffect};
use super::panes::{self, help};
use crate::lab::action::{Action, LessonKey};
use crate::lab::sheet::AskedAnswer;
use crate::lab::view::Pane;
use crate::lab::{Lab, LabRequest, Mode};

const NUMBER_FIRST: &str = "type a number, then press Enter; Tab goes to the lab";

/// Carries out `key` in `lab`. Returns a request if only the main loop can fulfill it.
pub fn press(key: Key, lab: &mut Lab) -> Option<LabRequest> {
    let mode = lab.mode();
    let mut own = panes::row(lab.view().focus).keys.iter();
    if own.any(|row| row.modes.contains(&mode) && row.keys.contains(&key)) {
        lab.view_mut().is_touched = true;
    }
    match keymap::meaning(panes::keys_of(lab), mode, key) {
        Some(KeyEffect::Action(Action::DoEntry)) => help::do_entry(lab),
        Some(KeyEffect::Action(Action::Digit(digit))) if is_of_sheet(lab) => {
            lab.update(Action::Lesson(LessonKey::Digit(digit)))
        }
        Some(does) if mode == Mode::Lab && asks_number(lab) && !is_of_page(does) => {
            match key {
                Key::Char(sign @ ('-' | '+' | '.' | ',')) => {
                    return lab.update(Action::Lesson(LessonKey::Sign(sign)));
                }
                Key::Char(letter) if letter.is_alphabetic() => lab.refuse(NUMBER_FIRST),
                _ => return carry_out(does, lab),
            }
            None
        }
        Some(does) => carry_out(does, lab),
        None => {
            lab.refuse(refusal(mode, key));
            None
        }
    }
}

fn carry_out(does: KeyEffect, lab: &mut Lab) -> Option<LabRequest> {
    let request = panes::carry_out(does, lab);
    help::limit(lab);
    request
}

/// Returns true if the page has the focus and asks for a number. Letters are then not keys of the lab.
fn asks_number(lab: &Lab) -> bool {
    lab.view().asked() == Some(AskedAnswer::Number) && is_of_sheet(lab)
}

/// Returns true if the key turns pages, closes, quits or opens the help.
fn is_of_page(does: KeyEffect) -> bool {
    matches!(
        does,
        KeyEffect::Action(
            Action::Lesson(_) | Action::Class | Action::Quit | Action::Help | Action::Close
        )
    )
}

/// Returns true if the sheet receives a digit. After the first digit of a count, further digits extend the count.
fn is_of_sheet(lab: &Lab) -> bool {
    lab.view().sheet_takes_digits() && lab.popups().count.is_none()
}

/// Returns the message for a `key` without effect in `mode`: where the key works, or which keys to press here.
fn refusal(mode: Mode, key: Key) -> String {
    let here = match mode {
        Mode::Lab => "? lists the keys",
        Mode::Browser => "Enter opens, Esc closes",
        Mode::Lessons => "Enter opens, Esc closes the list",
        Mode::Find => "Enter edits the value, Esc shows all values",
        Mode::Help => "Enter does the selected entry, Esc closes",
        Mode::Dialog => "Enter applies, Esc cancels",
    };
    match elsewhere(mode, key) {
        Some(place) => format!("{key} is a key {place}; {here}"),
        None => format!("{key} does nothing here; {here}"),
    }
}

/// Returns where `key` works and how to get there, or `None` if it works nowhere else.
fn elsewhere(mode: Mode, key: Key) -> Option<String> {
    let of_pane = panes::rows().find(|pane| pane.keys.iter().any(|row| row.keys.contains(&key)));
    if let Some(pane) = of_pane.filter(|_| mode == Mode::Lab) {
        let how = match pane.id {
            Pane::Lesson => "L lists the lessons",
            Pane::Step => "v opens it",
            Pane::Parameters => "e goes to it",
            Pane::Traces | Pane::Above | Pane::ThreeD => "Tab goes to it",
        };
        return Some(format!("of the pane \"{}\": {how}", pane.title));
    }
    let mut others = BINDINGS.iter().filter(|row| !row.modes.contains(&mode));
    let other = others.find(|row| row.keys.contains(&key))?;
    Some(match other.modes[0] {
        Mode::Lab => "of the lab".to_owned(),
        Mode::Browser | Mode::Lessons | Mode::Help => "of lists (o, L, ?, c)".to_owned(),
        Mode::Find => "of the search for a value (/)".to_owned(),
        Mode::Dialog => "of dialogs".to_owned(),
    })
}
