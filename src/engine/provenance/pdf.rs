//! PDF: the text is an attached file. It is appended to the picture's file as an incremental update: the attachment,
//! the catalog that names it, and the table of their positions.

use super::extracted::{BROKEN, Extracted, packed, place, unpacked};

const PDF_MARK: &str = "\n% gyrolab figure\n";
const STREAM: &[u8] = b"\nstream\n";
/// Name of the attachment in PDF readers.
const ATTACHMENT_NAME: &str = "gyrolab-figure.txt";
/// Size of the end of a file in which its trailer is searched, bytes.
const TAIL: usize = 256;

/// Returns the update that embeds `text` after `picture`.
pub fn carrier(picture: &[u8], text: &str) -> Option<Vec<u8>> {
    let tail = String::from_utf8_lossy(&picture[picture.len().saturating_sub(TAIL)..]);
    let number = |key: &str| -> Option<usize> {
        let after = tail.rsplit_once(key)?.1.trim_start();
        after
            .split(|c: char| !c.is_ascii_digit())
            .next()?
            .parse()
            .ok()
    };
    let (size, before) = (number("/Size")?, number("startxref")?);
    let (attached, stream) = (size, size + 1);
    let content = packed(text.as_bytes());
    let mut update = PDF_MARK.as_bytes().to_vec();
    let catalog_at = picture.len() + update.len();
    update.extend(format!(
        "1 0 obj\n<</Type/Catalog/Pages 2 0 R/Names<</EmbeddedFiles<</Names[({ATTACHMENT_NAME}) {attached} 0 R]>>>>>>\nendobj\n"
    ).bytes());
    let attached_at = picture.len() + update.len();
    update.extend(
        format!("{attached} 0 obj\n<</Type/Filespec/F({ATTACHMENT_NAME})/EF<</F {stream} 0 R>>>>\nendobj\n")
            .bytes(),
    );
    let stream_at = picture.len() + update.len();
    update.extend(format!(
        "{stream} 0 obj\n<</Type/EmbeddedFile/Subtype/text#2Fplain/Filter/FlateDecode/Length {}/Params<</Size {}>>>>",
        content.len(),
        text.len()
    ).bytes());
    update.extend([STREAM, &content, b"\nendstream\nendobj\n"].concat());
    let table_at = picture.len() + update.len();
    update.extend(format!(
        "xref\n1 1\n{catalog_at:010} 00000 n\r\n{attached} 2\n{attached_at:010} 00000 n\r\n{stream_at:010} 00000 n\r\n\
         trailer\n<</Size {}/Root 1 0 R/Info 5 0 R/Prev {before}>>\nstartxref\n{table_at}\n%%EOF\n",
        stream + 1
    ).bytes());
    Some(update)
}

pub fn extract(file: &[u8]) -> Result<Extracted, &'static str> {
    let begin = place(file, PDF_MARK.as_bytes())?;
    let update = &file[begin..];
    let stream = update
        .windows(STREAM.len())
        .position(|window| window == STREAM);
    Ok(Extracted {
        carrier: begin..file.len(),
        text: unpacked(&update[stream.ok_or(BROKEN)? + STREAM.len()..])?,
    })
}
