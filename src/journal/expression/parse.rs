//! Parses an expression: its tokens, and the tree of operators.

use super::{COMPARES, Fault, MULTIPLIES, Node, OPERATORS, Operator};
use std::fmt;

/// How deep parentheses and signs may be nested.
const DEEPEST: usize = 64;

/// The expression in `text`, and each name in it once with its column.
pub(super) fn parse(text: &str) -> Result<(Node, Vec<(String, usize)>), Fault> {
    let mut parser = Parser {
        tokens: tokens(text)?,
        at: 0,
        end: text.chars().count() + 1,
        names: Vec::new(),
        depth: 0,
    };
    let root = parser.expression(0)?;
    match parser.tokens.get(parser.at) {
        None => Ok((root, parser.names)),
        Some((column, token)) => Parser::fault(
            *column,
            format!("{token} cannot follow here: an operator must come first"),
        ),
    }
}

#[derive(Clone)]
enum Token {
    Number(f64),
    Name(String),
    Operator(&'static Operator),
    Open,
    Close,
}

impl fmt::Display for Token {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Number(number) => write!(f, "{number}"),
            Self::Name(name) => f.write_str(name),
            Self::Operator(operator) => f.write_str(operator.name),
            Self::Open => f.write_str("("),
            Self::Close => f.write_str(")"),
        }
    }
}

fn tokens(text: &str) -> Result<Vec<(usize, Token)>, Fault> {
    let characters: Vec<char> = text.chars().collect();
    let mut tokens = Vec::new();
    let mut at = 0;
    while let Some(&c) = characters.get(at) {
        if c.is_whitespace() {
            at += 1;
            continue;
        }
        let rest = &characters[at..];
        let column = at + 1;
        let read = if c.is_ascii_digit() || c == '.' {
            number(rest)
        } else if c.is_ascii_alphabetic() || c == '_' {
            Ok(word(rest))
        } else {
            sign(rest)
        };
        let (token, length) = read.map_err(|rule| Fault { column, rule })?;
        tokens.push((column, token));
        at += length;
    }
    Ok(tokens)
}

/// The number at the beginning of `text`: digits, a point, an exponent.
fn number(text: &[char]) -> Result<(Token, usize), String> {
    let is_part = |index: usize| {
        let c = text[index];
        let before = index.checked_sub(1).map(|before| text[before]);
        c.is_ascii_alphanumeric()
            || c == '.'
            || (matches!(c, '+' | '-') && matches!(before, Some('e' | 'E')))
    };
    let length = (0..text.len())
        .find(|&index| !is_part(index))
        .unwrap_or(text.len());
    let written: String = text[..length].iter().collect();
    match written.parse::<f64>() {
        Ok(number) if number.is_finite() => Ok((Token::Number(number), length)),
        _ => Err(format!("{written} is no number")),
    }
}

/// The name at the beginning of `text`, or the operator that is a word.
fn word(text: &[char]) -> (Token, usize) {
    let is_part = |c: &char| c.is_ascii_alphanumeric() || matches!(c, '_' | '.');
    let name: String = text.iter().take_while(|c| is_part(c)).collect();
    let length = name.len();
    let operator = OPERATORS.iter().find(|operator| operator.name == name);
    let token = operator.map_or(Token::Name(name), Token::Operator);
    (token, length)
}

fn sign(text: &[char]) -> Result<(Token, usize), String> {
    match text[0] {
        '(' => return Ok((Token::Open, 1)),
        ')' => return Ok((Token::Close, 1)),
        _ => {}
    }
    let begins =
        |name: &str| name.chars().zip(text).all(|(a, b)| a == *b) && name.len() <= text.len();
    let operator = OPERATORS.iter().find(|operator| begins(operator.name));
    match (operator, text[0]) {
        (Some(operator), _) => Ok((Token::Operator(operator), operator.name.len())),
        (None, '=') if text.get(1) == Some(&'>') => Err("write >= for =>".to_owned()),
        (None, '=') if text.get(1) == Some(&'<') => Err("write <= for =<".to_owned()),
        (None, '=') => Err("a comparison is written ==".to_owned()),
        (None, '&') => Err("write and".to_owned()),
        (None, '|') => Err("write or, or abs(...)".to_owned()),
        (None, c) => Err(format!("{} has no meaning here", c.escape_debug())),
    }
}

