//! What is around the program: the environment variables that it reads, the files that it keeps, its exit codes.

use crate::cli::complete;
use crate::cli::{INTERRUPTED, MISUSED};
use crate::storage::settings;

/// Environment variables, and what each is for.
pub(super) const ENVIRONMENT: &[(&str, &str)] = &[
    (
        "NO_COLOR",
        "Set to anything: no colours, unless --color always or config.toml asks for them.",
    ),
    (
        "COLORFGBG",
        "A light background, as some terminals tell it, gives the colours for one; --background wins.",
    ),
    (
        "TERM",
        "The terminal. dumb gets ASCII and no colours, linux gets half blocks.",
    ),
    (
        "LC_ALL",
        "The locale, before LC_CTYPE and LANG: one without UTF-8 gets ASCII.",
    ),
    ("LC_CTYPE", "See LC_ALL."),
    ("LANG", "See LC_ALL."),
    ("HOME", "The home folder, where the next two are not set."),
    (
        "XDG_STATE_HOME",
        "Where sessions and settings.toml are kept, in its folder gyrolab; by default ~/.local/state.",
    ),
    (
        "XDG_CONFIG_HOME",
        "Where config.toml is read, in its folder gyrolab; by default ~/.config.",
    ),
    (
        "SSH_CONNECTION",
        "The port that the line with scp names after an export.",
    ),
    (
        "PAGER",
        "The program that shows gyrolab man on a terminal where it is longer than the screen; cat, or nothing, to have it printed; by default less.",
    ),
    ("LESS", "The options of less; by default FRX."),
    ("USER", "The user whom that line names; else LOGNAME."),
    ("LOGNAME", "See USER."),
    (
        "RAYON_NUM_THREADS",
        "On how many cores gyrolab sweep, compare, fit and verify compute; by default on all. No number depends on it.",
    ),
    (
        complete::VARIABLE,
        "The shell that asks for completions; the script of gyrolab completions sets it.",
    ),
];

/// Files, and what each is for.
pub(super) fn files() -> Vec<(String, &'static str)> {
    let state = "$XDG_STATE_HOME/gyrolab";
    vec![
        (
            format!("{state}/"),
            "The sessions of the lab, which gyrolab sessions lists and --resume comes back to.",
        ),
        (
            format!("{state}/{}", settings::FILE),
            "What was chosen in the lab; gyrolab writes it.",
        ),
        (
            "$XDG_CONFIG_HOME/gyrolab/config.toml".to_owned(),
            "Your own settings; gyrolab never writes it. See SETTINGS.",
        ),
        ("DIR/.gyrolab/".to_owned(), "Both of gyrolab --folder DIR."),
        (
            "FILE.toml".to_owned(),
            "A scenario or a run file: gyrolab man scenario.",
        ),
        (
            "FILE.csv".to_owned(),
            "A run with its run file in the header: gyrolab man csv.",
        ),
        ("FILE.md".to_owned(), "A lesson: gyrolab lesson --template."),
    ]
}

/// Exit codes, and when each is given.
pub(super) fn exit_codes() -> [(String, &'static str); 4] {
    [
        (
            0.to_string(),
            "Done; a reader that has gone, as head does, is no failure.",
        ),
        (
            1.to_string(),
            "Failed: a bad file, an output that cannot be written, numbers no longer finite, a CSV that differs.",
        ),
        (
            MISUSED.to_string(),
            "Wrong usage: an unknown option, a value that cannot be.",
        ),
        (
            INTERRUPTED.to_string(),
            "Ended by Ctrl-C, or another signal to end.",
        ),
    ]
}
