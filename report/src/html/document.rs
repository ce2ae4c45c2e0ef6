//! The document of a page: everything but the table of tests and the runs. `docs/report-data.md` describes it.

use super::Page;
use super::columns::Tests;
use super::pack::base64;
use super::runs::Described;
use crate::junit::{command_option, shell_word};
use paracosm_analysis::estimate::Measured;
use paracosm_analysis::failure_estimate::{Estimator, FailureEstimate, decided};
use paracosm_analysis::{Growth, Judged, Summary};
#[cfg(feature = "viewer")]
use paracosm_campaign::Log;
use paracosm_campaign::{Error, Number, Study};
use paracosm_coverage::Measure;
use paracosm_generators::FailingShare;
use paracosm_oracles::Verdict;
use paracosm_space::{Coordinate, Domain, Record};
use rayon::prelude::*;
use serde::Serialize;
use serde_json::{Map, Value};

/// The name of the format, with its version.
const FORMAT: &str = "paracosm-report-1";

/// The greatest number of maps with a probability in a file. A map over two of many parameters takes some 3 s of a core.
pub(super) const MAPS: usize = 10;

/// The document of a page.
#[derive(Debug, Serialize)]
pub(super) struct Document {
    format: &'static str,
    software: &'static str,
    /// True if a viewer serves the page, and answers its questions.
    pub served: bool,
    study: About,
    verdicts: Vec<Count>,
    requirements: Vec<Stated>,
    coordinates: Vec<Axis>,
    /// The positions of the two coordinates that the map shows first.
    axes: Option<[usize; 2]>,
    maps: Vec<Grid>,
    hole: Option<Record<[f64; 2]>>,
    without_effect: Vec<NoEffect>,
    worst: Option<WorstTest>,
    worst_plausible: Option<WorstTest>,
    plausible: Option<Record<[f64; 2]>>,
    modes: Value,
    growth: Vec<Growth>,
    findings: Vec<Finding>,
    results: Map<String, Value>,
    changes: Option<Value>,
    pub tests: Tests,
    pub runs: Described,
}

/// The study of the campaign.
#[derive(Debug, Serialize)]
struct About {
    title: String,
    scenario: Option<String>,
    strategy: String,
    seed: Option<u64>,
    budget: usize,
    /// True if the campaign still runs, or was interrupted.
    unfinished: bool,
    hash: String,
    folder: String,
    /// The program that has the commands on the page.
    program: String,
    /// The end of commands about tests, which lets them run the program of the campaign.
    trusting: String,
    fixed: Value,
}

#[derive(Debug, Serialize)]
struct Count {
    name: String,
    tests: usize,
}

#[derive(Debug, Serialize)]
struct Stated {
    id: String,
    text: String,
    formula: Option<String>,
    unit: String,
    severity: Option<String>,
    source: Option<String>,
    violated: usize,
    undecided: usize,
    worst: Option<(usize, Number)>,
}

/// A coordinate of the tests.
#[derive(Debug, Serialize)]
struct Axis {
    name: String,
    label: String,
    unit: Option<String>,
    /// The least and the greatest value; `None` if the coordinate is discrete.
    range: Option<[f64; 2]>,
    /// The values in words; `None` if the coordinate is continuous.
    levels: Option<Vec<String>>,
}

/// The estimated probability of failure over two coordinates.
#[derive(Debug, Serialize)]
pub(crate) struct Grid {
    /// The positions of both coordinates.
    axes: [usize; 2],
    /// The number of places along both axes.
    size: [usize; 2],
    /// For each place the probability in percent, or 255 if it is not known: all places along x at the least y come first.
    percent: String,
    /// For each place 1 if more than half of the tests fail with 95 % certainty, 2 if fewer do, 0 if this is not known.
    decided: String,
}

#[derive(Debug, Serialize)]
struct NoEffect {
    name: String,
    why: String,
}

#[derive(Debug, Serialize)]
struct WorstTest {
    index: usize,
    requirement: String,
    robustness: Number,
    verdict: String,
}

