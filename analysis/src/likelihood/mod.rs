//! Estimates the probability that a test fails, if the parameters have the distributions that the user gives.
//!
//! The algorithms know nothing about scenarios. They receive a function that maps points of the unit cube, uniform
//! and independent, to robustness values, and estimate the probability that a value is below zero. Every number is an
//! estimate with a confidence interval; no number proves that there is no failure.

mod monte_carlo;
mod qmc;
mod study;
mod subset;

pub(crate) use study::always_hold;
pub use study::of_study;

use paracosm_campaign::{Error, Problem, Reason};
use paracosm_space::{did_you_mean, nearest};
use serde::Serialize;
use std::fmt;
use std::str::FromStr;
use thiserror::Error;

/// A method that estimates a probability of failure.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Method {
    /// Independent tests, with the exact interval of Clopper and Pearson.
    MonteCarlo,
    /// Repetitions of Owen-scrambled Sobol points, with Student's interval over the repetitions. The interval is
    /// narrower than that of Monte Carlo if few parameters decide and failures are not rare.
    Qmc,
    /// Subset simulation by chains of ever worse tests, for failures that are too rare for the other methods.
    Subset,
}

impl Method {
    /// All methods that estimate a probability of failure.
    pub const ALL: [Self; 3] = [Self::MonteCarlo, Self::Qmc, Self::Subset];

    /// Returns the name by which a user chooses the method.
    pub fn name(self) -> &'static str {
        match self {
            Self::MonteCarlo => "monte-carlo",
            Self::Qmc => "qmc",
            Self::Subset => "subset",
        }
    }

    /// Returns the least budget with which the method gives an estimate.
    pub fn least_budget(self) -> usize {
        match self {
            Self::MonteCarlo => 1,
            Self::Qmc => qmc::REPLICATES,
            Self::Subset => subset::LEAST_BUDGET,
        }
    }
}

impl fmt::Display for Method {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

/// The error that no method of estimation has the given name.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[error("no method is called `{name}`{}; the methods are {}", did_you_mean(.nearest), Method::ALL.map(Method::name).join(", "))]
pub struct UnknownMethod {
    /// The name of the method that was not found.
    pub name: String,
    /// The name of a similar method that the user perhaps meant.
    pub nearest: Option<&'static str>,
}

/// A reason why the probability of failure cannot be estimated.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum LikelihoodFlaw {
    /// The confidence of the interval is not between 0 and 1.
    #[error("the confidence is {found}, expected a number above 0 and below 1")]
    Confidence {
        /// The confidence that the user gave.
        found: f64,
    },
    /// The budget is too small for the method.
    #[error("the budget is {budget}, expected at least {least} for the method {method}")]
    Budget {
        /// The budget that the user gave.
        budget: usize,
        /// The least budget of the method.
        least: usize,
        /// The method that the user chose.
        method: Method,
    },
    /// No parameter is open (all have fixed values), so that there is no probability to estimate.
    #[error("no parameter is open, so there is no probability to estimate: leave at least one parameter open")]
    NothingOpen,
    /// Constraints leave a part of the space, and the method needs the whole space.
    #[error(
        "the constraints leave a part of the space, and the method {method} needs the whole space; the method monte-carlo does not"
    )]
    Constraints {
        /// The method that the user chose.
        method: Method,
    },
    /// No random test keeps the constraints.
    #[error("none of {drawn} random tests keeps the constraints")]
    NoValidTest {
        /// The number of random tests.
        drawn: usize,
    },
    /// No test could be judged, because each test broke, or its world could not be built.
    #[error(
        "no test could be judged{}", first.as_ref().map(|first| format!("; the problem of the first test: {first}")).unwrap_or_default()
    )]
    NothingJudged {
        /// The problem of the first test, if the problem is known.
        first: Option<Problem>,
    },
}

impl Reason for UnknownMethod {}
impl Reason for LikelihoodFlaw {}

impl FromStr for Method {
    type Err = UnknownMethod;

    fn from_str(text: &str) -> Result<Self, UnknownMethod> {
        let unknown = || UnknownMethod { name: text.to_owned(), nearest: nearest(text, Self::ALL.map(Self::name)) };
        Self::ALL.into_iter().find(|method| method.name() == text).ok_or_else(unknown)
    }
}

/// The settings of an estimate, which are the method, the budget, the confidence and the seed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Question {
    /// The method by which the probability is to be estimated.
    pub method: Method,
    /// The greatest number of tests that are run.
    pub budget: usize,
    /// The probability with which the interval is to contain the true value, above 0 and below 1.
    pub confidence: f64,
    /// The seed of all random numbers of the estimate.
    pub seed: u64,
}

impl Question {
    fn check(&self) -> Result<(), LikelihoodFlaw> {
        let Self { method, budget, confidence, .. } = *self;
        if !(confidence > 0.0 && confidence < 1.0) {
            return Err(LikelihoodFlaw::Confidence { found: confidence });
        }
        let least = method.least_budget();
        if budget < least {
            return Err(LikelihoodFlaw::Budget { budget, least, method });
        }
        Ok(())
    }
}

