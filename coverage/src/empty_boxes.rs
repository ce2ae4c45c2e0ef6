//! Keeps all maximal empty boxes of a set that grows point by point, and so always knows the dispersion.
//!
//! An empty box is maximal if none of its faces can move outward: each face lies in a wall of the cube or is
//! *supported* by a point in the relative interior of the face (Naamad, Lee, Hsu, On the maximum empty rectangle
//! problem, Discrete Appl. Math. 8, 1984). A new point changes only the maximal boxes that hold it strictly inside.
//! Each of these boxes is cut on either side of the point along every axis, which leaves `2d` parts. The maximal
//! empty boxes of the larger set are the boxes that were not cut and the parts that are maximal:
//!
//! * A new maximal box lies in a maximal box that held the point, so in one of the parts of that box, so it is that
//!   part.
//! * A part is maximal if its faces are supported. The face that moved lies at the point; the opposite face lost
//!   nothing. Any other face kept its support unless the support was cut away. To find that out takes a single
//!   comparison: no box is compared with another.
//! * No maximal part comes from two boxes. The two boxes would share all faces but those that moved. Then either one
//!   of them would hold the other, or the point would lie on a face of a box that holds it strictly inside.
//!
//! A face remembers one point that supports it. If coordinates tie, other points may lie in the same plane. They are
//! found in the ring of the points that share this coordinate. The method only compares coordinates and computes
//! nothing, so that ties, duplicates and points on faces are treated exactly.
//!
//! The boxes may also be *periodic*: they go on beyond a face of the cube from the opposite face, as if these faces were
//! glued together. Then there are no walls. All of the above holds for sides that are arcs of circles, with one
//! difference. A side that goes all the way round has no faces, and a point leaves one part of it, whose two faces both
//! lie at the point.
//!
//! To find the boxes that hold a point, all boxes are looked at in blocks, with an array for each end of each axis.
//! For tens of thousands of boxes that costs less than a tree.
//!
//! Within the valid part of a space, a box has the share of the valid part that it may take up, instead of its volume.
//!
//! `n` random points have `O(n (log n)^(d-1))` maximal boxes, with a factor that grows with `d` (in the worst case
//! `O(n^d)`: Backer, Keil, The mono- and bichromatic empty rectangle and square problems in all dimensions, LATIN
//! 2010). The first `n` points of the Halton sequence have this number of maximal boxes:
//!
//! | n   | d = 2 | d = 3   | d = 4     | d = 5   |
//! | --- | ----- | ------- | --------- | ------- |
//! | 64  | 600   | 5,100   | 42,000    | 290,000 |
//! | 100 | 1,000 | 10,200  |           | 940,000 |
//! | 500 | 6,700 | 108,000 | 1,900,000 |         |
//!
//! A box takes `24 d + 8` bytes. Up to about four dimensions that is little. In more dimensions, use
//! [`EmptyBoxes::at_most`]: it keeps only the larger boxes, and the bracket shows whether that was enough.

mod side;

use crate::valid::ValidPart;
use crate::{Bracket, PointSetError};
use side::Side;
use std::collections::{BTreeMap, btree_map::Entry};
use std::sync::Arc;

/// Marks a face that lies in a wall of the cube, or the missing faces of a side that goes all the way round.
const WALL: u32 = u32::MAX;

/// The number of boxes that are looked at together.
const BLOCK: usize = 128;

/// The maximal empty boxes among points in the unit cube, kept up to date while points are added one at a time.
///
/// ```
/// use paracosm_coverage::empty_boxes::EmptyBoxes;
///
/// let mut boxes = EmptyBoxes::new(2)?;
/// assert_eq!(boxes.dispersion().lower, 1.0);
/// boxes.add(&[0.25, 0.5])?;
/// assert_eq!((boxes.largest().side(0), boxes.largest().side(1)), ((0.25, 1.0), (0.0, 1.0)));
/// assert_eq!(boxes.dispersion().lower, 0.75);
/// assert_eq!(boxes.len(), 4);
/// # Ok::<(), paracosm_coverage::PointSetError>(())
/// ```
#[derive(Debug, Clone)]
pub struct EmptyBoxes {
    dims: usize,
    /// `true` if boxes go on beyond a face of the cube from the opposite face.
    periodic: bool,
    /// The valid part of the cube; `None` if the whole cube is valid.
    valid: Option<Arc<ValidPart>>,
    /// The coordinates of the points, one point after the other.
    points: Vec<f64>,
    /// For each coordinate of each point, the next point with the same coordinate; the last of them leads to the
    /// first.
    rings: Vec<u32>,
    /// For each axis, a point of each ring, by the bits of the coordinate.
    alike: Vec<BTreeMap<u64, u32>>,
    /// The ends of the boxes by axis: first the lower ends, then the upper ends.
    ends: Vec<[Vec<f64>; 2]>,
    volumes: Vec<f64>,
    /// For each box, axis by axis, the points that support its lower and its upper face.
    supports: Vec<u32>,
    /// The greatest number of boxes to keep, and the volume of the largest box that was forgotten.
    most: usize,
    forgotten: f64,
    /// The index of the largest box.
    largest: usize,
}

