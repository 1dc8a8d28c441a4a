//! A text that is written when it is first read.

use std::fmt;
use std::ops::Deref;
use std::sync::{Arc, LazyLock};

/// A text, or how to write it. It is written once, by the thread that first reads it; a clone shares it.
#[derive(Clone)]
pub struct Text(Arc<LazyLock<String, Writing>>);

type Writing = Box<dyn FnOnce() -> String + Send>;

impl Text {
    /// The text that `write` gives. It is called when the text is first read.
    pub fn later(write: impl FnOnce() -> String + Send + 'static) -> Self {
        Self(Arc::new(LazyLock::new(Box::new(write))))
    }

    /// Whether both are clones of one text; it writes neither.
    pub(super) fn is_clone_of(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.0, &other.0)
    }
}

impl Deref for Text {
    type Target = str;

    fn deref(&self) -> &str {
        &self.0
    }
}

impl From<&str> for Text {
    fn from(text: &str) -> Self {
        let text = text.to_owned();
        Self::later(move || text)
    }
}

impl PartialEq for Text {
    /// Comparing the pointers settles nearly every case without comparing the texts.
    fn eq(&self, other: &Self) -> bool {
        self.is_clone_of(other) || **self == **other
    }
}

impl Eq for Text {}

impl fmt::Debug for Text {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        fmt::Debug::fmt(&**self, f)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::sync::atomic::{AtomicUsize, Ordering};

    #[test]
    fn a_text_is_written_once_and_only_when_it_is_read() {
        let count = Arc::new(AtomicUsize::new(0));
        let written = Arc::clone(&count);
        let text = Text::later(move || {
            written.fetch_add(1, Ordering::SeqCst);
            "here".to_owned()
        });
        let clone = text.clone();
        assert_eq!(text, clone);
        assert_eq!(count.load(Ordering::SeqCst), 0);
        assert_eq!((&*text, &*clone), ("here", "here"));
        assert_eq!(text, Text::from("here"));
        assert_eq!(count.load(Ordering::SeqCst), 1);
    }
}
