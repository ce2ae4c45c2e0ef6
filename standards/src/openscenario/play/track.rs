//! Ways through the world that an entity follows vertex by vertex.

use crate::openscenario::way::Clothoid;
use nalgebra::Vector2;
use paracosm_engine::Pose;

/// A way, with the distance along it and the time at each vertex.
#[derive(Debug, Clone)]
pub(super) struct Track {
    vertices: Vec<Vertex>,
    /// `true` if the heading changes evenly between two vertices, `false` if the way is straight there.
    curved: bool,
}

/// The distance in metres between two vertices of a clothoid.
const SPACING: f64 = 0.05;

#[derive(Debug, Clone, Copy)]
struct Vertex {
    pose: Pose,
    s: f64,
    time: f64,
}

impl Track {
    /// Makes a polyline through vertices with their times; `None` without vertices.
    pub fn polyline(vertices: Vec<(Pose, f64)>) -> Option<Self> {
        let all = measured(vertices);
        (!all.is_empty()).then_some(Self { vertices: all, curved: false })
    }

    /// Makes a way of clothoids from a pose. `end` is the time at the end.
    pub fn clothoids(start: Pose, segments: &[Clothoid], end: f64) -> Self {
        let (mut here, mut all) = (start, vec![(start, segments.first().map_or(0.0, |first| first.time))]);
        for (index, Clothoid { curvature, rate, length, turn, time }) in segments.iter().enumerate() {
            here.heading += turn;
            let next = segments.get(index + 1).map_or(end, |next| next.time);
            let (first, count) = (here.heading, (length / SPACING).ceil().max(1.0));
            let step = length / count;
            let heading = |s: f64| first + (curvature + 0.5 * rate * s) * s;
            for i in 0..count as usize {
                let s = i as f64 * step;
                // The mean heading of the step, whose heading is a parabola.
                let middle = Pose { heading: heading(s + 0.5 * step) + rate * step * step / 24.0, ..here };
                // The chord of an arc is shorter than the arc.
                let bend = (curvature + rate * (s + 0.5 * step)) * step;
                let chord = step * (1.0 - bend * bend / 24.0);
                here = Pose { position: here.position + middle.forward() * chord, heading: heading(s + step) };
                all.push((here, time + (next - time) * (i + 1) as f64 / count));
            }
        }
        Self { vertices: measured(all), curved: true }
    }

    /// Returns the length in metres.
    pub fn length(&self) -> f64 {
        self.vertices[self.vertices.len() - 1].s
    }

    /// Returns the time at the last vertex.
    pub fn end(&self) -> f64 {
        self.vertices[self.vertices.len() - 1].time
    }

    /// Returns the distance along the way at a time.
    pub fn at_time(&self, time: f64) -> f64 {
        self.between(time, |vertex| vertex.time, |vertex| vertex.s)
    }

    /// Returns the pose at a distance along the way. The heading is the direction of the way.
    pub fn at(&self, s: f64) -> Pose {
        let of = |index: usize| self.vertices[index];
        let next = self.vertices.partition_point(|vertex| vertex.s <= s).clamp(1, self.vertices.len().max(2) - 1);
        if self.vertices.len() == 1 {
            return of(0).pose;
        }
        let (a, b) = (of(next - 1), of(next));
        let ahead: Vector2<f64> = b.pose.position - a.pose.position;
        let share = if b.s > a.s { ((s - a.s) / (b.s - a.s)).clamp(0.0, 1.0) } else { 1.0 };
        let heading = if self.curved {
            a.pose.heading + (b.pose.heading - a.pose.heading) * share
        } else if ahead.norm() > 0.0 {
            libm::atan2(ahead.y, ahead.x)
        } else {
            a.pose.heading
        };
        Pose { position: a.pose.position + ahead * share, heading }
    }

    fn between(&self, x: f64, key: impl Fn(&Vertex) -> f64, value: impl Fn(&Vertex) -> f64) -> f64 {
        let next = self.vertices.partition_point(|vertex| key(vertex) <= x);
        let (Some(before), Some(after)) = (next.checked_sub(1), self.vertices.get(next)) else {
            return value(&self.vertices[next.min(self.vertices.len() - 1)]);
        };
        let before = &self.vertices[before];
        value(before) + (value(after) - value(before)) * (x - key(before)) / (key(after) - key(before))
    }
}

/// Adds to each vertex the distance along the way.
fn measured(vertices: Vec<(Pose, f64)>) -> Vec<Vertex> {
    let mut all: Vec<Vertex> = Vec::with_capacity(vertices.len());
    for (pose, time) in vertices {
        let s = all.last().map_or(0.0, |last| last.s + (pose.position - last.pose.position).norm());
        all.push(Vertex { pose, s, time });
    }
    all
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::{FRAC_PI_2, FRAC_PI_4};

    fn clothoid(curvature: f64, rate: f64, length: f64) -> Clothoid {
        Clothoid { curvature, rate, length, turn: 0.0, time: 0.0 }
    }

    #[test]
    fn an_arc_ends_where_its_circle_says() {
        let start = Pose { position: Vector2::new(3.0, 4.0), heading: 0.0 };
        let arc = clothoid(0.1, 0.0, 10.0 * FRAC_PI_2);
        let track = Track::clothoids(start, &[arc, clothoid(0.0, 0.0, 5.0)], 10.0);
        let quarter = track.at(10.0 * FRAC_PI_2);
        assert!((quarter.position - Vector2::new(13.0, 14.0)).norm() < 1e-4, "{quarter:?}");
        assert!((quarter.heading - FRAC_PI_2).abs() < 1e-3);
        assert!((track.at(f64::INFINITY).position - Vector2::new(13.0, 19.0)).norm() < 1e-4);
        assert!((track.length() - 10.0 * FRAC_PI_2 - 5.0).abs() < 1e-4);
    }

    #[test]
    fn a_clothoid_turns_with_the_square_of_its_length() {
        let start = Pose { position: Vector2::zeros(), heading: 0.0 };
        // The heading is s²/2, and a sum of 200,000 steps gives the end.
        let track = Track::clothoids(start, &[clothoid(0.0, 1.0, FRAC_PI_2.sqrt())], 1.0);
        let end = track.at(track.length());
        assert!((end.heading - FRAC_PI_4).abs() < 1e-9);
        assert!((end.position - Vector2::new(1.178_180, 0.313_941)).norm() < 1e-4, "{end:?}");
    }

    #[test]
    fn a_polyline_has_the_direction_of_its_lines() {
        let at = |x: f64, y: f64| Pose { position: Vector2::new(x, y), heading: 9.0 };
        let track = Track::polyline(vec![(at(0.0, 0.0), 0.0), (at(4.0, 0.0), 2.0), (at(4.0, 3.0), 3.0)]).unwrap();
        assert_eq!(track.at(5.0).position, Vector2::new(4.0, 1.0));
        assert_eq!(track.at(5.0).heading, FRAC_PI_2);
        assert_eq!(track.at_time(1.0), 2.0);
        assert_eq!((track.at_time(9.0), track.end(), track.length()), (7.0, 3.0, 7.0));
    }
}
