//! The world as it would look if the way of the car were straight. Positions count along the way and beside it, instead
//! of ahead of the bumper and beside the doors. Drivers whose models know only straight lanes use this module to drive
//! through bends (Frenet coordinates: Werling, Ziegler, Kammel, Thrun, "Optimal Trajectory Generation for Dynamic
//! Street Scenarios in a Frenét Frame", ICRA 2010).
//!
//! The way is known as points every few metres. Between two points it counts as their chord, and its direction turns
//! evenly along the chord. Before the first point and beyond the last it goes on straight, so on a long bend a body
//! beyond the last point may seem to come over. The car is expected to keep its offset from the way: lateral positions
//! are measured from the parallel on which the car is. If all points lie ahead in a line, only the angle between the
//! car and that line is removed.

use crate::observation::{Observation, Other, Way};
use nalgebra::Vector2;

/// The greatest distance in metres of the points of a straight way from their line.
const STRAIGHT: f64 = 1e-6;
/// The number of points: the point beside the car and the points ahead.
const POINTS: usize = 17;

/// A point of the way and the way's direction there (a unit vector), both as the car sees them.
#[derive(Debug, Clone, Copy)]
struct Point {
    position: Vector2<f64>,
    tangent: Vector2<f64>,
}

/// The point of the way that is nearest to a position.
#[derive(Debug, Clone, Copy)]
struct Foot {
    /// The distance along the way from the point beside the car in metres, negative behind it.
    along: f64,
    point: Point,
}

/// The coordinate system along and across the way of the car.
#[derive(Debug, Clone)]
pub(super) struct Frenet {
    /// The offset of the car from the way, and the direction of the way beside the car.
    offset: f64,
    tangent: Vector2<f64>,
    /// The points of the way; `None` if the way is straight.
    points: Option<[Point; POINTS]>,
}

impl Frenet {
    /// Makes the coordinate system of the way in an observation.
    pub fn of(observation: &Observation) -> Self {
        let Way { offset, heading, ahead } = observation.way;
        let (sin, cos) = libm::sincos(heading);
        let (tangent, left) = (Vector2::new(cos, -sin), Vector2::new(sin, cos));
        let straight = ahead.iter().all(|point| (left.dot(&point.position) + offset).abs() < STRAIGHT);
        if straight {
            return Self { offset, tangent, points: None };
        }
        let mut points = [Point { position: -left * offset, tangent }; POINTS];
        for (point, ahead) in points[1..].iter_mut().zip(&ahead) {
            point.position = ahead.position;
        }
        // A point that coincides with the next has the direction of the point before.
        for i in 1..POINTS {
            let before = points[i - 1].tangent;
            let chord = |i: usize| (points[i].position - points[i - 1].position).try_normalize(STRAIGHT);
            let came = chord(i).unwrap_or(before);
            points[i].tangent = if i + 1 < POINTS {
                (came + chord(i + 1).unwrap_or(came)).try_normalize(STRAIGHT).unwrap_or(came)
            } else {
                // The direction of an arc's chord is the mean of the directions at the arc's ends.
                came * (2.0 * came.dot(&before)) - before
            };
        }
        Self { offset, tangent, points: Some(points) }
    }

    /// Returns the body as the car would see it if the way were straight and the car pointed along the way. The body
    /// was seen `age` seconds ago; its position assumes straight motion since then, the result motion along the way.
    pub fn straightened(&self, body: &Other, age: f64) -> Other {
        let turned = |tangent: Vector2<f64>, v: &Vector2<f64>| Vector2::new(tangent.dot(v), tangent.perp(v));
        let (here, position, velocity) = if let Some(points) = &self.points {
            let then = body.position - body.velocity * age;
            let Foot { along, point } = Foot::of(then, points);
            let from_way = then - point.position;
            let beside = from_way.norm().copysign(point.tangent.perp(&from_way));
            let velocity = turned(point.tangent, &body.velocity);
            let position = Vector2::new(along, beside - self.offset) + velocity * age;
            (Foot::of(body.position, points).point.tangent, position, velocity)
        } else {
            (self.tangent, turned(self.tangent, &body.position), turned(self.tangent, &body.velocity))
        };
        Other { position, velocity, heading: body.heading - libm::atan2(here.y, here.x), ..*body }
    }
}

impl Foot {
    /// Returns the point of a way nearest to a position.
    fn of(position: Vector2<f64>, points: &[Point; POINTS]) -> Self {
        let (first, last) = (points[0], points[POINTS - 1]);
        let beyond = |point: Point| point.tangent.dot(&(position - point.position));
        let straight_on =
            |point: Point, metres: f64| Point { position: point.position + point.tangent * metres, ..point };
        let (behind, onward) = (beyond(first).min(0.0), beyond(last).max(0.0));
        let ends = [
            Foot { along: behind, point: straight_on(first, behind) },
            Foot { along: Way::SPACING * (POINTS - 1) as f64 + onward, point: straight_on(last, onward) },
        ];
        let chords = points.windows(2).enumerate().filter_map(|(i, ends)| {
            let way = ends[1].position - ends[0].position;
            let length = way.norm_squared();
            let share = ((position - ends[0].position).dot(&way) / length).clamp(0.0, 1.0);
            let tangent = ends[0].tangent.lerp(&ends[1].tangent, share).try_normalize(STRAIGHT)?;
            let point = Point { position: ends[0].position + way * share, tangent };
            (length > 0.0).then_some(Foot { along: Way::SPACING * (i as f64 + share), point })
        });
        let distance = |foot: &Foot| (position - foot.point.position).norm_squared();
        let nearest = |a: Foot, b: Foot| if distance(&b) < distance(&a) { b } else { a };
        chords.chain([ends[1]]).fold(ends[0], nearest)
    }
}

#[cfg(test)]
mod tests;
