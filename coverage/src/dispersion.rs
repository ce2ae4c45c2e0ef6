//! Dispersion: the largest open axis-parallel box in the unit cube that no point has entered.
//!
//! Every empty box is what is left of the cube after each point has been cut away along some axis, on one of its
//! two sides. The search branches on that: it takes a point inside the box at hand, the pivot, and tries its
//! `2d` cuts. A box without points inside is a candidate; one that is no larger than the best candidate is
//! dropped. Three things keep this small:
//!
//! * Children are disjoint. The cuts of a pivot are tried in an order, and the child of a later cut carries the
//!   constraint that the earlier ones were not made (`Side::kept`), so that no empty box
//!   is found twice. The larger a child, the later in the order and the more constrained it is.
//! * The pivot is chosen well: the one whose children's volumes have the least sum of cubes. That prefers points
//!   near the centre, and above all points that constraints and the best candidate leave few cuts.
//! * Volumes are products of differences, which floating-point rounding keeps monotone: a box inside another is
//!   never computed to be larger. Pruning on computed volumes is exact, without tolerances.
//!
//! The search is depth-first with a stack of its own, because boxes can be cut `n` deep; the larger children are
//! explored first, which finds good candidates early.

use crate::bracket::Watch;
use crate::{Bracket, Deadline, PointSet};
use std::ops::Range;

/// An open box in the unit cube that holds no point.
#[derive(Debug, Clone, PartialEq)]
pub struct LargestEmptyBox {
    /// Its lower corner.
    pub lower: Vec<f64>,
    /// Its upper corner.
    pub upper: Vec<f64>,
}

impl LargestEmptyBox {
    /// Its volume, as a share of the cube's.
    pub fn volume(&self) -> f64 {
        self.lower.iter().zip(&self.upper).map(|(lower, upper)| upper - lower).product()
    }
}

/// The dispersion of a set of points, with the box that shows it.
#[derive(Debug, Clone, PartialEq)]
pub struct Dispersion {
    /// The largest volume; its lower end is the volume of `witness`.
    pub volume: Bracket,
    /// The largest empty box that was found.
    pub witness: LargestEmptyBox,
}

/// The largest volume over the open axis-parallel boxes in `[0,1]^d` that hold none of the points. A point on a
/// face of a box is not in it; of a set without points the largest is the cube, with volume 1 (Rote, Tichy,
/// Quasi-Monte Carlo methods and the dispersion of point sequences, Math. Comput. Modelling 23, 1996).
///
/// Exact, in any dimension, unless `deadline` cuts the search short.
pub fn dispersion(points: &PointSet, deadline: Deadline) -> Dispersion {
    let mut search = Search::new(points);
    let left = search.run(deadline);
    let lower = search.witness.volume();
    let volume = if left <= lower { Bracket::exact(lower) } else { Bracket { lower, upper: left } };
    Dispersion { volume, witness: search.witness }
}

/// A box along one axis, and what is known of the empty boxes that are looked for inside it.
#[derive(Debug, Clone, Copy)]
struct Side {
    lower: f64,
    upper: f64,
    /// Their lower ends are below this: cuts from there on were tried elsewhere.
    lower_below: f64,
    /// Their upper ends are above this.
    upper_above: f64,
}

/// One of the two ends of a side.
#[derive(Debug, Clone, Copy)]
enum End {
    Lower,
    Upper,
}

impl Side {
    const WHOLE: Self = Self { lower: 0.0, upper: 1.0, lower_below: f64::INFINITY, upper_above: f64::NEG_INFINITY };

    fn length(&self) -> f64 {
        self.upper - self.lower
    }

    /// Whether an end may move to `x`.
    fn allows(&self, x: f64, end: End) -> bool {
        match end {
            End::Lower => x < self.lower_below,
            End::Upper => x > self.upper_above,
        }
    }

    /// The side with an end at `x`.
    fn moved(self, x: f64, end: End) -> Self {
        match end {
            End::Lower => Self { lower: x, ..self },
            End::Upper => Self { upper: x, ..self },
        }
    }

    /// The side with the promise that this end does not reach `x`.
    fn kept(self, x: f64, end: End) -> Self {
        match end {
            End::Lower => Self { lower_below: self.lower_below.min(x), ..self },
            End::Upper => Self { upper_above: self.upper_above.max(x), ..self },
        }
    }
}

/// A way to get rid of a point: an end of the box moves to it.
#[derive(Debug, Clone, Copy)]
struct Cut {
    axis: usize,
    end: End,
    /// What is left of the box.
    volume: f64,
}

/// A box that waits to be explored; its sides lie on a stack of their own.
struct Node {
    volume: f64,
    /// Where the points inside the box that it was cut from are listed.
    around: Range<usize>,
}

struct Search<'a> {
    points: &'a PointSet,
    /// The boxes that wait, as a stack, and their sides.
    nodes: Vec<Node>,
    sides: Vec<Side>,
    /// The points inside each box, as a stack: a list outlives the lists of the boxes inside its own.
    lists: Vec<u32>,
    /// The best candidate, and its volume.
    witness: LargestEmptyBox,
    best: f64,
}