/// A view of a single maximal empty box among the points.
#[derive(Debug, Clone, Copy)]
pub struct EmptyBox<'a> {
    boxes: &'a EmptyBoxes,
    at: usize,
}

impl EmptyBox<'_> {
    /// Returns the lower and the upper end of the box along `axis`. If a periodic box goes on beyond 1, the upper end is
    /// above 1. If it goes all the way round, the ends are infinite.
    pub fn side(&self, axis: usize) -> (f64, f64) {
        let Side { lower, upper } = self.boxes.side(self.at, axis);
        (lower, if lower < upper { upper } else { upper + 1.0 })
    }

    /// Returns the volume of the box, as a share of the volume of the unit cube. Within a valid part, it is the greatest share of
    /// the valid part that the box may take up.
    pub fn volume(&self) -> f64 {
        self.boxes.volumes[self.at]
    }
}

impl EmptyBoxes {
    /// Makes the empty boxes of a set without points, which are a single box, the whole cube.
    ///
    /// # Errors
    /// `dims` is 0.
    pub fn new(dims: usize) -> Result<Self, PointSetError> {
        Self::at_most(dims, usize::MAX)
    }

    /// Makes the empty boxes of a set without points, with the limit that at most `most` boxes are kept. If there are
    /// more boxes, the smaller boxes are forgotten.
    ///
    /// The largest box is known for certain as long as it is larger than any box that was forgotten, because boxes
    /// only shrink.
    ///
    /// # Errors
    /// `dims` is 0.
    pub fn at_most(dims: usize, most: usize) -> Result<Self, PointSetError> {
        Self::with(dims, most, false, None)
    }

    /// Makes the periodic empty boxes of a set without points, with the same limit as [`EmptyBoxes::at_most`]. Periodic
    /// boxes go on beyond a face of the cube from the opposite face, and the coordinates 0 and 1 are the same. Along an
    /// axis, a box that a single point stops has the width 1.
    ///
    /// ```
    /// use paracosm_coverage::empty_boxes::EmptyBoxes;
    ///
    /// let mut boxes = EmptyBoxes::periodic_at_most(1, 100)?;
    /// boxes.add(&[0.25])?;
    /// assert_eq!(boxes.largest().side(0), (0.25, 1.25));
    /// boxes.add(&[0.75])?;
    /// assert_eq!(boxes.dispersion().lower, 0.5);
    /// # Ok::<(), paracosm_coverage::PointSetError>(())
    /// ```
    ///
    /// # Errors
    /// `dims` is 0.
    pub fn periodic_at_most(dims: usize, most: usize) -> Result<Self, PointSetError> {
        Self::with(dims, most, true, None)
    }

    /// Makes the empty boxes within the valid part of a cube, with the same limit as [`EmptyBoxes::at_most`]. Boxes are compared
    /// by their shares of the valid part.
    ///
    /// # Errors
    /// The cube has no dimension.
    pub fn within(valid: Arc<ValidPart>, most: usize) -> Result<Self, PointSetError> {
        Self::with(valid.dims(), most, false, Some(valid))
    }

    fn with(dims: usize, most: usize, periodic: bool, valid: Option<Arc<ValidPart>>) -> Result<Self, PointSetError> {
        if dims == 0 {
            return Err(PointSetError::NoDimension);
        }
        let Side { lower, upper } = if periodic { Side::ROUND } else { Side::WALL_TO_WALL };
        Ok(Self {
            dims,
            periodic,
            valid,
            points: Vec::new(),
            rings: Vec::new(),
            alike: vec![BTreeMap::new(); dims],
            ends: vec![[vec![lower], vec![upper]]; dims],
            volumes: vec![1.0],
            supports: vec![WALL; 2 * dims],
            most: most.max(1),
            forgotten: 0.0,
            largest: 0,
        })
    }

