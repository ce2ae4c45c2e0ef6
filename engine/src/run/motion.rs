//! The motion of all bodies of a run, tick by tick, for programs that play the run elsewhere.

use super::Run;
use crate::Pose;
use crate::object::{Body, BodyState};

/// The poses of all bodies of a run at every tick.
#[derive(Debug, Clone, PartialEq)]
pub struct Motion {
    /// The duration of a tick in seconds.
    pub dt: f64,
    /// The bodies in the order of [`Run::bodies`]: the ego vehicle is the first.
    pub tracks: Vec<Track>,
}

/// The motion of one body.
#[derive(Debug, Clone, PartialEq)]
pub struct Track {
    /// The name of the object that the body belongs to; the ego vehicle is `car`.
    pub name: String,
    /// The body.
    pub body: Body,
    /// The pose of the middle of the body at every tick; `None` while the body is not in the world.
    pub poses: Vec<Option<Pose>>,
}

impl Run {
    /// Records the motion of all bodies from the present tick on. Without this call, nothing is recorded.
    pub fn record_motion(&mut self) {
        let bodies = self.bodies().iter().enumerate();
        let track = |(index, state): (usize, &BodyState)| Track {
            name: self.name_of(index).to_owned(),
            body: state.body,
            poses: Vec::with_capacity(self.ticks + 1),
        };
        self.motion = Some(Box::new(Motion { dt: self.dt, tracks: bodies.map(track).collect() }));
    }

    /// Returns the recorded motion; `None` if the run records no motion.
    pub fn motion(&self) -> Option<&Motion> {
        self.motion.as_deref()
    }

    /// Adds the present tick to the recorded motion.
    #[cold]
    pub(super) fn note_motion(&mut self) {
        let Some(motion) = &mut self.motion else { return };
        for (track, state) in motion.tracks.iter_mut().zip(&self.scene.bodies) {
            track.poses.push(state.present.then_some(state.pose));
        }
    }
}
