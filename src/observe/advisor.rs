//! Searches for a change that makes an unreliable run reliable, by trial runs in the background: it may take a second.

use crate::analysis::health::{Advice, advise_while};
use crate::scenario::Scenario;
use std::sync::{Arc, OnceLock};
use std::thread;
use std::time::Duration;

/// Delay before a search begins. A held key nudges a value many times a second; each search is then dropped before it begins.
const DELAY: Duration = Duration::from_millis(200);

/// A search for advice, in progress or finished. Dropping it ends the search: one that nobody waits for would take the
/// processor from the run that is edited.
pub struct Advisor {
    answer: Arc<OnceLock<Advice>>,
    is_reported: bool,
}

impl Advisor {
    pub fn ask(scenario: Arc<Scenario>) -> Self {
        let answer = Arc::new(OnceLock::new());
        let asker = Arc::downgrade(&answer);
        let search = move || {
            thread::sleep(DELAY);
            let is_wanted = || asker.strong_count() > 0;
            if !is_wanted() {
                return;
            }
            let advice = advise_while(&scenario, &is_wanted);
            if let (Some(answer), Some(advice)) = (asker.upgrade(), advice) {
                let _ = answer.set(advice); // it is set only here, so this succeeds
            }
        };
        // If the system gives no thread, there is no advice.
        let _ = thread::Builder::new()
            .name("advice".to_owned())
            .spawn(search);
        Self {
            answer,
            is_reported: false,
        }
    }

    pub fn advice(&self) -> Option<&Advice> {
        self.answer.get()
    }

    pub fn take_news(&mut self) -> bool {
        let is_news = !self.is_reported && self.answer.get().is_some();
        self.is_reported |= is_news;
        is_news
    }
}
