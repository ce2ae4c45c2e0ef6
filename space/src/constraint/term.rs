//! Terms: numbers that are computed from the parameters of a test, as in `ego_speed - lead_speed`.

use super::written::Name;
use std::fmt;

/// A number that is computed from the values of parameters.
#[derive(Debug, Clone, PartialEq)]
pub enum Term {
    /// A finite number.
    Number(f64),
    /// The value of the parameter with this name.
    Parameter(String),
    /// A function of the values of other terms, with as many operands as [`Function::operands`] says.
    Applied(Function, Vec<Term>),
}

/// An operator or a function of terms.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Function {
    /// The sum `a + b`.
    Add,
    /// The difference `a - b`.
    Subtract,
    /// The product `a * b`.
    Multiply,
    /// The quotient `a / b`. It has no value if `b` is 0.
    Divide,
    /// The remainder `a % b` of the division with the quotient rounded to zero. It has the sign of `a`.
    Remainder,
    /// The number `-a`.
    Negate,
    /// The smaller number `min(a, b)`.
    Least,
    /// The larger number `max(a, b)`.
    Greatest,
    /// The size `abs(a)`.
    Absolute,
    /// The square root `sqrt(a)`. It has no value if `a` is negative.
    Root,
    /// The power `pow(a, b)`.
    Power,
    /// The greatest whole number that is at most `a`, `floor(a)`.
    Floor,
    /// The least whole number that is at least `a`, `ceil(a)`.
    Ceiling,
    /// The nearest whole number `round(a)`. A half is rounded away from 0.
    Round,
    /// The sign `sign(a)`: -1, 0 or 1.
    Sign,
    /// The sine `sin(a)` of an angle in radians.
    Sine,
    /// The cosine `cos(a)` of an angle in radians.
    Cosine,
    /// The tangent `tan(a)` of an angle in radians.
    Tangent,
    /// The angle `asin(a)` in radians.
    ArcSine,
    /// The angle `acos(a)` in radians.
    ArcCosine,
    /// The angle `atan(a)` in radians.
    ArcTangent,
}

/// The functions that are written with a name, such as `min(a, b)`.
const NAMED: [(&str, Function); 15] = [
    ("min", Function::Least),
    ("max", Function::Greatest),
    ("abs", Function::Absolute),
    ("sqrt", Function::Root),
    ("pow", Function::Power),
    ("floor", Function::Floor),
    ("ceil", Function::Ceiling),
    ("round", Function::Round),
    ("sign", Function::Sign),
    ("sin", Function::Sine),
    ("cos", Function::Cosine),
    ("tan", Function::Tangent),
    ("asin", Function::ArcSine),
    ("acos", Function::ArcCosine),
    ("atan", Function::ArcTangent),
];

impl Function {
    /// Returns the function that is written with this name, such as `min`.
    pub fn named(name: &str) -> Option<Self> {
        NAMED.iter().find(|(known, _)| *known == name).map(|(_, function)| *function)
    }

    /// Iterates over the names of the functions that are written with a name.
    pub fn names() -> impl Iterator<Item = &'static str> {
        NAMED.iter().map(|(name, _)| *name)
    }

    /// Returns the number of operands, which is 1 or 2.
    pub fn operands(self) -> usize {
        let has_two = matches!(self, Self::Least | Self::Greatest | Self::Power) || self.sign().is_some();
        if has_two { 2 } else { 1 }
    }

    /// Returns the value of the function; `None` if the function has no value that is a finite number.
    ///
    /// # Panics
    /// There are fewer operands than the function needs.
    pub fn value(self, operands: &[f64]) -> Option<f64> {
        let a = operands[0];
        let value = match self {
            Self::Add => a + operands[1],
            Self::Subtract => a - operands[1],
            Self::Multiply => a * operands[1],
            Self::Divide => a / operands[1],
            Self::Remainder => a % operands[1],
            Self::Negate => -a,
            Self::Least => a.min(operands[1]),
            Self::Greatest => a.max(operands[1]),
            Self::Absolute => a.abs(),
            Self::Root => a.sqrt(),
            Self::Power => libm::pow(a, operands[1]),
            Self::Floor => a.floor(),
            Self::Ceiling => a.ceil(),
            Self::Round => a.round(),
            Self::Sign if a == 0.0 => 0.0,
            Self::Sign => a.signum(),
            Self::Sine => libm::sin(a),
            Self::Cosine => libm::cos(a),
            Self::Tangent => libm::tan(a),
            Self::ArcSine => libm::asin(a),
            Self::ArcCosine => libm::acos(a),
            Self::ArcTangent => libm::atan(a),
        };
        value.is_finite().then_some(value)
    }

    /// Returns the sign of an operator between two operands; `None` for a function with a name and for the minus of one
    /// operand.
    pub(super) fn sign(self) -> Option<char> {
        match self {
            Self::Add => Some('+'),
            Self::Subtract => Some('-'),
            Self::Multiply => Some('*'),
            Self::Divide => Some('/'),
            Self::Remainder => Some('%'),
            _ => None,
        }
    }

    /// Returns a number for the strength with which an operator binds its operands.
    fn tightness(self) -> u8 {
        match self {
            Self::Add | Self::Subtract => 0,
            Self::Multiply | Self::Divide | Self::Remainder => 1,
            Self::Negate => 2,
            _ => 3,
        }
    }
}

