//! Reads a network from an ONNX file and runs it in this process.

use crate::error::{AnswerError, ModelError};
use crate::plan::{optimised, parsed, unreadable};
use paracosm_engine::sensor::{Image, Look};
use std::panic;
use std::sync::Arc;
use tract_onnx::prelude::{
    DatumType, InferenceFact, InferenceModel, IntoRunnable, IntoTValue, Tensor, TractError, TypedRunnableModel, tvec,
};
use tract_onnx::tract_hir::infer::Factoid;

/// The smallest and the greatest height and width of an image, in pixels.
const PIXELS: (usize, usize) = (8, 1024);

/// The property of an ONNX file that names the look of the images that the network takes. The property is missing if the
/// look is `flat`.
pub(crate) const LOOK: &str = "look";

const IMAGE: &str = "1 x 3 x height x width, float, with height and width from 8 to 1024";
const SPEED: &str = "1 x 1, float: the speed";
const ANSWER: &str = "1 x 2, float: steering and throttle";

/// A neural network that drives, read from an ONNX file. Copies share the network's weights.
#[derive(Debug, Clone)]
pub struct Model {
    plan: Arc<TypedRunnableModel>,
    width: usize,
    height: usize,
    look: Look,
    asks_for_speed: bool,
}

impl Model {
    /// Reads a network from the contents of an ONNX file.
    ///
    /// # Errors The contents are no ONNX file, or the network is beyond a limit, or the network has other inputs and
    /// outputs than a driver needs.
    pub fn read(contents: &[u8]) -> Result<Self, ModelError> {
        // The library panics on some networks that no software writes.
        panic::catch_unwind(|| Self::parse(contents)).unwrap_or(Err(ModelError::Broken))
    }

    fn parse(contents: &[u8]) -> Result<Self, ModelError> {
        let (file, mut model) = parsed(contents)?;
        let look = file.metadata_props.iter().find(|property| property.key == LOOK);
        let look = look.map_or(Ok(Look::default()), |look| look.value.parse())?;
        let inputs = model.inputs.len();
        if !(1..=2).contains(&inputs) {
            let found = format!("{inputs} tensors");
            return Err(ModelError::Shape {
                what: "the input",
                found,
                expected: "one or two tensors: an image, and optionally the speed",
            });
        }
        let (height, width) = image_size(&model)?;
        let float = |dimensions: &[usize]| InferenceFact::dt_shape(DatumType::F32, dimensions);
        if inputs == 2 {
            let speed = dimensions(&model, 1);
            if !matches!(speed.as_deref(), Some([None | Some(1), Some(1)])) {
                return Err(ModelError::Shape { what: "the second input", found: shown(&model, 1), expected: SPEED });
            }
            model.set_input_fact(1, float(&[1, 1])).map_err(unreadable)?;
        }
        model.set_input_fact(0, float(&[1, 3, height, width])).map_err(unreadable)?;
        let model = optimised(model)?;
        let answers = model.outputs.len();
        let answer = model.output_fact(0).map_err(unreadable)?;
        if answers != 1 || answer.datum_type != DatumType::F32 || answer.shape.as_concrete() != Some(&[1, 2]) {
            let found = if answers == 1 { format!("{answer:?}") } else { format!("{answers} tensors") };
            return Err(ModelError::Shape { what: "the output", found, expected: ANSWER });
        }
        let plan = model.into_runnable().map_err(unreadable)?;
        Ok(Self { plan, width, height, look, asks_for_speed: inputs == 2 })
    }

    /// Returns the width and the height in pixels of the images that the network takes.
    pub fn resolution(&self) -> [u32; 2] {
        [self.width as u32, self.height as u32]
    }

    /// Returns the look of the images that the network takes: the property `look` of the file, or `flat`.
    pub fn look(&self) -> Look {
        self.look
    }

    /// Returns the network's steering and throttle for an image of its resolution and a speed in m/s. The numbers are
    /// not clamped.
    ///
    /// # Errors
    /// The image has another size, the network cannot be run, or it gives fewer than two numbers.
    pub fn answer(&self, image: &Image, speed: f64) -> Result<[f32; 2], AnswerError> {
        let (found, expected) = (image.rgb.len(), 3 * self.width * self.height);
        if found != expected {
            return Err(AnswerError::ImageSize { found, expected });
        }
        let wrong = |source: TractError| AnswerError::Run { source };
        let planes = Tensor::from_shape(&[1, 3, self.height, self.width], &planes(&image.rgb)).map_err(wrong)?;
        let mut inputs = tvec![planes.into_tvalue()];
        if self.asks_for_speed {
            inputs.push(Tensor::from_shape(&[1, 1], &[speed as f32]).map_err(wrong)?.into_tvalue());
        }
        let outputs = self.plan.run(inputs).map_err(wrong)?;
        let answer = outputs[0].to_plain_array_view::<f32>().map_err(wrong)?;
        let mut numbers = answer.iter().copied();
        let mut next = || numbers.next().ok_or(AnswerError::TooFewNumbers);
        Ok([next()?, next()?])
    }
}

/// Converts an image to the form that a network takes: colour plane by colour plane, each number from 0 to 1.
pub(crate) fn planes(rgb: &[u8]) -> Vec<f32> {
    let mut planes = Vec::with_capacity(rgb.len());
    for channel in 0..3 {
        planes.extend(rgb[channel..].iter().step_by(3).map(|byte| f32::from(*byte) / 255.0));
    }
    planes
}

/// Returns the height and the width in pixels of the images that a model takes.
fn image_size(model: &InferenceModel) -> Result<(usize, usize), ModelError> {
    let fine = |pixels: usize| (PIXELS.0..=PIXELS.1).contains(&pixels);
    match dimensions(model, 0).as_deref() {
        Some([None | Some(1), Some(3), Some(height), Some(width)]) if fine(*height) && fine(*width) => {
            Ok((*height, *width))
        }
        _ => Err(ModelError::Shape { what: "the first input", found: shown(model, 0), expected: IMAGE }),
    }
}

/// Returns the known dimensions of an input of floats. `None` if the input is not of floats or its rank is not known.
fn dimensions(model: &InferenceModel, input: usize) -> Option<Vec<Option<usize>>> {
    let fact = model.input_fact(input).ok()?;
    if fact.shape.rank().concretize().is_none() || fact.datum_type.concretize() != Some(DatumType::F32) {
        return None;
    }
    let known = |dimension: tract_onnx::prelude::TDim| dimension.to_i64().ok().and_then(|size| size.try_into().ok());
    Some(fact.shape.dims().map(|dimension| dimension.concretize().and_then(known)).collect())
}

fn shown(model: &InferenceModel, input: usize) -> String {
    model.input_fact(input).map_or_else(|_| "missing".to_owned(), InferenceFact::format_dt_shape)
}
