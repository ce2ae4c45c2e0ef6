//! A network in a file of the ONNX format, run in process.

use paracosm_engine::sensor::Image;
use std::io::Cursor;
use std::sync::Arc;
use thiserror::Error;
use tract_onnx::prelude::{
    DatumType, Framework, InferenceFact, InferenceModel, InferenceModelExt, IntoRunnable, IntoTValue, Tensor,
    TractError, TypedRunnableModel, tvec,
};
use tract_onnx::tract_hir::infer::Factoid;

/// The fewest and the most pixels each way.
const PIXELS: (usize, usize) = (8, 1024);

/// Why a file is no driver.
#[derive(Debug, Error)]
pub enum ModelError {
    /// It is not in the format, or has operations that are not known.
    #[error("cannot be read as an ONNX model: {source:#}")]
    Unreadable {
        /// What is wrong with it.
        source: TractError,
    },
    /// It has tensors that a driver has not.
    #[error("{what} is {found}, expected {expected}")]
    Shape {
        /// Which tensor.
        what: &'static str,
        /// What it is.
        found: String,
        /// What it should be.
        expected: &'static str,
    },
}

/// Why a network does not answer.
#[derive(Debug, Error)]
pub enum AnswerError {
    /// An image of another size than the network takes.
    #[error("the image has {found} bytes, expected {expected}")]
    ImageSize {
        /// How many bytes it has.
        found: usize,
        /// How many it should have.
        expected: usize,
    },
    /// The network cannot be run.
    #[error("the network cannot be run: {source:#}")]
    Run {
        /// Why.
        source: TractError,
    },
    /// Steering or throttle is missing.
    #[error("the network gives fewer than two numbers")]
    TooFewNumbers,
}

const IMAGE: &str = "1 x 3 x height x width, float, with height and width from 8 to 1024";
const SPEED: &str = "1 x 1, float: the speed";
const ANSWER: &str = "1 x 2, float: steering and throttle";

/// A network that drives; copies share its weights.
#[derive(Debug, Clone)]
pub struct Model {
    plan: Arc<TypedRunnableModel>,
    width: usize,
    height: usize,
    asks_for_speed: bool,
}

impl Model {
    /// The network in a file with these contents.
    ///
    /// # Errors
    /// They are no such file, or a network with other inputs and outputs than a driver's.
    pub fn read(contents: &[u8]) -> Result<Self, ModelError> {
        let unreadable = |source: TractError| ModelError::Unreadable { source };
        let mut model = tract_onnx::onnx().model_for_read(&mut Cursor::new(contents)).map_err(unreadable)?;
        let inputs = model.inputs.len();
        if !(1..=2).contains(&inputs) {
            let found = format!("{inputs} tensors");
            return Err(ModelError::Shape { what: "the input", found, expected: "an image, and the speed if need be" });
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
        let model = model.into_optimized().map_err(unreadable)?;
        let answers = model.outputs.len();
        let answer = model.output_fact(0).map_err(unreadable)?;
        if answers != 1 || answer.datum_type != DatumType::F32 || answer.shape.as_concrete() != Some(&[1, 2]) {
            let found = if answers == 1 { format!("{answer:?}") } else { format!("{answers} tensors") };
            return Err(ModelError::Shape { what: "the output", found, expected: ANSWER });
        }
        let plan = model.into_runnable().map_err(unreadable)?;
        Ok(Self { plan, width, height, asks_for_speed: inputs == 2 })
    }

    /// Pixels across and down of the images that it is shown.
    pub fn resolution(&self) -> [u32; 2] {
        [self.width as u32, self.height as u32]
    }

    /// Steering and throttle for an image of its resolution at a speed in m/s, as the network has it.
    ///
    /// # Errors
    /// The network cannot be run on it.
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

/// Plane by plane, from 0 to 1: what a network is shown of an image.
pub(crate) fn planes(rgb: &[u8]) -> Vec<f32> {
    let mut planes = Vec::with_capacity(rgb.len());
    for channel in 0..3 {
        planes.extend(rgb[channel..].iter().step_by(3).map(|byte| f32::from(*byte) / 255.0));
    }
    planes
}

/// Pixels down and across.
fn image_size(model: &InferenceModel) -> Result<(usize, usize), ModelError> {
    let fine = |pixels: usize| (PIXELS.0..=PIXELS.1).contains(&pixels);
    match dimensions(model, 0).as_deref() {
        Some([None | Some(1), Some(3), Some(height), Some(width)]) if fine(*height) && fine(*width) => {
            Ok((*height, *width))
        }
        _ => Err(ModelError::Shape { what: "the first input", found: shown(model, 0), expected: IMAGE }),
    }
}

/// The dimensions of an input of floats as far as they are known.
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
