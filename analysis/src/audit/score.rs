//! The mutation score of a suite: in all, and by the kind and the size of defects.

use super::bout::Tried;
use crate::statistics::wilson;
use paracosm_mutants::Mutant;
use serde::Serialize;

const CONFIDENCE: f64 = 0.95;

/// The mutation score of a suite.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Score {
    /// The number of mutants that were made for the screen.
    pub made: usize,
    /// The number of them that no test of the screen notices. They are equivalent to the driver as far as known, and do not count.
    pub equivalent_so_far: usize,
    /// The score for all mutants.
    #[serde(flatten)]
    pub all: Share,
    /// The scores of mutants that are always on, that one condition turns on, that two conditions turn on, and so on.
    pub by_conditions: Vec<Share>,
    /// The scores by kind of defect, in the order of the list of kinds.
    pub by_kind: Vec<KindScore>,
}

/// A number of mutants, and how many of them a suite kills.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Share {
    /// The number of mutants that count: a test of the screen notices each of them.
    pub counted: usize,
    /// The number of mutants that the suite kills.
    pub killed: usize,
    /// The share of mutants that the suite kills; `None` without mutants. The interval takes the mutants as a sample of many (Wilson).
    pub mutation_score: Option<Estimate>,
}

/// A share with its interval with 95 % confidence.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Estimate {
    /// The share.
    pub value: f64,
    /// The lower end of the interval.
    pub lower: f64,
    /// The upper end of the interval.
    pub upper: f64,
}

impl Estimate {
    pub(super) fn of(value: f64, [lower, upper]: [f64; 2]) -> Self {
        Self { value, lower, upper }
    }
}

/// The score of a suite for a kind of defect.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct KindScore {
    /// The name of the kind.
    pub kind: &'static str,
    /// The unit of its size.
    pub unit: &'static str,
    /// The score for the kind.
    #[serde(flatten)]
    pub all: Share,
    /// The size in the list of sizes, from slight to gross, from which on the suite kills all mutants of the kind that are always
    /// on; `None` if it does not kill the grossest of them, or there is none.
    pub noticed_from: Option<f64>,
    /// The scores of the sizes, from slight to gross.
    pub sizes: Vec<SizeScore>,
}

/// The score of a suite for a size of a defect.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct SizeScore {
    /// The size.
    pub size: f64,
    /// The score for the size.
    #[serde(flatten)]
    pub all: Share,
}

impl Share {
    pub(super) fn new(killed: usize, counted: usize) -> Self {
        let score = || Estimate::of(killed as f64 / counted as f64, wilson(killed, counted, CONFIDENCE));
        Self { counted, killed, mutation_score: (counted > 0).then(score) }
    }

    fn of<'t>(tried: impl Iterator<Item = &'t Tried>, suite: usize) -> Self {
        let (killed, counted) = tried
            .fold((0, 0), |(killed, counted), one| (killed + usize::from(one.kills[suite].is_some()), counted + 1));
        Self::new(killed, counted)
    }
}

impl Score {
    /// Counts the kills of a suite, which is named by its position. `equivalent_so_far` mutants besides do not count.
    pub(super) fn of(equivalent_so_far: usize, tried: &[Tried], suite: usize) -> Self {
        let conditions = |one: &Tried| one.mutant.when.len();
        let most = tried.iter().map(conditions).max().map_or(0, |most| most + 1);
        let with = |count| tried.iter().filter(move |one| conditions(one) == count);
        let kinds = paracosm_mutants::ALL.iter().filter_map(|kind| KindScore::of(kind, tried, suite));
        Self {
            made: tried.len() + equivalent_so_far,
            equivalent_so_far,
            all: Share::of(tried.iter(), suite),
            by_conditions: (0..most).map(|count| Share::of(with(count), suite)).collect(),
            by_kind: kinds.collect(),
        }
    }
}

impl KindScore {
    fn of(kind: &'static paracosm_mutants::Kind, tried: &[Tried], suite: usize) -> Option<Self> {
        let is_of = |mutant: &Mutant| mutant.defect.kind().name == kind.name;
        let of_kind: Vec<&Tried> = tried.iter().filter(|one| is_of(&one.mutant)).collect();
        if of_kind.is_empty() {
            return None;
        }
        let of_size = |size: f64| of_kind.iter().copied().filter(move |one| one.mutant.defect.size() == size);
        let sizes = kind.sizes.iter().map(|&size| SizeScore { size, all: Share::of(of_size(size), suite) });
        let always = |size| of_size(size).filter(|one| one.mutant.when.is_empty());
        let mut noticed_from = None;
        for &size in kind.sizes.iter().rev() {
            if always(size).any(|one| one.kills[suite].is_none()) {
                break;
            }
            if always(size).next().is_some() {
                noticed_from = Some(size);
            }
        }
        Some(Self {
            kind: kind.name,
            unit: kind.unit,
            all: Share::of(of_kind.iter().copied(), suite),
            noticed_from,
            sizes: sizes.filter(|size| size.all.counted > 0).collect(),
        })
    }
}
