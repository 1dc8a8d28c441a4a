//! The lessons of a lab: the list of them, the open one, and where the others were left.

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

#[derive(Debug, Default)]
pub struct Lessons {
    shown: LessonDialog,
    /// Where the lessons were left that are not open now, by their names.
    left: BTreeMap<String, LessonProgress>,
    /// Which lesson was selected when the list was closed.
    selected: usize,
    /// The time since the lab was opened.
    now: Duration,
    /// Whether the page is to be written again.
    has_changed: bool,
    kept: Table,
    /// The lessons of the folder that the lab is confined to, by the full paths of their files.
    own: Vec<String>,
    overlay: ClassOverlay,
}

#[derive(Debug, Default)]
enum LessonDialog {
    #[default]
    Nothing,
    /// The list of lessons, of which one is selected.
    List {
        /// Its number, from 0, among those that are listed.
        selected: usize,
        /// What is typed: only lessons that have it in their titles or names are listed.
        filter: String,
    },
    Lesson(Box<OpenLesson>),
}

#[derive(Debug, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct KeptLessons {
    pub open: Option<String>,
    #[serde(default)]
    pub lessons: BTreeMap<String, LessonProgress>,
}

impl KeptLessons {
    /// Returns what `kept`, a table of a session, says.
    pub fn read(kept: &Table) -> Result<Self, toml::de::Error> {
        kept.clone().try_into()
    }
}

/// Returns the full paths of the lessons in `folder`, sorted; hidden files and what cannot be read as a lesson are left
/// out.
pub fn files_in(folder: &Path) -> Vec<String> {
    let mut paths = Vec::new();
    for entry in std::fs::read_dir(folder).into_iter().flatten().flatten() {
        let Ok(name) = entry.file_name().into_string() else {
            continue;
        };
        let path = folder.join(&name);
        let is_meant = name.ends_with(".md") && !name.starts_with('.');
        // A FIFO would be waited for.
        if is_meant && path.is_file() && opening::read_again(&path).is_ok() {
            paths.push(path.display().to_string());
        }
    }
    paths.sort_unstable();
    paths
}

/// Says the first line of why a lesson could not be opened.
fn tell(opened: Result<(), String>, lab: &mut Lab) {
    if let Err(reason) = opened {
        lab.refuse(reason.lines().next().unwrap_or_default());
    }
}

impl Lessons {
    /// Returns the lessons as `kept` has them. The one that was open is opened again, on its page; the run is left where
    /// it is.
    ///
    /// # Errors
    /// Why the lesson that was open cannot be opened again; where it was left is kept.
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

    /// Returns what a session keeps of them: a [`KeptLessons`].
    pub fn kept(&self) -> &Table {
        &self.kept
    }

    /// Opens the lesson that NAME names, on the page `page` (from 1) or where it was left, and makes the lab stand there.
    pub fn open(&mut self, name: &str, page: Option<usize>, lab: &mut Lab) -> Result<(), String> {
        self.load(name, lab)?;
        if let LessonDialog::Lesson(open) = &mut self.shown {
            open.go_to(page, lab)?;
        }
        self.show(lab);
        lab.view_mut().turn_to_sheet();
        Ok(())
    }

    /// Returns whether the list of lessons is shown.
    pub fn is_listing(&self) -> bool {
        matches!(self.shown, LessonDialog::List { .. })
    }

    pub fn open_lesson(&self) -> Option<&OpenLesson> {
        match &self.shown {
            LessonDialog::Lesson(open) => Some(open),
            _ => None,
        }
    }

    /// Takes the lesson that NAME names, where it was left.
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

    /// Keeps where the lesson stands, and takes it no longer.
    fn leave(&mut self, lab: &mut Lab) {
        if let LessonDialog::Lesson(open) = std::mem::take(&mut self.shown) {
            let name = open.lesson.name.clone();
            self.left.insert(name, open.into_place());
            lab.set_undo_floor(false);
        }
        self.has_changed = true;
    }

    /// Does what `key` stands for. Returns the direction in which the page is to be scrolled, if that is what it means.
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
                let text =
                    "the lessons are closed: L lists them again, each stands where it was left";
                lab.refuse(text);
            }
            (_, LessonKey::Leave) => {
                lab.refuse("nothing is open on this page: L lists the lessons, q leaves");
            }
            (LessonDialog::List { selected, .. }, LessonKey::Move(direction)) => {
                let last = names.len().saturating_sub(1);
                *selected = selected.saturating_add_signed(direction.rows(10)).min(last);
            }
            (LessonDialog::List { selected, .. }, LessonKey::Take) => {
                let name = names.get(*selected).cloned();
                tell(name.map_or(Ok(()), |name| self.open(&name, None, lab)), lab);
            }
            (LessonDialog::List { .. }, _) => {
                lab.refuse("Enter opens the selected lesson, Esc closes the list");
            }
            (LessonDialog::Nothing, _) => lab.refuse("no lesson is open: L lists them"),
            (LessonDialog::Lesson(open), key) => scrolls = open.on_key(key, lab),
        }
        self.show(lab);
        if key == LessonKey::List {
            lab.view_mut().turn_to_sheet();
        }
        scrolls
    }

    /// Leaves the lesson for the list; it is selected there.
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

    /// Returns the names of the list: the lessons of the lab's folder, those that come with the program, then the files
    /// that were opened.
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

    /// Returns the names of the lessons that the list shows.
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

    /// Shows the page of `class`: the run is not touched, and the page's numbers are stated once the class has arrived.
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

    /// Takes `number` as the answer to the question that was asked last.
    pub fn answer(&mut self, number: f64, lab: &mut Lab) {
        if let LessonDialog::Lesson(open) = &mut self.shown {
            open.answer(number, lab);
        }
        self.show(lab);
    }

    /// Locks the answer that is chosen for the question `name`, as the vote of `round`, which is over; only if the open
    /// page is `page` of that lesson. Returns the answer in short.
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

    /// Brings the page up to date with the lab and the file; `now` is the time since the lab was opened.
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

    /// Returns how long the caller may wait until the page is looked at again; `None` where nothing waits.
    pub fn wait(&self) -> Option<Duration> {
        self.open_lesson().map(|_| Duration::from_secs(1))
    }

    /// Writes the sheet, and what the session keeps.
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
