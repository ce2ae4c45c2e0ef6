//! Formulas followed tick by tick, against the same formulas on the whole trace.

mod common;

use common::DT;
use common::{cases, formulas, traces};
use paracosm_oracles::{EvaluationError, Formula, Monitor, Trace, Truth};
use proptest::prelude::*;

/// The trace, cut short after each tick.
fn beginnings(trace: &Trace) -> impl Iterator<Item = (&[f64], Trace)> {
    let mut beginning = Trace::new(trace.dt(), trace.signals().to_vec());
    trace.rows().map(move |row| {
        beginning.record(row);
        (row, beginning.clone())
    })
}

fn told(text: &str, samples: &[f64]) -> (Vec<Truth>, Monitor) {
    let formula: Formula = text.parse().unwrap();
    let mut monitor = Monitor::new(&formula, &["x".to_owned()], DT).unwrap();
    (samples.iter().map(|x| monitor.step(&[*x]).unwrap()).collect(), monitor)
}

#[test]
fn a_verdict_comes_at_the_first_tick_at_which_it_is_certain() {
    use Truth::{Holds, Undecided, Violated};
    // Also where the formula looks further ahead.
    let (truths, monitor) = told("always[0,5] always[0,5] (x > 0)", &[1.0, -2.0, 3.0]);
    assert_eq!(truths, [Undecided, Violated, Violated]);
    assert_eq!(monitor.bounds(), (f64::NEG_INFINITY, 0.0));
    let (truths, _) = told("always[0,1] (x > 0 -> eventually[0,1] (x < 0))", &[1.0, -1.0, -1.0]);
    assert_eq!(truths, [Undecided, Undecided, Holds]);
    let (truths, _) = told("always[0,1] (x > 0 -> eventually[0,1] (x < 0))", &[1.0, 1.0, 1.0]);
    assert_eq!(truths, [Undecided, Undecided, Violated]);
    let (truths, _) = told("(x > 0) until (x > 5)", &[1.0, 6.0, -1.0]);
    assert_eq!(truths, [Undecided, Holds, Holds]);
}

#[test]
fn the_bounds_close_in_on_the_robustness() {
    let (_, mut monitor) = told("always[0,1] (x > 0)", &[4.0, 2.0]);
    assert_eq!(monitor.bounds(), (f64::NEG_INFINITY, 2.0));
    monitor.step(&[3.0]).unwrap();
    assert_eq!(monitor.bounds(), (2.0, 2.0));
    assert_eq!(monitor.truth(), Truth::Holds);
}

#[test]
fn a_sample_that_is_no_number_does_not_count() {
    let (_, mut monitor) = told("always (x > 0)", &[4.0]);
    let before = monitor.clone().finish(true);
    let error = EvaluationError::NoValue { what: "x".to_owned(), time: DT };
    assert_eq!(monitor.step(&[f64::NAN]), Err(error));
    assert_eq!(monitor.finish(true), before);
}

/// A trace of two signals that change slowly, or at every tick, around 0.
fn long_traces() -> impl Strategy<Value = Trace> {
    prop::collection::vec((-5..=5i8, -5..=5i8, 1..20usize), 5..40).prop_map(|pieces| {
        let mut trace = Trace::new(DT, common::SIGNALS.map(str::to_owned).to_vec());
        for (x, y, ticks) in pieces {
            (0..ticks).for_each(|tick| trace.record(&[f64::from(x), f64::from(y), (tick % 3) as f64 - 1.0]));
        }
        trace
    })
}

proptest! {
    #[test]
    fn what_is_forgotten_on_the_way_does_not_matter(formula in formulas(3), outer in 0..60u8, trace in long_traces()) {
        for formula in [formula.clone().always(..), (!formula.eventually(0.0..=DT * f64::from(outer))).always(5.0..)] {
            let mut monitor = Monitor::new(&formula, trace.signals(), trace.dt()).unwrap();
            for (row, beginning) in beginnings(&trace) {
                let truth = monitor.step(row).unwrap();
                if beginning.len() % 7 == 0 {
                    prop_assert_eq!(truth, formula.evaluate(&beginning).unwrap().truth, "{}", formula);
                }
            }
            prop_assert_eq!(monitor.finish(false), formula.evaluate(&trace).unwrap(), "{}", formula);
        }
    }
}

proptest! {
    #![proptest_config(cases())]

    #[test]
    fn at_every_tick_the_truth_is_that_of_the_trace_so_far(formula in formulas(3), trace in traces()) {
        let mut monitor = Monitor::new(&formula, trace.signals(), trace.dt()).unwrap();
        for (row, beginning) in beginnings(&trace) {
            let expected = formula.evaluate(&beginning).unwrap();
            prop_assert_eq!(monitor.step(row), Ok(expected.truth), "{} after {}", formula, beginning.len());
            prop_assert_eq!(monitor.clone().finish(false), expected, "{} after {}", formula, beginning.len());
            let (lower, upper) = monitor.bounds();
            prop_assert!(lower <= expected.lower && expected.upper <= upper, "{}: [{}, {}]", formula, lower, upper);
        }
        prop_assert_eq!(monitor.finish(trace.is_complete()), formula.evaluate(&trace).unwrap(), "{}", formula);
    }
}
