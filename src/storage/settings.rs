//! Settings of the lab that hold for every run: what dots are made of, colours, frames a second, the mouse.
//!
//! Two files hold them. `settings.toml` beside the sessions is the program's: it is written when the user chooses a setting
//! in the lab. `config.toml` in the configuration folder is the user's: it wins, and is never written. Both are checked as a
//! scenario is, by the table [`KEYS`]; a setting that breaks a rule is not used, the others are.

use super::session::{lock_folder, make_folder, own};
use crate::scenario::keys::Kind::{self, Flag, OneOf, Whole};
use crate::scenario::problem::nearest;
use crate::scenario::{Document, Problem, Problems};
use crate::text::printable::Shown;
use etcetera::{BaseStrategy, base_strategy::Xdg};
use std::io::ErrorKind;
use std::path::{Path, PathBuf};
use std::sync::mpsc::{self, Receiver, Sender};
use std::thread::{self, JoinHandle};
use std::time::{Duration, Instant};
use toml::{Table, Value};

/// The file that the program writes.
pub const FILE: &str = "settings.toml";

/// The first lines of that file.
const HEAD: &str = "# What was chosen in the lab. gyrolab writes this file; config.toml in the configuration folder is yours, and wins.\n";

/// A setting's key, what it may hold, and its meaning.
pub const KEYS: [(&str, Kind, &str); 5] = [
    (
        "marker",
        OneOf(&["braille", "half-block", "dot", "ascii"]),
        "what dots are made of",
    ),
    (
        "colour",
        OneOf(&["auto", "always", "never"]),
        "whether there are colours",
    ),
    (
        "background",
        OneOf(&["dark", "light"]),
        "what screen the colours are for",
    ),
    ("fps", Whole(1, 60), "frames a second at most"),
    ("mouse", Flag, "whether the lab takes the mouse"),
];

/// The settings that a file holds; `None` for those that it does not hold.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Settings {
    /// Name of the kind of dots.
    pub marker: Option<String>,
    /// `auto`, `always` or `never`.
    pub colour: Option<String>,
    /// `dark` or `light`.
    pub background: Option<String>,
    /// Frames a second at most, 1 to 60.
    pub fps: Option<u32>,
    /// Whether the lab takes the mouse.
    pub mouse: Option<bool>,
}

impl Settings {
    /// The settings of this file, and for those that it does not hold the ones of `other`.
    pub fn or(self, other: Self) -> Self {
        Self {
            marker: self.marker.or(other.marker),
            colour: self.colour.or(other.colour),
            background: self.background.or(other.background),
            fps: self.fps.or(other.fps),
            mouse: self.mouse.or(other.mouse),
        }
    }

    fn of(table: &Table) -> Self {
        let text = |key: &str| Some(table.get(key)?.as_str()?.to_owned());
        let fps = table.get("fps").and_then(Value::as_integer);
        Self {
            marker: text("marker"),
            colour: text("colour"),
            background: text("background"),
            fps: fps.and_then(|fps| u32::try_from(fps).ok()),
            mouse: table.get("mouse").and_then(Value::as_bool),
        }
    }
}

/// The settings of one file, and what is wrong with it.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Read {
    /// Those of its settings that break no rule.
    pub settings: Settings,
    /// What is wrong with the others.
    pub problems: Option<Problems>,
}

impl Read {
    fn broken(origin: String, rule: String) -> Self {
        Self {
            settings: Settings::default(),
            problems: Some(Problems::one(origin, Problem::at("", rule))),
        }
    }

    fn of(document: Result<Document, Problems>) -> Self {
        match document {
            Ok(document) => {
                let (good, found) = sifted(document.table());
                Self {
                    settings: Settings::of(&good),
                    problems: (!found.is_empty()).then(|| document.placed(found)),
                }
            }
            Err(problems) => Self {
                settings: Settings::default(),
                problems: Some(problems),
            },
        }
    }
}

