//! Expressions over a run's numbers: `t_s >= 60 and abs(tilt_deg - 45) < 0.5`.
//!
//! Numbers, names, `+ - * /`, parentheses, `abs(...)`, the comparisons `< <= > >= == !=`, `and`, `or`. A name stands
//! for a readout or for a key of the scenario; the caller looks its value up. A name may have no value at a step: what
//! is computed from it has none either, and a comparison with it neither holds nor fails.

use serde::{Deserialize, Serialize};
use std::fmt;

const LONGEST: usize = 1000;

#[derive(Clone, Debug, Serialize, Deserialize)]
#[serde(try_from = "String", into = "String")]
pub struct Expression {
    text: String,
    root: Node,
    /// Every name in it once, and the column (from 1) where it stands first.
    names: Vec<(String, usize)>,
}

#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("column {column}: {rule}")]
pub struct Fault {
    /// The character at which the error shows, counted from 1.
    pub column: usize,
    pub rule: String,
}

#[derive(Clone, Debug)]
enum Node {
    Number(f64),
    Name(usize),
    Negated(Box<Node>),
    Absolute(Box<Node>),
    Computed(&'static Operator, Box<Node>, Box<Node>),
}

#[derive(Debug)]
struct Operator {
    name: &'static str,
    /// How tightly it binds: the larger, the tighter.
    power: u8,
    apply: fn(f64, f64) -> f64,
}

const OR: u8 = 1;
const AND: u8 = 2;
const COMPARES: u8 = 3;
const ADDS: u8 = 4;
const MULTIPLIES: u8 = 5;

/// Of two that begin alike the longer stands first. A condition is 1 where it holds and 0 where it does not.
static OPERATORS: [Operator; 12] = [
    operator("<=", COMPARES, |a, b| truth(a <= b)),
    operator(">=", COMPARES, |a, b| truth(a >= b)),
    operator("==", COMPARES, |a, b| truth(a == b)),
    operator("!=", COMPARES, |a, b| truth(a != b)),
    operator("<", COMPARES, |a, b| truth(a < b)),
    operator(">", COMPARES, |a, b| truth(a > b)),
    operator("+", ADDS, |a, b| a + b),
    operator("-", ADDS, |a, b| a - b),
    operator("*", MULTIPLIES, |a, b| a * b),
    operator("/", MULTIPLIES, |a, b| a / b),
    // Where neither side decides.
    operator("and", AND, |_, _| 1.0),
    operator("or", OR, |_, _| 0.0),
];

const fn operator(name: &'static str, power: u8, apply: fn(f64, f64) -> f64) -> Operator {
    Operator { name, power, apply }
}

fn truth(holds: bool) -> f64 {
    f64::from(u8::from(holds))
}

impl Operator {
    /// The result where one side alone decides it, whatever the other is.
    fn decided_by(&self, side: Option<f64>) -> Option<f64> {
        match (self.power, side?) {
            (OR, value) if value != 0.0 => Some(1.0),
            (AND, 0.0) => Some(0.0),
            _ => None,
        }
    }

    fn value(&self, left: Option<f64>, right: impl FnOnce() -> Option<f64>) -> Option<f64> {
        self.decided_by(left).or_else(|| {
            let right = right();
            let decided = self.decided_by(right);
            decided.or_else(|| Some((self.apply)(left?, right?)))
        })
    }
}

impl Expression {
    pub fn parse(text: &str) -> Result<Self, Fault> {
        if text.len() > LONGEST {
            let rule = format!("an expression has at most {LONGEST} characters");
            return Err(Fault { column: 1, rule });
        }
        let (root, names) = tree(text)?;
        let text = text.to_owned();
        Ok(Self { text, root, names })
    }

    /// Reads `text`, which must say whether something holds.
    pub fn condition(text: &str) -> Result<Self, Fault> {
        let expression = Self::parse(text)?;
        if expression.is_condition() {
            return Ok(expression);
        }
        let rule = "must compare, such as t_s >= 60".to_owned();
        Err(Fault { column: 1, rule })
    }

    pub fn text(&self) -> &str {
        &self.text
    }

    pub fn is_condition(&self) -> bool {
        self.root.is_condition()
    }

    pub fn names(&self) -> impl Iterator<Item = &str> {
        self.names.iter().map(|(name, _)| name.as_str())
    }

    /// Looks each name up once, with `find`, which returns in words why a name stands for no number.
    pub fn bind<'a, T>(
        &'a self,
        find: impl Fn(&'a str) -> Result<T, String>,
    ) -> Result<Vec<T>, Fault> {
        let look_up = |(name, column): &'a (String, usize)| {
            find(name).map_err(|rule| Fault {
                column: *column,
                rule,
            })
        };
        self.names.iter().map(look_up).collect()
    }

