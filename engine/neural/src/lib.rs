//! Networks: networks that drive by a camera, the training of such networks, and networks that see (`vision`).
//!
//! A network that drives is a file in the ONNX format, whoever made it. `Model` reads the file and `Pilot` drives with
//! it (feature `onnx`). `learn::Learner` trains a network and writes such a file, too (feature `train`), so there is
//! one way to drive by a network. Without these features the crate is empty, and none of the heavy dependencies is
//! built.
//!
//! # The inputs and outputs of a model
//!
//! | tensor | shape | meaning |
//! | --- | --- | --- |
//! | input 1 | 1 x 3 x height x width, float | the camera's newest image: red, green, blue from 0 to 1 (sRGB bytes / 255), from the top left |
//! | input 2, may be left out | 1 x 1, float | the car's speed in m/s |
//! | output | 1 x 2, float | steering from -1, right, to 1, left; throttle from -1, full brakes, to 1, full power |
//!
//! The names of the tensors do not matter. The first dimension may be left open. Answers beyond the ends of a range
//! count as the ends. The driver's camera has the model's height and width, from 8 to 1024 pixels. The camera looks
//! ahead from behind the windscreen, 74 degrees across, ten times a second. The property `look` of the file names the
//! look of the images, `flat` or `textured`; without it, the look is `flat`. The driver asks the model once for every
//! image.
//!
//! ```
//! # #[cfg(feature = "onnx")] {
//! use paracosm_neural::{CLONED, Model, Pilot};
//!
//! let follow = CLONED.iter().find(|network| network.name == "follow").expect("the network comes with the crate");
//! let model = Model::read(follow.contents)?;
//! println!("images of {:?} pixels", model.resolution());
//! let driver = Pilot::new(model);
//! # }
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

#[cfg(feature = "onnx")]
mod cloned;
#[cfg(feature = "onnx")]
mod error;
#[cfg(feature = "train")]
mod export;
#[cfg(feature = "train")]
pub mod learn;
#[cfg(feature = "onnx")]
mod limits;
#[cfg(feature = "onnx")]
mod model;
#[cfg(feature = "train")]
mod network;
#[cfg(feature = "train")]
mod onnx_file;
#[cfg(feature = "onnx")]
mod pilot;
#[cfg(feature = "onnx")]
mod plan;
#[cfg(feature = "onnx")]
pub mod vision;

#[cfg(feature = "onnx")]
pub use cloned::{CLONED, Cloned};
#[cfg(feature = "onnx")]
pub use error::{AnswerError, ModelError};
#[cfg(feature = "onnx")]
pub use limits::{Limit, MOST_MEBIBYTES};
#[cfg(feature = "onnx")]
pub use model::Model;
#[cfg(feature = "onnx")]
pub use pilot::{PERIOD, Pilot, camera};