/// The settings in `table` that break no rule, and what is wrong with the others.
fn sifted(table: &Table) -> (Table, Vec<Problem>) {
    let mut good = Table::new();
    let mut problems = Vec::new();
    for (key, value) in table {
        let name = match key.as_str() {
            "color" if !table.contains_key("colour") => "colour",
            other => other,
        };
        let Some((_, kind, _)) = KEYS.iter().find(|(known, ..)| *known == name) else {
            let near = nearest(key, KEYS.iter().map(|(known, ..)| *known));
            problems.push(Problem::at(key.clone(), format!("unknown key: {near}")));
            continue;
        };
        match kind.check(value) {
            Ok(()) => drop(good.insert(name.to_owned(), value.clone())),
            Err(rule) => problems.push(Problem::with_value(key.clone(), value, rule)),
        }
    }
    (good, problems)
}

/// The user's file: `$XDG_CONFIG_HOME/gyrolab/config.toml`, by default `~/.config/gyrolab/config.toml`; `None` where the
/// user has no home.
pub fn config() -> Option<PathBuf> {
    let folder = Xdg::new().ok()?.config_dir();
    let folder = folder.is_absolute().then_some(folder)?;
    Some(folder.join("gyrolab").join("config.toml"))
}

/// Reads the user's file at `path`, which may be a symbolic link; where there is none, there are no settings.
pub fn read_config(path: &Path) -> Read {
    match std::fs::metadata(path) {
        Ok(there) if there.is_file() => Read::of(Document::read(path)),
        Ok(_) => Read::broken(path.display().to_string(), "is not a file".to_owned()),
        Err(error) if error.kind() == ErrorKind::NotFound => Read::default(),
        Err(error) => Read::broken(
            path.display().to_string(),
            format!("cannot be read: {error}"),
        ),
    }
}

/// Reads the file that the program has written in `folder`, if it is the user's own; no symbolic link is followed.
pub fn read(folder: &Path) -> Read {
    let path = folder.join(FILE);
    let origin = path.display().to_string();
    match own::read(&path) {
        Ok(bytes) => Read::of(Document::read_from(&origin, &*bytes)),
        Err(error) if matches!(error.kind(), ErrorKind::NotFound | ErrorKind::NotADirectory) => {
            Read::default()
        }
        Err(error) => Read::broken(origin, format!("cannot be read: {error}")),
    }
}

/// Replaces the settings `chosen` in the file of `folder`, which is created if it does not exist. What is wrong in the
/// file is left out.
///
/// # Errors
/// Why it cannot be written; the file is then unchanged.
fn write(folder: &Path, chosen: &Table) -> Result<(), String> {
    let path = folder.join(FILE);
    let cannot = |reason: String| {
        let path = Shown(&path);
        format!("the choice cannot be remembered in {path}: {reason}")
    };
    make_folder(folder).map_err(|error| cannot(error.to_string()))?;
    let _lock = lock_folder(folder);
    let mut table = match own::read(&path) {
        // What is no TOML was reported when the lab was opened.
        Ok(bytes) => sifted(&toml::from_slice(&bytes).unwrap_or_default()).0,
        Err(error) if error.kind() == ErrorKind::NotFound => Table::new(),
        Err(error) => return Err(cannot(error.to_string())),
    };
    table.extend(chosen.clone());
    let text = table.to_string();
    own::replace(&path, &[HEAD, &text]).map_err(|error| cannot(error.to_string()))
}

