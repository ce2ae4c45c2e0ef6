//! Random formulas and traces, and the meaning of formulas by the letter of their definition: recursive, quadratic and
//! worse, and sharing nothing with the crate but the data.
#![allow(dead_code, reason = "each test file uses its own part")]

pub mod curve;
pub mod dense;

use paracosm_oracles::{
    Arithmetic, Comparison, Connective, Expression, Formula, Interval, Modality, Sequence, Trace, Truth, flag, signal,
};
use proptest::prelude::*;

pub const DT: f64 = 0.5;
pub const SIGNALS: [&str; 3] = ["x", "y", "car.speed"];

/// The environment variable that asks for more random pairs of formula and trace than the suite tries.
const CASES: &str = "PARACOSM_FORMULA_CASES";

/// As many random pairs as the suite promises whatever the environment says, or more if it asks for more.
pub fn cases() -> ProptestConfig {
    let asked = std::env::var(CASES).ok().and_then(|cases| cases.parse().ok());
    ProptestConfig::with_cases(asked.unwrap_or(0).max(10_000))
}

/// Small whole numbers, so that comparisons are often met with equality.
pub fn traces() -> impl Strategy<Value = Trace> {
    let row = prop::array::uniform3((-3..=3i8).prop_map(f64::from));
    (prop::collection::vec(row, 1..14), any::<bool>()).prop_map(|(rows, complete)| {
        let mut trace = Trace::new(DT, SIGNALS.map(str::to_owned).to_vec());
        rows.iter().for_each(|row| trace.record(row));
        if complete {
            trace.finish();
        }
        trace
    })
}

pub fn expressions() -> impl Strategy<Value = Expression> {
    let leaf = prop_oneof![
        (-4..=4i8).prop_map(|number| Expression::Number(f64::from(number) / 2.0)),
        prop::sample::select(&SIGNALS[..]).prop_map(signal),
    ];
    leaf.prop_recursive(2, 4, 2, |inner| {
        let operation = prop::sample::select(vec![
            Arithmetic::Add,
            Arithmetic::Subtract,
            Arithmetic::Multiply,
            Arithmetic::Least,
            Arithmetic::Greatest,
        ]);
        let binary = (operation, inner.clone(), inner.clone())
            .prop_map(|(operation, l, r)| Expression::Binary(operation, Box::new(l), Box::new(r)));
        prop_oneof![inner.clone().prop_map(|e| -e), inner.clone().prop_map(Expression::abs), binary]
    })
}

pub fn comparisons() -> impl Strategy<Value = Comparison> {
    use Comparison::*;
    prop::sample::select(vec![Below, AtMost, Above, AtLeast, Equal, Different])
}

pub fn intervals() -> impl Strategy<Value = Interval> {
    let bounded = (0..5u8, 0..5u8).prop_map(|(start, length)| {
        let start = DT * f64::from(start);
        Interval::from(start..=start + DT * f64::from(length))
    });
    let outward = (0..9u8, 0..9u8).prop_map(|(start, length)| {
        let start = 0.25 * f64::from(start);
        Interval::from(start..=start + 0.25 * f64::from(length)).outward()
    });
    prop_oneof![4 => bounded, 1 => outward, 1 => Just(Interval::from(..)), 1 => Just(Interval::from(1.0..))]
}

pub fn formulas(depth: u32) -> impl Strategy<Value = Formula> {
    let leaf = prop_oneof![
        1 => any::<bool>().prop_map(Formula::Constant),
        2 => prop::sample::select(&SIGNALS[..]).prop_map(flag),
        8 => (prop::sample::select(&SIGNALS[..]), comparisons(), -2..=2i8)
            .prop_map(|(name, comparison, number)| signal(name).compare(comparison, f64::from(number))),
        4 => (expressions(), comparisons(), expressions()).prop_map(|(l, comparison, r)| l.compare(comparison, r)),
    ];
    connected(leaf, depth, intervals)
}

