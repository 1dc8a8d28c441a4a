//! Texts, numbers and formulas in TeX. No character of a text has its TeX meaning.

use super::Document;
use super::formula::{Formula, Piece};
use super::text::{Quantity, Span, Text};

/// Characters that pdfTeX needs a command for, in a text and in a formula.
const SYMBOLS: [(char, &str, &str); 44] = [
    ('α', r"$\alpha$", r"\alpha"),
    ('β', r"$\beta$", r"\beta"),
    ('γ', r"$\gamma$", r"\gamma"),
    ('δ', r"$\delta$", r"\delta"),
    ('ε', r"$\varepsilon$", r"\varepsilon"),
    ('θ', r"$\theta$", r"\theta"),
    ('κ', r"$\kappa$", r"\kappa"),
    ('λ', r"$\lambda$", r"\lambda"),
    ('μ', r"$\mu$", r"\mu"),
    ('π', r"$\pi$", r"\pi"),
    ('ρ', r"$\rho$", r"\rho"),
    ('σ', r"$\sigma$", r"\sigma"),
    ('τ', r"$\tau$", r"\tau"),
    ('φ', r"$\varphi$", r"\varphi"),
    ('χ', r"$\chi$", r"\chi"),
    ('ψ', r"$\psi$", r"\psi"),
    ('ω', r"$\omega$", r"\omega"),
    ('Δ', r"$\Delta$", r"\Delta"),
    ('Σ', r"$\Sigma$", r"\Sigma"),
    ('Ω', r"$\Omega$", r"\Omega"),
    ('×', r"$\times$", r"\times"),
    ('·', r"$\cdot$", r"\cdot"),
    ('±', r"$\pm$", r"\pm"),
    ('−', r"$-$", "-"),
    ('≈', r"$\approx$", r"\approx"),
    ('≤', r"$\le$", r"\le"),
    ('≥', r"$\ge$", r"\ge"),
    ('≠', r"$\ne$", r"\ne"),
    ('→', r"$\to$", r"\to"),
    ('∞', r"$\infty$", r"\infty"),
    ('√', r"$\surd$", r"\surd"),
    ('°', r"$^\circ$", r"^\circ"),
    ('²', r"$^2$", "^2"),
    ('³', r"$^3$", "^3"),
    ('½', r"$\frac12$", r"\frac12"),
    ('′', r"$'$", "'"),
    ('“', "``", "``"),
    ('”', "''", "''"),
    ('‘', "`", "`"),
    ('’', "'", "'"),
    ('…', r"\dots{}", r"\dots"),
    ('–', "--", "-"),
    ('—', "---", "-"),
    ('\u{a0}', "~", "~"),
];

/// Latin letters up to here are in the T1 font encoding, or are made of a letter and an accent.
const LAST_LATIN: char = 'ž';

pub(super) fn line(document: &Document, text: &Text) -> String {
    text.0.iter().map(|it| span(document, it)).collect()
}

fn span(document: &Document, span: &Span) -> String {
    match span {
        Span::Plain(text) => escaped(text),
        Span::Emphasis(text) => format!("\\emph{{{}}}", escaped(text)),
        Span::Strong(text) => format!("\\textbf{{{}}}", escaped(text)),
        Span::Code(text) => format!("\\texttt{{{}}}", code(text)),
        Span::Formula(it) => format!("${}$", formula(it)),
        Span::Quantity(it) => quantity(it),
        Span::Reference(label) => match document.name_of(label) {
            Some(name) => {
                let kind = name.split(' ').next().unwrap_or_default();
                format!("{kind}~\\ref{{{label}}}")
            }
            None => escaped(label),
        },
        Span::Citation(key) => match document.number_of(key) {
            Some(_) => format!("\\cite{{{key}}}"),
            None => escaped(key),
        },
    }
}

fn quantity(quantity: &Quantity) -> String {
    let Quantity {
        number: digits,
        unit,
    } = quantity;
    if digits.is_empty() && !unit.is_empty() {
        return format!("\\si{{{}}}", si_unit(unit));
    }
    match (number(digits), unit.as_str()) {
        (Some(number), "") => format!("\\num{{{number}}}"),
        (Some(number), unit) => format!("\\SI{{{number}}}{{{}}}", si_unit(unit)),
        (None, unit) => escaped(format!("{digits} {unit}").trim_end()),
    }
}

/// Returns `digits` as siunitx reads them: an uncertainty in units of the last digit, without a point. `None` if they are no
/// number.
pub(super) fn number(digits: &str) -> Option<String> {
    let (mantissa, power) = digits.split_once('e').unwrap_or((digits, "0"));
    let (value, error) = match mantissa.split_once('(') {
        Some((value, error)) => (value, error.strip_suffix(')')?),
        None => (mantissa, "0"),
    };
    let [value, power] = [value, power].map(|text| text.strip_prefix(['+', '-']).unwrap_or(text));
    if ![value, error, power].into_iter().all(is_decimal) {
        return None;
    }
    Some(match digits.split_once('(') {
        Some((before, after)) => format!("{before}({}", after.replace('.', "")),
        None => digits.to_owned(),
    })
}

fn is_decimal(text: &str) -> bool {
    let digits = text.replacen('.', "", 1);
    !digits.is_empty() && digits.chars().all(|c| c.is_ascii_digit())
}

