//! Redraws a figure from the data in its file, to verify it.

use crate::engine::provenance::{FigureFile, FileFormat, Payload, SCREEN};
use crate::plot::{PageFormat, write};
use crate::report::figure::FigureSource;
use crate::studies::verify::{Unverified, other_version};
use std::ops::ControlFlow;
use std::path::Path;

/// The difference in a figure, if any, and remarks.
type Redrawn = (Option<String>, Vec<String>);

/// Redraws the figure in the file `path`. Returns the difference, if any, and remarks; `None` if the file is not a
/// figure. `watch` is called as in the verification of a CSV.
pub fn redraw(
    path: &Path,
    watch: impl Fn(u64, u64) -> ControlFlow<()>,
) -> Result<Option<Redrawn>, Unverified> {
    let Some(figure) = FigureFile::open(path)? else {
        return Ok(None);
    };
    let mut notes = Vec::from_iter(other_version(&figure.origin.gyrolab));
    if let Some(changed) = figure.changed {
        return Ok(Some((Some(changed.to_owned()), notes)));
    }
    if figure.origin.figure.contains_key(SCREEN) {
        let rule = "is a picture of the lab's screen and cannot be redrawn; the file is unchanged, and gyrolab run can play the run in it";
        return Err(rule.to_owned().into());
    }
    let folder = path.parent().unwrap_or(Path::new(""));
    let source = FigureSource::from_origin(&figure.origin, folder).map_err(|problems| {
        let versions = notes.first().map(|note| format!(" ({note})"));
        problems.in_one_line() + &versions.unwrap_or_default()
    })?;
    let drawn = source.draw(watch)?.ok_or(Unverified::Stopped)?;
    let again = write(&drawn.scene, format(&figure, &source), Some(&figure.origin));
    let again = FigureFile::parse(again.map_err(|error| error.to_string())?)?;
    if figure.origin.all(Payload::Table).next().is_some() {
        notes.push("redrawn from its table, which is not recomputed; to verify the table, run gyrolab verify on its own file".to_owned());
    }
    let mut difference = None;
    if figure.picture != again.picture {
        let is_png = figure.form == FileFormat::Png;
        if is_png && have_same_pixels(&figure.picture, &again.picture) == Some(true) {
            notes.push("its pixels are the same, but compressed differently".to_owned());
        } else {
            difference = Some("its run, redrawn, gives another picture".to_owned());
        }
    }
    Ok(Some((difference, notes)))
}

/// Returns true if two PNG files show the same picture; `None` if one of them cannot be read.
fn have_same_pixels(there: &[u8], drawn: &[u8]) -> Option<bool> {
    let of_drawn = pixels(drawn, MOST_PIXELS)?;
    Some(pixels(there, of_drawn.1.len())? == of_drawn)
}

fn format(figure: &FigureFile, source: &FigureSource) -> PageFormat {
    match figure.form {
        FileFormat::Svg if source.spec.text => PageFormat::SvgText,
        FileFormat::Svg => PageFormat::Svg,
        FileFormat::Pdf => PageFormat::Pdf,
        FileFormat::Png => PageFormat::Png,
    }
}

/// Maximum size of the pixels of a redrawn PNG, bytes.
const MOST_PIXELS: usize = 300_000_000;

/// Decodes the pixels of a PNG, if they take at most `most` bytes.
fn pixels(file: &[u8], most: usize) -> Option<(png::OutputInfo, Vec<u8>)> {
    let mut reader = png::Decoder::new(std::io::Cursor::new(file))
        .read_info()
        .ok()?;
    let length = reader
        .output_buffer_size()
        .filter(|length| *length <= most)?;
    let mut pixels = vec![0; length];
    let info = reader.next_frame(&mut pixels).ok()?;
    Some((info, pixels))
}
