//! Points in three or more dimensions, sorted along each axis, and the boxes at the origin whose corners lie at coordinates of points.
//!
//! Only such boxes matter for the star discrepancy: a box with too few points grows until its faces reach points, and a box with too many points shrinks to
//! its points (Niederreiter, Random Number Generation and Quasi-Monte Carlo Methods, 1992, section 2.1).

use rand::Rng;

/// Points by axis, in the order of their coordinates along each axis.
#[derive(Debug, Clone)]
pub(super) struct Spots {
    /// The coordinates of all points along each axis, and 1 as the coordinate after the last point: the face of a box that reaches the end.
    axes: Vec<Vec<f64>>,
    /// The points along each axis from the lowest coordinate to the highest.
    orders: Vec<Vec<u32>>,
}

/// The kind of a box.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(super) enum Kind {
    /// The box is open, and may have too few points.
    Empty,
    /// The box is closed, and may have too many points.
    Full,
}

/// A box at the origin. Along each axis, its face has the coordinate of a point, or of the end after the last point.
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
pub(super) struct Corner {
    pub kind: Kind,
    pub faces: Vec<u32>,
}

impl Kind {
    /// Returns true if a coordinate is outside a box with a face at a position.
    pub fn is_beyond(self, coordinate: f64, position: f64) -> bool {
        match self {
            Self::Empty => coordinate >= position,
            Self::Full => coordinate > position,
        }
    }

    /// Returns the difference between the volume of a box and its share of the points, which is positive if the box has too few or too many points.
    pub fn difference(self, volume: f64, share: f64) -> f64 {
        match self {
            Self::Empty => volume - share,
            Self::Full => share - volume,
        }
    }
}

impl Corner {
    /// Returns true if the box may have too few points, so that points inside help.
    pub fn is_empty(&self) -> bool {
        self.kind == Kind::Empty
    }
}

impl Spots {
    /// Makes the points from their coordinates.
    pub fn new(points: &[Vec<f64>], dims: usize) -> Self {
        let axis = |axis: usize| points.iter().map(|point| point[axis]).chain([1.0]).collect::<Vec<f64>>();
        let axes: Vec<Vec<f64>> = (0..dims).map(axis).collect();
        let order = |axis: &Vec<f64>| {
            let mut order: Vec<u32> = (0..points.len() as u32).collect();
            order.sort_by(|&i, &k| axis[i as usize].total_cmp(&axis[k as usize]));
            order
        };
        Self { orders: axes.iter().map(order).collect(), axes }
    }

    /// Returns the number of points.
    pub fn len(&self) -> usize {
        self.orders[0].len()
    }

    /// Returns the number of dimensions.
    pub fn dims(&self) -> usize {
        self.axes.len()
    }

    /// Returns the coordinate of a point along an axis, and 1 for the end.
    pub fn at(&self, axis: usize, point: u32) -> f64 {
        self.axes[axis][point as usize]
    }

    /// Returns the points.
    pub fn points(&self) -> Vec<Vec<f64>> {
        (0..self.len()).map(|point| self.axes.iter().map(|axis| axis[point]).collect()).collect()
    }

    /// Moves a point along an axis.
    pub fn place(&mut self, axis: usize, point: u32, coordinate: f64) {
        let (along, order) = (&mut self.axes[axis], &mut self.orders[axis]);
        along[point as usize] = coordinate;
        let mut at = order.iter().position(|&other| other == point).expect("the order has all points");
        while at > 0 && along[order[at - 1] as usize] > coordinate {
            order.swap(at, at - 1);
            at -= 1;
        }
        while at + 1 < order.len() && along[order[at + 1] as usize] < coordinate {
            order.swap(at, at + 1);
            at += 1;
        }
    }

    /// Counts the points in a box.
    pub fn count(&self, corner: &Corner) -> usize {
        let is_inside = |point: &u32| {
            corner
                .faces
                .iter()
                .enumerate()
                .all(|(axis, &face)| !corner.kind.is_beyond(self.at(axis, *point), self.at(axis, face)))
        };
        (0..self.len() as u32).filter(is_inside).count()
    }

    /// Counts the points, but one, that a box loses or gains if its face along an axis moves between two places.
    pub fn count_between(&self, corner: &Corner, axis: usize, (low, high): (f64, f64), but: u32) -> usize {
        let (kind, along, order) = (corner.kind, &self.axes[axis], &self.orders[axis]);
        let first = order.partition_point(|&point| !kind.is_beyond(along[point as usize], low));
        let passed = order[first..].iter().take_while(|&&point| !kind.is_beyond(along[point as usize], high));
        let is_beside = |point: u32| {
            let mut faces = corner.faces.iter().enumerate();
            faces.all(|(other, &face)| other == axis || !kind.is_beyond(self.at(other, point), self.at(other, face)))
        };
        passed.filter(|&&point| point != but && is_beside(point)).count()
    }

    /// Returns the volume of a box.
    pub fn volume(&self, corner: &Corner) -> f64 {
        corner.faces.iter().enumerate().map(|(axis, &face)| self.at(axis, face)).product()
    }

