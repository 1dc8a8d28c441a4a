//! What a key that is pressed does in the lab.

use super::keymap::{self, Key};
use super::panes::{self, help};
use crate::lab::action::Action;
use crate::lab::{Lab, Request};

/// The action of `key`, if it has one now.
pub fn action_of(key: Key, lab: &Lab) -> Option<Action> {
    keymap::action(panes::keys_of(lab), lab.on_top().mode, key)
}

/// Carries out the action of `key`, or shows a message that it has none.
pub fn press(key: Key, lab: &mut Lab) -> Option<Request> {
    let mode = lab.on_top().mode;
    let mut own = panes::keys(lab.view().focus).iter();
    if own.any(|row| row.modes.contains(&mode) && row.keys.contains(&key)) {
        lab.touch_pane();
    }
    match action_of(key, lab) {
        Some(Action::DoEntry) => help::do_entry(lab),
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
