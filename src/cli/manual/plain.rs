//! Pages of the manual as plain text, where there is no man(1) to show them, or a pipe reads them.
//!
//! It knows the requests of roff that the pages of this program hold, no others.

use crate::text::wrap::wrapped;

/// Columns of a line.
pub(super) const WIDTH: usize = 80;
/// Columns by which text stands to the right of the titles, and explanations to the right of their terms.
const INDENT: usize = 7;
/// Columns by which the title of a part stands to the right of those of sections.
const PART: usize = 3;

/// The page in roff `page` as plain text, in lines of at most [`WIDTH`] columns, but for those that are not to be broken.
pub(super) fn text_of(page: &str) -> String {
    let mut text = Text::default();
    for line in page.lines() {
        text.take(line);
    }
    text.end_paragraph();
    text.lines.join("\n").trim_start_matches('\n').to_owned() + "\n"
}

/// What is written so far, and how it goes on.
#[derive(Default)]
struct Text {
    lines: Vec<String>,
    /// The words of the paragraph that is not complete.
    paragraph: String,
    /// What stands before its first line, as a bullet does.
    mark: String,
    /// The margins that .RS has left, the innermost last.
    outer: Vec<usize>,
    margin: usize,
    /// Columns from the margin to the paragraph.
    hanging: usize,
    /// Whether the next line is a term, which .TP explains.
    is_term: bool,
    /// Whether lines stay as they are, and where they begin.
    verbatim: Option<usize>,
}

impl Text {
    fn take(&mut self, line: &str) {
        let Some(request) = line.strip_prefix('.') else {
            return self.take_text(&unescaped(line));
        };
        let (name, argument) = request.split_once(' ').unwrap_or((request, ""));
        let argument = unescaped(argument.trim_matches('"'));
        self.end_paragraph();
        match name {
            "SH" => self.title(&argument, 0),
            "SS" => self.title(&argument, PART),
            "TP" => (self.is_term, self.hanging) = (true, INDENT),
            "IP" => {
                let mark = argument.split(' ').next().unwrap_or_default();
                self.hanging = mark.chars().count() + 1;
                self.mark = mark.to_owned();
            }
            "PP" => self.hanging = 0,
            "RS" => {
                self.outer.push(self.margin);
                self.margin += argument.parse().unwrap_or(INDENT);
                self.hanging = 0;
            }
            "RE" => {
                self.margin = self.outer.pop().unwrap_or(INDENT);
                self.hanging = 0;
            }
            "nf" => self.verbatim = Some(self.margin),
            "in" => self.verbatim = self.verbatim.map(|_| argument.parse().unwrap_or(INDENT)),
            "fi" => self.verbatim = None,
            _ => {}
        }
        if matches!(name, "TP" | "IP" | "PP" | "sp") {
            self.blank();
        }
    }

    fn take_text(&mut self, text: &str) {
        if let Some(margin) = self.verbatim {
            self.line(margin, text);
        } else if std::mem::take(&mut self.is_term) {
            let lines = wrapped(text, WIDTH - self.margin);
            lines.iter().for_each(|line| self.line(self.margin, line));
        } else {
            self.paragraph += " ";
            self.paragraph += text;
        }
    }

    fn title(&mut self, title: &str, indent: usize) {
        self.blank();
        self.outer.clear();
        (self.margin, self.hanging) = (INDENT, 0);
        self.line(indent, title);
    }

    fn line(&mut self, indent: usize, text: &str) {
        let line = " ".repeat(indent) + text;
        self.lines.push(line.trim_end().to_owned());
    }

    fn blank(&mut self) {
        if self.lines.last().is_some_and(|last| !last.is_empty()) {
            self.lines.push(String::new());
        }
    }

    fn end_paragraph(&mut self) {
        let paragraph = std::mem::take(&mut self.paragraph);
        let mark = std::mem::take(&mut self.mark);
        if paragraph.trim().is_empty() {
            return;
        }
        let indent = self.margin + self.hanging;
        for (index, line) in wrapped(&paragraph, WIDTH - indent).iter().enumerate() {
            if index == 0 && !mark.is_empty() {
                self.line(self.margin, &format!("{mark} {line}"));
            } else {
                self.line(indent, line);
            }
        }
    }
}

/// `text` without the escapes of roff.
fn unescaped(text: &str) -> String {
    let mut plain = String::new();
    let mut rest = text;
    while let Some((before, escape)) = rest.split_once('\\') {
        plain += before;
        let (skipped, put) = match escape.as_bytes() {
            [b'-', ..] => (1, "-"),
            [b'e', ..] => (1, "\\"),
            [b'f', ..] => (2, ""),
            [b'(', b'b', b'u', ..] => (3, "*"),
            [b'*', b'(', b'A', b'q', ..] => (4, "'"),
            _ => (1, ""),
        };
        plain += put;
        rest = escape.get(skipped..).unwrap_or_default();
    }
    plain + rest
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_page_is_laid_out_as_man_does() {
        let page = ".TH gyrolab 1\n.SH NAME\ngyrolab \\- a lab\\*(Aqs\npage\n.SH \"OPTIONS\"\n.TP\n\
            \\fB\\-\\-scheme\\fR\nThe scheme\n.sp\nOne of:\n.RS 14\n.IP \\(bu 2\nrk4\n.RE\n.TP\nx\ny\n\
            .SS \"A part\"\n.PP\n.nf\n[[do]]\n  a = \"\\e\"\n\n.in 0\n\\&.wide\n.in\n.fi\n";
        let wanted = "NAME\n       gyrolab - a lab's page\n\nOPTIONS\n\n       --scheme\n              The scheme\n\n\
            \x20             One of:\n\n                     * rk4\n\n       x\n              y\n\n   A part\n\n\
            \x20      [[do]]\n         a = \"\\\"\n\n.wide\n";
        assert_eq!(text_of(page), wanted);
        let long = format!(".SH NAME\n{}\n", "word ".repeat(100));
        let text = text_of(&long);
        assert!(text.lines().all(|line| line.len() <= WIDTH), "{text}");
    }
}
