//! Assertions on words in a text.

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

/// Returns the error messages in `text` without the names that they list, so that a new name changes no snapshot.
pub fn without_lists(text: &str) -> String {
    let lines = text.lines().map(|line| {
        if let Some((before, list)) = line.rsplit_once(": there is ")
            && list.ends_with(" more")
        {
            return format!("{before}: there is ...");
        }
        let Some((before, list)) = line.split_once(" must be one of ") else {
            return line.to_owned();
        };
        let end = list.find(';').unwrap_or(list.len());
        format!("{before} must be one of ...{}", &list[end..])
    });
    lines.collect::<Vec<_>>().join("\n")
}

/// Asserts that `text` does not contain `words`.
#[track_caller]
pub fn has_no(text: impl AsRef<str>, words: impl AsRef<str>) {
    let (text, words) = (text.as_ref(), words.as_ref());
    assert!(!text.contains(words), "{words:?} is in: {text}");
}
