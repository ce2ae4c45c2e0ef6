//! Fill distance: the radius of the largest ball, with its centre in the unit cube, that no point has entered.
//!
//! It is also called covering radius, and designs that make it small are minimax distance designs (Johnson, Moore,
//! Ylvisaker, Minimax and maximin distance designs, J. Statistical Planning and Inference 26, 1990). The centre is a
//! vertex of the Voronoi diagram of the points, clipped to the cube. The diagram has far too many vertices to list in more
//! than a few dimensions, and most are nowhere near the largest. So this is a branch and bound over boxes of the cube
//! that hold the centre:
//!
//! * A weighted mean of squared distances bounds all squared distances in a box, and a linear program finds the weights
//!   (`relaxation.rs`). It is off by no more than a quarter of the sum of the squared sides of the box, and its solution is
//!   a vertex of the diagram as soon as the box is small enough: cut through that, the box has nothing left above it.
//! * The weights also say which parts of the box are too near to points, and the box is shrunk by them (`search.rs`).
//! * Nearest points come from a k-d tree (`tree.rs`).
//!
//! `hunt.rs` shares boxes out to all cores, the ones with the largest bounds first, so that a time limit finds the
//! bracket as narrow as it can be.

mod hunt;
mod relaxation;
mod search;
mod tree;

use crate::measure::{Compare, Computation, Descriptor, Measure};
pub use crate::witness::Fill;
use crate::{Deadline, PointSet};
use hunt::Hunt;

impl Measure {
    /// The radius of the largest empty ball with its centre in the cube.
    pub const FILL: Self = Self::of(&Descriptor {
        name: "fill",
        key: "fill",
        label: "fill",
        title: "fill, the radius of the largest empty ball",
        about: "the radius of the largest ball that holds no test, each parameter scaled to [0,1]",
        pace: 5,
        // Strategies are not judged by balls, and the balls of greedy's points take seconds.
        compare: Compare::WhereNamed,
        method: Computation::Ball(fill),
    });
}

/// The largest Euclidean distance of a place in `[0,1]^d` from the point nearest to it. Of a set without points there
/// is none: no ball is too large to be empty.
///
/// Exact, in any dimension, unless `deadline` cuts the search short. The radius is irrational as a rule and is known as a
/// floating-point number: exact says that no place in the cube is further from all points than `(1 + 1e-12) radius +
/// 4.5e-16 sqrt(d)`, which is proved with all rounding counted, and that `centre` is as far as `radius`, to the few ulps
/// of a computed distance. Where the bracket is not exact, its upper end is rounded up. Radius and centre of an exact
/// result do not depend on the number of threads.
pub fn fill(points: &PointSet, deadline: Deadline) -> Option<Fill> {
    (!points.is_empty()).then(|| Hunt::new(points, deadline).run())
}
