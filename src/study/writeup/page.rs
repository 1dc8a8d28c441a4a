//! The first page of a write-up, `README.md`: what was run, what came out, whether to believe it, how to make it again.

use super::languages::Lines;
use super::markdown::escaped;
use super::quantities::Quantity;
use super::{AGAIN, Beside, CSV, Drawing, RUN_FILE, Writeup, setup};
use crate::text::number::NONE;
use std::fmt::{self, Write};

/// A longer run file is not printed on the page.
const MOST_LINES: usize = 120;

/// The whole page as Markdown.
///
/// # Errors
/// None: a `String` takes what is written to it.
pub fn page(writeup: &Writeup) -> Result<String, fmt::Error> {
    let mut page = String::new();
    let readouts = &writeup.readouts;
    writeln!(page, "# {}\n", escaped(&readouts.title))?;
    let file = &writeup.scenario.file;
    let look_at = file.view.as_ref().and_then(|view| view.look_at.as_ref());
    let look_at = look_at.map(|line| sentence(line));
    for text in file.about.iter().chain(&look_at) {
        writeln!(page, "{}\n", escaped(text))?;
    }
    if let Some(source) = &file.source {
        writeln!(page, "Source: {}\n", escaped(source))?;
    }
    writeln!(page, "## What was run\n")?;
    setup::write(&mut page, writeup)?;
    writeln!(page, "\n## Are the numbers to be believed?\n")?;
    if let Some(broken) = &writeup.broken {
        writeln!(page, "{}.\n", escaped(&sentence(&broken.to_string())))?;
    }
    writeln!(
        page,
        "{}\n",
        escaped(&readouts.health.sentence(readouts.advice.as_ref()))
    )?;
    writeln!(page, "## Measured beside theory\n")?;
    write_quantities(&mut page, &writeup.quantities)?;
    if let Some(beside) = &writeup.beside {
        writeln!(page, "\n## Measured data beside the run\n")?;
        beside.write(&mut page)?;
    }
    writeln!(page, "\n## Figures\n")?;
    write_drawings(&mut page, &writeup.drawings)?;
    writeln!(page, "## How to make it again\n")?;
    write_again(&mut page, writeup.beside.as_ref())?;
    writeln!(page, "## How to read the CSV\n")?;
    write_languages(&mut page, &writeup.languages())?;
    writeln!(page, "## How to cite\n")?;
    write_citation(&mut page)?;
    write_run_file(&mut page, &writeup.scenario.to_toml())?;
    Ok(page)
}

fn write_quantities(page: &mut String, quantities: &[Quantity]) -> fmt::Result {
    if quantities.is_empty() {
        return writeln!(
            page,
            "The run is too short for that: nothing could be measured on it."
        );
    }
    writeln!(
        page,
        "| what | measured | theory | difference | in errors | unit |"
    )?;
    writeln!(page, "| --- | --- | --- | --- | --- | --- |")?;
    for quantity in quantities {
        writeln!(
            page,
            "| {} (`{}`) | {} | {} | {} | {} | {} |",
            quantity.label(),
            quantity.readout.name,
            quantity.measured_text(),
            quantity.predicted_text(),
            quantity.difference_text(),
            quantity.in_errors_text(),
            quantity.readout.unit
        )?;
    }
    writeln!(page)?;
    for quantity in quantities {
        writeln!(
            page,
            "- {}: {}",
            quantity.name(),
            escaped(&quantity.meaning())
        )?;
    }
    writeln!(
        page,
        "\nMeasured means read off the steps of this run; theory is that of the exact motion under the forces at the end of \
         the run. Digits in parentheses are one standard error of reading the number off the steps, in units of the last \
         digits: 0.886033(24) is 0.886033 ± 0.000024. \"In errors\" is the difference in standard errors. Up to about 3 of \
         them, reading alone explains it (exactly ±1.00: the reading's own known error, stated and not taken away). What is \
         more is the doing of the scheme and its time step, which the standard error does not hold: where the numbers hold, it \
         may be many errors and still be tiny. The least and the greatest values are those of the whole run, in \
         theory too. {NONE}: there is no such number, or none that can be \
         stated. The same table for LaTeX is in `{}`, every readout in `{}`.",
        super::LATEX,
        super::READOUTS_FILE
    )
}

