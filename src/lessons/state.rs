//! The lessons of a lab: their list, the open one, and the progress in the others.

use super::open_lesson::{ClassPage, OpenLesson};
use super::page::ClassOverlay;
use super::predictions::LessonProgress;
use super::{opening, page, shipped};
use crate::lab::Lab;
use crate::lab::action::{Direction, LessonKey};
use crate::lab::form::edit_line;
use crate::lab::sheet::Sheet;
use crate::lab::storage::confined::Confined;
use crate::lab::values::list::Match;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::path::Path;
use std::time::Duration;
use toml::Table;

/// The lessons of a lab.
#[derive(Debug, Default)]
pub struct Lessons {
    shown: LessonDialog,
    /// Progress in the lessons that are not open now, by their names.
    left: BTreeMap<String, LessonProgress>,
    /// Selected row when the list was closed.
    selected: usize,
    /// Time since the lab was opened.
    now: Duration,
    /// True if the page must be rewritten.
    has_changed: bool,
    /// Lessons as the session keeps them: a [`KeptLessons`].
    kept: Table,
    /// Lessons in the folder that the lab is confined to, by the full paths of their files.
    own: Vec<String>,
    overlay: ClassOverlay,
}

#[derive(Debug, Default)]
enum LessonDialog {
    #[default]
    Nothing,
    /// The list of lessons.
    List {
        /// Selected row of the filtered list, from 0.
        selected: usize,
        /// Typed filter: only lessons with this text in their titles or names are listed.
        filter: String,
    },
    Lesson(Box<OpenLesson>),
}

/// The lessons in a session file.
#[derive(Debug, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct KeptLessons {
    pub open: Option<String>,
    #[serde(default)]
    pub lessons: BTreeMap<String, LessonProgress>,
}

impl KeptLessons {
    /// Parses `kept`, a table of a session.
    ///
    /// # Errors
    ///
    /// Returns an error if the table has another form.
    pub fn read(kept: &Table) -> Result<Self, toml::de::Error> {
        kept.clone().try_into()
    }
}

/// Returns the full paths of the lessons in `folder`, sorted. Hidden files and files that are not lessons are omitted.
pub fn files_in(folder: &Path) -> Vec<String> {
    let mut paths = Vec::new();
    for entry in std::fs::read_dir(folder).into_iter().flatten().flatten() {
        let Ok(name) = entry.file_name().into_string() else {
            continue;
        };
        let path = folder.join(&name);
        let is_meant = name.ends_with(".md") && !name.starts_with('.');
        // Reading a FIFO would block.
        if is_meant && path.is_file() && opening::read_again(&path).is_ok() {
            paths.push(path.display().to_string());
        }
    }
    paths.sort_unstable();
    paths
}

/// Shows the first line of the reason why a lesson could not be opened.
fn report_error(opened: Result<(), String>, lab: &mut Lab) {
    if let Err(reason) = opened {
        lab.refuse(reason.lines().next().unwrap_or_default());
    }
}

impl Lessons {
    /// Returns the lessons as `kept` has them. The open lesson is opened again on its page, without changing the run.
    ///
    /// # Errors
    ///
    /// The second value is an error if that lesson cannot be opened. Its progress is kept.
    pub fn resumed(kept: Table, lab: &mut Lab) -> (Self, Result<(), String>) {
        let read = KeptLessons::read(&kept);
        let mut lessons = Self {
            kept,
            ..Self::default()
        };
        let Ok(KeptLessons {
            open,
            lessons: left,
        }) = read
        else {
            return (lessons, Ok(()));
        };
        lessons.left = left;
        let opened = open.map_or(Ok(()), |name| lessons.load(&name, lab));
        if !lessons.kept.is_empty() {
            lessons.show(lab);
        }
        (lessons, opened)
    }

    /// Returns the lessons as a session keeps them: a [`KeptLessons`].
    pub fn kept(&self) -> &Table {
        &self.kept
    }

    /// Opens the lesson `name` on page `page` (from 1) or on the page where it was left, and brings the lab to its
    /// state.
    ///
    /// # Errors
    ///
    /// Returns an error if the lesson cannot be opened, the page does not exist, or an earlier page cannot be carried
    /// out.
    pub fn open(&mut self, name: &str, page: Option<usize>, lab: &mut Lab) -> Result<(), String> {
        self.load(name, lab)?;
        if let LessonDialog::Lesson(open) = &mut self.shown {
            open.go_to(page, lab)?;
        }
        self.show(lab);
        lab.view_mut().turn_to_sheet();
        Ok(())
    }

