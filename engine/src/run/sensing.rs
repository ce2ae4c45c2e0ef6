//! The sensors and cameras of a run.

use super::Run;
use crate::sensor::{Air, Rig, SensorView, Shutters};

/// All sensors and cameras of a run. None of them depends on the others.
#[derive(Debug, Default)]
pub(super) struct Sensing {
    rig: Rig,
    eyes: Shutters,
    film: Shutters,
    /// The key of the test ([`Test::key`](crate::Test::key)).
    test: u64,
}

impl Sensing {
    /// Makes an empty set of sensors for the test with the given key.
    pub fn in_test(key: u64) -> Self {
        Self { test: key, ..Self::default() }
    }

    /// Returns the key of the test.
    pub fn test(&self) -> u64 {
        self.test
    }

    fn rigs(&mut self) -> [&mut Rig; 3] {
        [&mut self.rig, self.eyes.rig(), self.film.rig()]
    }

    /// Returns `true` if there is no sensor and no camera.
    fn is_empty(&self) -> bool {
        self.rig.is_empty() && self.eyes.is_empty() && self.film.is_empty()
    }

    /// Drops all arrived readings and moments, so that only later arrivals are new.
    pub fn clear(&mut self) {
        self.rigs().into_iter().for_each(Rig::clear);
    }
}

impl Run {
    /// Gives the ego vehicle the sensors of a rig, and resets the sensors. From now on they see every tick.
    pub fn equip(&mut self, rig: Rig) {
        self.sensing.rig = rig;
        self.sensing.rig.reset();
    }

    /// Gives the ego vehicle the cameras of its driver.
    pub(super) fn open_eyes(&mut self, eyes: Shutters) {
        self.sensing.eyes = eyes.in_test(self.sensing.test);
    }

    /// Films the run with the given cameras, whose images the driver does not get. Their noise and their lost images
    /// depend on the test.
    pub fn film(&mut self, film: Shutters) {
        self.sensing.film = film.in_test(self.sensing.test);
    }

    /// Returns `true` if the ego vehicle has a sensor or a camera, or if a camera films the run. Otherwise light, fog and the sun
    /// change nothing, and rain changes only the friction.
    pub fn has_senses(&self) -> bool {
        !self.sensing.is_empty()
    }

    /// Returns the ego vehicle's sensors, with the readings that have arrived since the last question to the driver.
    pub fn rig(&self) -> &Rig {
        &self.sensing.rig
    }

    /// Returns the driver's cameras. Their arrived moments have to be rendered before the driver can answer.
    pub fn eyes(&self) -> &Shutters {
        &self.sensing.eyes
    }

    /// Returns the cameras that film the run for the user.
    pub fn filmed(&self) -> &Shutters {
        &self.sensing.film
    }

    /// Returns the true state of the world at this tick, as sensors need it.
    pub fn view(&self) -> SensorView<'_> {
        let weather = self.weather();
        SensorView {
            time: self.time(),
            car: self.scene.ego.dynamics().state(),
            bodies: &self.scene.bodies,
            before: self.scene.before(),
            dt: self.dt,
            network: &self.scene.network,
            weather,
            air: Air::of(&weather),
        }
    }

    /// Shows all sensors the state of the world at this tick.
    pub(super) fn sense(&mut self) {
        // The weather and the air are only computed if a sensor looks.
        if self.sensing.is_empty() {
            return;
        }
        let mut sensing = std::mem::take(&mut self.sensing);
        let view = self.view();
        sensing.rigs().into_iter().for_each(|rig| rig.see(&view));
        self.sensing = sensing;
    }
}