    /// Adds a point to the set, and divides the empty boxes that hold the point.
    ///
    /// # Errors
    /// The point has another number of coordinates, or a coordinate is not in `[0,1]`. The boxes are then unchanged.
    pub fn add(&mut self, point: &[f64]) -> Result<(), PointSetError> {
        let index = self.points.len() / self.dims;
        if point.len() != self.dims {
            return Err(PointSetError::Ragged { index, found: point.len(), expected: self.dims });
        }
        if let Some(axis) = point.iter().position(|x| !(0.0..=1.0).contains(x)) {
            return Err(PointSetError::OutsideCube { index, axis, value: point[axis] });
        }
        let point: Vec<f64> = point.iter().map(|&x| if self.periodic && x == 1.0 { 0.0 } else { x }).collect();
        let point = &point[..];
        let split = self.holding(point);
        let index = index as u32;
        self.join_rings(point, index);
        self.points.extend_from_slice(point);
        if split.is_empty() {
            return Ok(());
        }
        let parts = self.volumes.len();
        for &at in &split {
            self.push_parts(at, point, index, false);
            if self.volumes.len() - parts > self.most {
                self.forget_smaller(parts);
            }
        }
        if self.volumes.len() == split.len() {
            // The maximal boxes around these parts have been forgotten: non-maximal boxes are better than none.
            self.push_parts(split[0], point, index, true);
        }
        // From the back, so that the box that takes a removed box's place is never one that must be removed.
        for &at in split.iter().rev() {
            self.remove(at);
        }
        if self.volumes.len() > self.most {
            self.forget_smaller(0);
        }
        self.find_largest();
        Ok(())
    }