/// Writes what the user chooses, in a thread of its own: a disk that hangs does not hold up the lab.
#[derive(Debug)]
pub struct Keeper {
    chosen: Option<Sender<(&'static str, Value)>>,
    trouble: Receiver<String>,
    thread: Option<JoinHandle<()>>,
}

impl Keeper {
    /// A keeper of the file in `folder`.
    ///
    /// # Errors
    /// When the system gives no thread.
    pub fn new(folder: PathBuf) -> std::io::Result<Self> {
        let (chosen, choices) = mpsc::channel::<(&'static str, Value)>();
        let (told, trouble) = mpsc::channel();
        let keep = move || {
            while let Ok((key, value)) = choices.recv() {
                let mut table = Table::from_iter([(key.to_owned(), value)]);
                table.extend(
                    choices
                        .try_iter()
                        .map(|(key, value)| (key.to_owned(), value)),
                );
                if let Err(reason) = write(&folder, &table) {
                    let _ = told.send(reason); // nobody to tell once the lab is closed
                }
            }
        };
        let thread = thread::Builder::new()
            .name("settings".to_owned())
            .spawn(keep)?;
        Ok(Self {
            chosen: Some(chosen),
            trouble,
            thread: Some(thread),
        })
    }

    /// Remembers that the setting `key` has the `value`.
    pub fn keep(&self, key: &'static str, value: impl Into<Value>) {
        if let Some(chosen) = &self.chosen {
            let _ = chosen.send((key, value.into())); // the thread lives as long as this
        }
    }

    /// Why a choice could not be remembered; each reason is given once.
    pub fn trouble(&self) -> Option<String> {
        self.trouble.try_iter().last()
    }

    /// Waits until everything is written, at most `patience`. Returns why the last choice could not be remembered.
    pub fn close(mut self, patience: Duration) -> Option<String> {
        self.chosen = None;
        let begin = Instant::now();
        let thread = self.thread.take()?;
        while !thread.is_finished() && begin.elapsed() < patience {
            thread::sleep(Duration::from_millis(2));
        }
        self.trouble()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::fs;
    use std::os::unix::fs::{PermissionsExt, symlink};

    fn kept(folder: &Path, choices: &[(&'static str, Value)]) -> Option<String> {
        let keeper = Keeper::new(folder.to_owned()).unwrap();
        for (key, value) in choices {
            keeper.keep(key, value.clone());
        }
        keeper.close(Duration::from_secs(20))
    }

    #[test]
    fn what_is_kept_is_read_again_and_is_the_users_alone() {
        let home = tempfile::tempdir().unwrap();
        let folder = home.path().join("gyrolab");
        assert_eq!(read(&folder), Read::default());
        let choices = [("marker", "dot".into()), ("mouse", false.into())];
        assert_eq!(kept(&folder, &choices), None);
        assert_eq!(kept(&folder, &[("marker", "ascii".into())]), None);
        let found = read(&folder);
        assert_eq!(found.problems, None);
        assert_eq!(found.settings.marker.as_deref(), Some("ascii"));
        assert_eq!(found.settings.mouse, Some(false));
        let file = folder.join(FILE);
        let mode = fs::metadata(&file).unwrap().permissions().mode();
        assert_eq!(mode & 0o777, 0o600);
        assert!(!folder.join("settings.toml.new").exists());
    }

    #[test]
    fn a_link_is_neither_read_nor_written_through() {
        let home = tempfile::tempdir().unwrap();
        let target = home.path().join("target");
        fs::write(&target, "marker = 'dot'\n").unwrap();
        symlink(&target, home.path().join(FILE)).unwrap();
        let found = read(home.path());
        assert_eq!(found.settings, Settings::default());
        assert!(
            found
                .problems
                .unwrap()
                .to_string()
                .contains("symbolic link")
        );
        let trouble = kept(home.path(), &[("marker", "ascii".into())]).unwrap();
        assert!(trouble.contains("symbolic link"), "{trouble}");
        assert_eq!(fs::read_to_string(&target).unwrap(), "marker = 'dot'\n");
        // The user's own file may be a link.
        let config = home.path().join("config.toml");
        symlink(&target, &config).unwrap();
        assert_eq!(read_config(&config).settings.marker.as_deref(), Some("dot"));
    }

    #[test]
    fn what_is_wrong_is_told_with_its_line_and_the_rest_is_used() {
        let home = tempfile::tempdir().unwrap();
        let path = home.path().join("config.toml");
        let text = "fps = 5\nmarkers = 'dot'\nbackground = 'gray'\nmouse = 1\n";
        fs::write(&path, text).unwrap();
        let found = read_config(&path);
        assert_eq!(found.settings.fps, Some(5));
        let told = found.problems.unwrap().to_string();
        for words in [
            "config.toml:2: markers: unknown key: did you mean marker?",
            "config.toml:3: background (\"gray\") must be",
            "config.toml:4: mouse (1) must be true or false",
        ] {
            assert!(told.contains(words), "{told}");
        }
        fs::write(&path, "fps = 5\nmarker = [\n").unwrap();
        let told = read_config(&path).problems.unwrap().to_string();
        assert!(told.contains("config.toml:"), "{told}");
        // A choice mends the program's own file.
        fs::write(home.path().join(FILE), text).unwrap();
        assert_eq!(kept(home.path(), &[("colour", "never".into())]), None);
        let found = read(home.path());
        assert_eq!((found.problems, found.settings.fps), (None, Some(5)));
    }
}
