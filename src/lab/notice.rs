//! The message at the bottom of the screen. It goes away after a few seconds or at the next key.

use std::time::Duration;

/// How long a message stays unless a key removes it earlier.
const STANDS: Duration = Duration::from_secs(5);

/// The present message, if there is one, and the lasting trouble with the session.
#[derive(Clone, Debug, Default)]
pub struct Notice {
    said: Option<Said>,
    /// Why the session cannot be saved, if it cannot.
    trouble: Option<String>,
}

#[derive(Clone, Debug)]
struct Said {
    text: String,
    /// The time at which it goes away; `None` where only a key removes it.
    until: Option<Duration>,
    /// The part of the text that stands there until something has been found, and is then replaced by that.
    unfound: Option<&'static str>,
}

impl Notice {
    /// Shows `text` for five seconds from `now` on.
    pub fn say(&mut self, text: impl Into<String>, now: Duration) {
        self.show(text.into(), Some(now + STANDS), None);
    }

    /// Shows `text` until the next key: for messages that must not be missed.
    pub fn keep_saying(&mut self, text: impl Into<String>) {
        self.show(text.into(), None, None);
    }

    /// Shows `text` until the next key; its part `unfound` is replaced once [something is found](Self::find).
    pub fn keep_seeking(&mut self, text: String, unfound: &'static str) {
        self.show(text, None, Some(unfound));
    }

    fn show(&mut self, text: String, until: Option<Duration>, unfound: Option<&'static str>) {
        self.said = Some(Said {
            text,
            until,
            unfound,
        });
    }

    /// Whether a part of the message stands until something is found.
    pub fn is_seeking(&self) -> bool {
        let said = self.said.as_ref();
        said.is_some_and(|said| said.unfound.is_some())
    }

    /// Shows what has been `found` in the place of the part that stood until then.
    pub fn find(&mut self, found: &str) {
        if let Some(said) = &mut self.said
            && let Some(unfound) = said.unfound.take()
        {
            said.text = said.text.replacen(unfound, found, 1);
        }
    }

    /// Shows `text` before the message, until the next key; alone it does without the "; " at its end.
    pub fn keep_saying_first(&mut self, text: &str) {
        let Some(said) = &mut self.said else {
            return self.keep_saying(text.trim_end_matches("; "));
        };
        said.text.insert_str(0, text);
        said.until = None;
    }

    /// Removes the message; returns whether there was one.
    pub fn take_back(&mut self) -> bool {
        self.said.take().is_some()
    }

    /// Removes the message if its time is over at `now`; returns whether it did.
    pub fn expire(&mut self, now: Duration) -> bool {
        self.ends_in(now).is_some_and(|left| left.is_zero()) && self.take_back()
    }

    /// How long the message stays from `now` on; `None` where only a key removes it, or there is none.
    pub fn ends_in(&self, now: Duration) -> Option<Duration> {
        let until = self.said.as_ref()?.until;
        until.map(|until| until.saturating_sub(now))
    }

    pub fn text(&self) -> Option<&str> {
        self.said.as_ref().map(|said| said.text.as_str())
    }

    /// Records why the session cannot be saved, or that it can; returns whether that is new.
    pub fn set_trouble(&mut self, trouble: Option<String>) -> bool {
        let is_new = self.trouble != trouble;
        self.trouble = trouble;
        is_new
    }

    /// Why the session cannot be saved, if it cannot.
    pub fn trouble(&self) -> Option<&str> {
        self.trouble.as_deref()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_message_goes_with_time_unless_it_is_to_stay() {
        let at = Duration::from_secs;
        let mut notice = Notice::default();
        assert!(!notice.expire(at(0)) && !notice.take_back());
        notice.say("pushed", at(10));
        assert_eq!(notice.ends_in(at(12)), Some(at(3)));
        assert!(!notice.expire(at(14)) && notice.expire(at(15)));
        notice.keep_saying("the end");
        assert_eq!(notice.ends_in(at(12)), None);
        assert!(!notice.expire(at(1000)));
        assert_eq!(notice.text(), Some("the end"));
        assert!(notice.take_back() && notice.text().is_none());
    }

    #[test]
    fn what_is_found_takes_the_place_of_what_stood_until_then() {
        let mut notice = Notice::default();
        let text = "the end: a cure is looked for, u goes back".to_owned();
        notice.keep_seeking(text, "a cure is looked for");
        assert!(notice.is_seeking());
        notice.keep_saying_first("opened; ");
        assert_eq!(
            notice.text(),
            Some("opened; the end: a cure is looked for, u goes back")
        );
        notice.find("a shorter step");
        let found = "opened; the end: a shorter step, u goes back";
        assert_eq!(notice.text(), Some(found));
        assert!(!notice.is_seeking());
        // Nothing is left to be replaced; and another message is not changed either.
        notice.find("again");
        assert_eq!(notice.text(), Some(found));
        notice.keep_saying("a cure is looked for");
        notice.find("again");
        assert_eq!(notice.text(), Some("a cure is looked for"));
    }

    #[test]
    fn trouble_stays_until_it_is_over() {
        let mut notice = Notice::default();
        let full = || Some("the disk is full".to_owned());
        assert!(notice.set_trouble(full()) && !notice.set_trouble(full()));
        notice.take_back();
        assert_eq!(notice.trouble(), Some("the disk is full"));
        assert!(notice.set_trouble(None));
    }
}
