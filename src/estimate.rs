//! How well tests cover their space: what `paracosm-cover estimate` prints.

use crate::Error;
use paracosm_coverage::dispersion::dispersion;
use paracosm_coverage::kwise::kwise_coverage;
use paracosm_coverage::star::star_discrepancy;
use paracosm_coverage::{Bracket, Deadline, Parameter, Point, PointSet, Record, Space, Value};
use paracosm_coverage::{did_you_mean, l2, nearest};
use serde::{Deserialize, Serialize};
use std::str::FromStr;
use std::time::{Duration, Instant};

/// Tests with the space that they are points of.
#[derive(Debug, Clone, PartialEq)]
pub struct Tests {
    /// Their space.
    pub space: Space,
    /// Their coordinates.
    pub points: Vec<Point>,
    /// How many discrete parameters at a time they were made to cover, if that was said.
    pub k: Option<usize>,
}

/// A number that says how well tests cover a space.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Measure {
    /// The volume of the largest box without a test.
    Dispersion,
    /// The star discrepancy.
    Star,
    /// The L2-star discrepancy.
    L2Star,
    /// The centered discrepancy, squared.
    Centered,
    /// The wraparound discrepancy, squared.
    Wraparound,
    /// The mixture discrepancy, squared.
    Mixture,
    /// The share of combinations of k discrete parameters that are covered.
    KWise,
}

impl Measure {
    /// Every measure.
    pub const ALL: [Self; 7] =
        [Self::Dispersion, Self::Star, Self::L2Star, Self::Centered, Self::Wraparound, Self::Mixture, Self::KWise];

    /// The name by which it is asked for.
    pub fn name(self) -> &'static str {
        match self {
            Self::Dispersion => "dispersion",
            Self::Star => "star",
            Self::L2Star => "l2_star",
            Self::Centered => "centered",
            Self::Wraparound => "wraparound",
            Self::Mixture => "mixture",
            Self::KWise => "k-wise",
        }
    }
}

impl FromStr for Measure {
    type Err = String;

    fn from_str(name: &str) -> Result<Self, String> {
        Self::ALL.into_iter().find(|measure| measure.name() == name).ok_or_else(|| {
            let names = Self::ALL.map(Self::name);
            let hint = did_you_mean(&nearest(name, names));
            format!("no measure is called `{name}`{hint}; there are {}", names.join(", "))
        })
    }
}

/// How well a set of tests covers its space. Measures that were not asked for are absent.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Coverage {
    /// How many tests there are.
    pub tests: usize,
    /// The continuous half; `None` where the space has none.
    pub continuous: Option<Continuous>,
    /// The discrete half; `None` where the space has none.
    pub discrete: Option<Discrete>,
}

/// How well tests cover the continuous parameters, each scaled to `[0,1]`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Continuous {
    /// The parameters.
    pub parameters: Vec<String>,
    /// The largest empty box.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub dispersion: Option<Hole>,
    /// The star discrepancy.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub star_discrepancy: Option<Bracket>,
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

/// The largest box that no test has entered.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Hole {
    /// Its volume as a share of the space.
    #[serde(flatten)]
    pub volume: Bracket,
    /// A box of the lower volume: from and to of each parameter, as values.
    pub largest_empty_box: Record<[f64; 2]>,
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
    /// The share of the combinations of all parameters that are tested.
    pub combinations: f64,
}

impl Tests {
    /// Measures how well the tests cover their space: discrete parameters `k` at a time (where nothing is said, as
    /// they were made to; else 2, or as many as there are), and all that takes long within a time limit.
    ///
    /// # Errors
    /// There are not `k` discrete parameters, or too many combinations of them to count.
    pub fn measure(&self, measures: &[Measure], k: Option<usize>, limit: Option<Duration>) -> Result<Coverage, Error> {
        let continuous = if self.space.dims() == 0 { None } else { Some(self.continuous(measures, limit)?) };
        let levels = self.space.levels();
        if levels.is_empty() && k.is_some() {
            return Err(Error::Usage("the space has no discrete parameters, so there is no k to cover them by".into()));
        }
        let discrete = if levels.is_empty() || !measures.contains(&Measure::KWise) {
            None
        } else {
            Some(self.discrete(k.or(self.k).unwrap_or(levels.len().min(2)), &levels)?)
        };
        Ok(Coverage { tests: self.points.len(), continuous, discrete })
    }

    fn continuous(&self, measures: &[Measure], limit: Option<Duration>) -> Result<Continuous, Error> {
        let points = PointSet::new(self.space.dims(), self.points.iter().map(|point| &point.continuous))?;
        let asked = |measure| measures.contains(&measure);
        let parameters: Vec<&Parameter> = self.space.continuous().collect();
        // What a measure leaves of the time is for those after it.
        let end = limit.and_then(|limit| Instant::now().checked_add(limit));
        let mut waiting = measures.iter().filter(|measure| **measure != Measure::KWise).count() as u32;
        let mut deadline = || {
            let share = end.map(|end| end.saturating_duration_since(Instant::now()) / waiting.max(1));
            waiting = waiting.saturating_sub(1);
            share.map_or_else(Deadline::never, Deadline::after)
        };
        let mut mean = |measure: fn(&PointSet, Deadline) -> Option<f64>| measure(&points, deadline());
        let l2_star = asked(Measure::L2Star).then(|| mean(l2::l2_star));
        let centered = asked(Measure::Centered).then(|| mean(l2::centered));
        let wraparound = asked(Measure::Wraparound).then(|| mean(l2::wraparound));
        let mixture = asked(Measure::Mixture).then(|| mean(l2::mixture));
        Ok(Continuous {
            parameters: parameters.iter().map(|parameter| parameter.name.clone()).collect(),
            dispersion: asked(Measure::Dispersion).then(|| {
                let found = dispersion(&points, deadline());
                let sides = found.witness.lower.iter().zip(&found.witness.upper);
                let sides = parameters
                    .iter()
                    .zip(sides)
                    .map(|(p, (lo, hi))| (p.name.clone(), [*lo, *hi].map(|u| p.value_at(u))));
                Hole { volume: found.volume, largest_empty_box: sides.collect() }
            }),
            star_discrepancy: asked(Measure::Star).then(|| star_discrepancy(&points, deadline())),
            l2_star,
            centered,
            wraparound,
            mixture,
        })
    }

    fn discrete(&self, k: usize, levels: &[usize]) -> Result<Discrete, Error> {
        let parameters: Vec<&Parameter> = self.space.discrete().collect();
        let counted = kwise_coverage(levels, k, self.points.iter().map(|point| point.discrete.as_slice()))?;
        let name = |(parameter, level): &(usize, usize)| {
            let parameter = parameters[*parameter];
            let level = parameter.levels().expect("it is a discrete parameter")[*level].clone();
            (parameter.name.clone(), level)
        };
        Ok(Discrete {
            k,
            valid: counted.valid,
            covered: counted.covered,
            ratio: counted.ratio(),
            missing: counted.missing.iter().map(|tuple| tuple.iter().map(name).collect()).collect(),
            combinations: counted.combinations,
        })
    }
}
