//! What a key that is pressed does in the lab.

use super::keymap::{self, Key};
use super::panes::{self, help};
use crate::lab::action::{Action, LessonKey};
use crate::lab::{Lab, Request};

/// Carries out the action of `key`, or shows a message that it has none.
pub fn press(key: Key, lab: &mut Lab) -> Option<Request> {
    let mode = lab.on_top().mode;
    let mut own = panes::keys(lab.view().focus).iter();
    if own.any(|row| row.modes.contains(&mode) && row.keys.contains(&key)) {
        lab.touch_pane();
    }
    match keymap::action(panes::keys_of(lab), mode, key) {
        Some(Action::DoEntry) => help::do_entry(lab),
        Some(Action::Digit(digit)) if lab.asks_number() => {
            lab.update(Action::Lesson(LessonKey::Digit(digit)))
        }
        Some(action) => {
            let request = lab.update(action);
            help::limit(lab);
            request
        }
        None => {
            lab.refuse(keymap::refusal(mode, key));
            None
        }
    }
}
