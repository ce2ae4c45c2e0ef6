//! The dispersion within the valid part of the cube.
//!
//! Two searches give the bracket. The one looks for the box with the most that is certainly valid: its share is a lower bound,
//! and the box is a witness. The other looks for the box with the most that is not certainly invalid: its share is an upper
//! bound. If the valid part is exact, both searches are the same, and the result is exact.

use super::hunt::Hunt;
use super::side::{Side, Valid, Weight};
use super::{Dispersion, LargestEmptyBox, gaps, slab};
use crate::valid::{Bound, ValidPart};
use crate::{Bracket, Deadline, PointSet};

/// The share of the time for the search for a witness.
const WITNESS: f64 = 0.4;

/// Returns the dispersion of points within the valid part.
pub(super) fn largest(
    points: &PointSet,
    valid: &ValidPart,
    deadline: Deadline,
    watch: &mut dyn FnMut(Bracket),
) -> Dispersion {
    let certain = Hunt::new(points, Valid(valid, Bound::Certain), heaviest(points, valid, Bound::Certain), 0.0);
    if valid.is_exact() {
        let shares = |volume: Bracket| Bracket {
            lower: valid.greatest_share(volume.lower),
            upper: valid.greatest_share(volume.upper),
        };
        let Dispersion { volume, witness } = certain.run(deadline, &mut |volume| watch(shares(volume)));
        return Dispersion { volume: shares(volume), witness };
    }
    let witness = certain.run(deadline.part(WITNESS), &mut |_| ()).witness;
    let lower = share(valid, &witness);
    watch(Bracket { lower, upper: 1.0 });
    let begun = heaviest(points, valid, Bound::Possible);
    let possible = Hunt::new(points, Valid(valid, Bound::Possible), begun, 0.0);
    let bracket = |volume: Bracket| Bracket { lower, upper: valid.greatest_share(volume.upper).max(lower) };
    let found = possible.run(deadline, &mut |volume| watch(bracket(volume)));
    let other = share(valid, &found.witness);
    let Bracket { lower, upper } = bracket(found.volume);
    let (lower, witness) = if other > lower { (other, found.witness) } else { (lower, witness) };
    Dispersion { volume: Bracket { lower, upper: upper.max(lower) }, witness }
}

/// Returns the dispersion of points within the valid part; `None` if the search proves that it is at most `above`.
pub(super) fn larger_than(points: &PointSet, valid: &ValidPart, above: f64, deadline: Deadline) -> Option<Dispersion> {
    let weight = valid.weight_for(above.max(0.0));
    let begun = heaviest(points, valid, Bound::Possible);
    let none = Hunt::new(points, Valid(valid, Bound::Possible), begun, weight).finds_none(weight, deadline);
    if none == Some(true) {
        return None;
    }
    Some(largest(points, valid, deadline, &mut |_| ()))
}

/// Returns the least share of the valid part that a box takes up.
fn share(valid: &ValidPart, found: &LargestEmptyBox) -> f64 {
    valid.least_share(|axis| (found.lower[axis], found.upper[axis]))
}

/// Returns the heaviest of the gaps between neighbouring coordinates. A search starts from this candidate.
fn heaviest(points: &PointSet, valid: &ValidPart, bound: Bound) -> LargestEmptyBox {
    let weight = Valid(valid, bound);
    let of = |gap| {
        let slab = slab(points.dims(), gap);
        let sides: Vec<Side> =
            slab.lower.iter().zip(&slab.upper).map(|(&lower, &upper)| Side::between(lower, upper)).collect();
        (weight.of(&sides), slab)
    };
    gaps(points).map(of).max_by(|a, b| a.0.total_cmp(&b.0)).expect("0 and 1 are apart").1
}
