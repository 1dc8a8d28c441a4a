//! The content of a session, and how it is read from its files.

use super::files::file;
use super::text::Text;
use super::{format, own};
use std::path::Path;

/// The content of a session, as two texts.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Content {
    /// What changes seldom, such as the runs and their journals. It may be long and is saved only when it has changed.
    pub work: Text,
    /// What changes all the time, such as the step at which the lab stands. It is short.
    pub place: String,
}

/// Checks whether a content, once saved, can be read back as the same; the error says why not.
pub type Check = fn(&Content) -> Result<(), String>;

/// What was read from the files of a session.
pub(super) struct Stored {
    /// The work and the place.
    pub content: Content,
    /// Revision of the work.
    pub revision: u64,
    /// Why the place file could not be read, if so; the content then has the older place from the work file.
    pub damage: Option<String>,
}

/// Reads the session `id`, whether or not a process holds it.
///
/// # Errors
/// Why the work file cannot be read.
pub(super) fn stored(folder: &Path, id: &str) -> Result<Stored, String> {
    let text = own::read(&file(folder, id, "work"))?;
    let (revision, carried, work) = format::parse_work(&text)
        .ok_or("it has been cut off or changed, or another version of gyrolab wrote it")?;
    let (place, damage) = match stored_place(folder, id, revision) {
        Ok(place) => (place, None),
        Err(reason) => (None, Some(reason)),
    };
    let content = Content {
        work: Text::from(work),
        place: place.unwrap_or_else(|| carried.to_owned()),
    };
    Ok(Stored {
        content,
        revision,
        damage,
    })
}

/// The place written last, if it belongs to the work of that `revision`.
fn stored_place(folder: &Path, id: &str, revision: u64) -> Result<Option<String>, String> {
    let path = file(folder, id, "place");
    if !own::exists(&path) {
        return Ok(None);
    }
    let text = own::read(&path)?;
    let (of, place) = format::parse_place(&text).ok_or("it has been cut off or changed")?;
    Ok((of == revision).then(|| place.to_owned()))
}
