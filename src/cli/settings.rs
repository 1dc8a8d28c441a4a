//! The lab's settings without a command-line option: first the user's `config.toml`, then the choices made in the lab.

use super::args::{DisplayArgs, WorkbenchArgs};
use super::new_lab::variable;
use super::warn;
use crate::engine::scenario::Problems;
use crate::engine::text::printable::printable_lines;
use crate::lab::Lab;
use crate::lab::storage::settings::{self, SettingsFile};
use crate::lab::view::theme::Marker;
use crate::tui::theme::{self, ColorChoice};
use clap::ValueEnum;
use std::path::Path;
use toml::{Table, Value};

pub(super) struct Chosen {
    config: SettingsFile,
    remembered: SettingsFile,
}

/// Reads the settings remembered in `folder`, and the user's own unless the lab is confined to a folder.
pub(super) fn read(folder: Option<&Path>, is_confined: bool) -> Chosen {
    let config = settings::config().filter(|_| !is_confined);
    Chosen {
        config: config.map_or_else(SettingsFile::default, |path| settings::read_config(&path)),
        remembered: folder.map_or_else(SettingsFile::default, settings::read),
    }
}

impl Chosen {
    /// Returns `args` completed with the settings, where no option is given.
    pub(super) fn complete(&self, args: &WorkbenchArgs) -> WorkbenchArgs {
        let mut settings = shown_here(self.remembered.settings.clone());
        settings.extend(self.config.settings.clone());
        let value = |key: &str| settings.get(key);
        WorkbenchArgs {
            fps: args
                .fps
                .or_else(|| u32::try_from(value("fps")?.as_integer()?).ok()),
            look: DisplayArgs {
                color: args.look.color.or_else(|| option(value("color"))),
                background: args.look.background.or_else(|| option(value("background"))),
                markers: args.look.markers.or_else(|| option(value("marker"))),
                no_mouse: args.look.no_mouse || value("mouse") == Some(&Value::Boolean(false)),
            },
            ..args.clone()
        }
    }

    /// Reports errors in the files in `lab`. Errors in the user's file also appear on the shell's screen, in full,
    /// after the lab is closed.
    pub(super) fn tell(&self, lab: &mut Lab) {
        if let Some(problems) = &self.remembered.problems {
            let all = in_one_line(problems);
            lab.messages_mut()
                .keep_saying_first(&format!("{all}: ignored until you choose it again; "));
        }
        if let Some(problems) = &self.config.problems {
            warn(format_args!(
                "gyrolab: {}\ngyrolab: wrong settings are ignored; gyrolab man lists all settings",
                printable_lines(&problems.to_string())
            ));
            let all = in_one_line(problems);
            lab.messages_mut()
                .keep_saying_first(&format!("{all}: ignored; correct the file; "));
        }
    }
}

/// Joins all `problems` in one line, with the file's name but not its folder.
fn in_one_line(problems: &Problems) -> String {
    let name = Path::new(&problems.origin).file_name().unwrap_or_default();
    let named = Problems {
        origin: name.to_string_lossy().into_owned(),
        ..problems.clone()
    };
    let text = named.to_string();
    text.lines().collect::<Vec<_>>().join("; ")
}

/// Returns the remembered `settings` that this terminal can show. Dots chosen on another terminal may need more
/// abilities, and NO_COLOR disables colors.
fn shown_here(mut settings: Table) -> Table {
    let usual = theme::marker(variable);
    let is_shown = |choice: ColorChoice| match choice {
        ColorChoice::Auto | ColorChoice::Never => true,
        ColorChoice::Always => !theme::refuses_color(variable),
        ColorChoice::Palette(palette) => {
            !theme::refuses_color(variable) && palette <= theme::terminal_palette(variable)
        }
    };
    settings.retain(|key, value| match key {
        "marker" => option(Some(value)).is_some_and(|it: Marker| it.needs_no_more_than(usual)),
        "color" => option(Some(value)).is_some_and(is_shown),
        _ => true,
    });
    settings
}

/// Returns the option named by `value`, which the table of settings has checked.
fn option<T: ValueEnum>(value: Option<&Value>) -> Option<T> {
    T::from_str(value?.as_str()?, false).ok()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::engine::scenario::kind::ValueKind;
    use crate::lab::view::theme::Background;

    fn are_options<T: ValueEnum>(wanted: &str) -> bool {
        let mut rows = settings::SETTINGS_KEYS.iter();
        let row = rows.find(|row| row.path == wanted);
        let Some(ValueKind::OneOf(words)) = row.map(|row| row.kind) else {
            return false;
        };
        words
            .iter()
            .all(|word| option::<T>(Some(&(*word).into())).is_some())
            && words.len() == T::value_variants().len()
    }

    #[test]
    fn setting_values_are_valid_options_and_choices_of_the_lab() {
        assert!(are_options::<Marker>("marker"));
        assert!(are_options::<ColorChoice>("color"));
        assert!(are_options::<Background>("background"));
    }
}
