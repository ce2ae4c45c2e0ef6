//! Notes the bodies of a run while the run is watched, and what a LiDAR measures.

use super::WORLD;
use paracosm_engine::object::Body;
use paracosm_engine::road::RoadNetwork;
use paracosm_engine::sensor::{Delivery, Handle, Lidar, LidarSettings, Mount, Rig, Scan, SensorError};
use paracosm_engine::{Pose, Run};
use std::collections::HashSet;
use std::sync::Arc;

/// The frame of the LiDAR, and the beginning of the frames of cameras.
pub(super) const LIDAR: &str = "lidar";
pub(super) const CAMERA: &str = "camera ";

/// The record of a run for its file. [`Recorder::see`] notes a moment of a run, for example from [`Run::watch`]. A run that is not
/// recorded costs nothing.
#[derive(Default)]
pub struct Recorder {
    pub(super) scene: Option<Scene>,
    pub(super) moments: Vec<Moment>,
    /// The body that the ego vehicle touches at the end.
    pub(super) touched: Option<usize>,
    pub(super) lidar: Option<Scanned>,
}

/// The facts that do not change in a run.
pub(super) struct Scene {
    pub network: Arc<RoadNetwork>,
    /// The name of each body, which no other body has, and the body.
    pub bodies: Vec<(String, Body)>,
}

/// The bodies at a time in seconds.
pub(super) struct Moment {
    pub time: f64,
    /// The pose and the altitude of each body; `None` if it is not in the world.
    pub bodies: Vec<Option<(Pose, f64)>>,
}

/// A LiDAR, and the scans that it has made.
pub(super) struct Scanned {
    pub mount: Mount,
    rig: Rig,
    handle: Handle<Lidar>,
    /// The seconds of each scan, and the scan.
    pub scans: Vec<(f64, Scan)>,
}

impl Recorder {
    /// Adds a LiDAR to the ego vehicle, which the driver does not see.
    ///
    /// # Errors
    /// A setting of the LiDAR is out of its range.
    pub fn with_lidar(self, settings: LidarSettings) -> Result<Self, SensorError> {
        let mut rig = Rig::new(0);
        let handle = rig.attach(LIDAR, Lidar::new(settings)?, Delivery::default())?;
        Ok(Self { lidar: Some(Scanned { mount: settings.mount, rig, handle, scans: Vec::new() }), ..self })
    }

    /// Records the present moment of a run.
    pub fn see(&mut self, run: &Run) {
        let (bodies, time) = (run.bodies(), run.time());
        if self.scene.is_none() {
            let names = frames((0..bodies.len()).map(|body| run.name_of(body)));
            let bodies = names.into_iter().zip(bodies.iter().map(|state| state.body)).collect();
            self.scene = Some(Scene { network: run.network().clone(), bodies });
        }
        self.touched = run.touched();
        if !bodies.iter().all(|state| state.pose.is_finite()) {
            return;
        }
        if self.moments.last().is_some_and(|last| last.time == time) {
            self.moments.pop();
        }
        let bodies = bodies.iter().map(|state| state.present.then_some((state.pose, state.altitude))).collect();
        self.moments.push(Moment { time, bodies });
        if let Some(lidar) = &mut self.lidar {
            lidar.rig.see(&run.view());
            lidar.scans.extend(lidar.rig.arrived(&lidar.handle).iter().map(|scan| (scan.time, scan.reading.clone())));
            // The last reading stays in the rig, but it does not arrive again.
            lidar.rig.clear();
        }
    }

    /// Returns `true` if no moment was recorded, because the world of the run could not be built.
    pub fn is_empty(&self) -> bool {
        self.moments.is_empty()
    }

    /// Returns the name of the ego vehicle.
    pub(super) fn ego(&self) -> &str {
        self.scene.as_ref().and_then(|scene| scene.bodies.first()).map_or("car", |(name, _)| name)
    }
}

/// Returns a frame for each body. No two frames have the same name, also not those of the world and of sensors.
fn frames<'a>(names: impl Iterator<Item = &'a str>) -> Vec<String> {
    let mut taken = HashSet::from([WORLD.to_owned(), LIDAR.to_owned()]);
    let frame = |name: &str| {
        let name = if name.starts_with(CAMERA) { format!("body {name}") } else { name.to_owned() };
        let numbered = (2..).map(|number| format!("{name} #{number}"));
        let free = std::iter::once(name.clone()).chain(numbered).find(|frame| taken.insert(frame.clone()));
        free.expect("there is always a further number")
    };
    names.map(frame).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_body_has_a_frame_of_its_own() {
        let names = ["car", "car #2", "car", "world", "lidar", "camera front", "car"];
        let expected = ["car", "car #2", "car #3", "world #2", "lidar #2", "body camera front", "car #4"];
        assert_eq!(frames(names.into_iter()), expected);
    }
}
