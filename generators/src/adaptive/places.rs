//! Places of a mixed cube: moved to the middle of their slices, or moved a little.

use super::cube::{Axis, level, middle};
use super::normal;
use rand::Rng;

/// Returns the place in the cube with each discrete coordinate moved to the middle of its slice.
pub(super) fn snapped(axes: &[Axis], mut at: Vec<f64>) -> Vec<f64> {
    for (u, axis) in at.iter_mut().zip(axes) {
        *u = match *axis {
            Axis::Continuous => u.clamp(0.0, 1.0_f64.next_down()),
            Axis::Ordered(levels) | Axis::Nominal(levels) => middle(level(*u, levels), levels),
        };
    }
    at
}

/// Returns a random place near a given place. Some coordinates move by normally distributed steps, and now and then a
/// word is replaced.
pub(super) fn nudged(axes: &[Axis], from: &[f64], step: f64, rng: &mut impl Rng) -> Vec<f64> {
    let share = (3.0 / axes.len() as f64).clamp(0.3, 1.0);
    let one = rng.random_range(0..axes.len());
    let mut at = from.to_vec();
    for (index, (u, axis)) in at.iter_mut().zip(axes).enumerate() {
        if index != one && rng.random::<f64>() >= share {
            continue;
        }
        *u = match *axis {
            Axis::Continuous => *u + step * normal(rng),
            Axis::Ordered(levels) => *u + step.max(0.7 / levels as f64) * normal(rng),
            Axis::Nominal(_) if rng.random::<f64>() < 0.3 => rng.random(),
            Axis::Nominal(_) => *u,
        };
    }
    snapped(axes, at)
}
