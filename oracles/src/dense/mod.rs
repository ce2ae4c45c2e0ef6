//! Evaluates formulas in dense time: signals are straight lines between samples, and every instant counts.
//!
//! Every sub-formula becomes a piecewise linear function of time. So comparisons must be piecewise linear: sums,
//! differences, `abs`, `min`, `max`, and products with and quotients by constants. The robustness jumps when a window
//! reaches the first instant of the trace or leaves the last one. At this instant it has a value of its own beside the
//! limits on both sides. An operator that sees this instant takes all three into account.

mod cause;
mod piece;
mod track;
mod unit;
mod wave;
mod window;

use crate::Arithmetic;
use crate::{
    Cause, Comparison, Connective, Evaluation, EvaluationError, Expression, Formula, Interval, Modality, Sequence,
};
use crate::{Trace, Truth};
use cause::{Causes, hair};
use track::{Track, reaches};
use unit::Unit;
use wave::Wave;
use window::Window;

/// Evaluates a formula at the beginning of a trace that has samples.
pub(crate) fn evaluate(formula: &Formula, trace: &Trace) -> Result<Evaluation, EvaluationError> {
    let [robustness, lower, upper] = Dense::new(formula, trace).track(formula, 0.0, &mut |_, _| {})?.first();
    let truth = if lower > 0.0 {
        Truth::Holds
    } else if upper < 0.0 {
        Truth::Violated
    } else {
        Truth::Undecided
    };
    Ok(Evaluation { truth, robustness, lower, upper })
}

/// Finds the cause of the formula's robustness on a trace that has samples. It needs only the worth of every part over
/// time, which is computed once and kept.
pub(crate) fn explain<'f>(formula: &'f Formula, trace: &Trace) -> Result<Cause<'f>, EvaluationError> {
    let dense = Dense::new(formula, trace);
    let mut parts = Vec::new();
    let whole = dense.track(formula, 0.0, &mut |part, wave| parts.push((part, wave.clone())))?;
    let [robustness, ..] = whole.first();
    let (part, time) = Causes { end: dense.end, unit: dense.unit, parts }.of(formula, robustness);
    // A time near a sample becomes exactly the sample's time, as it is written elsewhere.
    let sample = dense.unit.nearest_sample(time);
    let time = if (time - sample).abs() <= hair(dense.end) { sample } else { time };
    Ok(Cause { time: dense.unit.to_seconds(time), part, robustness })
}

/// A trace with straight lines between its samples.
struct Dense<'a> {
    trace: &'a Trace,
    /// The unit of all times.
    unit: Unit,
    /// The time of the last sample.
    end: f64,
}

impl<'a> Dense<'a> {
    fn new(formula: &Formula, trace: &'a Trace) -> Self {
        let unit = Unit::of(formula, trace);
        Self { trace, unit, end: unit.of_ticks(trace.len() - 1) }
    }

    /// Computes the worth of the formula from time 0 at least to `needed`. `keep` gets the worth for the recorded
    /// samples, of the formula and of all its parts.
    fn track<'f>(
        &self,
        formula: &'f Formula,
        needed: f64,
        keep: &mut dyn FnMut(&'f Formula, &Wave),
    ) -> Result<Track, EvaluationError> {
        let track = match formula {
            Formula::Constant(truth) => {
                let worth = if *truth { f64::INFINITY } else { f64::NEG_INFINITY };
                Track::settled(Wave::constant(worth, self.end), needed)
            }
            Formula::Flag(_) => return Err(EvaluationError::NotLinear { formula: formula.to_string() }),
            Formula::Compare(left, comparison, right) => {
                Track::settled(self.comparison(formula, left, *comparison, right)?, needed)
            }
            Formula::Not(inner) => self.track(inner, needed, keep)?.negated(),
            Formula::Join(connective, left, right) => {
                let (left, right) = (self.track(left, needed, keep)?, self.track(right, needed, keep)?);
                match connective {
                    Connective::And => left.joined(&right, Wave::min),
                    Connective::Or => left.joined(&right, Wave::max),
                    Connective::Implies => left.negated().joined(&right, Wave::max),
                }
            }
            Formula::Modal(modality, interval, inner) => {
                let past = matches!(modality, Modality::Historically | Modality::Once);
                let dual = matches!(modality, Modality::Always | Modality::Historically);
                let scope = self.scope(*interval, past, dual, needed)?;
                let inner = self.track(inner, scope.asked, keep)?;
                scope.track([inner], |scope, [inner]| scope.any(inner))
            }
            Formula::Sequence(sequence, interval, hold, goal) => {
                let past = *sequence == Sequence::Since;
                let scope = self.scope(*interval, past, *sequence == Sequence::Release, needed)?;
                let operands = [self.track(hold, scope.asked, keep)?, self.track(goal, scope.asked, keep)?];
                scope.track(operands, |scope, [hold, goal]| scope.until(hold, goal))
            }
        };
        keep(formula, &track.recorded);
        Ok(track)
    }

