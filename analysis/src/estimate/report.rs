//! What `estimate` says: the numbers and the places that show them, as JSON has them.

use paracosm_campaign::JsonArtefact;
use paracosm_coverage::{Bracket, Measure};
use paracosm_space::{Record, Value};
use serde::ser::SerializeMap;
use serde::{Deserialize, Serialize, Serializer};

/// How well a set of tests covers its space. Measures that were not asked for are absent.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Coverage {
    /// How many tests there are.
    pub tests: usize,
    /// The continuous half; `None` where the space has none.
    pub continuous: Option<Continuous>,
    /// How many of the tests violate a constraint; they cover nothing.
    #[serde(skip_serializing_if = "is_zero")]
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

/// How well tests cover the continuous parameters, each scaled to `[0,1]`. As JSON, the parameters, and each measure under
/// its key.
#[derive(Debug, Clone, PartialEq)]
pub struct Continuous {
    /// The parameters; of a signal each of its coordinates.
    pub parameters: Vec<String>,
    /// The measures that were taken, in the order in which they are shown, with what each says.
    pub measured: Vec<(Measure, Measured)>,
}

/// What a measure says of the continuous parameters.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(untagged)]
pub enum Measured {
    /// A number; null without tests or time.
    Number(Option<f64>),
    /// A number that is exact, or between two bounds.
    Bracket(Bracket),
    /// The largest empty box.
    Hole(Hole),
    /// The largest empty ball with its centre in the cube; null without tests.
    Ball(Option<Ball>),
}

impl Measured {
    /// The number, or between which bounds it is; none where nothing is known.
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
    /// What a measure says, if it was taken.
    pub fn measured(&self, measure: Measure) -> Option<&Measured> {
        self.measured.iter().find(|(taken, _)| *taken == measure).map(|(_, measured)| measured)
    }

    /// The number of a measure; none if the measure was not taken, or nothing is known.
    pub fn bracket(&self, measure: Measure) -> Option<Bracket> {
        self.measured(measure).and_then(Measured::bracket)
    }
}

impl Serialize for Continuous {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let mut map = serializer.serialize_map(Some(1 + self.measured.len()))?;
        map.serialize_entry("parameters", &self.parameters)?;
        for (measure, measured) in &self.measured {
            map.serialize_entry(measure.descriptor().key, measured)?;
        }
        map.end()
    }
}

/// The largest box that no test has entered.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Hole {
    /// Its volume as a share of the space.
    #[serde(flatten)]
    pub volume: Bracket,
    /// A box of the lower volume: from and to of each parameter, as values.
    pub largest_empty_box: Record<[f64; 2]>,
}

/// The largest ball that holds no test.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Ball {
    /// Its radius, each parameter scaled to `[0,1]`.
    #[serde(flatten)]
    pub radius: Bracket,
    /// The centre of a ball of the lower radius, as values.
    pub centre: Record<f64>,
}

/// How well tests cover the discrete parameters.
#[derive(Debug, Clone, PartialEq, Serialize)]
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
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub strengths: Vec<Strength>,
}

/// How well tests cover a group of discrete parameters.
#[derive(Debug, Clone, PartialEq, Serialize)]
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
#[derive(Debug, Clone, PartialEq, Serialize)]
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
#[derive(Debug, Clone, PartialEq, Serialize)]
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

impl JsonArtefact for Coverage {
    const FILE: &'static str = "coverage.json";
}
