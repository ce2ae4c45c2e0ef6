//! The valid part of a space, and of any choice of its parameters.
//!
//! A place in a projection is valid if some valid test lies there, whatever values the other parameters have. So a cell of
//! a projection is certainly invalid if no row of discrete values and no values of the other continuous parameters make a
//! test valid. It is certainly valid if one row and one choice of the others make all its tests valid.

use super::bisect::Limits;
use super::{Cases, Content, ValidPart};
use crate::Projection;
use paracosm_space::Space;
use paracosm_space::rules::Rules;
use std::collections::BTreeMap;
use std::sync::{Arc, Mutex, PoisonError};

/// The greatest number of rows of discrete values that are looked at. If there are more, no cell counts as invalid.
const MOST_ROWS: usize = 64;
/// The greatest number of continuous parameters outside of a projection whose corners are all tried.
const MOST_BESIDE: usize = 4;

/// The greatest number of parts that get the full effort.
const FEW_PARTS: u64 = 16;

/// The effort that goes into a valid part.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Effort {
    /// The effort for a single part: thousands of cells.
    Full,
    /// The effort for one of many parts: hundreds of cells.
    Quick,
}

impl Effort {
    /// Returns the effort for each of so many parts.
    pub fn for_parts(parts: u64) -> Self {
        if parts <= FEW_PARTS { Self::Full } else { Self::Quick }
    }
}

/// The constraints of a space that depend on continuous parameters. It keeps the parts that it made, because rows and
/// projections share them.
#[derive(Debug)]
pub struct Validity<'a> {
    space: &'a Space,
    rules: &'a Rules,
    /// The continuous parameters on which the constraints depend, as positions among the continuous parameters.
    axes: Vec<usize>,
    /// The discrete parameters on which the same constraints depend, as positions among the discrete parameters.
    discrete: Vec<usize>,
    known: Mutex<BTreeMap<Key, Arc<ValidPart>>>,
}

/// The facts on which a valid part depends: its axes, the levels of the constrained discrete parameters in each of its rows,
/// and the effort.
type Key = (Vec<usize>, Vec<Vec<usize>>, Effort);

impl<'a> Validity<'a> {
    /// Makes the validity of a space with these rules; `None` if no constraint depends on continuous parameters.
    pub fn of(space: &'a Space, rules: &'a Rules) -> Option<Self> {
        let constraints = || space.constraints().iter().filter(|constraint| constraint.checks_each_test());
        constraints().next()?;
        let names: Vec<&str> = constraints().flat_map(|constraint| constraint.expression().names()).collect();
        let axes = space.continuous().enumerate().filter(|(_, axis)| names.contains(&axis.parameter.name.as_str()));
        let levels = space.discrete().enumerate().filter(|(_, level)| names.contains(&level.parameter.name.as_str()));
        let (axes, discrete) = (axes.map(|(at, _)| at).collect(), levels.map(|(at, _)| at).collect());
        Some(Self { space, rules, axes, discrete, known: Mutex::default() })
    }

    /// Returns the valid part of all continuous parameters together.
    pub fn whole(&self) -> Arc<ValidPart> {
        self.part(&Projection { fixed: Vec::new(), axes: (0..self.space.dims()).collect() }, Effort::Full)
    }

    /// Returns the valid part of the continuous parameters for a row of discrete values.
    pub fn of_row(&self, row: &[usize], effort: Effort) -> Arc<ValidPart> {
        let fixed = row.iter().copied().enumerate().collect();
        self.part(&Projection { fixed, axes: (0..self.space.dims()).collect() }, effort)
    }

    /// Returns the valid part of a projection.
    pub fn part(&self, projection: &Projection, effort: Effort) -> Arc<ValidPart> {
        let (rows, all) = self.rows(&projection.fixed);
        let key: Key = (projection.axes.clone(), rows.iter().map(|row| self.levels(row)).collect(), effort);
        let known = || self.known.lock().unwrap_or_else(PoisonError::into_inner);
        let found = known().get(&key).cloned();
        found.unwrap_or_else(|| {
            let part = Arc::new(self.bisected(projection, effort, &rows, all));
            known().insert(key, part.clone());
            part
        })
    }

