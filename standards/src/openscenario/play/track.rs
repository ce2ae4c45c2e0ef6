//! Ways through the world that an entity follows vertex by vertex.

use crate::openscenario::clothoid::Clothoid;
use crate::openscenario::nurbs::Nurbs;
use nalgebra::Vector2;
use paracosm_engine::Pose;
use paracosm_engine::road::wrapped;

/// A way, with the distance along it and the time at each vertex.
#[derive(Debug, Clone)]
pub(super) struct Track {
    vertices: Vec<Vertex>,
    /// `true` if the heading changes evenly between two vertices, `false` if the way is straight there.
    curved: bool,
}

/// The least distance in metres between two vertices of a clothoid.
const SPACING: f64 = 0.05;
/// The greatest number of vertices of a clothoid.
const MOST_VERTICES: f64 = 200_000.0;

/// The distance in metres between two vertices of a curve through control points.
const STRIDE: f64 = 1.0;
/// The greatest number of strides of a curve.
const MOST: f64 = 100_000.0;
/// The greatest number of strides times control points.
const MOST_FUNCTIONS: f64 = 10_000_000.0;
/// The part of a stride after a vertex at which the influence of control points is read. The standard does not say where on the curve the
/// time of a control point holds. With this number the places are those of esmini.
const LATER: f64 = 0.3;
/// The part of a curve before and after a place that gives its direction.
const NEAR: f64 = 1e-6;
/// The greatest number of metres before and after a vertex of a polyline within which an entity turns.
const CORNER: f64 = 2.0;

#[derive(Debug, Clone, Copy)]
struct Vertex {
    pose: Pose,
    s: f64,
    time: f64,
    /// `true` if the heading of the pose is the entity's, `false` if the entity faces along the way.
    faces: bool,
}

impl Track {
    /// Makes a polyline through vertices with their times; `None` without vertices. A vertex may give the heading of the entity.
    pub fn polyline(vertices: Vec<(Pose, f64, bool)>) -> Option<Self> {
        let mut all = measured(vertices.iter().map(|(pose, time, _)| (*pose, *time)).collect());
        all.iter_mut().zip(&vertices).for_each(|(vertex, (.., faces))| vertex.faces = *faces);
        (!all.is_empty()).then_some(Self { vertices: all, curved: false })
    }

    /// Makes a way of clothoids from a pose. `end` is the time at the end.
    pub fn clothoids(start: Pose, segments: &[Clothoid], end: f64) -> Self {
        let (mut here, mut all) = (start, vec![(start, segments.first().map_or(0.0, |first| first.time))]);
        for (index, Clothoid { curvature, rate, length, turn, time }) in segments.iter().enumerate() {
            here.heading += turn;
            let next = segments.get(index + 1).map_or(end, |next| next.time);
            let (first, count) = (here.heading, (length / SPACING).ceil().clamp(1.0, MOST_VERTICES));
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

    /// Makes a curve through control points with their times. The time of a control point belongs to the place on which the point has
    /// its greatest influence.
    pub fn nurbs(points: &[(Vector2<f64>, f64)], nurbs: &Nurbs) -> Self {
        let reach: f64 = points.windows(2).map(|pair| (pair[1].0 - pair[0].0).norm()).sum();
        let count = 1 + (reach / STRIDE).min(MOST).min(MOST_FUNCTIONS / points.len() as f64) as usize;
        let u = |i: usize| i as f64 / count as f64;
        let functions: Vec<_> = (0..=count).map(|i| nurbs.functions(u(i) + LATER / count as f64)).collect();
        let peaks: Vec<(f64, f64)> = (0..points.len())
            .map(|point| {
                let greatest =
                    |a: &usize, b: &usize| functions[*a][point].total_cmp(&functions[*b][point]).then(b.cmp(a));
                (u((0..=count).max_by(greatest).unwrap_or(0)), points[point].1)
            })
            .collect();
        let time = |u: f64| {
            let next = peaks.partition_point(|(peak, _)| *peak <= u).clamp(1, peaks.len() - 1);
            let (before, after) = (peaks[next - 1], peaks[next]);
            let share = if after.0 > before.0 { (u - before.0) / (after.0 - before.0) } else { 1.0 };
            before.1 + (after.1 - before.1) * share
        };
        let place = |u: f64| -> Vector2<f64> {
            points.iter().zip(nurbs.shares(u)).map(|((point, _), share)| point * share).sum()
        };
        let heading = |u: f64| {
            let ahead = place(u + NEAR) - place(u - NEAR);
            libm::atan2(ahead.y, ahead.x)
        };
        let mut before = heading(0.0);
        let vertex = |i: usize| {
            // The heading goes on beyond half a turn.
            before += wrapped(heading(u(i)) - before);
            (Pose { position: place(u(i)), heading: before }, time(u(i)))
        };
        Self { vertices: measured((0..=count).map(vertex).collect()), curved: true }
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

    /// Returns the time from the beginning of the way to a distance along it.
    pub fn time_to(&self, s: f64) -> f64 {
        let next = self.vertices.partition_point(|vertex| vertex.s < s).min(self.vertices.len() - 1);
        let Some(before) = next.checked_sub(1) else { return 0.0 };
        let (a, b) = (&self.vertices[before], &self.vertices[next]);
        a.time + (b.time - a.time) * (s - a.s) / (b.s - a.s) - self.vertices[0].time
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
        } else {
            self.direction(next - 1, s)
        };
        Pose { position: a.pose.position + ahead * share, heading }
    }

    /// Returns the heading at a distance along a polyline, on the line after a vertex. It changes evenly between vertices that give the
    /// heading. Otherwise it is the direction of the line, and changes evenly to the lines before and after near the ends of the line.
    fn direction(&self, vertex: usize, s: f64) -> f64 {
        let line = |first: usize| {
            let (a, b) = (self.vertices.get(first)?, self.vertices.get(first + 1)?);
            let ahead = b.pose.position - a.pose.position;
            (ahead.norm() > 0.0).then(|| (libm::atan2(ahead.y, ahead.x), b.s - a.s))
        };
        let Some((here, length)) = line(vertex) else { return self.vertices[vertex].pose.heading };
        let towards = |other: Option<(f64, f64)>, metres: f64| {
            let Some((there, other_length)) = other else { return here };
            let corner = CORNER.min(0.25 * length).min(0.25 * other_length);
            here + wrapped(there - here) * 0.5 * (1.0 - metres / corner).max(0.0)
        };
        let done = s.max(0.0) - self.vertices[vertex].s;
        if let Some([a, b]) = self.vertices.get(vertex..vertex + 2).and_then(|pair| <&[Vertex; 2]>::try_from(pair).ok())
            && (a.faces || b.faces)
        {
            let [from, to] = [a, b].map(|vertex| if vertex.faces { vertex.pose.heading } else { here });
            return from + wrapped(to - from) * (done / length).min(1.0);
        }
        if done < 0.5 * length {
            towards(vertex.checked_sub(1).and_then(line), done)
        } else {
            towards(line(vertex + 1), length - done)
        }
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
        all.push(Vertex { pose, s, time, faces: false });
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
        let track =
            Track::polyline(vec![(at(0.0, 0.0), 0.0, false), (at(4.0, 0.0), 2.0, false), (at(4.0, 3.0), 3.0, false)])
                .unwrap();
        assert_eq!(track.at(5.0).position, Vector2::new(4.0, 1.0));
        assert_eq!(track.at(5.0).heading, FRAC_PI_2);
        assert_eq!(track.at_time(1.0), 2.0);
        assert_eq!((track.at_time(9.0), track.end(), track.length()), (7.0, 3.0, 7.0));
    }
}
