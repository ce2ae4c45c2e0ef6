//! The weather of a scenario as the weather of its world.

use super::environment::{PARTS, Surroundings};
use super::play::Stage;
use paracosm_engine::object::{Geometric, Output, Outputs};
use paracosm_engine::{Conditions, Environment, Pose, Scenario, Stream};
use std::cell::RefCell;
use std::rc::Rc;

/// The weather that a storyboard changes, as an object of the world without a body.
struct Changing {
    stage: Rc<RefCell<Stage>>,
    parts: [Output<f64>; 6],
}

/// Gives a world the weather of a storyboard. A world without an `EnvironmentAction` keeps the weather of all worlds. `changes` is
/// `true` if the weather can change during the run.
pub(super) fn place(s: &mut Scenario, stage: &Rc<RefCell<Stage>>, changes: bool) {
    let surroundings = stage.borrow().cast.surroundings;
    let parts = if changes {
        let mut draft = s.object("environment");
        let parts = PARTS.map(|name| draft.output(name));
        let streams = parts.each_ref().map(Output::stream);
        draft.geometric(Changing { stage: stage.clone(), parts });
        streams
    } else if surroundings == Surroundings::default() {
        return;
    } else {
        surroundings.parts(0.0).map(Stream::constant)
    };
    let [light, fog, rain, elevation, azimuth, factor] = parts;
    let friction = Conditions::default().friction * factor;
    s.place(Environment::new().light(light).fog(fog).rain(rain).sun(elevation, azimuth).friction(friction));
}

impl Geometric for Changing {
    fn poses(&self, _: &mut [Option<Pose>]) {}

    fn show(&self, outputs: &mut Outputs<'_>) {
        let stage = self.stage.borrow();
        let now = stage.cast.surroundings.parts(stage.cast.time);
        self.parts.iter().zip(now).for_each(|(part, value)| outputs.set(part, value));
    }
}
