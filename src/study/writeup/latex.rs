//! The measured numbers beside theory as a LaTeX table, which needs no package.

use super::quantities::Quantity;
use crate::text::number::Uncertain;

/// The table of `quantities`: what, measured, theory, unit. `caption` says whose numbers they are, `verdict` whether they are
/// to be believed; both are printed.
pub fn table(quantities: &[Quantity], caption: &str, verdict: &str) -> String {
    let rows: String = quantities.iter().map(row).collect();
    let meanings = quantities
        .iter()
        .map(|quantity| format!("% {}: {}.\n", quantity.name(), quantity.meaning()));
    let meanings: String = meanings.collect();
    format!(
        r"{meanings}% Digits in parentheses are one standard error of reading the number off the steps, in units of the last digits.
\begin{{table}}
\centering
\caption{{{} {}}}
\footnotesize
\begin{{tabular}}{{@{{}}p{{0.42\columnwidth}}rr@{{}}}}
\hline
 & measured & theory \\
\hline
{rows}\hline
\end{{tabular}}
\end{{table}}
",
        escaped(caption),
        escaped(verdict)
    )
}

fn row(quantity: &Quantity) -> String {
    let measured = match quantity.stated() {
        Some(stated) => uncertain(&stated),
        None => number(&quantity.measured_text()),
    };
    let unit = match quantity.readout.unit {
        "" => String::new(),
        name => format!("~({})", unit(name)),
    };
    format!(
        "\\raggedright {}{unit} & {measured} & {} \\\\\n",
        escaped(&quantity.label()),
        number(&quantity.predicted_text()),
    )
}

/// `0.886033(24)`, or `8.86(24) \times 10^{-5}`.
fn uncertain(stated: &Uncertain) -> String {
    power_of_ten(&stated.digits, stated.exponent)
}

/// A number as it was written with `e` for the power of ten; what is no number, such as n/a, is a text.
fn number(text: &str) -> String {
    match text.split_once('e') {
        Some((digits, power)) => match power.parse() {
            Ok(power) => power_of_ten(digits, power),
            Err(_) => escaped(text),
        },
        None if text.parse::<f64>().is_ok() => power_of_ten(text, 0),
        None => escaped(text),
    }
}

fn power_of_ten(digits: &str, power: i32) -> String {
    match power {
        0 => format!("${digits}$"),
        power => format!(r"${digits} \times 10^{{{power}}}$"),
    }
}

/// `rad/s` as `rad\,s$^{-1}$`, `deg` as a degree sign.
fn unit(unit: &str) -> String {
    match unit {
        "deg" => r"$^{\circ}$".to_owned(),
        other => match other.split_once('/') {
            Some((over, under)) => format!(r"{over}\,{under}$^{{-1}}$"),
            None => other.replace(' ', r"\,"),
        },
    }
}

/// `text` so that LaTeX prints it as it stands.
fn escaped(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    for c in text.chars() {
        match c {
            // LaTeX makes one dash of two.
            '-' if out.ends_with('-') => out.push_str("{}-"),
            '\\' => out.push_str(r"\textbackslash{}"),
            '~' => out.push_str(r"\textasciitilde{}"),
            '^' => out.push_str(r"\textasciicircum{}"),
            '&' | '%' | '$' | '#' | '_' | '{' | '}' => out.extend(['\\', c]),
            c => out.push(c),
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_text_is_printed_as_it_stands() {
        assert_eq!(
            escaped(r"50% of a_b & {c} \d ~ ^ # $"),
            r"50\% of a\_b \& \{c\} \textbackslash{}d \textasciitilde{} \textasciicircum{} \# \$"
        );
        assert_eq!(escaped("a-b --time-step"), "a-b -{}-time-step");
    }

    #[test]
    fn numbers_and_units_are_set_as_such() {
        assert_eq!(number("0.886033"), "$0.886033$");
        assert_eq!(number("-1.5e-7"), r"$-1.5 \times 10^{-7}$");
        assert_eq!(number("n/a"), "n/a");
        assert_eq!(unit("rad/s"), r"rad\,s$^{-1}$");
        assert_eq!(unit("J s"), r"J\,s");
    }
}
