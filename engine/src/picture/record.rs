//! What is kept of a run for its pictures: where all bodies were, every so often.

use super::body::{extent, is_actor};
use super::view::MARGIN;
use super::world::NEAR;
use crate::geometry::Pose;
use crate::object::Body;
use crate::road::{Bounds, RoadNetwork};
use crate::run::Run;
use nalgebra::Vector2;
use std::ops::Range;
use std::sync::Arc;

/// Seconds between two moments.
const INTERVAL: f64 = 0.1;
/// Metres that a body moves at least to have a way of its own.
const STIR: f64 = 0.3;

/// Where all bodies of a run were, every tenth of a second or as often as its driver is asked. Show it the run by
/// [`MotionRecord::see`], from [`Run::watch`] for example; a run that nobody watches costs nothing.
#[derive(Debug, Clone, Default)]
pub struct MotionRecord {
    pub(super) scene: Option<Scene>,
    pub(super) moments: Vec<Moment>,
    /// The body that the car under test touches at the last moment.
    pub(super) touched: Option<usize>,
}

/// What does not change in a run.
#[derive(Debug, Clone)]
pub(super) struct Scene {
    pub network: Arc<RoadNetwork>,
    pub bodies: Vec<Body>,
}

/// Where all bodies are at a time in seconds, the car under test first.
#[derive(Debug, Clone)]
pub(super) struct Moment {
    pub time: f64,
    pub poses: Vec<Pose>,
}

impl MotionRecord {
    /// Looks at a run as it stands now. What comes too soon after what was seen before is passed over, the end is not.
    pub fn see(&mut self, run: &Run) {
        let bodies = run.bodies();
        if self.scene.is_none() {
            let bodies = bodies.iter().map(|state| state.body).collect();
            self.scene = Some(Scene { network: run.network().clone(), bodies });
        }
        let time = run.time();
        let due = self.moments.last().is_none_or(|last| time >= last.time + INTERVAL - 1e-9);
        self.touched = run.touched();
        let finite = bodies.iter().all(|state| state.pose.is_finite());
        if finite && (due || run.is_over()) {
            if self.moments.last().is_some_and(|last| last.time == time) {
                self.moments.pop();
            }
            self.moments.push(Moment { time, poses: bodies.iter().map(|state| state.pose).collect() });
        }
    }

    /// Whether nothing was seen: the world could not even be built.
    pub fn is_empty(&self) -> bool {
        self.moments.is_empty()
    }

    /// Where the car under test was in these moments, the actors that were within `reach` metres of it, and what stands
    /// beside its way.
    pub(super) fn bounds(&self, scene: &Scene, moments: Range<usize>, reach: f64) -> Bounds {
        let mut bounds = Bounds::empty();
        for moment in &self.moments[moments] {
            let car = moment.poses[0].position;
            for (i, (pose, body)) in moment.poses.iter().zip(&scene.bodies).enumerate() {
                let distance = (pose.position - car).norm();
                if i == 0 || is_actor(body.class) && distance <= reach {
                    bounds.include(pose.position);
                } else if distance <= NEAR {
                    bounds = bounds.union(&Bounds::around([pose.position]).grown(extent(body) - MARGIN[1]));
                }
            }
        }
        bounds
    }

    /// Whether a body moved in these moments.
    pub(super) fn moves(&self, body: usize, moments: Range<usize>) -> bool {
        let start = self.moments[moments.start].poses[body].position;
        self.moments[moments].iter().any(|moment| (moment.poses[body].position - start).norm() > STIR)
    }

    /// Where the car under test touches another body: the point of its outline that is nearest to the other's middle.
    pub(super) fn point_of_contact(&self, scene: &Scene) -> Option<Vector2<f64>> {
        let poses = &self.moments.last()?.poses;
        let other = poses[self.touched?].position;
        let half = scene.bodies[0].outline.half_extent();
        let seen = poses[0].to_local(other);
        let at = Vector2::new(seen.x.clamp(-half.x, half.x), seen.y.clamp(-half.y, half.y));
        Some(super::ground::seen_from(&poses[0], at.x, at.y))
    }
}
