//! The linear algorithms against the definition, on random formulas and traces.

mod common;

use common::{DT, cases, formulas, naive, traces};
use paracosm_oracles::{Evaluation, Formula, Interval, Monitor, Trace, Truth, flag, signal};
use proptest::prelude::*;

fn trace(dt: f64, samples: &[f64], complete: bool) -> Trace {
    let mut trace = Trace::new(dt, vec!["x".to_owned()]);
    samples.iter().for_each(|x| trace.record(&[*x]));
    if complete {
        trace.finish();
    }
    trace
}

fn evaluated(text: &str, trace: &Trace) -> Evaluation {
    text.parse::<Formula>().unwrap().evaluate(trace).unwrap()
}

#[test]
fn a_bounded_operator_is_undecided_where_the_trace_ends_before_its_bound() {
    let complete = trace(1.0, &[1.0, 2.0, 3.0], true);
    let undecided = evaluated("always[0,3] (x > 0)", &complete);
    assert_eq!(undecided.truth, Truth::Undecided);
    assert_eq!((undecided.lower, undecided.robustness, undecided.upper), (f64::NEG_INFINITY, 1.0, 1.0));
    assert_eq!(evaluated("always[0,2] (x > 0)", &complete).truth, Truth::Holds);
    assert_eq!(evaluated("always[0,3] (x > 1)", &complete).truth, Truth::Violated);
    assert_eq!(evaluated("eventually[0,9] (x > 3)", &complete).truth, Truth::Undecided);
    assert_eq!(evaluated("always (x > 1 -> eventually[0,2] (x > 4))", &complete).truth, Truth::Undecided);
}

#[test]
fn an_unbounded_operator_runs_to_the_end_of_a_complete_trace() {
    for (complete, always, eventually) in
        [(true, Truth::Holds, Truth::Violated), (false, Truth::Undecided, Truth::Undecided)]
    {
        let trace = trace(1.0, &[1.0, 2.0, 3.0], complete);
        assert_eq!(evaluated("always (x > 0)", &trace).truth, always);
        assert_eq!(evaluated("eventually (x > 3)", &trace).truth, eventually);
        assert_eq!(evaluated("eventually[7,inf] (x > 0)", &trace).truth, eventually);
        assert_eq!(evaluated("(x > 0) until (x > 3)", &trace).truth, eventually);
        assert_eq!(evaluated("(x > 3) release (x > 0)", &trace).truth, always);
    }
}

#[test]
fn before_the_first_sample_there_was_nothing() {
    let trace = trace(1.0, &[1.0, 2.0], true);
    assert_eq!(evaluated("once[1,5] (x > 0)", &trace).truth, Truth::Violated);
    assert_eq!(evaluated("historically[1,5] (x > 9)", &trace).truth, Truth::Holds);
    assert_eq!(evaluated("eventually[1,1] once[1,1] (x == 1)", &trace).truth, Truth::Holds);
}

#[test]
fn a_robustness_of_0_decides_nothing_by_itself() {
    let trace = trace(1.0, &[0.0], true);
    for (text, truth) in [
        ("always (x >= 0)", Truth::Holds),
        ("always (x > 0)", Truth::Violated),
        ("not (x == 0) or (x < 0)", Truth::Violated),
        ("(x <= 0) and not (x > 0)", Truth::Holds),
    ] {
        let evaluation = evaluated(text, &trace);
        assert_eq!((evaluation.truth, evaluation.robustness), (truth, 0.0), "{text}");
    }
}

#[test]
fn the_empty_trace_decides_nothing() {
    let evaluation = evaluated("always (x > 0)", &trace(1.0, &[], true));
    assert_eq!(evaluation.truth, Truth::Undecided);
    assert!(evaluation.robustness.is_nan());
}

#[test]
fn a_number_that_is_none_is_named_with_its_time() {
    let complaint = |text: &str, samples: &[f64]| {
        let formula: Formula = text.parse().unwrap();
        formula.evaluate(&trace(0.5, samples, true)).map_err(|error| error.to_string())
    };
    let gap = [1.0, 2.0, f64::NAN, 3.0];
    assert_eq!(complaint("always (x > 0)", &gap), Err("`x` has no value at 1 s".to_owned()));
    assert_eq!(complaint("once (abs(x) > 0) or always x", &gap), Err("`x` has no value at 1 s".to_owned()));
    assert_eq!(complaint("always max(x, 0) > 1", &gap), Err("`x` has no value at 1 s".to_owned()));
    let zero = [1.0, 0.0];
    assert_eq!(complaint("always (x / x > 0)", &zero), Err("`(x / x > 0)` has no value at 0.5 s".to_owned()));
    assert_eq!(complaint("always (2 / x > 1)", &zero).unwrap().robustness, 1.0);
    assert_eq!(complaint("eventually (2 / x > 5)", &zero).unwrap().robustness, f64::INFINITY);
    assert_eq!(complaint("always[0,0.5] (x > 0)", &gap).unwrap().robustness, 1.0, "what does not count may be missing");
}

