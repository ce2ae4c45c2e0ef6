//! Says how much each parameter matters: Sobol indices of the failure and of the robustness.
//!
//! If the parameters are independent, the variance of a quantity over all tests is a sum of parts: one part for each
//! parameter alone, and one part for each set of parameters that act together. The *first-order index* of a parameter is
//! the share of its own part. The *total index* is the share of all parts in which the parameter takes part (Sobol',
//! Sensitivity estimates for nonlinear mathematical models, 1993; Homma and Saltelli, 1996). A parameter without effect has
//! the total index 0.
//!
//! The indices come from tests of their own, or from the model of the failures of a campaign. The parameters have the
//! distributions of the space.

mod design;
mod estimator;
mod study;

pub use design::{Design, Evaluate, Factor, explain, tests_within};
pub use study::{of_model, of_tests};

use paracosm_campaign::{Problem, Reason};
use serde::Serialize;
use std::fmt;
use thiserror::Error;

/// The source of the values from which the indices are estimated.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Source {
    /// Tests were run for the indices.
    Tests,
    /// The model of the failures of a campaign was evaluated. No test was run.
    FailureModel {
        /// The number of tests of the campaign that the model knows.
        tests: usize,
    },
}

/// An estimated index, which is a share of a variance. The error of an estimate can bring it a little below 0 or above 1.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Index {
    /// The estimated share.
    pub estimate: f64,
    /// The lower end of the 95 % bootstrap interval.
    pub lower: f64,
    /// The upper end of the 95 % bootstrap interval.
    pub upper: f64,
}

impl fmt::Display for Index {
    /// Writes the estimate with its interval, such as `0.291 (0.244 to 0.343)`.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { estimate, lower, upper } = self;
        write!(f, "{estimate:.3} ({lower:.3} to {upper:.3})")
    }
}

/// The indices of a parameter. All coordinates of a signal together are one parameter.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Indices {
    /// The name of the parameter.
    pub name: String,
    /// The share of the variance that the parameter explains alone.
    pub first_order: Index,
    /// The share of the variance that vanishes if all other parameters explain what they can without this parameter.
    pub total: Index,
}

/// The variance of a quantity, with the indices of the parameters.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Explained {
    /// The mean of the quantity over the tests.
    pub mean: f64,
    /// The variance of the quantity over the tests.
    pub variance: f64,
    /// The indices, the greatest total index first. The list is empty if the quantity is the same in all tests.
    pub parameters: Vec<Indices>,
}

/// The sensitivity of a study to its open parameters.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Sensitivity {
    /// The source of the values.
    pub source: Source,
    /// The number of tests, or of evaluations of the model.
    pub evaluations: usize,
    /// The number of pairs of independent random tests. Each estimate is a mean over the pairs.
    pub pairs: usize,
    /// The variance of the failure. From tests, the failure is 1 for a failing test and 0 for any other test. From a model, it
    /// is the probability that the test fails.
    pub failure: Explained,
    /// The variance of the robustness, which is the least robustness of the requirements in units of their scales,
    /// clipped to [-10, 10]. `None` from a model, which knows only whether tests fail.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub robustness: Option<Explained>,
    /// Remarks that a reader needs to understand the indices.
    pub notes: Vec<String>,
}

/// A reason why the sensitivity cannot be estimated.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum SensitivityFlaw {
    /// No parameter is open.
    #[error(
        "no parameter is open, so nothing can explain differences between tests: leave at least one parameter open"
    )]
    NothingOpen,
    /// Constraints leave a part of the space, so that the parameters are not independent.
    #[error(
        "the constraints leave a part of the space, so the parameters are not independent, and Sobol indices are not \
         defined: narrow the ranges until every test keeps the constraints"
    )]
    Constraints,
    /// The budget is too small.
    #[error("the budget is {budget}, expected at least {least}: {pairs} pairs, with {each} tests for each pair")]
    Budget {
        /// The budget that the user gave.
        budget: usize,
        /// The least budget.
        least: usize,
        /// The least number of pairs of tests.
        pairs: usize,
        /// The number of tests for each pair.
        each: usize,
    },
    /// The campaign has no model of its failures.
    #[error(
        "the campaign has no model of its failures, because {why}: estimate from tests of its own instead, with a budget"
    )]
    NoModel {
        /// The reason, in words.
        why: &'static str,
    },
    /// Too many tests could not be judged.
    #[error(
        "{unjudged} of {tests} tests could not be judged, so the parameters are not independent over the judged \
         tests{}", first.as_ref().map(|first| format!("; the problem of the first test: {first}")).unwrap_or_default()
    )]
    Unjudged {
        /// The number of tests that could not be judged.
        unjudged: usize,
        /// The number of all tests.
        tests: usize,
        /// The problem of the first test, if the problem is known.
        first: Option<Problem>,
    },
}

impl Reason for SensitivityFlaw {}

#[cfg(test)]
mod tests;
