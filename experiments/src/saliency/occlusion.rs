//! Measures how much each place of an image matters: a patch covers the place, and the network is asked again (Zeiler
//! and Fergus, "Visualizing and Understanding Convolutional Networks", 2014).

use super::frames::Seen;
use paracosm::engine::object::Colour;
use paracosm::engine::sensor::Image;
use paracosm_neural::{AnswerError, Model};
use rayon::prelude::*;

/// The colour that is zero to the network, which subtracts half of the range from every colour.
pub const NOTHING: Colour = [128; 3];

/// Returns for each pixel how much steering and throttle change if a patch of this width and height covers the image
/// around the pixel.
pub fn changes(
    model: &Model,
    image: &Image,
    speed: f64,
    patch: [usize; 2],
    fill: Colour,
) -> Result<Vec<[f64; 2]>, AnswerError> {
    let before = model.answer(image, speed)?;
    let (width, height) = (image.width as usize, image.height as usize);
    let change = |pixel: usize| {
        let answer = model.answer(&covered(image, [pixel % width, pixel / width], patch, fill), speed)?;
        Ok([0, 1].map(|i| f64::from(answer[i] - before[i])))
    };
    (0..width * height).into_par_iter().map(change).collect()
}

/// Returns the image with a patch around a pixel. The part of the patch beyond the image is left out.
pub fn covered(image: &Image, [column, row]: [usize; 2], patch: [usize; 2], fill: Colour) -> Image {
    let (width, height) = (image.width as usize, image.height as usize);
    let mut rgb = image.rgb.clone();
    let span = |middle: usize, size: usize, end: usize| {
        (middle.saturating_sub(size / 2), (middle + size.div_ceil(2)).min(end))
    };
    let ((left, right), (top, bottom)) = (span(column, patch[0], width), span(row, patch[1], height));
    for y in top..bottom {
        rgb[3 * (y * width + left)..3 * (y * width + right)].chunks_exact_mut(3).for_each(|pixel| {
            pixel.copy_from_slice(&fill);
        });
    }
    Image { rgb, ..image.clone() }
}

/// Returns the places at which a square patch of this side covers a pixel of the leader.
pub fn touching(seen: &Seen, side: usize) -> Vec<bool> {
    let (width, height) = (seen.width(), seen.height());
    let reach = side / 2;
    let touches = |pixel: usize| {
        let (column, row) = (pixel % width, pixel / width);
        let columns = column.saturating_sub(reach)..=(column + reach).min(width - 1);
        let rows = row.saturating_sub(reach)..=(row + reach).min(height - 1);
        rows.into_iter().any(|row| columns.clone().any(|column| seen.leader[row * width + column]))
    };
    (0..width * height).map(touches).collect()
}

/// Returns the share of all changes that lies at these places.
pub fn share(changes: &[[f64; 2]], output: usize, places: &[bool]) -> f64 {
    let sum = |of: &dyn Fn(usize) -> bool| -> f64 {
        changes.iter().enumerate().filter(|(i, _)| of(*i)).map(|(_, change)| change[output].abs()).sum()
    };
    sum(&|i| places[i]) / sum(&|_| true)
}
