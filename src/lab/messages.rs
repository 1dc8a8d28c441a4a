//! The texts that the lab shows: the message at the bottom of the screen, the line about what to look at, and what to
//! try next.
//!
//! A message disappears after a few seconds or at the next key.

use super::answer::{ActionResult, Done};
use super::player::{Halt, MOST_UNTIL, Player};
use super::runs::Runs;
use super::sheet::AskedAnswer;
use super::view::{HideablePart, View};
use crate::engine::journal::changed;
use crate::engine::scenario::presets;
use indicatif::HumanCount;
use std::borrow::Cow;
use std::time::Duration;

/// Duration of a message, unless a key removes it earlier.
const MESSAGE_STAYS: Duration = Duration::from_secs(5);

/// The beginning of the message at the end of the scenario's run, before what to try next.
const END_OF_RUN: &str = "end of the run: space continues, r restarts";

/// The mention of the exact motion in a line about what to try, and its replacement if the exact motion is shown
/// already.
const ASKS_FOR_EXACT: &str = "t draws the exact motion";
const HAS_EXACT: &str = "the exact motion is drawn in dashes";

/// The present message, and the lasting problem with the session.
#[derive(Clone, Debug, Default)]
pub struct Messages {
    said: Option<ShownMessage>,
    /// The reason why the session cannot be saved; `None` if it can.
    trouble: Option<String>,
    /// True if the last key was a request to quit that got a warning.
    was_warned: bool,
}

/// The count and the message that a key has removed.
#[derive(Clone, Copy, Debug)]
pub struct Cleared {
    pub(super) count: Option<u64>,
    /// True if a message or a count was removed.
    pub(super) anything: bool,
    /// True if the previous key was a request to quit that got a warning.
    pub(super) was_warned: bool,
}

#[derive(Clone, Debug)]
struct ShownMessage {
    text: String,
    /// The time at which the message disappears; `None` if only a key removes it.
    until: Option<Duration>,
}

impl Messages {
    /// Shows `text` for five seconds from `now` on.
    pub fn say(&mut self, text: impl Into<String>, now: Duration) {
        self.show(text.into(), Some(now + MESSAGE_STAYS));
    }

    /// Shows `text` until the next key. This is for messages that must not be missed.
    pub fn keep_saying(&mut self, text: impl Into<String>) {
        self.show(text.into(), None);
    }

    /// Shows the message of a command, or the reason why it was refused. Returns false if there is nothing to show.
    pub(super) fn answer(&mut self, answer: ActionResult, now: Duration) -> bool {
        let done = answer.unwrap_or_else(|refusal| Done::saying(refusal.to_string()));
        match done.said {
            Some(text) if done.stays => self.keep_saying(text),
            Some(text) => self.say(text, now),
            None => return false,
        }
        true
    }

    fn show(&mut self, text: String, until: Option<Duration>) {
        self.said = Some(ShownMessage { text, until });
    }

    /// Shows `text` in front of the message until the next key. Without a message, shows `text` alone, without the "; "
    /// at its end.
    pub fn keep_saying_first(&mut self, text: &str) {
        let Some(said) = &mut self.said else {
            return self.keep_saying(text.trim_end_matches("; "));
        };
        said.text.insert_str(0, text);
        said.until = None;
    }

    /// Removes the message. Returns false if there was none.
    pub fn take_back(&mut self) -> bool {
        self.said.take().is_some()
    }

    /// Removes the message if its time is over at `now`. Returns true if it did.
    pub fn expire(&mut self, now: Duration) -> bool {
        self.ends_in(now).is_some_and(|left| left.is_zero()) && self.take_back()
    }

    /// Returns the remaining time of the message at `now`; `None` if only a key removes it or there is none.
    pub fn ends_in(&self, now: Duration) -> Option<Duration> {
        let until = self.said.as_ref()?.until;
        until.map(|until| until.saturating_sub(now))
    }

    pub fn text(&self) -> Option<&str> {
        self.said.as_ref().map(|said| said.text.as_str())
    }

    /// Records why the session cannot be saved, or `None` if it can. Returns true if this is a change.
    pub fn set_trouble(&mut self, trouble: Option<String>) -> bool {
        let is_new = self.trouble != trouble;
        self.trouble = trouble;
        is_new
    }

    /// Returns the reason why the session cannot be saved; `None` if it can.
    pub fn trouble(&self) -> Option<&str> {
        self.trouble.as_deref()
    }

    /// Removes the message, as every key does. `count` is the count that the key has removed.
    pub(super) fn clear(&mut self, count: Option<u64>) -> Cleared {
        Cleared {
            count,
            anything: self.take_back() || count.is_some(),
            was_warned: std::mem::take(&mut self.was_warned),
        }
    }