    /// Returns true if the list of lessons is shown.
    pub fn is_listing(&self) -> bool {
        matches!(self.shown, LessonDialog::List { .. })
    }

    pub fn open_lesson(&self) -> Option<&OpenLesson> {
        match &self.shown {
            LessonDialog::Lesson(open) => Some(open),
            _ => None,
        }
    }

    /// Loads the lesson `name` with its progress.
    fn load(&mut self, name: &str, lab: &mut Lab) -> Result<(), String> {
        let name = opening::full_name(name);
        if opening::is_file_name(&name) {
            lab.files().admit_reading(Path::new(&name))?;
        }
        let lesson = opening::open_again(&name).map_err(|problems| problems.to_string())?;
        self.leave(lab);
        let place = self.left.remove(&lesson.name).unwrap_or_default();
        let mut open = OpenLesson::new(lesson, place, self.now);
        open.resume_page(lab);
        self.shown = LessonDialog::Lesson(Box::new(open));
        Ok(())
    }

    /// Closes the open lesson and keeps its progress.
    fn leave(&mut self, lab: &mut Lab) {
        if let LessonDialog::Lesson(open) = std::mem::take(&mut self.shown) {
            let name = open.lesson.name.clone();
            self.left.insert(name, open.into_place());
            lab.set_undo_floor(false);
        }
        self.has_changed = true;
    }

    /// Handles `key`. Returns the direction in which the page must scroll, if any.
    pub fn on_key(&mut self, key: LessonKey, lab: &mut Lab) -> Option<Direction> {
        let mut scrolls = None;
        let names = self.listed();
        match (&mut self.shown, key) {
            (LessonDialog::List { .. }, LessonKey::List) => {}
            (_, LessonKey::List) => self.open_list(lab),
            (LessonDialog::List { selected, filter }, LessonKey::Filter(edit)) => {
                edit_line(filter, edit);
                *selected = 0;
            }
            (LessonDialog::List { selected, filter }, LessonKey::Leave) if !filter.is_empty() => {
                filter.clear();
                *selected = 0;
            }
            (LessonDialog::List { selected, .. }, LessonKey::Select(row)) => *selected = row,
            (LessonDialog::List { selected, .. }, LessonKey::Leave) => {
                self.selected = *selected;
                self.shown = LessonDialog::Nothing;
                let text = "lessons closed; press L to reopen each where you left it";
                lab.refuse(text);
            }
            (_, LessonKey::Leave) => {
                lab.refuse("nothing to close; L lists the lessons, q quits");
            }
            (LessonDialog::List { selected, .. }, LessonKey::Move(direction)) => {
                let last = names.len().saturating_sub(1);
                *selected = selected.saturating_add_signed(direction.rows(10)).min(last);
            }
            (LessonDialog::List { selected, .. }, LessonKey::Take) => {
                let name = names.get(*selected).cloned();
                report_error(name.map_or(Ok(()), |name| self.open(&name, None, lab)), lab);
            }
            (LessonDialog::List { .. }, _) => {
                lab.refuse("Enter opens the selected lesson, Esc closes the list");
            }
            (LessonDialog::Nothing, _) => lab.refuse("no lesson is open; press L to list them"),
            (LessonDialog::Lesson(open), key) => scrolls = open.on_key(key, lab),
        }
        self.show(lab);
        if key == LessonKey::List {
            lab.view_mut().turn_to_sheet();
        }
        scrolls
    }

    /// Closes the lesson and opens the list, in which the lesson is selected.
    fn open_list(&mut self, lab: &mut Lab) {
        let here = self.open_lesson().map(|open| open.lesson.name.clone());
        self.leave(lab);
        let folder = lab.files().confined().map(Confined::lessons);
        self.own = folder.map(files_in).unwrap_or_default();
        let mut names = self.names().into_iter();
        let selected = names.position(|name| Some(name) == here);
        self.shown = LessonDialog::List {
            selected: selected.unwrap_or(self.selected),
            filter: String::new(),
        };
    }

    /// Returns the names in the list: lessons in the lab's folder, shipped lessons, then files that were opened.
    fn names(&self) -> Vec<String> {
        let mut names = self.own.clone();
        names.extend(shipped::LESSONS.iter().map(|lesson| lesson.name.to_owned()));
        for name in self.left.keys() {
            if !names.contains(name) {
                names.push(name.clone());
            }
        }
        names
    }

