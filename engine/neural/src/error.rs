//! The errors in files of networks, and of networks that are run.

use crate::limits::Limit;
use paracosm_engine::sensor::UnknownLook;
use paracosm_space::did_you_mean;
use thiserror::Error;
use tract_onnx::prelude::TractError;

/// An error in a file that should contain a network.
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
    /// No look of images has the name in the property `look` of the file.
    #[error("the property `look` of the file: {0}")]
    Look(#[from] UnknownLook),
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
