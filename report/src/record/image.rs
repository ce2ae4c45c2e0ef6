//! Images as PNG files.

use paracosm_campaign::{Error, Failure};
use png::{BitDepth, ColorType};
use std::path::Path;

/// Metres times this are the numbers of a depth image, as KITTI has them.
pub(super) const DEPTH_STEPS: f32 = 256.0;

/// How the pixels of an image are written.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Pixels<'a> {
    /// Red, green and blue.
    Colours(&'a [u8]),
    /// A number up to 255.
    Bytes(&'a [u8]),
    /// A number up to 65,535.
    Words(&'a [u16]),
}

/// The contents of a PNG file of so many pixels across and down.
pub(super) fn png(pixels: Pixels<'_>, [width, height]: [u32; 2]) -> Result<Vec<u8>, png::EncodingError> {
    let mut file = Vec::new();
    let mut encoder = png::Encoder::new(&mut file, width, height);
    let (colour, depth, bytes) = match pixels {
        Pixels::Colours(bytes) => (ColorType::Rgb, BitDepth::Eight, bytes.to_vec()),
        Pixels::Bytes(bytes) => (ColorType::Grayscale, BitDepth::Eight, bytes.to_vec()),
        Pixels::Words(words) => {
            (ColorType::Grayscale, BitDepth::Sixteen, words.iter().flat_map(|word| word.to_be_bytes()).collect())
        }
    };
    encoder.set_color(colour);
    encoder.set_depth(depth);
    encoder.write_header()?.write_image_data(&bytes)?;
    Ok(file)
}

/// Depths in metres as KITTI writes them: 256 times as much, and 0 for what is too far or nothing at all.
pub(super) fn depth_words(depth: &[f32]) -> Vec<u16> {
    let word = |metres: &f32| {
        let steps = (metres * DEPTH_STEPS).round();
        if steps <= f32::from(u16::MAX) { (steps as u16).max(1) } else { 0 }
    };
    depth.iter().map(word).collect()
}

/// Writes a PNG file. It is not kept from a power cut: what holds it gets its name when it is whole.
pub(super) fn write(path: &Path, pixels: Pixels<'_>, size: [u32; 2]) -> Result<(), Error> {
    let failed = |error: png::EncodingError| Failure::Drawing { path: path.to_owned(), source: error.into() };
    let contents = png(pixels, size).map_err(failed)?;
    std::fs::write(path, contents).map_err(Error::io("write", path))
}