    /// Returns the names of the lessons that match the filter.
    fn listed(&self) -> Vec<String> {
        let mut names = self.names();
        if let LessonDialog::List { filter, .. } = &self.shown
            && !filter.is_empty()
        {
            names.retain(|name| {
                let lesson = opening::open_again(name).ok();
                let title = lesson.map_or(String::new(), |lesson| lesson.title);
                Match::find(&format!("{title} {name}"), filter).is_some()
            });
        }
        names
    }

    pub fn set_overlay(&mut self, overlay: ClassOverlay, lab: &mut Lab) {
        if let LessonDialog::Lesson(open) = &mut self.shown {
            open.was_asked |= overlay.is_of_teacher;
            open.rounds.clone_from(&overlay.rounds);
            if !overlay.is_followed {
                open.leave_class();
            }
        }
        if self.overlay != overlay {
            self.overlay = overlay;
            self.show(lab);
        }
    }

    /// Shows the page of `class` without changing the run. The page's numbers are stated once the class's run has
    /// arrived.
    pub fn show_class_page(&mut self, class: &ClassPage<'_>, lab: &mut Lab) -> Result<(), String> {
        if self
            .open_lesson()
            .is_none_or(|open| open.lesson.name != class.lesson)
        {
            self.load(class.lesson, lab)?;
        }
        if let LessonDialog::Lesson(open) = &mut self.shown
            && open.show_class_page(class)
        {
            self.show(lab);
            lab.view_mut().turn_to_sheet();
        }
        Ok(())
    }

    /// Locks `number` as the answer to the last question asked.
    pub fn answer(&mut self, number: f64, lab: &mut Lab) {
        if let LessonDialog::Lesson(open) = &mut self.shown {
            open.answer(number, lab);
        }
        self.show(lab);
    }

    /// Locks the chosen answer to the question `name` as the vote of `round`, which is over, if `page` of that lesson
    /// is open. Returns the answer in short.
    pub fn lock_chosen(
        &mut self,
        (lesson, page): (&str, usize),
        name: &str,
        round: u32,
        lab: &mut Lab,
    ) -> Option<String> {
        let LessonDialog::Lesson(open) = &mut self.shown else {
            return None;
        };
        let is_here = (open.lesson.name.as_str(), open.place.page) == (lesson, page);
        let locked = is_here.then(|| open.lock_chosen(name, round, lab))??;
        self.show(lab);
        Some(locked)
    }

    /// Updates the page after changes of the lab or the file. `now` is the time since the lab was opened.
    pub fn update(&mut self, now: Duration, lab: &mut Lab) {
        let second = now.as_secs() != self.now.as_secs();
        self.now = now;
        let LessonDialog::Lesson(open) = &mut self.shown else {
            if self.has_changed {
                self.show(lab);
            }
            return;
        };
        let is_new = open.update(now, lab);
        if is_new || self.has_changed || lab.has_changed() || (second && open.shows_notes) {
            self.show(lab);
        }
    }

    /// Returns how long the caller may wait before the next update, or `None` if no lesson is open.
    pub fn wait(&self) -> Option<Duration> {
        self.open_lesson().map(|_| Duration::from_secs(1))
    }

    /// Writes the sheet, and the table for the session.
    fn show(&mut self, lab: &mut Lab) {
        self.has_changed = false;
        let sheet = self.sheet(lab);
        lab.set_sheet(sheet);
        self.kept = Table::try_from(self.to_keep()).unwrap_or_default();
    }

    fn sheet(&mut self, lab: &Lab) -> Option<Sheet> {
        let names = self.listed();
        match &mut self.shown {
            LessonDialog::Nothing => self.overlay.instead.clone().map(page::alone),
            LessonDialog::List { selected, filter } => Some(page::list(
                &names,
                filter,
                *selected,
                &self.left,
                &self.overlay,
            )),
            LessonDialog::Lesson(open) => Some(page::sheet(open, &self.overlay, self.now, lab)),
        }
    }

    fn to_keep(&self) -> KeptLessons {
        let mut lessons = self.left.clone();
        let open = self.open_lesson().map(|open| {
            let name = open.lesson.name.clone();
            lessons.insert(name.clone(), open.place.clone());
            name
        });
        KeptLessons { open, lessons }
    }
}
