//! Shared code of the file formats: the result of an extraction, compression, and error messages.

use std::ops::Range;

/// Maximum length of an embedded text, bytes.
pub const LONGEST_TEXT: usize = 64 << 20;

pub const NO_RUN_TEXT: &str =
    "contains no run: another program drew or rewrote it, or its metadata was stripped";
pub const TWO: &str =
    "contains the metadata of two figures, and it is unknown which one belongs to it";
pub const BROKEN: &str = "its metadata is damaged";

/// An embedded text, and the bytes of the file in which it is embedded. The other bytes are the picture.
pub struct Extracted {
    pub carrier: Range<usize>,
    pub text: Vec<u8>,
}

pub fn packed(bytes: &[u8]) -> Vec<u8> {
    const PAYLOAD_COMPRESSION: u8 = 9;
    miniz_oxide::deflate::compress_to_vec_zlib(bytes, PAYLOAD_COMPRESSION)
}

pub fn unpacked(bytes: &[u8]) -> Result<Vec<u8>, &'static str> {
    let unpacked = miniz_oxide::inflate::decompress_to_vec_zlib_with_limit(bytes, LONGEST_TEXT);
    unpacked.map_err(|_| BROKEN)
}

/// Returns the position of `mark` in `file`, in which it must occur exactly once.
pub fn place(file: &[u8], mark: &[u8]) -> Result<usize, &'static str> {
    let places = file.windows(mark.len()).enumerate();
    let mut places = places.filter(|(_, window)| *window == mark);
    let (place, _) = places.next().ok_or(NO_RUN_TEXT)?;
    places.next().map_or(Ok(place), |_| Err(TWO))
}
