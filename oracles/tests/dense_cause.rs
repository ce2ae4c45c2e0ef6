//! What a robustness in dense time comes down to: a comparison that has it at that time, and on which it depends.

mod common;

use common::dense::{TOLERANCE, end, formulas, intervals, margin, traces};
use common::{SIGNALS, cases, connected};
use paracosm_oracles::{Cause, Comparison, Formula, Semantics, Trace, signal};
use proptest::prelude::*;

fn explain<'f>(formula: &'f Formula, trace: &Trace) -> Cause<'f> {
    formula.explain_in(Semantics::Dense, trace).unwrap().unwrap()
}

#[test]
fn the_part_and_the_time_between_samples_are_named() {
    let mut trace = Trace::new(1.0, vec!["x".to_owned(), "y".to_owned()]);
    [[0.0, 5.0], [4.0, 3.0], [0.0, 1.0]].iter().for_each(|row| trace.record(row));
    trace.finish();
    for (text, robustness, part, time) in [
        ("always (x < 3)", -1.0, "(x < 3)", 1.0),
        ("always[0,0.25] (x < 3)", 2.0, "(x < 3)", 0.25),
        ("eventually (x > 1 and x < 2)", 0.5, "(x > 1)", 0.375),
        ("always (x < y)", -1.0, "(x < y)", 1.0),
        ("not eventually[0.25,0.5] (x > y)", 2.0, "(x > y)", 0.5),
        ("(x < 3) until (x > 2)", 0.5, "(x > 2)", 0.625),
        ("(x < 3) until (y < 1.5)", -1.0, "(x < 3)", 1.0),
        ("eventually[2,2] once[0.5,0.75] (x > 0)", 3.0, "(x > 0)", 1.25),
        ("eventually[1.5,1.5] ((x > 1) since[0.25,1] (x > 2.5))", 1.0, "(x > 1)", 1.5),
        ("(x > 3) release (y < 4)", -1.0, "(y < 4)", 0.0),
        ("always[1,1.25] (x > 1 -> y > 4)", -1.5, "(y > 4)", 1.25),
        ("x > 1 or false", -1.0, "(x > 1)", 0.0),
    ] {
        let formula: Formula = text.parse().unwrap();
        let cause = explain(&formula, &trace);
        assert_eq!((cause.robustness, cause.part.to_string().as_str(), cause.time), (robustness, part, time), "{text}");
    }
    let beyond: Formula = "always[0,1] eventually[5,6] (x > 0)".parse().unwrap();
    let cause = explain(&beyond, &trace);
    assert_eq!(cause.part.to_string(), "eventually[5,6] (x > 0)", "nothing was recorded where it looks");
    let sampled = beyond.explain_in(Semantics::Sampled, &trace).unwrap().unwrap();
    assert_eq!(sampled.part, cause.part);
    let nothing = Trace::new(1.0, vec!["x".to_owned()]);
    assert_eq!(beyond.explain_in(Semantics::Dense, &nothing), Ok(None));
    let square: Formula = "x * x > 0".parse().unwrap();
    assert!(square.explain_in(Semantics::Dense, &trace).is_err());
}

/// The parts of a formula, itself among them.
fn parts(formula: &Formula) -> Vec<&Formula> {
    let operands = match formula {
        Formula::Constant(_) | Formula::Flag(_) | Formula::Compare(..) => vec![],
        Formula::Not(inner) | Formula::Modal(_, _, inner) => parts(inner),
        Formula::Join(_, left, right) | Formula::Sequence(_, _, left, right) => [parts(left), parts(right)].concat(),
    };
    [vec![formula], operands].concat()
}

/// The formula with the threshold of one part moved.
fn moved(formula: &Formula, part: &Formula, by: f64) -> Formula {
    let of = |inner: &Formula| Box::new(moved(inner, part, by));
    match formula {
        Formula::Compare(left, comparison, right) if std::ptr::eq(formula, part) => {
            left.clone().compare(*comparison, right.clone() + by)
        }
        Formula::Not(inner) => Formula::Not(of(inner)),
        Formula::Modal(modality, interval, inner) => Formula::Modal(*modality, *interval, of(inner)),
        Formula::Join(connective, left, right) => Formula::Join(*connective, of(left), of(right)),
        Formula::Sequence(sequence, interval, left, right) => {
            Formula::Sequence(*sequence, *interval, of(left), of(right))
        }
        _ => formula.clone(),
    }
}

/// Formulas no two of whose comparisons have the same margin at the same time, but for chance.
fn distinct() -> impl Strategy<Value = Formula> {
    let comparison = prop::sample::select(vec![Comparison::Below, Comparison::Above]);
    let leaf = (prop::sample::select(&SIGNALS[..]), comparison, (-2.0..2.0).no_shrink())
        .prop_map(|(name, comparison, threshold)| signal(name).compare(comparison, threshold));
    connected(leaf, 3, intervals)
}

fn rough() -> impl Strategy<Value = Trace> {
    let row = prop::array::uniform3((-3.0..3.0).no_shrink());
    (prop::collection::vec(row, 1..7), any::<bool>()).prop_map(|(rows, complete)| {
        let mut trace = Trace::new(0.5, SIGNALS.map(str::to_owned).to_vec());
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
    fn the_named_comparison_has_the_robustness_at_the_named_time(formula in formulas(), trace in traces()) {
        let Cause { time, part, robustness } = explain(&formula, &trace);
        let asked = formula.evaluate_in(Semantics::Dense, &trace).unwrap().robustness;
        prop_assert_eq!(robustness.to_bits(), asked.to_bits(), "{}", formula);
        prop_assert!((0.0..=end(&trace)).contains(&time), "{}: {}", formula, time);
        prop_assert!(parts(&formula).iter().any(|other| std::ptr::eq(*other, part)));
        match part {
            Formula::Compare(left, comparison, right) => {
                let found = margin(left, *comparison, right, &trace).at(time);
                prop_assert!((found.abs() - robustness.abs()).abs() <= TOLERANCE, "{}: {} at {}", formula, part, time);
            }
            // A truth, or an operator that sees nothing.
            _ => prop_assert!(robustness.is_infinite(), "{}: {} at {}", formula, part, time),
        }
    }

    #[test]
    fn the_robustness_depends_on_the_named_comparison(formula in distinct(), trace in rough()) {
        const STEP: f64 = 1e-5;
        let Cause { part, robustness, .. } = explain(&formula, &trace);
        if robustness.is_finite() {
            let after = |by: f64| moved(&formula, part, by).evaluate_in(Semantics::Dense, &trace).unwrap().robustness;
            let changes = [STEP, -STEP].map(|by| (after(by) - robustness).abs());
            let most = changes[0].max(changes[1]);
            prop_assert!(1e-7 * STEP < most && most < 1.01 * STEP, "{}: {} {:?}", formula, part, changes);
        }
    }
}
