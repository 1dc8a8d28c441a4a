//! Expressions over a run's numbers: `t_s >= 60 and abs(tilt_deg - 45) < 0.5`.
//!
//! Numbers, names, `+ - * /`, parentheses, `abs(...)`, the comparisons `< <= > >= == !=`, `and`, `or`. A name stands
//! for a readout or for a key of the scenario; the caller looks its value up. A name may have no value at a step: what
//! is computed from it has none either, and a comparison with it neither holds nor fails.

mod parse;

use serde::{Deserialize, Serialize};

/// The longest expression, bytes.
const LONGEST: usize = 1000;

#[derive(Clone, Debug, Serialize, Deserialize)]
#[serde(try_from = "String", into = "String")]
pub struct Expression {
    text: String,
    root: Node,
    /// Every name in it once, and the column (from 1) where it stands first.
    names: Vec<(String, usize)>,
}

/// What is wrong with an expression, and where.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("column {column}: {rule}")]
pub struct Fault {
    /// The character at which the error shows, counted from 1.
    pub column: usize,
    /// What is wrong there, and the remedy.
    pub rule: String,
}

#[derive(Clone, Debug)]
enum Node {
    Number(f64),
    /// The number of the name.
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
        let (root, names) = parse::parse(text)?;
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

    /// Whether it is a condition, not a number.
    pub fn is_condition(&self) -> bool {
        self.root.is_condition()
    }

    pub fn names(&self) -> impl Iterator<Item = &str> {
        self.names.iter().map(|(name, _)| name.as_str())
    }

    /// Looks each name up once, with `find`, which returns in words why a name stands for no number.
    ///
    /// # Errors
    /// The first name that is not found, where it stands, and why.
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

/// A part of a condition that `and` joins to the others.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Conjunct {
    pub holds: bool,
    /// The left side of the comparison, where it is one that has a value.
    pub left: Option<f64>,
}

impl Expression {
    /// The parts that `and` joins, in their order, with the values of the names from `value_of`. A part in parentheses
    /// counts as one.
    pub fn conjuncts(&self, mut value_of: impl FnMut(&str) -> Option<f64>) -> Vec<Conjunct> {
        let mut name = |index: usize| value_of(&self.names[index].0);
        let mut parts = Vec::new();
        let mut rest = &self.root;
        while let Node::Computed(Operator { power: AND, .. }, left, right) = rest {
            parts.push(right.as_ref());
            rest = left;
        }
        parts.push(rest);
        let conjunct = |part: &Node| Conjunct {
            holds: part.value(&mut name).is_some_and(|value| value != 0.0),
            left: match part {
                Node::Computed(operator, left, _) if operator.power == COMPARES => {
                    left.value(&mut name)
                }
                _ => None,
            },
        };
        parts.into_iter().rev().map(conjunct).collect()
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
            ("7 - 2 - 3", Some(2.0)),
            ("8 / 2 / 2", Some(2.0)),
            ("-2 * -3", Some(6.0)),
            ("--2", Some(2.0)),
            ("1 - -2", Some(3.0)),
            ("2e3 + 1.5e-1", Some(2000.15)),
            ("abs(tilt_deg) + push.0.force_N.2", Some(-47.0)),
            ("1 + 1 == 2 and 2 > 1", Some(1.0)),
            ("1 > 2 or 2 > 1 and 1 > 2", Some(0.0)),
            ("(1 > 2 or 2 > 1) and 1 != 2", Some(1.0)),
            ("t_s >= 60 and t_s <= 60", Some(1.0)),
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
        let that = "t_s >= 5 and (tilt_deg < 0 and 1 < 2) and abs(tilt_deg) < 2";
        let parts = Expression::parse(that)
            .unwrap()
            .conjuncts(|name| match name {
                "t_s" => Some(4.0),
                _ => Some(-3.0),
            });
        let parts: Vec<_> = parts.iter().map(|part| (part.holds, part.left)).collect();
        assert_eq!(
            parts,
            [(false, Some(4.0)), (true, None), (false, Some(3.0))]
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
            ("t_s > 1)", 8, "cannot follow"),
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
        assert!(fault(&"-".repeat(500)).1.contains("deep"));
        assert!(fault(&"1".repeat(2000)).1.contains("1000"));
    }
}
