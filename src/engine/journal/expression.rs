//! Expressions over a run's numbers: `t_s >= 60 and abs(tilt_deg - 45) < 0.5`.
//!
//! Numbers, names, `+ - * /`, parentheses, `abs(...)`, the comparisons `< <= > >= == !=`, `and`, `or`. A name stands
//! for a readout or for a key of the scenario; the caller looks its value up. A name may have no value at a step: what
//! is computed from it has none either, and a comparison with it neither holds nor fails.

use serde::{Deserialize, Serialize};

const LONGEST_EXPRESSION: usize = 1000;

#[derive(Clone, Debug, Serialize, Deserialize)]
#[serde(try_from = "String", into = "String")]
pub struct Expression {
    text: String,
    root: ExpressionNode,
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
enum ExpressionNode {
    Number(f64),
    Name(usize),
    Negated(Box<ExpressionNode>),
    Absolute(Box<ExpressionNode>),
    Computed(&'static Operator, Box<ExpressionNode>, Box<ExpressionNode>),
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
    /// Returns the result where one side alone decides it, whatever the other is.
    fn decided_by(&self, side: Option<f64>) -> Option<f64> {
        match (self.power, side?) {
            (OR, value) if value != 0.0 => Some(1.0),
            (AND, 0.0) => Some(0.0),
            _ => None,
        }
    }

    /// Returns the result with the value `left`; `right` computes the other one where it is needed.
    fn value(&self, left: Option<f64>, right: impl FnOnce() -> Option<f64>) -> Option<f64> {
        self.decided_by(left).or_else(|| {
            let other = right();
            let decided = self.decided_by(other);
            decided.or_else(|| Some((self.apply)(left?, other?)))
        })
    }
}

impl Expression {
    pub fn parse(text: &str) -> Result<Self, Fault> {
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
        Ok(Self {
            text: text.to_owned(),
            root,
            names: parser.names,
        })
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
        self.names
            .iter()
            .map(|(name, column)| {
                find(name).map_err(|rule| Fault {
                    column: *column,
                    rule,
                })
            })
            .collect()
    }

    /// Its value, with the values of the names from `value_of`; `None` where a number that it needs has no value. A
    /// condition is 1 where it holds and 0 where it does not.
    pub fn value(&self, mut value_of: impl FnMut(&str) -> Option<f64>) -> Option<f64> {
        self.value_at(|index| value_of(&self.names[index].0))
    }

    /// Returns the same, with the value of the name of each index, as [`bind`](Self::bind) lists them. A name that
    /// cannot change the result any more is not looked up.
    pub fn value_at(&self, mut value_of: impl FnMut(usize) -> Option<f64>) -> Option<f64> {
        self.root.value(&mut value_of)
    }
}

/// A part of a condition that `and` joins to the others.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Conjunct {
    pub holds: bool,
    /// The left side of the comparison, where it is one that has a value; of `abs(EXPRESSION - NUMBER)` the expression.
    pub left: Option<f64>,
}

impl Expression {
    /// Returns the parts that `and` joins, in their order, with the values of the names from `value_of`. A part in
    /// parentheses counts as one.
    pub fn conjuncts(&self, mut value_of: impl FnMut(&str) -> Option<f64>) -> Vec<Conjunct> {
        let mut name = |index: usize| value_of(&self.names[index].0);
        let mut parts = Vec::new();
        let mut rest = &self.root;
        while let ExpressionNode::Computed(Operator { power: AND, .. }, left, right) = rest {
            parts.push(right.as_ref());
            rest = left;
        }
        parts.push(rest);
        parts
            .into_iter()
            .rev()
            .map(|part| Conjunct {
                holds: part.value(&mut name).is_some_and(|value| value != 0.0),
                left: match part {
                    ExpressionNode::Computed(operator, left, _) if operator.power == COMPARES => {
                        left.off_by().unwrap_or(left).value(&mut name)
                    }
                    _ => None,
                },
            })
            .collect()
    }
}

impl ExpressionNode {
    /// Returns the expression in `abs(EXPRESSION - NUMBER)`.
    fn off_by(&self) -> Option<&Self> {
        let Self::Absolute(inside) = self else {
            return None;
        };
        match inside.as_ref() {
            Self::Computed(Operator { name: "-", .. }, left, right)
                if matches!(**right, Self::Number(_)) =>
            {
                Some(left)
            }
            _ => None,
        }
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

impl ExpressionNode {
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
                let known = left.value(name);
                operator.value(known, || right.value(name))
            }
        }
    }
}

/// How deep parentheses and signs may be nested.
const DEEPEST_NESTING: usize = 64;

/// Reads `text` from its beginning to its end.
struct Parser<'a> {
    text: &'a str,
    /// Where the next character stands, in bytes.
    at: usize,
    /// Each name once, with its column.
    names: Vec<(String, usize)>,
    depth: usize,
}

/// Returns the number, name or operator in letters at the beginning of `rest`; empty where it begins with a sign.
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

/// Returns what is wrong with the sign `c`, which `next` follows.
fn no_meaning(c: char, next: Option<char>) -> String {
    match (c, next) {
        ('=', Some('>')) => "write >= for =>".to_owned(),
        ('=', Some('<')) => "write <= for =<".to_owned(),
        ('=', _) => "a comparison is written ==".to_owned(),
        ('&', _) => "write and".to_owned(),
        ('|', _) => "write or, or abs(...)".to_owned(),
        _ => format!("{} has no meaning here", c.escape_debug()),
    }
}

impl<'a> Parser<'a> {
    /// Returns what has not been read; it begins with no space.
    fn rest(&mut self) -> &'a str {
        let rest = self.text[self.at..].trim_start();
        self.at = self.text.len() - rest.len();
        rest
    }

    /// Returns the column of the next character that is no space.
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

    /// Error for the token at the cursor: `rule` if the token is known, else that it has no meaning.
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

    /// Returns the operands joined by operators that bind at least as tightly as `least`.
    fn expression(&mut self, least: u8) -> Result<ExpressionNode, Fault> {
        let begin = self.column();
        self.depth += 1;
        if self.depth > DEEPEST_NESTING {
            return Self::fault(begin, "it is nested too deep");
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
                    _ => Self::fault(column, format!("{read} is no number")),
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
    fn a_condition_is_taken_apart() {
        let that =
            "t_s >= 5 and (tilt_deg < 0 and 1 < 2) and abs(tilt_deg) < 2 and abs(tilt_deg - 1) < 2";
        let parts = Expression::parse(that)
            .unwrap()
            .conjuncts(|name| match name {
                "t_s" => Some(4.0),
                _ => Some(-3.0),
            });
        let parts: Vec<_> = parts.iter().map(|part| (part.holds, part.left)).collect();
        assert_eq!(
            parts,
            [
                (false, Some(4.0)),
                (true, None),
                (false, Some(3.0)),
                (false, Some(-3.0))
            ]
        );
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
