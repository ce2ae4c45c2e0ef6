//! The distance of two bodies, seen from above: distances between rectangles and discs in 64 bits.

use super::body::Outline;
use nalgebra::Vector2;
use paracosm_road::{Frame, Pose};

/// An outline in the ground plane, with its axes, which are computed once.
struct Footprint<'a> {
    outline: &'a Outline,
    position: Vector2<f64>,
    frame: Frame,
}

impl<'a> Footprint<'a> {
    fn of((outline, pose): (&'a Outline, &Pose)) -> Self {
        Self { outline, position: pose.position, frame: pose.frame() }
    }

    fn corners(&self) -> [Vector2<f64>; 4] {
        let (half, forward) = (self.outline.half_extent(), self.frame.ahead());
        let (ahead, left) = (forward * half.x, Vector2::new(-forward.y, forward.x) * half.y);
        let (front, back) = ([ahead + left, ahead - left], [-ahead - left, -ahead + left]);
        [self.position + front[0], self.position + front[1], self.position + back[0], self.position + back[1]]
    }

    /// Returns the distance in metres from the outline to a point; 0 if the point is inside.
    fn to_point(&self, point: Vector2<f64>) -> f64 {
        match self.outline {
            Outline::Rectangle { .. } => {
                let beyond = self.frame.to_local(point).abs() - self.outline.half_extent();
                beyond.sup(&Vector2::zeros()).norm()
            }
            Outline::Disc { radius } => ((point - self.position).norm() - radius).max(0.0),
        }
    }

    /// Returns `true` if all of these corners lie beyond one side of the rectangle.
    fn is_apart_from(&self, corners: &[Vector2<f64>; 4]) -> bool {
        let half = self.outline.half_extent();
        let (mut least, mut most) = (Vector2::repeat(f64::INFINITY), Vector2::repeat(f64::NEG_INFINITY));
        for corner in corners {
            let seen = self.frame.to_local(*corner);
            (least, most) = (least.inf(&seen), most.sup(&seen));
        }
        (0..2).any(|axis| least[axis] > half[axis] || most[axis] < -half[axis])
    }
}

/// Returns the distance in metres between the areas that two bodies cover; 0 if they touch or overlap.
pub(crate) fn gap(a: (&Outline, &Pose), b: (&Outline, &Pose)) -> f64 {
    match (a.0, b.0) {
        (_, Outline::Disc { radius }) => (Footprint::of(a).to_point(b.1.position) - radius).max(0.0),
        (Outline::Disc { radius }, _) => (Footprint::of(b).to_point(a.1.position) - radius).max(0.0),
        (Outline::Rectangle { .. }, Outline::Rectangle { .. }) => {
            let (a, b) = (Footprint::of(a), Footprint::of(b));
            let corners = [a.corners(), b.corners()];
            // Most rectangles are far from each other. Two rectangles are apart exactly if one lies wholly beyond a side of the other.
            let reach = a.outline.reach_at_most() + b.outline.reach_at_most();
            let is_near = (a.position - b.position).norm_squared() <= reach * reach;
            if is_near && !a.is_apart_from(&corners[1]) && !b.is_apart_from(&corners[0]) {
                return 0.0;
            }
            // If two convex polygons are apart, one of their corners is nearest to the other polygon.
            let nearest = |from: &Footprint<'_>, corners: &[Vector2<f64>; 4]| {
                corners.iter().map(|corner| from.to_point(*corner)).fold(f64::INFINITY, f64::min)
            };
            nearest(&a, &corners[1]).min(nearest(&b, &corners[0]))
        }
    }
}

