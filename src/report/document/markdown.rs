//! A document as Markdown, in GitHub's dialect. It is also readable as plain text.

use super::formula::{Formula, Piece};
use super::table::{Column, ColumnKind, Table};
use super::text::{Quantity, Span, Text};
use super::{Block, Document, Figure};
use std::fmt::{self, Write};

/// Tables up to this width have columns of equal width in the file too, characters.
const WIDEST_ALIGNED: usize = 120;

/// Digits and signs, and the same as indices and as powers.
const DIGITS: &str = "0123456789+-−";
const LOW_DIGITS: &str = "₀₁₂₃₄₅₆₇₈₉₊₋₋";
const HIGH_DIGITS: &str = "⁰¹²³⁴⁵⁶⁷⁸⁹⁺⁻⁻";

pub(super) fn write(document: &Document) -> String {
    let mut out = String::new();
    let written = write_document(&mut out, document);
    debug_assert!(written.is_ok(), "a String takes what is written to it");
    out
}

fn write_document(out: &mut String, document: &Document) -> fmt::Result {
    writeln!(out, "# {}", line(document, &document.title))?;
    let (mut figures, mut tables) = (0, 0);
    for block in &document.blocks {
        writeln!(out)?;
        match block {
            Block::Heading { level, text } => {
                let marks = "#".repeat(usize::from(*level) + 1);
                writeln!(out, "{marks} {}", line(document, text))?;
            }
            Block::Paragraph(text) => writeln!(out, "{}", paragraph(document, text))?,
            Block::Quote(text) => writeln!(out, "> {}", paragraph(document, text))?,
            Block::Formula(text) => writeln!(out, "> {}", formula(&Formula::parse(text)))?,
            Block::List { is_numbered, items } => {
                for (number, item) in (1..).zip(items) {
                    let item = line(document, item);
                    if *is_numbered {
                        writeln!(out, "{number}. {item}")?;
                    } else {
                        writeln!(out, "- {item}")?;
                    }
                }
            }
            Block::Table(table) => {
                tables += 1;
                write_table(out, document, table, tables)?;
            }
            Block::Figure(figure) => {
                figures += 1;
                write_figure(out, document, figure, figures)?;
            }
            Block::Code { language, text } => write_code(out, language, text)?,
        }
    }
    write_references(out, document)
}

fn write_table(out: &mut String, document: &Document, table: &Table, number: usize) -> fmt::Result {
    let caption = line(document, &table.caption);
    writeln!(out, "**Table {number}.** {caption}\n")?;
    let header = table.columns.iter().map(|it| &it.header).collect();
    let rows = std::iter::once(header).chain(table.rows.iter().map(|row| row.iter().collect()));
    let cells: Vec<Vec<String>> = rows
        .map(|row: Vec<&Text>| row.into_iter().map(|it| cell(document, it)).collect())
        .collect();
    let mut widths: Vec<usize> = (0..table.columns.len())
        .map(|column| {
            let lengths = cells.iter().filter_map(|row| row.get(column));
            lengths.map(|it| it.chars().count()).max().unwrap_or(0)
        })
        .collect();
    if widths.iter().sum::<usize>() > WIDEST_ALIGNED {
        widths.fill(0);
    }
    for (index, row) in cells.iter().enumerate() {
        let columns = row.iter().zip(&table.columns).zip(&widths);
        for ((text, column), width) in columns {
            match column.kind {
                ColumnKind::Text => write!(out, "| {text:<width$} ")?,
                ColumnKind::Number => write!(out, "| {text:>width$} ")?,
            }
        }
        writeln!(out, "|")?;
        if index == 0 {
            write_rule(out, &table.columns, &widths)?;
        }
    }
    Ok(())
}

/// Writes the line below the header of a table.
fn write_rule(out: &mut String, columns: &[Column], widths: &[usize]) -> fmt::Result {
    for (column, width) in columns.iter().zip(widths) {
        match column.kind {
            ColumnKind::Text => write!(out, "| {:-<width$} ", "---")?,
            ColumnKind::Number => write!(out, "| {:->width$} ", "--:")?,
        }
    }
    writeln!(out, "|")
}

fn cell(document: &Document, text: &Text) -> String {
    line(document, text).replace('|', "\\|")
}

fn write_figure(
    out: &mut String,
    document: &Document,
    figure: &Figure,
    number: usize,
) -> fmt::Result {
    let pictures: Vec<String> = figure
        .pictures
        .iter()
        .map(|picture| format!("![Figure {number}]({picture}.svg)"))
        .collect();
    let caption = line(document, &figure.caption);
    writeln!(out, "{}\n", pictures.join(" "))?;
    writeln!(out, "**Figure {number}.** {caption}")
}

/// Writes `text` between fences that are longer than any in it.
fn write_code(out: &mut String, language: &str, text: &str) -> fmt::Result {
    let longest = text
        .split(|c| c != '`')
        .map(str::len)
        .max()
        .unwrap_or_default();
    let fence = "`".repeat(longest.max(2) + 1);
    writeln!(out, "{fence}{language}\n{}\n{fence}", text.trim_end())
}

