//! Temporal formulas over the signals of a trace, with one meaning: whether they hold and by how much.
//!
//! The quantitative semantics is that of signal temporal logic (Donzé and Maler, "Robust satisfaction of
//! temporal logic over real-valued signals", FORMATS 2010): a comparison is worth its distance from equality,
//! `always` the least and `eventually` the greatest worth over the rest of the trace. The Boolean semantics is
//! kept beside it, because a robustness of 0 decides nothing, and because a trace that was cut short leaves
//! questions open. Both are found in one pass from the end of the trace.

use crate::{Trace, Truth};
use std::fmt;

/// How a signal is compared with a number.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Comparison {
    /// `<`
    Below,
    /// `<=`
    AtMost,
    /// `>`
    Above,
    /// `>=`
    AtLeast,
}

impl Comparison {
    /// Whether `left` compares to `right` so. Nothing compares to NaN.
    pub fn holds(self, left: f64, right: f64) -> bool {
        match self {
            Comparison::Below => left < right,
            Comparison::AtMost => left <= right,
            Comparison::Above => left > right,
            Comparison::AtLeast => left >= right,
        }
    }

    fn robustness(self, left: f64, right: f64) -> f64 {
        match self {
            Comparison::Below | Comparison::AtMost => right - left,
            Comparison::Above | Comparison::AtLeast => left - right,
        }
    }

    /// How the comparison is written.
    pub fn symbol(self) -> &'static str {
        match self {
            Comparison::Below => "<",
            Comparison::AtMost => "<=",
            Comparison::Above => ">",
            Comparison::AtLeast => ">=",
        }
    }
}

/// A temporal formula. [`Display`](fmt::Display) writes it as a user would.
#[derive(Debug, Clone, PartialEq)]
pub enum Formula {
    /// A signal compared with a number.
    Compare {
        /// The signal's name.
        signal: String,
        /// How it is compared.
        comparison: Comparison,
        /// With what.
        threshold: f64,
    },
    /// The formula does not hold.
    Not(Box<Formula>),
    /// The formula holds now and at every later tick.
    Always(Box<Formula>),
    /// The formula holds now or at some later tick.
    Eventually(Box<Formula>),
}

/// A formula that speaks of a signal the trace does not have.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct UnknownSignal(
    /// The name that is in the formula only.
    pub String,
);

impl fmt::Display for UnknownSignal {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "the trace has no signal `{}`", self.0)
    }
}

impl std::error::Error for UnknownSignal {}

/// What a formula is worth on a trace.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Evaluation {
    /// Whether it holds.
    pub truth: Truth,
    /// How far it is from the other answer; on a trace that was cut short, judging by what there is.
    pub robustness: f64,
}

impl Formula {
    /// What the formula is worth at the beginning of the trace, in time linear in the trace.
    ///
    /// # Errors
    /// The formula names a signal that the trace does not have.
    pub fn evaluate(&self, trace: &Trace) -> Result<Evaluation, UnknownSignal> {
        let unknown = Evaluation { truth: Truth::Undecided, robustness: f64::NAN };
        Ok(self.at_every_tick(trace)?.first().copied().unwrap_or(unknown))
    }

    fn at_every_tick(&self, trace: &Trace) -> Result<Vec<Evaluation>, UnknownSignal> {
        match self {
            Formula::Compare { signal, comparison, threshold } => {
                let samples = trace.signal(signal).ok_or_else(|| UnknownSignal(signal.clone()))?;
                let worth = |sample| Evaluation {
                    truth: Truth::of(comparison.holds(sample, *threshold)),
                    robustness: comparison.robustness(sample, *threshold),
                };
                Ok(samples.map(worth).collect())
            }
            Formula::Not(inner) => {
                let negate = |e: Evaluation| Evaluation { truth: e.truth.not(), robustness: -e.robustness };
                Ok(inner.at_every_tick(trace)?.into_iter().map(negate).collect())
            }
            Formula::Always(inner) => {
                let rest = Evaluation { truth: after_the_end(trace, Truth::Holds), robustness: f64::INFINITY };
                Ok(backwards(inner.at_every_tick(trace)?, rest, |now, later| Evaluation {
                    truth: now.truth.and(later.truth),
                    robustness: now.robustness.min(later.robustness),
                }))
            }
            Formula::Eventually(inner) => {
                let rest = Evaluation { truth: after_the_end(trace, Truth::Violated), robustness: f64::NEG_INFINITY };
                Ok(backwards(inner.at_every_tick(trace)?, rest, |now, later| Evaluation {
                    truth: now.truth.or(later.truth),
                    robustness: now.robustness.max(later.robustness),
                }))
            }
        }
    }
}

