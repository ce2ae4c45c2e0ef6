//! Cuts the masks of objects alone into bands of rows, so that any number of objects fits into one buffer.
//!
//! A view of several bands becomes several layers: the first has the view's images and the first band, and each of the
//! others has one band.

use super::deal::Layer;
use super::prepare::Prepared;
use super::targets::Format;
use crate::frame::Extent;
use crate::{Camera, Frame};
use std::collections::BTreeMap;
use std::iter::repeat_n;
use std::ops::Range;

/// The most bytes of masks at a time, if the adapter takes that many.
pub(super) const MOST_BYTES: u64 = 128 << 20;

/// Returns the layers of a view whose masks may take `limit` bytes at a time.
pub(super) fn layers<'a>(
    (index, camera): (usize, &'a Camera),
    prepared: Prepared,
    format: Format,
    limit: u64,
) -> impl Iterator<Item = Layer<'a>> {
    let bands = bands(format, prepared.words(), limit);
    let copies = repeat_n(prepared, bands.len());
    bands.into_iter().zip(copies).map(move |(rows, prepared)| Layer { index, camera, prepared, rows })
}

/// Returns the range of image rows of each band.
fn bands(format: Format, words: u32, limit: u64) -> Vec<Range<u32>> {
    let row = format.mask_bytes(words, 1).max(1);
    let high = u32::try_from(limit / row).unwrap_or(u32::MAX).clamp(1, format.height);
    let band = |top: u32| top..(top + high).min(format.height);
    (0..format.height).step_by(high as usize).map(band).collect()
}

/// Joins the frames of two layers of one view, in either order.
pub(super) fn joined(a: Frame, b: Frame, b_has_images: bool) -> Frame {
    let (mut whole, mut part) = if b_has_images { (b, a) } else { (a, b) };
    let mut extents: BTreeMap<u16, Extent> = BTreeMap::new();
    for extent in whole.alone.take().into_iter().chain(part.alone.take()).flatten() {
        extents.entry(extent.id).and_modify(|before| before.join(&extent)).or_insert(extent);
    }
    whole.alone = Some(extents.into_values().collect());
    whole
}
