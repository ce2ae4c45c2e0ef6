//! How probable a failure is over two coordinates of a campaign's tests, what is sure of it, and where.
//!
//! The model of the verdicts (`generators::FailureModel`) is asked on a grid. Where the tests vary more than two
//! coordinates, each place of the grid stands for sixteen tests that have the others as Halton's sequence has them, and
//! what is estimated is the share of these that fail.

use crate::{Error, Study, Trial};
use paracosm_coverage::{Point, did_you_mean, nearest};
use paracosm_generators::{FailingShare, FailureModel, Request, Strategy};
use paracosm_oracles::Verdict;

/// The nodes of a grid along both axes, alone and where each stands for many tests.
const FINE: [usize; 2] = [61, 46];
const COARSE: [usize; 2] = [41, 31];

/// For how many tests a place stands where others are varied too.
const OTHERS: usize = 16;

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
}

/// The positions of two coordinates among the continuous ones of a study.
pub(crate) type Axes = [usize; 2];

/// The positions of the coordinates with these names.
///
/// # Errors
/// A name is none of a continuous coordinate, or both are one.
pub(crate) fn axes(study: &Study, names: [&str; 2]) -> Result<Axes, Error> {
    let all: Vec<String> = study.space.continuous().map(|coordinate| coordinate.name()).collect();
    let position = |name: &str| {
        all.iter().position(|other| other == name).ok_or_else(|| {
            let can = format!("axes can be {}", all.join(", "));
            let discrete = study.space.discrete().any(|coordinate| coordinate.name() == name);
            if discrete {
                return Error::Usage(format!("`{name}` takes single values, expected an interval: {can}"));
            }
            let signal = format!("{name}[0]");
            let meant = all.contains(&signal).then_some(signal);
            let meant = meant.or_else(|| nearest(name, all.iter().map(String::as_str)).map(str::to_owned));
            Error::Usage(format!("the tests vary no `{name}`{}; {can}", did_you_mean(&meant)))
        })
    };
    let found = [position(names[0])?, position(names[1])?];
    if found[0] == found[1] {
        return Err(Error::Usage(format!("both axes are `{}`, expected two of {}", names[0], all.join(", "))));
    }
    Ok(found)
}

impl FailureEstimate {
    /// The estimate of a campaign over two of its continuous coordinates; `None` where no test failed or none passed.
    ///
    /// # Errors
    /// A trial is none of the study's space, or its constraints cannot be kept.
    pub(crate) fn of(study: &Study, trials: &[Trial], axes: Axes) -> Result<Option<Self>, Error> {
        let judged: Vec<&Trial> =
            trials.iter().filter(|t| matches!(t.verdict, Verdict::Fail | Verdict::Pass)).collect();
        let failures = judged.iter().filter(|trial| trial.is_failure()).count();
        if failures == 0 || failures == judged.len() {
            return Ok(None);
        }
        let tests = judged.iter().map(|trial| study.space.encode(&trial.test)).collect::<Result<Vec<_>, _>>()?;
        // The sign is the verdict's, whatever a rounded robustness says.
        let robustness = judged.iter().map(|trial| {
            let size = study.objective(trial).map_or(1.0, f64::abs);
            if trial.is_failure() { -size } else { size }
        });
        let Some(model) = FailureModel::fit(&study.space, &tests, &robustness.collect::<Vec<_>>()) else {
            return Ok(None);
        };
        let others = others(study)?;
        let nodes = if others.len() == 1 { FINE } else { COARSE };
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
        let coordinates: Vec<_> = study.space.continuous().collect();
        let values = |axis: usize| {
            let parameter = coordinates[axes[axis]].parameter;
            (0..nodes[axis]).map(|i| parameter.value_at(at(axis, i))).collect()
        };
        let names = axes.map(|axis| coordinates[axis].name());
        Ok(Some(Self { names, x: values(0), y: values(1), shares: model.shares(&groups) }))
    }

    /// What is known at a node.
    pub(crate) fn at(&self, i: usize, j: usize) -> &FailingShare {
        &self.shares[j * self.x.len() + i]
    }

    /// The probability over the whole of both coordinates: the mean of the grid's.
    pub fn mean(&self) -> f64 {
        self.shares.iter().map(|share| share.mean).sum::<f64>() / self.shares.len() as f64
    }

    /// The share of the places of which it is sure whether more than half fails or less.
    pub fn decided(&self) -> f64 {
        self.shares.iter().filter(|share| decided(share).is_some()).count() as f64 / self.shares.len() as f64
    }

    /// The estimate as CSV: the coordinates, the probability, its standard deviation, and `fail`, `pass` or
    /// nothing for where more or less than half fails for sure.
    pub fn csv(&self) -> Vec<u8> {
        let mut csv = csv::Writer::from_writer(Vec::new());
        let mut write = |row: [String; 5]| csv.write_record(row).expect("rows of one length fit into memory");
        let [x, y] = &self.names;
        write([x, y, "probability", "deviation", "decided"].map(str::to_owned));
        for (j, y) in self.y.iter().enumerate() {
            for (i, x) in self.x.iter().enumerate() {
                let share = self.at(i, j);
                let decided = match decided(share) {
                    Some(true) => "fail",
                    Some(false) => "pass",
                    None => "",
                };
                let (mean, deviation) = (share.mean.to_string(), share.deviation.to_string());
                write([x.to_string(), y.to_string(), mean, deviation, decided.to_owned()]);
            }
        }
        csv.into_inner().expect("memory does not fail to flush")
    }
}

/// Whether more than half fails for sure, or less; `None` where neither is sure.
pub(crate) fn decided(share: &FailingShare) -> Option<bool> {
    [(share.above_half >= SURE, true), (share.above_half <= 1.0 - SURE, false)]
        .into_iter()
        .find_map(|(is, what)| is.then_some(what))
}

/// What the tests at a place differ by: one where they vary nothing but the axes.
fn others(study: &Study) -> Result<Vec<Point>, Error> {
    let wanted = if study.space.coordinates().count() == 2 { 1 } else { OTHERS };
    let mut halton = Strategy::Halton.build(&Request::new(&study.space, wanted))?;
    let mut others = Vec::new();
    while others.len() < wanted {
        let more = halton.ask(wanted - others.len());
        if more.is_empty() {
            break;
        }
        others.extend(more);
    }
    Ok(others)
}
