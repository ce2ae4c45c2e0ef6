//! Dense time with decimal times: 0.1 s is no number of a computer, and sums of such times are rounded. The same formula and trace with
//! times that are exact is the judge: the worths must be equal, not just near.

mod common;

use common::dense::{formulas, traces};
use common::{SIGNALS, cases};
use paracosm_oracles::{Formula, Interval, Semantics, Trace};
use proptest::prelude::*;

/// A duration in place of a quarter of a second, as a fraction. A time is the number that is nearest to the true time, as a user writes it.
const QUARTERS: [[f64; 2]; 7] =
    [[1.0, 10.0], [1.0, 100.0], [1.0, 50.0], [1.0, 30.0], [3.0, 10.0], [7.0, 100.0], [1.0, 3000.0]];

fn stretched(seconds: f64, [numerator, denominator]: [f64; 2]) -> f64 {
    4.0 * seconds * numerator / denominator
}

fn with_times(formula: &Formula, quarter: [f64; 2]) -> Formula {
    let of = |inner: &Formula| Box::new(with_times(inner, quarter));
    let within = |interval: &Interval| Interval {
        start: stretched(interval.start, quarter),
        end: stretched(interval.end, quarter),
        ..*interval
    };
    match formula {
        Formula::Constant(_) | Formula::Flag(_) | Formula::Compare(..) => formula.clone(),
        Formula::Not(inner) => Formula::Not(of(inner)),
        Formula::Join(connective, left, right) => Formula::Join(*connective, of(left), of(right)),
        Formula::Modal(modality, interval, inner) => Formula::Modal(*modality, within(interval), of(inner)),
        Formula::Sequence(sequence, interval, left, right) => {
            Formula::Sequence(*sequence, within(interval), of(left), of(right))
        }
    }
}

fn with_period(trace: &Trace, quarter: [f64; 2]) -> Trace {
    let mut other = Trace::new(stretched(trace.dt(), quarter), SIGNALS.map(str::to_owned).to_vec());
    trace.rows().for_each(|row| other.record(row));
    if trace.is_complete() {
        other.finish();
    }
    other
}

proptest! {
    #![proptest_config(cases())]

    #[test]
    fn decimal_times_part_no_two_jumps(
        formula in formulas(),
        trace in traces(),
        quarter in prop::sample::select(&QUARTERS[..]),
    ) {
        let (decimal, short) = (with_times(&formula, quarter), with_period(&trace, quarter));
        let exact = formula.evaluate_in(Semantics::Dense, &trace).unwrap();
        let found = decimal.evaluate_in(Semantics::Dense, &short).unwrap();
        prop_assert_eq!(found, exact, "{} on samples each {} s", decimal, short.dt());
        let causes = (formula.explain_in(Semantics::Dense, &trace).unwrap(), decimal.explain_in(Semantics::Dense, &short).unwrap());
        if let (Some(exact), Some(found)) = causes {
            prop_assert_eq!(found.robustness, exact.robustness);
            prop_assert!((found.time - stretched(exact.time, quarter)).abs() <= 1e-12, "{found:?}");
        }
    }
}
