//! Examples of each command, below its help and in its page of the manual. They are lines for a shell: what an example
//! does stands above it as a comment, and a long one is broken with a backslash, so that it can be pasted as it is.

use clap::Command;

const EXAMPLES: &str = include_str!("examples.txt");

/// The part of `text` below the line `== name`.
pub(super) fn part(text: &'static str, name: &str) -> Option<&'static str> {
    let text = text.strip_prefix("== ")?;
    let mut parts = text.split("\n== ").filter_map(|part| part.split_once('\n'));
    parts.find_map(|(of, part)| (of == name).then(|| part.trim_end()))
}

/// The examples of the command `name`, or of the program itself: lines for a shell.
pub(super) fn of(name: &str) -> Option<&'static str> {
    part(EXAMPLES, name)
}

/// `command` with its examples below its help and below that of its commands, behind what a command says there itself.
pub(super) fn with_examples(command: Command) -> Command {
    let Some(examples) = of(command.get_name()) else {
        return command.mut_subcommands(with_examples);
    };
    let own = command.get_after_help().map(|own| format!("{own}\n\n"));
    let mut text = own.unwrap_or_default() + "Examples:";
    for line in examples.lines() {
        text = text + "\n  " + line;
    }
    command.after_help(text).mut_subcommands(with_examples)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_line_is_wider_than_a_page_or_a_help_of_80_columns() {
        let wide = EXAMPLES.lines().find(|line| line.chars().count() > 73);
        assert_eq!(wide, None);
    }
}
