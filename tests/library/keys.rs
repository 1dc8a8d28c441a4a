//! Keys: the footer, the settings dialog, the search in the help, and keys named in texts.

use crate::support::stage::{LARGE, SMALL, Stage};
use crate::support::words::has_all;
use gyrolab::lab::Mode;
use gyrolab::tui::keymap::{BINDINGS, Key};
use gyrolab::tui::panes;
use gyrolab::tui::panes::help::{HelpEntry, find_entries};
use std::fs;
use std::path::{Path, PathBuf};

fn footer(stage: &Stage) -> String {
    stage.picture().lines().last().unwrap().to_owned()
}

#[track_caller]
fn footer_begins(stage: &Stage, words: &str) {
    let footer = footer(stage);
    assert!(footer.starts_with(words), "{footer}");
}

#[test]
fn the_footer_shows_the_keys_of_a_pane_after_its_first_use() {
    let mut stage = Stage::open("method-2", &[], SMALL);
    stage.commands("pause = true");
    let first = " space run  . , step  p push  t exact  e edit  o open  L lessons  x CSV  ? help";
    footer_begins(&stage, first);
    stage.key(Key::Left);
    stage.wait(6.0);
    footer_begins(&stage, " Left cursor");
    has_all(&footer(&stage), ["space run", "L lessons", "? help"]);
    // From the values pane back to the run.
    let mut fresh = Stage::open("method-2", &[], SMALL);
    fresh.press("e");
    footer_begins(&fresh, " / find");
    fresh.key(Key::Esc);
    footer_begins(&fresh, " space pause  . , step");
}

#[test]
fn one_dialog_shows_all_settings_with_their_values() {
    let mut stage = Stage::open("method-2", &[], SMALL);
    stage.commands("pause = true").press("c");
    for words in [
        "verdict",
        "theory",
        "screen",
        "braille",
        "dark",
        "15 at most",
        "controls the lab",
    ] {
        stage.shows(words);
    }
    stage.press("↓↓↓→").shows("octant  𜴐").press("←←");
    stage.shows("ascii").shows_no("octant");
    stage.press("↓↓↓").press("\n").shows("30 at most");
    stage.press("\n").shows("2 at most").press("←");
    stage.shows("30 at most");
    assert_eq!(stage.lab.view().fps, 30);
    stage.lab.view_mut().fps = 12;
    stage.press("→").shows("15 at most");
    stage.lab.view_mut().fps = 12;
    stage.press("←").shows("10 at most").press("\u{1b}");
    stage.shows_no("at most");
}

#[test]
fn lesson_keys_work_only_with_an_open_lesson() {
    for key in ["n", "N", "b", "h", "\u{e}"] {
        Stage::open("method-2", &[], SMALL)
            .press(key)
            .shows("L lists the lessons");
        let mut stage = Stage::open("method-2", &[], LARGE);
        stage.lesson("is-the-wobble-real", 1);
        stage.wait(20.0).press("e").press(key);
        stage.shows_no("L lists the lessons");
    }
}

/// The letters that are not keys of the lab in any pane: candidates for a new key.
const FREE_LETTERS: &str = "lABCDEFGHIJKOQRTVY";

#[test]
fn the_list_of_free_letters_is_complete() {
    let keys = keys();
    let letters = ('a'..='z').chain('A'..='Z');
    let free: String = letters
        .filter(|letter| !keys.contains(&letter.to_string()))
        .collect();
    assert_eq!(
        free, FREE_LETTERS,
        "a key was added or removed: change FREE_LETTERS in tests/library/keys.rs"
    );
}

/// A letter and its capital are counterparts, or only one of them is a key.
#[test]
fn capitals_are_counterparts_of_their_letters() {
    const PAIRS: [char; 8] = ['m', 'n', 'p', 's', 'u', 'w', 'x', 'z'];
    let keys = keys();
    for letter in 'a'..='z' {
        let both = [letter, letter.to_ascii_uppercase()];
        let are_keys = both.iter().all(|key| keys.contains(&key.to_string()));
        assert_eq!(
            are_keys,
            PAIRS.contains(&letter),
            "{letter}: if its capital is its counterpart, add it to PAIRS in tests/library/keys.rs"
        );
    }
}

#[test]
fn lab_keys_work_in_every_pane() {
    const EVERYWHERE: &str = "space . , + - g r t i j d f Tab v y w [ ] z W Z Left Right < > ( ) | Enter \
        e / p P a u U o s S x X c L k ? q";
    let rows = BINDINGS.iter().filter(|row| row.modes.contains(&Mode::Lab));
    let bound: Vec<_> = rows
        .flat_map(|row| row.keys)
        .map(ToString::to_string)
        .collect();
    for key in EVERYWHERE.split_whitespace() {
        assert!(bound.contains(&key.to_owned()), "{key}");
    }
}

#[test]
fn an_unbound_key_says_where_it_works() {
    for (keys, said) in [
        ("n", "L lists the lessons"),
        ("!", "! does nothing here; ? lists the keys"),
        ("c\u{10}", "settings"),
    ] {
        Stage::open("method-2", &[], SMALL).press(keys).shows(said);
    }
    let mut stage = Stage::open("method-2", &[], SMALL);
    stage.key(Key::Backspace);
    stage.wait(0.0).shows("Backspace is a key of lists");
}

