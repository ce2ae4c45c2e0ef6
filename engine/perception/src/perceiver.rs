//! The system under test: anything that answers images with boxes or masks.

use crate::{Detection, Mask, Rect, Task};
use std::error::Error;
use std::sync::Arc;

/// An image for a perceiver.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Picture<'a> {
    /// The width in pixels.
    pub width: u32,
    /// The height in pixels.
    pub height: u32,
    /// Red, green and blue of each pixel in sRGB, in rows from the top.
    pub rgb: &'a [u8],
}

/// The answer of a perceiver to an image.
#[derive(Debug, Clone, PartialEq)]
pub enum Percept {
    /// All boxes that the detector considers, in pixels of the image, before any threshold and suppression.
    Boxes(Vec<Detection>),
    /// The mask, of the size of the image.
    Mask(Mask),
}

/// The reason why a perceiver has no valid answer.
#[derive(Debug, Clone, thiserror::Error)]
pub enum PerceiverError {
    /// A box has a class that the detector does not have.
    #[error("a box has the class {class}, expected a number below {classes}")]
    Class {
        /// The number of the class.
        class: usize,
        /// The number of classes of the detector.
        classes: usize,
    },
    /// The score of a box is not within 0 and 1.
    #[error("a box has the score {score}, expected a number from 0 to 1")]
    Score {
        /// The score of the box.
        score: f64,
    },
    /// A box is not finite, or has a negative size.
    #[error(
        "a box is {left}, {top}, {width}, {height} (left, top, width, height), expected finite pixels and no negative size",
        left = rect.left, top = rect.top, width = rect.width, height = rect.height
    )]
    Rect {
        /// The box.
        rect: Rect,
    },
    /// The number of answers is not the number of images.
    #[error("{found} answers to {expected} images, expected one for each image")]
    Count {
        /// The number of answers.
        found: usize,
        /// The number of images.
        expected: usize,
    },
    /// A detector answers with a mask, or a segmentation network with boxes.
    #[error("the answer is {found}, expected {expected}")]
    Kind {
        /// The kind of the answer, in words.
        found: &'static str,
        /// The kind that the task asks for, in words.
        expected: &'static str,
    },
    /// A mask has another size than its image.
    #[error("the mask has {found} pixels, expected {expected}: one for each pixel of the image")]
    Size {
        /// The number of pixels of the mask.
        found: usize,
        /// The number of pixels of the image.
        expected: usize,
    },
    /// A mask has a score that is no number.
    #[error("a pixel of the mask has a score that is no number")]
    Pixel,
    /// The perceiver failed with an error of its own.
    #[error("the perceiver failed: {0}")]
    Failed(Arc<dyn Error + Send + Sync>),
}

/// A perception network, or another program that perceives.
pub trait Perceiver: Send {
    /// Returns the meaning of the answers.
    fn task(&self) -> &Task;

    /// Returns the factor that makes pixels of the perceiver's input from pixels of an image of this width and height,
    /// by the height. Recall is counted by the height of road users in the input.
    fn scale(&self, _width: u32, _height: u32) -> f64 {
        1.0
    }

    /// Answers images, in their order. An answer depends on its image alone.
    ///
    /// # Errors
    /// The perceiver has no answer to an image, or its answer is invalid.
    fn perceive(&mut self, pictures: &[Picture<'_>]) -> Result<Vec<Percept>, PerceiverError>;
}

impl Task {
    /// Checks the answers of a perceiver to images.
    ///
    /// # Errors
    /// An answer is missing, is not the kind of answer that the task asks for, does not fit its image, or has a detection
    /// that is not valid.
    pub fn check(&self, pictures: &[Picture<'_>], percepts: &[Percept]) -> Result<(), PerceiverError> {
        let (found, expected) = (percepts.len(), pictures.len());
        if found != expected {
            return Err(PerceiverError::Count { found, expected });
        }
        for (picture, percept) in pictures.iter().zip(percepts) {
            match (self, percept) {
                (Self::Detection(detector), Percept::Boxes(boxes)) => {
                    boxes.iter().try_for_each(|one| one.check(detector.classes.len()))?;
                }
                (Self::Segmentation(_), Percept::Mask(mask)) => {
                    let (found, expected) = (mask.pixels.len(), picture.width as usize * picture.height as usize);
                    if found != expected || mask.width != picture.width {
                        return Err(PerceiverError::Size { found, expected });
                    }
                }
                (Self::Detection(_), Percept::Mask(_)) => {
                    return Err(PerceiverError::Kind { found: "a mask", expected: "boxes" });
                }
                (Self::Segmentation(_), Percept::Boxes(_)) => {
                    return Err(PerceiverError::Kind { found: "boxes", expected: "a mask" });
                }
            }
        }
        Ok(())
    }
}

impl Detection {
    /// Checks a detection of a detector with the given number of classes. A box may extend beyond the image.
    ///
    /// # Errors
    /// The class does not exist, the score is not within 0 and 1, or the box is not finite or has a negative size.
    pub fn check(&self, classes: usize) -> Result<(), PerceiverError> {
        let Self { class, score, rect } = *self;
        if class >= classes {
            return Err(PerceiverError::Class { class, classes });
        }
        if !(0.0..=1.0).contains(&score) {
            return Err(PerceiverError::Score { score });
        }
        let is_finite = [rect.left, rect.top, rect.width, rect.height].iter().all(|number| number.is_finite());
        if is_finite && rect.width >= 0.0 && rect.height >= 0.0 { Ok(()) } else { Err(PerceiverError::Rect { rect }) }
    }
}
