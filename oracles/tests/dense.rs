//! Dense time: what happens between samples, against the sampled semantics on ever finer samples.

mod common;

use common::SIGNALS;
use paracosm_oracles::{Evaluation, EvaluationError, Formula, Interval, Modality, Semantics, Sequence};
use paracosm_oracles::{Trace, Truth, flag, signal};
use proptest::prelude::*;

fn trace(dt: f64, samples: &[f64], complete: bool) -> Trace {
    let mut trace = Trace::new(dt, vec!["x".to_owned()]);
    samples.iter().for_each(|x| trace.record(&[*x]));
    if complete {
        trace.finish();
    }
    trace
}

fn dense(text: &str, trace: &Trace) -> Result<Evaluation, EvaluationError> {
    text.parse::<Formula>().unwrap().evaluate_in(Semantics::Dense, trace)
}

#[test]
fn what_happens_between_two_samples_counts() {
    let trace = trace(1.0, &[0.0, 4.0, 0.0], true);
    for (text, robustness) in [
        ("eventually (x > 1 and x < 2)", 0.5),
        ("eventually[0,0.5] (x > 1)", 1.0),
        ("always[0.25,0.75] (x > 0)", 1.0),
        ("eventually[0.75,1.25] (x < 4)", 1.0),
        ("always (abs(x - 2) > -1)", 1.0),
        ("(x < 3) until (x > 2)", 0.5),
        ("(x < 3) until[0.5,2] (x > 2)", 0.5),
        ("eventually[2,2] once[0.5,0.75] (x > 0)", 3.0),
        ("eventually[1.5,1.5] ((x > 1) since[0.25,1] (x > 3))", 1.0),
        ("(x > 3) release (x < 5)", 1.0),
        ("always (2 * x / 4 - 1 != 0.5)", 0.0),
    ] {
        assert_eq!(dense(text, &trace).unwrap().robustness, robustness, "{text}");
    }
}

#[test]
fn what_comes_after_the_last_sample_is_open_as_it_is_on_samples() {
    let trace = trace(1.0, &[1.0, 2.0, 3.0], false);
    let cut = dense("always (x > 0)", &trace).unwrap();
    assert_eq!((cut.truth, cut.lower, cut.robustness, cut.upper), (Truth::Undecided, f64::NEG_INFINITY, 1.0, 1.0));
    assert_eq!(dense("always (x > 2)", &trace).unwrap().truth, Truth::Violated);
    assert_eq!(dense("always[0,1] always[0,1] (x > 0)", &trace).unwrap().truth, Truth::Holds);
    assert_eq!(dense("always[0,1] eventually[1.5,1.5] (x > 2)", &trace).unwrap().truth, Truth::Undecided);
    assert_eq!(dense("always[0,1] eventually[0,1.5] (x > 2)", &trace).unwrap().lower, 0.5);
    assert_eq!(dense("x >= 1", &trace).unwrap().truth, Truth::Undecided, "0 decides nothing");
}

#[test]
fn where_two_jump_at_one_instant_each_has_its_value_there() {
    let zeros = |dt: f64, ticks: usize| trace(dt, &vec![0.0; ticks], false);
    let inf = f64::INFINITY;
    for (text, trace, lower, robustness) in [
        ("once[1,inf] true release[0.5,1.25] true", zeros(0.5, 3), inf, inf),
        ("always[0,1.75] true until (true since[0.25,0.25] true)", zeros(1.0, 3), inf, inf),
        ("always[0,1] (true since ((x < 0) until[1,1] true))", zeros(1.0, 2), 0.0, 0.0),
        ("false until historically[0,0] always[1.25,1.5] true", zeros(0.5, 4), inf, inf),
    ] {
        let found = dense(text, &trace).unwrap();
        assert_eq!((found.lower, found.robustness), (lower, robustness), "{text}");
    }
}

