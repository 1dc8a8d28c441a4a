//! A line of text that the user types: a filter, or what is searched for.

use crate::text::printable::is_steering;

/// The most characters of such a line.
pub(super) const MOST_TYPED: usize = 100;

/// Adds `text` to the line `typed`, without line ends and other control characters, up to 100 characters. Returns whether
/// all of it had room.
pub(super) fn type_into(typed: &mut String, text: &str) -> bool {
    let room = MOST_TYPED.saturating_sub(typed.chars().count());
    let mut characters = text.chars().filter(|&c| !is_steering(c));
    typed.extend(characters.by_ref().take(room));
    characters.next().is_none()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_line_takes_a_hundred_characters_and_none_that_steer() {
        let mut line = "速".to_owned();
        assert!(type_into(&mut line, "a\n\u{1b}b"));
        assert_eq!(line, "速ab");
        assert!(type_into(&mut line, &"x".repeat(MOST_TYPED - 3)));
        assert!(!type_into(&mut line, "y"));
        assert!(type_into(&mut line, "\n"), "nothing of it had no room");
        assert_eq!(line.chars().count(), MOST_TYPED);
    }
}