/// A result in words.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct Finding {
    /// The kind of the result, such as `explanation`.
    pub label: &'static str,
    /// The sentences.
    pub lines: Vec<String>,
    /// The numbers behind the sentences; `None` if there is no table.
    pub table: Option<FindingTable>,
}

/// A table of a result. Each row has as many cells as there are columns.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct FindingTable {
    /// The titles of the columns.
    pub head: Vec<String>,
    /// The cells of each row.
    pub rows: Vec<Vec<String>>,
}

impl Document {
    /// Makes the document with at most this number of maps.
    pub fn of(page: &Page, most_maps: usize) -> Result<Self, Error> {
        let (log, study) = (page.log, page.log.study());
        let worst = |summary: &Summary| {
            let found = summary.worst(log.scales())?;
            let trial = &log.trials()[found.index];
            Some(WorstTest {
                index: found.index,
                robustness: Number(trial.robustness(&found.requirement)),
                requirement: found.requirement,
                verdict: trial.verdict.to_string(),
            })
        };
        let coordinates: Vec<Coordinate> = study.space().coordinates().collect();
        let position = |name: &String| coordinates.iter().position(|coordinate| coordinate.name() == *name);
        let axes = page.axes.as_ref().and_then(|[x, y]| Some([position(x)?, position(y)?]));
        let summary = page.summary;
        Ok(Self {
            format: FORMAT,
            software: env!("CARGO_PKG_VERSION"),
            served: false,
            study: About::of(page, study),
            verdicts: Verdict::ALL
                .iter()
                .map(|verdict| Count { name: verdict.to_string(), tests: summary.count(*verdict) })
                .collect(),
            requirements: summary.requirements().iter().map(|judged| stated(study, judged)).collect(),
            coordinates: coordinates.iter().map(described).collect(),
            axes,
            maps: maps(page, axes, most_maps)?,
            hole: hole(page),
            without_effect: page
                .effects
                .iter()
                .flat_map(|effects| effects.without_effect())
                .map(|(name, why)| NoEffect { name: name.to_owned(), why: why.to_string() })
                .collect(),
            worst: worst(summary),
            worst_plausible: page.plausible.and_then(|plausible| worst(&plausible.summary)),
            plausible: page.plausible.map(|plausible| plausible.ranges.clone()),
            modes: serde_json::to_value(page.modes).expect("modes are always JSON"),
            growth: page.growth.clone(),
            findings: page.findings.clone(),
            results: page.results.clone(),
            changes: page.changes.clone(),
            tests: Tests::default(),
            runs: Described::default(),
        })
    }

    pub fn json(&self) -> Vec<u8> {
        serde_json::to_vec(self).expect("a document is always JSON")
    }
}

impl About {
    fn of(page: &Page, study: &Study) -> Self {
        let simulation = study.subject().scenario().ok();
        Self {
            title: study.title(),
            scenario: simulation.map(|simulation| simulation.scenario().to_owned()),
            strategy: study.sampling().strategy_name().to_owned(),
            seed: study.sampling().seed,
            budget: study.sampling().budget,
            unfinished: page.unfinished,
            hash: page.log.hash().unwrap_or_default().to_owned(),
            folder: shell_word(&page.folder),
            program: shell_word(&page.program),
            trusting: command_option(study),
            fixed: serde_json::to_value(study.fixed()).expect("values are always JSON"),
        }
    }
}

fn stated(study: &Study, judged: &Judged) -> Stated {
    let stated = study.requirement(&judged.id);
    let text = |of: fn(&paracosm_campaign::StatedRequirement) -> Option<String>| stated.and_then(of);
    Stated {
        id: judged.id.clone(),
        text: text(|stated| Some(stated.text.clone())).unwrap_or_default(),
        formula: text(|stated| stated.formula.as_ref().map(ToString::to_string)),
        unit: text(|stated| Some(stated.unit.clone())).unwrap_or_default(),
        severity: text(|stated| stated.severity.clone()),
        source: text(|stated| stated.source.clone()),
        violated: judged.violated,
        undecided: judged.undecided,
        worst: judged.worst.map(|(robustness, index)| (index, Number(Some(robustness)))),
    }
}

