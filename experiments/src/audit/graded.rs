//! A suite with its coverage and its score: a row of the table from which the statistics follow.

use serde::{Deserialize, Serialize};

/// A suite with its coverage and its score.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct Graded {
    /// The name of the scenario.
    pub scenario: String,
    /// The name of the strategy that made the suite.
    pub strategy: String,
    /// The seed of the strategy.
    pub seed: u64,
    /// The number of tests of the suite.
    pub tests: usize,
    /// The number of mutants.
    pub mutants: usize,
    /// The number of mutants that conditions turn on.
    pub conditional: usize,
    /// The largest empty box of the continuous parameters; `None` if there are none, or if the box is not known exactly.
    pub dispersion: Option<f64>,
    /// The share of covered pairs of values of discrete parameters; `None` if there are not two such parameters.
    pub pairs: Option<f64>,
    /// The largest hole of any two parameters; `None` if it is not known exactly.
    pub pair_dispersion: Option<f64>,
    /// The mutation score.
    pub score: f64,
    /// The mutation score for mutants that conditions turn on; `None` if there are none.
    pub score_conditional: Option<f64>,
}
