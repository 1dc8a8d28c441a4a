//! SVG: the text is the last element, `<metadata>`. Characters that XML does not allow, and `%`, are written as `%` and
//! two hexadecimal digits for each byte. Other programs then have no reason to rewrite them.

use super::extracted::{BROKEN, Extracted, place};

const BEGIN: &str = "<metadata>\n";
/// The start tag, with the first letters of the text.
const BEGIN_OF_TEXT: &[u8] = b"<metadata>\n# gyrolab figure, ";
const METADATA_END: &str = "\n</metadata>\n";
pub const END_OF_FILE: &[u8] = b"</svg>\n";

/// Returns the element with `text`.
pub fn carrier(text: &str) -> Vec<u8> {
    let mut carrier = BEGIN.to_owned();
    escape(text, &mut carrier);
    carrier.push_str(METADATA_END);
    carrier.into_bytes()
}

pub fn extract(file: &[u8]) -> Result<Extracted, &'static str> {
    let begin = place(file, BEGIN_OF_TEXT)?;
    let rest = &file[begin + BEGIN.len()..];
    let end = rest.iter().position(|byte| *byte == b'<').ok_or(BROKEN)?;
    let (text, after) = rest.split_at(end.saturating_sub(1));
    let after = after.strip_prefix(METADATA_END.as_bytes()).ok_or(BROKEN)?;
    Ok(Extracted {
        carrier: begin..file.len() - after.len(),
        text: unescaped(text).ok_or(BROKEN)?,
    })
}

fn escape(text: &str, escaped: &mut String) {
    escaped.reserve(text.len());
    for c in text.chars() {
        let is_plain = c == '\n' || c == '\t' || !c.is_control();
        if is_plain && !"%<>&\u{fffe}\u{ffff}".contains(c) {
            escaped.push(c);
        } else {
            let mut bytes = [0; 4];
            let bytes = c.encode_utf8(&mut bytes).bytes();
            escaped.extend(bytes.map(|byte| format!("%{byte:02x}")));
        }
    }
}

fn unescaped(text: &[u8]) -> Option<Vec<u8>> {
    let mut parts = text.split(|byte| *byte == b'%');
    let mut plain = parts.next()?.to_vec();
    for part in parts {
        let (digits, rest) = part.split_at_checked(2)?;
        plain.push(u8::from_str_radix(str::from_utf8(digits).ok()?, 16).ok()?);
        plain.extend_from_slice(rest);
    }
    Some(plain)
}
