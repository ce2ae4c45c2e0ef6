//! Networks that see: detectors and segmentation networks from ONNX files, each with a description.

mod answer;
mod description;
mod frame;
#[cfg(feature = "train")]
pub mod learn;
#[cfg(test)]
mod tests;

pub use description::{Colours, Description, DescriptionFlaw, Form, Input, Output, Resize, Unit};

use crate::error::ModelError;
use crate::plan::Plan;
use answer::{boxes, mask};
use frame::{Placed, tensor};
use paracosm_perception::{Perceiver, PerceiverError, Percept, Picture, Task};
use std::error::Error;
use std::sync::Arc;

/// A perception network from an ONNX file. Copies share the weights of the network.
#[derive(Debug, Clone)]
pub struct Vision {
    plan: Plan,
    description: Description,
}

impl Vision {
    /// Reads a network from the contents of an ONNX file, with its description.
    ///
    /// # Errors
    /// The contents are no ONNX file, the network is beyond a limit, or its inputs and outputs are not those of the
    /// description.
    pub fn read(contents: &[u8], description: Description) -> Result<Self, ModelError> {
        let [width, height] = description.input.size;
        let plan = Plan::read(contents, &[1, 3, height, width])?;
        let shape = |name: &str| plan.output(name);
        match &description.output {
            Output::Boxes { boxes, scores, .. } => {
                let Task::Detection(detector) = &description.task else { return Err(ModelError::Broken) };
                let classes = detector.classes.len();
                let found = shape(boxes)?;
                let [1, count, 4] = found[..] else {
                    return Err(unfit(boxes, found, "1 x N x 4".to_owned()));
                };
                let found = shape(scores)?;
                if found != [1, count, classes] {
                    return Err(unfit(scores, found, format!("1 x {count} x {classes}, a score for each class")));
                }
            }
            Output::Mask { mask, classes, .. } => {
                let found = shape(mask)?;
                let [1, count, _, _] = found[..] else {
                    return Err(unfit(mask, found, "1 x classes x height x width".to_owned()));
                };
                if count != classes.len() {
                    let expected = format!("1 x {} x height x width, a score for each class", classes.len());
                    return Err(unfit(mask, found, expected));
                }
            }
        }
        Ok(Self { plan, description })
    }

    fn answer(&self, picture: &Picture<'_>) -> Result<Percept, PerceiverError> {
        let Description { input, output, .. } = &self.description;
        let outputs = self.plan.run(&tensor(input, picture)).map_err(failed)?;
        let placed = Placed::of(input, picture);
        match output {
            Output::Boxes { boxes: name, scores, form, unit } => {
                let (at, by) = (&outputs[self.plan.place(name)], &outputs[self.plan.place(scores)]);
                boxes((at, by), (*form, *unit), input, &placed).map(Percept::Boxes)
            }
            Output::Mask { mask: name, classes, positive, threshold } => {
                let positive: Vec<bool> = classes.iter().map(|class| positive.contains(class)).collect();
                let shape = self.plan.output(name).map_err(failed)?;
                let scores = (&outputs[self.plan.place(name)][..], [shape[3], shape[2]]);
                mask(scores, (&positive, *threshold), input, (&placed, picture)).map(Percept::Mask)
            }
        }
    }
}

/// Returns the error of a network that cannot be run.
fn failed(error: impl Error + Send + Sync + 'static) -> PerceiverError {
    PerceiverError::Failed(Arc::new(error))
}

fn unfit(name: &str, found: &[usize], expected: String) -> ModelError {
    let found = found.iter().map(usize::to_string).collect::<Vec<_>>().join(" x ");
    ModelError::Output { name: name.to_owned(), found, expected }
}

impl Perceiver for Vision {
    fn task(&self) -> &Task {
        &self.description.task
    }

    fn scale(&self, width: u32, height: u32) -> f64 {
        let Input { size, resize, .. } = &self.description.input;
        let [across, down] = [size[0] as f64 / f64::from(width), size[1] as f64 / f64::from(height)];
        match resize {
            Resize::Stretch => down,
            Resize::Letterbox => across.min(down),
        }
    }

    fn perceive(&mut self, pictures: &[Picture<'_>]) -> Result<Vec<Percept>, PerceiverError> {
        pictures.iter().map(|picture| self.answer(picture)).collect()
    }
}
