//! The preview of the entry that is selected in the browser. A thread reads it, since a file may take long to read and
//! to check.

use crate::scenario::{Document, Scenario};
use std::sync::Arc;
use std::sync::mpsc::{self, Receiver, RecvTimeoutError};
use std::thread;
use std::time::Duration;

/// How long the lab waits for a preview before it shows that the entry is being read. A file that is read faster is
/// shown at once.
pub(super) const AT_ONCE: Duration = Duration::from_millis(15);

/// What is known of the selected entry.
#[derive(Clone, Debug)]
pub enum Preview {
    /// It is being read.
    Loading,
    /// Its scenario, or why it cannot be opened.
    Known(Arc<Result<Scenario, String>>),
}

/// Begins `work` on a thread and returns where its result will come. Where the system gives no thread, nothing comes.
pub(super) fn in_background<T: Send + 'static>(
    work: impl FnOnce() -> T + Send + 'static,
) -> Receiver<T> {
    let (tell, found) = mpsc::channel();
    let thread = thread::Builder::new().name("browser".to_owned());
    let _ = thread.spawn(move || {
        let _ = tell.send(work()); // nobody may wait for it any more
    });
    found
}

/// Reads scenarios in the background. The answer to any earlier request is dropped.
#[derive(Debug, Default)]
pub struct Loader {
    asked: Option<(String, Receiver<Result<Scenario, String>>)>,
}

impl Loader {
    /// Requests the scenario `name`.
    pub fn ask(&mut self, name: &str) -> Preview {
        let (name, wanted) = (name.to_owned(), name.to_owned());
        self.asked = Some((name, in_background(move || read(&wanted))));
        self.answer_within(AT_ONCE).unwrap_or(Preview::Loading)
    }

    /// The answer to the last request, if it has come since this was last called.
    pub fn take_answer(&mut self) -> Option<Preview> {
        self.answer_within(Duration::ZERO)
    }

    fn answer_within(&mut self, wait: Duration) -> Option<Preview> {
        let (name, answer) = self.asked.as_ref()?;
        let known = match answer.recv_timeout(wait) {
            Ok(known) => known,
            Err(RecvTimeoutError::Timeout) => return None,
            Err(RecvTimeoutError::Disconnected) => read(name), // there was no thread
        };
        self.asked = None;
        Some(Preview::Known(Arc::new(known)))
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

    fn read_by(loader: &mut Loader, name: &str) -> Arc<Result<Scenario, String>> {
        let mut preview = loader.ask(name);
        loop {
            if let Preview::Known(known) = preview {
                return known;
            }
            thread::yield_now();
            preview = loader.take_answer().unwrap_or(Preview::Loading);
        }
    }

    #[test]
    fn the_answer_is_to_what_was_asked_last() {
        let title = read("method-2").unwrap().file.title;
        let mut loader = Loader::default();
        for _ in 0..20 {
            for name in ["cusps", "no-such.toml", "loops"] {
                loader.ask(name);
            }
            let known = read_by(&mut loader, "method-2");
            assert_eq!(known.as_ref().as_ref().unwrap().file.title, title);
            assert!(loader.take_answer().is_none(), "it is told once");
        }
    }

    #[test]
    fn what_cannot_be_opened_says_why() {
        let known = read_by(&mut Loader::default(), "no-such.toml");
        let refused = known.as_ref().as_ref().unwrap_err();
        assert!(refused.contains("there is no such file"));
    }
}
