//! The depth-first search of one box: it finds every empty box inside that is larger than a bar.
//!
//! The tree does not depend on the bar. The choice of pivots and the promises to children do not depend on what has
//! been found so far, only on the `reference` volume that is fixed beforehand. If another thread raises the bar
//! sooner or later, the search therefore leaves out more or less of the same tree, and the first largest box in the
//! order of the tree is always the same.

use super::LargestEmptyBox;
use super::side::{End, Side, Weight, inside, volume};
use crate::PointSet;
use std::ops::Range;
use std::sync::atomic::{AtomicU64, Ordering};

/// A weight that many threads share and raise, so that all threads leave out smaller boxes. Non-negative floats have
/// the same order as their bits.
#[derive(Debug)]
pub(super) struct Bar(AtomicU64);

impl Bar {
    pub fn new(weight: f64) -> Self {
        Self(AtomicU64::new(weight.to_bits()))
    }

    pub fn get(&self) -> f64 {
        f64::from_bits(self.0.load(Ordering::Relaxed))
    }

    pub fn raise(&self, weight: f64) {
        self.0.fetch_max(weight.to_bits(), Ordering::Relaxed);
    }
}

/// A box that waits to be explored, with the points strictly inside the box.
#[derive(Debug, Clone)]
pub(super) struct Open {
    pub weight: f64,
    pub sides: Vec<Side>,
    pub inside: Vec<u32>,
}

impl Open {
    /// Makes the box that is the whole unit cube, with all points strictly inside the cube.
    pub fn cube(points: &PointSet, weight: impl Weight) -> Self {
        let sides = vec![Side::between(0.0, 1.0); points.dims()];
        let all = 0..points.len() as u32;
        let inside = all.filter(|&point| inside(points.point(point as usize), &sides)).collect();
        Self { weight: weight.of(&sides), sides, inside }
    }
}

/// A way to cut a point away: an end of the box moves to the point.
#[derive(Debug, Clone, Copy)]
struct Cut {
    axis: u32,
    end: End,
    /// The weight of the rest of the box.
    weight: f64,
}

/// A box on the stack. Its sides lie on a stack of their own.
struct Node {
    weight: f64,
    /// The place where the points inside the parent box are listed, and the axis of the cut: the points need only be
    /// compared along this axis.
    around: Range<usize>,
    cut: Option<u32>,
}

/// The result of the depth-first search for the largest empty box.
#[derive(Debug)]
pub(super) struct Found {
    /// The first of the largest empty boxes that exceed the search's limits in weight; `None` if no box does.
    pub witness: Option<LargestEmptyBox>,
    /// The boxes that the search did not explore before its end.
    pub open: Vec<Open>,
    /// `true` if the search ended for lack of memory, so that the list of unexplored boxes in `open` is incomplete.
    pub lost: bool,
}

impl Found {
    /// Returns `true` if the search explored all boxes.
    pub fn is_done(&self) -> bool {
        self.open.is_empty() && !self.lost
    }
}

/// The default number of points that the lists of a search may hold, which take 64 MiB.
pub(super) const MOST_LISTED: usize = 1 << 24;

pub(super) struct BoxSearch<'a, W> {
    points: &'a PointSet,
    weight: W,
    /// The weight for which pivots are chosen: smaller boxes are not expected to matter.
    reference: f64,
    nodes: Vec<Node>,
    sides: Vec<Side>,
    /// The points inside each box, as a stack: the list of a box stays while the boxes inside it are searched.
    lists: Vec<u32>,
    cuts: Vec<Cut>,
    /// One over the length of each side.
    scales: Vec<f64>,
    /// The pivots in the order in which they were taken, if the search is to give a proof.
    trail: Option<Vec<u32>>,
    /// The number of points that the lists may hold, and the number that the lists of the open boxes may hold.
    most_listed: usize,
    /// The greatest number of sides of waiting boxes.
    most_sides: usize,
}

impl<'a, W: Weight> BoxSearch<'a, W> {
    pub fn new(points: &'a PointSet, weight: W, reference: f64) -> Self {
        let (nodes, sides, lists, cuts, scales) = Default::default();
        // A box and its children must always fit.
        let most_listed = MOST_LISTED.max(4 * points.len());
        let most_sides = (MOST_LISTED / 8).max(4 * points.dims() * points.dims());
        Self { points, weight, reference, nodes, sides, lists, cuts, scales, trail: None, most_listed, most_sides }
    }

    /// Makes a search that records its pivots, so that a proof can repeat the search from the points and the pivots.
    /// The search tries cuts in the order of the axes.
    pub fn with_trail(points: &'a PointSet, weight: W, reference: f64) -> Self {
        Self { trail: Some(Vec::new()), ..Self::new(points, weight, reference) }
    }

    /// Returns the pivots that the search recorded, in the order in which the search took them.
    pub fn into_trail(self) -> Vec<u32> {
        self.trail.unwrap_or_default()
    }

