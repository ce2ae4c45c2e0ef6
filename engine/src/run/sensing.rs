//! The sensors and cameras that a run carries along.

use super::Run;
use crate::sensor::{Air, Rig, SensorView, Shutters};

/// All that measures in a run. None of it depends on what else is carried.
#[derive(Debug, Default)]
pub(super) struct Sensing {
    rig: Rig,
    eyes: Shutters,
    film: Shutters,
    /// Which test it is: [`Test::key`](crate::Test::key).
    test: u64,
}

impl Sensing {
    /// What measures nothing yet, in a test of this key.
    pub fn in_test(key: u64) -> Self {
        Self { test: key, ..Self::default() }
    }

    fn rigs(&mut self) -> [&mut Rig; 3] {
        [&mut self.rig, self.eyes.rig(), self.film.rig()]
    }

    /// Only what arrives from now on is new.
    pub fn clear(&mut self) {
        self.rigs().into_iter().for_each(Rig::clear);
    }
}

impl Run {
    /// Gives the car under test these sensors, which begin anew. From now on they see every tick.
    pub fn equip(&mut self, rig: Rig) {
        self.sensing.rig = rig;
        self.sensing.rig.reset();
    }

    /// Gives the car under test the cameras that its driver sees through.
    pub(super) fn open_eyes(&mut self, eyes: Shutters) {
        self.sensing.eyes = eyes.in_test(self.sensing.test);
    }

    /// Films the run with these cameras, which the driver knows nothing of. Their noise and what they lose are those of this
    /// test.
    pub fn film(&mut self, film: Shutters) {
        self.sensing.film = film.in_test(self.sensing.test);
    }

    /// The sensors of the car under test, with what has arrived from them since its driver was last asked.
    pub fn rig(&self) -> &Rig {
        &self.sensing.rig
    }

    /// The cameras that the driver sees through: what has arrived from them has to be drawn before it can answer.
    pub fn eyes(&self) -> &Shutters {
        &self.sensing.eyes
    }

    /// The cameras that the run is filmed with.
    pub fn filmed(&self) -> &Shutters {
        &self.sensing.film
    }

    /// What there is to know at this tick.
    pub fn view(&self) -> SensorView<'_> {
        let weather = self.weather();
        SensorView {
            time: self.time(),
            car: self.scene.ego.dynamics.state(),
            bodies: &self.scene.bodies,
            network: &self.scene.network,
            weather,
            air: Air::of(&weather),
        }
    }

    /// Shows the sensors this tick.
    pub(super) fn sense(&mut self) {
        let mut sensing = std::mem::take(&mut self.sensing);
        let view = self.view();
        sensing.rigs().into_iter().for_each(|rig| rig.see(&view));
        self.sensing = sensing;
    }
}
