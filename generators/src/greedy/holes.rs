//! The large empty boxes around a place, and how well a point breaks them.

use paracosm_coverage::empty_boxes::EmptyBoxes;

/// The least volume of a box that counts, as a share of the largest box.
const LARGE: f64 = 0.65;

/// The large empty boxes that a point in a given room can break.
pub(super) struct Holes {
    dims: usize,
    /// For each box, the eighth power of the ratio of its volume to the largest volume.
    weights: Vec<f64>,
    /// For each box, axis by axis, its lower end and one over its width.
    sides: Vec<(f64, f64)>,
}

impl Holes {
    /// Collects the large empty boxes that overlap the box `room`. The room has a lower end and a width along each
    /// axis. `largest` is the volume of the largest empty box, here or elsewhere, with which the boxes are compared.
    pub fn around(boxes: &EmptyBoxes, room: &[(f64, f64)], largest: f64) -> Self {
        let dims = room.len();
        let mut holes = Self { dims, weights: Vec::new(), sides: Vec::new() };
        for hole in boxes.larger_than(LARGE * largest) {
            let meets = |(axis, (from, width)): (usize, &(f64, f64))| {
                let (lower, upper) = hole.side(axis);
                lower < from + width && *from < upper
            };
            if room.iter().enumerate().all(meets) {
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
            let shares = || sides.iter().zip(point).map(|((lower, per_width), x)| (x - lower) * per_width);
            if shares().all(|share| 0.0 < share && share < 1.0) {
                let parts = shares().map(|share| eighth_power(share) + eighth_power(1.0 - share));
                sum += weight * (parts.sum::<f64>() - 1.0);
            }
        }
        sum
    }
}

fn eighth_power(x: f64) -> f64 {
    let square = x * x;
    let fourth = square * square;
    fourth * fourth
}
