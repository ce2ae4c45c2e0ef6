//! Dense time against the definition of formulas, by brute force: every operator at every instant looks at all that is in
//! its window. It shares nothing with the crate but the data, and is quadratic and worse.
//!
//! Numbers are those of `f64` here as there. Both round, so that they agree to within [`TOLERANCE`]; signals, time bounds
//! and so the instants at which anything jumps are multiples of an eighth, and exact.

mod common;

use common::curve::Curve;
use common::{SIGNALS, cases, comparisons, connected};
use paracosm_oracles::{
    Arithmetic, Comparison, Connective, Expression, Formula, Interval, Modality, Semantics, Sequence, Trace, signal,
};
use proptest::prelude::*;

const TOLERANCE: f64 = 1e-6;

/// What stands for all that was not recorded.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Beyond {
    Nothing,
    Least,
    Most,
}

impl Beyond {
    fn not(self) -> Self {
        match self {
            Beyond::Nothing => Beyond::Nothing,
            Beyond::Least => Beyond::Most,
            Beyond::Most => Beyond::Least,
        }
    }

    fn value(self) -> Option<f64> {
        match self {
            Beyond::Nothing => None,
            Beyond::Least => Some(f64::NEG_INFINITY),
            Beyond::Most => Some(f64::INFINITY),
        }
    }
}

fn end(trace: &Trace) -> f64 {
    (trace.len() - 1) as f64 * trace.dt()
}

