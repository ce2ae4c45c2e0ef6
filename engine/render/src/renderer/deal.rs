//! Which views are drawn together.

use super::prepare::Prepared;
use super::targets::Format;
use crate::{Camera, Outputs};

/// The most views in a batch.
const MOST_LAYERS: usize = 64;
/// The most bytes that are read back of a batch of more than one view. With as much on the adapter's side, and two
/// batches under way, it bounds the memory that images take.
const MOST_BYTES: u64 = 48 << 20;

/// A view in a batch.
#[derive(Debug)]
pub(super) struct Layer<'a> {
    /// Which of the views it is.
    pub index: usize,
    pub camera: &'a Camera,
    pub prepared: Prepared,
}

/// Views of one size that are drawn together.
#[derive(Debug)]
pub(super) struct Hand<'a> {
    pub format: Format,
    pub layers: Vec<Layer<'a>>,
    bytes: u64,
}

/// Deals views out: to hands of one size each, and not too many to any.
pub(super) fn deal(layers: Vec<Layer<'_>>, wanted: Outputs, limit: usize) -> Vec<Hand<'_>> {
    let mut hands: Vec<Hand<'_>> = Vec::new();
    for layer in layers {
        let format = Format { width: layer.camera.width(), height: layer.camera.height(), wanted };
        let bytes = format.bytes() + format.mask_bytes(layer.prepared.words());
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
