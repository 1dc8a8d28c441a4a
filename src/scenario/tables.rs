//! How many tables a text asks for, told before it is read: a table costs a hundred times the letters that ask for it.

use super::problem::Problem;
use toml_parser::Source;
use toml_parser::lexer::TokenKind;

/// The most tables of a file: 100 000 points and 100 000 edits take 300 000.
const MOST: usize = 300_000;

/// Counts tables while the tokens of a text go by.
#[derive(Default)]
struct Count<'a> {
    tables: usize,
    /// Dots since the last mark that is no part of a name.
    dots: usize,
    /// Where the heading that the line begins with starts, until it ends.
    heading: Option<usize>,
    last_heading: &'a str,
}

impl<'a> Count<'a> {
    /// Takes in the mark `kind`, which stands in `text` from `begin` on; `is_first` in its line.
    fn follow(&mut self, kind: TokenKind, text: &'a str, begin: usize, is_first: bool) {
        match kind {
            TokenKind::Dot => self.dots += 1,
            TokenKind::Equals => self.tables += std::mem::take(&mut self.dots),
            TokenKind::LeftCurlyBracket => (self.tables, self.dots) = (self.tables + 1, 0),
            TokenKind::LeftSquareBracket if is_first => {
                self.tables += 1;
                (self.heading, self.dots) = (Some(begin), 0);
            }
            TokenKind::RightSquareBracket => {
                let heading = self.heading.take().and_then(|from| text.get(from..begin));
                if let Some(heading) = heading {
                    // Of [[body.point]] the table around it is there once.
                    if heading != self.last_heading {
                        self.tables += self.dots;
                    }
                    self.last_heading = heading;
                }
                self.dots = 0;
            }
            TokenKind::Comma | TokenKind::Newline => self.dots = 0,
            _ => {}
        }
    }
}

/// Refuses a `text` that asks for more tables than any scenario needs.
///
/// # Errors
/// With the line at which there are too many.
pub(super) fn few_enough(text: &str) -> Result<(), Problem> {
    let mut count = Count::default();
    let (mut line, mut is_first) = (1, true);
    for token in Source::new(text).lex() {
        let kind = token.kind();
        count.follow(kind, text, token.span().start(), is_first);
        if count.tables > MOST {
            let rule = format!(
                "asks for more than {MOST} tables, the most that are allowed: each [heading], each {{}}, and each dot in a key is one"
            );
            let mut problem = Problem::at("", rule);
            problem.place = Some(format!("line {line}"));
            return Err(problem);
        }
        match kind {
            TokenKind::Newline => (line, is_first) = (line + 1, true),
            TokenKind::Whitespace => {}
            _ => is_first = false,
        }
    }
    Ok(())
}