    /// Returns a random box whose volume is roughly evenly distributed.
    pub fn random_corner(&self, rng: &mut impl Rng) -> Corner {
        let kind = if rng.random() { Kind::Empty } else { Kind::Full };
        let face = |axis: usize| {
            let width = libm::pow(rng.random(), 1.0 / self.dims() as f64);
            let order = &self.orders[axis];
            let after = order.partition_point(|&point| self.at(axis, point) < width);
            match kind {
                Kind::Empty => order.get(after).copied().unwrap_or(self.len() as u32),
                Kind::Full => order[after.min(order.len() - 1)],
            }
        };
        Corner { kind, faces: (0..self.dims()).map(face).collect() }
    }

    /// Moves one face after another to its best place, until no face can do better. Returns the difference of the box.
    pub fn climb(&self, corner: &mut Corner, outside: &mut Vec<u8>) -> f64 {
        let kind = corner.kind;
        outside.clear();
        outside.resize(self.len(), 0);
        for (axis, &face) in corner.faces.iter().enumerate() {
            let position = self.at(axis, face);
            for (outside, &coordinate) in outside.iter_mut().zip(&self.axes[axis]) {
                *outside += u8::from(kind.is_beyond(coordinate, position));
            }
        }
        let (mut best, mut unmoved) = (f64::NEG_INFINITY, 0);
        for axis in (0..self.dims()).cycle() {
            let (difference, face) = self.best_face(corner, axis, outside);
            if difference > best {
                (best, unmoved) = (difference, 0);
                let (from, to) = (self.at(axis, corner.faces[axis]), self.at(axis, face));
                for (outside, &coordinate) in outside.iter_mut().zip(&self.axes[axis]) {
                    *outside -= u8::from(kind.is_beyond(coordinate, from));
                    *outside += u8::from(kind.is_beyond(coordinate, to));
                }
                corner.faces[axis] = face;
            } else {
                unmoved += 1;
            }
            if unmoved >= self.dims() {
                return best;
            }
        }
        best
    }

    /// Returns the best place of a face while the others stay, with the difference there. `outside` has the number of axes along which each point is outside.
    fn best_face(&self, corner: &Corner, axis: usize, outside: &[u8]) -> (f64, u32) {
        let Corner { kind, ref faces } = *corner;
        let others: f64 =
            (0..self.dims()).filter(|&other| other != axis).map(|other| self.at(other, faces[other])).product();
        let (along, points) = (&self.axes[axis], self.len() as f64);
        let now = along[faces[axis] as usize];
        let (mut best, mut count) = ((f64::NEG_INFINITY, faces[axis]), 0_u32);
        for &point in &self.orders[axis] {
            let coordinate = along[point as usize];
            if outside[point as usize] > u8::from(kind.is_beyond(coordinate, now)) {
                continue;
            }
            let before = count;
            count += 1;
            let inside = if kind == Kind::Empty { before } else { count };
            let difference = kind.difference(others * coordinate, f64::from(inside) / points);
            if difference > best.0 {
                best = (difference, point);
            }
        }
        let at_end = kind.difference(others, f64::from(count) / points);
        if kind == Kind::Empty && at_end > best.0 { (at_end, self.len() as u32) } else { best }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::seeded::{Purpose, seeded};
    use paracosm_coverage::star::star_discrepancy;
    use paracosm_coverage::{Deadline, PointSet};

    /// All boxes whose corners lie at coordinates of points or at the end.
    fn corners(spots: &Spots) -> Vec<Corner> {
        let (n, dims) = (spots.len() as u32, spots.dims() as u32);
        let choices = (n + 1).pow(dims);
        let faces = |number: u32| (0..dims).map(|axis| number / (n + 1).pow(axis) % (n + 1)).collect::<Vec<u32>>();
        (0..choices)
            .flat_map(|number| [Kind::Empty, Kind::Full].map(|kind| Corner { kind, faces: faces(number) }))
            .collect()
    }

    #[test]
    fn the_worst_box_has_the_star_discrepancy_and_no_climb_is_above_it() {
        let mut rng = seeded(6, Purpose::Search, 0);
        for (n, dims) in [(1, 3), (4, 3), (9, 3), (5, 4)] {
            let points: Vec<Vec<f64>> = (0..n).map(|_| (0..dims).map(|_| rng.random()).collect()).collect();
            let spots = Spots::new(&points, dims);
            let star = star_discrepancy(&PointSet::new(dims, &points).unwrap(), Deadline::never()).upper;
            let difference = |corner: &Corner| {
                corner.kind.difference(spots.volume(corner), spots.count(corner) as f64 / f64::from(n))
            };
            let worst = corners(&spots).iter().map(difference).fold(0.0, f64::max);
            assert!((worst - star).abs() < 1e-12, "{worst} of {n} points, and {star}");
            let (mut outside, mut highest) = (Vec::new(), 0.0_f64);
            for _ in 0..200 {
                let mut corner = spots.random_corner(&mut rng);
                let before = difference(&corner);
                let climbed = spots.climb(&mut corner, &mut outside);
                assert!(
                    (climbed - difference(&corner)).abs() < 1e-12
                        && climbed >= before - 1e-12
                        && climbed <= star + 1e-12
                );
                highest = highest.max(climbed);
            }
            assert!((highest - star).abs() < 1e-12, "200 climbs find the worst of few boxes");
        }
    }
}