#[test]
fn all_lists_filter_by_typing_and_share_their_keys() {
    let selected = |stage: &Stage| {
        let picture = stage.picture();
        let line = picture.lines().find(|line| line.contains("> "));
        line.unwrap_or_else(|| panic!("{picture}")).to_owned()
    };
    for open in ["o", "L"] {
        let mut stage = Stage::open("method-2", &[], SMALL);
        stage.wait(1.0).press(open);
        stage.key(Key::Home);
        let first = selected(&stage);
        for (there, back) in [
            (Key::Down, Key::Up),
            (Key::Ctrl('n'), Key::Ctrl('p')),
            (Key::End, Key::Home),
            (Key::PageDown, Key::PageUp),
        ] {
            stage.key(there);
            stage.wait(0.0);
            assert_ne!(selected(&stage), first, "{open} {there}");
            stage.key(back);
            stage.wait(0.0);
            assert_eq!(selected(&stage), first, "{open} {back}");
        }
        // Letters that are keys of the lab are typed, and so is the space.
        stage.press("s t").shows("s t_").press("\u{1b}");
        stage.shows_no("s t_");
        stage.press("\u{1b}");
        assert!(stage.lab.mode() == Mode::Lab, "{open}");
    }
    let mut stage = Stage::open("method-2", &[], SMALL);
    stage
        .press("cback")
        .shows("background")
        .shows_no("frames per second");
    stage.press("\n").shows("light").press("\u{1b}");
    stage.shows("frames per second").press("\u{1b}");
    stage.shows_no("frames per second");
}

#[test]
fn the_help_finds_keys_by_synonyms() {
    for (search, key) in [
        ("speed", "+"),
        ("dt", "e"),
        ("mass", "e"),
        ("color", "c"),
        ("compare", "t"),
        ("compare", "i"),
        ("kick", "p"),
        ("screenshot", "X"),
    ] {
        let names: Vec<_> = find_entries(search).iter().map(HelpEntry::name).collect();
        let is_found = names.iter().any(|name| name.starts_with(key));
        assert!(is_found, "{search}: {names:?}");
    }
}

/// Returns the names of all keys of the lab.
fn keys() -> Vec<String> {
    let of_panes = panes::rows().flat_map(|pane| pane.keys);
    let rows = BINDINGS
        .iter()
        .chain(of_panes)
        .filter(|row| row.modes.contains(&Mode::Lab));
    rows.flat_map(|row| row.keys)
        .map(ToString::to_string)
        .collect()
}

/// Verbs that follow the name of a key, as in "m shows both again".
#[rustfmt::skip]
const VERBS: [&str; 26] = [
    "begins", "brings", "changes", "chooses", "counts", "does", "draws", "explains", "exports", "fills", "gives", "goes",
    "hides", "leaves", "lists", "makes", "moves", "opens", "pauses", "plays", "returns", "saves", "searches", "shows",
    "takes", "turns",
];
/// Phrases in which a letter of physics precedes such a verb.
const SYMBOLS: [&str; 2] = ["the arrow F shows", "R turns every"];

/// Returns the keys named in `text`: in backticks or parentheses, before a verb or colon, or in the first column of a list.
fn named(text: &str) -> Vec<String> {
    let text = SYMBOLS
        .iter()
        .fold(text.to_owned(), |text, symbol| text.replace(symbol, ""));
    let is_letter = |word: &str| word.len() == 1 && word.chars().all(|c| c.is_ascii_alphabetic());
    let words: Vec<_> = text.split_whitespace().collect();
    let mut named = Vec::new();
    for (at, word) in words.iter().enumerate() {
        let whole = word
            .trim_end_matches(['.', ',', ';', ':', ')'])
            .trim_start_matches('(');
        let bare = whole.trim_matches('`');
        let next = words
            .get(at + 1)
            .copied()
            .unwrap_or_default()
            .trim_matches([',', '.', ';']);
        let is_named = whole == format!("`{bare}`")
            || word.trim_end_matches(['.', ',', ';', ':']) == format!("({bare})")
            || word.ends_with(':')
            || (*word == bare && VERBS.contains(&next));
        if is_named && is_letter(bare) {
            named.push(bare.to_owned());
        }
    }
    let rows = text.lines().map(str::trim_start);
    let listed = rows
        .filter_map(|line| Some(line.split_once("    ")?.0))
        .filter(|key| is_letter(key));
    named.extend(listed.map(str::to_owned));
    named
}

fn files(folder: &Path, extension: &str) -> Vec<PathBuf> {
    let entries = fs::read_dir(folder)
        .unwrap()
        .map(|entry| entry.unwrap().path());
    let (folders, files): (Vec<_>, Vec<_>) = entries.partition(|path| path.is_dir());
    let below = folders
        .iter()
        .flat_map(|inner| self::files(inner, extension));
    files
        .into_iter()
        .filter(|path| path.extension().is_some_and(|end| end == extension))
        .chain(below)
        .collect()
}

#[test]
fn every_key_named_in_a_text_exists() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let read = |path: &PathBuf| fs::read_to_string(path).unwrap();
    let mut texts = vec![("README.md".to_owned(), read(&root.join("README.md")))];
    let mut add = |folder: &str, extension: &str| {
        for path in files(&root.join(folder), extension) {
            texts.push((path.display().to_string(), read(&path)));
        }
    };
    add("src/cli/topics", "txt");
    add("presets", "md");
    let (keys, mut count) = (keys(), 0);
    for (file, text) in &texts {
        for key in named(text) {
            assert!(keys.contains(&key), "{file} names the key {key}");
            count += 1;
        }
    }
    assert!(count > 100, "{count}");
    let text = "H hides it, (M) too; `k`: no; B: no";
    assert_eq!(named(text), ["H", "M", "k", "B"]);
}
