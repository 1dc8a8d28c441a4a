//! The settings of the lab that no option names: those of the user's `config.toml`, and after them those that were chosen in
//! the lab.

use super::args::{Look, WorkbenchArgs};
use super::new_lab::variable;
use super::tell;
use crate::lab::Lab;
use crate::lab::view::markers::Marker;
use crate::scenario::Problems;
use crate::storage::settings::{self, Read, Settings};
use crate::text::printable::printable_lines;
use crate::tui::surroundings;
use clap::ValueEnum;
use std::path::Path;

pub(super) struct Chosen {
    config: Read,
    remembered: Read,
}

/// Reads the settings: those remembered in `folder`, and the user's own unless the lab is confined to a folder.
pub(super) fn read(folder: Option<&Path>, is_confined: bool) -> Chosen {
    let config = settings::config().filter(|_| !is_confined);
    Chosen {
        config: config.map_or_else(Read::default, |path| settings::read_config(&path)),
        remembered: folder.map_or_else(Read::default, settings::read),
    }
}

impl Chosen {
    /// `args` with the settings for which it has no option.
    pub(super) fn complete(&self, args: &WorkbenchArgs) -> WorkbenchArgs {
        let remembered = shown_here(self.remembered.settings.clone());
        let settings = self.config.settings.clone().or(remembered);
        let mut args = args.clone();
        args.fps = args.fps.or(settings.fps);
        args.look = Look {
            color: args.look.color.or_else(|| option(settings.colour)),
            background: args.look.background.or_else(|| option(settings.background)),
            markers: args.look.markers.or_else(|| option(settings.marker)),
            no_mouse: args.look.no_mouse || settings.mouse == Some(false),
        };
        args
    }

    /// Says in `lab` what is wrong with the files, and of the user's also on the shell's screen, which shows all of it
    /// when the lab is left.
    pub(super) fn tell(&self, lab: &mut Lab) {
        if let Some(problems) = &self.remembered.problems {
            let all = in_one_line(problems);
            lab.tell_first(&format!("{all}: not used; a choice mends it; "));
        }
        if let Some(problems) = &self.config.problems {
            tell(format_args!(
                "gyrolab: {}\ngyrolab: what is wrong there is not used; gyrolab man lists the settings",
                printable_lines(&problems.to_string())
            ));
            let all = in_one_line(problems);
            lab.tell_first(&format!("{all}: not used; mend it; "));
        }
    }
}

/// All `problems` in one line, each with the file's name and no folder.
fn in_one_line(problems: &Problems) -> String {
    let name = Path::new(&problems.origin).file_name().unwrap_or_default();
    let named = Problems {
        origin: name.to_string_lossy().into_owned(),
        ..problems.clone()
    };
    let text = named.to_string();
    text.lines().collect::<Vec<_>>().join("; ")
}

/// The remembered `settings` that this terminal can show: dots that were chosen on another terminal may need more, and
/// NO_COLOR takes away colours that were chosen elsewhere.
fn shown_here(settings: Settings) -> Settings {
    let usual = surroundings::marker(variable);
    let can_be_shown = |name: &String| {
        let marker = Marker::ALL.into_iter().find(|marker| marker.name() == name);
        marker.is_some_and(|marker| marker.needs_no_more_than(usual))
    };
    let is_allowed =
        |colour: &String| colour != "always" || !surroundings::refuses_colour(variable);
    Settings {
        marker: settings.marker.filter(can_be_shown),
        colour: settings.colour.filter(is_allowed),
        ..settings
    }
}

/// The option called `name`, which the table of settings has checked.
fn option<T: ValueEnum>(name: Option<String>) -> Option<T> {
    T::from_str(&name?, false).ok()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lab::view::theme::Background;
    use crate::scenario::keys::Kind;
    use crate::tui::surroundings::ColourChoice;

    fn are_options<T: ValueEnum>(wanted: &str) -> bool {
        let row = settings::KEYS.iter().find(|(key, ..)| *key == wanted);
        let Some((_, Kind::OneOf(words), _)) = row else {
            return false;
        };
        let is_option = |word: &&str| option::<T>(Some((*word).to_owned())).is_some();
        words.iter().all(is_option) && words.len() == T::value_variants().len()
    }

    #[test]
    fn every_word_of_the_table_is_an_option_and_a_choice_of_the_lab() {
        assert!(are_options::<Marker>("marker"));
        assert!(are_options::<ColourChoice>("colour"));
        assert!(are_options::<Background>("background"));
    }
}
