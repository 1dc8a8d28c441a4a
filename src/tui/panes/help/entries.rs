//! The entries of the help: every key, grouped by its purpose, and every word of the glossary. And the search among
//! them.

use crate::lab::Mode;
use crate::lab::action::Action;
use crate::lab::view::Pane;
use crate::tui::keymap::{BINDINGS, Binding};
use crate::tui::panes::PANES;

/// The words that the lab uses, each in one sentence: those of the motion first, then those of the numbers and of the screen.
const GLOSSARY: &str = include_str!("glossary.txt");

/// A key, or several that mean the same; or a word of the glossary.
#[derive(Clone, Copy, Debug)]
pub struct Entry {
    /// The heading under which it stands.
    pub group: &'static str,
    /// The pane whose key it is; `None` for a key that every pane has, and for a word.
    pub pane: Option<Pane>,
    /// Its key; `None` for a word.
    pub binding: Option<&'static Binding>,
    /// A word, or what the footer says of a key.
    short: &'static str,
    /// What it does, or means.
    pub text: &'static str,
}

const PLAY: &str = "play";
const LOOK: &str = "look";
const CHANGE: &str = "change the values";
const PUSH: &str = "push";
const KEEP: &str = "keep and export";
const OPEN: &str = "open another run";
const LEAVE: &str = "help, close, leave";
/// The groups of the keys of the lab, in order.
const PURPOSES: [&str; 7] = [PLAY, LOOK, CHANGE, PUSH, KEEP, OPEN, LEAVE];
/// The groups of the keys of other modes, in order.
const PLACES: [(Mode, &str); 5] = [
    (Mode::Browser, "in the list of presets and files"),
    (Mode::Filter, "while a part of a name is typed"),
    (Mode::Find, "while a value is searched for"),
    (Mode::Help, "in this list"),
    (Mode::Dialog, "in a dialog"),
];
const WORDS: &str = "words";

impl Entry {
    pub fn name(&self) -> String {
        self.binding.map_or(self.short.to_owned(), |binding| {
            let keys: Vec<_> = binding.keys.iter().map(ToString::to_string).collect();
            keys.join(" ")
        })
    }

    /// How well it matches `search`, of which `lower` is the lower case: 0 is the best match; `None` where it does not
    /// match.
    fn answers(&self, search: &str, lower: &str) -> Option<u8> {
        let keys = self.binding.map_or(&[][..], |binding| binding.keys);
        let is_key =
            |wanted: &dyn Fn(String) -> bool| keys.iter().any(|key| wanted(key.to_string()));
        if is_key(&|key| key == search) {
            return Some(0);
        }
        let short = self.short.to_lowercase();
        if short == lower || is_key(&|key| key.to_lowercase() == lower) {
            return Some(1);
        }
        if short.starts_with(lower) {
            return Some(2);
        }
        let further = self.binding.map_or("", |binding| binding.search);
        let all = format!("{} {short} {} {further}", self.name(), self.text).to_lowercase();
        let is_word = |wanted: &str| {
            let mut words = all.split(|c: char| !c.is_alphanumeric());
            words.any(|word| word.starts_with(wanted))
        };
        let mut wanted = lower.split_whitespace();
        if wanted.clone().all(is_word) {
            return Some(3);
        }
        if wanted.clone().all(|word| all.contains(word)) {
            return Some(4);
        }
        let group = self.group.to_lowercase();
        let is_there = |word: &str| all.contains(word) || group.contains(word);
        wanted.all(is_there).then_some(5)
    }
}

/// Every word with its meaning.
fn glossary() -> impl Iterator<Item = (&'static str, &'static str)> {
    let lines = GLOSSARY.lines();
    lines.filter_map(|line| line.split_once(" = "))
}

/// Every entry, group by group.
pub fn entries() -> Vec<Entry> {
    let of_mode = |(mode, group)| {
        let rows = BINDINGS.iter().filter(move |row| row.modes[0] == mode);
        let rows = rows.filter(move |row| mode != Mode::Lab || purpose(row.action) == group);
        rows.map(move |row| key(group, None, row))
    };
    let of_lab = PURPOSES.map(|group| (Mode::Lab, group)).into_iter();
    let of_pane = PANES.iter().flat_map(|pane| {
        let rows = pane.keys.iter();
        rows.map(|row| key(pane.title, Some(pane.id), row))
    });
    let words = glossary().map(|(word, meaning)| Entry {
        group: WORDS,
        pane: None,
        binding: None,
        short: word,
        text: meaning,
    });
    let keys = of_lab.flat_map(of_mode).chain(of_pane);
    keys.chain(words)
        .chain(PLACES.into_iter().flat_map(of_mode))
        .collect()
}

/// The entries that match `search`, the best match first; if it is empty, all entries, group by group.
pub fn found(search: &str) -> Vec<Entry> {
    let (search, mut found) = (search.trim(), entries());
    if search.is_empty() {
        return found;
    }
    let lower = search.to_lowercase();
    let rank = |entry: &Entry| entry.answers(search, &lower);
    found.retain(|entry| rank(entry).is_some());
    found.sort_by_key(rank); // stable: among equals the order of the groups
    found
}

fn key(group: &'static str, pane: Option<Pane>, binding: &'static Binding) -> Entry {
    Entry {
        group,
        pane,
        binding: Some(binding),
        short: binding.footer,
        text: binding.help,
    }
}

/// The group of the key of `action` in the lab: its purpose.
fn purpose(action: Action) -> &'static str {
    use Action as A;
    match action {
        A::TogglePause | A::Step | A::StepBack | A::Faster | A::Slower | A::GoTo | A::Restart => {
            PLAY
        }
        A::Parameters | A::Edit | A::FindValue | A::Undo | A::Redo => CHANGE,
        A::Move(_) | A::MoveFar(_) => CHANGE,
        A::Push | A::ChoosePush => PUSH,
        A::Export | A::Figure | A::SaveRun | A::SavePresent => KEEP,
        A::Browse => OPEN,
        A::Help | A::Close | A::Redraw | A::Suspend | A::Quit => LEAVE,
        _ => LOOK,
    }
}