    /// Its value, with the values of the names from `value_of`; `None` where a number that it needs has no value. A
    /// condition is 1 where it holds and 0 where it does not.
    pub fn value(&self, mut value_of: impl FnMut(&str) -> Option<f64>) -> Option<f64> {
        self.value_at(|index| value_of(&self.names[index].0))
    }

    /// The same, with the value of the name of each index, as [`bind`](Self::bind) lists them. A name that cannot change
    /// the result any more is not looked up.
    pub fn value_at(&self, mut value_of: impl FnMut(usize) -> Option<f64>) -> Option<f64> {
        self.root.value(&mut value_of)
    }
}

impl TryFrom<String> for Expression {
    type Error = Fault;

    fn try_from(text: String) -> Result<Self, Fault> {
        Self::parse(&text)
    }
}

impl From<Expression> for String {
    fn from(expression: Expression) -> Self {
        expression.text
    }
}

impl PartialEq for Expression {
    fn eq(&self, other: &Self) -> bool {
        self.text == other.text
    }
}

impl Node {
    fn is_condition(&self) -> bool {
        matches!(self, Self::Computed(operator, ..) if operator.power <= COMPARES)
    }

    fn value(&self, name: &mut impl FnMut(usize) -> Option<f64>) -> Option<f64> {
        match self {
            Self::Number(number) => Some(*number),
            Self::Name(index) => name(*index),
            Self::Negated(inner) => Some(-inner.value(name)?),
            Self::Absolute(inner) => Some(inner.value(name)?.abs()),
            Self::Computed(operator, left, right) => {
                let left = left.value(name);
                operator.value(left, || right.value(name))
            }
        }
    }
}

/// How deep parentheses and signs may be nested.
const DEEPEST: usize = 64;

/// The expression in `text`, and each name in it once with its column.
fn tree(text: &str) -> Result<(Node, Vec<(String, usize)>), Fault> {
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

#[cfg(test)]
mod tests {
    use super::*;

    fn value(text: &str) -> Option<f64> {
        let numbers = |name: &str| match name {
            "t_s" => Some(60.0),
            "tilt_deg" => Some(-3.0),
            "push.0.force_N.2" => Some(-50.0),
            _ => None,
        };
        Expression::parse(text).unwrap().value(numbers)
    }

    fn fault(text: &str) -> (usize, String) {
        let fault = Expression::condition(text).unwrap_err();
        (fault.column, fault.rule)
    }

    #[test]
    fn operators_bind_as_in_arithmetic_and_what_is_not_known_decides_nothing() {
        for (text, known) in [
            ("1 + 2 * 3", Some(7.0)),
            ("(1 + 2) * 3", Some(9.0)),
            ("8 / 2 / 2", Some(2.0)),
            ("-2 * -3", Some(6.0)),
            ("2e3 + 1.5e-1", Some(2000.15)),
            ("abs(tilt_deg) + push.0.force_N.2", Some(-47.0)),
            ("1 + 1 == 2 and 2 > 1", Some(1.0)),
            ("1 > 2 or 2 > 1 and 1 > 2", Some(0.0)),
            ("(1 > 2 or 2 > 1) and 1 != 2", Some(1.0)),
            ("nothing + 1", None),
            ("nothing > 1", None),
            ("nothing > 1 or t_s > 1", Some(1.0)),
            ("t_s < 1 and nothing > 1", Some(0.0)),
            ("nothing > 1 and t_s > 1", None),
        ] {
            assert_eq!(value(text), known, "{text}");
        }
    }

    #[test]
    fn every_fault_has_its_column() {
        for (text, column, words) in [
            ("", 1, "missing"),
            ("t_s >=", 7, "missing"),
            ("t_s >= 60 x", 11, "cannot follow"),
            ("t_s = 60", 5, "=="),
            ("(t_s > 1", 9, "column 1 is not closed"),
            ("t_s + 1", 1, "must compare"),
            ("1 < t_s < 3", 9, "and"),
            ("t_s and t_s > 1", 1, "joins comparisons"),
            ("t_s > 1 and 3", 13, "joins comparisons"),
            ("abs t_s > 1", 5, "abs(...)"),
            ("* 3 > 1", 1, "before it"),
            ("t_s > 1.2.3", 7, "no number"),
            ("t_s > 1e999", 7, "no number"),
            ("t_s > ü", 7, "no meaning"),
        ] {
            let (at, rule) = fault(text);
            assert_eq!(at, column, "{text}: {rule}");
            assert!(rule.contains(words), "{text}: {rule}");
        }
        assert!(fault(&"(".repeat(500)).1.contains("deep"));
        assert!(fault(&"1".repeat(2000)).1.contains("1000"));
    }
}