#[test]
fn a_crossing_that_rounds_to_the_instant_of_a_jump_leaves_the_jump_its_value() {
    let mut trace = Trace::new(0.5, vec!["x".to_owned(), "y".to_owned()]);
    let rows = [[1.0, 0.0], [-3.0, 2.0], [1.0, 0.0], [0.0, 0.0], [0.0, 0.0], [0.0, 0.0]];
    rows.iter().for_each(|row| trace.record(row));
    let formula =
        "eventually[1.5,inf] (historically[1.25,1.75] (min(y / -2, 0) > abs(x / -2)) release[0,1] not (0 > 0))";
    // Nothing but the one instant at 1.5 s has its whole window in the trace.
    assert_eq!(dense(formula, &trace).unwrap().lower, 0.0);
}

#[test]
fn a_crossing_counts_however_near_to_a_sample_it_is() {
    let steep = |rows: &[[f64; 2]]| {
        let mut trace = Trace::new(0.1, vec!["x".to_owned(), "y".to_owned()]);
        rows.iter().for_each(|row| trace.record(row));
        trace.finish();
        trace
    };
    let of = |text: &str, trace: &Trace| dense(text, trace).unwrap().robustness;
    let found = of("always (x != 0)", &steep(&[[1.0, 0.0], [-1e9, 0.0]]));
    assert!(found.abs() < 1e-6, "{found}");
    let found = of("always (x != 0)", &steep(&[[1e9, 0.0], [-1.0, 0.0]]));
    assert!(found.abs() < 1e-6, "{found}");
    let found = of("always (x > 0 or y > 0)", &steep(&[[1.0, -3.0], [-1e9, 1e9]]));
    assert!((found + 1.0).abs() < 1e-6, "{found}");
    // A finite bound is not the same as none, however large it is.
    assert_eq!(dense("always[0,1e308] (x > 0)", &steep(&[[1.0, 0.0]; 3])).unwrap().truth, Truth::Undecided);
}

#[test]
fn windows_of_the_past_are_closed_where_they_reach_the_first_instant() {
    let mut falling = Trace::new(0.5, vec!["a".to_owned(), "b".to_owned()]);
    [[-1.0, 1.0], [1.0, 1.0], [1.0, 1.0]].iter().for_each(|row| falling.record(row));
    falling.finish();
    let found = dense("always (b > 0 -> not once[1,2] (a < 0))", &falling).unwrap();
    assert_eq!((found.truth, found.robustness), (Truth::Violated, -1.0));
    let found = dense("eventually[2,2] historically[2,5] (x < 0)", &trace(1.0, &[1.0, -1.0, -1.0], true)).unwrap();
    assert_eq!((found.truth, found.robustness), (Truth::Violated, -1.0));
    // The hold need not hold when the goal is reached.
    let found = dense("(not once[1,2] (x > 0)) until[1,1] (x < 0)", &trace(1.0, &[2.0, -3.0], true)).unwrap();
    assert_eq!((found.truth, found.robustness), (Truth::Holds, 3.0));
}

#[test]
fn what_is_not_piecewise_linear_is_refused() {
    let trace = trace(1.0, &[1.0, 2.0], true);
    for (text, complaint) in [
        (
            "always (x * x > 0)",
            "`(x * x > 0)` is not a piecewise linear function of its signals, which dense time needs",
        ),
        ("eventually x", "`x` is not a piecewise linear function of its signals, which dense time needs"),
        ("always (x / 0 > 1)", "`x / 0` has no value at 0 s"),
        ("always (min(x, 0 / 0) > 1)", "`0 / 0` has no value at 0 s"),
        ("always (xx > 1)", "the trace has no signal `xx` (did you mean `x`?)"),
    ] {
        assert_eq!(dense(text, &trace).unwrap_err().to_string(), complaint);
    }
    assert!(dense("always (x * (2 + 1) / 4 > 1)", &trace).is_ok());
    let single = self::trace(1.0, &[3.0], true);
    assert_eq!(dense("always (x > 0) and (x > 2) until (x > 1)", &single).unwrap().robustness, 2.0);
    assert!(flag("x").evaluate_in(Semantics::Dense, &self::trace(1.0, &[], true)).unwrap().robustness.is_nan());
}

