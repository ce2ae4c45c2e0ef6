//! Estimates the probability of failure over two coordinates of a campaign's tests, with its uncertainty.
//!
//! The model of the verdicts (`generators::FailureModel`) is evaluated on a grid. If the tests vary more than two
//! coordinates, each place of the grid stands for eight random Latin hypercubes of sixteen tests in the other
//! coordinates, and the estimate is the share of these tests that fail. The differences between the eight samples are
//! the sampling error, which is part of the deviation.
//!
//! The worlds of some tests cannot be built. A second model estimates which tests these are, and the share of
//! failures refers to the tests that can be built. A place is *invalid* if more than half of its tests cannot be
//! built: the estimate says nothing about failures there.

use paracosm_campaign::{Error, Log, Reason, Study, Trial};
use paracosm_generators::{DiscreteFamily, FailingShare, FailureModel, Request, Strategy};
use paracosm_oracles::Verdict;
use paracosm_space::{Point, did_you_mean, nearest};
use thiserror::Error;

/// The numbers of nodes of a grid along both axes: `FINE` if a node is one test, `COARSE` if it is many tests.
const FINE: [usize; 2] = [61, 46];
const COARSE: [usize; 2] = [25, 19];

/// The number of samples at a place if tests vary other coordinates too, and the number of tests of a sample.
const SAMPLES: usize = 8;
const OTHERS: usize = 16;

/// The least share of the tests at a place that can be built: below this share the place is invalid.
const LEAST_VALID: f64 = 0.5;

/// The least probability with which the share of failures is above, or below, one half at a decided place.
const SURE: f64 = 0.95;

/// The estimated probability of failure on a grid over two coordinates.
#[derive(Debug, Clone, PartialEq)]
pub struct FailureEstimate {
    /// The names of the two coordinates of the grid.
    pub names: [String; 2],
    /// The values of the first coordinate on the grid, from the least to the greatest.
    pub x: Vec<f64>,
    /// The values of the second coordinate on the grid, from the least to the greatest.
    pub y: Vec<f64>,
    /// The estimated share of failing tests at each place of the grid. All values of `x` at the first value of `y` come
    /// first.
    pub shares: Vec<FailingShare>,
    /// The estimated share of tests whose worlds can be built, at each place of the grid. `shares` refers to these
    /// tests.
    pub valid: Vec<f64>,
}

/// The positions of two coordinates among the continuous coordinates of a study.
pub type Axes = [usize; 2];

/// A reason why a failure map cannot have these axes.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
pub enum AxesFlaw {
    /// The name of an axis belongs to a discrete parameter.
    #[error("`{name}` is a discrete parameter, expected a continuous one: axes can be {}", can.join(", "))]
    Discrete {
        /// The name of the discrete parameter.
        name: String,
        /// The names of the continuous coordinates that the axes can have.
        can: Vec<String>,
    },
    /// The name of an axis belongs to no continuous coordinate that the tests vary.
    #[error("the tests do not vary a parameter `{name}`{}; axes can be {}", did_you_mean(.nearest), can.join(", "))]
    Unknown {
        /// The name of the axis that was not found.
        name: String,
        /// The name of a similar coordinate that the user perhaps meant.
        nearest: Option<String>,
        /// The names of the continuous coordinates that the axes can have.
        can: Vec<String>,
    },
    /// Both axes have the same name.
    #[error("both axes are `{name}`, expected two different parameters of {}", can.join(", "))]
    Same {
        /// The name of both axes.
        name: String,
        /// The names of the continuous coordinates that the axes can have.
        can: Vec<String>,
    },
}

impl Reason for AxesFlaw {}