fn write_references(out: &mut String, document: &Document) -> fmt::Result {
    if document.references.is_empty() {
        return Ok(());
    }
    writeln!(out, "\n## References\n")?;
    for (number, reference) in (1..).zip(&document.references) {
        let [author, title, after] = reference.line().map(|part| escaped(&part));
        writeln!(out, "{number}. {author}: *{title}*. {after}.")?;
    }
    Ok(())
}

/// Returns `text` on one line, so that it begins no list, heading or quotation.
fn paragraph(document: &Document, text: &Text) -> String {
    let text = line(document, text);
    let digits = text.find(|c: char| !c.is_ascii_digit()).unwrap_or(0);
    let begins_block = text.starts_with(['+', '-', '=', '#', '>'])
        || (digits > 0 && text[digits..].starts_with(['.', ')']));
    if begins_block {
        let (number, rest) = text.split_at(digits);
        return format!("{number}\\{rest}");
    }
    text
}

fn line(document: &Document, text: &Text) -> String {
    text.0.iter().map(|it| span(document, it)).collect()
}

fn span(document: &Document, span: &Span) -> String {
    match span {
        Span::Plain(text) => escaped(text),
        Span::Emphasis(text) => format!("*{}*", escaped(text)),
        Span::Strong(text) => format!("**{}**", escaped(text)),
        Span::Code(text) => code(text),
        Span::Formula(it) => formula(it),
        Span::Quantity(it) => quantity(it),
        Span::Reference(label) => document.name_of(label).unwrap_or_else(|| escaped(label)),
        Span::Citation(key) => match document.number_of(key) {
            Some(number) => format!("[{number}]"),
            None => escaped(key),
        },
    }
}

/// Returns `text` as code. A line break is a space in it.
fn code(text: &str) -> String {
    let text = text.replace('\n', " ");
    if text.contains('`') {
        format!("`` {text} ``")
    } else {
        format!("`{text}`")
    }
}

/// Returns `2.4 × 10⁻⁹ m s⁻²`.
fn quantity(quantity: &Quantity) -> String {
    let (digits, exponent) = quantity.parts();
    let power = exponent
        .map(|it| format!(" × 10{}", translated(it, HIGH_DIGITS)))
        .unwrap_or_default();
    let unit = match quantity.unit.as_str() {
        "" => String::new(),
        "deg" => "°".to_owned(),
        unit => format!(" {}", powers(unit)),
    };
    format!("{digits}{power}{unit}").trim_start().to_owned()
}

/// Returns `unit` with its powers raised: `kg m²`.
fn powers(unit: &str) -> String {
    let mut before = ' ';
    let letters = unit.chars().map(|c| {
        let is_power = c.is_ascii_digit() && before.is_alphabetic();
        before = c;
        if is_power {
            in_alphabet(c, HIGH_DIGITS)
        } else {
            c
        }
    });
    letters.collect()
}

fn formula(of: &Formula) -> String {
    let pieces = of.0.iter().map(|piece| match piece {
        Piece::Variables(letters) => format!("*{letters}*"),
        Piece::Word(word) => word.clone(),
        Piece::Other(text) => escaped(text),
        Piece::Index(inner) => match inner.as_digits() {
            Some(digits) => translated(digits, LOW_DIGITS),
            None => format!("<sub>{}</sub>", formula(inner)),
        },
        Piece::Power(inner) => match inner.as_digits() {
            Some(digits) => translated(digits, HIGH_DIGITS),
            None => format!("<sup>{}</sup>", formula(inner)),
        },
        Piece::Root(inner) if inner.0.len() == 1 => format!("√{}", formula(inner)),
        Piece::Root(inner) => format!("√({})", formula(inner)),
    });
    pieces.collect()
}

/// Returns `digits` as indices or as powers.
fn translated(digits: &str, alphabet: &str) -> String {
    digits.chars().map(|c| in_alphabet(c, alphabet)).collect()
}

fn in_alphabet(c: char, alphabet: &str) -> char {
    let place = DIGITS.chars().position(|digit| digit == c);
    place.and_then(|at| alphabet.chars().nth(at)).unwrap_or(c)
}

/// Returns `text` so that Markdown shows it as it is, on one line.
fn escaped(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    let mut before = ' ';
    for (at, c) in text.char_indices() {
        let after = text[at + c.len_utf8()..].chars().next().unwrap_or(' ');
        let has_meaning = match c {
            '\\' | '`' | '*' | '[' | ']' | '$' | '~' => true,
            // Within a word it emphasizes nothing.
            '_' => !(before.is_alphanumeric() && after.is_alphanumeric()),
            '<' => after.is_ascii_alphabetic() || "/!?".contains(after),
            '&' => after.is_ascii_alphabetic() || after == '#',
            _ => false,
        };
        if has_meaning {
            out.push('\\');
        }
        out.push(if c == '\n' { ' ' } else { c });
        before = c;
    }
    out
}
