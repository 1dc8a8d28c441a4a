//! The operations of an expression and their values.

#[derive(Clone, Debug)]
pub enum ExpressionNode {
    Number(f64),
    Name(usize),
    Negated(Box<ExpressionNode>),
    Absolute(Box<ExpressionNode>),
    Computed(&'static Operator, Box<ExpressionNode>, Box<ExpressionNode>),
}

#[derive(Debug)]
pub struct Operator {
    pub name: &'static str,
    /// Precedence. A larger number binds more tightly.
    pub power: u8,
    apply: fn(f64, f64) -> f64,
}

const OR: u8 = 1;
pub const AND: u8 = 2;
pub const COMPARES: u8 = 3;
const ADDS: u8 = 4;
pub const MULTIPLIES: u8 = 5;

/// All operators. If two begin alike, the longer one comes first. A condition is 1 if true and 0 if false.
pub static OPERATORS: [Operator; 12] = [
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
    // Result if neither side decides it.
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
    /// Returns the result if this side alone decides it.
    fn decided_by(&self, side: Option<f64>) -> Option<f64> {
        match (self.power, side?) {
            (OR, value) if value != 0.0 => Some(1.0),
            (AND, 0.0) => Some(0.0),
            _ => None,
        }
    }

    /// Returns the result for the value `left`. `right` is called only if the other value is needed.
    fn value(&self, left: Option<f64>, right: impl FnOnce() -> Option<f64>) -> Option<f64> {
        self.decided_by(left).or_else(|| {
            let other = right();
            let decided = self.decided_by(other);
            decided.or_else(|| Some((self.apply)(left?, other?)))
        })
    }
}

impl ExpressionNode {
    /// Returns the expression in `abs(EXPRESSION - NUMBER)`.
    pub fn off_by(&self) -> Option<&Self> {
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

    pub fn is_condition(&self) -> bool {
        matches!(self, Self::Computed(operator, ..) if operator.power <= COMPARES)
    }

    pub fn value(&self, name: &mut impl FnMut(usize) -> Option<f64>) -> Option<f64> {
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
