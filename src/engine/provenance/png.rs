//! PNG: the text is the last chunk before the end, a compressed iTXt with the keyword `gyrolab`.

use super::extracted::{Extracted, NO_RUN_TEXT, TWO, packed, unpacked};
use crate::text::checksum::crc32;

pub const SIGNATURE: &[u8] = b"\x89PNG\r\n\x1a\n";
const KEYWORD: &[u8] = b"iTXtgyrolab\0";
/// Compressed by zlib, with no language and no translated keyword.
const COMPRESSED: &[u8] = b"\x01\0\0\0";
/// The IEND chunk.
pub const IEND_CHUNK: &[u8] = b"\0\0\0\0IEND\xae\x42\x60\x82";

/// Returns the chunk with `text`.
pub fn carrier(text: &str) -> Option<Vec<u8>> {
    let chunk = [KEYWORD, COMPRESSED, &packed(text.as_bytes())].concat();
    let length = u32::try_from(chunk.len() - 4).ok()?.to_be_bytes();
    let sum = crc32(&chunk).to_be_bytes();
    Some([&length, chunk.as_slice(), &sum].concat())
}

pub fn extract(file: &[u8]) -> Result<Extracted, &'static str> {
    let (mut at, mut found) = (SIGNATURE.len(), None);
    while let Some((chunk, end)) = chunk(file, at) {
        if let Some(content) = chunk.strip_prefix(KEYWORD)
            && found.replace((content, at, end)).is_some()
        {
            return Err(TWO);
        }
        at = end;
    }
    let (content, begin, end) = found.ok_or(NO_RUN_TEXT)?;
    Ok(Extracted {
        carrier: begin..end,
        text: unpacked(content.strip_prefix(COMPRESSED).ok_or(NO_RUN_TEXT)?)?,
    })
}

/// Returns kind and content of the chunk at the position `at`, and the position of the next one.
fn chunk(file: &[u8], at: usize) -> Option<(&[u8], usize)> {
    let length = file.get(at..)?.first_chunk().copied();
    let end = at
        .checked_add(12)?
        .checked_add(u32::from_be_bytes(length?) as usize)?;
    Some((file.get(at + 4..end)?.split_last_chunk::<4>()?.0, end))
}