    /// Shows at `now` what quitting would end. If the next key is also a request to quit, the lab quits.
    pub(super) fn warn(&mut self, text: impl Into<String>, now: Duration) {
        self.was_warned = true;
        self.say(text, now);
    }

    /// Shows `text`, which says that the numbers are no longer finite, with the remedies.
    ///
    /// These are `remedy`, a key that fixes the run, if one is known, and undo if the run has edits.
    pub(super) fn tell_of_break(&mut self, text: &str, remedy: Option<&str>, is_edited: bool) {
        let unknown = "try a shorter time step or another scheme (e)";
        let undo = if is_edited {
            ", u undoes the last edit"
        } else {
            ""
        };
        self.keep_saying(format!("{text}: {}{undo}", remedy.unwrap_or(unknown)));
    }
}

/// Returns the message about a run that has stopped by itself, if it needs one. `next` is what to try next.
pub(super) fn halt_in_words(halt: Halt, next: Option<&str>) -> Option<String> {
    match (halt, next) {
        (Halt::Arrived | Halt::ConditionMet, _) => None,
        (Halt::GaveUp, _) => Some(format!(
            "the condition did not hold at any of {} steps",
            HumanCount(MOST_UNTIL)
        )),
        (Halt::EndOfRun, Some(next)) => Some(format!("{END_OF_RUN}. Next: {next}")),
        (Halt::EndOfRun, None) => {
            Some("end of the scenario's run: space continues, r restarts".to_owned())
        }
        (Halt::NotFinite(error), _) => Some(format!("{} at step {}", error.fact(), error.step)),
    }
}

/// Returns the line about what to try after the run. A command or the scenario may set it. Otherwise it comes from the
/// preset, as long as the motion is unchanged.
pub(super) fn next<'a>(view: &'a View, runs: &'a Runs, player: &'a Player) -> Option<Cow<'a, str>> {
    let file = &player.run().scenario().file;
    let set = view.look.next.as_deref().or(file.viewed_text("next"));
    let next = match (set, runs.changed_from_file()) {
        (Some(next), _) => next,
        (None, None) => presets::find(runs.name())?.next,
        (None, Some(_)) => return None,
    };
    if next.is_empty() {
        return None;
    }
    // The line must not ask for the exact motion if it is on the screen already.
    match player.run().overlay() {
        Some(_) => Some(next.replace(ASKS_FOR_EXACT, HAS_EXACT).into()),
        None => Some(next.into()),
    }
}

/// Returns the line about what to look at in the run.
pub(super) fn note<'a>(view: &'a View, runs: &'a Runs, player: &'a Player) -> Cow<'a, str> {
    if view.asked() == Some(AskedAnswer::Elsewhere) {
        return "".into();
    }
    if view.asked().is_some() {
        return "The verdict and the exact motion are hidden until you have predicted.".into();
    }
    if view.hides_answers() {
        return "The verdict and the exact motion are hidden until the round is over.".into();
    }
    let is_alone = view.sheet.as_ref().is_some_and(|sheet| sheet.is_alone);
    if is_alone || view.hides(HideablePart::LookAt) {
        return "".into();
    }
    let set = view.look.look_at.as_deref();
    let changed = runs.changed_from_file();
    if set.is_none() && changed.is_some() && view.sheet.is_some() {
        // The page describes the run. The file's line is about another run.
        return "".into();
    }
    set.or(changed)
        .or_else(|| changed::look_at(player.run().scenario()))
        .unwrap_or("? lists the keys; a scenario can show its own line here (view.look_at)")
        .into()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_message_expires_unless_it_is_persistent() {
        let at = Duration::from_secs;
        let mut messages = Messages::default();
        assert!(!messages.expire(at(0)) && !messages.take_back());
        messages.say("pushed", at(10));
        assert_eq!(messages.ends_in(at(12)), Some(at(3)));
        assert!(!messages.expire(at(14)) && messages.expire(at(15)));
        messages.keep_saying("the end");
        assert_eq!(messages.ends_in(at(12)), None);
        assert!(!messages.expire(at(1000)));
        assert_eq!(messages.text(), Some("the end"));
        assert!(messages.take_back() && messages.text().is_none());
        messages.warn("an export is under way", at(0));
        let cleared = messages.clear(None);
        assert!(cleared.anything && cleared.was_warned);
        let counted = messages.clear(Some(4));
        assert!(counted.anything && !counted.was_warned);
        assert!(!messages.clear(None).anything);
    }
}
