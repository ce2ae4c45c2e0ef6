//! What `estimate` says: the numbers and the places that show them, as JSON has them.

use paracosm_coverage::{Bracket, Record, Value};
use serde::{Deserialize, Serialize};

/// How well a set of tests covers its space. Measures that were not asked for are absent.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Coverage {
    /// How many tests there are.
    pub tests: usize,
    /// The continuous half; `None` where the space has none.
    pub continuous: Option<Continuous>,
    /// How many of the tests violate a constraint; they cover nothing.
    #[serde(skip_serializing_if = "is_zero", default)]
    pub violating: usize,
    /// The discrete half; `Some(None)`, null, where the space has none, and absent where it was not asked for.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub discrete: Option<Option<Discrete>>,
    /// Whether the tests are (k, epsilon)-covering; absent where nothing is discrete, or k-wise coverage was not asked
    /// for. Without continuous parameters a row has no hole, and epsilon is 0.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub k_epsilon: Option<KEpsilon>,
    /// Both halves together.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub k_wise_dispersion: Option<KwiseHole>,
}

/// How well tests cover the continuous parameters, each scaled to `[0,1]`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Continuous {
    /// The parameters; of a signal each of its coordinates.
    pub parameters: Vec<String>,
    /// The largest empty box.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub dispersion: Option<Hole>,
    /// The star discrepancy.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub star_discrepancy: Option<Bracket>,
    /// The extreme discrepancy.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub extreme_discrepancy: Option<Bracket>,
    /// The radius of the largest empty ball with its centre in the cube; null without tests.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub fill: Option<Option<Ball>>,
    /// The L2-star discrepancy; null without tests or time.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub l2_star: Option<Option<f64>>,
    /// The squared centered discrepancy; null without tests or time.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub centered: Option<Option<f64>>,
    /// The squared wraparound discrepancy; null without tests or time.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub wraparound: Option<Option<f64>>,
    /// The squared mixture discrepancy; null without tests or time.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub mixture: Option<Option<f64>>,
}

impl Continuous {
    /// Nothing measured yet.
    pub(super) fn of(parameters: Vec<String>) -> Self {
        Self {
            parameters,
            dispersion: None,
            star_discrepancy: None,
            extreme_discrepancy: None,
            fill: None,
            l2_star: None,
            centered: None,
            wraparound: None,
            mixture: None,
        }
    }
}

/// The largest box that no test has entered.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Hole {
    /// Its volume as a share of the space.
    #[serde(flatten)]
    pub volume: Bracket,
    /// A box of the lower volume: from and to of each parameter, as values.
    pub largest_empty_box: Record<[f64; 2]>,
}

/// The largest ball that holds no test.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Ball {
    /// Its radius, each parameter scaled to `[0,1]`.
    #[serde(flatten)]
    pub radius: Bracket,
    /// The centre of a ball of the lower radius, as values.
    pub centre: Record<f64>,
}

/// How well tests cover the discrete parameters.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Discrete {
    /// How many parameters are looked at together.
    pub k: usize,
    /// All combinations of values of k parameters.
    pub valid: u64,
    /// Those that some test contains.
    pub covered: u64,
    /// covered / valid.
    pub ratio: f64,
    /// Some that no test contains, 20 at most.
    pub missing: Vec<Record<Value>>,
    /// The share of the valid combinations of all parameters that are tested; null where these are too many to count.
    pub combinations: Option<f64>,
    /// The groups that were named, with a k of their own.
    #[serde(skip_serializing_if = "Vec::is_empty", default)]
    pub strengths: Vec<Strength>,
}

/// How well tests cover a group of discrete parameters.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Strength {
    /// The parameters.
    pub parameters: Vec<String>,
    /// How many of them are looked at together.
    pub k: usize,
    /// All combinations of values of k of them.
    pub valid: u64,
    /// Those that some test contains.
    pub covered: u64,
    /// covered / valid.
    pub ratio: f64,
    /// Some that no test contains, 20 at most.
    pub missing: Vec<Record<Value>>,
}

/// Whether tests are (k, epsilon)-covering: any k discrete parameters show all valid combinations of their values, and
/// no row of discrete values has an empty box larger than epsilon (the paper, section 3.1).
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct KEpsilon {
    /// How many discrete parameters are looked at together.
    pub k: usize,
    /// Whether all valid combinations of them are covered.
    pub complete: bool,
    /// The smallest epsilon; null if they are not.
    pub epsilon: Option<f64>,
    /// The largest dispersion of the rows that there are. Where the time limit cut it short, it is no more than this,
    /// and so is `epsilon`.
    pub epsilon_over_covered_rows: f64,
    /// It is no less than this either: the same number, unless the time limit cut it short.
    pub epsilon_at_least: f64,
}

/// The largest hole that any k parameters show.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct KwiseHole {
    /// How many parameters are looked at together.
    pub k: usize,
    /// Its volume as a share of the values of those parameters.
    #[serde(flatten)]
    pub volume: Bracket,
    /// Where it is.
    pub worst: KwiseWorst,
}

/// The place of a hole: values of some discrete parameters, and a box over some continuous ones.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct KwiseWorst {
    /// The discrete parameters among the k, with their values.
    pub fixed: Record<Value>,
    /// From and to of the continuous ones, as values.
    pub empty_box: Record<[f64; 2]>,
}

fn is_zero(number: &usize) -> bool {
    *number == 0
}
