//! Expressions over a run's numbers: `t_s >= 60 and abs(tilt_deg - 45) < 0.5`.
//!
//! An expression consists of numbers, names, `+ - * /`, parentheses, `abs(...)`, the comparisons `< <= > >= == !=`,
//! `and` and `or`. A name is a readout or a key of the scenario, and the caller looks up its value. If a name has no
//! value at a step, neither has a result computed from it, and a comparison with it is neither true nor false.

mod node;
mod parser;

use node::{AND, COMPARES, ExpressionNode, Operator};
pub use parser::Fault;
use serde::{Deserialize, Serialize};

#[derive(Clone, Debug, Serialize, Deserialize)]
#[serde(try_from = "String", into = "String")]
pub struct Expression {
    text: String,
    root: ExpressionNode,
    /// Every name once, with the column (from 1) of its first occurrence.
    names: Vec<(String, usize)>,
}

impl Expression {
    pub fn parse(text: &str) -> Result<Self, Fault> {
        let (root, names) = parser::parse(text)?;
        Ok(Self {
            text: text.to_owned(),
            root,
            names,
        })
    }

    /// Parses `text`, which must be a condition.
    pub fn condition(text: &str) -> Result<Self, Fault> {
        let expression = Self::parse(text)?;
        if expression.is_condition() {
            return Ok(expression);
        }
        let rule = "must be a comparison, such as t_s >= 60".to_owned();
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

    /// Looks up each name once with `find`, which returns an error message if a name is not a number.
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

    /// Returns the value of the expression, with the values of names from `value_of`. `None` if a number that it needs
    /// has no value. A condition is 1 if true and 0 if false.
    pub fn value(&self, mut value_of: impl FnMut(&str) -> Option<f64>) -> Option<f64> {
        self.value_at(|index| value_of(&self.names[index].0))
    }

    /// Returns the same value. `value_of` takes the index of a name in the list of [`bind`](Self::bind). Names that can
    /// no longer change the result are not looked up.
    pub fn value_at(&self, mut value_of: impl FnMut(usize) -> Option<f64>) -> Option<f64> {
        self.root.value(&mut value_of)
    }
}

/// A part of a condition, joined to the others by `and`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Conjunct {
    pub holds: bool,
    /// Left side of the part, if it is a comparison that has a value. For `abs(EXPRESSION - NUMBER)`, the value of
    /// EXPRESSION.
    pub left: Option<f64>,
}

impl Expression {
    /// Returns the parts joined by `and`, in order, with the values of names from `value_of`. A part in parentheses
    /// counts as one.
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
    fn operators_have_the_usual_precedence_and_unknown_values_propagate() {
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
    fn a_condition_splits_into_conjuncts() {
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
            ("t_s + 1", 1, "must be a comparison"),
            ("1 < t_s < 3", 9, "and"),
            ("t_s and t_s > 1", 1, "joins comparisons"),
            ("t_s > 1 and 3", 13, "joins comparisons"),
            ("abs t_s > 1", 5, "abs(...)"),
            ("* 3 > 1", 1, "before it"),
            ("t_s > 1.2.3", 7, "not a number"),
            ("t_s > 1e999", 7, "not a number"),
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
