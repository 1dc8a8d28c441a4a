//! The preview of the entry that is selected in the browser. A thread reads it, since a file may take long to read and
//! to check.

use crate::scenario::{Document, Scenario};
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::thread;
use std::time::Duration;

/// How long the lab waits for a preview before it shows that the entry is being read. A file that is read faster is
/// shown at once.
pub(super) const AT_ONCE: Duration = Duration::from_millis(15);

/// What is known of the selected entry.
#[derive(Clone, Debug)]
pub enum Preview {
    Loading,
    /// It cannot be read: the system gives no thread.
    Unknown,
    /// Its scenario, or why it cannot be opened.
    Known(Arc<Result<Scenario, String>>),
}

/// Reads scenarios on a thread of its own, one after the other. A request that has not begun when the next one comes is
/// dropped.
#[derive(Debug, Default)]
pub struct Loader {
    shared: Option<Arc<Shared>>,
}

#[derive(Debug, Default)]
struct Shared {
    task: Mutex<Task>,
    changed: Condvar,
}

#[derive(Debug, Default)]
struct Task {
    /// The scenario to be read next.
    wanted: Option<String>,
    /// The answer to the last request, once there is one.
    known: Option<Arc<Result<Scenario, String>>>,
    is_new: bool,
    is_over: bool,
}

impl Loader {
    /// Requests the scenario `name`. The answer to any earlier request is dropped.
    pub fn ask(&mut self, name: &str) -> Preview {
        let Some(shared) = self.started() else {
            return Preview::Unknown;
        };
        let mut task = shared.lock();
        (task.wanted, task.known) = (Some(name.to_owned()), None);
        shared.changed.notify_all();
        let is_waiting = |task: &mut Task| task.known.is_none();
        let waited = shared.changed.wait_timeout_while(task, AT_ONCE, is_waiting);
        let (mut task, _) = waited.unwrap_or_else(PoisonError::into_inner);
        task.is_new = false;
        task.known.clone().map_or(Preview::Loading, Preview::Known)
    }

    /// The answer to the last request, if it has come since this was last called.
    pub fn take_answer(&self) -> Option<Preview> {
        let mut task = self.shared.as_ref()?.lock();
        let is_new = std::mem::take(&mut task.is_new);
        task.known.clone().filter(|_| is_new).map(Preview::Known)
    }

    /// The state that is shared with the thread, which is started if there is none; `None` where the system gives no
    /// thread.
    fn started(&mut self) -> Option<Arc<Shared>> {
        if self.shared.is_none() {
            let shared = Arc::new(Shared::default());
            let of_thread = Arc::clone(&shared);
            let thread = thread::Builder::new().name("preview".to_owned());
            thread.spawn(move || of_thread.work()).ok()?;
            self.shared = Some(shared);
        }
        self.shared.clone()
    }
}

impl Drop for Loader {
    fn drop(&mut self) {
        if let Some(shared) = &self.shared {
            shared.lock().is_over = true;
            shared.changed.notify_all();
        }
    }
}

impl Shared {
    fn lock(&self) -> MutexGuard<'_, Task> {
        self.task.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Reads each requested scenario, until the loader is dropped.
    fn work(&self) {
        loop {
            let is_idle = |task: &mut Task| task.wanted.is_none() && !task.is_over;
            let waited = self.changed.wait_while(self.lock(), is_idle);
            let mut task = waited.unwrap_or_else(PoisonError::into_inner);
            if task.is_over {
                return;
            }
            let Some(name) = task.wanted.take() else {
                continue;
            };
            drop(task);
            let known = Arc::new(read(&name));
            let mut task = self.lock();
            if task.wanted.is_none() {
                (task.known, task.is_new) = (Some(known), true);
                self.changed.notify_all();
            }
        }
    }
}

/// The scenario `name`, or why it cannot be opened.
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
                    preview = loader.take_answer().unwrap_or(Preview::Loading);
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
            assert!(loader.take_answer().is_none(), "it is told once");
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
                .contains("there is no such file")
        );
    }
}