    fn comparison(
        &self,
        formula: &Formula,
        left: &Expression,
        comparison: Comparison,
        right: &Expression,
    ) -> Result<Wave, EvaluationError> {
        let linear = |expression| {
            let wave = self.number(expression)?;
            wave.ok_or_else(|| EvaluationError::NotLinear { formula: formula.to_string() })
        };
        let margin = match constant(right) {
            Some(threshold) => linear(left)?.raised(-threshold),
            None => linear(left)?.sum(&linear(right)?.scaled(-1.0)),
        };
        if let Some((time, _)) = margin.points().iter().find(|point| !point.1.is_finite()) {
            return Err(EvaluationError::NoValue { what: formula.to_string(), time: self.unit.to_seconds(*time) });
        }
        let distance = |margin: Wave| margin.max(&margin.clone().scaled(-1.0));
        Ok(match comparison {
            Comparison::Below | Comparison::AtMost => margin.scaled(-1.0),
            Comparison::Above | Comparison::AtLeast => margin,
            Comparison::Equal => distance(margin).scaled(-1.0),
            Comparison::Different => distance(margin),
        })
    }

    /// Computes the values of an expression over time. `None` if it is not piecewise linear.
    fn number(&self, expression: &Expression) -> Result<Option<Wave>, EvaluationError> {
        // `min` and `max` would hide a NaN.
        let finite = |number: f64| {
            let what = || EvaluationError::NoValue { what: expression.to_string(), time: 0.0 };
            if number.is_finite() { Ok(number) } else { Err(what()) }
        };
        if let Some(number) = constant(expression) {
            return Ok(Some(Wave::constant(finite(number)?, self.end)));
        }
        Ok(match expression {
            Expression::Number(_) => unreachable!("a number is constant"),
            Expression::Signal(name) => Some(self.signal(name)?),
            Expression::Negate(inner) => self.number(inner)?.map(|wave| wave.scaled(-1.0)),
            Expression::Absolute(inner) => self.number(inner)?.map(|wave| wave.max(&wave.clone().scaled(-1.0))),
            Expression::Binary(Arithmetic::Multiply, left, right) => match (constant(left), constant(right)) {
                (Some(factor), _) => {
                    let factor = finite(factor)?;
                    self.number(right)?.map(|wave| wave.scaled(factor))
                }
                (_, Some(factor)) => {
                    let factor = finite(factor)?;
                    self.number(left)?.map(|wave| wave.scaled(factor))
                }
                _ => None,
            },
            Expression::Binary(Arithmetic::Divide, left, right) => match constant(right) {
                Some(divisor) => {
                    let factor = finite(divisor.recip())?;
                    self.number(left)?.map(|wave| wave.scaled(factor))
                }
                None => None,
            },
            Expression::Binary(operation, left, right) => {
                let (Some(left), Some(right)) = (self.number(left)?, self.number(right)?) else { return Ok(None) };
                Some(match operation {
                    Arithmetic::Add => left.sum(&right),
                    Arithmetic::Subtract => left.sum(&right.scaled(-1.0)),
                    Arithmetic::Least => left.min(&right),
                    _ => left.max(&right),
                })
            }
        })
    }

    fn signal(&self, name: &str) -> Result<Wave, EvaluationError> {
        let samples = self.trace.signal(name).ok_or_else(|| EvaluationError::unknown(name, self.trace.signals()))?;
        let mut points = Vec::with_capacity(samples.len());
        for (tick, sample) in samples.enumerate() {
            let time = self.unit.of_ticks(tick);
            if !sample.is_finite() {
                return Err(EvaluationError::NoValue { what: name.to_owned(), time: self.unit.to_seconds(time) });
            }
            points.push((time, sample));
        }
        Ok(Wave::new(points))
    }

    fn scope(&self, interval: Interval, past: bool, dual: bool, needed: f64) -> Result<Scope, EvaluationError> {
        if !interval.is_valid() {
            return Err(EvaluationError::Interval(interval));
        }
        let interval = self.unit.of_interval(interval);
        let asked = if past { needed } else { self.end.min(needed + interval.end) };
        let ends = interval.end.is_infinite() && self.trace.is_complete();
        Ok(Scope { interval, past, dual, needed, asked, ends, outside: None })
    }
}

