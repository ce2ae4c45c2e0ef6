//! Checks whether two elements cover the same ground.
//!
//! The ground of every element is cut into convex quadrilaterals along its strips. The overlap of two quadrilaterals is
//! the smallest movement that separates them; this movement is across one of their sides (separating axis theorem).

use super::bounds::{Bounds, Tree};
use super::composite::Composite;
use super::error::RoadError;
use super::layout::Layout;
use super::strip::Surface;
use crate::geometry::Pose;
use nalgebra::Vector2;
use std::sync::Arc;

type Quad = [Vector2<f64>; 4];

/// The largest distance in metres of a quadrilateral's sides from the curve that they follow.
const FAITHFUL: f64 = 0.01;
/// The largest allowed overlap in metres. Connected elements touch each other, and a loop may close with a gap.
const ALLOWED: f64 = 0.05;

/// The ground of an element at its place.
struct Ground {
    bounds: Bounds,
    quads: Vec<(Bounds, Quad)>,
}

/// Refuses a composite in which two elements cover the same ground.
pub(super) fn check(composite: &Composite, layouts: &[Arc<Layout>]) -> Result<(), RoadError> {
    let grounds: Vec<Ground> =
        composite.parts.iter().zip(layouts).map(|(part, layout)| ground(layout, &part.pose)).collect();
    let tree = Tree::new(&grounds.iter().map(|ground| ground.bounds).collect::<Vec<_>>());
    for (i, ground) in grounds.iter().enumerate() {
        let mut near = tree.near(&ground.bounds);
        near.sort_unstable();
        for j in near.into_iter().map(|j| j as usize).filter(|j| *j > i) {
            if let Some(at) = meeting(ground, &grounds[j]) {
                let name = |index: usize| composite.parts[index].name.clone();
                return Err(RoadError::Overlap { a: name(i), b: name(j), at: (at.x, at.y) });
            }
        }
    }
    Ok(())
}

fn ground(layout: &Layout, pose: &Pose) -> Ground {
    let mut quads = Vec::new();
    for strip in &layout.strips {
        if matches!(strip.surface, Surface::Carriageway | Surface::Sidewalk) {
            let (right, left) = strip.moved(pose).sides(FAITHFUL);
            for i in 1..right.len() {
                let quad = [right[i - 1], right[i], left[i], left[i - 1]];
                quads.push((Bounds::around(quad), quad));
            }
        }
    }
    let bounds = quads.iter().fold(Bounds::empty(), |all, (bounds, _)| all.union(bounds));
    Ground { bounds, quads }
}

/// Returns a point where two grounds overlap.
fn meeting(one: &Ground, other: &Ground) -> Option<Vector2<f64>> {
    let near = other.quads.iter().filter(|(bounds, _)| bounds.meets(&one.bounds));
    let near: Vec<_> = near.collect();
    for (bounds, quad) in one.quads.iter().filter(|(bounds, _)| bounds.meets(&other.bounds)) {
        for (other_bounds, other_quad) in &near {
            if bounds.meets(other_bounds) && overlap(quad, other_quad) > ALLOWED {
                let common = [bounds.min.sup(&other_bounds.min), bounds.max.inf(&other_bounds.max)];
                return Some(0.5 * (common[0] + common[1]));
            }
        }
    }
    None
}

/// Returns the smallest movement that separates two convex quadrilaterals; negative if they are apart already.
fn overlap(one: &Quad, other: &Quad) -> f64 {
    let mut least = f64::INFINITY;
    for quad in [one, other] {
        for i in 0..4 {
            let side = quad[(i + 1) % 4] - quad[i];
            let length = side.norm();
            if length == 0.0 {
                continue;
            }
            let across = Vector2::new(side.y, -side.x) / length;
            let range = |quad: &Quad| {
                let along = quad.map(|corner| corner.dot(&across));
                along.into_iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(lo, hi), x| (lo.min(x), hi.max(x)))
            };
            let ((a, b), (c, d)) = (range(one), range(other));
            least = least.min((b - c).min(d - a));
            if least <= 0.0 {
                return least;
            }
        }
    }
    least
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// A piece of a strip somewhere: as wide at both ends, or not, as on an arc.
    fn quad() -> impl Strategy<Value = Quad> {
        let place = (-5.0..5.0f64, -5.0..5.0f64, -4.0..4.0f64);
        (place, 0.5..6.0f64, 0.5..6.0f64, 0.5..6.0f64).prop_map(|((x, y, heading), length, begin, end)| {
            let pose = Pose { position: Vector2::new(x, y), heading };
            let corners = [(0.0, -0.5 * begin), (length, -0.5 * end), (length, 0.5 * end), (0.0, 0.5 * begin)];
            corners.map(|(x, y)| pose.then(&Pose { position: Vector2::new(x, y), heading: 0.0 }).position)
        })
    }

    fn holds(quad: &Quad, point: Vector2<f64>) -> bool {
        (0..4).all(|i| (quad[(i + 1) % 4] - quad[i]).perp(&(point - quad[i])) >= 0.0)
    }

    /// Returns true if one of many points of `one` lies in `other`.
    fn meet_by_sampling(one: &Quad, other: &Quad) -> bool {
        const STEPS: usize = 80;
        let share = |i: usize| i as f64 / STEPS as f64;
        let point = |u: f64, v: f64| one[0].lerp(&one[1], u).lerp(&one[3].lerp(&one[2], u), v);
        (0..=STEPS).any(|i| (0..=STEPS).any(|j| holds(other, point(share(i), share(j)))))
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(512))]

        #[test]
        fn two_quadrilaterals_overlap_exactly_where_they_have_a_point_in_common(one in quad(), other in quad()) {
            let overlap = overlap(&one, &other);
            // How far apart they are is not asked, only whether.
            prop_assert_eq!(overlap.max(0.0), super::overlap(&other, &one).max(0.0));
            if overlap <= 0.0 {
                prop_assert!(!meet_by_sampling(&one, &other), "{overlap}");
            } else if overlap > 0.3 {
                prop_assert!(meet_by_sampling(&one, &other), "{overlap}");
            }
        }
    }
}
