//! Boxes with sides along the axes, and a tree of boxes that finds the item nearest to a point and items near a box.
//!
//! The tree is a bounding volume hierarchy over constant boxes, halved at the median along the longer side.

use nalgebra::Vector2;
use std::ops::Range;

/// A rectangle in the ground plane with sides along the axes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Bounds {
    /// The corner of the box with the smallest coordinates.
    pub min: Vector2<f64>,
    /// The corner of the box with the largest coordinates.
    pub max: Vector2<f64>,
}

impl Bounds {
    /// Returns an empty box, which contains no point. It is the start for [`Bounds::include`] and [`Bounds::union`].
    #[inline]
    pub fn empty() -> Self {
        Self { min: Vector2::repeat(f64::INFINITY), max: Vector2::repeat(f64::NEG_INFINITY) }
    }

    /// Returns the smallest box that contains all given points; an empty box without points.
    #[inline]
    pub fn around(points: impl IntoIterator<Item = Vector2<f64>>) -> Self {
        let mut bounds = Self::empty();
        points.into_iter().for_each(|point| bounds.include(point));
        bounds
    }

    /// Extends the box so that it contains a given point.
    #[inline]
    pub fn include(&mut self, point: Vector2<f64>) {
        self.min = self.min.inf(&point);
        self.max = self.max.sup(&point);
    }

    /// Returns the smallest box that contains both boxes.
    #[must_use]
    #[inline]
    pub fn union(&self, other: &Self) -> Self {
        Self { min: self.min.inf(&other.min), max: self.max.sup(&other.max) }
    }

    /// Returns the box with every side moved outward by `by` metres.
    #[must_use]
    #[inline]
    pub fn grown(&self, by: f64) -> Self {
        Self { min: self.min.add_scalar(-by), max: self.max.add_scalar(by) }
    }

    /// Returns true if the boxes have a point in common.
    #[inline]
    pub fn meets(&self, other: &Self) -> bool {
        let apart = |a: &Self, b: &Self| a.max.x < b.min.x || a.max.y < b.min.y;
        !apart(self, other) && !apart(other, self)
    }

    fn centre(&self) -> Vector2<f64> {
        0.5 * (self.min + self.max)
    }

    /// Returns the square of the distance to a point; 0 if the point is inside.
    fn distance_squared(&self, point: Vector2<f64>) -> f64 {
        let beyond = (self.min - point).sup(&(point - self.max)).sup(&Vector2::zeros());
        beyond.norm_squared()
    }
}

/// A tree over many boxes, which are identified by their indices.
#[derive(Debug)]
pub(super) struct Tree {
    /// The nodes of the tree. The first node is the root; the first child of a node follows the node directly.
    nodes: Vec<Node>,
    items: Vec<u32>,
}

#[derive(Debug)]
struct Node {
    bounds: Bounds,
    below: Below,
}

#[derive(Debug)]
enum Below {
    /// A leaf of the tree, with a range of items.
    Leaf(Range<usize>),
    /// An inner node with the index of its second child; the first child is the next node.
    Second(usize),
}

/// The largest number of items in a leaf.
const LEAF: usize = 4;

impl Tree {
    pub fn new(boxes: &[Bounds]) -> Self {
        let mut tree = Self { nodes: Vec::with_capacity(boxes.len()), items: (0..boxes.len() as u32).collect() };
        if !boxes.is_empty() {
            tree.split(boxes, 0..boxes.len());
        }
        tree
    }

    fn split(&mut self, boxes: &[Bounds], range: Range<usize>) {
        let items = &mut self.items[range.clone()];
        let bounds = items.iter().fold(Bounds::empty(), |all, item| all.union(&boxes[*item as usize]));
        let node = self.nodes.len();
        self.nodes.push(Node { bounds, below: Below::Leaf(range.clone()) });
        if items.len() <= LEAF {
            return;
        }
        let axis = (bounds.max - bounds.min).imax();
        let middle = items.len() / 2;
        items.select_nth_unstable_by(middle, |a, b| {
            let centre = |item: &u32| boxes[*item as usize].centre()[axis];
            centre(a).total_cmp(&centre(b)).then(a.cmp(b))
        });
        self.split(boxes, range.start..range.start + middle);
        self.nodes[node].below = Below::Second(self.nodes.len());
        self.split(boxes, range.start + middle..range.end);
    }

    /// Returns the first item with the smallest distance to a point. `distance_squared` gives the squared distance of
    /// an item, never less than that of its box, or `None` for an item to leave out.
    pub fn nearest(&self, point: Vector2<f64>, distance_squared: impl Fn(u32) -> Option<f64>) -> Option<u32> {
        let mut best: Option<(f64, u32)> = None;
        // The tree is halved at each level, so no search of a tree in memory has more open nodes.
        let mut open = [(0.0, 0); usize::BITS as usize + 1];
        let mut count = 0;
        if let Some(root) = self.nodes.first() {
            open[0] = (root.bounds.distance_squared(point), 0);
            count = 1;
        }
        while count > 0 {
            count -= 1;
            let (bound, index) = open[count];
            if best.is_some_and(|(least, _)| bound > least) {
                continue;
            }
            match &self.nodes[index].below {
                Below::Leaf(range) => {
                    for &item in &self.items[range.clone()] {
                        let Some(found) = distance_squared(item).map(|distance| (distance, item)) else { continue };
                        if best.is_none_or(|best| found < best) {
                            best = Some(found);
                        }
                    }
                }
                Below::Second(second) => {
                    let mut children =
                        [index + 1, *second].map(|child| (self.nodes[child].bounds.distance_squared(point), child));
                    // The nearer child lies on top of the stack and is visited first.
                    if children[0].0 < children[1].0 {
                        children.swap(0, 1);
                    }
                    open[count..count + 2].copy_from_slice(&children);
                    count += 2;
                }
            }
        }
        best.map(|(_, item)| item)
    }

    /// Returns all items whose boxes meet `target`, and some items whose boxes are only near `target`.
    pub fn near(&self, target: &Bounds) -> Vec<u32> {
        let mut found = Vec::new();
        self.visit_near(target, &mut Vec::new(), |item| found.push(item));
        found
    }

    /// Calls `visit` for every item that [`Tree::near`] returns. It allocates nothing if `open` has been used before.
    pub fn visit_near(&self, target: &Bounds, open: &mut Vec<usize>, mut visit: impl FnMut(u32)) {
        open.clear();
        open.extend((!self.nodes.is_empty()).then_some(0));
        while let Some(index) = open.pop() {
            let node = &self.nodes[index];
            if node.bounds.meets(target) {
                match &node.below {
                    Below::Leaf(range) => self.items[range.clone()].iter().for_each(|item| visit(*item)),
                    Below::Second(second) => open.extend([*second, index + 1]),
                }
            }
        }
    }
}