/// Formulas of these leaves, so deep, with these windows.
pub fn connected<W: Strategy<Value = Interval> + 'static>(
    leaf: impl Strategy<Value = Formula> + 'static,
    depth: u32,
    intervals: fn() -> W,
) -> impl Strategy<Value = Formula> {
    leaf.prop_recursive(depth, 12, 2, move |inner| {
        use {Connective::*, Modality::*, Sequence::*};
        let pair = (inner.clone(), inner.clone()).prop_map(|(l, r)| (Box::new(l), Box::new(r)));
        let join = (prop::sample::select(vec![And, Or, Implies]), pair.clone());
        let modal = prop::sample::select(vec![Always, Eventually, Historically, Once]);
        let sequence = (prop::sample::select(vec![Until, Release, Since]), intervals(), pair);
        prop_oneof![
            1 => inner.clone().prop_map(|f| !f),
            2 => join.prop_map(|(connective, (l, r))| Formula::Join(connective, l, r)),
            4 => (modal, intervals(), inner).prop_map(|(modality, i, f)| Formula::Modal(modality, i, Box::new(f))),
            4 => sequence.prop_map(|(sequence, i, (l, r))| Formula::Sequence(sequence, i, l, r)),
        ]
    })
}

pub fn number(expression: &Expression, trace: &Trace, tick: usize) -> f64 {
    match expression {
        Expression::Number(number) => *number,
        Expression::Signal(name) => trace.signal(name).unwrap().nth(tick).unwrap(),
        Expression::Negate(inner) => -number(inner, trace, tick),
        Expression::Absolute(inner) => number(inner, trace, tick).abs(),
        Expression::Binary(operation, left, right) => {
            let (left, right) = (number(left, trace, tick), number(right, trace, tick));
            match operation {
                Arithmetic::Add => left + right,
                Arithmetic::Subtract => left - right,
                Arithmetic::Multiply => left * right,
                Arithmetic::Divide => left / right,
                Arithmetic::Least => left.min(right),
                Arithmetic::Greatest => left.max(right),
            }
        }
    }
}

/// What a formula can be worth: truths as Kleene has them, or robustness.
pub trait Meaning: Copy {
    const TRUE: Self;
    fn compare(left: f64, comparison: Comparison, right: f64) -> Self;
    fn not(self) -> Self;
    fn and(self, other: Self) -> Self;
    fn or(self, other: Self) -> Self {
        self.not().and(other.not()).not()
    }
}

impl Meaning for Truth {
    const TRUE: Self = Truth::Holds;

    fn compare(left: f64, comparison: Comparison, right: f64) -> Self {
        let holds = match comparison {
            Comparison::Below => left < right,
            Comparison::AtMost => left <= right,
            Comparison::Above => left > right,
            Comparison::AtLeast => left >= right,
            Comparison::Equal => left == right,
            Comparison::Different => left != right,
        };
        if holds { Truth::Holds } else { Truth::Violated }
    }

    fn not(self) -> Self {
        match self {
            Truth::Holds => Truth::Violated,
            Truth::Violated => Truth::Holds,
            Truth::Undecided => Truth::Undecided,
        }
    }

    fn and(self, other: Self) -> Self {
        match (self, other) {
            (Truth::Holds, Truth::Holds) => Truth::Holds,
            (Truth::Violated, _) | (_, Truth::Violated) => Truth::Violated,
            _ => Truth::Undecided,
        }
    }
}

impl Meaning for f64 {
    const TRUE: Self = f64::INFINITY;

    fn compare(left: f64, comparison: Comparison, right: f64) -> Self {
        match comparison {
            Comparison::Below | Comparison::AtMost => right - left,
            Comparison::Above | Comparison::AtLeast => left - right,
            Comparison::Equal => -(left - right).abs(),
            Comparison::Different => (left - right).abs(),
        }
    }

    fn not(self) -> Self {
        -self
    }

    fn and(self, other: Self) -> Self {
        self.min(other)
    }
}

/// The least and the most that a robustness can be.
impl Meaning for (f64, f64) {
    const TRUE: Self = (f64::INFINITY, f64::INFINITY);

