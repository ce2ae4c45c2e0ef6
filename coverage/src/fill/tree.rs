//! Finds nearest points by a k-d tree (Bentley, Multidimensional binary search trees used for associative searching,
//! Comm. ACM 18, 1975). The distance to a part of the tree is kept up to date axis by axis (Arya, Mount, Algorithms
//! for fast vector quantization, DCC 1993).

use crate::PointSet;

/// The number of points up to which a part of the tree is not divided.
const LEAF: usize = 8;
/// The least number of points that are used to find the widest axis of a part: to use all of them would take too
/// long.
const SAMPLE: usize = 64;

/// A k-d tree of points. The middle point of each part of the tree divides the part along its widest axis.
#[derive(Debug)]
pub(super) struct Tree {
    dims: usize,
    coordinates: Vec<f64>,
    /// For each point that divides a part, the axis along which it divides.
    axes: Vec<u32>,
}

/// The result of a search for the point nearest to a place.
#[derive(Debug, Clone, Copy)]
pub(super) struct Nearest {
    /// The position of the nearest point in the tree.
    pub point: u32,
    /// The squared distance between the place and the nearest point.
    pub squared: f64,
    /// The number of points that the search for the nearest point looked at.
    pub looked_at: usize,
}

impl Tree {
    pub fn new(points: &PointSet) -> Self {
        let mut order: Vec<u32> = (0..points.len() as u32).collect();
        let mut axes = vec![0; points.len()];
        divide(points, &mut order, &mut axes);
        let coordinates = order.iter().flat_map(|&point| points.point(point as usize)).copied().collect();
        Self { dims: points.dims(), coordinates, axes }
    }

    pub fn dims(&self) -> usize {
        self.dims
    }

    pub fn point(&self, point: u32) -> &[f64] {
        &self.coordinates[point as usize * self.dims..][..self.dims]
    }

    /// Finds the point nearest to a place, which may lie outside the cube. `beyond` is working memory, a number per
    /// axis.
    pub fn nearest(&self, place: &[f64], beyond: &mut [f64]) -> Nearest {
        beyond.fill(0.0);
        let nearest = Nearest { point: 0, squared: f64::INFINITY, looked_at: 0 };
        let mut query = Query { tree: self, place, beyond, nearest };
        query.visit(0, self.axes.len(), 0.0);
        query.nearest
    }
}

/// Brings the points of a part into the order of the tree.
fn divide(points: &PointSet, order: &mut [u32], axes: &mut [u32]) {
    if order.len() <= LEAF {
        return;
    }
    let extent = |axis: usize| {
        let sample = order.iter().step_by((order.len() / SAMPLE).max(1));
        let coordinates = sample.map(|&point| points.point(point as usize)[axis]);
        let (least, most) = coordinates.fold((1.0f64, 0.0f64), |(least, most), x| (least.min(x), most.max(x)));
        most - least
    };
    let extents: Vec<f64> = (0..points.dims()).map(extent).collect();
    let axis = (0..points.dims()).max_by(|&a, &b| extents[a].total_cmp(&extents[b])).expect("there is an axis");
    let middle = order.len() / 2;
    let coordinate = |point: &u32| points.point(*point as usize)[axis];
    order.select_nth_unstable_by(middle, |a, b| coordinate(a).total_cmp(&coordinate(b)).then(a.cmp(b)));
    axes[middle] = axis as u32;
    let (lower, upper) = order.split_at_mut(middle);
    let (lower_axes, upper_axes) = axes.split_at_mut(middle);
    divide(points, lower, lower_axes);
    divide(points, &mut upper[1..], &mut upper_axes[1..]);
}

/// A search for the nearest point, while it runs.
struct Query<'a> {
    tree: &'a Tree,
    place: &'a [f64],
    /// For each axis, the distance between the place and the part that is being visited.
    beyond: &'a mut [f64],
    nearest: Nearest,
}

impl Query<'_> {
    /// Visits the part from `first` to `end`. The squared distance of its points is at least `squared`.
    fn visit(&mut self, first: usize, end: usize, squared: f64) {
        if end - first <= LEAF {
            (first..end).for_each(|point| self.look_at(point));
            return;
        }
        let middle = first + (end - first) / 2;
        let axis = self.tree.axes[middle] as usize;
        let offset = self.place[axis] - self.tree.coordinates[middle * self.tree.dims + axis];
        let [near, far] =
            if offset < 0.0 { [(first, middle), (middle + 1, end)] } else { [(middle + 1, end), (first, middle)] };
        self.visit(near.0, near.1, squared);
        let before = self.beyond[axis];
        let squared = squared - before * before + offset * offset;
        if squared < self.nearest.squared {
            self.look_at(middle);
            self.beyond[axis] = offset;
            self.visit(far.0, far.1, squared);
            self.beyond[axis] = before;
        }
    }

    fn look_at(&mut self, point: usize) {
        let coordinates = &self.tree.coordinates[point * self.tree.dims..][..self.tree.dims];
        let squared = squared_distance(self.place, coordinates);
        self.nearest.looked_at += 1;
        if squared < self.nearest.squared {
            (self.nearest.point, self.nearest.squared) = (point as u32, squared);
        }
    }
}

/// Returns the square of the distance between two places.
pub(super) fn squared_distance(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| (a - b) * (a - b)).sum()
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// Points anywhere, or points nearly equally far from the middle, so that the nearest may be in any part of the
    /// tree.
    fn points() -> impl Strategy<Value = Vec<[f64; 2]>> {
        let anywhere = prop::collection::vec(prop::array::uniform2(0.0..=1.0f64), 1..400);
        let onto_circle = |points: Vec<[f64; 2]>| {
            let moved = |point: [f64; 2]| {
                let distance = squared_distance(&point, &[0.5; 2]).sqrt().max(1e-3);
                point.map(|x| (0.5 + (x - 0.5) * (0.45 + 0.02 * point[0]) / distance).clamp(0.0, 1.0))
            };
            points.into_iter().map(moved).collect::<Vec<_>>()
        };
        (anywhere, any::<bool>()).prop_map(move |(points, circle)| if circle { onto_circle(points) } else { points })
    }

    proptest! {
        #[test]
        fn the_nearest_point_of_the_tree_is_that_of_the_list(
            points in points(),
            mut places in prop::collection::vec(prop::array::uniform2(-0.5..=1.5f64), 50)
        ) {
            let tree = Tree::new(&PointSet::new(2, &points).unwrap());
            places.push([0.5; 2]);
            for place in places {
                let nearest = tree.nearest(&place, &mut [0.0; 2]);
                let of_list = points.iter().map(|point| squared_distance(&place, point)).fold(f64::INFINITY, f64::min);
                prop_assert!((nearest.squared - of_list).abs() <= 1e-15);
                prop_assert_eq!(squared_distance(&place, tree.point(nearest.point)), nearest.squared);
            }
        }
    }
}