fn described(coordinate: &Coordinate) -> Axis {
    let (range, levels) = match &coordinate.parameter.domain {
        Domain::Interval { lo, hi } => (Some([*lo, *hi]), None),
        Domain::Choice(levels) => (None, Some(levels.iter().map(ToString::to_string).collect())),
    };
    Axis { name: coordinate.name(), label: coordinate.label(), unit: coordinate.parameter.unit.clone(), range, levels }
}

/// Returns the sides of the largest empty box in the whole box of the continuous parameters.
fn hole(page: &Page) -> Option<Record<[f64; 2]>> {
    let continuous = page.coverage.continuous.as_ref()?;
    let of_dispersion = continuous.measured.iter().find(|(measure, _)| *measure == Measure::DISPERSION)?;
    match &of_dispersion.1 {
        Measured::Hole(hole) if hole.volume.upper > 0.0 => Some(hole.largest_empty_box.clone()),
        _ => None,
    }
}

/// Returns the estimates over pairs of coordinates; the pair that is shown first comes first, then pairs with one of its coordinates. The order does not depend on the threads.
fn maps(page: &Page, first: Option<[usize; 2]>, most: usize) -> Result<Vec<Grid>, Error> {
    let Some(first) = first else { return Ok(Vec::new()) };
    let coordinates: Vec<Coordinate> = page.log.study().space().coordinates().collect();
    let continuous: Vec<usize> =
        (0..coordinates.len()).filter(|at| coordinates[*at].parameter.levels().is_none()).collect();
    let all = (0..continuous.len()).flat_map(|x| (x + 1..continuous.len()).map(move |y| [x, y]));
    let mut pairs: Vec<[usize; 2]> = all.collect();
    // A stable sort: first the pair itself, then pairs with one of its coordinates.
    pairs.sort_by_key(|pair| 2 - pair.iter().filter(|at| first.contains(&continuous[**at])).count());
    pairs.truncate(most);
    let estimator = Estimator::of(page.log)?;
    let grid = |pair: [usize; 2]| Some(Grid::of(&estimator.over(pair)?, pair.map(|at| continuous[at])));
    Ok(pairs.into_par_iter().filter_map(grid).collect())
}

/// The error that a map cannot have these axes.
#[cfg(feature = "viewer")]
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[error("a map needs two different continuous coordinates, found the coordinates {} and {}", .0[0], .0[1])]
struct NoPair([usize; 2]);

#[cfg(feature = "viewer")]
impl paracosm_campaign::Reason for NoPair {}

impl Grid {
    /// Returns the estimate over two coordinates of a campaign, by their positions; `None` if there is no model of the failures.
    ///
    /// # Errors
    /// A coordinate does not exist or is discrete, or both are the same; or no model can be fitted.
    #[cfg(feature = "viewer")]
    pub fn over(log: &Log, axes: [usize; 2]) -> Result<Option<Self>, Error> {
        let continuous: Vec<usize> = (0..)
            .zip(log.study().space().coordinates())
            .filter_map(|(at, coordinate)| coordinate.parameter.levels().is_none().then_some(at))
            .collect();
        let place = |axis: usize| continuous.iter().position(|at| *at == axis).ok_or(NoPair(axes));
        let pair = [place(axes[0])?, place(axes[1])?];
        if pair[0] == pair[1] {
            return Err(NoPair(axes).into());
        }
        Ok(Estimator::of(log)?.over(pair).map(|estimate| Self::of(&estimate, axes)))
    }

    fn of(estimate: &FailureEstimate, axes: [usize; 2]) -> Self {
        let size = [estimate.x.len(), estimate.y.len()];
        let places = || (0..size[1]).flat_map(|j| (0..size[0]).map(move |i| estimate.at(i, j)));
        let whole = |share: &FailingShare| (100.0 * share.mean).round().clamp(0.0, 100.0) as u8;
        let percent: Vec<u8> = places().map(|share| share.map_or(255, whole)).collect();
        let decided: Vec<u8> = places()
            .map(|share| match share.and_then(decided) {
                None => 0,
                Some(true) => 1,
                Some(false) => 2,
            })
            .collect();
        Self { axes, size, percent: base64(&percent), decided: base64(&decided) }
    }
}
