//! A discrete row that chooses among several sets of points, and the largest hole that each set leaves.
//!
//! The sets grow side by side. To know their holes, all empty boxes are kept, and there are many in three dimensions
//! and more. While there are few boxes, all sets are kept. If there are many, the worst sets are dropped until two
//! are left: the row's own block and the best of the others. If these two take more memory than a row has, only the
//! better one is left, and in the end its smaller boxes are forgotten.

use crate::sequence::Sequence;
use paracosm_coverage::dispersion::{is_at_most, valid_is_at_most};
use paracosm_coverage::valid::ValidPart;
use paracosm_coverage::{Deadline, PointSet, empty_boxes::EmptyBoxes};
use paracosm_space::{Point, Space};
use std::sync::Arc;

/// The memory that the boxes of all rows may take together, in bytes.
const MOST_MEMORY: usize = 200_000_000;

/// The greatest number of faces to look at when a point splits all boxes: a box has `2d` parts with `2d` faces each.
const MOST_FACES: usize = 500_000_000;

/// The greatest number of boxes of a row's sets while more than two sets are compared.
const MOST_COMPARED: usize = 20_000;

/// The greatest number of points in a row that a set leaves out because they break constraints.
const MOST_REFUSED: usize = 10_000;

/// The limits of a row, which are its epsilon, its deadline and its memory.
pub(super) struct Limits {
    pub(super) epsilon: f64,
    pub(super) deadline: Deadline,
    /// The greatest number of boxes of a row.
    most: usize,
    /// The space, if its constraints depend on continuous parameters.
    constrained: Option<Space>,
}

impl Limits {
    pub(super) fn new(space: &Space, rows: u64, epsilon: f64, deadline: Deadline) -> Self {
        let dims = space.dims();
        let in_memory = MOST_MEMORY / (24 * dims + 8) / rows.max(1) as usize;
        let most = in_memory.min(MOST_FACES / (2 * dims).saturating_mul(2 * dims).max(1)).max(100);
        let constrained = space.checks_each_test().then(|| space.clone());
        Self { epsilon, deadline, most, constrained }
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
    added: Vec<Added>,
    /// The number of the next point of the set.
    next: u64,
}

/// A point of a set that a row has got.
pub(super) struct Added {
    /// The number of the point in the set.
    pub(super) number: u64,
    /// The largest hole before the point was added.
    pub(super) hole: f64,
}

impl Candidate {
    fn hole(&self) -> f64 {
        self.boxes.largest().volume()
    }

    /// Adds the next valid point of the set. Returns `false` if the set has no other point, or hardly any valid point.
    fn grow(&mut self, discrete: &[usize], limits: &Limits) -> bool {
        for _ in 0..MOST_REFUSED {
            if !self.set.has(self.next) {
                return false;
            }
            let number = self.next;
            self.next += 1;
            let point = self.set.point(number);
            let is_valid = limits
                .constrained
                .as_ref()
                .is_none_or(|space| space.allows(&Point { continuous: point.clone(), discrete: discrete.to_vec() }));
            if is_valid {
                self.added.push(Added { number, hole: self.hole() });
                self.boxes.add(&point).expect("a point of the cube");
                return true;
            }
        }
        false
    }
}

/// A row of discrete values with the points that the row has so far.
pub(super) struct Row {
    discrete: Vec<usize>,
    /// The valid part of the row; `None` if the whole cube is valid.
    valid: Option<Arc<ValidPart>>,
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
    pub(super) fn new(
        dims: usize,
        discrete: Vec<usize>,
        valid: Option<Arc<ValidPart>>,
        existing: Vec<Vec<f64>>,
        limits: &Limits,
    ) -> Self {
        let boxes = match &valid {
            Some(valid) => EmptyBoxes::within(valid.clone(), limits.most),
            None => EmptyBoxes::at_most(dims, limits.most),
        };
        let mut boxes = boxes.expect("there is an axis");
        existing.iter().for_each(|point| boxes.add(point).expect("a point of the cube"));
        Self { discrete, valid, existing, boxes, candidates: Vec::new(), best: 0, look_at: 1 }
    }

    fn boxes(&self) -> &EmptyBoxes {
        self.candidates.get(self.best).map_or(&self.boxes, |best| &best.boxes)
    }

    /// Returns the volume of the largest hole of the row's best set.
    pub(super) fn hole(&self) -> f64 {
        self.boxes().largest().volume()
    }

    /// Returns the number of new points that the row has so far.
    pub(super) fn points(&self) -> usize {
        self.candidates.first().map_or(0, |candidate| candidate.added.len())
    }

    /// Returns `true` if it is proved that no hole of the row is above epsilon.
    pub(super) fn is_enough(&mut self, limits: &Limits) -> bool {
        let upper = self.boxes().dispersion().upper;
        let points = self.existing.len() + self.points();
        if upper <= limits.epsilon || self.hole() > limits.epsilon || points < self.look_at {
            return upper <= limits.epsilon;
        }
        // Larger boxes may have been forgotten: search for them.
        self.look_at = points + points.div_ceil(20);
        let best = self.candidates.get(self.best);
        let new = best.into_iter().flat_map(|best| best.added.iter().map(|added| best.set.point(added.number)));
        let points: Vec<Vec<f64>> = self.existing.iter().cloned().chain(new).collect();
        let points = PointSet::new(points[0].len(), &points).expect("points of the cube");
        let is_enough = match &self.valid {
            Some(valid) => valid_is_at_most(&points, valid, limits.epsilon, limits.deadline),
            None => is_at_most(&points, limits.epsilon, limits.deadline),
        };
        is_enough == Some(true)
    }

    /// Gives the row the sets from which the row chooses, with the row's own block first.
    pub(super) fn choose_from(&mut self, sets: Vec<Set>) {
        let candidate = |set| Candidate { set, boxes: self.boxes.clone(), added: Vec::new(), next: 0 };
        self.candidates = sets.into_iter().map(candidate).collect();
    }

    /// Adds a point to the row. Returns `true` if the row needs another point and a point is available.
    pub(super) fn grow(&mut self, limits: &Limits) -> bool {
        let discrete = &self.discrete;
        let grown: Vec<bool> = self.candidates.iter_mut().map(|candidate| candidate.grow(discrete, limits)).collect();
        if !grown.contains(&true) {
            return false;
        }
        let mut grown = grown.into_iter();
        self.candidates.retain(|_| grown.next() == Some(true));
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

    /// Returns the discrete values of the row, its chosen set, and the points of this set that the row has got. The last two are
    /// `None` if the row has no set.
    pub(super) fn chosen(mut self) -> (Vec<usize>, Option<(Set, Vec<Added>)>) {
        let chosen = (!self.candidates.is_empty()).then(|| self.candidates.swap_remove(self.best));
        (self.discrete, chosen.map(|candidate| (candidate.set, candidate.added)))
    }
}
