//! Fill distance: the radius of the largest ball, with its centre in the unit cube, that no point has entered.
//!
//! The fill distance is also called covering radius. Designs that make it small are minimax distance designs
//! (Johnson, Moore, Ylvisaker, Minimax and maximin distance designs, J. Statistical Planning and Inference 26, 1990).
//! The centre is a vertex of the Voronoi diagram of the points, clipped to the cube. In more than a few dimensions
//! the diagram has far too many vertices to list, and most are far smaller than the largest. So the search is a
//! branch and bound over boxes of the cube that hold the centre:
//!
//! * A weighted mean of squared distances bounds all squared distances in a box, and a linear program finds the
//!   weights (`relaxation.rs`). The bound is off by at most a quarter of the sum of the squared sides of the box. As
//!   soon as the box is small enough, the solution is a vertex of the diagram. If the box is cut through this vertex,
//!   no part of the box is left above it.
//! * The weights also say which parts of the box are too near to points, and the box is shrunk by them (`search.rs`).
//! * Nearest points come from a k-d tree (`tree.rs`).
//!
//! `hunt.rs` shares boxes out to all cores, the boxes with the largest bounds first, so that the bracket is as narrow
//! as possible at a time limit.

mod hunt;
mod relaxation;
mod search;
mod tree;

use crate::measure::{Compare, Computation, Descriptor, Measure};
pub use crate::witness::Fill;
use crate::{Deadline, PointSet};
use hunt::Hunt;

impl Measure {
    /// The measure "fill", which is the radius of the largest empty ball with its centre in the cube.
    pub const FILL: Self = Self::of(&Descriptor {
        name: "fill",
        key: "fill",
        label: "fill",
        title: "fill, the radius of the largest empty ball",
        about: "the radius of the largest ball that holds no test, each parameter scaled to [0,1]",
        pace: 5,
        // Balls do not judge strategies, and the balls of greedy's points take seconds.
        compare: Compare::WhereNamed,
        method: Computation::Ball(fill),
    });
}

/// Computes the fill distance of points, which is the largest Euclidean distance of a place in `[0,1]^d` from its
/// nearest point. Returns `None` for a set without points, because no ball is then too large to be empty.
///
/// The result is exact, in any dimension, unless `deadline` cuts the search short. The radius is usually irrational,
/// and is known as a floating-point number. "Exact" means that no place in the cube is further from all points than
/// `(1 + 1e-12) radius + 4.5e-16 sqrt(d)`, which is proved with all rounding counted, and that `centre` is as far
/// away as `radius`, to the few ulps of a computed distance. If the bracket is not exact, its upper bound is rounded
/// up. Radius and centre of an exact result do not depend on the number of threads.
pub fn fill(points: &PointSet, deadline: Deadline) -> Option<Fill> {
    (!points.is_empty()).then(|| Hunt::new(points, deadline).run())
}
