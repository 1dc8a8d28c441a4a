//! The sections of the manual about the lab: its keys, its files of commands, its settings. Each is made of the table that
//! the lab itself goes by.

use super::roff::plain;
use crate::lab::command::COMMANDS;
use crate::scenario::keys::Kind;
use crate::storage::settings;
use crate::tui::panes::help;

/// The manual's section about the keys of the lab, those of each purpose, pane and place under its name.
pub(super) fn keys_page() -> String {
    let entries = help::entries();
    let keys: Vec<_> = entries
        .iter()
        .filter(|entry| matches!(entry.what, help::What::Key(_)))
        .collect();
    let mut page = ".SH \"KEYS IN THE LAB\"\n\
        The same list is shown by ? in the lab, with the words on its screen.\n"
        .to_owned();
    for group in keys.chunk_by(|one, next| one.group == next.group) {
        let name = match group[0].pane {
            Some(_) => format!("{}, while this pane has the focus", group[0].group),
            None => group[0].group.to_owned(),
        };
        page += &format!(".SS \"{}\"\n", plain(&name));
        for entry in group {
            let (keys, text) = (plain(&entry.name()), plain(entry.text()));
            page += &format!(".TP\n\\fB\\&{keys}\\fR\n\\&{text}\n");
        }
    }
    page
}

/// The manual's section about files of commands, one paragraph for each command.
pub(super) fn commands_page() -> String {
    let mut page = ".SH \"FILES OF COMMANDS\"\n\
        A file for \\-\\-do is a list of [[do]] tables with one command each, carried out in order:\n.PP\n.nf\n\
        [[do]]\nset = { \"motion.time_step_s\" = 0.05 }\n\n[[do]]\ngo_to = \"60 s\"\n.fi\n\
        .PP\nThe next begins when the one before is done. Refusals count the commands from 0: do.0 is the first. Conditions hold numbers, the names of the CSV's columns and \
        of the scenario's keys, + \\- * / ( ), abs, comparisons, and, or.\n"
        .to_owned();
    for row in COMMANDS {
        let (value, about) = (plain(row.value), plain(row.about));
        page += &format!(".TP\n\\fB{} = {value}\\fR\n{about}\n", row.name);
    }
    page
}

/// The manual's section about the files of settings, one paragraph for each key.
pub(super) fn settings_page() -> String {
    let mut page = ".SH \"SETTINGS\"\n\
        The lab's settings, each a line of $XDG_CONFIG_HOME/gyrolab/config.toml (by default ~/.config/gyrolab/config.toml). What is chosen in the lab is \
        remembered in settings.toml beside the sessions; config.toml wins, and is never written; options win over both. \
        No setting changes a number, and show reads none.\n"
        .to_owned();
    for (key, kind, about) in settings::KEYS {
        let value = match kind {
            Kind::OneOf(words) => format!("\"{}\"", words.join("\", \"")),
            Kind::Whole(least, most) => format!("{least} to {most}"),
            _ => "true, false".to_owned(),
        };
        let value = value.replace('-', "\\-");
        page += &format!(".TP\n\\fB{key} = {value}\\fR\n{about}\n");
    }
    page
}