fn write_drawings(page: &mut String, drawings: &[Drawing]) -> fmt::Result {
    if drawings.is_empty() {
        return writeln!(page, "None.\n");
    }
    for drawing in drawings {
        writeln!(
            page,
            "![{0}]({1}.svg)\n\n{0}: `{1}.pdf` and `{1}.svg`.\n",
            drawing.caption, drawing.name
        )?;
        if let Some(remark) = &drawing.remark {
            writeln!(page, "{remark}\n")?;
        }
    }
    Ok(())
}

fn write_again(page: &mut String, beside: Option<&Beside>) -> fmt::Result {
    let measured = beside.map(|beside| format!(" --measured {}", beside.name()));
    let measured = measured.unwrap_or_default();
    let same = format!("the same bytes as {CSV}");
    let commands = [
        (
            format!("verify {CSV}"),
            "computes the rows anew and says whether they are the same",
        ),
        (format!("run {RUN_FILE} -o {AGAIN}"), same.as_str()),
        (
            format!("writeup {RUN_FILE}{measured} -o again"),
            "this folder",
        ),
        (
            format!("{RUN_FILE}{measured}"),
            "the run, live in the terminal",
        ),
    ];
    let width = commands.iter().map(|(command, _)| command.len()).max();
    let width = width.unwrap_or_default();
    let version = env!("CARGO_PKG_VERSION");
    writeln!(page, "In this folder, with gyrolab {version}:\n\n```sh")?;
    for (command, what) in commands {
        writeln!(page, "gyrolab {command:width$}   # {what}")?;
    }
    writeln!(page, "```\n")
}

fn write_languages(page: &mut String, languages: &[Lines]) -> fmt::Result {
    for Lines {
        language,
        tag,
        code,
    } in languages
    {
        writeln!(page, "{language}:\n\n```{tag}\n{code}```\n")?;
    }
    Ok(())
}

fn write_citation(page: &mut String) -> fmt::Result {
    let (version, (year, authors)) = (env!("CARGO_PKG_VERSION"), copyright());
    writeln!(
        page,
        "{authors}, *gyrolab*, version {version} ({year}): {}.\n\n\
         ```bibtex\n\
         @software{{gyrolab,\n  title = {{gyrolab}},\n  author = {{{{{authors}}}}},\n  version = {{{version}}},\n  year = {{{year}}}\n}}\n\
         ```\n",
        env!("CARGO_PKG_DESCRIPTION")
    )
}

/// The year and the authors, from the licence.
fn copyright() -> (&'static str, &'static str) {
    const MARK: &str = "Copyright (c) ";
    let licence = include_str!("../../../LICENSE");
    let line = licence.lines().find_map(|line| line.strip_prefix(MARK));
    line.and_then(|line| line.split_once(' '))
        .unwrap_or_default()
}

fn write_run_file(page: &mut String, run_file: &str) -> fmt::Result {
    writeln!(page, "## The run file\n")?;
    match run_file.lines().count() {
        lines if lines > MOST_LINES => {
            writeln!(page, "`{RUN_FILE}`, {lines} lines.")
        }
        _ => writeln!(
            page,
            "`{RUN_FILE}`:\n\n```toml\n{}\n```",
            run_file.trim_end()
        ),
    }
}

/// `text` with a capital letter at its beginning.
fn sentence(text: &str) -> String {
    let mut letters = text.chars();
    let first = letters.next().map(char::to_uppercase);
    first.into_iter().flatten().chain(letters).collect()
}
