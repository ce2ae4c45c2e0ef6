//! The linear algorithms against the definition, on random formulas and traces.

mod common;

use common::{DT, formulas, naive, traces};
use paracosm_oracles::{EvaluationError, Formula, Trace, Truth, flag, signal};
use proptest::prelude::*;

/// Cases of the comparison with the definition. `PROPTEST_CASES` does not reach it, so that the suite's promise holds.
const CASES: u32 = 10_000;

proptest! {
    #![proptest_config(ProptestConfig::with_cases(CASES))]

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
