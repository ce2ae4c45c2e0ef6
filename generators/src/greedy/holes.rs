//! The large empty boxes around a place, and how well a point breaks them.

use super::room::{Room, wrap};
use paracosm_coverage::empty_boxes::EmptyBoxes;

/// The least volume of a box that counts, as a share of the largest box.
const LARGE: f64 = 0.65;

/// The large empty boxes that a point in a given room can break.
pub(super) struct Holes {
    dims: usize,
    /// `true` if the boxes go on beyond the faces of the cube.
    periodic: bool,
    /// For each box, the eighth power of the ratio of its volume to the largest volume.
    weights: Vec<f64>,
    /// For each box, axis by axis, its lower end and one over its width, which is 0 if the box goes all the way round.
    sides: Vec<(f64, f64)>,
}

impl Holes {
    /// Collects the large empty boxes that overlap the box `room`, which has a room for each coordinate. `largest` is
    /// the volume of the largest empty box, here or elsewhere, with which the boxes are compared.
    pub fn around(boxes: &EmptyBoxes, room: &[Room], largest: f64) -> Self {
        let dims = room.len();
        let mut holes = Self { dims, periodic: boxes.is_periodic(), weights: Vec::new(), sides: Vec::new() };
        for hole in boxes.larger_than(LARGE * largest) {
            if room.iter().enumerate().all(|(axis, room)| room.meets(hole.side(axis))) {
                holes.weights.push(eighth_power(hole.volume() / largest));
                let sides = (0..dims).map(|axis| hole.side(axis));
                holes.sides.extend(sides.map(|(lower, upper)| (lower, 1.0 / (upper - lower))));
            }
        }
        holes
    }

    /// Returns `true` if no large empty box overlaps the room given to [`Holes::around`].
    pub fn is_empty(&self) -> bool {
        self.weights.is_empty()
    }

    /// Returns the amount by which a new point changes the sum of the eighth powers of the boxes' volumes.
    pub fn left_by(&self, point: &[f64]) -> f64 {
        let mut sum = 0.0;
        for (weight, sides) in self.weights.iter().zip(self.sides.chunks_exact(self.dims)) {
            let shares = || sides.iter().zip(point).map(|(side, x)| self.share(*side, *x));
            if shares().all(|share| 0.0 < share && share < 1.0) {
                let parts = shares().map(|share| eighth_power(share) + eighth_power(1.0 - share));
                sum += weight * (parts.sum::<f64>() - 1.0);
            }
        }
        sum
    }

    /// The place of a coordinate in a side, as a share of the side.
    ///
    /// A point cuts a circle open, and leaves one part of the same width. The part is divided only by the next point.
    /// It counts as if the point had divided the circle in the middle, so that the place of the point does not matter.
    fn share(&self, (lower, per_width): (f64, f64), x: f64) -> f64 {
        if !self.periodic {
            (x - lower) * per_width
        } else if per_width == 0.0 {
            0.5
        } else {
            wrap(wrap(x) - lower) * per_width
        }
    }
}

fn eighth_power(x: f64) -> f64 {
    let square = x * x;
    let fourth = square * square;
    fourth * fourth
}