/// Returns `true` if the straight line between two points crosses the area that a body covers.
pub(crate) fn crosses((outline, pose): (&Outline, &Pose), from: Vector2<f64>, to: Vector2<f64>) -> bool {
    // Most bodies are far from the line. These tests need no sine. Their margins are far above all rounding.
    let around = outline.reach_at_most() + 1e-3;
    let beside = |axis: usize| {
        let (at, from, to) = (pose.position[axis], from[axis], to[axis]);
        at < from.min(to) - around || at > from.max(to) + around
    };
    if beside(0) || beside(1) {
        return false;
    }
    let (way, towards) = (to - from, pose.position - from);
    let length = way.norm_squared();
    let nearest = if length > 0.0 { way * (towards.dot(&way) / length).clamp(0.0, 1.0) } else { Vector2::zeros() };
    if (towards - nearest).norm() > outline.reach() + 1e-3 {
        return false;
    }
    let frame = pose.frame();
    let (from, to) = (frame.to_local(from), frame.to_local(to));
    let way = to - from;
    match outline {
        Outline::Rectangle { .. } => {
            let half = outline.half_extent();
            let (mut begin, mut end) = (0.0_f64, 1.0_f64);
            for axis in 0..2 {
                if way[axis] == 0.0 {
                    if from[axis].abs() > half[axis] {
                        return false;
                    }
                } else {
                    let sides = [-half[axis], half[axis]].map(|side| (side - from[axis]) / way[axis]);
                    (begin, end) = (begin.max(sides[0].min(sides[1])), end.min(sides[0].max(sides[1])));
                }
            }
            begin <= end
        }
        Outline::Disc { radius } => {
            let share = if way == Vector2::zeros() { 0.0 } else { -from.dot(&way) / way.norm_squared() };
            (from + way * share.clamp(0.0, 1.0)).norm() <= *radius
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn outline() -> impl Strategy<Value = Outline> {
        prop_oneof![
            (0.1..6.0, 0.1..6.0).prop_map(|(length, width)| Outline::Rectangle { length, width }),
            (0.1..3.0).prop_map(|radius| Outline::Disc { radius }),
        ]
    }

    fn pose() -> impl Strategy<Value = Pose> {
        (-6.0..6.0, -6.0..6.0, -3.2..3.2).prop_map(|(x, y, heading)| Pose { position: Vector2::new(x, y), heading })
    }

    /// Points of an outline, close together: its rim and what is inside.
    fn points(outline: &Outline, pose: &Pose) -> Vec<Vector2<f64>> {
        let steps = 24;
        let part = |i: usize| 2.0 * i as f64 / steps as f64 - 1.0;
        let mut points = Vec::new();
        for i in 0..=steps {
            for j in 0..=steps {
                let local = match outline {
                    Outline::Rectangle { length, width } => Vector2::new(0.5 * length * part(i), 0.5 * width * part(j)),
                    Outline::Disc { radius } => {
                        let (sin, cos) = libm::sincos(std::f64::consts::PI * part(i));
                        Vector2::new(cos, sin) * (0.5 * (part(j) + 1.0) * radius)
                    }
                };
                points.push(pose.position + pose.forward() * local.x + pose.left() * local.y);
            }
        }
        points
    }

    proptest! {
        #[test]
        fn a_line_crosses_an_outline_if_one_of_its_points_is_in_it(
            outline in outline(), at in pose(), from in pose(), to in pose()
        ) {
            let (from, to) = (from.position, to.position);
            let points = (0..=2000).map(|i| from + (to - from) * (f64::from(i) / 2000.0));
            let footprint = Footprint::of((&outline, &at));
            let nearest = points.map(|point| footprint.to_point(point)).fold(f64::INFINITY, f64::min);
            let crosses = crosses((&outline, &at), from, to);
            prop_assert!(if crosses { nearest < 0.01 } else { nearest > 0.0 }, "{} but {}", crosses, nearest);
        }

        #[test]
        fn the_gap_is_the_least_distance_of_any_two_points(
            a in outline(), at in pose(), b in outline(), there in pose()
        ) {
            let gap = gap((&a, &at), (&b, &there));
            let other_way = super::gap((&b, &there), (&a, &at));
            prop_assert!((gap - other_way).abs() < 1e-12, "{} and {}", gap, other_way);
            let (left, right) = (points(&a, &at), points(&b, &there));
            let distances = left.iter().flat_map(|p| right.iter().map(move |q| (p - q).norm()));
            let sampled = distances.fold(f64::INFINITY, f64::min);
            prop_assert!(gap <= sampled + 1e-9, "{} > {}", gap, sampled);
            prop_assert!(sampled <= gap + 0.6, "{} << {}", gap, sampled);
        }
    }
}