/// An estimated probability of failure.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Likelihood {
    /// The estimated probability of a failure, given that the test can be judged.
    pub probability: f64,
    /// The lower end of the confidence interval of the probability. In the lower end, tests that could not be judged
    /// count as passed.
    pub lower: f64,
    /// The upper end of the confidence interval of the probability. In the upper end, tests that could not be judged
    /// count as failed.
    pub upper: f64,
    /// The probability with which the method gives an interval that contains the true value.
    pub confidence: f64,
    /// The method by which the probability was estimated.
    pub method: Method,
    /// The statistical basis of the interval, in words.
    pub interval: String,
    /// The number of tests that were run for the estimate.
    pub evaluations: usize,
    /// The number of failing tests among the tests of the estimate. Only for `monte-carlo` does the probability follow
    /// from the share of failing tests.
    pub failures: usize,
    /// The number of tests that could not be judged, because they broke or their worlds could not be built.
    pub unjudged: usize,
    /// Remarks that a reader needs to understand the estimate.
    pub notes: Vec<String>,
}

/// A function that runs tests and returns the robustness of each test. The robustness at a point of the unit cube is
/// negative (-0 included) for a failure, and `None` if the test could not be judged.
pub type Evaluate<'a> = dyn FnMut(&[Vec<f64>]) -> Result<Vec<Option<f64>>, Error> + 'a;

/// Estimates the probability that a uniformly distributed point of the unit cube with `dims` dimensions is a failure.
///
/// The method decides the number of points that are evaluated at a time. The result depends only on the question and
/// the values.
///
/// ```
/// use paracosm_analysis::likelihood::{Method, Question, estimate};
/// let question = Question { method: Method::MonteCarlo, budget: 1000, confidence: 0.95, seed: 0 };
/// let found = estimate(&question, 2, &mut |points| Ok(points.iter().map(|x| Some(x[0] - 0.25)).collect()))?;
/// assert!(found.lower < 0.25 && 0.25 < found.upper);
/// # Ok::<(), paracosm_campaign::Error>(())
/// ```
///
/// # Errors
/// The budget is too small for the method, the confidence is not between 0 and 1, `dims` is 0, no test could be
/// judged, or `evaluate` returned an error.
pub fn estimate(question: &Question, dims: usize, evaluate: &mut Evaluate) -> Result<Likelihood, Error> {
    question.check()?;
    if dims == 0 {
        return Err(LikelihoodFlaw::NothingOpen.into());
    }
    let mut runs = Runs { evaluate, evaluations: 0, failures: 0, unjudged: 0 };
    let found = match question.method {
        Method::MonteCarlo => monte_carlo::estimate(question, dims, &mut runs),
        Method::Qmc => qmc::estimate(question, dims, &mut runs),
        Method::Subset => subset::estimate(question, dims, &mut runs),
    }?;
    let mut notes = found.notes;
    if runs.unjudged > 0 {
        let count = runs.unjudged;
        notes.push(format!(
            "{count} of the tests could not be judged: such tests count as passed in the lower end of the interval and as failed in the upper end"
        ));
    }
    let [lower, upper] = found.interval;
    Ok(Likelihood {
        probability: found.probability,
        lower: lower.clamp(0.0, found.probability),
        upper: upper.clamp(found.probability, 1.0),
        confidence: question.confidence,
        method: question.method,
        interval: found.source,
        evaluations: runs.evaluations,
        failures: runs.failures,
        unjudged: runs.unjudged,
        notes,
    })
}

/// The result of a method.
struct Tail {
    probability: f64,
    interval: [f64; 2],
    source: String,
    notes: Vec<String>,
}

/// A runner of tests that counts the tests.
struct Runs<'a, 'b> {
    evaluate: &'a mut Evaluate<'b>,
    evaluations: usize,
    failures: usize,
    unjudged: usize,
}

impl Runs<'_, '_> {
    /// Runs tests and returns the robustness at each point.
    fn run(&mut self, points: &[Vec<f64>]) -> Result<Vec<Option<f64>>, Error> {
        if points.is_empty() {
            return Ok(Vec::new());
        }
        let mut values = (self.evaluate)(points)?;
        assert_eq!(values.len(), points.len(), "a value for every point");
        for value in &mut values {
            *value = value.filter(|robustness| !robustness.is_nan());
        }
        let Tally { failures, unjudged, .. } = Tally::of(&values);
        self.evaluations += points.len();
        self.failures += failures;
        self.unjudged += unjudged;
        Ok(values)
    }
}

/// Returns `true` if a robustness is the robustness of a failure (negative, or -0).
fn is_failure(robustness: f64) -> bool {
    robustness.is_sign_negative()
}

/// The counts of outcomes of independent tests.
#[derive(Clone, Copy, Default)]
struct Tally {
    tests: usize,
    failures: usize,
    unjudged: usize,
}

impl Tally {
    fn of(values: &[Option<f64>]) -> Self {
        let failures = values.iter().flatten().filter(|robustness| is_failure(**robustness)).count();
        let unjudged = values.iter().filter(|value| value.is_none()).count();
        Self { tests: values.len(), failures, unjudged }
    }

    fn add(&mut self, other: Self) {
        self.tests += other.tests;
        self.failures += other.failures;
        self.unjudged += other.unjudged;
    }

    /// Returns the share of failures among the tests that were judged.
    fn share(self) -> Result<f64, LikelihoodFlaw> {
        match self.tests - self.unjudged {
            0 => Err(LikelihoodFlaw::NothingJudged { first: None }),
            judged => Ok(self.failures as f64 / judged as f64),
        }
    }

    /// Returns the exact interval of the share of failures.
    fn interval(self, confidence: f64) -> [f64; 2] {
        let Self { tests, failures, unjudged } = self;
        let end = |failures, which: usize| crate::statistics::clopper_pearson(failures, tests, confidence)[which];
        [end(failures, 0), end(failures + unjudged, 1)]
    }
}

#[cfg(test)]
mod tests;
