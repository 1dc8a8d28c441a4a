//! Parses expressions. Errors have a position and a reason.

use super::node::{COMPARES, ExpressionNode, MULTIPLIES, OPERATORS, Operator};

#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("column {column}: {rule}")]
pub struct Fault {
    /// Position of the error, characters from 1.
    pub column: usize,
    pub rule: String,
}

const LONGEST_EXPRESSION: usize = 1000;
/// Maximum depth of nested parentheses and signs.
const DEEPEST_NESTING: usize = 64;

/// Parses `text`. Returns the expression, and every name once with the column (from 1) of its first occurrence.
pub fn parse(text: &str) -> Result<(ExpressionNode, Vec<(String, usize)>), Fault> {
    if text.len() > LONGEST_EXPRESSION {
        let rule = format!("an expression has at most {LONGEST_EXPRESSION} characters");
        return Err(Fault { column: 1, rule });
    }
    let mut parser = Parser {
        text,
        at: 0,
        names: Vec::new(),
        depth: 0,
    };
    let root = parser.expression(0)?;
    if !parser.rest().is_empty() {
        return parser.misplaced("cannot follow here: an operator must come first");
    }
    Ok((root, parser.names))
}

/// Parses `text` from beginning to end.
struct Parser<'a> {
    text: &'a str,
    /// Position of the next character, bytes.
    at: usize,
    /// Each name once, with its column.
    names: Vec<(String, usize)>,
    depth: usize,
}

/// Returns the number, name or word operator at the beginning of `rest`. It is empty if `rest` begins with a sign.
fn word(rest: &str) -> &str {
    let is_number = rest.starts_with(|c: char| c.is_ascii_digit() || c == '.');
    let mut before = ' ';
    let end = rest.find(|c: char| {
        let is_of_exponent = matches!((before, c), ('e' | 'E', '+' | '-'));
        before = c;
        let is_of_both = c.is_ascii_alphanumeric() || c == '.';
        !(is_of_both || if is_number { is_of_exponent } else { c == '_' })
    });
    &rest[..end.unwrap_or(rest.len())]
}

/// Describes the error of the sign `c`, which is followed by `next`.
fn no_meaning(c: char, next: Option<char>) -> String {
    match (c, next) {
        ('=', Some('>')) => "write >= for =>".to_owned(),
        ('=', Some('<')) => "write <= for =<".to_owned(),
        ('=', _) => "write == for a comparison".to_owned(),
        ('&', _) => "write and".to_owned(),
        ('|', _) => "write or, or abs(...)".to_owned(),
        _ => format!("{} has no meaning here", c.escape_debug()),
    }
}

impl<'a> Parser<'a> {
    /// Returns the rest of the text, without leading spaces.
    fn rest(&mut self) -> &'a str {
        let rest = self.text[self.at..].trim_start();
        self.at = self.text.len() - rest.len();
        rest
    }

    /// Returns the column of the next character that is not a space.
    fn column(&mut self) -> usize {
        self.rest();
        self.text[..self.at].chars().count() + 1
    }

    fn operator(&mut self) -> Option<&'static Operator> {
        let rest = self.rest();
        let read = word(rest);
        OPERATORS.iter().find(|operator| match read {
            "" => rest.starts_with(operator.name),
            word => operator.name == word,
        })
    }

    fn fault<T>(column: usize, rule: impl Into<String>) -> Result<T, Fault> {
        Err(Fault {
            column,
            rule: rule.into(),
        })
    }

    /// Returns an error for the token at the cursor: `rule` if the token is known, otherwise that it has no meaning.
    fn misplaced<T>(&mut self, rule: &str) -> Result<T, Fault> {
        let column = self.column();
        let rest = self.rest();
        let mut signs = rest.chars();
        let known = self.operator().map_or(word(rest), |operator| operator.name);
        match (known, signs.next()) {
            ("", Some(c @ ('(' | ')'))) => Self::fault(column, format!("{c} {rule}")),
            ("", Some(c)) => Self::fault(column, no_meaning(c, signs.next())),
            _ => Self::fault(column, format!("{known} {rule}")),
        }
    }

    /// Parses operands joined by operators with a precedence of at least `least`.
    fn expression(&mut self, least: u8) -> Result<ExpressionNode, Fault> {
        let begin = self.column();
        self.depth += 1;
        if self.depth > DEEPEST_NESTING {
            return Self::fault(begin, "the expression is nested too deeply");
        }
        let mut left = self.operand()?;
        while let Some(operator) = self.operator().filter(|it| it.power >= least) {
            let column = self.column();
            self.at += operator.name.len();
            let right_begins = self.column();
            let right = self.expression(operator.power + 1)?;
            for (side, at) in [(&left, begin), (&right, right_begins)] {
                Self::check_side(operator, side, at, column)?;
            }
            left = ExpressionNode::Computed(operator, Box::new(left), Box::new(right));
        }
        self.depth -= 1;
        Ok(left)
    }

    fn check_side(
        operator: &Operator,
        side: &ExpressionNode,
        at: usize,
        column: usize,
    ) -> Result<(), Fault> {
        let name = operator.name;
        match (operator.power < COMPARES, side.is_condition()) {
            (true, false) => Self::fault(at, format!("{name} joins comparisons, not numbers")),
            (false, true) => {
                let rule = format!("{name} takes numbers, not comparisons: join those with and");
                Self::fault(column, rule)
            }
            _ => Ok(()),
        }
    }

    fn operand(&mut self) -> Result<ExpressionNode, Fault> {
        let (column, rest, operator) = (self.column(), self.rest(), self.operator());
        let read = word(rest);
        match (operator, rest.chars().next()) {
            (_, None) => Self::fault(column, "a number or a name is missing at the end"),
            (Some(operator), Some('-')) => {
                self.at += 1;
                let inner = self.expression(MULTIPLIES + 1)?;
                Self::check_side(operator, &inner, column, column)?;
                Ok(ExpressionNode::Negated(Box::new(inner)))
            }
            (None, Some('(')) => {
                self.at += 1;
                let inside = self.expression(0)?;
                if !self.rest().starts_with(')') {
                    let rule = format!("the parenthesis of column {column} is not closed");
                    return Self::fault(self.column(), rule);
                }
                self.at += 1;
                Ok(inside)
            }
            (None, Some(c)) if c.is_ascii_digit() || c == '.' => {
                self.at += read.len();
                match read.parse::<f64>() {
                    Ok(number) if number.is_finite() => Ok(ExpressionNode::Number(number)),
                    _ => Self::fault(column, format!("{read} is not a number")),
                }
            }
            (None, Some(_)) if !read.is_empty() => {
                self.at += read.len();
                match read {
                    "abs" => self.absolute(column),
                    name => Ok(ExpressionNode::Name(self.number_of(name, column))),
                }
            }
            _ => self.misplaced("needs a number or a name before it"),
        }
    }

    fn absolute(&mut self, column: usize) -> Result<ExpressionNode, Fault> {
        if !self.rest().starts_with('(') {
            return Self::fault(self.column(), "abs needs parentheses: abs(...)");
        }
        let inner = self.operand()?;
        if inner.is_condition() {
            return Self::fault(column, "abs takes a number, not a comparison");
        }
        Ok(ExpressionNode::Absolute(Box::new(inner)))
    }

    fn number_of(&mut self, name: &str, column: usize) -> usize {
        let known = self.names.iter().position(|(known, _)| known == name);
        known.unwrap_or_else(|| {
            self.names.push((name.to_owned(), column));
            self.names.len() - 1
        })
    }
}
