//! What a key that is pressed does in the lab.

use super::keymap::{self, Key, KeyEffect};
use super::panes::{self, help};
use crate::lab::action::{Action, LessonKey};
use crate::lab::{Lab, LabRequest};

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
        Some(does) => {
            let request = does.carry_out(lab);
            help::limit(lab);
            request
        }
        None => {
            lab.refuse(keymap::refusal(mode, key));
            None
        }
    }
}

/// Whether a digit is for the sheet; behind the first digit of a count it goes on with the count.
fn is_of_sheet(lab: &Lab) -> bool {
    lab.view().sheet_takes_digits() && lab.popups().count.is_none()
}
