//! Random formulas and traces of dense time, and their comparisons as functions of time.

use super::curve::Curve;
use super::{SIGNALS, comparisons, connected};
use paracosm_oracles::{Arithmetic, Comparison, Expression, Formula, Interval, Trace, signal};
use proptest::prelude::*;

/// By how much numbers may differ that were rounded in different ways.
pub const TOLERANCE: f64 = 1e-6;

/// The time of the last sample.
pub fn end(trace: &Trace) -> f64 {
    (trace.len() - 1) as f64 * trace.dt()
}

/// An expression over time, whose parts are straight between the instants at which they bend.
pub fn number(expression: &Expression, trace: &Trace) -> Curve {
    let of = |inner: &Expression| number(inner, trace);
    let bends = |a: &Curve, b: &Curve| [a.times.clone(), b.times.clone()].concat();
    match expression {
        Expression::Number(number) => Curve::new(end(trace), [], |_| *number),
        Expression::Signal(name) => {
            let samples: Vec<f64> = trace.signal(name).unwrap().collect();
            let ticks = (0..samples.len()).map(|tick| tick as f64 * trace.dt());
            Curve::new(end(trace), ticks, |time| {
                let (tick, share) = ((time / trace.dt()).floor() as usize, (time / trace.dt()).fract());
                samples[tick] * (1.0 - share) + samples.get(tick + 1).map_or(0.0, |next| next * share)
            })
        }
        Expression::Negate(inner) => {
            let inner = of(inner);
            Curve::new(end(trace), inner.times.clone(), |time| -inner.at(time))
        }
        Expression::Absolute(inner) => {
            let inner = of(inner);
            Curve::new(end(trace), inner.times.clone(), |time| inner.at(time).abs())
        }
        Expression::Binary(operation, left, right) => {
            let (left, right) = (of(left), of(right));
            Curve::new(end(trace), bends(&left, &right), |time| {
                let (left, right) = (left.at(time), right.at(time));
                match operation {
                    Arithmetic::Add => left + right,
                    Arithmetic::Subtract => left - right,
                    Arithmetic::Multiply => left * right,
                    Arithmetic::Divide => left / right,
                    Arithmetic::Least => left.min(right),
                    Arithmetic::Greatest => left.max(right),
                }
            })
        }
    }
}

/// The margin by which a comparison holds, over time.
pub fn margin(left: &Expression, comparison: Comparison, right: &Expression, trace: &Trace) -> Curve {
    let (left, right) = (number(left, trace), number(right, trace));
    let bends = [left.times.clone(), right.times.clone()].concat();
    Curve::new(end(trace), bends, |time| {
        let (left, right) = (left.at(time), right.at(time));
        match comparison {
            Comparison::Below | Comparison::AtMost => right - left,
            Comparison::Above | Comparison::AtLeast => left - right,
            Comparison::Equal => -(left - right).abs(),
            Comparison::Different => (left - right).abs(),
        }
    })
}

/// Expressions whose values stay small.
fn expressions() -> impl Strategy<Value = Expression> {
    let leaf = prop_oneof![
        1 => (-4..=4i8).prop_map(|number| Expression::Number(f64::from(number) / 2.0)),
        3 => prop::sample::select(&SIGNALS[..]).prop_map(signal),
    ];
    leaf.prop_recursive(2, 5, 2, |inner| {
        use Arithmetic::*;
        let operation = prop::sample::select(vec![Add, Subtract, Least, Greatest]);
        let factor = prop::sample::select(vec![-2.0, -0.5, 0.5, 1.0, 2.0]);
        prop_oneof![
            1 => inner.clone().prop_map(|e| -e),
            1 => inner.clone().prop_map(Expression::abs),
            1 => (inner.clone(), factor.clone()).prop_map(|(e, factor)| e * factor),
            1 => (inner.clone(), factor).prop_map(|(e, factor)| e / factor),
            3 => (operation, inner.clone(), inner)
                .prop_map(|(operation, l, r)| Expression::Binary(operation, Box::new(l), Box::new(r))),
        ]
    })
}

/// Windows at quarters of a second: from now or from later on, an instant wide or wider, and without an end.
pub fn intervals() -> impl Strategy<Value = Interval> {
    let bounded = (0..6u8, 0..9u8).prop_map(|(start, length)| {
        let start = 0.25 * f64::from(start);
        Interval::from(start..=start + 0.25 * f64::from(length))
    });
    let unbounded = (0..4u8).prop_map(|start| Interval::from(0.5 * f64::from(start)..));
    prop_oneof![5 => bounded, 1 => Just(Interval::UNBOUNDED), 1 => unbounded]
}

/// Formulas that can be asked in dense time.
pub fn formulas() -> impl Strategy<Value = Formula> {
    let leaf = prop_oneof![
        1 => any::<bool>().prop_map(Formula::Constant),
        8 => (prop::sample::select(&SIGNALS[..]), comparisons(), -4..=4i8)
            .prop_map(|(name, comparison, number)| signal(name).compare(comparison, f64::from(number) / 2.0)),
        6 => (expressions(), comparisons(), expressions()).prop_map(|(l, comparison, r)| l.compare(comparison, r)),
    ];
    connected(leaf, 3, intervals)
}

/// Small whole numbers, once or twice a second.
pub fn traces() -> impl Strategy<Value = Trace> {
    let row = prop::array::uniform3((-3..=3i8).prop_map(f64::from));
    let period = prop::sample::select(vec![0.5, 1.0]);
    (period, prop::collection::vec(row, 1..7), any::<bool>()).prop_map(|(dt, rows, complete)| {
        let mut trace = Trace::new(dt, SIGNALS.map(str::to_owned).to_vec());
        rows.iter().for_each(|row| trace.record(row));
        if complete {
            trace.finish();
        }
        trace
    })
}