/// Returns the positions of the continuous coordinates with these names.
///
/// # Errors
/// A name is not that of a continuous coordinate, or both names are the same.
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
    /// Estimates the failure probability of a campaign over two of its continuous coordinates; `None` if no test
    /// failed, no test passed, no model can be fitted, or every place is invalid.
    ///
    /// # Errors
    /// A trial does not fit into the study's space, or its constraints cannot be satisfied.
    pub fn of(log: &Log, axes: Axes) -> Result<Option<Self>, Error> {
        Ok(Estimator::of(log)?.over(axes))
    }

    /// Returns the estimated share of failing tests at a node of the grid; `None` if the node is invalid.
    pub fn at(&self, i: usize, j: usize) -> Option<&FailingShare> {
        let place = j * self.x.len() + i;
        (self.valid[place] >= LEAST_VALID).then_some(&self.shares[place])
    }

    /// Returns the estimates at the valid nodes, each with the weight of the tests that the node stands for.
    fn places(&self) -> impl Iterator<Item = (&FailingShare, f64)> {
        let edge = |at: usize, all: usize| if at == 0 || at + 1 == all { 0.5 } else { 1.0 };
        let nodes = (0..self.y.len()).flat_map(|j| (0..self.x.len()).map(move |i| (i, j)));
        nodes.filter_map(move |(i, j)| {
            let valid = self.valid[j * self.x.len() + i];
            Some((self.at(i, j)?, valid * edge(i, self.x.len()) * edge(j, self.y.len())))
        })
    }

    /// Returns the mean probability of failure over the valid places of the grid, for tests that can be built. It is
    /// the integral over the grid by the trapezoidal rule.
    pub fn mean(&self) -> f64 {
        let sum =
            |of: &dyn Fn(&FailingShare) -> f64| self.places().map(|(share, weight)| weight * of(share)).sum::<f64>();
        sum(&|share| share.mean) / sum(&|_| 1.0)
    }

    /// Returns the share of the valid places whose share of failures is above or below one half with 95 % certainty.
    pub fn decided(&self) -> f64 {
        self.places().filter(|(share, _)| decided(share).is_some()).count() as f64 / self.places().count() as f64
    }

    /// Returns the share of the places that are invalid, because more than half of their tests cannot be built.
    pub fn invalid(&self) -> f64 {
        1.0 - self.places().count() as f64 / self.shares.len() as f64
    }

    /// Returns the estimated probability of failure on the grid as CSV. The columns are the coordinates, the
    /// probability, its standard deviation, and `fail` or `pass` if surely more or less than half of the tests fail
    /// (empty if undecided). A place marked `invalid` has no probability.
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

/// The models of a campaign from which the failure probability over any two coordinates is estimated.
pub struct Estimator<'a> {
    study: &'a Study,
    /// The model of the failures; `None` if no test failed, no test passed, or no model can be fitted.
    failures: Option<FailureModel>,
    /// The model of the tests whose worlds cannot be built; `None` if all can be.
    invalid: Option<FailureModel>,
    /// Tests with values of the other coordinates.
    others: Vec<Point>,
    /// The number of samples among `others`.
    samples: usize,
}

impl<'a> Estimator<'a> {
    /// Fits the models to the trials of a campaign.
    ///
    /// # Errors
    /// A trial does not fit into the study's space, or its constraints cannot be satisfied.
    pub fn of(log: &'a Log) -> Result<Self, Error> {
        let (study, trials) = (log.study(), log.trials());
        let failures = failure_model(log)?;
        let (others, samples) = if failures.is_some() { others(study)? } else { (Vec::new(), 1) };
        let invalid = if failures.is_some() { invalid_model(study, trials)? } else { None };
        Ok(Self { study, failures, invalid, others, samples })
    }

    /// Estimates the failure probability over two continuous coordinates; `None` if there is no model of the failures, or if every place is
    /// invalid.
    pub fn over(&self, axes: Axes) -> Option<FailureEstimate> {
        let model = self.failures.as_ref()?;
        if self.others.is_empty() {
            return None;
        }
        let nodes = if self.samples == 1 { FINE } else { COARSE };
        let at = |axis: usize, node: usize| node as f64 / (nodes[axis] - 1) as f64;
        let place = |other: &Point, x: f64, y: f64| {
            let mut test = other.clone();
            for (axis, u) in axes.into_iter().zip([x, y]) {
                test.continuous[axis] = u.min(1.0_f64.next_down());
            }
            test
        };
        let grid = (0..nodes[1]).flat_map(|j| (0..nodes[0]).map(move |i| (i, j)));
        let groups: Vec<Vec<(Point, f64)>> = grid
            .map(|(i, j)| self.weighed(self.others.iter().map(|other| place(other, at(0, i), at(1, j))).collect()))
            .collect();
        let coordinates: Vec<_> = self.study.space().continuous().collect();
        let values = |axis: usize| {
            let parameter = coordinates[axes[axis]].parameter;
            (0..nodes[axis]).map(|i| parameter.value_at(at(axis, i))).collect()
        };
        let names = axes.map(|axis| coordinates[axis].name());
        let valid =
            groups.iter().map(|group| group.iter().map(|test| test.1).sum::<f64>() / group.len() as f64).collect();
        let shares = model.shares(&groups, self.samples);
        let estimate = FailureEstimate { names, x: values(0), y: values(1), shares, valid };
        (estimate.invalid() < 1.0).then_some(estimate)
    }

