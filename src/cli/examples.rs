//! Examples of each command, below its help and in its page of the manual.

use clap::Command;

/// Command, and its examples.
const EXAMPLES: &[(&str, &str)] = &[
    (
        "run",
        "  gyrolab run method-2                                  how it ends, and whether to believe it
  gyrolab run method-2 -o method-2.csv                  every step as CSV
  gyrolab run method-2 --every 10 --from 50 --to 60 --columns t_s,z_m -o part.csv
  gyrolab run method-2 --points -o points.csv           every point of the body at every step
  gyrolab run method-2 --excel -o method-2.csv          for a spreadsheet with decimal commas
  gyrolab run wobble-push --time-step 0.01 --json       the numbers, for a program
  gyrolab run cusps --set start.tilt_deg=20 -o -        with a value changed, on stdout",
    ),
    (
        "show",
        "  gyrolab show wobble-push                  the lab at the end of the run
  gyrolab show method-2 --at 500 --size 120x40
  gyrolab show --do demo.toml               what a file of commands leads to",
    ),
    (
        "compare",
        "  gyrolab compare cusps                     every scheme at four time steps
  gyrolab compare cusps --schemes report,rk4 --time-steps 0.01,0.005 -o errors.csv
  gyrolab compare cusps --json              the same numbers, for a program",
    ),
    (
        "figure",
        "  gyrolab figure wobble-push -o wobble.pdf                        x, y and z over time
  gyrolab figure cusps --kind 3d -o cusps.svg
  gyrolab figure method-2 --kind tilt_deg --exact -o tilt.pdf     beside the exact motion
  gyrolab figure method-2 --schemes report,rk4 --kind z_m --to 20 -o schemes.png
  gyrolab compare cusps -o error.csv && gyrolab figure error.csv -o error.pdf",
    ),
    (
        "cast",
        "  gyrolab cast demo.toml -o demo.cast && asciinema play demo.cast
  gyrolab cast demo.toml --size 80x24 --title 'A push' -o push.cast",
    ),
    (
        "writeup",
        "  gyrolab writeup wobble-push -o wobble      run, CSV, figures, table and text in a folder
  gyrolab writeup method-2 --measured bench.csv -o bench    with what was measured, and chi^2",
    ),
    (
        "verify",
        "  gyrolab verify method-2.csv               the same rows, or the first that differs
  gyrolab verify *.csv && echo all good     exit code 1 where one differs",
    ),
    (
        "sweep",
        "  gyrolab sweep                                     the shipped sweeps
  gyrolab sweep wobble-over-time-step -o wobble.csv
  gyrolab sweep method-2 --vary motion.time_step_s=0.01..0.1:10 --vary motion.scheme=report,rk4 -o grid.csv
  gyrolab sweep grid.csv -o again.csv               a sweep's CSV runs again: its header is the sweep file
  gyrolab man sweep                                 sweep files, and sweeps on many machines",
    ),
    (
        "fit",
        "  gyrolab fit heidelberg-precession --in heidelberg --free body.part.0.moments_kg_m2.2
  gyrolab fit lab.csv --in mine.toml --free start.spin_rpm,start.tilt_deg=10..40
  gyrolab fit lab.csv --in mine.toml --free start.spin_rpm -o fit.csv && gyrolab figure fit.csv -o fit.pdf
  gyrolab man fit                                   how files of measured data are written",
    ),
    (
        "presets",
        "  gyrolab presets                           what there is to run
  gyrolab presets method-2 > mine.toml      one of them, to change",
    ),
    (
        "sessions",
        "  gyrolab sessions                          which labs were left
  gyrolab --resume 3                        back to the one that is called 3",
    ),
    ("schemes", "  gyrolab schemes"),
    (
        "lesson",
        "  gyrolab lesson                            the lessons
  gyrolab lesson is-the-wobble-real         one of them beside the running lab
  gyrolab lesson is-the-wobble-real --handout -o wobble.md",
    ),
    (
        "check",
        "  gyrolab check mine.toml lesson.md         line, key and rule of what is wrong",
    ),
    ("keys", "  gyrolab keys | grep push"),
    ("readouts", "  gyrolab readouts | grep tilt"),
    (
        "completions",
        "  bash  gyrolab completions bash > ~/.local/share/bash-completion/completions/gyrolab
  zsh   gyrolab completions zsh > _gyrolab        in a folder of $fpath
  fish  gyrolab completions fish > ~/.config/fish/completions/gyrolab.fish",
    ),
    (
        "man",
        "  gyrolab man                               the manual
  gyrolab man run                           the page of a command
  gyrolab man csv                           a topic
  gyrolab man --all -o man1                 every page as a file, for a package",
    ),
];

/// The examples of the command `name`.
pub(super) fn of(name: &str) -> Option<&'static str> {
    let found = EXAMPLES.iter().find(|(of, _)| *of == name);
    found.map(|(_, examples)| *examples)
}

/// `command` with their examples below the help of its commands, and below what a command says there itself.
pub(super) fn with_examples(command: Command) -> Command {
    command.mut_subcommands(|sub| {
        let Some(examples) = of(sub.get_name()) else {
            return sub;
        };
        let own = sub.get_after_help().map(|own| format!("{own}\n\n"));
        let text = format!("{}Examples:\n{examples}", own.unwrap_or_default());
        sub.after_help(text)
    })
}
