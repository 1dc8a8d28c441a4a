//! What a key that is pressed does in the lab.

use super::keymap::{self, Does, Key};
use super::panes::{self, help};
use crate::lab::action::Action;
use crate::lab::{Lab, Request};

pub fn press(key: Key, lab: &mut Lab) -> Option<Request> {
    let mode = lab.popups().mode;
    let mut own = panes::keys(lab.view().focus).iter();
    if own.any(|row| row.modes.contains(&mode) && row.keys.contains(&key)) {
        lab.view_mut().is_touched = true;
    }
    match keymap::meaning(panes::keys_of(lab), mode, key) {
        Some(Does::Action(Action::DoEntry)) => help::do_entry(lab),
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
