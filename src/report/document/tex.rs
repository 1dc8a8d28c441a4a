//! A document as a TeX file.

use super::formula::Formula;
use super::table::{ColumnKind, Table};
use super::tex_text::{code, formula, line, number};
use super::text::{Span, Text};
use super::{BIBLIOGRAPHY_FILE, Block, Document, Figure};
use std::fmt::{self, Write};

const PREAMBLE: &str = r"\documentclass[11pt,a4paper]{article}
\usepackage[T1]{fontenc}
\usepackage[utf8]{inputenc}
\usepackage{textcomp}
\IfFileExists{lmodern.sty}{\usepackage{lmodern}}{}
\usepackage[margin=25mm]{geometry}
\usepackage{array,booktabs,longtable}
\usepackage{graphicx}
\usepackage{siunitx}
\usepackage[hidelinks]{hyperref}
\setlength{\parindent}{0pt}
\setlength{\parskip}{6pt}
\setlength{\belowcaptionskip}{4pt}
\emergencystretch=3em
\renewcommand{\topfraction}{0.9}
\renewcommand{\bottomfraction}{0.8}
\renewcommand{\textfraction}{0.1}
\renewcommand{\floatpagefraction}{0.8}
% A line of code: broken where it is too long, with a hanging indent.
\newcommand{\codeline}[1]{\noindent\hangindent=2em\hangafter=1{\small\ttfamily\frenchspacing #1}\par}
";

/// The width of the text on the page, mm.
const TEXT_WIDTH_MM: f64 = 160.0;
/// Characters that a line of a table holds.
const TABLE_CHARACTERS: f64 = 86.0;
/// What stands between two columns, in characters.
const COLUMN_GAP: f64 = 2.5;
/// A table with more lines may be broken across pages.
const MOST_LINES_OF_FLOAT: f64 = 28.0;

pub(super) fn write(document: &Document) -> String {
    let mut out = String::from(PREAMBLE);
    let written = write_document(&mut out, document);
    debug_assert!(written.is_ok(), "a String takes what is written to it");
    out
}

fn write_document(out: &mut String, document: &Document) -> fmt::Result {
    let title = line(document, &document.title);
    writeln!(out, "\n\\title{{{title}}}\n\\author{{}}\n\\date{{}}")?;
    writeln!(out, "\n\\begin{{document}}\n\\maketitle")?;
    for block in &document.blocks {
        writeln!(out)?;
        match block {
            Block::Heading { level, text } => {
                let command = match level {
                    0 | 1 => "section",
                    2 => "subsection",
                    _ => "subsubsection",
                };
                writeln!(out, "\\{command}{{{}}}", line(document, text))?;
            }
            Block::Paragraph(text) => writeln!(out, "{}", line(document, text))?,
            Block::Quote(text) => {
                let text = line(document, text);
                writeln!(out, "\\begin{{quote}}\n{text}\n\\end{{quote}}")?;
            }
            Block::Formula(text) => writeln!(out, "\\[{}\\]", formula(&Formula::parse(text)))?,
            Block::List { is_numbered, items } => {
                let name = if *is_numbered { "enumerate" } else { "itemize" };
                write_list(out, document, name, items)?;
            }
            Block::Table(table) => write_table(out, document, table)?,
            Block::Figure(figure) => write_figure(out, document, figure)?,
            Block::Code { text, .. } => write_code(out, text)?,
        }
    }
    if !document.references.is_empty() {
        let (file, _) = BIBLIOGRAPHY_FILE.split_once('.').unwrap_or_default();
        writeln!(
            out,
            "\n\\nocite{{*}}\n\\bibliographystyle{{unsrt}}\n\\bibliography{{{file}}}"
        )?;
    }
    writeln!(out, "\n\\end{{document}}")
}

fn write_list(out: &mut String, document: &Document, name: &str, items: &[Text]) -> fmt::Result {
    writeln!(out, "\\begin{{{name}}}")?;
    for item in items {
        // Without the braces, a bracket at its beginning would be the item's label.
        writeln!(out, "\\item {{}}{}", line(document, item))?;
    }
    writeln!(out, "\\end{{{name}}}")
}

fn write_table(out: &mut String, document: &Document, table: &Table) -> fmt::Result {
    let formats = column_formats(table);
    let height = lines(table, &formats);
    let is_long = height > MOST_LINES_OF_FLOAT;
    let columns: String = formats.iter().map(ToString::to_string).collect();
    let label = table.label.as_ref().map(|it| format!("\\label{{{it}}}"));
    let label = label.unwrap_or_default();
    let caption = format!("\\caption{{{}}}{label}", line(document, &table.caption));
    let header = row(document, table, table.columns.iter().map(|it| &it.header));
    if is_long {
        writeln!(
            out,
            "{{\\small\n\\begin{{longtable}}{{{columns}}}\n{caption}\\\\"
        )?;
        writeln!(out, "\\toprule\n{header}\n\\midrule\n\\endfirsthead")?;
        writeln!(out, "\\toprule\n{header}\n\\midrule\n\\endhead")?;
        writeln!(out, "\\bottomrule\n\\endfoot")?;
    } else {
        writeln!(
            out,
            "\\begin{{table}}[htbp]\n\\centering\n\\small\n{caption}"
        )?;
        writeln!(
            out,
            "\\begin{{tabular}}{{{columns}}}\n\\toprule\n{header}\n\\midrule"
        )?;
    }
    let are_broken = height > table.rows.len() as f64;
    for (index, cells) in table.rows.iter().enumerate() {
        if are_broken && index > 0 {
            writeln!(out, "\\addlinespace")?;
        }
        writeln!(out, "{}", row(document, table, cells.iter()))?;
    }
    if is_long {
        writeln!(out, "\\end{{longtable}}\n}}")
    } else {
        writeln!(out, "\\bottomrule\n\\end{{tabular}}\n\\end{{table}}")
    }
}

/// Returns a row of `table`. In a column of numbers, braces protect what is not aligned.
fn row<'a>(document: &Document, table: &Table, cells: impl Iterator<Item = &'a Text>) -> String {
    let cells =
        cells
            .zip(&table.columns)
            .map(|(cell, column)| match (column.kind, aligned(cell)) {
                (ColumnKind::Number, Some(digits)) => digits,
                (ColumnKind::Number, None) => format!("{{{}}}", line(document, cell)),
                (ColumnKind::Text, _) => line(document, cell),
            });
    format!("{} \\\\", cells.collect::<Vec<_>>().join(" & "))
}

/// The format of a column.
enum ColumnFormat {
    Number(NumberFormat),
    Line,
    /// Text that is broken into lines, and the part of the page's width that it takes.
    Lines(f64),
}

impl fmt::Display for ColumnFormat {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Number(format) => write!(f, "S[table-format={format}]"),
            Self::Line => f.write_str("l"),
            Self::Lines(part) => {
                write!(
                    f,
                    ">{{\\raggedright\\arraybackslash}}p{{{part:.3}\\linewidth}}"
                )
            }
        }
    }
}

