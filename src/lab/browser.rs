//! The list of presets and files: what there is, which of it the filter lets through, which is selected.

use super::preview::{Loader, Preview, read};
use crate::scenario::presets::PRESETS;
use crate::text::printable::is_steering;
use std::path::Path;
use std::sync::Arc;

/// Files beyond this many are not listed.
const MOST_FILES: usize = 1000;

/// Characters the filter holds at most.
pub(super) const MOST_TYPED: usize = 100;

/// What may be opened.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Entry {
    /// As SCENARIO on the command line: a preset's name, or a file's path.
    pub name: String,
    /// Whether it is a file.
    pub is_file: bool,
}

/// The browser's state.
#[derive(Debug, Default)]
pub struct Browser {
    entries: Vec<Entry>,
    /// What the lab has open.
    open: String,
    filter: String,
    selected: usize,
    /// The selected entry, and what it holds.
    preview: Option<(Entry, Preview)>,
    loader: Loader,
}

impl Browser {
    /// Presets, and the scenario, run and CSV files in `folder`, with `name` selected.
    pub fn new(folder: &Path, name: &str) -> Self {
        let mut browser = Self::default();
        browser.begin(folder, name, |_| true);
        browser
    }

    /// Lists what there is anew, as [`new`](Self::new) does, of the files only those that `may_be_read`.
    pub fn begin(&mut self, folder: &Path, name: &str, may_be_read: impl Fn(&Path) -> bool) {
        let presets = PRESETS.iter().map(|preset| Entry {
            name: preset.name.to_owned(),
            is_file: false,
        });
        let mut names = files(folder);
        names.retain(|name| may_be_read(Path::new(name)));
        let files = names.into_iter().map(|name| Entry {
            name,
            is_file: true,
        });
        self.entries = presets.chain(files).collect();
        self.open = name.to_owned();
        self.filter.clear();
        self.preview = None;
        self.refilter();
    }

    /// The entries the filter lets through.
    pub fn shown(&self) -> Vec<&Entry> {
        let wanted = self.filter.to_lowercase();
        self.entries
            .iter()
            .filter(|entry| entry.name.to_lowercase().contains(&wanted))
            .collect()
    }

    /// How many of all entries are files.
    pub fn files(&self) -> usize {
        self.entries.iter().filter(|entry| entry.is_file).count()
    }

    /// The place of the selected one among them.
    pub fn selected(&self) -> usize {
        self.selected
    }

    /// The selected entry.
    pub fn choice(&self) -> Option<&Entry> {
        self.shown().get(self.selected).copied()
    }

    /// What the selected entry holds, as far as that is known.
    pub fn preview(&self) -> Option<&Preview> {
        self.preview.as_ref().map(|(_, preview)| preview)
    }

    /// Whether the selected entry is still being read.
    pub fn is_loading(&self) -> bool {
        matches!(self.preview(), Some(Preview::Loading))
    }

    /// Takes what has been found out about the selected entry since; gives whether there was anything.
    pub fn take_news(&mut self) -> bool {
        match (&mut self.preview, self.loader.news()) {
            (Some((_, preview @ Preview::Loading)), Some(news)) => {
                *preview = news;
                true
            }
            _ => false,
        }
    }

    /// The filter as it is typed.
    pub fn filter(&self) -> &str {
        &self.filter
    }

    /// Moves the selection by `rows`, no further than the ends.
    pub fn shift(&mut self, rows: isize) {
        let last = self.shown().len().saturating_sub(1);
        self.selected = self.selected.saturating_add_signed(rows).min(last);
        self.load_preview();
    }

    /// Adds a character to the filter, if it has room.
    pub fn type_char(&mut self, typed: char) {
        self.paste(typed.encode_utf8(&mut [0; 4]));
    }

    /// Adds `text` to the filter, as far as it has room; gives whether it had.
    pub fn paste(&mut self, text: &str) -> bool {
        let typed = text.chars().filter(|&c| !is_steering(c));
        let room = MOST_TYPED.saturating_sub(self.filter.chars().count());
        let is_cut = typed.clone().nth(room).is_some();
        self.filter.extend(typed.take(room));
        self.refilter();
        !is_cut
    }

    /// Takes the filter's last character away.
    pub fn erase(&mut self) {
        self.filter.pop();
        self.refilter();
    }

    /// Lets everything through again.
    pub fn clear_filter(&mut self) {
        self.filter.clear();
        self.refilter();
    }

    /// Selects the first that the filter lets through; without a filter what is open.
    fn refilter(&mut self) {
        let open = match self.filter.is_empty() {
            true => self
                .entries
                .iter()
                .position(|entry| entry.name == self.open),
            false => None,
        };
        self.selected = open.unwrap_or(0);
        self.load_preview();
    }

    fn load_preview(&mut self) {
        let choice = self.choice().cloned();
        if self.preview.as_ref().map(|(of, _)| of) == choice.as_ref() {
            return;
        }
        self.preview = choice.map(|entry| {
            let preview = match entry.is_file {
                true => self.loader.ask(&entry.name),
                false => Preview::Known(Arc::new(read(&entry.name))),
            };
            (entry, preview)
        });
    }
}

/// What SCENARIO would name the files in `folder` that may hold a scenario, in the order of their names.
fn files(folder: &Path) -> Vec<String> {
    let Ok(entries) = std::fs::read_dir(folder) else {
        return Vec::new(); // a folder that cannot be read has nothing to offer
    };
    let mut names: Vec<_> = entries
        .flatten()
        .filter(|entry| entry.path().is_file())
        .filter_map(|entry| entry.file_name().into_string().ok())
        .filter(|name| name.ends_with(".toml") || name.ends_with(".csv"))
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
