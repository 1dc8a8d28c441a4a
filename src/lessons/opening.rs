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

/// The longest file that is read as a lesson, bytes.
pub const LONGEST_LESSON_FILE: u64 = 1 << 20;
const TOO_LONG: &str = "is longer than 1 MiB, the most of a lesson";

/// Opens what NAME names: a shipped lesson, or else a file: one whose name holds a `/` or ends in `.md`.
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

/// The shipped lessons that were read, by their names: the list asks for all of them at every key.
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

/// As [`open`], where nothing may wait for a file.
pub fn open_again(name: &str) -> Result<Lesson, Problems> {
    if is_file_name(name) {
        return read_again(Path::new(name));
    }
    open(name)
}

/// Returns whether NAME names a file: it holds a `/` or ends in `.md`.
pub fn is_file_name(name: &str) -> bool {
    name.contains('/') || name.ends_with(".md")
}

/// Returns the name by which a session keeps the lesson that NAME names: that of a shipped lesson, or the full path of its
/// file.
pub fn full_name(name: &str) -> String {
    match std::path::absolute(name) {
        Ok(path) if is_file_name(name) => path.display().to_string(),
        _ => name.to_owned(),
    }
}

/// Reads the lesson in the file at `path`. The files that it opens are looked for in its folder.
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

/// As [`read_file`], while the lab waits: a file that could keep it waiting is refused.
pub fn read_again(path: &Path) -> Result<Lesson, Problems> {
    if Destination::may_wait(path) {
        let rule = "is not a regular file, which a lesson in the lab must be: it is read again whenever it changes";
        let origin = path.display().to_string();
        return Err(Problems::one(origin, Problem::at("", rule)));
    }
    read_file(path)
}

/// Makes the files that `lesson` opens files in `folder`, where they are not named from the root.
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
