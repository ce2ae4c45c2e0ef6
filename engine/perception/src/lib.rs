//! Perception networks on trial: the answers of a network to images, the ground truth, and the measures that compare
//! them.
//!
//! A [`Perceiver`] answers an image with boxes or with a mask. Its [`Task`] says what the answer means. The
//! measures are the standard measures of the field: matches by overlap as COCO defines them ([`match_boxes`]), average
//! precision ([`Tally`]), and the overlap of masks ([`Confusion`]). An [`Encounter`] follows one object from
//! image to image. The crate draws nothing and runs no network.
//!
//! Pixels: x to the right and y down, in pixels from the left upper corner of the image. A box is given by the edges of
//! its pixels, so a box around one pixel has the width 1.

mod bins;
mod boxes;
mod detection;
mod encounter;
mod mask;
mod matching;
mod object;
mod perceiver;
mod precision;
mod task;
#[cfg(test)]
mod tests;

pub use bins::{Axis, BINS, Bin};
pub use boxes::Rect;
pub use detection::{Detection, suppress};
pub use encounter::{Encounter, Encounters};
pub use mask::{Confusion, Mask};
pub use matching::{Criterion, Matching, match_boxes};
pub use object::{Areas, Object};
pub use perceiver::{Perceiver, PerceiverError, Percept, Picture};
pub use precision::Tally;
pub use task::{Detector, Extent, Group, KINDS, Segmenter, Task, TaskFlaw};
