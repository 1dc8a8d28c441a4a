//! Words that a text must contain.

/// Asserts that `text` contains `words`.
#[track_caller]
pub fn has(text: impl AsRef<str>, words: impl AsRef<str>) {
    let (text, words) = (text.as_ref(), words.as_ref());
    assert!(text.contains(words), "{words:?} is not in: {text}");
}

/// Asserts that `text` contains each of `words`.
#[track_caller]
pub fn has_all(text: impl AsRef<str>, words: impl IntoIterator<Item = impl AsRef<str>>) {
    for one in words {
        has(&text, one);
    }
}

/// Asserts that `text` does not contain `words`.
#[track_caller]
pub fn has_no(text: impl AsRef<str>, words: impl AsRef<str>) {
    let (text, words) = (text.as_ref(), words.as_ref());
    assert!(!text.contains(words), "{words:?} is in: {text}");
}
