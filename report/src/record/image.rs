//! Writes images as PNG files.

use paracosm_campaign::{Error, Failure};
use png::{BitDepth, ColorType};
use std::path::Path;

/// The steps per metre in a depth image, as in the KITTI format.
pub(super) const DEPTH_STEPS: f32 = 256.0;

/// The pixels of an image, in the form in which they are written.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Pixels<'a> {
    /// The red, green and blue of each pixel, with 8 bits each.
    Colours(&'a [u8]),
    /// A number with 8 bits for each pixel, which viewers show in the colour of the palette at this number.
    Indices(&'a [u8], &'a [[u8; 3]]),
    /// A number with 16 bits for each pixel.
    Words(&'a [u16]),
}

/// Returns the contents of a PNG file with the given width and height in pixels.
pub(crate) fn png(pixels: Pixels<'_>, [width, height]: [u32; 2]) -> Result<Vec<u8>, png::EncodingError> {
    let mut file = Vec::new();
    let mut encoder = png::Encoder::new(&mut file, width, height);
    let (colour, depth, bytes) = match pixels {
        Pixels::Colours(bytes) => (ColorType::Rgb, BitDepth::Eight, bytes.to_vec()),
        Pixels::Indices(indices, palette) => {
            encoder.set_palette(palette.concat());
            (ColorType::Indexed, BitDepth::Eight, indices.to_vec())
        }
        Pixels::Words(words) => {
            (ColorType::Grayscale, BitDepth::Sixteen, words.iter().flat_map(|word| word.to_be_bytes()).collect())
        }
    };
    encoder.set_color(colour);
    encoder.set_depth(depth);
    encoder.write_header()?.write_image_data(&bytes)?;
    Ok(file)
}

/// Converts depths in metres to the KITTI format: 256 steps per metre, and 0 if the point is too far away or there is
/// none.
pub(super) fn depth_words(depth: &[f32]) -> Vec<u16> {
    let word = |metres: &f32| {
        let steps = (metres * DEPTH_STEPS).round();
        if steps <= f32::from(u16::MAX) { (steps as u16).max(1) } else { 0 }
    };
    depth.iter().map(word).collect()
}

/// Writes a PNG file. The file is not safe against a power cut; instead, the folder around it gets its name only when
/// it is complete.
pub(super) fn write(path: &Path, pixels: Pixels<'_>, size: [u32; 2]) -> Result<(), Error> {
    let failed = |error: png::EncodingError| Failure::Drawing { path: path.to_owned(), source: error.into() };
    let contents = png(pixels, size).map_err(failed)?;
    std::fs::write(path, contents).map_err(Error::io("write", path))
}
