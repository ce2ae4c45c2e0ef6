//! Reads the frames of a batch from its bytes.

use super::images::Image;
use super::targets::Format;
use crate::frame::Extent;
use crate::{Camera, Frame};
use std::collections::BTreeMap;

/// Returns the frames of a batch. The bytes hold the images one after the other, and of each image the layers of these
/// cameras.
pub(super) fn frames(format: Format, bytes: &[u8], cameras: &[&Camera]) -> Vec<Frame> {
    let mut begin = 0;
    let mut images = Vec::new();
    for image in format.images() {
        let stride = format.stride(image) as usize;
        images.push((image, begin, stride));
        begin += stride * cameras.len();
    }
    let frame = |(layer, camera): (usize, &&Camera)| {
        let mut frame = Frame {
            camera: (*camera).clone(),
            rgb: None,
            linear: None,
            depth: None,
            semantic: None,
            instance: None,
            alone: None,
        };
        for (image, begin, stride) in &images {
            let layer = &bytes[begin + layer * stride..][..*stride];
            let rows = layer.chunks_exact(format.pitch(*image) as usize);
            let rows = rows.map(|row| &row[..format.width as usize * image.bytes() as usize]);
            fill(&mut frame, *image, rows, format.pixels() as usize);
        }
        frame
    };
    cameras.iter().enumerate().map(frame).collect()
}

fn fill<'a>(frame: &mut Frame, image: Image, rows: impl Iterator<Item = &'a [u8]>, pixels: usize) {
    match image {
        Image::Rgb => {
            let mut rgb = vec![0; pixels * 3];
            let opaque = rows.flat_map(|row| row.as_chunks::<4>().0);
            for (pixel, [red, green, blue, _]) in rgb.as_chunks_mut::<3>().0.iter_mut().zip(opaque) {
                *pixel = [*red, *green, *blue];
            }
            frame.rgb = Some(rgb);
        }
        Image::Linear => {
            let pixel =
                |pixel: &[u8; 16]| [0, 4, 8].map(|at| f32::from_ne_bytes([0, 1, 2, 3].map(|byte| pixel[at + byte])));
            frame.linear = Some(rows.flat_map(|row| row.as_chunks().0).flat_map(pixel).collect());
        }
        Image::Depth => frame.depth = Some(gathered(rows, pixels, |pixel| f32::from_ne_bytes(*pixel))),
        Image::Semantic => frame.semantic = Some(gathered(rows, pixels, |[class]| *class)),
        Image::Instance => frame.instance = Some(gathered(rows, pixels, |pixel| u16::from_ne_bytes(*pixel))),
    }
}

/// Collects the pixels of several rows, of `N` bytes each.
fn gathered<'a, T, const N: usize>(
    rows: impl Iterator<Item = &'a [u8]>,
    pixels: usize,
    pixel: impl Fn(&[u8; N]) -> T + Copy,
) -> Vec<T> {
    let mut all = Vec::with_capacity(pixels);
    rows.for_each(|row| all.extend(row.as_chunks().0.iter().map(pixel)));
    all
}

/// Returns the pixels that each object would have if it were alone, from the masks of a view from row `top` on.
pub(super) fn alone(format: Format, top: u32, masks: &[u8], bits: &BTreeMap<u16, u32>) -> Vec<Extent> {
    let ids: Vec<u16> = bits.keys().copied().collect();
    let words = ids.len().div_ceil(32);
    let mut extents: Vec<Option<Extent>> = vec![None; ids.len()];
    for (index, word) in masks.as_chunks().0.iter().map(|word| u32::from_ne_bytes(*word)).enumerate() {
        let pixel = (index / words) as u32;
        let at = [pixel % format.width, top + pixel / format.width];
        let mut left = word;
        while left != 0 {
            let bit = index % words * 32 + left.trailing_zeros() as usize;
            left &= left - 1;
            match &mut extents[bit] {
                Some(extent) => extent.add(at),
                none => *none = Some(Extent::of_pixel(ids[bit], at)),
            }
        }
    }
    extents.into_iter().flatten().collect()
}
