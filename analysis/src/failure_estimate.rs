//! How probable a failure is over two coordinates of a campaign's tests, what is sure of it, and where.
//!
//! The model of the verdicts (`generators::FailureModel`) is asked on a grid. Where the tests vary more than two
//! coordinates, each place of the grid stands for eight random Latin hypercubes of sixteen tests in the others, and what is
//! estimated is the share of these that fail. How much the eight differ is the error of having taken samples, which is in
//! the deviation.
//!
//! Some tests cannot be built. Which ones, a second model tells of those that could not, and the share that fails is one of
//! the others. A place of which more than half cannot be built is *invalid*: nothing is said of failures there.

use paracosm_campaign::{Error, Log, Reason, Study, Trial};
use paracosm_generators::{DiscreteFamily, FailingShare, FailureModel, Request, Strategy};
use paracosm_oracles::Verdict;
use paracosm_space::{Point, did_you_mean, nearest};
use thiserror::Error;

/// The nodes of a grid along both axes, alone and where each stands for many tests.
const FINE: [usize; 2] = [61, 46];
const COARSE: [usize; 2] = [25, 19];

/// For how many samples a place stands where others are varied too, and for how many tests each of them.
const SAMPLES: usize = 8;
const OTHERS: usize = 16;

/// So large a share of the tests at a place can be built, or it is invalid.
const LEAST_VALID: f64 = 0.5;

/// How sure it has to be on which side of one half a probability is, so that a place is decided.
const SURE: f64 = 0.95;

/// The estimated probability of failure on a grid over two coordinates.
#[derive(Debug, Clone, PartialEq)]
pub struct FailureEstimate {
    /// The names of the two coordinates.
    pub names: [String; 2],
    /// The values of the first coordinate, from its least to its greatest.
    pub x: Vec<f64>,
    /// The values of the second.
    pub y: Vec<f64>,
    /// What is known at each place: all of the first coordinate for the first of the second, and so on.
    pub shares: Vec<FailingShare>,
    /// The estimated share of the tests at each place that can be built, in the same order; the share that fails is one of
    /// these.
    pub valid: Vec<f64>,
}

/// The positions of two coordinates among the continuous ones of a study.
pub type Axes = [usize; 2];

/// Why a map cannot have these axes.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
pub enum AxesFlaw {
    /// One is discrete.
    #[error("`{name}` takes single values, expected an interval: axes can be {}", can.join(", "))]
    Discrete {
        /// Its name.
        name: String,
        /// The names that axes can have.
        can: Vec<String>,
    },
    /// The tests do not vary one.
    #[error("the tests vary no `{name}`{}; axes can be {}", did_you_mean(.nearest), can.join(", "))]
    Unknown {
        /// Its name.
        name: String,
        /// A name that was perhaps meant.
        nearest: Option<String>,
        /// The names that axes can have.
        can: Vec<String>,
    },
    /// Both are one.
    #[error("both axes are `{name}`, expected two of {}", can.join(", "))]
    Same {
        /// Its name.
        name: String,
        /// The names that axes can have.
        can: Vec<String>,
    },
}

impl Reason for AxesFlaw {}

/// The positions of the coordinates with these names.
///
/// # Errors
/// A name is none of a continuous coordinate, or both are one.
pub fn axes(study: &Study, names: [&str; 2]) -> Result<Axes, AxesFlaw> {
    let all: Vec<String> = study.space().continuous().map(|coordinate| coordinate.name()).collect();
    let position = |name: &str| {
        all.iter().position(|other| other == name).ok_or_else(|| {
            let (name, can) = (name.to_owned(), all.clone());
            let discrete = study.space().discrete().any(|coordinate| coordinate.name() == name);
            if discrete {
                return AxesFlaw::Discrete { name, can };
            }
            let signal = format!("{name}[0]");
            let meant = all.contains(&signal).then_some(signal);
            let nearest = meant.or_else(|| nearest(&name, all.iter().map(String::as_str)).map(str::to_owned));
            AxesFlaw::Unknown { name, nearest, can }
        })
    };
    let found = [position(names[0])?, position(names[1])?];
    if found[0] == found[1] {
        return Err(AxesFlaw::Same { name: names[0].to_owned(), can: all });
    }
    Ok(found)
}

