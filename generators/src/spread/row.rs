//! A discrete row that chooses among several sets of points, and the largest hole that each set leaves.
//!
//! The sets grow side by side. To know their holes, all empty boxes are kept, and there are many in three dimensions
//! and more. While there are few boxes, all sets are kept. If there are many, the worst sets are dropped until two
//! are left: the row's own block and the best of the others. If these two take more memory than a row has, only the
//! better one is left, and in the end its smaller boxes are forgotten.

use crate::sequence::Sequence;
use paracosm_coverage::dispersion::is_at_most;
use paracosm_coverage::{Deadline, PointSet, empty_boxes::EmptyBoxes};
use std::sync::Arc;

/// The memory that the boxes of all rows may take together, in bytes.
const MOST_MEMORY: usize = 200_000_000;

/// The greatest number of faces to look at when a point splits all boxes: a box has `2d` parts with `2d` faces each.
const MOST_FACES: usize = 500_000_000;

/// The greatest number of boxes of a row's sets while more than two sets are compared.
const MOST_COMPARED: usize = 20_000;

/// The limits of a row, which are its epsilon, its deadline and its memory.
pub(super) struct Limits {
    pub(super) epsilon: f64,
    pub(super) deadline: Deadline,
    /// The greatest number of boxes of a row.
    most: usize,
}

impl Limits {
    pub(super) fn new(dims: usize, rows: u64, epsilon: f64, deadline: Deadline) -> Self {
        let in_memory = MOST_MEMORY / (24 * dims + 8) / rows.max(1) as usize;
        let most = in_memory.min(MOST_FACES / (2 * dims).saturating_mul(2 * dims).max(1)).max(100);
        Self { epsilon, deadline, most }
    }
}

/// A set of points, which are the points of a sequence from an index on.
pub(super) struct Set {
    pub(super) sequence: Arc<dyn Sequence>,
    pub(super) first: u64,
}

impl Set {
    pub(super) fn point(&self, number: u64) -> Vec<f64> {
        self.sequence.point(self.first + number)
    }

    fn has(&self, number: u64) -> bool {
        self.first + number < self.sequence.len()
    }
}

/// A set with the points that it has so far.
struct Candidate {
    set: Set,
    boxes: EmptyBoxes,
    /// For each point, the largest hole before the point was added.
    holes: Vec<f64>,
}

impl Candidate {
    fn hole(&self) -> f64 {
        self.boxes.dispersion().lower
    }

    fn grow(&mut self) {
        let point = self.set.point(self.holes.len() as u64);
        self.holes.push(self.hole());
        self.boxes.add(&point).expect("a point of the cube");
    }
}

/// A row of discrete values with the points that the row has so far.
pub(super) struct Row {
    discrete: Vec<usize>,
    existing: Vec<Vec<f64>>,
    /// The boxes of the existing points.
    boxes: EmptyBoxes,
    /// The sets to choose from; empty before the first point.
    candidates: Vec<Candidate>,
    /// The index of the candidate with the smallest hole.
    best: usize,
    /// The number of points at which the row is checked again, if the boxes do not show whether the points are
    /// enough.
    look_at: usize,
}

impl Row {
    pub(super) fn new(dims: usize, discrete: Vec<usize>, existing: Vec<Vec<f64>>, limits: &Limits) -> Self {
        let mut boxes = EmptyBoxes::at_most(dims, limits.most).expect("there is an axis");
        existing.iter().for_each(|point| boxes.add(point).expect("a point of the cube"));
        Self { discrete, existing, boxes, candidates: Vec::new(), best: 0, look_at: 1 }
    }

    fn boxes(&self) -> &EmptyBoxes {
        self.candidates.get(self.best).map_or(&self.boxes, |best| &best.boxes)
    }

    /// Returns the volume of the largest hole of the row's best set.
    pub(super) fn hole(&self) -> f64 {
        self.boxes().dispersion().lower
    }

    /// Returns the number of new points that the row has so far.
    pub(super) fn points(&self) -> usize {
        self.candidates.first().map_or(0, |candidate| candidate.holes.len())
    }

    /// Returns `true` if it is proved that no hole of the row is above epsilon.
    pub(super) fn is_enough(&mut self, limits: &Limits) -> bool {
        let hole = self.boxes().dispersion();
        let points = self.existing.len() + self.points();
        if hole.upper <= limits.epsilon || hole.lower > limits.epsilon || points < self.look_at {
            return hole.upper <= limits.epsilon;
        }
        // Larger boxes may have been forgotten: search for them.
        self.look_at = points + points.div_ceil(20);
        let best = self.candidates.get(self.best);
        let new = best.into_iter().flat_map(|best| (0..best.holes.len()).map(|number| best.set.point(number as u64)));
        let points: Vec<Vec<f64>> = self.existing.iter().cloned().chain(new).collect();
        let points = PointSet::new(points[0].len(), &points).expect("points of the cube");
        is_at_most(&points, limits.epsilon, limits.deadline) == Some(true)
    }

    /// Gives the row the sets from which the row chooses, with the row's own block first.
    pub(super) fn choose_from(&mut self, sets: Vec<Set>) {
        let candidate = |set| Candidate { set, boxes: self.boxes.clone(), holes: Vec::new() };
        self.candidates = sets.into_iter().map(candidate).collect();
    }

    /// Adds a point to the row. Returns `true` if the row needs another point and a point is available.
    pub(super) fn grow(&mut self, limits: &Limits) -> bool {
        let number = self.points() as u64;
        if !self.candidates.iter().any(|candidate| candidate.set.has(number)) {
            return false;
        }
        self.candidates.retain(|candidate| candidate.set.has(number));
        self.candidates.iter_mut().for_each(Candidate::grow);
        self.let_go(limits.most);
        let holes = self.candidates.iter().map(Candidate::hole).enumerate();
        self.best = holes.min_by(|a, b| a.1.total_cmp(&b.1)).map_or(0, |(best, _)| best);
        !self.is_enough(limits)
    }

    /// Drops the worst sets if there are too many boxes to keep them all.
    fn let_go(&mut self, most: usize) {
        let boxes = |candidates: &[Candidate]| candidates.iter().map(|candidate| candidate.boxes.len()).sum::<usize>();
        let worst = |candidates: &[Candidate]| {
            let holes = candidates.iter().map(Candidate::hole).enumerate();
            holes.max_by(|a, b| a.1.total_cmp(&b.1)).map_or(0, |(worst, _)| worst)
        };
        while self.candidates.len() > 2 && boxes(&self.candidates) > most.min(MOST_COMPARED) {
            self.candidates.remove(1 + worst(&self.candidates[1..]));
        }
        if self.candidates.len() == 2 && boxes(&self.candidates) > most {
            self.candidates.remove(worst(&self.candidates));
        }
    }

    /// Returns the discrete values of the row, its chosen set, and the largest hole before each point. The last two are
    /// `None` if the row has no set.
    pub(super) fn chosen(mut self) -> (Vec<usize>, Option<(Set, Vec<f64>)>) {
        let chosen = (!self.candidates.is_empty()).then(|| self.candidates.swap_remove(self.best));
        (self.discrete, chosen.map(|candidate| (candidate.set, candidate.holes)))
    }
}
