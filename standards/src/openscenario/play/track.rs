//! Ways through the world that an entity follows vertex by vertex.

use nalgebra::Vector2;
use paracosm_engine::Pose;

/// A polyline, with the distance along it and the time at each vertex.
#[derive(Debug, Clone)]
pub(super) struct Track {
    vertices: Vec<Vertex>,
}

#[derive(Debug, Clone, Copy)]
struct Vertex {
    pose: Pose,
    s: f64,
    time: f64,
}

impl Track {
    /// Makes a way through vertices with their times. It has at least one vertex.
    pub fn new(vertices: impl IntoIterator<Item = (Pose, f64)>) -> Option<Self> {
        let mut all: Vec<Vertex> = Vec::new();
        for (pose, time) in vertices {
            let s = all.last().map_or(0.0, |last| last.s + (pose.position - last.pose.position).norm());
            all.push(Vertex { pose, s, time });
        }
        (!all.is_empty()).then_some(Self { vertices: all })
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
        let heading = if ahead.norm() > 0.0 { libm::atan2(ahead.y, ahead.x) } else { a.pose.heading };
        let share = if b.s > a.s { ((s - a.s) / (b.s - a.s)).clamp(0.0, 1.0) } else { 1.0 };
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
