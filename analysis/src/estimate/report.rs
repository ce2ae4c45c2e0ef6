//! Defines the report of `estimate`: the numbers and the places that show them, as in the JSON file.

use paracosm_campaign::JsonArtefact;
use paracosm_coverage::{Bracket, Measure};
use paracosm_space::{Record, Value};
use serde::ser::SerializeMap;
use serde::{Deserialize, Serialize, Serializer};

/// A report of the coverage of a space by a set of tests. Measures that were not asked for are absent.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Coverage {
    /// The number of all tests, including the tests that violate constraints.
    pub tests: usize,
    /// The coverage of the continuous parameters; `None` if the space has no continuous parameters.
    pub continuous: Option<Continuous>,
    /// The number of tests that violate a constraint. Such tests cover nothing.
    #[serde(skip_serializing_if = "is_zero")]
    pub violating: usize,
    /// The coverage of the discrete parameters; `Some(None)` (null) if the space has no discrete parameters, and `None`
    /// (absent) if this coverage was not asked for.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub discrete: Option<Option<Discrete>>,
    /// The (k, epsilon)-coverage of the tests; absent if the space has no discrete parameters or k-wise coverage was
    /// not asked for. Without continuous parameters a row has no hole, and epsilon is 0.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub k_epsilon: Option<KEpsilon>,
    /// The k-wise dispersion, over the discrete and continuous parameters together.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub k_wise_dispersion: Option<KwiseHole>,
}

impl Coverage {
    /// Returns the coverage of a space without parameters, in which there is nothing to cover.
    pub(super) fn of_one_test(tests: usize) -> Self {
        Self { tests, continuous: None, violating: 0, discrete: Some(None), k_epsilon: None, k_wise_dispersion: None }
    }
}

/// The coverage of the continuous parameters, each scaled to `[0,1]`. The JSON object has the parameters, the valid
/// share if constraints leave only a part, and each measure under its key.
#[derive(Debug, Clone, PartialEq)]
pub struct Continuous {
    /// The names of the continuous parameters; a signal has an entry for each of its coordinates.
    pub parameters: Vec<String>,
    /// The share of the box of these parameters in which tests keep the constraints; `None` if no constraint depends on these
    /// parameters. The volume of a hole is then a share of the valid part.
    pub valid_share: Option<Bracket>,
    /// The measures that were taken with their results, in the order in which they are shown.
    pub measured: Vec<(Measure, Measured)>,
}

/// The result of a measure of the continuous parameters.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(untagged)]
pub enum Measured {
    /// A result that is a number; null if there are no tests or the time was too short.
    Number(Option<f64>),
    /// A result that is an exact number, or a bracket (a lower and an upper bound) of a number.
    Bracket(Bracket),
    /// A result that is the largest box without a test inside.
    Hole(Hole),
    /// A result that is the largest ball without a test inside and with its centre in the cube; null without tests.
    Ball(Option<Ball>),
}

impl Measured {
    /// Returns the result as a bracket of a number, a volume or a radius; `None` if the result is not known.
    pub fn bracket(&self) -> Option<Bracket> {
        match self {
            Self::Number(number) => number.map(Bracket::exact),
            Self::Bracket(bracket) => Some(*bracket),
            Self::Hole(hole) => Some(hole.volume),
            Self::Ball(ball) => ball.as_ref().map(|ball| ball.radius),
        }
    }
}

impl Continuous {
    /// Returns the result of a measure; `None` if the measure was not taken.
    pub fn measured(&self, measure: Measure) -> Option<&Measured> {
        self.measured.iter().find(|(taken, _)| *taken == measure).map(|(_, measured)| measured)
    }

    /// Returns the result of a measure as a bracket; `None` if the measure was not taken or its result is not known.
    pub fn bracket(&self, measure: Measure) -> Option<Bracket> {
        self.measured(measure).and_then(Measured::bracket)
    }
}

