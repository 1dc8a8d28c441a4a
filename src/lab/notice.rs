//! The message at the bottom of the screen. It goes away after a few seconds or at the next key.

use std::time::Duration;

/// How long a message stays unless a key removes it earlier.
const STANDS: Duration = Duration::from_secs(5);

/// The present message, if there is one, and the lasting trouble with the session.
#[derive(Clone, Debug, Default)]
pub struct Notice {
    /// The message, and the time at which it goes away; `None` where only a key removes it.
    said: Option<(String, Option<Duration>)>,
    /// Why the session cannot be saved, if it cannot.
    trouble: Option<String>,
}

impl Notice {
    /// Shows `text` for five seconds from `now` on.
    pub fn say(&mut self, text: impl Into<String>, now: Duration) {
        self.said = Some((text.into(), Some(now + STANDS)));
    }

    /// Shows `text` until the next key: for messages that must not be missed.
    pub fn keep_saying(&mut self, text: impl Into<String>) {
        self.said = Some((text.into(), None));
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
        let (_, until) = self.said.as_ref()?;
        until.map(|until| until.saturating_sub(now))
    }

    /// The message.
    pub fn text(&self) -> Option<&str> {
        self.said.as_ref().map(|(text, _)| text.as_str())
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
    fn trouble_stays_until_it_is_over() {
        let mut notice = Notice::default();
        let full = || Some("the disk is full".to_owned());
        assert!(notice.set_trouble(full()) && !notice.set_trouble(full()));
        notice.take_back();
        assert_eq!(notice.trouble(), Some("the disk is full"));
        assert!(notice.set_trouble(None));
    }
}