    fn bisected(&self, projection: &Projection, effort: Effort, rows: &[Vec<usize>], all: bool) -> ValidPart {
        let beside: Vec<usize> = self.axes.iter().copied().filter(|axis| !projection.axes.contains(axis)).collect();
        let places = probes(beside.len());
        let answer = |lower: &[f64], upper: &[f64]| {
            let (mut low, mut high) = (vec![0.0; self.space.dims()], vec![1.0; self.space.dims()]);
            for (at, &axis) in projection.axes.iter().enumerate() {
                (low[axis], high[axis]) = (lower[at], upper[at]);
            }
            let asked = rows.iter().map(|row| self.space.allows_part(row, &low, &high)).collect::<Vec<_>>();
            if let Some(row) = asked.iter().position(|answer| *answer == Some(true)) {
                // The row is valid at every place.
                return Content::Valid { row, place: 0 };
            }
            if asked.iter().all(|answer| *answer == Some(false)) {
                return if all { Content::Invalid } else { Content::Undecided };
            }
            if beside.is_empty() {
                return Content::Undecided;
            }
            for (place, coordinates) in places.iter().enumerate() {
                for (&axis, &x) in beside.iter().zip(coordinates) {
                    (low[axis], high[axis]) = (x, x);
                }
                let mut open = (0..rows.len()).filter(|&row| asked[row].is_none());
                if let Some(row) = open.find(|&row| self.space.allows_part(&rows[row], &low, &high) == Some(true)) {
                    return Content::Valid { row, place };
                }
            }
            Content::Undecided
        };
        let axes = (0..projection.axes.len()).filter(|&at| self.axes.contains(&projection.axes[at])).collect();
        let limits = match effort {
            Effort::Full => Limits { cuts: 8192, questions: 1 << 17 },
            Effort::Quick => Limits { cuts: 512, questions: 1 << 12 },
        };
        let cases = Cases {
            continuous: projection.axes.clone(),
            discrete: self.discrete.clone(),
            rows: rows.iter().map(|row| self.levels(row)).collect(),
            beside: beside.clone(),
            places: places.clone(),
        };
        ValidPart::bisect(cases, axes, limits, answer)
    }

    /// Returns the levels of a row on which the constraints depend.
    fn levels(&self, row: &[usize]) -> Vec<usize> {
        self.discrete.iter().map(|&parameter| row[parameter]).collect()
    }

    /// Returns a complete row for each valid choice of levels on which the constraints depend, and whether these are all.
    fn rows(&self, fixed: &[(usize, usize)]) -> (Vec<Vec<usize>>, bool) {
        let levels = self.rules.levels();
        let mut partial = vec![fixed.to_vec()];
        for &parameter in self.discrete.iter().filter(|&parameter| fixed.iter().all(|(known, _)| known != parameter)) {
            let with = |row: &Vec<(usize, usize)>| {
                let row = row.clone();
                (0..levels[parameter]).map(move |level| [&row[..], &[(parameter, level)]].concat())
            };
            let valid = |row: &Vec<(usize, usize)>| self.rules.is_valid(row);
            partial = partial.iter().flat_map(with).filter(valid).take(MOST_ROWS + 1).collect();
        }
        let all = partial.len() <= MOST_ROWS;
        partial.truncate(MOST_ROWS);
        (partial.into_iter().filter_map(|row| self.completed(row)).collect(), all)
    }

    fn completed(&self, mut row: Vec<(usize, usize)>) -> Option<Vec<usize>> {
        for (parameter, &levels) in self.rules.levels().iter().enumerate() {
            if row.iter().any(|(known, _)| *known == parameter) {
                continue;
            }
            let level = (0..levels).find(|&level| self.rules.is_valid(&[&row[..], &[(parameter, level)]].concat()))?;
            row.push((parameter, level));
        }
        row.sort_unstable();
        Some(row.into_iter().map(|(_, level)| level).collect())
    }
}

/// Returns places of the unit cube of so many dimensions: the centre, and all corners if they are few.
fn probes(dims: usize) -> Vec<Vec<f64>> {
    let mut probes = vec![vec![0.5; dims]];
    if (1..=MOST_BESIDE).contains(&dims) {
        let corner = |bits: usize| (0..dims).map(|axis| f64::from(u8::from(bits >> axis & 1 == 1))).collect();
        probes.extend((0..1usize << dims).map(corner));
    }
    probes
}
