//! What would mend a run that is not to be believed: found by trial in the background, for it may take a second.

use crate::analysis::health::{Advice, advise};
use crate::scenario::Scenario;
use std::sync::{Arc, OnceLock};
use std::thread;
use std::time::Duration;

/// How long a question waits: while a value is nudged by a key held down, each is dropped for the next, unanswered.
const PATIENCE: Duration = Duration::from_millis(200);

/// A question under way, or answered. Dropped, nobody hears the answer.
pub struct Advisor {
    answer: Arc<OnceLock<Advice>>,
    is_heard: bool,
}

impl Advisor {
    /// Asks what would mend `scenario`.
    pub fn ask(scenario: Arc<Scenario>) -> Self {
        let answer = Arc::new(OnceLock::new());
        let told = Arc::downgrade(&answer);
        let search = move || {
            thread::sleep(PATIENCE);
            if told.strong_count() == 0 {
                return;
            }
            let advice = advise(&scenario);
            if let Some(told) = told.upgrade() {
                let _ = told.set(advice); // the first answer, so it is taken
            }
        };
        // Where there is no thread to be had, there is no advice.
        let _ = thread::Builder::new()
            .name("advice".to_owned())
            .spawn(search);
        Self {
            answer,
            is_heard: false,
        }
    }

    /// The answer, once there is one.
    pub fn advice(&self) -> Option<&Advice> {
        self.answer.get()
    }

    /// Whether the answer has come since this was asked last.
    pub fn has_news(&mut self) -> bool {
        let is_news = !self.is_heard && self.answer.get().is_some();
        self.is_heard |= is_news;
        is_news
    }
}