impl FailureEstimate {
    /// The estimate of a campaign over two of its continuous coordinates; `None` where no test failed or none passed.
    ///
    /// # Errors
    /// A trial is none of the study's space, or its constraints cannot be kept.
    pub fn of(log: &Log, axes: Axes) -> Result<Option<Self>, Error> {
        let (study, trials) = (log.study(), log.trials());
        let judged: Vec<&Trial> =
            trials.iter().filter(|t| matches!(t.verdict, Verdict::Fail | Verdict::Pass)).collect();
        let failures = judged.iter().filter(|trial| trial.is_failure()).count();
        if failures == 0 || failures == judged.len() {
            return Ok(None);
        }
        let tests = judged.iter().map(|trial| study.space().encode(&trial.test)).collect::<Result<Vec<_>, _>>()?;
        // The sign is the verdict's, whatever a rounded robustness says.
        let robustness = judged.iter().map(|trial| {
            let size = log.scales().objective(trial).map_or(1.0, f64::abs);
            if trial.is_failure() { -size } else { size }
        });
        let Some(model) = FailureModel::fit(study.space(), &tests, &robustness.collect::<Vec<_>>()) else {
            return Ok(None);
        };
        let (others, samples) = others(study)?;
        if others.is_empty() {
            return Ok(None);
        }
        let nodes = if samples == 1 { FINE } else { COARSE };
        let at = |axis: usize, node: usize| node as f64 / (nodes[axis] - 1) as f64;
        let place = |other: &Point, x: f64, y: f64| {
            let mut test = other.clone();
            for (axis, u) in axes.into_iter().zip([x, y]) {
                test.continuous[axis] = u.min(1.0_f64.next_down());
            }
            test
        };
        let grid = (0..nodes[1]).flat_map(|j| (0..nodes[0]).map(move |i| (i, j)));
        let groups: Vec<Vec<Point>> =
            grid.map(|(i, j)| others.iter().map(|other| place(other, at(0, i), at(1, j))).collect()).collect();
        let coordinates: Vec<_> = study.space().continuous().collect();
        let values = |axis: usize| {
            let parameter = coordinates[axes[axis]].parameter;
            (0..nodes[axis]).map(|i| parameter.value_at(at(axis, i))).collect()
        };
        let names = axes.map(|axis| coordinates[axis].name());
        let groups = weighed(study, trials, groups)?;
        let valid =
            groups.iter().map(|group| group.iter().map(|test| test.1).sum::<f64>() / group.len() as f64).collect();
        let estimate = Self { names, x: values(0), y: values(1), shares: model.shares(&groups, samples), valid };
        Ok(if estimate.invalid() < 1.0 { Some(estimate) } else { None })
    }

    /// What is known at a node; `None` where it is invalid.
    pub fn at(&self, i: usize, j: usize) -> Option<&FailingShare> {
        let place = j * self.x.len() + i;
        (self.valid[place] >= LEAST_VALID).then_some(&self.shares[place])
    }

    /// What is known at the nodes that are not invalid, with how much of the tests each stands for.
    fn places(&self) -> impl Iterator<Item = (&FailingShare, f64)> {
        let edge = |at: usize, all: usize| if at == 0 || at + 1 == all { 0.5 } else { 1.0 };
        let nodes = (0..self.y.len()).flat_map(|j| (0..self.x.len()).map(move |i| (i, j)));
        nodes.filter_map(move |(i, j)| {
            let valid = self.valid[j * self.x.len() + i];
            Some((self.at(i, j)?, valid * edge(i, self.x.len()) * edge(j, self.y.len())))
        })
    }

    /// The probability that a test which can be built fails, over the whole of both coordinates but for what is invalid: the
    /// integral of the grid's by the trapezoidal rule.
    pub fn mean(&self) -> f64 {
        let sum =
            |of: &dyn Fn(&FailingShare) -> f64| self.places().map(|(share, weight)| weight * of(share)).sum::<f64>();
        sum(&|share| share.mean) / sum(&|_| 1.0)
    }

