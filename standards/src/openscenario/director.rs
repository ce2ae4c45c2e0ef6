//! The storyboard as an object of the world: its conditions are streams that it reads, and it moves all entities.

use super::condition::{Check, Condition};
use super::measure::Measure;
use super::play::{Stage, Unplayable};
use super::story::Storyboard;
use paracosm_engine::object::{Geometric, Input, InputError, Output, Outputs, Tick};
use paracosm_engine::{Pose, Scenario, Stream};
use std::cell::RefCell;
use std::rc::Rc;

/// The storyboard that controls all entities, as an object of the world without a body.
struct Director {
    stage: Rc<RefCell<Stage>>,
    conditions: Vec<Input<bool>>,
    truths: Vec<bool>,
    measures: Vec<(Measure, Output<f64>)>,
    stopped: Output<bool>,
}

/// Adds the storyboard to a world: its conditions as streams, and the object that plays it. `drawn` is the storyboard if somebody
/// wants its drawing. Returns the stream that is true once the stop trigger has come.
pub(super) fn direct(
    s: &mut Scenario,
    stage: &Rc<RefCell<Stage>>,
    conditions: &[Condition],
    drawn: Option<&Storyboard>,
) -> Stream<bool> {
    let mut draft = s.object("storyboard");
    let stopped = draft.output("stopped");
    let end = stopped.stream();
    let mut measures = Vec::new();
    let mut inputs = Vec::new();
    for condition in conditions {
        let Check { measures: all, any, rule, value } = &condition.check;
        let mut truths = all.iter().map(|measure| {
            let stream = if *measure == Measure::Time {
                Stream::time()
            } else {
                let output = draft.output(&format!("{}.measure", condition.name));
                let stream = output.stream();
                measures.push((measure.clone(), output));
                stream
            };
            rule.compare(&stream, *value)
        });
        let first = truths.next().unwrap_or(Stream::constant(false));
        let truth = truths.fold(first, |all, next| if *any { all | next } else { all & next });
        inputs.push(draft.input(&condition.name, truth.named(&condition.name)));
    }
    let truths = vec![false; inputs.len()];
    if let (Some(board), Some(sketch)) = (drawn, draft.sketch()) {
        board.sketch(sketch, &inputs, &measures, &stopped);
    }
    draft.geometric(Director { stage: stage.clone(), conditions: inputs, truths, measures, stopped });
    end
}

impl Geometric for Director {
    fn poses(&self, _: &mut [Option<Pose>]) {}

    fn show(&self, outputs: &mut Outputs<'_>) {
        self.stage.borrow_mut().catch_up();
        let stage = self.stage.borrow();
        for (measure, output) in &self.measures {
            outputs.set(output, stage.measure(measure));
        }
        outputs.set(&self.stopped, stage.stopped);
    }

    fn step(&mut self, tick: &Tick<'_>) -> Result<(), InputError> {
        for (truth, input) in self.truths.iter_mut().zip(&self.conditions) {
            *truth = tick.get(input) == Some(true);
        }
        let played = self.stage.borrow_mut().play(&self.truths, tick.dt());
        played.map_err(|Unplayable { file, line, action, lost }| InputError::Impossible {
            object: format!("{}:{line}", file.display()),
            action,
            reason: lost.to_string(),
        })
    }
}
