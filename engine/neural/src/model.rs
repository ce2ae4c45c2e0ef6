//! Reads a network from an ONNX file and runs it in this process.

use crate::limits::{Limit, MOST_MEBIBYTES, check, check_tensors};
use paracosm_engine::sensor::Image;
use paracosm_space::did_you_mean;
use std::io::Cursor;
use std::panic;
use std::sync::Arc;
use thiserror::Error;
use tract_onnx::prelude::{
    DatumType, Framework, InferenceFact, InferenceModel, InferenceModelExt, IntoRunnable, IntoTValue, Tensor,
    TractError, TypedRunnableModel, tvec,
};
use tract_onnx::tract_hir::infer::Factoid;

/// The smallest and the greatest height and width of an image, in pixels.
const PIXELS: (usize, usize) = (8, 1024);

/// An error in a file that should contain a network that drives.
#[derive(Debug, Error)]
pub enum ModelError {
    /// The file is not in the ONNX format, or has operations that are not known.
    #[error("cannot be read as an ONNX model with operations that are supported: {source:#}")]
    Unreadable {
        /// The error of the ONNX reader.
        source: TractError,
    },
    /// The library that reads networks gives up on the network.
    #[error("no software writes such a network: the library that reads ONNX files gives up on it")]
    Broken,
    /// The network is beyond a limit.
    #[error(transparent)]
    Limit(#[from] Limit),
    /// The input of a perception network is not the input that its description states.
    #[error("the input is {found}, expected {expected}")]
    Input {
        /// The type and the shape of the input in the file, or the number of inputs.
        found: String,
        /// The input that the description states.
        expected: String,
    },
    /// An output of a perception network is not the output that its description states.
    #[error("the output `{name}` is {found}, expected {expected}")]
    Output {
        /// The name of the output.
        name: String,
        /// The shape of the output in the file.
        found: String,
        /// The shape that the description states.
        expected: String,
    },
    /// A perception network has no output with a name of its description.
    #[error("the network has no output `{name}`, expected some of {expected}{}", did_you_mean(.nearest))]
    NoOutput {
        /// The name in the description.
        name: String,
        /// The names of the outputs.
        expected: String,
        /// The most similar name.
        nearest: Option<String>,
    },
    /// The inputs or outputs of the network are not the inputs and outputs of a driver.
    #[error("{what} is {found}, expected {expected}")]
    Shape {
        /// The name of the wrong tensor, in words.
        what: &'static str,
        /// The type and shape of the tensor in the file.
        found: String,
        /// The type and shape that a driver needs.
        expected: &'static str,
    },
}

/// An error during the computation of a network's answer.
#[derive(Debug, Error)]
pub enum AnswerError {
    /// The size of the image differs from the size that the network takes.
    #[error("the image has {found} bytes, expected {expected}: three for each pixel of the network's input")]
    ImageSize {
        /// The number of bytes of the image.
        found: usize,
        /// The number of bytes that the network takes.
        expected: usize,
    },
    /// The network cannot be run.
    #[error("the network cannot be run: {source:#}")]
    Run {
        /// The error of the ONNX runtime.
        source: TractError,
    },
    /// Steering or throttle is missing in the network's answer.
    #[error("the network's answer has fewer than two numbers, expected steering and throttle")]
    TooFewNumbers,
}

const IMAGE: &str = "1 x 3 x height x width, float, with height and width from 8 to 1024";
const SPEED: &str = "1 x 1, float: the speed";
const ANSWER: &str = "1 x 2, float: steering and throttle";

/// A neural network that drives, read from an ONNX file. Copies share the network's weights.
#[derive(Debug, Clone)]
pub struct Model {
    plan: Arc<TypedRunnableModel>,
    width: usize,
    height: usize,
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
        let unreadable = |source: TractError| ModelError::Unreadable { source };
        if contents.len() > MOST_MEBIBYTES << 20 {
            return Err(Limit::Size.into());
        }
        let file = tract_onnx::onnx().proto_model_for_read(&mut Cursor::new(contents)).map_err(unreadable)?;
        check(&file)?;
        let mut model = tract_onnx::onnx().model_for_proto_model(&file).map_err(unreadable)?;
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
        let model = model.into_typed().map_err(unreadable)?;
        check_tensors(&model)?;
        let model = model.into_optimized().map_err(unreadable)?;
        check_tensors(&model)?;
        let answers = model.outputs.len();
        let answer = model.output_fact(0).map_err(unreadable)?;
        if answers != 1 || answer.datum_type != DatumType::F32 || answer.shape.as_concrete() != Some(&[1, 2]) {
            let found = if answers == 1 { format!("{answer:?}") } else { format!("{answers} tensors") };
            return Err(ModelError::Shape { what: "the output", found, expected: ANSWER });
        }
        let plan = model.into_runnable().map_err(unreadable)?;
        Ok(Self { plan, width, height, asks_for_speed: inputs == 2 })
    }

    /// Returns the width and the height in pixels of the images that the network takes.
    pub fn resolution(&self) -> [u32; 2] {
        [self.width as u32, self.height as u32]
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