struct Parser {
    tokens: Vec<(usize, Token)>,
    at: usize,
    /// The column after the last character.
    end: usize,
    names: Vec<(String, usize)>,
    depth: usize,
}

impl Parser {
    fn column(&self) -> usize {
        self.tokens
            .get(self.at)
            .map_or(self.end, |(column, _)| *column)
    }

    fn fault<T>(column: usize, rule: impl Into<String>) -> Result<T, Fault> {
        let rule = rule.into();
        Err(Fault { column, rule })
    }

    /// The operands joined by operators that bind at least as tightly as `least`.
    fn expression(&mut self, least: u8) -> Result<Node, Fault> {
        self.depth += 1;
        if self.depth > DEEPEST {
            return Self::fault(self.column(), "it is nested too deep");
        }
        let begin = self.column();
        let mut left = self.operand()?;
        while let Some((column, Token::Operator(operator))) = self.tokens.get(self.at) {
            let (column, operator) = (*column, *operator);
            if operator.power < least {
                break;
            }
            self.at += 1;
            let right_begins = self.column();
            let right = self.expression(operator.power + 1)?;
            for (side, at) in [(&left, begin), (&right, right_begins)] {
                Self::check_side(operator, side, at, column)?;
            }
            left = Node::Computed(operator, Box::new(left), Box::new(right));
        }
        self.depth -= 1;
        Ok(left)
    }

    fn check_side(operator: &Operator, side: &Node, at: usize, column: usize) -> Result<(), Fault> {
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

    fn operand(&mut self) -> Result<Node, Fault> {
        let Some((column, token)) = self.tokens.get(self.at).cloned() else {
            return Self::fault(self.end, "a number or a name is missing at the end");
        };
        self.at += 1;
        match token {
            Token::Number(number) => Ok(Node::Number(number)),
            Token::Operator(operator) if operator.name == "-" => {
                let inner = self.expression(MULTIPLIES + 1)?;
                Self::check_side(operator, &inner, column, column)?;
                Ok(Node::Negated(Box::new(inner)))
            }
            Token::Open => {
                let inner = self.expression(0)?;
                self.close(column)?;
                Ok(inner)
            }
            Token::Name(name) if name == "abs" => self.absolute(column),
            Token::Name(name) => Ok(Node::Name(self.number_of(name, column))),
            other => Self::fault(
                column,
                format!("{other} needs a number or a name before it"),
            ),
        }
    }

    fn absolute(&mut self, column: usize) -> Result<Node, Fault> {
        if !matches!(self.tokens.get(self.at), Some((_, Token::Open))) {
            return Self::fault(self.column(), "abs needs parentheses: abs(...)");
        }
        let inner = self.operand()?;
        if inner.is_condition() {
            return Self::fault(column, "abs takes a number, not a comparison");
        }
        Ok(Node::Absolute(Box::new(inner)))
    }

    fn close(&mut self, opened: usize) -> Result<(), Fault> {
        if !matches!(self.tokens.get(self.at), Some((_, Token::Close))) {
            let rule = format!("the parenthesis of column {opened} is not closed");
            return Self::fault(self.column(), rule);
        }
        self.at += 1;
        Ok(())
    }

    fn number_of(&mut self, name: String, column: usize) -> usize {
        let known = self.names.iter().position(|(known, _)| *known == name);
        known.unwrap_or_else(|| {
            self.names.push((name, column));
            self.names.len() - 1
        })
    }
}
