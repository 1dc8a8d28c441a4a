//! Opening a lesson: a shipped one, or a file.

use super::lesson::{Lesson, LessonBlock};
use super::reading::read;
use super::shipped;
use crate::engine::export::Destination;
use crate::engine::scenario::head::read_whole;
use crate::engine::scenario::problem::nearest;
use crate::engine::scenario::{Problem, Problems, presets};
use crate::engine::text::shipped::Shipped;
use crate::lab::command::Command;
use std::collections::BTreeMap;
use std::path::Path;
use std::sync::{Mutex, PoisonError};

/// Maximum length of a lesson file, bytes.
pub const LONGEST_LESSON_FILE: u64 = 1 << 20;
const TOO_LONG: &str = "is longer than 1 MiB, the maximum for a lesson";

/// Opens the lesson `name`: a file if the name contains a `/` or ends in `.md`, else a shipped lesson.
///
/// # Errors
///
/// Returns an error if there is no such lesson, or if its file cannot be read or parsed.
pub fn open(name: &str) -> Result<Lesson, Problems> {
    if is_file_name(name) {
        return read_file(Path::new(name));
    }
    match shipped::find(name) {
        Some(lesson) => open_shipped(lesson),
        None => {
            let near = nearest(name, shipped::LESSONS.iter().map(|lesson| lesson.name));
            let rule =
                format!("no lesson of that name: {near} (a file's name holds a / or ends in .md)");
            Err(Problems::one(name, Problem::at("", rule)))
        }
    }
}

/// Shipped lessons parsed so far, by their names. The list needs all of them at every key.
static READ: Mutex<BTreeMap<&str, Lesson>> = Mutex::new(BTreeMap::new());

fn open_shipped(shipped: &'static Shipped) -> Result<Lesson, Problems> {
    let mut known = READ.lock().unwrap_or_else(PoisonError::into_inner);
    if let Some(lesson) = known.get(shipped.name) {
        return Ok(lesson.clone());
    }
    let origin = format!("presets/lessons/{}.md", shipped.name);
    let lesson = Lesson {
        name: shipped.name.to_owned(),
        ..read(&origin, shipped.text)?
    };
    known.insert(shipped.name, lesson.clone());
    Ok(lesson)
}

/// Opens a lesson like [`open`], but refuses files that could block.
pub fn open_again(name: &str) -> Result<Lesson, Problems> {
    if is_file_name(name) {
        return read_again(Path::new(name));
    }
    open(name)
}

/// Returns true if `name` names a file: it contains a `/` or ends in `.md`.
pub fn is_file_name(name: &str) -> bool {
    name.contains('/') || name.ends_with(".md")
}

/// Returns the name under which a session keeps the lesson `name`: the name of a shipped lesson, or the full path of a
/// file.
pub fn full_name(name: &str) -> String {
    match std::path::absolute(name) {
        Ok(path) if is_file_name(name) => path.display().to_string(),
        _ => name.to_owned(),
    }
}

/// Reads the lesson in the file at `path`. Files that the lesson opens are relative to its folder.
///
/// # Errors
///
/// Returns an error if the file cannot be read or parsed.
pub fn read_file(path: &Path) -> Result<Lesson, Problems> {
    let origin = path.display().to_string();
    let text = read_whole(path, LONGEST_LESSON_FILE, TOO_LONG)
        .map_err(|problem| Problems::one(origin.clone(), problem))?;
    let mut lesson = read(&origin, &text)?;
    if let Some(folder) = path.parent().filter(|folder| *folder != Path::new("")) {
        look_in(folder, &mut lesson);
    }
    Ok(lesson)
}

/// Reads a lesson like [`read_file`] while the lab waits.
///
/// # Errors
///
/// Returns an error for a file that could block, too.
pub fn read_again(path: &Path) -> Result<Lesson, Problems> {
    if Destination::may_wait(path) {
        let rule =
            "is not a regular file: the lab needs one, because it rereads a lesson that changes";
        let origin = path.display().to_string();
        return Err(Problems::one(origin, Problem::at("", rule)));
    }
    read_file(path)
}

/// Makes the relative paths that `lesson` opens relative to `folder`.
fn look_in(folder: &Path, lesson: &mut Lesson) {
    for block in lesson.pages.iter_mut().flat_map(|page| &mut page.blocks) {
        let (LessonBlock::Lab(setup) | LessonBlock::Task(setup)) = block else {
            continue;
        };
        for placed in &mut setup.commands {
            if let Command::Open(name) = &mut placed.command
                && presets::find(name).is_none()
            {
                *name = folder.join(&*name).display().to_string();
            }
        }
    }
}