#[test]
fn an_infinite_sample_is_a_number() {
    let trace = trace(1.0, &[f64::INFINITY, 2.0], true);
    assert_eq!(evaluated("x > 3", &trace).robustness, f64::INFINITY);
    assert_eq!(evaluated("x > x", &trace).truth, Truth::Violated);
    assert_eq!(evaluated("always (x > 3)", &trace).robustness, -1.0);
}

#[test]
fn a_formula_that_does_not_fit_the_trace_is_refused_with_the_reason() {
    let complaint = |text: &str| text.parse::<Formula>().unwrap().evaluate(&trace(0.1, &[1.0], true)).unwrap_err();
    assert_eq!(complaint("always (y > 0)").to_string(), "the trace has no signal `y`");
    assert_eq!(complaint("always (xx > 0)").to_string(), "the trace has no signal `xx` (did you mean `x`?)");
    assert_eq!(
        complaint("eventually[0,0.25] (x > 0)").to_string(),
        "the time bound 0.25 s is not a multiple of the sample period 0.1 s; write ~[0,0.25] to round outward"
    );
    let endless = flag("x").always(3.0..=1.0).evaluate(&trace(0.1, &[1.0], true)).unwrap_err();
    assert_eq!(endless.to_string(), "the time bounds [3,1] are not an interval, expected 0 <= start <= end in seconds");
}

#[test]
fn rounding_outward_looks_at_the_samples_on_either_side() {
    let trace = trace(0.1, &[0.0, 1.0, 2.0, 3.0, 4.0], true);
    let built = signal("x").below(9.0).always(Interval::from(0.15..=0.25).outward());
    assert_eq!(built.evaluate(&trace).unwrap().robustness, 6.0);
    assert_eq!(evaluated("eventually~[0.15,0.25] (x > 0)", &trace).robustness, 3.0);
    assert_eq!(evaluated("always~[0.15,0.25] (x > 0)", &trace).robustness, 1.0);
    assert_eq!(evaluated("always~[0.2,0.3] (x > 0)", &trace).robustness, 2.0);
}

#[test]
fn no_time_bound_is_too_long() {
    let trace = trace(1e-3, &[1.0, 2.0], true);
    for text in [
        "always[0,1e300] (x > 0)",
        "always[1e300,1e300] eventually[1e12,1e300] (x > 0)",
        "historically[0,1e300] once[1e300,1e301] (x > 0)",
        "(x > 0) until[1e15,1e16] (x > 1)",
        "eventually (x > 0) since[1e15,1e300] (x > 1)",
    ] {
        let formula: Formula = text.parse().unwrap();
        let mut monitor = Monitor::new(&formula, trace.signals(), trace.dt()).unwrap();
        trace.rows().for_each(|row| assert!(monitor.step(row).is_ok()));
        assert_eq!(monitor.finish(true), formula.evaluate(&trace).unwrap(), "{text}");
    }
}

#[test]
fn the_cause_is_the_comparison_at_the_time_on_which_everything_depends() {
    let trace = trace(0.5, &[0.0, 4.0, 1.0, 3.0, 9.0, 0.0], true);
    for (text, part, time) in [
        ("always (x < 8)", "(x < 8)", 2.0),
        ("always (x > 2 -> eventually[0,1] (x < 1))", "(x < 1)", 1.0),
        ("(x < 5) until[0,2.5] (x > 7)", "(x < 5)", 0.5),
        ("not eventually (x > 1 and once[0,0.5] (x < 1))", "(x < 1)", 0.0),
        ("eventually[2,2] ((x > 1) since (x == 1))", "(x == 1)", 1.0),
        ("eventually[9,10] (x > 1)", "eventually[9,10] (x > 1)", 0.0),
    ] {
        let formula: Formula = text.parse().unwrap();
        let cause = formula.explain(&trace).unwrap().unwrap();
        assert_eq!((cause.part.to_string().as_str(), cause.time), (part, time), "{text}");
    }
}

proptest! {
    #![proptest_config(cases())]

    #[test]
    fn formulas_are_worth_what_their_definition_says(formula in formulas(3), trace in traces()) {
        let evaluation = formula.evaluate(&trace).unwrap();
        prop_assert_eq!(evaluation.truth, naive(&formula, &trace, 0, Some(Truth::Undecided)), "{}", formula);
        prop_assert_eq!(evaluation.robustness, naive(&formula, &trace, 0, None::<f64>), "{}", formula);
        let bounds = naive(&formula, &trace, 0, Some((f64::NEG_INFINITY, f64::INFINITY)));
        prop_assert_eq!((evaluation.lower, evaluation.upper), bounds, "{}", formula);
        let cause = formula.explain(&trace).unwrap().unwrap();
        prop_assert_eq!(cause.robustness, evaluation.robustness);
        let tick = (cause.time / DT).round() as usize;
        let part = naive(cause.part, &trace, tick, None::<f64>);
        prop_assert_eq!(part.abs(), evaluation.robustness.abs(), "{}: {} at {}", formula, cause.part, cause.time);
    }
}
