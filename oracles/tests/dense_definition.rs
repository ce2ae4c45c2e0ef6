//! Dense time against the definition of formulas, by brute force: every operator at every instant looks at all that is
//! in its window. It shares nothing with the crate but the data, and is quadratic and worse.
//!
//! Numbers are those of `f64` here as there. Both round, so that they agree to within [`TOLERANCE`]; signals, time
//! bounds and so the instants at which anything jumps are multiples of an eighth, and exact.

mod common;

use common::cases;
use common::curve::Curve;
use common::dense::{TOLERANCE, end, formulas, margin, traces};
use paracosm_oracles::{Connective, Formula, Interval, Modality, Semantics, Sequence, Trace};
use proptest::prelude::*;

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
        Formula::Compare(left, comparison, right) => margin(left, *comparison, right, trace),
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

/// The values that count between two instants, both included: those at instants and the limits on their sides.
fn values(curve: &Curve, [from, to]: [f64; 2]) -> impl Iterator<Item = f64> {
    let instants = Curve::instants(&[curve], [from, to]);
    let around = move |time: f64| {
        let limits = [(from < time).then(|| curve.left(time)), (time < to).then(|| curve.right(time))];
        limits.into_iter().flatten().chain([curve.at(time)])
    };
    instants.into_iter().flat_map(around)
}

/// Which way an operator looks, how far, and what it sees where nothing was recorded.
#[derive(Clone, Copy)]
struct Sight {
    interval: Interval,
    past: bool,
    outside: Option<f64>,
}

impl Sight {
    /// Instants between which the operator rises or falls throughout: those at which an operand bends here or at an
    /// edge of the window, and those at which two of these values pass each other.
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
                let limits = [curve.right(early), curve.left(late)];
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
