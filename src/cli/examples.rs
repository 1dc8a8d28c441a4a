//! Examples of each command, below its help and in its page of the manual. They are lines for a shell: what an example
//! does stands above it as a comment, and a long one is broken with a backslash, so that it can be pasted as it is.

use clap::Command;

/// The examples of each command, and of the program itself.
const EXAMPLES: &[(&str, &str)] = &[
    (
        "gyrolab",
        "\
# the report's Method 2 in the lab, live
gyrolab
# a screen prepared for the class
gyrolab cusps --paused --at 500
# a lesson beside the running lab
gyrolab lesson is-the-wobble-real
# which labs were left, and back to the newest of them
gyrolab sessions
gyrolab --resume
# what there is to run, and how the report's Method 2 ends
gyrolab presets
gyrolab run method-2
# every step of it as CSV, which runs again: its header is the run file
gyrolab run method-2 -o method-2.csv
gyrolab run method-2.csv -o again.csv",
    ),
    (
        "run",
        "\
# how it ends, and whether to believe it
gyrolab run method-2
# every step as CSV
gyrolab run method-2 -o method-2.csv
# some of the rows and columns
gyrolab run method-2 --every 10 --from 50 --to 60 \\
    --columns t_s,z_m -o part.csv
# every point of the body at every step
gyrolab run method-2 --points -o points.csv
# for a spreadsheet with decimal commas
gyrolab run method-2 --excel -o excel.csv
# the numbers, for a program
gyrolab run wobble-push --time-step 0.01 --json
# with a value changed, on stdout
gyrolab run cusps --set start.tilt_deg=20 -o -",
    ),
    (
        "show",
        "\
# the lab at the end of the run
gyrolab show wobble-push
# at a step, larger
gyrolab show method-2 --at 500 --size 120x40
# what commands lead to
echo 'do = [{ open = \"cusps\" }, { run_until = \"t_s >= 0.5\" }]' | \\
    gyrolab show --do -",
    ),
    (
        "compare",
        "\
# every scheme at four time steps
gyrolab compare cusps
# some of them, as CSV
gyrolab compare cusps --schemes report,rk4 --time-steps 0.01,0.005 \\
    -o errors.csv
# the same numbers, for a program
gyrolab compare cusps --json",
    ),
    (
        "figure",
        "\
# x, y and z over time
gyrolab figure wobble-push -o wobble.pdf
# the path in space
gyrolab figure cusps --kind 3d -o cusps.svg
# beside the exact motion
gyrolab figure method-2 --kind tilt_deg --exact -o tilt.pdf
# two schemes
gyrolab figure cusps --schemes report,rk4 --kind z_m -o schemes.png
# the error over the time step
gyrolab compare cusps -o error.csv
gyrolab figure error.csv -o error.pdf",
    ),
    (
        "cast",
        "\
# nine seconds of the push
echo 'do = [{open = \"wobble-push\"}, {run = true}, {wait_s = 9}]' | \\
    gyrolab cast - --size 80x24 --title 'A push' -o push.cast
# commands in a file; asciinema must be version 3 or later
gyrolab cast demo.toml -o demo.cast
asciinema play demo.cast",
    ),
    (
        "writeup",
        "\
# run, CSV, figures, table and text in a folder
gyrolab writeup wobble-push -o wobble
# with what was measured, and chi^2
gyrolab writeup heidelberg --measured heidelberg-spin-decay -o decay",
    ),
    (
        "verify",
        "\
# the same rows, or the first that differs
gyrolab run method-2 -o method-2.csv
gyrolab verify method-2.csv
# exit code 1 where one differs
gyrolab verify *.csv && echo all good",
    ),
    (
        "sweep",
        "\
# the shipped sweeps, and one of them
gyrolab sweep
gyrolab sweep wobble-over-time-step -o wobble.csv
# a grid, and its figure
gyrolab sweep cusps --vary motion.time_step_s=0.001..0.01:10 \\
    --vary motion.scheme=report,rk4 --measure most_distance_m -o grid.csv
gyrolab figure grid.csv -o grid.pdf
# a sweep's CSV runs again: its header is the sweep file
gyrolab sweep grid.csv -o again.csv
# sweep files, and sweeps on many machines
gyrolab man sweep",
    ),
    (
        "fit",
        "\
# shipped data
gyrolab fit heidelberg-precession --in heidelberg \\
    --free body.part.0.moments_kg_m2.2
# two keys, one of them within bounds
gyrolab fit lab.csv --in mine.toml \\
    --free start.spin_rpm,start.tilt_deg=10..40
# with a figure of data, model and residuals
gyrolab fit lab.csv --in mine.toml --free start.spin_rpm -o fit.csv
gyrolab figure fit.csv -o fit.pdf
# how files of measured data are written
gyrolab man fit",
    ),
    (
        "presets",
        "\
# what there is to run
gyrolab presets
# one of them, to change
gyrolab presets method-2 > mine.toml",
    ),
    (
        "sessions",
        "\
# which labs were left
gyrolab sessions
# back to the one that is called 3
gyrolab --resume 3",
    ),
    ("schemes", "gyrolab schemes"),
    (
        "lesson",
        "\
# the lessons
gyrolab lesson
# one of them beside the running lab
gyrolab lesson is-the-wobble-real
# for paper
gyrolab lesson is-the-wobble-real --handout -o wobble.md",
    ),
    (
        "check",
        "\
# line, key and rule of what is wrong
gyrolab presets method-2 > mine.toml
gyrolab check mine.toml",
    ),
    ("keys", "gyrolab keys | grep push"),
    ("readouts", "gyrolab readouts | grep tilt"),
    (
        "completions",
        "\
# bash
folder=~/.local/share/bash-completion/completions
mkdir -p $folder && gyrolab completions bash > $folder/gyrolab
# zsh: the folder must be one of $fpath
folder=~/.zfunc
mkdir -p $folder && gyrolab completions zsh > $folder/_gyrolab
# fish
folder=~/.config/fish/completions
mkdir -p $folder && gyrolab completions fish > $folder/gyrolab.fish",
    ),
    (
        "man",
        "\
# the manual
gyrolab man
# the page of a command
gyrolab man run
# a topic
gyrolab man csv
# every page as a file, for a package
gyrolab man --all -o man1",
    ),
];

/// The examples of the command `name`, or of the program itself: lines for a shell.
pub(super) fn of(name: &str) -> Option<&'static str> {
    let found = EXAMPLES.iter().find(|(of, _)| *of == name);
    found.map(|(_, examples)| *examples)
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
        for (command, examples) in EXAMPLES {
            let wide = examples.lines().find(|line| line.chars().count() > 73);
            assert_eq!(wide, None, "{command}");
        }
    }
}