impl<'a> Search<'a> {
    fn new(points: &'a PointSet) -> Self {
        let witness = widest_slab(points);
        Self {
            points,
            nodes: vec![Node { volume: 1.0, around: 0..points.len() }],
            sides: vec![Side::WHOLE; points.dims()],
            lists: (0..points.len() as u32).collect(),
            best: witness.volume(),
            witness,
        }
    }

    /// Searches until nothing is left or the deadline has passed, and returns the largest volume that boxes
    /// left unexplored may have.
    fn run(&mut self, deadline: Deadline) -> f64 {
        let dims = self.points.dims();
        let mut sides = Vec::with_capacity(dims);
        let mut cuts = Vec::with_capacity(2 * dims);
        let mut watch = Watch::new(deadline);
        while let Some(node) = self.nodes.pop() {
            let top = self.nodes.len() * dims;
            sides.clear();
            sides.extend(self.sides.drain(top..));
            if node.volume <= self.best {
                continue;
            }
            if watch.passed_after(node.around.len()) {
                let left = self.nodes.iter().map(|node| node.volume).fold(node.volume, f64::max);
                // Each factor and each product may have lost half an ulp.
                return (left * (1.0 + 2.0 * dims as f64 * f64::EPSILON)).min(1.0);
            }
            self.explore(node.around, &mut sides, &mut cuts);
        }
        0.0
    }

    /// Explores a box: a candidate, if there is no point inside, else the children that a pivot's cuts leave.
    fn explore(&mut self, around: Range<usize>, sides: &mut [Side], cuts: &mut Vec<Cut>) {
        self.lists.truncate(around.end);
        for i in around.clone() {
            let point = self.lists[i];
            let inside = |(side, x): (&Side, &f64)| side.lower < *x && *x < side.upper;
            if sides.iter().zip(self.points.point(point as usize)).all(inside) {
                self.lists.push(point);
            }
        }
        let list = around.end..self.lists.len();
        let Some(pivot) = self.pivot(list.clone(), sides) else {
            self.witness.lower = sides.iter().map(|side| side.lower).collect();
            self.witness.upper = sides.iter().map(|side| side.upper).collect();
            self.best = self.witness.volume();
            return;
        };
        let pivot = self.points.point(pivot);
        cuts.clear();
        for (axis, &x) in pivot.iter().enumerate() {
            let side = sides[axis];
            for end in [End::Lower, End::Upper] {
                if side.allows(x, end) {
                    sides[axis] = side.moved(x, end);
                    cuts.push(Cut { axis, end, volume: volume(sides) });
                }
            }
            sides[axis] = side;
        }
        cuts.retain(|cut| cut.volume > self.best);
        // The largest comes last: most constrained, and on top of the stack.
        cuts.sort_unstable_by(|a, b| a.volume.total_cmp(&b.volume));
        for cut in cuts {
            let (side, x) = (sides[cut.axis], pivot[cut.axis]);
            sides[cut.axis] = side.moved(x, cut.end);
            self.nodes.push(Node { volume: cut.volume, around: list.clone() });
            self.sides.extend_from_slice(sides);
            sides[cut.axis] = side.kept(x, cut.end);
        }
    }

    /// The listed point whose possible cuts leave the least sum of cubed volumes.
    ///
    /// Shares of the box's volume serve to choose; whether a cut is worth exploring is decided by its volume.
    fn pivot(&self, list: Range<usize>, sides: &[Side]) -> Option<usize> {
        let least = self.best / volume(sides);
        let cubed = |possible: bool, share: f64| if possible && share > least { share * share * share } else { 0.0 };
        let score = |point: usize| {
            let axes = sides.iter().zip(self.points.point(point));
            let scores = axes.map(|(side, &x)| {
                let share = (x - side.lower) / side.length();
                cubed(side.allows(x, End::Upper), share) + cubed(side.allows(x, End::Lower), 1.0 - share)
            });
            scores.sum::<f64>()
        };
        let scored = self.lists[list].iter().map(|&point| (score(point as usize), point as usize));
        scored.min_by(|a, b| a.0.total_cmp(&b.0)).map(|(_, point)| point)
    }
}

fn volume(sides: &[Side]) -> f64 {
    sides.iter().map(Side::length).product()
}

/// The widest gap between neighbouring coordinates along any axis, as a box across the whole cube: the candidate
/// that the search starts from.
fn widest_slab(points: &PointSet) -> LargestEmptyBox {
    let dims = points.dims();
    let gaps = (0..dims).flat_map(|axis| {
        let mut coordinates: Vec<f64> = points.iter().map(|point| point[axis]).chain([0.0, 1.0]).collect();
        coordinates.sort_unstable_by(f64::total_cmp);
        let gaps = coordinates.windows(2).map(|gap| (axis, gap[0], gap[1]));
        gaps.collect::<Vec<_>>()
    });
    let width = |gap: &(usize, f64, f64)| gap.2 - gap.1;
    let (axis, lower, upper) = gaps.max_by(|a, b| width(a).total_cmp(&width(b))).expect("0 and 1 are apart");
    let mut slab = LargestEmptyBox { lower: vec![0.0; dims], upper: vec![1.0; dims] };
    (slab.lower[axis], slab.upper[axis]) = (lower, upper);
    slab
}
