//! The browser: the list of presets and files, its filter, the selected entry, and a preview of the entry.

use crate::engine::scenario::presets::PRESETS;
use crate::engine::scenario::{Document, Scenario};
use std::fs::File;
use std::io::Read;
use std::path::{Path, PathBuf};

/// The name of the entry for the parent folder.
const PARENT_FOLDER: &str = "../";

/// A preset or file that can be opened, or a folder.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct BrowserEntry {
    /// The name of the preset or the path of the file, as SCENARIO on the command line. The path of a folder ends in
    /// `/`.
    pub name: String,
    pub is_file: bool,
    pub is_folder: bool,
}

#[derive(Debug, Default)]
pub struct Browser {
    entries: Vec<BrowserEntry>,
    /// The listed folder. `first` is the folder listed first, and `passed` contains the folders on the way down from
    /// it.
    folder: PathBuf,
    first: PathBuf,
    passed: Vec<PathBuf>,
    /// Another folder. Its files are listed first, before the files of `first`.
    pub also: Option<PathBuf>,
    /// Number of files in the folder that are not listed because they contain no run.
    pub others: usize,
    /// The name of the entry that is open in the lab.
    open: String,
    pub filter: String,
    pub selected: usize,
    preview: Option<(BrowserEntry, Preview)>,
}

/// The scenario of an entry, or the reason why it cannot be opened.
pub type Preview = Result<Scenario, String>;

impl Browser {
    /// Lists presets, and the scenario, run and CSV files in `folder` that `may_be_read` admits. Selects `name`.
    pub fn begin(&mut self, folder: &Path, name: &str, may_be_read: impl Fn(&Path) -> bool) {
        self.passed.clear();
        self.first = folder.to_owned();
        self.open = name.to_owned();
        self.filter.clear();
        self.list(folder, may_be_read);
        self.refilter();
    }

    /// Lists the files of the selected folder instead. Returns false if no folder is selected or the parent cannot be
    /// found.
    ///
    /// If the selected folder is the parent, the folder that was left is selected in it.
    pub fn enter(&mut self, may_be_read: impl Fn(&Path) -> bool) -> bool {
        let chosen = self.choice().filter(|entry| entry.is_folder);
        let Some(name) = chosen.map(|entry| entry.name.clone()) else {
            return false;
        };
        let (is_up, from) = (name == PARENT_FOLDER, self.folder.clone());
        let to = if is_up {
            let Some(above) = self.passed.pop().or_else(|| above(&from)) else {
                return false;
            };
            above
        } else {
            self.passed.push(from.clone());
            PathBuf::from(name.trim_end_matches('/'))
        };
        self.list(&to, may_be_read);
        self.filter.clear();
        let came_from = std::fs::canonicalize(&from).unwrap_or(from);
        let mut of_folder = self.entries.iter().skip(PRESETS.len());
        let found = of_folder.position(|entry| {
            if is_up {
                Path::new(&entry.name).file_name() == came_from.file_name()
            } else {
                entry.name != PARENT_FOLDER
            }
        });
        let last = self.entries.len().saturating_sub(1);
        self.selected = (PRESETS.len() + found.unwrap_or(0)).min(last);
        self.load_preview();
        true
    }

    /// Lists presets, the parent of `folder`, and its subfolders and files, as far as `may_be_read` admits them.
    fn list(&mut self, folder: &Path, may_be_read: impl Fn(&Path) -> bool) {
        let mut folders = names_in(folder, Path::is_dir, |name| !name.starts_with('.'));
        folders.retain(|name| may_be_read(Path::new(name)));
        folders.iter_mut().for_each(|name| name.push('/'));
        if !self.passed.is_empty() || above(folder).is_some_and(|above| may_be_read(&above)) {
            folders.insert(0, PARENT_FOLDER.to_owned());
        }
        let also = self.also.as_deref().filter(|_| folder == self.first);
        let mut files = Vec::new();
        for listed in also.into_iter().chain([folder]) {
            files.extend(names_in(listed, Path::is_file, |name| {
                name.ends_with(".toml") || name.ends_with(".csv")
            }));
        }
        files.retain(|name| may_be_read(Path::new(name)));
        let all = files.len();
        files.retain(|name| may_hold_run(name));
        self.others = all - files.len();
        let presets = PRESETS.iter().map(|preset| preset.name.to_owned());
        self.entries = (presets.map(|name| (name, false, false)))
            .chain(folders.into_iter().map(|name| (name, false, true)))
            .chain(files.into_iter().map(|name| (name, true, false)))
            .map(|(name, is_file, is_folder)| BrowserEntry {
                name,
                is_file,
                is_folder,
            })
            .collect();
        self.folder = folder.to_owned();
        self.preview = None;
    }

