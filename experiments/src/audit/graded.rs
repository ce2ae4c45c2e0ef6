//! A suite with its coverage and its score: a row of the table from which the statistics follow.

use serde::{Deserialize, Serialize};

/// A suite with its coverage and its score.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct Graded {
    pub scenario: String,
    pub strategy: String,
    pub seed: u64,
    pub tests: usize,
    /// The number of mutants, and of those among them that conditions turn on.
    pub mutants: usize,
    pub conditional: usize,
    /// The largest empty box of the continuous parameters; `None` if there are none, or if the box is not known exactly.
    pub dispersion: Option<f64>,
    /// The share of covered pairs of values of discrete parameters; `None` if there are not two such parameters.
    pub pairs: Option<f64>,
    /// The largest hole of any two parameters; `None` if it is not known exactly.
    pub pair_dispersion: Option<f64>,
    pub score: f64,
    /// The score for mutants that conditions turn on.
    pub score_conditional: Option<f64>,
}
