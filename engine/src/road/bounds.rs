//! Boxes along the axes, and a tree of them: which of many things is nearest to a point, which come near a box.
//!
//! The tree is a bounding volume hierarchy over boxes that never change: halves by the median along the longer side.

use nalgebra::Vector2;
use std::ops::Range;

/// A box with sides along the axes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Bounds {
    /// The corner with the least coordinates.
    pub min: Vector2<f64>,
    /// The corner with the greatest coordinates.
    pub max: Vector2<f64>,
}

impl Bounds {
    /// The box of no point, which becomes that of what is included.
    pub(crate) fn empty() -> Self {
        Self { min: Vector2::repeat(f64::INFINITY), max: Vector2::repeat(f64::NEG_INFINITY) }
    }

    pub(crate) fn around(points: impl IntoIterator<Item = Vector2<f64>>) -> Self {
        let mut bounds = Self::empty();
        points.into_iter().for_each(|point| bounds.include(point));
        bounds
    }

    pub(crate) fn include(&mut self, point: Vector2<f64>) {
        self.min = self.min.inf(&point);
        self.max = self.max.sup(&point);
    }

    pub(crate) fn union(&self, other: &Self) -> Self {
        Self { min: self.min.inf(&other.min), max: self.max.sup(&other.max) }
    }

    /// The box with every side moved outward.
    pub(crate) fn grown(&self, by: f64) -> Self {
        Self { min: self.min.add_scalar(-by), max: self.max.add_scalar(by) }
    }

    pub(crate) fn meets(&self, other: &Self) -> bool {
        let apart = |a: &Self, b: &Self| a.max.x < b.min.x || a.max.y < b.min.y;
        !apart(self, other) && !apart(other, self)
    }

    fn centre(&self) -> Vector2<f64> {
        0.5 * (self.min + self.max)
    }

    /// The square of the distance to a point; 0 inside.
    fn distance_squared(&self, point: Vector2<f64>) -> f64 {
        let beyond = (self.min - point).sup(&(point - self.max)).sup(&Vector2::zeros());
        beyond.norm_squared()
    }
}

/// Many boxes, by their indices.
#[derive(Debug)]
pub(super) struct Tree {
    /// The first is the root; the first child of a node follows it.
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
    /// The items in this range.
    Leaf(Range<usize>),
    /// The next node, and this one.
    Second(usize),
}

/// Items in a leaf.
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

    /// The item with the least distance to a point, of those that have one, and the least index among equals.
    /// `distance_squared` is that of an item, never less than that of its box.
    pub fn nearest(&self, point: Vector2<f64>, distance_squared: impl Fn(u32) -> Option<f64>) -> Option<u32> {
        let mut best: Option<(f64, u32)> = None;
        let mut open = Vec::with_capacity(64);
        if let Some(root) = self.nodes.first() {
            open.push((root.bounds.distance_squared(point), 0));
        }
        while let Some((bound, index)) = open.pop() {
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
                    // The nearer is looked at first: it lies on top.
                    if children[0].0 < children[1].0 {
                        children.swap(0, 1);
                    }
                    open.extend(children);
                }
            }
        }
        best.map(|(_, item)| item)
    }

    /// The items below the nodes that meet a box: all whose own boxes do, and some that come near.
    pub fn near(&self, target: &Bounds) -> Vec<u32> {
        let mut found = Vec::new();
        self.visit_near(target, &mut Vec::new(), |item| found.push(item));
        found
    }

    /// The same without an allocation, where `open` has been used before.
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