impl Term {
    /// Makes the negative of a term.
    #[must_use]
    pub fn negative(self) -> Self {
        match self {
            Self::Number(number) => Self::Number(-number),
            other => Self::Applied(Function::Negate, vec![other]),
        }
    }

    /// Returns the term with its value in the place of a function of numbers, if the function has a value.
    #[must_use]
    pub fn computed(self) -> Self {
        let Self::Applied(function, operands) = &self else { return self };
        let number = |term: &Term| if let Self::Number(number) = term { Some(*number) } else { None };
        let numbers: Option<Vec<f64>> = operands.iter().map(number).collect();
        numbers.and_then(|numbers| function.value(&numbers)).map_or(self, Self::Number)
    }

    /// Returns the number of operators and functions of the term.
    pub fn operators(&self) -> usize {
        match self {
            Self::Number(_) | Self::Parameter(_) => 0,
            Self::Applied(_, operands) => 1 + operands.iter().map(Self::operators).sum::<usize>(),
        }
    }

    /// Calls `see` with the name of each parameter of the term.
    pub(super) fn each_parameter<'a>(&'a self, see: &mut dyn FnMut(&'a str)) {
        match self {
            Self::Number(_) => {}
            Self::Parameter(name) => see(name),
            Self::Applied(_, operands) => operands.iter().for_each(|operand| operand.each_parameter(see)),
        }
    }

    /// Returns the term with the given numbers in the place of parameters. A function of numbers is replaced by its value
    /// if it has one.
    pub(super) fn with(&self, known: &dyn Fn(&str) -> Option<f64>) -> Self {
        match self {
            Self::Number(_) => self.clone(),
            Self::Parameter(name) => known(name).map_or_else(|| self.clone(), Self::Number),
            Self::Applied(function, operands) => {
                let operands = operands.iter().map(|operand| operand.with(known)).collect();
                Self::Applied(*function, operands).computed()
            }
        }
    }

    fn write(&self, f: &mut fmt::Formatter<'_>, needed: u8) -> fmt::Result {
        let tightness = match self {
            Self::Applied(function, _) => function.tightness(),
            Self::Number(_) | Self::Parameter(_) => 3,
        };
        if tightness < needed { write!(f, "({self})") } else { write!(f, "{self}") }
    }
}

impl fmt::Display for Term {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Number(number) => write!(f, "{number}"),
            Self::Parameter(name) => write!(f, "{}", Name(name)),
            Self::Applied(Function::Negate, operands) => {
                f.write_str("-")?;
                operands[0].write(f, 3)
            }
            Self::Applied(function, operands) => {
                if let Some(sign) = function.sign() {
                    operands[0].write(f, function.tightness())?;
                    write!(f, " {sign} ")?;
                    return operands[1].write(f, function.tightness() + 1);
                }
                let name = NAMED.iter().find(|(_, named)| named == function).map_or("", |(name, _)| *name);
                write!(f, "{name}(")?;
                for (i, operand) in operands.iter().enumerate() {
                    write!(f, "{}{operand}", if i == 0 { "" } else { ", " })?;
                }
                f.write_str(")")
            }
        }
    }
}