/// An expression over time, whose parts are straight between the instants at which they bend.
fn number(expression: &Expression, trace: &Trace) -> Curve {
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

/// A formula over time.
fn worth(formula: &Formula, trace: &Trace, beyond: Beyond) -> Curve {
    let of = |inner: &Formula| worth(inner, trace, beyond);
    let negated = |curve: Curve| Curve::new(end(trace), curve.times.clone(), |time| -curve.at(time));
    let not = |inner: &Formula| negated(worth(inner, trace, beyond.not()));
    match formula {
        Formula::Constant(truth) => {
            Curve::new(end(trace), [], |_| if *truth { f64::INFINITY } else { f64::NEG_INFINITY })
        }
        Formula::Flag(_) => unreachable!("a flag has no place in dense time"),
        Formula::Compare(left, comparison, right) => {
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
        Formula::Not(inner) => not(inner),
        Formula::Join(connective, left, right) => {
            let left = if *connective == Connective::Implies { not(left) } else { of(left) };
            let right = of(right);
            let join = if *connective == Connective::And { f64::min } else { f64::max };
            let bends = [left.times.clone(), right.times.clone()].concat();
            Curve::new(end(trace), bends, |time| join(left.at(time), right.at(time)))
        }
        Formula::Modal(modality, interval, inner) => {
            let inner = of(inner);
            let all = matches!(modality, Modality::Always | Modality::Historically);
            let past = matches!(modality, Modality::Once | Modality::Historically);
            let sight = Sight { interval: *interval, past, outside: outside(*interval, past, trace, beyond) };
            let (nothing, join): (f64, fn(f64, f64) -> f64) =
                if all { (f64::INFINITY, f64::min) } else { (f64::NEG_INFINITY, f64::max) };
            Curve::new(end(trace), sight.bends(&[&inner]), |time| {
                let unseen = sight.outside.filter(|_| sight.ends_beyond(time, &inner)).unwrap_or(nothing);
                sight.window(time, &inner).map_or(unseen, |[from, to]| values(&inner, [from, to]).fold(unseen, join))
            })
        }
        Formula::Sequence(sequence, interval, hold, goal) => {
            let release = *sequence == Sequence::Release;
            let [hold, goal] = [hold, goal].map(|operand| if release { negated(of(operand)) } else { of(operand) });
            let past = *sequence == Sequence::Since;
            let unseen = outside(*interval, past, trace, if release { beyond.not() } else { beyond });
            let sight = Sight { interval: *interval, past, outside: unseen };
            let until = Curve::new(end(trace), sight.bends(&[&hold, &goal]), |time| sight.until(time, &hold, &goal));
            if release { negated(until) } else { until }
        }
    }
}

/// What an operator sees beyond the end, if it may look there at all.
fn outside(interval: Interval, past: bool, trace: &Trace, beyond: Beyond) -> Option<f64> {
    let ends = past || interval.end.is_infinite() && trace.is_complete();
    beyond.value().filter(|_| !ends)
}

/// The values that count between two instants, both included: those at instants and, at jumps, those that follow.
fn values(curve: &Curve, [from, to]: [f64; 2]) -> impl Iterator<Item = f64> {
    let instants = Curve::instants(&[curve], [from, to]);
    instants.into_iter().flat_map(move |time| [Some(curve.at(time)), (time < to).then(|| curve.right(time))]).flatten()
}

/// Which way an operator looks, how far, and what it sees where nothing was recorded.
#[derive(Clone, Copy)]
struct Sight {
    interval: Interval,
    past: bool,
    outside: Option<f64>,
}

impl Sight {
    /// Instants between which the operator rises or falls throughout: those at which an operand bends here or at an edge
    /// of the window, and those at which two of these values pass each other.
    fn bends(&self, operands: &[&Curve]) -> Vec<f64> {
        let sign = if self.past { -1.0 } else { 1.0 };
        let Interval { start, end, .. } = self.interval;
        let ways: Vec<f64> =
            [0.0, start, end].into_iter().filter(|way| way.is_finite()).map(|way| sign * way).collect();
        let record = 0.0..=operands[0].end();
        let times = operands.iter().flat_map(|curve| curve.times.iter().copied());
        let mut bends: Vec<f64> = times.flat_map(|time| ways.iter().map(move |way| time - way)).collect();
        bends.retain(|time| record.contains(time));
        bends.sort_by(f64::total_cmp);
        let mut passed = Vec::new();
        for ends in bends.windows(2).filter(|ends| ends[1] - ends[0] > 1e-9) {
            let at = |share: f64| ends[0] + share * (ends[1] - ends[0]);
            let moving = operands.iter().flat_map(|curve| ways.iter().map(move |way| (curve, way)));
            let inside = moving.filter(|(_, way)| record.contains(&(at(0.5) + *way)));
            let lines: Vec<[f64; 2]> =
                inside.map(|(curve, way)| [0.25, 0.75].map(|share| curve.at(at(share) + way))).collect();
            for (place, a) in lines.iter().enumerate() {
                for b in &lines[..place] {
                    let (before, after) = (a[0] - b[0], a[1] - b[1]);
                    let share = 0.25 + 0.5 * before / (before - after);
                    passed.extend((share > 0.0 && share < 1.0).then(|| at(share)));
                }
            }
        }
        bends.extend(passed);
        bends
    }

    /// What is seen of the record from an instant, if anything.
    fn window(&self, time: f64, operand: &Curve) -> Option<[f64; 2]> {
        let Interval { start, end, .. } = self.interval;
        let [from, to] = if self.past { [time - end, time - start] } else { [time + start, time + end] };
        let [from, to] = [from.max(0.0), to.min(operand.end())];
        (from <= to).then_some([from, to])
    }

    fn ends_beyond(&self, time: f64, operand: &Curve) -> bool {
        !self.past && time + self.interval.end > operand.end()
    }

    /// The greatest that the lesser of the goal at an instant in the window, and of the hold up to it, comes to.
    fn until(&self, time: f64, hold: &Curve, goal: &Curve) -> f64 {
        let window = self.window(time, goal);
        let mut best = f64::NEG_INFINITY;
        let reach = if self.past { [0.0, time] } else { [time, goal.end()] };
        let mut instants = Curve::instants(&[hold, goal], reach);
        let [start, end] =
            [self.interval.start, self.interval.end].map(|by| if self.past { time - by } else { time + by });
        instants.extend([start, end].into_iter().filter(|edge| reach[0] < *edge && *edge < reach[1]));
        instants.sort_by(f64::total_cmp);
        instants.dedup();
        if self.past {
            instants.reverse();
        }
        let seen = |at: f64| window.is_some_and(|[from, to]| from <= at && at <= to);
        let mut held = f64::INFINITY;
        for (place, now) in instants.iter().copied().enumerate() {
            if seen(now) {
                best = best.max(held.min(goal.at(now)));
            }
            // From here on it counts that the hold holds here.
            held = held.min(hold.at(now));
            let Some(next) = instants.get(place + 1).copied() else { break };
            // Both are straight from here to there.
            let limits = |curve: &Curve| {
                let (early, late) = (now.min(next), now.max(next));
                let limits = [curve.right(early), curve.at(late)];
                if self.past { [limits[1], limits[0]] } else { limits }
            };
            let ([h0, h1], [g0, g1]) = (limits(hold), limits(goal));
            if seen(0.5 * (now + next)) {
                best = best.max(most(held.min(h0), [h0, h1], [g0, g1]));
            }
            held = held.min(h0).min(h1);
        }
        match self.outside.filter(|_| self.ends_beyond(time, goal)) {
            Some(unseen) => best.max(held.min(unseen)),
            None => best,
        }
    }
}

/// The greatest that the least of a number and of two lines comes to between their ends, where it is concave.
fn most(held: f64, hold: [f64; 2], goal: [f64; 2]) -> f64 {
    let lines = [[held; 2], hold, goal];
    let crossing = |a: [f64; 2], b: [f64; 2]| {
        let (before, after) = (a[0] - b[0], a[1] - b[1]);
        let share = before / (before - after);
        (share > 0.0 && share < 1.0).then_some(share)
    };
    let crossings = [(0, 1), (0, 2), (1, 2)].into_iter().filter_map(|(a, b)| crossing(lines[a], lines[b]));
    let on =
        |line: [f64; 2], share: f64| if line[0] == line[1] { line[0] } else { line[0] + (line[1] - line[0]) * share };
    let least = |share: f64| lines.iter().map(|line| on(*line, share)).fold(f64::INFINITY, f64::min);
    crossings.chain([0.0, 1.0]).map(least).fold(f64::NEG_INFINITY, f64::max)
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
fn intervals() -> impl Strategy<Value = Interval> {
    let bounded = (0..6u8, 0..9u8).prop_map(|(start, length)| {
        let start = 0.25 * f64::from(start);
        Interval::from(start..=start + 0.25 * f64::from(length))
    });
    let unbounded = (0..4u8).prop_map(|start| Interval::from(0.5 * f64::from(start)..));
    prop_oneof![5 => bounded, 1 => Just(Interval::UNBOUNDED), 1 => unbounded]
}

fn formulas() -> impl Strategy<Value = Formula> {
    let leaf = prop_oneof![
        1 => any::<bool>().prop_map(Formula::Constant),
        8 => (prop::sample::select(&SIGNALS[..]), comparisons(), -4..=4i8)
            .prop_map(|(name, comparison, number)| signal(name).compare(comparison, f64::from(number) / 2.0)),
        6 => (expressions(), comparisons(), expressions()).prop_map(|(l, comparison, r)| l.compare(comparison, r)),
    ];
    connected(leaf, 3, intervals)
}

fn traces() -> impl Strategy<Value = Trace> {
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

proptest! {
    #![proptest_config(cases())]

    #[test]
    fn formulas_are_worth_what_their_definition_says_in_dense_time(formula in formulas(), trace in traces()) {
        let evaluation = formula.evaluate_in(Semantics::Dense, &trace).unwrap();
        for (beyond, found) in [
            (Beyond::Nothing, evaluation.robustness),
            (Beyond::Least, evaluation.lower),
            (Beyond::Most, evaluation.upper),
        ] {
            let expected = worth(&formula, &trace, beyond).at(0.0);
            let agree = expected == found || (expected - found).abs() <= TOLERANCE;
            prop_assert!(agree, "{}: {:?} {}, found {:?}", formula, beyond, expected, evaluation);
        }
    }
}