    /// Searches a box for the largest empty box inside, as long as `go_on` returns `true`. `go_on` receives the number
    /// of points that each step looks at.
    ///
    /// The search leaves out boxes below the shared bar, and boxes at or below `floor`. A box that it finds raises
    /// both.
    pub fn explore(&mut self, root: &Open, shared: &Bar, floor: f64, mut go_on: impl FnMut(usize) -> bool) -> Found {
        let dims = self.points.dims();
        self.lists.clear();
        self.lists.extend_from_slice(&root.inside);
        self.sides.clear();
        self.sides.extend_from_slice(&root.sides);
        self.nodes.clear();
        self.nodes.push(Node { weight: root.weight, around: 0..self.lists.len(), cut: None });
        let mut found = Found { witness: None, open: Vec::new(), lost: false };
        let mut best = floor;
        let mut sides = Vec::with_capacity(dims);
        while let Some(node) = self.nodes.pop() {
            let top = self.nodes.len() * dims;
            sides.clear();
            sides.extend(self.sides.drain(top..));
            if node.weight <= best || node.weight < shared.get() {
                continue;
            }
            if !go_on(node.around.len()) {
                self.sides.extend_from_slice(&sides);
                self.nodes.push(node);
                self.leave(best.max(shared.get()), &mut found);
                break;
            }
            if node.around.end + node.around.len() > self.most_listed || self.sides.len() > self.most_sides {
                found.lost = true;
                break;
            }
            if !self.branch(&node, &mut sides, best, shared.get()) {
                let lower = sides.iter().map(|side| side.lower).collect();
                let upper = sides.iter().map(|side| side.upper).collect();
                found.witness = Some(LargestEmptyBox { lower, upper });
                best = node.weight;
                shared.raise(best);
                if self.trail.is_some() {
                    // A larger box means that there is no proof.
                    break;
                }
            }
        }
        found
    }

    /// Moves the waiting boxes above a weight from the stack to `found.open`.
    fn leave(&mut self, above: f64, found: &mut Found) {
        let dims = self.points.dims();
        let mut listed = 0;
        for (node, sides) in self.nodes.drain(..).zip(self.sides.chunks_exact(dims)) {
            if node.weight <= above {
                continue;
            }
            // The points are inside the parent box, so that only the axis of the cut need be compared.
            let holds = |point: &&u32| {
                let point = self.points.point(**point as usize);
                node.cut.is_none_or(|axis| sides[axis as usize].holds(point[axis as usize]))
            };
            let inside: Vec<u32> = self.lists[node.around].iter().filter(holds).copied().collect();
            listed += inside.len();
            if listed > self.most_listed {
                found.lost = true;
                return;
            }
            found.open.push(Open { weight: node.weight, sides: sides.to_vec(), inside });
        }
    }

    /// Puts the children of a box on the stack. Returns `false` if no point is inside the box.
    fn branch(&mut self, node: &Node, sides: &mut [Side], best: f64, shared: f64) -> bool {
        let list = self.list(node, sides);
        let Some(pivot) = self.pivot(list.clone(), sides) else { return false };
        if let Some(trail) = &mut self.trail {
            trail.push(pivot as u32);
        }
        let pivot = self.points.point(pivot);
        self.cuts.clear();
        for (axis, &x) in pivot.iter().enumerate() {
            let side = sides[axis];
            for end in [End::Lower, End::Upper] {
                if side.allows(x, end) {
                    sides[axis] = side.moved(x, end);
                    self.cuts.push(Cut { axis: axis as u32, end, weight: self.weight.of(sides) });
                }
            }
            sides[axis] = side;
        }
        if self.trail.is_none() {
            // The largest comes last: it is the most constrained, and on top of the stack.
            self.cuts.sort_by(|a, b| a.weight.total_cmp(&b.weight));
        }
        for cut in &self.cuts {
            let axis = cut.axis as usize;
            let (side, x) = (sides[axis], pivot[axis]);
            if cut.weight > best && cut.weight >= shared {
                sides[axis] = side.moved(x, cut.end);
                self.nodes.push(Node { weight: cut.weight, around: list.clone(), cut: Some(cut.axis) });
                self.sides.extend_from_slice(sides);
            }
            sides[axis] = side.kept(x, cut.end);
        }
        true
    }

    /// Lists the points inside a box, after those of its parent box.
    fn list(&mut self, node: &Node, sides: &[Side]) -> Range<usize> {
        self.lists.truncate(node.around.end);
        let Some(axis) = node.cut else { return node.around.clone() };
        let axis = axis as usize;
        let side = sides[axis];
        for i in node.around.clone() {
            let point = self.lists[i];
            if side.holds(self.points.point(point as usize)[axis]) {
                self.lists.push(point);
            }
        }
        node.around.end..self.lists.len()
    }

    /// The listed point whose possible cuts leave the least sum of cubed volumes.
    ///
    /// The choice uses shares of the box's volume. Whether a cut is worth exploring is decided by its weight.
    fn pivot(&mut self, list: Range<usize>, sides: &[Side]) -> Option<usize> {
        let least = self.reference / volume(sides);
        self.scales.clear();
        self.scales.extend(sides.iter().map(|side| 1.0 / side.length()));
        let cubed = |possible: bool, share: f64| if possible & (share > least) { share * share * share } else { 0.0 };
        let (mut best, mut pivot) = (f64::INFINITY, None);
        for &point in &self.lists[list] {
            let mut score = 0.0;
            for ((side, scale), &x) in sides.iter().zip(&self.scales).zip(self.points.point(point as usize)) {
                let share = (x - side.lower) * scale;
                score += cubed(side.allows(x, End::Upper), share) + cubed(side.allows(x, End::Lower), 1.0 - share);
                if score >= best {
                    break;
                }
            }
            if score < best {
                (best, pivot) = (score, Some(point as usize));
            }
        }
        pivot
    }
}