    /// Returns the largest empty box among the points added so far.
    pub fn largest(&self) -> EmptyBox<'_> {
        EmptyBox { boxes: self, at: self.largest }
    }

    /// Returns the dispersion of the points added so far. It is exact unless a box was forgotten that is larger than
    /// all boxes that are left.
    pub fn dispersion(&self) -> Bracket {
        let largest = self.largest().volume();
        if let Some(valid) = &self.valid {
            let least = valid.least_share(|axis| self.largest().side(axis));
            return Bracket { lower: least.min(largest), upper: largest.max(self.forgotten) };
        }
        let lower = largest;
        if self.forgotten <= lower {
            return Bracket::exact(lower);
        }
        // Each factor and each product may have lost half an ulp.
        let upper = self.forgotten * (1.0 + 2.0 * self.dims as f64 * f64::EPSILON);
        Bracket { lower, upper: upper.min(1.0) }
    }

    /// Returns `true` if boxes go on beyond a face of the cube from the opposite face.
    pub fn is_periodic(&self) -> bool {
        self.periodic
    }

    /// Returns the number of empty boxes that are kept, which is at least 1.
    #[expect(clippy::len_without_is_empty, reason = "never empty")]
    pub fn len(&self) -> usize {
        self.volumes.len()
    }

    /// Iterates over the kept empty boxes that are larger than `volume`.
    pub fn larger_than(&self, volume: f64) -> impl Iterator<Item = EmptyBox<'_>> {
        let found = self.volumes.iter().enumerate().filter(move |(_, other)| **other > volume);
        found.map(|(at, _)| EmptyBox { boxes: self, at })
    }

    fn side(&self, at: usize, axis: usize) -> Side {
        let [lower, upper] = &self.ends[axis];
        Side { lower: lower[at], upper: upper[at] }
    }

    /// Enters the point that will have this index into the rings of the points that share a coordinate with it.
    fn join_rings(&mut self, point: &[f64], index: u32) {
        for (axis, x) in point.iter().enumerate() {
            // Adding 0 turns -0 into 0.
            let next = match self.alike[axis].entry((x + 0.0).to_bits()) {
                Entry::Occupied(alike) => {
                    std::mem::replace(&mut self.rings[*alike.get() as usize * self.dims + axis], index)
                }
                Entry::Vacant(unique) => *unique.insert(index),
            };
            self.rings.push(next);
        }
    }

    /// The boxes that hold a point strictly inside, in ascending order.
    fn holding(&self, point: &[f64]) -> Vec<usize> {
        let mut found = Vec::new();
        for start in (0..self.volumes.len()).step_by(BLOCK) {
            let size = BLOCK.min(self.volumes.len() - start);
            // As wide as a coordinate: vectors of them are compared without packing and unpacking.
            let mut inside = [u64::MAX; BLOCK];
            for ([lower, upper], x) in self.ends.iter().zip(point) {
                let ends = lower[start..][..size].iter().zip(&upper[start..][..size]);
                // As in `Side::holds`, without a jump.
                if self.periodic {
                    for (inside, (lower, upper)) in inside.iter_mut().zip(ends) {
                        let is_inside = ((lower < x) == (x < upper)) == (lower < upper);
                        *inside &= if is_inside { u64::MAX } else { 0 };
                    }
                } else {
                    for (inside, (lower, upper)) in inside.iter_mut().zip(ends) {
                        *inside &= if (lower < x) & (x < upper) { u64::MAX } else { 0 };
                    }
                }
            }
            found.extend((0..size).filter(|i| inside[*i] != 0).map(|i| start + i));
        }
        found
    }

    /// Appends the parts of a box that the point at `index` leaves: all parts if `all`, otherwise the maximal parts.
    fn push_parts(&mut self, at: usize, point: &[f64], index: u32, all: bool) {
        let dims = self.dims;
        let mut part: Vec<Side> = (0..dims).map(|axis| self.side(at, axis)).collect();
        let first = 2 * dims * at;
        for (axis, &x) in point.iter().enumerate() {
            let whole = part[axis];
            for (side, moved) in whole.without(x) {
                part[axis] = side;
                let start = self.supports.len();
                self.supports.extend_from_within(first..first + 2 * dims);
                self.supports[start + 2 * axis..][moved].fill(index);
                if self.keep_supports(start, axis, &part) || all {
                    for ([lower, upper], side) in self.ends.iter_mut().zip(&part) {
                        lower.push(side.lower);
                        upper.push(side.upper);
                    }
                    self.volumes.push(match &self.valid {
                        None => part.iter().map(|side| side.width()).product(),
                        Some(valid) => valid.greatest_share_of(|axis| (part[axis].lower, part[axis].upper)),
                    });
                } else {
                    self.supports.truncate(start);
                }
            }
            part[axis] = whole;
        }
    }

    /// Checks that all faces of a part are supported after its side along `axis` was cut. Replaces supports that were
    /// cut away.
    fn keep_supports(&mut self, start: usize, axis: usize, part: &[Side]) -> bool {
        let dims = self.dims;
        for face in (0..2 * dims).filter(|face| face / 2 != axis) {
            let support = self.supports[start + face];
            if support == WALL {
                continue;
            }
            let x = self.points[support as usize * dims + axis];
            if part[axis].holds(x) {
                continue;
            }
            match self.other_support(support, face / 2, part) {
                Some(other) => self.supports[start + face] = other,
                None => return false,
            }
        }
        true
    }

    /// Another point in the same plane across `axis` as `support` that lies within the part's other sides.
    fn other_support(&self, support: u32, axis: usize, part: &[Side]) -> Option<u32> {
        let dims = self.dims;
        let next = |point: &u32| Some(self.rings[*point as usize * dims + axis]);
        let others = std::iter::successors(next(&support), next).take_while(|point| *point != support);
        let supports = |point: &u32| {
            let coordinates = &self.points[*point as usize * dims..][..dims];
            let sides = part.iter().zip(coordinates).enumerate();
            sides.filter(|(other, _)| *other != axis).all(|(_, (side, x))| side.holds(*x))
        };
        others.into_iter().find(supports)
    }

    fn remove(&mut self, at: usize) {
        let last = self.volumes.len() - 1;
        for [lower, upper] in &mut self.ends {
            lower.swap_remove(at);
            upper.swap_remove(at);
        }
        self.volumes.swap_remove(at);
        let faces = 2 * self.dims;
        self.supports.copy_within(faces * last.., faces * at);
        self.supports.truncate(faces * last);
    }

    /// Forgets the smaller half of the boxes at `from` and after, which are more than `most`.
    fn forget_smaller(&mut self, from: usize) {
        let mut volumes = self.volumes[from..].to_vec();
        let (_, &mut middle, _) = volumes.select_nth_unstable_by(self.most / 2, |a, b| b.total_cmp(a));
        self.forgotten = self.forgotten.max(middle);
        for at in (from..self.volumes.len()).rev() {
            if self.volumes[at] <= middle && self.volumes.len() > from + 1 {
                self.remove(at);
            }
        }
    }

    fn find_largest(&mut self) {
        // Several maxima side by side: a single maximum would have to wait for itself at every step.
        let mut largest = [0.0; 16];
        for volumes in self.volumes.chunks(largest.len()) {
            for (largest, volume) in largest.iter_mut().zip(volumes) {
                *largest = if *volume > *largest { *volume } else { *largest };
            }
        }
        let largest = largest.into_iter().fold(0.0, f64::max);
        let at = self.volumes.iter().position(|volume| *volume == largest);
        self.largest = at.expect("one of the volumes");
    }
}
