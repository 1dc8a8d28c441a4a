//! The text format of a session's two files: header lines, then the content.
//!
//! ```text
//! gyrolab session 2            gyrolab place 2
//! revision 7                   revision 7
//! place 204                    place 204            bytes
//! work 3632                    sum 1c291ca3
//! sum 8d4f1d92                 PLACE
//! PLACE WORK
//! ```
//!
//! The sum is a CRC-32 of everything but its own line; it detects changed bits. Format 1 had no sum; it is still read, but
//! no longer written.

const WORK: &str = "gyrolab session ";
const PLACE: &str = "gyrolab place ";
const PRESENT_FORMAT: &str = "2";
const FORMAT_WITHOUT_SUM: &str = "1";

/// The header of the work file.
pub(super) fn head_of_work(revision: u64, place: &str, work: &str) -> String {
    let head = format!(
        "{WORK}{PRESENT_FORMAT}\nrevision {revision}\nplace {}\nwork {}\n",
        place.len(),
        work.len()
    );
    summed(head, &[place, work])
}

/// The header of the place file.
pub(super) fn head_of_place(revision: u64, place: &str) -> String {
    let head = format!(
        "{PLACE}{PRESENT_FORMAT}\nrevision {revision}\nplace {}\n",
        place.len()
    );
    summed(head, &[place])
}

/// `head` with the line of the sum over it and the `rest` of the file.
fn summed(head: String, rest: &[&str]) -> String {
    let line = sum_line(&head, rest);
    head + &line
}

fn sum_line(head: &str, rest: &[&str]) -> String {
    let mut sum = crc32fast::Hasher::new();
    sum.update(head.as_bytes());
    rest.iter().for_each(|part| sum.update(part.as_bytes()));
    format!("sum {:08x}\n", sum.finalize())
}

/// Revision, place and work from the text of a work file; `None` if it is incomplete or damaged.
pub(super) fn parse_work(text: &str) -> Option<(u64, &str, &str)> {
    let (form, rest) = text.strip_prefix(WORK)?.split_once('\n')?;
    let (revision, rest) = number("revision ", rest)?;
    let (place, rest) = number("place ", rest)?;
    let (work, rest) = number("work ", rest)?;
    let rest = after_sum(form, text, rest)?;
    let (place, rest) = rest.split_at_checked(usize::try_from(place).ok()?)?;
    (rest.len() as u64 == work).then_some((revision, place, rest))
}

/// Revision and place from the text of a place file; `None` if it is incomplete or damaged.
pub(super) fn parse_place(text: &str) -> Option<(u64, &str)> {
    let (form, rest) = text.strip_prefix(PLACE)?.split_once('\n')?;
    let (revision, rest) = number("revision ", rest)?;
    let (place, rest) = number("place ", rest)?;
    let rest = after_sum(form, text, rest)?;
    (rest.len() as u64 == place).then_some((revision, rest))
}

/// The content after the line with the sum, if the sum is right. `text` is the whole file, `rest` its end from that line
/// on.
fn after_sum<'a>(form: &str, text: &'a str, rest: &'a str) -> Option<&'a str> {
    match form {
        FORMAT_WITHOUT_SUM => Some(rest),
        PRESENT_FORMAT => {
            let head = &text[..text.len() - rest.len()];
            let (_, content) = rest.split_once('\n')?;
            let line = &rest[..rest.len() - content.len()];
            (line == sum_line(head, &[content])).then_some(content)
        }
        _ => None,
    }
}

/// The number in a line `name` NUMBER at the beginning of `text`, and the text after that line.
fn number<'a>(name: &str, text: &'a str) -> Option<(u64, &'a str)> {
    let (line, rest) = text.split_once('\n')?;
    Some((line.strip_prefix(name)?.parse().ok()?, rest))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Asserts that `is_read` refuses `text` with any one byte changed or with its end cut off.
    #[track_caller]
    fn assert_changes_are_refused(text: &str, is_read: impl Fn(&str) -> bool) {
        assert!(is_read(text));
        for at in 0..text.len() {
            for byte in 0..=u8::MAX {
                let mut changed = text.as_bytes().to_owned();
                changed[at] = byte;
                if byte != text.as_bytes()[at]
                    && let Ok(changed) = String::from_utf8(changed)
                {
                    assert!(!is_read(&changed), "byte {at} as {byte}: {changed:?}");
                }
            }
        }
        for end in 0..text.len() {
            assert!(!text.is_char_boundary(end) || !is_read(&text[..end]));
        }
    }

    #[test]
    fn a_changed_byte_is_detected() {
        let (place, work) = ("step = 12\n", "title = \"Größe\"\nform = 2\n");
        let text = head_of_work(12, place, work) + place + work;
        assert_eq!(parse_work(&text), Some((12, place, work)));
        assert_changes_are_refused(&text, |text| parse_work(text).is_some());
        let text = head_of_place(12, place) + place;
        assert_eq!(parse_place(&text), Some((12, place)));
        assert_changes_are_refused(&text, |text| parse_place(text).is_some());
    }

    #[test]
    fn format_1_without_a_sum_is_read() {
        let text = "gyrolab session 1\nrevision 3\nplace 2\nwork 4\nherework";
        assert_eq!(parse_work(text), None);
        let text = "gyrolab session 1\nrevision 3\nplace 4\nwork 4\nherework";
        assert_eq!(parse_work(text), Some((3, "here", "work")));
        let text = "gyrolab place 1\nrevision 3\nplace 4\nhere";
        assert_eq!(parse_place(text), Some((3, "here")));
    }
}