impl Serialize for Continuous {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let mut map = serializer.serialize_map(Some(1 + self.measured.len()))?;
        map.serialize_entry("parameters", &self.parameters)?;
        if let Some(share) = &self.valid_share {
            map.serialize_entry("valid_share", share)?;
        }
        for (measure, measured) in &self.measured {
            map.serialize_entry(measure.descriptor().key, measured)?;
        }
        map.end()
    }
}

/// The largest box without a test inside.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Hole {
    /// The volume of the largest empty box within the valid part of the space, as a share of this part.
    #[serde(flatten)]
    pub volume: Bracket,
    /// The two ends of the largest empty box along each parameter, as values of the parameter. The box has the lower
    /// volume.
    pub largest_empty_box: Record<[f64; 2]>,
}

/// The largest ball without a test inside.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Ball {
    /// The radius of the largest empty ball, with each parameter scaled to `[0,1]`.
    #[serde(flatten)]
    pub radius: Bracket,
    /// The centre of the largest empty ball, as parameter values. The ball has the lower radius.
    pub centre: Record<f64>,
}

/// The coverage of the discrete parameters.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Discrete {
    /// The number of parameters in each combination of values.
    pub k: usize,
    /// The number of valid combinations of values of any k parameters.
    pub valid: u64,
    /// The number of valid combinations that at least one test contains.
    pub covered: u64,
    /// The share of the valid combinations that at least one test contains (covered / valid).
    pub ratio: f64,
    /// Examples of valid combinations that no test contains, 20 at most.
    pub missing: Vec<Record<Value>>,
    /// The tested share of the valid combinations of all discrete parameters; null if there are too many combinations
    /// to count.
    pub combinations: Option<f64>,
    /// The coverage of each group of parameters that has its own k.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub strengths: Vec<Strength>,
}

/// The coverage of a group of discrete parameters that has its own k.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Strength {
    /// The names of the group's parameters.
    pub parameters: Vec<String>,
    /// The number of parameters of the group in each combination of values.
    pub k: usize,
    /// The number of valid combinations of values of any k parameters of the group.
    pub valid: u64,
    /// The number of valid combinations of the group that at least one test contains.
    pub covered: u64,
    /// The share of the group's valid combinations that at least one test contains (covered / valid).
    pub ratio: f64,
    /// Examples of valid combinations of the group that no test contains, 20 at most.
    pub missing: Vec<Record<Value>>,
}

/// The (k, epsilon)-coverage of tests, which joins k-wise coverage and dispersion. Tests are (k, epsilon)-covering if
/// any k discrete parameters show all valid combinations of their values, and no row of discrete values has an empty
/// box larger than epsilon (the paper, section 3.1).
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct KEpsilon {
    /// The number of discrete parameters in each combination of values.
    pub k: usize,
    /// `true` if the tests cover all valid combinations of any k discrete parameters.
    pub complete: bool,
    /// The smallest epsilon for which the tests are (k, epsilon)-covering; null if a valid combination is not covered.
    /// After a time-out this is an upper bound.
    pub epsilon: Option<f64>,
    /// The largest dispersion of the tests with the same discrete values, over all discrete values that tests have.
    /// After a time-out this is an upper bound.
    pub epsilon_over_covered_rows: f64,
    /// A lower bound of the largest dispersion of the tests with the same discrete values. Without a time-out this is
    /// the largest dispersion itself.
    pub epsilon_at_least: f64,
}

/// The largest hole, which is a part of the space without a test, over any k parameters.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct KwiseHole {
    /// The number of parameters over which the hole extends.
    pub k: usize,
    /// The volume of the hole, as a share of the valid part of the space of its k parameters.
    #[serde(flatten)]
    pub volume: Bracket,
    /// The place of the largest hole in the space.
    pub worst: KwiseWorst,
}

/// The place of a hole, given by values of discrete parameters and a box over continuous parameters.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct KwiseWorst {
    /// The discrete parameters of the hole, with their values.
    pub fixed: Record<Value>,
    /// The two ends of the hole's box along each continuous parameter, as values.
    pub empty_box: Record<[f64; 2]>,
}

fn is_zero(number: &usize) -> bool {
    *number == 0
}

impl JsonArtefact for Coverage {
    const FILE: &'static str = "coverage.json";
}