/// What can be said of the ticks that were not recorded: nothing, if there should have been more.
fn after_the_end(trace: &Trace, otherwise: Truth) -> Truth {
    if trace.is_complete() { otherwise } else { Truth::Undecided }
}

/// Folds from the last tick to the first, in place.
fn backwards(
    mut ticks: Vec<Evaluation>,
    mut rest: Evaluation,
    join: impl Fn(Evaluation, Evaluation) -> Evaluation,
) -> Vec<Evaluation> {
    for tick in ticks.iter_mut().rev() {
        rest = join(*tick, rest);
        *tick = rest;
    }
    ticks
}

impl fmt::Display for Formula {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Formula::Compare { signal, comparison, threshold } => {
                write!(f, "({signal} {} {threshold})", comparison.symbol())
            }
            Formula::Not(inner) => write!(f, "not {inner}"),
            Formula::Always(inner) => write!(f, "always {inner}"),
            Formula::Eventually(inner) => write!(f, "eventually {inner}"),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn trace(samples: &[f64], complete: bool) -> Trace {
        let mut trace = Trace::new(0.1, vec!["x".into()]);
        samples.iter().for_each(|x| trace.record(&[*x]));
        if complete {
            trace.finish();
        }
        trace
    }

    fn x(comparison: Comparison, threshold: f64) -> Formula {
        Formula::Compare { signal: "x".into(), comparison, threshold }
    }

    fn always(inner: Formula) -> Formula {
        Formula::Always(Box::new(inner))
    }

    fn eventually(inner: Formula) -> Formula {
        Formula::Eventually(Box::new(inner))
    }

    fn truth(formula: &Formula, samples: &[f64], complete: bool) -> Truth {
        formula.evaluate(&trace(samples, complete)).unwrap().truth
    }

    #[test]
    fn always_is_worth_its_worst_tick_and_eventually_its_best() {
        let trace = trace(&[3.0, -1.0, 2.0], true);
        assert_eq!(always(x(Comparison::Above, 0.0)).evaluate(&trace).unwrap().robustness, -1.0);
        assert_eq!(eventually(x(Comparison::AtLeast, 2.5)).evaluate(&trace).unwrap().robustness, 0.5);
    }

    #[test]
    fn a_trace_cut_short_leaves_open_what_could_still_have_happened() {
        let reaches = eventually(x(Comparison::AtLeast, 5.0));
        assert_eq!(truth(&reaches, &[1.0, 2.0], false), Truth::Undecided);
        assert_eq!(truth(&reaches, &[1.0, 2.0], true), Truth::Violated);
        assert_eq!(truth(&reaches, &[1.0, 6.0], false), Truth::Holds);
        let stays = always(x(Comparison::Above, 0.0));
        assert_eq!(truth(&stays, &[1.0, 2.0], false), Truth::Undecided);
        assert_eq!(truth(&stays, &[1.0, -2.0], false), Truth::Violated);
        assert_eq!(truth(&stays, &[1.0, 2.0], true), Truth::Holds);
    }

    #[test]
    fn a_robustness_of_zero_decides_nothing_by_itself() {
        assert_eq!(truth(&always(x(Comparison::AtLeast, 0.0)), &[0.0], true), Truth::Holds);
        assert_eq!(truth(&always(x(Comparison::Above, 0.0)), &[0.0], true), Truth::Violated);
    }

    #[test]
    fn formulas_are_written_as_users_write_them() {
        let formula = always(Formula::Not(Box::new(x(Comparison::AtMost, 0.0))));
        assert_eq!(formula.to_string(), "always not (x <= 0)");
    }

    #[test]
    fn an_unknown_signal_is_named() {
        let formula = Formula::Compare { signal: "y".into(), comparison: Comparison::Below, threshold: 0.0 };
        assert_eq!(formula.evaluate(&trace(&[1.0], true)), Err(UnknownSignal("y".into())));
    }

    proptest! {
        #[test]
        fn nesting_agrees_with_the_definition_by_quantifiers(samples in prop::collection::vec(-3.0..3.0f64, 1..30)) {
            let trace = trace(&samples, true);
            // always eventually (x > 0): for every tick there is a later one above 0.
            let formula = always(eventually(x(Comparison::Above, 0.0)));
            let worth = (0..samples.len())
                .map(|i| samples[i..].iter().copied().fold(f64::NEG_INFINITY, f64::max))
                .fold(f64::INFINITY, f64::min);
            let evaluation = formula.evaluate(&trace).unwrap();
            prop_assert_eq!(evaluation.robustness, worth);
            prop_assert_eq!(evaluation.truth, Truth::of(*samples.last().unwrap() > 0.0));
        }
    }
}
