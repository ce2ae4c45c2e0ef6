//! Chooses the views that are drawn together.

use super::prepare::Prepared;
use super::targets::Format;
use crate::{Camera, WantedImages};
use std::ops::Range;

/// The most views in a batch.
const MOST_LAYERS: usize = 64;
/// The most bytes that are read back of a batch of more than one view. It bounds the memory that images take: the
/// adapter holds as much again, and two batches are under way.
const MOST_BYTES: u64 = 48 << 20;

/// A view in a batch.
#[derive(Debug)]
pub(super) struct Layer<'a> {
    /// The index of the view among all views of the call.
    pub index: usize,
    pub camera: &'a Camera,
    pub prepared: Prepared,
    /// The range of image rows in which the layer draws the masks of objects without occlusion.
    pub rows: Range<u32>,
}

impl Layer<'_> {
    /// Returns `true` if the layer contains the images of its view in addition to masks.
    pub fn has_images(&self) -> bool {
        self.rows.start == 0
    }

    /// Returns the size and the kinds of the layer's images.
    fn format(&self, wanted: WantedImages) -> Format {
        let masks = WantedImages { alone: true, ..WantedImages::default() };
        let wanted = if self.has_images() { wanted } else { masks };
        Format { width: self.camera.width(), height: self.camera.height(), wanted }
    }

    /// Returns the size in bytes of the layer's masks.
    pub fn mask_bytes(&self, format: Format) -> u64 {
        format.mask_bytes(self.prepared.words(), self.rows.len() as u32)
    }
}

/// A hand: views of one size that are drawn together.
#[derive(Debug)]
pub(super) struct Hand<'a> {
    pub format: Format,
    pub layers: Vec<Layer<'a>>,
    bytes: u64,
}

/// Deals views out to hands. Each hand has views of one size, and not too many of them.
pub(super) fn deal(layers: Vec<Layer<'_>>, wanted: WantedImages, limit: usize) -> Vec<Hand<'_>> {
    let mut hands: Vec<Hand<'_>> = Vec::new();
    for layer in layers {
        let format = layer.format(wanted);
        let bytes = format.bytes() + layer.mask_bytes(format);
        let has_room = |hand: &&mut Hand<'_>| {
            hand.format == format && hand.bytes + bytes <= MOST_BYTES && hand.layers.len() < MOST_LAYERS.min(limit)
        };
        match hands.iter_mut().rev().find(has_room) {
            Some(hand) => {
                hand.bytes += bytes;
                hand.layers.push(layer);
            }
            None => hands.push(Hand { format, layers: vec![layer], bytes }),
        }
    }
    hands
}
