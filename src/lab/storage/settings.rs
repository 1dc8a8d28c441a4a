//! Settings of the lab that apply to every run: markers, colors, frame rate, the mouse.
//!
//! They are stored in two files. `settings.toml`, in the folder of the sessions, belongs to the program, which writes
//! it when the user chooses a setting in the lab. `config.toml` in the configuration folder belongs to the user: it has
//! priority, and the program never writes it. Both are checked as a scenario is, against the table [`SETTINGS_KEYS`]. A
//! setting that breaks a rule is ignored, and the others are used.

use super::private_files;
use crate::engine::scenario::kind::ValueKind::{Flag, OneOf, Whole};
use crate::engine::scenario::schema::{Schema, SchemaRow, may};
use crate::engine::scenario::{Document, Problem, Problems};
use crate::engine::text::printable::PrintablePath;
use etcetera::{BaseStrategy, base_strategy::Xdg};
use std::fs::{self, File};
use std::io::{self, ErrorKind};
use std::path::{Path, PathBuf};
use toml::{Table, Value};

pub const SETTINGS_FILE: &str = "settings.toml";
/// Maximum size of a settings file, bytes.
const LONGEST_SETTINGS: usize = 1 << 20;

const SETTINGS_HEADER: &str = "# Choices made in the lab. gyrolab writes this file; config.toml in the configuration folder is yours, and takes priority.\n";

#[rustfmt::skip]
pub const SETTINGS_KEYS: &[SchemaRow] = &[
    may("marker", OneOf(&["braille", "octant", "half-block", "dot", "ascii"]), "characters with which dots are drawn"),
    may("color", OneOf(&["auto", "always", "never", "16", "256", "truecolor"]), "number of colors"),
    may("background", OneOf(&["dark", "light"]), "the background of the terminal"),
    may("fps", Whole(1, 60), "maximum frames per second"),
    may("mouse", Flag, "true if the lab uses the mouse"),
];

const SETTINGS_SCHEMA: Schema = Schema(&[SETTINGS_KEYS]);

/// The settings of one file, and the problems in it.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SettingsFile {
    /// The valid settings, under the keys of [`SETTINGS_KEYS`].
    pub settings: Table,
    pub problems: Option<Problems>,
}

/// Returns the settings of the file `path` with the content `read`. A missing file has no settings.
fn parse_settings(path: &Path, read: io::Result<Vec<u8>>) -> SettingsFile {
    let origin = path.display().to_string();
    let document = match read {
        Err(error) if matches!(error.kind(), ErrorKind::NotFound | ErrorKind::NotADirectory) => {
            return SettingsFile::default();
        }
        Ok(bytes) => Document::read_from(&origin, &*bytes),
        Err(error) => {
            let rule = format!("cannot be read: {error}");
            Err(Problems::one(origin, Problem::at("", rule)))
        }
    };
    match document {
        Ok(document) => {
            let (settings, found) = split_valid(document.table());
            let placed = found.or(()).map_err(|found| document.placed(found));
            SettingsFile {
                settings,
                problems: placed.err(),
            }
        }
        Err(problems) => SettingsFile {
            settings: Table::new(),
            problems: Some(problems),
        },
    }
}

/// Returns the valid settings in `table`, and the problems of the others.
fn split_valid(table: &Table) -> (Table, Problems) {
    let (mut good, mut problems) = (Table::new(), Problems::default());
    for (key, value) in table {
        let name = match key.as_str() {
            "colour" if !table.contains_key("color") => "color",
            other => other,
        };
        let setting = Table::from_iter([(name.to_owned(), value.clone())]);
        match SETTINGS_SCHEMA.check(&setting).or(setting) {
            Ok(setting) => good.extend(setting),
            // Report the problem at the key as spelled in the file.
            Err(found) => found.list.into_iter().for_each(|problem| {
                problems.add(|| Problem {
                    key: key.clone(),
                    ..problem
                });
            }),
        }
    }
    (good, problems)
}

/// Returns the user's file: `$XDG_CONFIG_HOME/gyrolab/config.toml`, by default `~/.config/gyrolab/config.toml`; `None`
/// if the user has no home folder.
pub fn config() -> Option<PathBuf> {
    let folder = Xdg::new().ok()?.config_dir();
    folder
        .is_absolute()
        .then(|| folder.join("gyrolab").join("config.toml"))
}

/// Reads the user's file at `path`, which may be a symbolic link.
pub fn read_config(path: &Path) -> SettingsFile {
    let bytes = match fs::metadata(path) {
        Ok(there) if !there.is_file() => Err(io::Error::other("it is not a file")),
        _ => File::open(path).and_then(|file| private_files::read_at_most(file, LONGEST_SETTINGS)),
    };
    parse_settings(path, bytes)
}

/// Reads the program's file in `folder`, if it belongs to the user. Symbolic links are not followed.
pub fn read(folder: &Path) -> SettingsFile {
    let path = folder.join(SETTINGS_FILE);
    parse_settings(&path, private_files::read(&path, LONGEST_SETTINGS))
}

/// Replaces the setting `key` in the file in `folder`, which is created if it does not exist. Invalid settings in the
/// file are dropped.
pub fn remember(folder: &Path, key: &str, value: Value) -> Result<(), String> {
    let path = folder.join(SETTINGS_FILE);
    let remembered = || -> io::Result<()> {
        private_files::make_folder(folder)?;
        let mut table = match private_files::read(&path, LONGEST_SETTINGS) {
            // Invalid TOML was reported when the lab was opened.
            Ok(bytes) => split_valid(&toml::from_slice(&bytes).unwrap_or_default()).0,
            Err(error) if error.kind() == ErrorKind::NotFound => Table::new(),
            Err(error) => return Err(error),
        };
        table.insert(key.to_owned(), value);
        private_files::replace(&path, &format!("{SETTINGS_HEADER}{table}"))
    };
    remembered().map_err(|error| {
        let path = PrintablePath(&path);
        format!("the choice cannot be saved in {path}: {error}")
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::os::unix::fs::symlink;

    #[test]
    fn symbolic_links_are_not_followed() {
        let home = tempfile::tempdir().unwrap();
        let target = home.path().join("target");
        fs::write(&target, "marker = 'dot'\n").unwrap();
        symlink(&target, home.path().join(SETTINGS_FILE)).unwrap();
        let found = read(home.path());
        assert!(found.settings.is_empty());
        let told = found.problems.unwrap().to_string();
        assert!(told.contains("symbolic link"), "{told}");
        let trouble = remember(home.path(), "marker", "ascii".into()).unwrap_err();
        assert!(trouble.contains("symbolic link"), "{trouble}");
        assert_eq!(fs::read_to_string(&target).unwrap(), "marker = 'dot'\n");
        // The user's own file may be a link.
        let config = home.path().join("config.toml");
        symlink(&target, &config).unwrap();
        assert_eq!(read_config(&config).settings["marker"], "dot".into());
    }
}