/// A temporal operator, expressed by its counterpart that looks ahead and takes maxima.
#[derive(Clone, Copy)]
struct Scope {
    interval: Interval,
    past: bool,
    dual: bool,
    /// The last time at which the operator is needed, and the last time at which its operands are therefore needed.
    needed: f64,
    asked: f64,
    /// `true` if nothing is in sight beyond the end of the trace.
    ends: bool,
    /// The worth of the operands beyond the end of the trace, or `None` if nothing lies there.
    outside: Option<f64>,
}

impl Scope {
    /// Computes the worth of the operator over time. `apply` computes its counterpart.
    fn track<const N: usize>(self, operands: [Track; N], apply: impl Fn(Self, [Wave; N]) -> Wave) -> Track {
        let operator = |scope: Self, waves: [Wave; N]| scope.back(apply(scope, waves.map(|wave| scope.ahead(wave))));
        let known = operands.iter().map(|track| track.settled).fold(f64::INFINITY, f64::min);
        let settled = if self.past {
            known
        } else if self.ends && operands.iter().all(|track| track.open.is_none()) {
            self.needed
        } else {
            known - self.interval.end
        };
        let is_open = !reaches(settled, self.needed);
        let settled = settled.min(self.needed);
        let open = is_open.then(|| {
            [f64::NEG_INFINITY, f64::INFINITY].map(|worth| {
                let base = if self.past { 0.0 } else { settled.max(0.0) };
                let outside = (!self.past && !self.ends).then_some(if self.dual { -worth } else { worth });
                let scope = Self { needed: self.needed - base, asked: self.asked - base, outside, ..self };
                let waves = operands.each_ref().map(|track| track.after(usize::from(worth > 0.0), base));
                operator(scope, waves).after(settled.max(0.0) - base)
            })
        });
        Track {
            recorded: operator(self, operands.map(|track| track.recorded)),
            settled: settled.min(self.needed),
            open,
        }
    }

    /// Converts an operand of the operator for the counterpart.
    fn ahead(&self, wave: Wave) -> Wave {
        let wave = if self.past { wave.cut(self.needed).reversed() } else { wave };
        if self.dual { wave.scaled(-1.0) } else { wave }
    }

    /// Converts the result of the counterpart back for the operator.
    fn back(&self, wave: Wave) -> Wave {
        let wave = if self.past { wave.reversed().cut(self.needed) } else { wave };
        if self.dual { wave.scaled(-1.0) } else { wave }
    }

    fn any(&self, wave: Wave) -> Wave {
        let Interval { start, end, .. } = self.interval;
        let outside = self.outside.unwrap_or(f64::NEG_INFINITY);
        if end.is_finite() {
            return wave.greatest(Window::closed(start, end), self.needed, outside);
        }
        if self.needed == 0.0 && start == 0.0 && !self.past {
            return Wave::constant(wave.greatest_of_all().max(outside), 0.0);
        }
        let now = wave.greatest_from_now(outside);
        if start == 0.0 { now } else { now.greatest(Window::closed(start, start), self.needed, outside) }
    }

    fn until(&self, hold: Wave, goal: Wave) -> Wave {
        let Interval { start, end, .. } = self.interval;
        let outside = self.outside.unwrap_or(f64::NEG_INFINITY);
        let mut until = Wave::until(&hold, &goal, outside);
        if end.is_finite() {
            // If the goal is in sight, and it is reached anywhere, then it is reached in sight.
            let needed = self.asked.min(self.needed + start);
            until = until.min(&goal.greatest(Window::closed(0.0, end - start), needed, outside));
        }
        if start > 0.0 {
            let fails = self.outside.map_or(f64::NEG_INFINITY, |worth| -worth);
            let before = hold.scaled(-1.0).greatest(Window::before(start), self.needed, fails).scaled(-1.0);
            until = before.min(&until.greatest(Window::closed(start, start), self.needed, outside));
        }
        until
    }
}

/// Returns the value of an expression without signals.
fn constant(expression: &Expression) -> Option<f64> {
    Some(match expression {
        Expression::Number(number) => *number,
        Expression::Signal(_) => return None,
        Expression::Negate(inner) => -constant(inner)?,
        Expression::Absolute(inner) => constant(inner)?.abs(),
        Expression::Binary(operation, left, right) => operation.apply(constant(left)?, constant(right)?),
    })
}