/// Samples `share` times as dense, on the straight lines.
fn refined(trace: &Trace, share: usize) -> Trace {
    let mut fine = Trace::new(trace.dt() / share as f64, trace.signals().to_vec());
    let rows: Vec<_> = trace.rows().collect();
    for pair in rows.windows(2) {
        for step in 0..share {
            let at = step as f64 / share as f64;
            fine.record(&[0, 1, 2].map(|i| pair[0][i] * (1.0 - at) + pair[1][i] * at));
        }
    }
    fine.record(rows[rows.len() - 1]);
    if trace.is_complete() {
        fine.finish();
    }
    fine
}

/// Bounds at quarters of a second.
fn bounded(from: std::ops::Range<u8>) -> BoxedStrategy<Interval> {
    let bounds = (from, 0..9u8).prop_map(|(start, length)| {
        let start = 0.25 * f64::from(start);
        Interval::from(start..=start + 0.25 * f64::from(length))
    });
    bounds.boxed()
}

fn unbounded(_: std::ops::Range<u8>) -> BoxedStrategy<Interval> {
    Just(Interval::UNBOUNDED).boxed()
}

/// Formulas in which operators of the past see the instant at which they stand, so that their robustness does not jump:
/// where it does, a goal may be reached right after a sample and what has to hold may fail right after it as well, and
/// no sample lies between.
fn formulas(intervals: fn(std::ops::Range<u8>) -> BoxedStrategy<Interval>) -> impl Strategy<Value = Formula> {
    let x = || prop::sample::select(&SIGNALS[..]).prop_map(signal);
    let leaf = prop_oneof![
        (x(), -3..=3i8).prop_map(|(x, y)| x.below(f64::from(y) / 2.0)),
        (x(), x()).prop_map(|(x, y)| x.above(y * 0.5)),
        (x(), x()).prop_map(|(x, y)| x.abs().max(y).equal_to(1.0)),
    ];
    let past = leaf.prop_recursive(2, 4, 2, move |inner| {
        let back = (prop::sample::select(vec![Modality::Historically, Modality::Once]), intervals(0..1), inner.clone());
        prop_oneof![
            back.prop_map(|(modality, i, f)| Formula::Modal(modality, i, Box::new(f))),
            (intervals(0..1), inner.clone(), inner.clone()).prop_map(|(i, l, r)| l.since(i, r)),
            (inner.clone(), inner).prop_map(|(l, r)| l.or(!r)),
        ]
    });
    past.prop_recursive(3, 8, 2, move |inner| {
        use {Modality::*, Sequence::*};
        let pair = (inner.clone(), inner.clone());
        let ahead = (prop::sample::select(vec![Always, Eventually]), intervals(0..5), inner.clone());
        let sequence = (prop::sample::select(vec![Until, Release]), intervals(0..5), pair.clone());
        prop_oneof![
            1 => inner.prop_map(|f| !f),
            2 => pair.clone().prop_map(|(l, r)| l.and(r)),
            1 => pair.prop_map(|(l, r)| l.implies(r)),
            4 => ahead.prop_map(|(modality, i, f)| Formula::Modal(modality, i, Box::new(f))),
            4 => sequence.prop_map(|(sequence, i, (l, r))| Formula::Sequence(sequence, i, Box::new(l), Box::new(r))),
        ]
    })
}

/// Formulas whose operators look anywhere. Their robustness jumps, but none of them asks what comes first.
fn modal() -> impl Strategy<Value = Formula> {
    let leaf =
        (prop::sample::select(&SIGNALS[..]).prop_map(signal), -3..=3i8).prop_map(|(x, y)| x.below(f64::from(y) / 2.0));
    leaf.prop_recursive(4, 10, 2, |inner| {
        use Modality::*;
        let modalities = vec![Always, Eventually, Historically, Once];
        let pair = (inner.clone(), inner.clone());
        prop_oneof![
            1 => inner.clone().prop_map(|f| !f),
            1 => pair.clone().prop_map(|(l, r)| l.and(r)),
            1 => pair.prop_map(|(l, r)| l.or(r)),
            5 => (prop::sample::select(modalities), bounded(0..5), inner)
                .prop_map(|(modality, i, f)| Formula::Modal(modality, i, Box::new(f))),
        ]
    })
}

fn traces(ticks: std::ops::Range<usize>) -> impl Strategy<Value = Trace> {
    let row = prop::array::uniform3((-3..=3i8).prop_map(f64::from));
    prop::collection::vec(row, ticks).prop_map(|rows| {
        let mut trace = Trace::new(1.0, SIGNALS.map(str::to_owned).to_vec());
        rows.iter().for_each(|row| trace.record(row));
        trace.finish();
        trace
    })
}

