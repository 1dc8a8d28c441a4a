//! Computations in the background while the run continues.

use crate::engine::analysis::health::{Advice, advise_while};
use crate::engine::scenario::Scenario;
use std::sync::{Arc, OnceLock};
use std::thread;
use std::time::Duration;

/// Delay before a search begins. A held key nudges a value many times a second, and each search is then dropped before
/// it begins.
const DELAY: Duration = Duration::from_millis(200);

/// A computation in progress or finished.
///
/// Dropping it ends the computation, so that useless work does not take the processor from the run that is edited.
pub struct BackgroundJob<T> {
    answer: Arc<OnceLock<T>>,
    is_reported: bool,
}

impl<T: Send + Sync + 'static> BackgroundJob<T> {
    /// Starts `work`, which can ask whether its answer is still wanted. If the system provides no thread, there is
    /// never an answer.
    pub fn begin(
        name: &str,
        work: impl FnOnce(&(dyn Fn() -> bool + Sync)) -> Option<T> + Send + 'static,
    ) -> Self {
        let answer = Arc::new(OnceLock::new());
        let asker = Arc::downgrade(&answer);
        let _ = thread::Builder::new().name(name.to_owned()).spawn(move || {
            let found = work(&|| asker.strong_count() > 0);
            if let (Some(waiting), Some(found)) = (asker.upgrade(), found) {
                let _ = waiting.set(found); // succeeds: this is the only place that sets it
            }
        });
        Self {
            answer,
            is_reported: false,
        }
    }

    pub fn answer(&self) -> Option<&T> {
        self.answer.get()
    }

    pub fn take_news(&mut self) -> bool {
        let is_news = !self.is_reported && self.answer.get().is_some();
        self.is_reported |= is_news;
        is_news
    }
}

/// Searches for a change that makes an unreliable run reliable. The search does trial runs and may take a second.
pub fn advice(scenario: Arc<Scenario>) -> BackgroundJob<Advice> {
    BackgroundJob::begin("advice", move |is_wanted| {
        thread::sleep(DELAY);
        is_wanted().then(|| advise_while(&scenario, is_wanted))?
    })
}
