//! Pieces of manual pages in roff, the language of man(1).

use crate::text::wrap::columns;

/// The day on which the manual was last gone through.
const DATE: &str = "2026-11-22";

/// The head of the page `name`.
pub(super) fn title(name: &str) -> String {
    let version = env!("CARGO_PKG_VERSION");
    let name = plain(name);
    format!(".TH {name} 1 {DATE} \"gyrolab {version}\" \"gyrolab manual\"\n")
}

/// The manual's synopsis of `command`: every option with its value.
pub(super) fn synopsis(command: &clap::Command) -> String {
    let mut line = format!("\\fB{}\\fR", plain(command.get_name()));
    if let Some(name) = command.get_bin_name() {
        line = format!("\\fB{}\\fR", plain(name));
    }
    let options = command.get_arguments().filter(|arg| !arg.is_hide_set());
    let (places, options): (Vec<_>, Vec<_>) = options.partition(|arg| arg.is_positional());
    for arg in options {
        let names: Vec<_> = [
            arg.get_short().map(|short| format!("-{short}")),
            arg.get_long().map(|long| format!("--{long}")),
        ]
        .into_iter()
        .flatten()
        .collect();
        let names = format!("\\fB{}\\fR", plain(&names.join("|")));
        let value = match (takes_value(arg), arg.get_num_args()) {
            (None, _) => String::new(),
            (Some(value), Some(number)) if number.min_values() == 0 => {
                format!(" [\\fI{}\\fR]", plain(&value))
            }
            (Some(value), _) => format!(" \\fI{}\\fR", plain(&value)),
        };
        line += &format!(" [{names}{value}]");
    }
    for arg in places {
        let name = arg.get_value_names().and_then(|names| names.first());
        let name = name.map_or_else(|| arg.get_id().to_string(), ToString::to_string);
        line += &if arg.is_required_set() {
            format!(" <\\fI{}\\fR>", plain(&name))
        } else {
            format!(" [\\fI{}\\fR]", plain(&name))
        };
    }
    if command.has_subcommands() {
        line += "\n.br\n\\fBgyrolab\\fR <\\fICOMMAND\\fR> ...";
    }
    format!(".SH SYNOPSIS\n{line}\n")
}

/// What the option `arg` is given; `None` of a flag.
fn takes_value(arg: &clap::Arg) -> Option<String> {
    let takes = arg.get_action().takes_values();
    let name = arg.get_value_names()?.first()?;
    takes.then(|| name.to_string())
}

/// `text` as roff prints it: hyphens as they are typed, no backslash an escape, no line a request.
pub(super) fn plain(text: &str) -> String {
    let text = text.replace('\\', "\\e").replace('-', "\\-");
    let begins_as_request = |line: &&str| line.starts_with(['.', '\'']);
    let lines = text.split('\n').map(|line| {
        if begins_as_request(&line) {
            format!("\\&{line}")
        } else {
            line.to_owned()
        }
    });
    lines.collect::<Vec<_>>().join("\n")
}

/// Columns that are left on a terminal of 80 where man(1) indents text.
const INDENTED: usize = 73;

/// A section of lines that stay as they are. Those that would be too wide for a terminal of 80 columns are not indented.
pub(super) fn verbatim(title: &str, text: &str) -> String {
    let (title, text) = (title.to_uppercase(), text.trim_end());
    let is_wide = text.lines().any(|line| columns(line) > INDENTED);
    let (begin, end) = if is_wide {
        (".in 0\n", ".in\n")
    } else {
        ("", "")
    };
    let lines = plain(text);
    format!(".SH \"{title}\"\n.nf\n{begin}{lines}\n{end}.fi\n")
}

/// A section of terms, each with its text.
pub(super) fn terms<'a>(
    title: &str,
    terms: impl IntoIterator<Item = (&'a str, &'a str)>,
) -> String {
    let mut page = format!(".SH \"{}\"\n", title.to_uppercase());
    for (term, text) in terms {
        page += &format!(".TP\n\\fB\\&{}\\fR\n{}\n", plain(term), plain(text));
    }
    page
}
