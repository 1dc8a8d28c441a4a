//! What is to be said in one line, and for how long: for a while, and no longer than until the next key.

use std::time::Duration;

/// How long a notice stands by itself.
const STANDS: Duration = Duration::from_secs(5);

/// The one line that is being said, if any.
#[derive(Clone, Debug, Default)]
pub struct Notice {
    said: Option<(String, Option<Duration>)>,
}

impl Notice {
    /// Says `text` from `now` on, for a while.
    pub fn say(&mut self, text: impl Into<String>, now: Duration) {
        self.said = Some((text.into(), Some(now + STANDS)));
    }

    /// Says `text` until the next key: it says why the lab stands as it does.
    pub fn keep_saying(&mut self, text: impl Into<String>) {
        self.said = Some((text.into(), None));
    }

    /// Says nothing more; gives whether something was being said.
    pub fn take_back(&mut self) -> bool {
        self.said.take().is_some()
    }

    /// Takes back what has stood long enough at `now`; gives whether it did.
    pub fn expire(&mut self, now: Duration) -> bool {
        self.ends_in(now).is_some_and(|left| left.is_zero()) && self.take_back()
    }

    /// How long it still stands at `now`; `None` where it stays or there is none.
    pub fn ends_in(&self, now: Duration) -> Option<Duration> {
        let (_, until) = self.said.as_ref()?;
        until.map(|until| until.saturating_sub(now))
    }

    /// What is being said.
    pub fn text(&self) -> Option<&str> {
        self.said.as_ref().map(|(text, _)| text.as_str())
    }
}