    /// Returns the entries whose names contain each word of the filter.
    pub fn shown(&self) -> Vec<&BrowserEntry> {
        let filter = self.filter.to_lowercase();
        let mut shown: Vec<_> = self.entries.iter().collect();
        shown.retain(|entry| {
            let name = entry.name.to_lowercase();
            filter.split_whitespace().all(|word| name.contains(word))
        });
        shown
    }

    /// Returns the listed folder; `None` if it is the first one.
    pub fn folder(&self) -> Option<&Path> {
        (self.folder != self.first).then_some(&self.folder)
    }

    /// Returns the number of files among all entries.
    pub fn files(&self) -> usize {
        self.entries.iter().filter(|entry| entry.is_file).count()
    }

    pub fn choice(&self) -> Option<&BrowserEntry> {
        self.shown().get(self.selected).copied()
    }

    pub fn preview(&self) -> Option<&Preview> {
        self.preview.as_ref().map(|(_, preview)| preview)
    }

    /// Selects the listed entry with the index `row`.
    pub fn select(&mut self, row: usize) {
        self.shift(row as isize - self.selected as isize);
    }

    /// Moves the selection by `rows`. It stops at both ends.
    pub fn shift(&mut self, rows: isize) {
        let last = self.shown().len().saturating_sub(1);
        self.selected = self.selected.saturating_add_signed(rows).min(last);
        self.load_preview();
    }

    /// Changes the filter, and selects the first entry that matches. A leading `/` is ignored, because it starts a
    /// search in other panes.
    pub fn filter_by(&mut self, change: impl FnOnce(&mut String)) {
        change(&mut self.filter);
        self.filter = self.filter.trim_start_matches('/').to_owned();
        self.refilter();
    }

    /// Selects the first listed entry, or without a filter the entry that is open in the lab.
    fn refilter(&mut self) {
        let open = self
            .entries
            .iter()
            .position(|entry| entry.name == self.open);
        self.selected = open.filter(|_| self.filter.is_empty()).unwrap_or(0);
        self.load_preview();
    }

    fn load_preview(&mut self) {
        let choice = self.choice().cloned();
        if self.preview.as_ref().map(|(of, _)| of) == choice.as_ref() {
            return;
        }
        self.preview = choice.filter(|entry| !entry.is_folder).map(|entry| {
            let read = Document::open(&entry.name).and_then(|document| document.scenario());
            (entry, read.map_err(|problems| problems.to_string()))
        });
    }
}

/// Maximum number of files that are listed, and of folders.
const MOST_FILES: usize = 1000;
/// Number of bytes at the start of a file that are searched for `[motion]`.
const PREVIEW_BYTES: u64 = 1 << 16;

/// Returns the sorted paths of the entries of `folder` for which `is_kind` and `is_wanted` (of the name) are true.
fn names_in(
    folder: &Path,
    is_kind: fn(&Path) -> bool,
    is_wanted: impl Fn(&str) -> bool,
) -> Vec<String> {
    let Ok(entries) = std::fs::read_dir(folder) else {
        return Vec::new(); // an unreadable folder is shown as empty
    };
    let mut names: Vec<_> = entries
        .flatten()
        .filter(|entry| is_kind(&entry.path()))
        .filter_map(|entry| entry.file_name().into_string().ok())
        .filter(|name| is_wanted(name))
        .take(MOST_FILES)
        .map(|name| {
            if folder == Path::new(".") {
                name
            } else {
                folder.join(name).display().to_string()
            }
        })
        .collect();
    names.sort_unstable();
    names
}

fn above(folder: &Path) -> Option<PathBuf> {
    let full = std::fs::canonicalize(folder).ok()?;
    full.parent().map(Path::to_owned)
}

/// Returns true if the file `name` may contain a run.
///
/// This is so if its beginning names `motion`, as a table or key of a scenario or in the header of an exported CSV. A
/// file that cannot be read counts too: its preview says why. A long scenario also counts, because a body of many
/// points may come before `motion`.
fn may_hold_run(name: &str) -> bool {
    let mut head = Vec::new();
    let read = File::open(name).and_then(|file| file.take(PREVIEW_BYTES).read_to_end(&mut head));
    if read.is_err() || (head.len() as u64 == PREVIEW_BYTES && name.ends_with(".toml")) {
        return true;
    }
    let text = String::from_utf8_lossy(&head);
    text.lines().any(|line| {
        let begun = line.trim_start_matches(['#', ' ', '\t', '\u{feff}', '[']);
        let rest = begun.strip_prefix("motion").map(str::trim_start);
        rest.is_some_and(|rest| rest.starts_with([']', '.', '=']))
    })
}