/// Returns the formats of the columns. If the table is wider than the page, long columns of text share what the others leave.
fn column_formats(table: &Table) -> Vec<ColumnFormat> {
    let all = 0..table.columns.len();
    let widths: Vec<f64> = all.clone().map(|column| width(table, column)).collect();
    let gaps = COLUMN_GAP * widths.len() as f64;
    let is_wide = widths.iter().sum::<f64>() + gaps > TABLE_CHARACTERS;
    let fair = (TABLE_CHARACTERS - gaps) / widths.len() as f64;
    let is_broken = |column: usize| {
        is_wide && table.columns[column].kind == ColumnKind::Text && widths[column] > fair.min(24.0)
    };
    let kept = all.clone().filter(|column| !is_broken(*column));
    let kept: f64 = kept.map(|column| widths[column]).sum();
    // The root: a column with four times the text is twice as wide and twice as high.
    let share = |column: usize| widths[column].sqrt();
    let shares: f64 = all
        .clone()
        .filter(|column| is_broken(*column))
        .map(share)
        .sum();
    let left = (TABLE_CHARACTERS - gaps - kept).max(0.3 * TABLE_CHARACTERS);
    let format = |column: usize| match table.columns[column].kind {
        ColumnKind::Number => ColumnFormat::Number(NumberFormat::of_column(table, column)),
        ColumnKind::Text if is_broken(column) => {
            ColumnFormat::Lines(left / TABLE_CHARACTERS * share(column) / shares)
        }
        ColumnKind::Text => ColumnFormat::Line,
    };
    all.map(format).collect()
}

/// Returns about how many lines the rows of `table` take.
fn lines(table: &Table, formats: &[ColumnFormat]) -> f64 {
    let lines_of_row = |row: &Vec<Text>| {
        let cells = row.iter().zip(formats).map(|(cell, format)| match format {
            ColumnFormat::Lines(part) => (length(cell) as f64 / (part * TABLE_CHARACTERS)).ceil(),
            ColumnFormat::Number(_) | ColumnFormat::Line => 1.0,
        });
        cells.fold(1.0, f64::max)
    };
    table.rows.iter().map(lines_of_row).sum()
}