    /// Returns the tests of a group, each with the probability that its world can be built.
    fn weighed(&self, group: Vec<Point>) -> Vec<(Point, f64)> {
        let invalid = self.invalid.as_ref().map_or_else(|| vec![0.0; group.len()], |model| model.probabilities(&group));
        group.into_iter().zip(invalid).map(|(test, invalid)| (test, 1.0 - invalid)).collect()
    }
}

/// Returns whether more than half of the tests fail; `None` if this is not known with 95 % certainty.
pub fn decided(share: &FailingShare) -> Option<bool> {
    [(share.above_half >= SURE, true), (share.above_half <= 1.0 - SURE, false)]
        .into_iter()
        .find_map(|(is, what)| is.then_some(what))
}

/// Returns a model of the failures of a campaign; `None` if no test failed, no test passed, or no model can be fitted.
///
/// # Errors
/// A trial does not fit into the study's space.
pub(crate) fn failure_model(log: &Log) -> Result<Option<FailureModel>, Error> {
    let is_judged = |t: &&Trial| matches!(t.verdict, Verdict::Fail | Verdict::Unpreventable | Verdict::Pass);
    let judged: Vec<&Trial> = log.trials().iter().filter(is_judged).collect();
    let failures = judged.iter().filter(|trial| trial.is_failure()).count();
    if failures == 0 || failures == judged.len() {
        return Ok(None);
    }
    // The verdict determines the sign, even if rounding gave the robustness another sign.
    let robustness = judged.iter().map(|trial| {
        let size = log.scales().objective(trial).map_or(1.0, f64::abs);
        if trial.is_failure() { -size } else { size }
    });
    let robustness: Vec<f64> = robustness.collect();
    Ok(FailureModel::fit(log.study().space(), &points(log.study(), &judged)?, &robustness))
}

/// Returns the tests of trials as points of the study's space.
fn points(study: &Study, trials: &[&Trial]) -> Result<Vec<Point>, Error> {
    Ok(trials.iter().map(|trial| study.space().encode(&trial.test)).collect::<Result<Vec<_>, _>>()?)
}

/// Returns a model of the tests whose worlds cannot be built; `None` if the worlds of all tests can be built, or if no model can be fitted.
fn invalid_model(study: &Study, trials: &[Trial]) -> Result<Option<FailureModel>, Error> {
    if !trials.iter().any(|trial| trial.verdict == Verdict::Invalid) {
        return Ok(None);
    }
    let built: Vec<&Trial> = trials.iter().filter(|trial| trial.verdict != Verdict::Error).collect();
    let side = |trial: &&Trial| if trial.verdict == Verdict::Invalid { -1.0 } else { 1.0 };
    let sides: Vec<f64> = built.iter().map(side).collect();
    Ok(FailureModel::fit(study.space(), &points(study, &built)?, &sides))
}

/// Returns tests with values of the other coordinates, and the number of their samples (1 without other coordinates).
fn others(study: &Study) -> Result<(Vec<Point>, usize), Error> {
    if study.space().coordinates().count() == 2 {
        return Ok((sample(study, 1, 0)?, 1));
    }
    let samples = (0..SAMPLES as u64).map(|seed| sample(study, OTHERS, seed)).collect::<Result<Vec<_>, _>>()?;
    let size = samples.iter().map(Vec::len).min().unwrap_or(0);
    Ok((samples.into_iter().flat_map(|sample| sample.into_iter().take(size)).collect(), SAMPLES))
}

/// Makes a random Latin hypercube.
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
