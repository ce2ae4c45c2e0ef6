//! Temporal formulas over the signals of a trace: signal temporal logic with its past.
//!
//! A formula is data. It is parsed from text or built in Rust, printed so that it parses again, and means the same
//! wherever it is evaluated; the [crate documentation](crate) says what.
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

/// How two formulas are joined at one instant.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Connective {
    /// Both hold.
    And,
    /// One of them holds.
    Or,
    /// The second holds, or the first does not.
    Implies,
}

/// At which instants of an interval a formula is to hold.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Modality {
    /// At all, from now on.
    Always,
    /// At one, from now on.
    Eventually,
    /// At all, up to now.
    Historically,
    /// At one, up to now.
    Once,
}

/// How two formulas follow one another.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Sequence {
    /// The second holds at an instant of the interval, and the first from now until before it.
    Until,
    /// The second holds at every instant of the interval up to the first, that one included, at which the first holds.
    Release,
    /// The second held at an instant of the interval, looking back, and the first ever since, up to now.
    Since,
}

/// A temporal formula. [`Display`](std::fmt::Display) writes it so that it can be parsed again.
#[derive(Debug, Clone, PartialEq)]
pub enum Formula {
    /// True or false, whatever happens.
    Constant(bool),
    /// A signal that is itself a truth: it holds while its samples are above 0.
    Flag(String),
    /// Two numbers compared.
    Compare(Expression, Comparison, Expression),
    /// The formula does not hold.
    Not(Box<Formula>),
    /// Two formulas at one instant.
    Join(Connective, Box<Formula>, Box<Formula>),
    /// A formula over an interval.
    Modal(Modality, Interval, Box<Formula>),
    /// Two formulas, one after the other.
    Sequence(Sequence, Interval, Box<Formula>, Box<Formula>),
}

/// The signal of this name, which is itself a truth.
pub fn flag(name: impl Into<String>) -> Formula {
    Formula::Flag(name.into())
}

impl Formula {
    /// Both hold.
    pub fn and(self, other: Formula) -> Self {
        Formula::Join(Connective::And, Box::new(self), Box::new(other))
    }

    /// One of them holds.
    pub fn or(self, other: Formula) -> Self {
        Formula::Join(Connective::Or, Box::new(self), Box::new(other))
    }

    /// If this holds, so does the other.
    pub fn implies(self, other: Formula) -> Self {
        Formula::Join(Connective::Implies, Box::new(self), Box::new(other))
    }

    /// Holds throughout the interval from now on.
    pub fn always(self, interval: impl Into<Interval>) -> Self {
        Formula::Modal(Modality::Always, interval.into(), Box::new(self))
    }

    /// Holds at some instant of the interval from now on.
    pub fn eventually(self, interval: impl Into<Interval>) -> Self {
        Formula::Modal(Modality::Eventually, interval.into(), Box::new(self))
    }

    /// Held throughout the interval back from now.
    pub fn historically(self, interval: impl Into<Interval>) -> Self {
        Formula::Modal(Modality::Historically, interval.into(), Box::new(self))
    }

    /// Held at some instant of the interval back from now.
    pub fn once(self, interval: impl Into<Interval>) -> Self {
        Formula::Modal(Modality::Once, interval.into(), Box::new(self))
    }

    /// Holds from now until before an instant of the interval at which `goal` holds.
    pub fn until(self, interval: impl Into<Interval>, goal: Formula) -> Self {
        Formula::Sequence(Sequence::Until, interval.into(), Box::new(self), Box::new(goal))
    }

    /// Releases `duty`, which holds at every instant of the interval up to and including the first at which this does.
    pub fn release(self, interval: impl Into<Interval>, duty: Formula) -> Self {
        Formula::Sequence(Sequence::Release, interval.into(), Box::new(self), Box::new(duty))
    }

    /// Has held ever since an instant of the interval, back from now, at which `cause` held.
    pub fn since(self, interval: impl Into<Interval>, cause: Formula) -> Self {
        Formula::Sequence(Sequence::Since, interval.into(), Box::new(self), Box::new(cause))
    }

    /// The names of the signals it speaks of, each once, in the order in which they first occur.
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

    /// How many seconds it looks ahead from where it stands: what a trace has to last for it to be decided at time 0
    /// in every case. Infinite where an operator of the future has no end.
    pub fn horizon(&self) -> f64 {
        let inner = self.operands().into_iter().flatten().map(Formula::horizon).fold(0.0, f64::max);
        match self {
            Formula::Modal(Modality::Always | Modality::Eventually, interval, _)
            | Formula::Sequence(Sequence::Until | Sequence::Release, interval, ..) => interval.end + inner,
            _ => inner,
        }
    }

    /// The outermost and leftmost sub-formula with a finite time bound later than `seconds`: on a trace that lasts no
    /// longer it asks about what was not recorded, which is worth a warning.
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
