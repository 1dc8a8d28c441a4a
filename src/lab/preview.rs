//! What the selected entry of the browser holds, found out in the background: a file may take long to read and to check.

use crate::scenario::{Document, Scenario};
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::thread;
use std::time::Duration;

/// How long a selection waits for its preview before the picture says that it is being read: what is read at once
/// shows at once.
pub(super) const AT_ONCE: Duration = Duration::from_millis(15);

/// What is known of the selected entry.
#[derive(Clone, Debug)]
pub enum Preview {
    /// It is being read.
    Loading,
    /// It cannot be looked into now.
    Unknown,
    /// What it holds, or why it cannot be opened.
    Known(Arc<Result<Scenario, String>>),
}

/// Reads one scenario after the other on a thread of its own; what was asked for before the last is not read at all.
#[derive(Debug, Default)]
pub struct Loader {
    desk: Option<Arc<Desk>>,
}

#[derive(Debug, Default)]
struct Desk {
    order: Mutex<Order>,
    changed: Condvar,
}

#[derive(Debug, Default)]
struct Order {
    /// What is to be read next.
    wanted: Option<String>,
    /// What was asked for last, once it is known.
    known: Option<Arc<Result<Scenario, String>>>,
    has_news: bool,
    is_over: bool,
}

impl Loader {
    /// Asks for the scenario `name`: the answer to anything asked before is dropped.
    pub fn ask(&mut self, name: &str) -> Preview {
        let Some(desk) = self.desk() else {
            return Preview::Unknown;
        };
        let mut order = desk.lock();
        (order.wanted, order.known) = (Some(name.to_owned()), None);
        desk.changed.notify_all();
        let is_waiting = |order: &mut Order| order.known.is_none();
        let waited = desk.changed.wait_timeout_while(order, AT_ONCE, is_waiting);
        let (mut order, _) = waited.unwrap_or_else(PoisonError::into_inner);
        order.has_news = false;
        order.known.clone().map_or(Preview::Loading, Preview::Known)
    }

    /// The answer to what was asked last, if it has come since.
    pub fn news(&self) -> Option<Preview> {
        let mut order = self.desk.as_ref()?.lock();
        let has_news = std::mem::take(&mut order.has_news);
        order.known.clone().filter(|_| has_news).map(Preview::Known)
    }

    /// The thread's desk, the thread begun if there is none; `None` where none can be had.
    fn desk(&mut self) -> Option<Arc<Desk>> {
        if self.desk.is_none() {
            let desk = Arc::new(Desk::default());
            let its_own = Arc::clone(&desk);
            let thread = thread::Builder::new().name("preview".to_owned());
            thread.spawn(move || its_own.work()).ok()?;
            self.desk = Some(desk);
        }
        self.desk.clone()
    }
}

impl Drop for Loader {
    fn drop(&mut self) {
        if let Some(desk) = &self.desk {
            desk.lock().is_over = true;
            desk.changed.notify_all();
        }
    }
}

impl Desk {
    fn lock(&self) -> MutexGuard<'_, Order> {
        self.order.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Reads what is asked for, until nobody asks any more.
    fn work(&self) {
        loop {
            let is_idle = |order: &mut Order| order.wanted.is_none() && !order.is_over;
            let waited = self.changed.wait_while(self.lock(), is_idle);
            let mut order = waited.unwrap_or_else(PoisonError::into_inner);
            if order.is_over {
                return;
            }
            let Some(name) = order.wanted.take() else {
                continue;
            };
            drop(order);
            let known = Arc::new(read(&name));
            let mut order = self.lock();
            if order.wanted.is_none() {
                (order.known, order.has_news) = (Some(known), true);
                self.changed.notify_all();
            }
        }
    }
}

/// What the scenario `name` holds, or why it cannot be opened.
pub fn read(name: &str) -> Result<Scenario, String> {
    Document::open(name)
        .and_then(|document| document.scenario())
        .map_err(|problems| problems.to_string())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn answer(loader: &Loader, preview: Preview) -> Arc<Result<Scenario, String>> {
        let mut preview = preview;
        loop {
            match preview {
                Preview::Known(known) => return known,
                Preview::Unknown => panic!("no thread"),
                Preview::Loading => {
                    thread::yield_now();
                    preview = loader.news().unwrap_or(Preview::Loading);
                }
            }
        }
    }

    #[test]
    fn the_answer_is_to_what_was_asked_last() {
        let mut loader = Loader::default();
        for _ in 0..20 {
            for name in ["cusps", "no-such.toml", "loops"] {
                loader.ask(name);
            }
            let preview = loader.ask("method-2");
            let known = answer(&loader, preview);
            assert_eq!(
                known.as_ref().as_ref().unwrap().file.title,
                read("method-2").unwrap().file.title
            );
            assert!(loader.news().is_none(), "it is told once");
        }
    }

    #[test]
    fn what_cannot_be_opened_says_why() {
        let mut loader = Loader::default();
        let preview = loader.ask("no-such.toml");
        let known = answer(&loader, preview);
        assert!(
            known
                .as_ref()
                .as_ref()
                .unwrap_err()
                .contains("cannot be read")
        );
    }
}