/// Fails unless dense time agrees with fine samples, but for what may happen between those.
fn check(formula: &Formula, trace: &Trace) -> Result<(), TestCaseError> {
    let dense = formula.evaluate_in(Semantics::Dense, trace).unwrap();
    let fine = formula.evaluate(&refined(trace, 128)).unwrap();
    let close = |left: f64, right: f64| left == right || (left - right).abs() < 0.25;
    prop_assert!(close(dense.robustness, fine.robustness), "{}: {:?} {:?}", formula, dense, fine);
    prop_assert_eq!((dense.lower, dense.upper), (dense.robustness, dense.robustness), "{}", formula);
    Ok(())
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(10_000))]

    #[test]
    fn fine_samples_come_close_to_dense_time((formula, trace) in formulas(bounded).prop_flat_map(|formula| {
        let ticks = formula.horizon().ceil() as usize + 1;
        (Just(formula), traces(ticks..ticks + 3))
    })) {
        check(&formula, &trace)?;
    }

    #[test]
    fn fine_samples_come_close_to_dense_time_where_it_jumps((formula, trace) in modal().prop_flat_map(|formula| {
        let ticks = formula.horizon().ceil() as usize + 1;
        (Just(formula), traces(ticks..ticks + 3))
    })) {
        check(&formula, &trace)?;
    }

    #[test]
    fn fine_samples_come_close_to_dense_time_without_bounds(formula in formulas(unbounded), trace in traces(1..14)) {
        check(&formula, &trace)?;
    }

    #[test]
    fn what_comes_later_stays_within_the_bounds_of_a_trace_cut_short(
        formula in prop_oneof![formulas(bounded), formulas(unbounded)],
        trace in traces(1..14),
        ticks in 1..9usize,
    ) {
        let mut cut = Trace::new(trace.dt(), trace.signals().to_vec());
        trace.rows().take(ticks).for_each(|row| cut.record(row));
        let early = formula.evaluate_in(Semantics::Dense, &cut).unwrap();
        let late = formula.evaluate_in(Semantics::Dense, &trace).unwrap();
        let nothing = 1e-9;
        prop_assert!(early.lower <= early.robustness + nothing && early.robustness <= early.upper + nothing);
        prop_assert!(early.lower <= late.lower + nothing && late.upper <= early.upper + nothing, "{}", formula);
    }
}

#[test]
fn moved_crossings_change_no_value_beyond_rounding() {
    let signals = ["x", "y", "z"].map(str::to_owned).to_vec();
    let mut trace = Trace::new(1.0, signals);
    for row in [[-1.0, 3.0, 3.0], [2.0, 2.0, -1.0], [0.0, -2.0, 3.0], [0.0, 0.0, 0.0]] {
        trace.record(&row);
    }
    trace.finish();
    let text = "((y < 0) release[0,0.75] ((max(abs(x), y) == 1) since[0,0.75] (z > x * 0.5))) release[0.5,1.5] \
                (once[0,0.5] (x > z * 0.5) and not (((x < 0) since[0,0] (y < 0.5)) or not ((x < 0) since[0,0] (y > x * 0.5))))";
    let mut cut = Trace::new(trace.dt(), trace.signals().to_vec());
    trace.rows().take(3).for_each(|row| cut.record(row));
    for trace in [&trace, &cut] {
        let found = dense(text, trace).unwrap();
        assert!((found.robustness + 0.125).abs() < 1e-10, "{found:?}");
    }
}

#[test]
fn where_one_rises_as_another_falls_at_one_instant_nothing_between_is_seen() {
    let mut trace = Trace::new(1.0, vec!["x".into(), "y".into(), "z".into()]);
    (0..3).for_each(|_| trace.record(&[0.0, 1.0, 0.0]));
    trace.finish();
    let text = "always ((x > 0 or once[1,1] (y > 0)) or ((x > -1) and historically[1,1] (z > 0)))";
    assert_eq!(dense(text, &trace).unwrap().robustness, 1.0);
}
