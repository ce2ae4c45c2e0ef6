//! The sensors that a run carries along.

use super::Run;
use crate::sensor::{Air, Rig, View};

impl Run {
    /// Gives the car under test these sensors, which begin anew. From now on they see every tick.
    pub fn equip(&mut self, rig: Rig) {
        self.rig = rig;
        self.rig.reset();
    }

    /// The sensors of the car under test, with what has arrived from them since its driver was last asked.
    pub fn rig(&self) -> &Rig {
        &self.rig
    }

    /// What there is to know at this tick.
    pub fn view(&self) -> View<'_> {
        let weather = self.weather();
        View {
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
        let mut rig = std::mem::take(&mut self.rig);
        rig.see(&self.view());
        self.rig = rig;
    }
}