/// Returns `unit` in the notation of siunitx: `kg.m^2`, `rad/s`.
fn si_unit(unit: &str) -> String {
    if unit == "deg" {
        return "\\degree".to_owned();
    }
    let mut out = String::new();
    for c in unit.chars() {
        match c {
            ' ' => out.push('.'),
            '%' => out.push_str("\\percent"),
            c if c.is_ascii_digit() && out.ends_with(char::is_alphabetic) => {
                out.extend(['^', c]);
            }
            c => out.push_str(&escaped(&c.to_string())),
        }
    }
    out
}

/// Functions that TeX has commands for.
const FUNCTIONS: [&str; 7] = ["sin", "cos", "tan", "arcsin", "arccos", "arctan", "exp"];

/// Returns the formula for TeX's mathematical mode.
pub(super) fn formula(of: &Formula) -> String {
    let mut out = String::new();
    for piece in &of.0 {
        match piece {
            Piece::Variables(letters) => push_symbols(&mut out, letters),
            Piece::Word(word) if FUNCTIONS.contains(&word.as_str()) => {
                push(&mut out, &format!("\\{word}"));
            }
            Piece::Word(word) => push(&mut out, &format!("\\mathrm{{{word}}}")),
            Piece::Other(text) => push_symbols(&mut out, &spaced(text)),
            Piece::Index(inner) => push(&mut out, &format!("_{{{}}}", formula(inner))),
            Piece::Power(inner) => push(&mut out, &format!("^{{{}}}", formula(inner))),
            Piece::Root(inner) => push(&mut out, &format!("\\sqrt{{{}}}", formula(inner))),
        }
    }
    out
}

/// Adds `tex` to a formula. A letter behind a command is kept apart from its name.
fn push(formula: &mut String, tex: &str) {
    let name = formula.trim_end_matches(|c: char| c.is_ascii_alphabetic());
    let ends_with_command = name.len() < formula.len() && name.ends_with('\\');
    if ends_with_command && tex.starts_with(|c: char| c.is_ascii_alphabetic()) {
        formula.push(' ');
    }
    formula.push_str(tex);
}

/// Returns `text` with a thin space for a space between two factors; TeX sets the space around operators itself.
fn spaced(text: &str) -> String {
    let is_factor = |c: Option<char>| c.is_none_or(|c| c.is_alphanumeric() || "|()".contains(c));
    let mut out = String::new();
    for (at, c) in text.char_indices() {
        let before = text[..at].chars().next_back();
        let after = text[at + c.len_utf8()..].chars().next();
        out.push(match c {
            ' ' if is_factor(before) && is_factor(after) => '\u{2009}',
            c => c,
        });
    }
    out
}

/// Adds the characters of `text` to a formula, as commands where they need one.
fn push_symbols(formula: &mut String, text: &str) {
    for c in text.chars() {
        let symbol = SYMBOLS.iter().find(|(symbol, ..)| *symbol == c);
        match (c, symbol) {
            (_, Some((_, _, command))) => push(formula, command),
            ('\u{2009}', _) => push(formula, "\\,"),
            ('{' | '}' | '%' | '#' | '&' | '$', _) => push(formula, &format!("\\{c}")),
            ('\\', _) => push(formula, "\\backslash"),
            _ if c.is_ascii() => push(formula, &c.to_string()),
            _ => push(formula, &format!("\\mbox{{{}}}", escaped(&c.to_string()))),
        }
    }
}

/// Returns `text` so that TeX prints it as it is, on one line.
pub(super) fn escaped(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    for c in text.chars() {
        match c {
            '\n' => out.push(' '),
            '\\' => out.push_str("\\textbackslash{}"),
            '{' | '}' | '%' | '#' | '&' | '$' | '_' => out.extend(['\\', c]),
            '~' => out.push_str("\\textasciitilde{}"),
            '^' => out.push_str("\\textasciicircum{}"),
            '<' => out.push_str("\\textless{}"),
            '>' => out.push_str("\\textgreater{}"),
            '|' => out.push_str("\\textbar{}"),
            '"' => out.push_str("\\textquotedbl{}"),
            '\'' => out.push_str("\\textquotesingle{}"),
            '`' => out.push_str("\\textasciigrave{}"),
            // Two of them would be a dash.
            '-' if out.ends_with('-') => out.push_str("{}-"),
            c if c == ' ' || c.is_ascii_graphic() => out.push(c),
            c => out.push_str(&beyond_ascii(c)),
        }
    }
    out
}

/// Returns a character that is not ASCII; one that pdfTeX has no letter for by its number.
fn beyond_ascii(c: char) -> String {
    let symbol = SYMBOLS.iter().find(|(symbol, ..)| *symbol == c);
    match symbol {
        Some((_, text, _)) => (*text).to_owned(),
        None if c.is_alphabetic() && c <= LAST_LATIN => c.to_string(),
        None => format!("[U+{:04X}]", u32::from(c)),
    }
}

/// Returns `text` as code, which may be broken behind the signs in names and paths.
pub(super) fn code(text: &str) -> String {
    let mut out = String::new();
    for c in text.chars() {
        match c {
            '_' | '/' | '.' | '=' | ',' => {
                out.push_str(&escaped(&c.to_string()));
                out.push_str("\\allowbreak{}");
            }
            '-' => out.push_str("-{}"),
            c => out.push_str(&escaped(&c.to_string())),
        }
    }
    out
}
