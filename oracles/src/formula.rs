//! Temporal formulas over the signals of a trace: signal temporal logic with operators of the past.
//!
//! A formula is data. It is parsed from text or built in Rust, and its printed text can be parsed again. It has the
//! same meaning in every evaluation; the [crate documentation](crate) defines the meaning.
//!
//! ```
//! use paracosm_oracles::{Formula, flag, signal};
//!
//! let stops = signal("speed").below(0.1).eventually(0.0..=5.0);
//! let built = flag("near").implies(stops).always(..);
//! let parsed: Formula = "always (near -> eventually[0,5] (speed < 0.1))".parse().unwrap();
//! assert_eq!(built, parsed);
//! assert_eq!(built.to_string(), "always (near -> eventually[0,5] (speed < 0.1))");
//! ```

mod expression;

pub use expression::{Arithmetic, Expression, signal};

use crate::{Comparison, Interval};
use std::ops::Not;

/// A logical connective that joins two formulas at the same instant.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Connective {
    /// The conjunction, which holds if both formulas hold.
    And,
    /// The disjunction, which holds if at least one of two formulas holds.
    Or,
    /// The implication, which holds if the second formula holds or the first formula does not hold.
    Implies,
}

/// A temporal operator on one formula, such as `always` or `once`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Modality {
    /// The operator `always`, which holds if the formula holds at all instants of the interval from now on.
    Always,
    /// The operator `eventually`, which holds if the formula holds at an instant of the interval from now on.
    Eventually,
    /// The operator `historically`, which holds if the formula held at all instants of the interval up to now.
    Historically,
    /// The operator `once`, which holds if the formula held at an instant of the interval up to now.
    Once,
}

/// A temporal operator on two formulas, such as `until`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Sequence {
    /// The operator `until`, which holds if the second formula holds at an instant of the interval and the first
    /// formula holds from now until just before this instant.
    Until,
    /// The operator `release`, which holds if the second formula holds at every instant of the interval, up to and
    /// including the first instant at which the first formula holds.
    Release,
    /// The operator `since`, which holds if the second formula held at an instant of the past interval and the first
    /// formula has held since just after this instant.
    Since,
}

/// A formula of temporal logic over the signals of a trace. [`Display`](std::fmt::Display) writes a text that can be
/// parsed again.
#[derive(Debug, Clone, PartialEq)]
pub enum Formula {
    /// A formula that is always true or always false.
    Constant(bool),
    /// A formula that is true while the samples of the signal with the given name are above 0.
    Flag(String),
    /// A comparison of two arithmetic expressions.
    Compare(Expression, Comparison, Expression),
    /// The negation of a formula.
    Not(Box<Formula>),
    /// Two formulas that a logical connective joins at the same instant.
    Join(Connective, Box<Formula>, Box<Formula>),
    /// A formula that has to hold at all instants or at one instant of an interval.
    Modal(Modality, Interval, Box<Formula>),
    /// Two formulas that a temporal operator such as `until` joins over an interval.
    Sequence(Sequence, Interval, Box<Formula>, Box<Formula>),
}

/// Makes the formula that is true while the samples of the signal with the given name are above 0.
pub fn flag(name: impl Into<String>) -> Formula {
    Formula::Flag(name.into())
}

impl Formula {
    /// Makes the formula "this formula and `other` hold".
    pub fn and(self, other: Formula) -> Self {
        Formula::Join(Connective::And, Box::new(self), Box::new(other))
    }

    /// Makes the formula "this formula or `other` holds".
    pub fn or(self, other: Formula) -> Self {
        Formula::Join(Connective::Or, Box::new(self), Box::new(other))
    }

    /// Makes the formula "if this formula holds, `other` holds".
    pub fn implies(self, other: Formula) -> Self {
        Formula::Join(Connective::Implies, Box::new(self), Box::new(other))
    }

    /// Makes the formula "this formula holds at all instants of the interval from now on".
    pub fn always(self, interval: impl Into<Interval>) -> Self {
        Formula::Modal(Modality::Always, interval.into(), Box::new(self))
    }

    /// Makes the formula "this formula holds at an instant of the interval from now on".
    pub fn eventually(self, interval: impl Into<Interval>) -> Self {
        Formula::Modal(Modality::Eventually, interval.into(), Box::new(self))
    }

    /// Makes the formula "this formula held at all instants of the past interval".
    pub fn historically(self, interval: impl Into<Interval>) -> Self {
        Formula::Modal(Modality::Historically, interval.into(), Box::new(self))
    }

