//! Drivers that learn: networks that drive by a camera, and how they are taught.
//!
//! Whatever drives is a file in the ONNX format, whoever made it: `Model` reads it, `Pilot` puts it at the wheel
//! (feature `onnx`), and what `learn::Learner` teaches a network (feature `train`) is written as such a file, too, so
//! that there is one way to drive by a network. Without the features there is nothing but this page, and none of the heavy
//! dependencies is built.
//!
//! # What a model is asked and answers
//!
//! | tensor | shape | meaning |
//! | --- | --- | --- |
//! | input 1 | 1 x 3 x height x width, float | the camera's newest image: red, green, blue from 0 to 1 (sRGB bytes / 255), from the top left |
//! | input 2, may be left out | 1 x 1, float | the car's speed in m/s |
//! | output | 1 x 2, float | steering from -1, right, to 1, left; throttle from -1, full brakes, to 1, full power |
//!
//! Names do not matter, a first dimension may be left open, and answers beyond the ends are taken for the ends. Height and
//! width, from 8 to 1024 pixels, are those of the camera that the driver mounts: it looks ahead from behind the windscreen,
//! 74 degrees across, ten times a second, and the model is asked once for every image.

#[cfg(feature = "onnx")]
mod cloned;
#[cfg(feature = "train")]
mod export;
#[cfg(feature = "train")]
pub mod learn;
#[cfg(feature = "onnx")]
mod model;
#[cfg(feature = "train")]
mod network;
#[cfg(feature = "onnx")]
mod pilot;

#[cfg(feature = "onnx")]
pub use cloned::{CLONED, Cloned};
#[cfg(feature = "onnx")]
pub use model::{AnswerError, Model, ModelError};
#[cfg(feature = "onnx")]
pub use pilot::{PERIOD, Pilot, camera};
