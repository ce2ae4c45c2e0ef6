//! The record of a run for its pictures: the poses of all bodies at regular times.

use super::body::{extent, is_actor};
use super::view::MARGIN;
use super::world::NEAR;
use nalgebra::Vector2;
use paracosm_engine::Pose;
use paracosm_engine::Run;
use paracosm_engine::object::Body;
use paracosm_engine::road::{Bounds, RoadNetwork};
use std::ops::Range;
use std::sync::Arc;

/// The seconds between two moments.
const INTERVAL: f64 = 0.1;
/// The least distance in metres that a moving body moves.
const STIR: f64 = 0.3;

/// A record of the poses of all bodies in a run, for bird's-eye pictures of the run. A moment is recorded every tenth
/// of a second, or as often as the driver is asked. [`MotionRecord::see`] records a moment of a run, for example from
/// [`Run::watch`]. A run that is not recorded costs nothing.
#[derive(Debug, Clone, Default)]
pub struct MotionRecord {
    pub(super) scene: Option<Scene>,
    pub(super) moments: Vec<Moment>,
    /// The body that the ego vehicle touches at the last moment.
    pub(super) touched: Option<usize>,
}

/// The facts that do not change in a run.
#[derive(Debug, Clone)]
pub(super) struct Scene {
    pub network: Arc<RoadNetwork>,
    pub bodies: Vec<Body>,
}

/// The poses of all bodies at a time in seconds, the ego vehicle first.
#[derive(Debug, Clone)]
pub(super) struct Moment {
    pub time: f64,
    pub poses: Vec<Pose>,
}

impl MotionRecord {
    /// Records the present poses of all bodies in a run. A moment too soon after the last recorded moment is skipped,
    /// except for the end of the run.
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

    /// Returns `true` if no pose was recorded, because the world of the run could not be built.
    pub fn is_empty(&self) -> bool {
        self.moments.is_empty()
    }

    /// Returns the bounds of the ego vehicle in these moments, of the actors within `reach` metres of it, and of
    /// things near its way.
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

    /// Returns `true` if a body moved in these moments.
    pub(super) fn moves(&self, body: usize, moments: Range<usize>) -> bool {
        let start = self.moments[moments.start].poses[body].position;
        self.moments[moments].iter().any(|moment| (moment.poses[body].position - start).norm() > STIR)
    }

    /// Returns where the ego vehicle touches another body: the car's point nearest to the other's middle.
    pub(super) fn point_of_contact(&self, scene: &Scene) -> Option<Vector2<f64>> {
        let poses = &self.moments.last()?.poses;
        let other = poses[self.touched?].position;
        let half = scene.bodies[0].outline.half_extent();
        let seen = poses[0].to_local(other);
        let at = Vector2::new(seen.x.clamp(-half.x, half.x), seen.y.clamp(-half.y, half.y));
        Some(super::ground::seen_from(&poses[0], at.x, at.y))
    }
}