/// Returns the width of a column that is not broken, in characters.
fn width(table: &Table, column: usize) -> f64 {
    let header = std::iter::once(&table.columns[column].header);
    let lengths = header.chain(table.cells(column)).map(length);
    let digits = match table.columns[column].kind {
        ColumnKind::Number => NumberFormat::of_column(table, column).width(),
        ColumnKind::Text => 0,
    };
    lengths.max().unwrap_or_default().max(digits) as f64
}

fn length(text: &Text) -> usize {
    let spans = text.0.iter().map(|span| match span {
        Span::Plain(it) | Span::Emphasis(it) | Span::Strong(it) => it.chars().count(),
        Span::Code(it) => it.chars().count() * 6 / 5,
        Span::Formula(it) => formula(it).len() / 2,
        Span::Quantity(it) => it.number.len() + it.unit.len() + 1,
        Span::Reference(_) => "Figure 1".len(),
        Span::Citation(_) => "[1]".len(),
    });
    spans.sum()
}

/// The most digits of the numbers of a column: before the point, after it, and of the uncertainty.
struct NumberFormat {
    has_sign: bool,
    whole: usize,
    decimals: usize,
    uncertainty: usize,
}

impl NumberFormat {
    fn of_column(table: &Table, column: usize) -> Self {
        let mut format = Self {
            has_sign: false,
            whole: 1,
            decimals: 0,
            uncertainty: 0,
        };
        for number in table.cells(column).filter_map(aligned) {
            let (value, error) = number.split_once('(').unwrap_or((&number, ""));
            format.has_sign |= value.starts_with(['-', '+']);
            let value = value.trim_start_matches(['-', '+']);
            let (before, after) = value.split_once('.').unwrap_or((value, ""));
            format.whole = format.whole.max(before.len());
            format.decimals = format.decimals.max(after.len());
            format.uncertainty = format.uncertainty.max(error.trim_end_matches(')').len());
        }
        format
    }

    /// Returns the width of a number, in characters, with the spaces between groups of digits.
    fn width(&self) -> usize {
        let digits = self.whole + self.decimals;
        let brackets = if self.uncertainty > 0 { 2 } else { 0 };
        digits + digits / 8 + self.uncertainty + brackets + usize::from(self.has_sign) + 1
    }
}

impl fmt::Display for NumberFormat {
    /// Writes siunitx's `table-format`: `-3.6(2)`.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let sign = if self.has_sign { "-" } else { "" };
        write!(f, "{sign}{}.{}", self.whole, self.decimals)?;
        match self.uncertainty {
            0 => Ok(()),
            digits => write!(f, "({digits})"),
        }
    }
}

/// Returns the number of a cell that is aligned at its decimal point: one without an exponent.
fn aligned(cell: &Text) -> Option<String> {
    let digits = cell.as_number().and_then(number);
    digits.filter(|digits| !digits.contains('e'))
}

fn write_figure(out: &mut String, document: &Document, figure: &Figure) -> fmt::Result {
    writeln!(out, "\\begin{{figure}}[htbp]\n\\centering")?;
    let count = figure.pictures.len().max(1) as f64;
    let fits = count * figure.width_mm <= TEXT_WIDTH_MM;
    for picture in &figure.pictures {
        let width = if fits {
            format!("{}mm", figure.width_mm)
        } else {
            format!("{:.3}\\linewidth", 0.99 / count)
        };
        writeln!(out, "\\includegraphics[width={width}]{{{picture}.pdf}}%")?;
    }
    let caption = line(document, &figure.caption);
    writeln!(
        out,
        "\\caption{{{caption}}}\\label{{{}}}\n\\end{{figure}}",
        figure.label
    )
}

/// Writes `text` line by line; spaces at the beginning of a line are kept.
fn write_code(out: &mut String, text: &str) -> fmt::Result {
    writeln!(
        out,
        "\\begin{{quote}}\\raggedright\\setlength{{\\parskip}}{{0pt}}"
    )?;
    for row in text.trim_end().lines() {
        let bare = row.trim_start_matches(' ');
        let indent = "~".repeat(row.len() - bare.len());
        let bare = code(bare).replace("  ", " ~");
        let line = if row.is_empty() {
            "~".to_owned()
        } else {
            indent + &bare
        };
        writeln!(out, "\\codeline{{{line}}}")?;
    }
    writeln!(out, "\\end{{quote}}")
}
