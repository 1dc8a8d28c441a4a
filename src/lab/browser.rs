//! The browser: the list of presets and files, the filter, the selected entry and its preview.

use crate::engine::scenario::presets::PRESETS;
use crate::engine::scenario::{Document, Scenario};
use std::fs::File;
use std::io::Read;
use std::path::{Path, PathBuf};

/// The name of the entry that leads to the folder above.
const PARENT_FOLDER: &str = "../";

/// A preset or file that can be opened, or a folder of them.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct BrowserEntry {
    /// The name of the preset or the path of the file, as SCENARIO on the command line; that of a folder ends in `/`.
    pub name: String,
    pub is_file: bool,
    pub is_folder: bool,
}

#[derive(Debug, Default)]
pub struct Browser {
    entries: Vec<BrowserEntry>,
    /// The folder whose files are listed, the one whose files were listed first, and those through which the way led down.
    folder: PathBuf,
    first: PathBuf,
    passed: Vec<PathBuf>,
    /// Another folder, whose files are listed before those of the first.
    pub also: Option<PathBuf>,
    /// How many files of the folder are left out because they hold no run.
    pub others: usize,
    /// The name of the entry that is open in the lab.
    open: String,
    pub filter: String,
    pub selected: usize,
    preview: Option<(BrowserEntry, Preview)>,
}

/// The scenario of an entry, or why it cannot be opened.
pub type Preview = Result<Scenario, String>;

impl Browser {
    /// Lists presets, and the scenario, run and CSV files in `folder` for which `may_be_read` is true, with `name` selected.
    pub fn begin(&mut self, folder: &Path, name: &str, may_be_read: impl Fn(&Path) -> bool) {
        self.passed.clear();
        self.first = folder.to_owned();
        self.open = name.to_owned();
        self.filter.clear();
        self.list(folder, may_be_read);
        self.refilter();
    }

    /// Lists the files of the selected folder instead; where that is the one above, the folder from which the way led up is
    /// selected. Returns whether a folder was selected.
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

    /// Lists presets, and of `folder` the way up, folders and files, as far as `may_be_read` is true for them.
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

    /// Returns the folder whose files are listed, where that is not the first one.
    pub fn folder(&self) -> Option<&Path> {
        (self.folder != self.first).then_some(&self.folder)
    }

    /// Returns how many of all entries are files.
    pub fn files(&self) -> usize {
        self.entries.iter().filter(|entry| entry.is_file).count()
    }

    pub fn choice(&self) -> Option<&BrowserEntry> {
        self.shown().get(self.selected).copied()
    }

    pub fn preview(&self) -> Option<&Preview> {
        self.preview.as_ref().map(|(_, preview)| preview)
    }

    /// Selects the entry of this number among those that are shown.
    pub fn select(&mut self, row: usize) {
        self.shift(row as isize - self.selected as isize);
    }

    /// Moves the selection by `rows`; it stops at both ends.
    pub fn shift(&mut self, rows: isize) {
        let last = self.shown().len().saturating_sub(1);
        self.selected = self.selected.saturating_add_signed(rows).min(last);
        self.load_preview();
    }

    /// Changes the filter, and selects the first entry that is then shown. `/` begins a search in other panes: at the
    /// beginning it means nothing here.
    pub fn filter_by(&mut self, change: impl FnOnce(&mut String)) {
        change(&mut self.filter);
        self.filter = self.filter.trim_start_matches('/').to_owned();
        self.refilter();
    }

    /// Selects the first entry that is shown; without a filter, the one that is open.
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

/// Files beyond this many are not listed, nor are folders.
const MOST_FILES: usize = 1000;
/// How many bytes of a file are searched for its `[motion]`.
const PREVIEW_BYTES: u64 = 1 << 16;

/// Returns the paths of the entries of `folder` that are of a kind and have a name that is wanted, in the order of names.
fn names_in(
    folder: &Path,
    is_kind: fn(&Path) -> bool,
    is_wanted: impl Fn(&str) -> bool,
) -> Vec<String> {
    let Ok(entries) = std::fs::read_dir(folder) else {
        return Vec::new(); // a folder that cannot be read has nothing to offer
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

/// Returns whether the file `name` may hold a run: its beginning names `motion`, as a table or key of a scenario or in
/// the header of an exported CSV. A file that cannot be read counts too, the preview says why; and so does a long
/// scenario, in which a body of many points may stand before it.
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
