//! Comparisons and flags whose signals are found in the rows of a trace.

use crate::Arithmetic;
use crate::worth::Worth;
use crate::{Comparison, EvaluationError, Expression, Formula};

/// An expression over the columns of a row.
#[derive(Debug, Clone)]
enum Number {
    Constant(f64),
    Column(usize),
    Negate(Box<Number>),
    Absolute(Box<Number>),
    Binary(Arithmetic, Box<Number>, Box<Number>),
}

impl Number {
    fn resolve(expression: &Expression, signals: &[String]) -> Result<Self, EvaluationError> {
        let boxed = |inner: &Expression| Ok(Box::new(Self::resolve(inner, signals)?));
        Ok(match expression {
            Expression::Number(number) => Number::Constant(*number),
            Expression::Signal(name) => Number::Column(column(name, signals)?),
            Expression::Negate(inner) => Number::Negate(boxed(inner)?),
            Expression::Absolute(inner) => Number::Absolute(boxed(inner)?),
            Expression::Binary(operation, left, right) => Number::Binary(*operation, boxed(left)?, boxed(right)?),
        })
    }

    #[inline]
    fn at(&self, row: &[f64]) -> f64 {
        match self {
            Number::Constant(number) => *number,
            Number::Column(column) => row[*column],
            _ => self.composed(row),
        }
    }

    /// Returns the value of an expression with parts. It is apart, so that signals and constants need no call.
    #[inline(never)]
    fn composed(&self, row: &[f64]) -> f64 {
        match self {
            Number::Constant(_) | Number::Column(_) => self.at(row),
            Number::Negate(inner) => -inner.at(row),
            Number::Absolute(inner) => inner.at(row).abs(),
            Number::Binary(operation, left, right) => operation.apply(left.at(row), right.at(row)),
        }
    }
}

/// A formula without sub-formulas, over the columns of a row.
#[derive(Debug, Clone)]
enum Statement {
    Constant(bool),
    Flag(usize),
    Compare(Number, Comparison, Number),
}

/// A statement about one row of samples, or the negation of a statement.
#[derive(Debug, Clone)]
pub(crate) struct Atom {
    statement: Statement,
    negated: bool,
    /// The text of the statement, for error messages. The names of its signals serve the same purpose.
    text: String,
    signals: Vec<(String, usize)>,
}

impl Atom {
    /// Makes an atom, which evaluates a formula without sub-formulas on rows of samples.
    pub fn resolve(formula: &Formula, negated: bool, signals: &[String]) -> Result<Self, EvaluationError> {
        let statement = match formula {
            Formula::Flag(name) => Statement::Flag(column(name, signals)?),
            Formula::Compare(left, comparison, right) => {
                Statement::Compare(Number::resolve(left, signals)?, *comparison, Number::resolve(right, signals)?)
            }
            Formula::Constant(truth) => Statement::Constant(*truth),
            _ => unreachable!("`{formula}` has parts"),
        };
        let named = formula.signals().into_iter().map(|name| Ok((name.to_owned(), column(name, signals)?)));
        Ok(Self { statement, negated, text: formula.to_string(), signals: named.collect::<Result<_, _>>()? })
    }

    /// Returns the robustness of the statement for a row of samples. `time` gives the time of the row in seconds.
    #[inline]
    pub fn at(&self, row: &[f64], time: impl FnOnce() -> f64) -> Result<Worth, EvaluationError> {
        let worth = match &self.statement {
            Statement::Constant(truth) => Worth::certain(*truth),
            Statement::Flag(column) if !row[*column].is_nan() => Worth::certain(row[*column] > 0.0),
            Statement::Flag(_) => return Err(self.complaint(row, time())),
            Statement::Compare(left, comparison, right) => {
                let (left, right) = (left.at(row), right.at(row));
                if left.is_nan() || right.is_nan() {
                    return Err(self.complaint(row, time()));
                }
                comparison.worth(left, right)
            }
        };
        Ok(worth.flipped(self.negated))
    }

    /// Returns the robustness of the statement for each of the given rows, which are `dt` seconds apart.
    pub fn column<'a>(
        &self,
        rows: impl ExactSizeIterator<Item = &'a [f64]>,
        dt: f64,
    ) -> Result<Vec<Worth>, EvaluationError> {
        let mut worths = Vec::with_capacity(rows.len());
        for (tick, row) in rows.enumerate() {
            worths.push(self.at(row, || tick as f64 * dt)?);
        }
        Ok(worths)
    }

    #[cold]
    fn complaint(&self, row: &[f64], time: f64) -> EvaluationError {
        let hole = self.signals.iter().find(|(_, column)| row[*column].is_nan());
        let what = hole.map_or_else(|| self.text.clone(), |(name, _)| name.clone());
        EvaluationError::NoValue { what, time }
    }
}

fn column(name: &str, signals: &[String]) -> Result<usize, EvaluationError> {
    let place = signals.iter().position(|signal| signal == name);
    place.ok_or_else(|| EvaluationError::unknown(name, signals))
}
