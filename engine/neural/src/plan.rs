//! A network of one image and any outputs, ready to be run.

use crate::error::{AnswerError, ModelError};
use crate::limits::{Limit, MOST_MEBIBYTES, check, check_tensors};
use paracosm_space::nearest;
use std::io::Cursor;
use std::panic;
use std::sync::Arc;
use tract_onnx::pb::ModelProto;
use tract_onnx::prelude::{
    DatumType, Framework, InferenceFact, InferenceModel, InferenceModelExt, IntoRunnable, IntoTValue, Tensor,
    TractError, TypedModel, TypedRunnableModel, tvec,
};
use tract_onnx::tract_hir::infer::Factoid;

/// Reads the contents of an ONNX file within the limits.
///
/// # Errors
/// The contents are no ONNX file, or the network is beyond a limit.
pub(crate) fn parsed(contents: &[u8]) -> Result<(ModelProto, InferenceModel), ModelError> {
    if contents.len() > MOST_MEBIBYTES << 20 {
        return Err(Limit::Size.into());
    }
    let file = tract_onnx::onnx().proto_model_for_read(&mut Cursor::new(contents)).map_err(unreadable)?;
    check(&file)?;
    let model = tract_onnx::onnx().model_for_proto_model(&file).map_err(unreadable)?;
    Ok((file, model))
}

/// Prepares a network with known inputs to be run.
///
/// # Errors
/// The network has operations that cannot be run, or its tensors are beyond the limit.
pub(crate) fn optimised(model: InferenceModel) -> Result<TypedModel, ModelError> {
    let model = model.into_typed().map_err(unreadable)?;
    check_tensors(&model)?;
    let model = model.into_optimized().map_err(unreadable)?;
    check_tensors(&model)?;
    Ok(model)
}

pub(crate) fn unreadable(source: TractError) -> ModelError {
    ModelError::Unreadable { source }
}

/// A network that can be run. Copies share the weights.
#[derive(Debug, Clone)]
pub(crate) struct Plan {
    runnable: Arc<TypedRunnableModel>,
    input: Vec<usize>,
    /// The name and the shape of each output.
    outputs: Vec<(String, Vec<usize>)>,
}

impl Plan {
    /// Reads a network from the contents of an ONNX file. Its input has to fit the given shape.
    ///
    /// # Errors
    /// The contents are no ONNX file, the network is beyond a limit, has another input, or has an output that is not of
    /// floats or has no fixed shape.
    pub fn read(contents: &[u8], input: &[usize]) -> Result<Self, ModelError> {
        // The library panics on some networks that no software writes.
        panic::catch_unwind(|| Self::parse(contents, input)).unwrap_or(Err(ModelError::Broken))
    }

    fn parse(contents: &[u8], input: &[usize]) -> Result<Self, ModelError> {
        let (file, model) = parsed(contents)?;
        let names = file.graph.as_ref().map(|graph| graph.output.iter().map(|output| output.name.clone()).collect());
        let names: Vec<String> = names.unwrap_or_default();
        let expected = || {
            let sizes: Vec<String> = input.iter().map(usize::to_string).collect();
            format!("one image of {}, float", sizes.join(" x "))
        };
        if model.inputs.len() != 1 {
            return Err(ModelError::Input { found: format!("{} tensors", model.inputs.len()), expected: expected() });
        }
        let fact = model.input_fact(0).map_err(unreadable)?;
        let known: Vec<Option<i64>> =
            fact.shape.dims().map(|size| size.concretize().and_then(|size| size.to_i64().ok())).collect();
        let fits = |(known, size): (&Option<i64>, &usize)| known.is_none_or(|known| known == *size as i64);
        let is_open = fact.shape.rank().concretize().is_none();
        let of_floats = fact.datum_type.concretize().is_none_or(|kind| kind == DatumType::F32);
        let has_shape = is_open || known.len() == input.len() && known.iter().zip(input).all(fits);
        if !has_shape || !of_floats {
            return Err(ModelError::Input { found: fact.format_dt_shape(), expected: expected() });
        }
        let model = model.with_input_fact(0, InferenceFact::dt_shape(DatumType::F32, input)).map_err(unreadable)?;
        let model = optimised(model)?;
        let mut outputs = Vec::new();
        for (place, name) in names.into_iter().enumerate() {
            let fact = model.output_fact(place).map_err(unreadable)?;
            let shape = fact.shape.as_concrete().filter(|_| fact.datum_type == DatumType::F32).ok_or_else(|| {
                let (found, expected) = (format!("{fact:?}"), "floats of a fixed shape".to_owned());
                ModelError::Output { name: name.clone(), found, expected }
            })?;
            outputs.push((name, shape.to_vec()));
        }
        let runnable = model.into_runnable().map_err(unreadable)?;
        Ok(Self { runnable, input: input.to_vec(), outputs })
    }

    /// Returns the place of the output with a name, which has to exist.
    pub fn place(&self, name: &str) -> usize {
        self.outputs.iter().position(|(known, _)| known == name).unwrap_or_default()
    }

    /// Returns the shape of the output with a name.
    ///
    /// # Errors
    /// No output has the name.
    pub fn output(&self, name: &str) -> Result<&[usize], ModelError> {
        let names = || self.outputs.iter().map(|(name, _)| name.as_str());
        let found = self.outputs.iter().find(|(known, _)| known == name);
        found.map(|(_, shape)| &shape[..]).ok_or_else(|| ModelError::NoOutput {
            name: name.to_owned(),
            expected: names().collect::<Vec<_>>().join(", "),
            nearest: nearest(name, names()).map(str::to_owned),
        })
    }

    /// Runs the network on the numbers of its input, and returns the numbers of each output.
    ///
    /// # Errors
    /// The network cannot be run.
    pub fn run(&self, numbers: &[f32]) -> Result<Vec<Vec<f32>>, AnswerError> {
        let wrong = |source: TractError| AnswerError::Run { source };
        let input = Tensor::from_shape(&self.input, numbers).map_err(wrong)?;
        let outputs = self.runnable.run(tvec![input.into_tvalue()]).map_err(wrong)?;
        let numbers = outputs.iter().map(|output| Ok(output.to_plain_array_view::<f32>()?.iter().copied().collect()));
        numbers.collect::<Result<_, TractError>>().map_err(wrong)
    }
}