    /// The share of the places, but for the invalid ones, of which it is sure whether more than half fails or less.
    pub fn decided(&self) -> f64 {
        self.places().filter(|(share, _)| decided(share).is_some()).count() as f64 / self.places().count() as f64
    }

    /// The share of the places that are invalid: most of their tests cannot be built.
    pub fn invalid(&self) -> f64 {
        1.0 - self.places().count() as f64 / self.shares.len() as f64
    }

    /// The estimate as CSV: the coordinates, the probability, its standard deviation, and `fail`, `pass` or
    /// nothing for where more or less than half fails for sure. Where it says `invalid`, there is no probability.
    pub fn csv(&self) -> Vec<u8> {
        let mut csv = csv::Writer::from_writer(Vec::new());
        let mut write = |row: [String; 5]| csv.write_record(row).expect("rows of one length fit into memory");
        let [x, y] = &self.names;
        write([x, y, "probability", "deviation", "decided"].map(str::to_owned));
        for (j, y) in self.y.iter().enumerate() {
            for (i, x) in self.x.iter().enumerate() {
                let share = self.at(i, j);
                let decided = match share.map(decided) {
                    None => "invalid",
                    Some(Some(true)) => "fail",
                    Some(Some(false)) => "pass",
                    Some(None) => "",
                };
                let number = |of: fn(&FailingShare) -> f64| share.map_or(String::new(), |share| of(share).to_string());
                let (mean, deviation) = (number(|share| share.mean), number(|share| share.deviation));
                write([x.to_string(), y.to_string(), mean, deviation, decided.to_owned()]);
            }
        }
        csv.into_inner().expect("memory does not fail to flush")
    }
}

/// Whether more than half fails for sure, or less; `None` where neither is sure.
pub fn decided(share: &FailingShare) -> Option<bool> {
    [(share.above_half >= SURE, true), (share.above_half <= 1.0 - SURE, false)]
        .into_iter()
        .find_map(|(is, what)| is.then_some(what))
}

/// The tests of the groups with the probability that each of them can be built.
fn weighed(study: &Study, trials: &[Trial], groups: Vec<Vec<Point>>) -> Result<Vec<Vec<(Point, f64)>>, Error> {
    let built: Vec<&Trial> = trials.iter().filter(|trial| trial.verdict != Verdict::Error).collect();
    let tests = built.iter().map(|trial| study.space().encode(&trial.test)).collect::<Result<Vec<_>, _>>()?;
    let sides: Vec<f64> =
        built.iter().map(|trial| if trial.verdict == Verdict::Invalid { -1.0 } else { 1.0 }).collect();
    let model = if sides.contains(&-1.0) { FailureModel::fit(study.space(), &tests, &sides) } else { None };
    let weigh = |group: Vec<Point>| {
        let invalid = model.as_ref().map_or_else(|| vec![0.0; group.len()], |model| model.probabilities(&group));
        group.into_iter().zip(invalid).map(|(test, invalid)| (test, 1.0 - invalid)).collect()
    };
    Ok(groups.into_iter().map(weigh).collect())
}

/// What the tests at a place differ by, and of how many samples they are: one where they vary nothing but the axes.
fn others(study: &Study) -> Result<(Vec<Point>, usize), Error> {
    if study.space().coordinates().count() == 2 {
        return Ok((sample(study, 1, 0)?, 1));
    }
    let samples = (0..SAMPLES as u64).map(|seed| sample(study, OTHERS, seed)).collect::<Result<Vec<_>, _>>()?;
    let size = samples.iter().map(Vec::len).min().unwrap_or(0);
    Ok((samples.into_iter().flat_map(|sample| sample.into_iter().take(size)).collect(), SAMPLES))
}

/// A random Latin hypercube.
fn sample(study: &Study, size: usize, seed: u64) -> Result<Vec<Point>, Error> {
    let discrete = DiscreteFamily::Random { delta: DiscreteFamily::DELTA };
    let request = Request { seed: Some(seed), discrete, ..Request::new(study.space(), size) };
    let mut hypercube = Strategy::LHS.build(&request)?;
    let mut sample = Vec::new();
    while sample.len() < size {
        let more = hypercube.ask(size - sample.len());
        if more.is_empty() {
            break;
        }
        sample.extend(more);
    }
    Ok(sample)
}