    fn compare(left: f64, comparison: Comparison, right: f64) -> Self {
        let exact = f64::compare(left, comparison, right);
        (exact, exact)
    }

    fn not(self) -> Self {
        (-self.1, -self.0)
    }

    fn and(self, other: Self) -> Self {
        (self.0.min(other.0), self.1.min(other.1))
    }
}

/// The worth of a formula at a tick. Beyond the end of the trace it is `beyond`, and does not count if that is nothing.
pub fn naive<M: Meaning>(formula: &Formula, trace: &Trace, tick: usize, beyond: Option<M>) -> M {
    let worth = |formula: &Formula, tick| naive(formula, trace, tick, beyond);
    match formula {
        Formula::Constant(truth) => {
            if *truth {
                M::TRUE
            } else {
                M::TRUE.not()
            }
        }
        Formula::Flag(name) => {
            let sample = trace.signal(name).unwrap().nth(tick).unwrap();
            if sample > 0.0 { M::TRUE } else { M::TRUE.not() }
        }
        Formula::Compare(left, comparison, right) => {
            M::compare(number(left, trace, tick), *comparison, number(right, trace, tick))
        }
        Formula::Not(inner) => worth(inner, tick).not(),
        Formula::Join(Connective::And, left, right) => worth(left, tick).and(worth(right, tick)),
        Formula::Join(Connective::Or, left, right) => worth(left, tick).or(worth(right, tick)),
        Formula::Join(Connective::Implies, left, right) => worth(left, tick).not().or(worth(right, tick)),
        Formula::Modal(modality, interval, inner) => {
            let past = matches!(modality, Modality::Historically | Modality::Once);
            let all = matches!(modality, Modality::Always | Modality::Historically);
            let worths = seen(trace, tick, interval, past, beyond.is_some())
                .into_iter()
                .filter_map(|at| at.map_or(beyond, |at| Some(worth(inner, at))));
            if all { worths.fold(M::TRUE, M::and) } else { worths.fold(M::TRUE.not(), M::or) }
        }
        Formula::Sequence(sequence, interval, hold, goal) => {
            let release = *sequence == Sequence::Release;
            let past = *sequence == Sequence::Since;
            let of = |formula: &Formula, at: Option<usize>| {
                let worth = at.map_or(beyond, |at| Some(worth(formula, at)));
                worth.map(|worth| if release { worth.not() } else { worth })
            };
            let mut result = M::TRUE.not();
            for (at, goal_at) in seen(trace, tick, interval, past, beyond.is_some())
                .into_iter()
                .filter_map(|at| Some((at, of(goal, at)?)))
            {
                let before: Vec<Option<usize>> = match at {
                    Some(at) if past => (at + 1..=tick).map(Some).collect(),
                    Some(at) => (tick..at).map(Some).collect(),
                    None => (tick..trace.len()).map(Some).chain([None]).collect(),
                };
                let held = before.into_iter().filter_map(|at| of(hold, at)).fold(M::TRUE, M::and);
                result = result.or(goal_at.and(held));
            }
            if release { result.not() } else { result }
        }
    }
}

/// The ticks of an interval; one that was not recorded is `None`, wherever beyond the end it may be.
fn seen(trace: &Trace, tick: usize, interval: &Interval, past: bool, beyond: bool) -> Vec<Option<usize>> {
    let (start, end) = (interval.start / DT, interval.end / DT);
    let (start, end) = if interval.outward { (start.floor(), end.ceil()) } else { (start.round(), end.round()) };
    let within = |distance: f64| start <= distance && distance <= end;
    let last = trace.len() - 1;
    if past {
        return (0..=tick).rev().filter(|at| within((tick - at) as f64)).map(Some).collect();
    }
    let mut ticks: Vec<_> = (tick..=last).filter(|at| within((at - tick) as f64)).map(Some).collect();
    let unknown = if end.is_infinite() { !trace.is_complete() } else { end > (last - tick) as f64 };
    if beyond && unknown {
        ticks.push(None);
    }
    ticks
}