    /// Makes the formula "this formula held at an instant of the past interval".
    pub fn once(self, interval: impl Into<Interval>) -> Self {
        Formula::Modal(Modality::Once, interval.into(), Box::new(self))
    }

    /// Makes the formula "this formula holds until just before an instant of the interval at which `goal` holds".
    pub fn until(self, interval: impl Into<Interval>, goal: Formula) -> Self {
        Formula::Sequence(Sequence::Until, interval.into(), Box::new(self), Box::new(goal))
    }

    /// Makes the formula "`duty` holds at every instant of the interval, up to and including the first instant at which
    /// this formula holds".
    pub fn release(self, interval: impl Into<Interval>, duty: Formula) -> Self {
        Formula::Sequence(Sequence::Release, interval.into(), Box::new(self), Box::new(duty))
    }

    /// Makes the formula "this formula has held since an instant of the past interval at which `cause` held".
    pub fn since(self, interval: impl Into<Interval>, cause: Formula) -> Self {
        Formula::Sequence(Sequence::Since, interval.into(), Box::new(self), Box::new(cause))
    }

    /// Returns the names of the signals in the formula, each once, in the order in which they first occur.
    pub fn signals(&self) -> Vec<&str> {
        let mut names = Vec::new();
        self.for_each_signal(&mut |name| {
            if !names.contains(&name) {
                names.push(name);
            }
        });
        names
    }

    fn for_each_signal<'a>(&'a self, visit: &mut impl FnMut(&'a str)) {
        match self {
            Formula::Flag(name) => visit(name),
            Formula::Compare(left, _, right) => {
                left.for_each_signal(visit);
                right.for_each_signal(visit);
            }
            _ => self.operands().into_iter().flatten().for_each(|operand| operand.for_each_signal(visit)),
        }
    }

    /// Returns the time in seconds that the formula looks ahead. A trace of this duration always decides the formula at
    /// time 0. The result is infinite if an operator of the future has no end.
    pub fn horizon(&self) -> f64 {
        let inner = self.operands().into_iter().flatten().map(Formula::horizon).fold(0.0, f64::max);
        match self {
            Formula::Modal(Modality::Always | Modality::Eventually, interval, _)
            | Formula::Sequence(Sequence::Until | Sequence::Release, interval, ..) => interval.end + inner,
            _ => inner,
        }
    }

    /// Returns the outermost and leftmost sub-formula with a finite time bound later than `seconds`. If a trace is not
    /// longer than `seconds`, this sub-formula asks for samples that were not recorded, which deserves a warning.
    pub fn outlasting(&self, seconds: f64) -> Option<&Formula> {
        match self {
            Formula::Modal(_, interval, _) | Formula::Sequence(_, interval, ..)
                if interval.start > seconds || (interval.end > seconds && interval.end.is_finite()) =>
            {
                Some(self)
            }
            _ => self.operands().into_iter().flatten().find_map(|operand| operand.outlasting(seconds)),
        }
    }

    /// Returns the leftmost comparison or signal outside of every temporal operator. It counts at the first sample of a trace alone, which deserves a
    /// note: most requirements are about the whole trace.
    pub fn only_at_begin(&self) -> Option<&Formula> {
        match self {
            Formula::Flag(_) | Formula::Compare(..) => Some(self),
            Formula::Constant(_) | Formula::Modal(..) | Formula::Sequence(..) => None,
            Formula::Not(_) | Formula::Join(..) => {
                self.operands().into_iter().flatten().find_map(Formula::only_at_begin)
            }
        }
    }

    /// Visits the time intervals of all operators.
    pub(crate) fn for_each_interval(&self, visit: &mut impl FnMut(Interval)) {
        if let Formula::Modal(_, interval, _) | Formula::Sequence(_, interval, ..) = self {
            visit(*interval);
        }
        self.operands().into_iter().flatten().for_each(|operand| operand.for_each_interval(visit));
    }

    fn operands(&self) -> [Option<&Formula>; 2] {
        match self {
            Formula::Constant(_) | Formula::Flag(_) | Formula::Compare(..) => [None, None],
            Formula::Not(inner) | Formula::Modal(_, _, inner) => [Some(inner), None],
            Formula::Join(_, left, right) | Formula::Sequence(_, _, left, right) => [Some(left), Some(right)],
        }
    }
}

impl Not for Formula {
    type Output = Formula;

    fn not(self) -> Formula {
        Formula::Not(Box::new(self))
    }
}
