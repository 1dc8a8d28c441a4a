//! A figure, drawn again from what its file carries.

use super::{Unverified, other_version};
use crate::figure::{Format, Source, write};
use crate::origin::{Figure, Form, Holds};
use crate::scenario::{Problem, Problems};
use std::ops::ControlFlow;
use std::path::Path;

#[derive(Clone, Debug, PartialEq)]
pub struct Redrawn {
    /// What differs; `None` where it is the same picture.
    pub difference: Option<String>,
    /// What else there is to say, a line each.
    pub notes: Vec<String>,
}

/// Draws the figure in the file `path` again and compares; `None` where the file is no figure. `watch` is as for a CSV.
pub fn redraw(
    path: &Path,
    watch: impl Fn(u64, u64) -> ControlFlow<()>,
) -> Result<Option<Redrawn>, Unverified> {
    let of_file = |rule: String| Problems::one(path.display().to_string(), Problem::at("", rule));
    let Some(figure) = Figure::open(path).map_err(of_file)? else {
        return Ok(None);
    };
    let mut notes = Vec::from_iter(other_version(&figure.origin.gyrolab));
    if let Some(changed) = figure.changed {
        let difference = Some(changed.to_owned());
        return Ok(Some(Redrawn { difference, notes }));
    }
    let folder = path.parent().unwrap_or(Path::new(""));
    let source = Source::of(&figure.origin, folder);
    let (source, text) = source.map_err(|problems| of_file(problems.in_one_line()))?;
    let drawn = source
        .draw(watch)
        .map_err(of_file)?
        .ok_or(Unverified::Stopped)?;
    let format = match figure.form {
        Form::Svg if text => Format::SvgText,
        Form::Svg => Format::Svg,
        Form::Pdf => Format::Pdf,
        Form::Png => Format::Png,
    };
    let again = write(&drawn.scene, format, Some(&figure.origin));
    let again = again.map_err(|error| of_file(error.to_string()))?;
    let again = Figure::of(&again).map_err(of_file)?;
    if figure.origin.all(Holds::Table).next().is_some() {
        notes.push("drawn from the table in it; gyrolab verify computes that where it has a file of its own".to_owned());
    }
    let difference = difference(&figure, &again);
    if difference.is_none() && figure.picture != again.picture {
        notes.push("its pixels are the same, compressed otherwise".to_owned());
    }
    Ok(Some(Redrawn { difference, notes }))
}

/// What differs between two pictures.
fn difference(figure: &Figure, again: &Figure) -> Option<String> {
    let (there, drawn) = (&figure.picture, &again.picture);
    let are_same = there == drawn
        || figure.form == Form::Png && pixels(drawn).is_some() && pixels(there) == pixels(drawn);
    let mut pairs = there.iter().zip(drawn);
    let at = pairs.position(|(a, b)| a != b);
    let at = at.unwrap_or(there.len().min(drawn.len()));
    (!are_same).then(|| {
        let (length, other) = (there.len(), drawn.len());
        format!(
            "its run, drawn again, is another picture: from byte {at} on ({length} bytes, drawn again {other})"
        )
    })
}

/// The size and the pixels of a PNG no larger than those that are drawn.
fn pixels(file: &[u8]) -> Option<(png::OutputInfo, Vec<u8>)> {
    const MOST: usize = 300_000_000;
    let mut reader = png::Decoder::new(std::io::Cursor::new(file))
        .read_info()
        .ok()?;
    let length = reader
        .output_buffer_size()
        .filter(|length| *length <= MOST)?;
    let mut pixels = vec![0; length];
    let info = reader.next_frame(&mut pixels).ok()?;
    Some((info, pixels))
}
