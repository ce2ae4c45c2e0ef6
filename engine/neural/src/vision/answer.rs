//! The way from the output tensors of a network to boxes or to a mask on the image.

use super::frame::Placed;
use super::{Form, Input, Unit};
use paracosm_perception::{Detection, Mask, PerceiverError, Picture, Rect};

/// Scores below this score are no detections for any measure. Most of the thousands of boxes of a detector are below.
const LEAST: f32 = 0.01;

/// Returns the boxes of a detector whose scores are at least [`LEAST`], in pixels of the image. Each box has a detection
/// for each such class.
pub(super) fn boxes(
    (boxes, scores): (&[f32], &[f32]),
    (form, unit): (Form, Unit),
    input: &Input,
    placed: &Placed,
) -> Result<Vec<Detection>, PerceiverError> {
    let classes = scores.len() / (boxes.len() / 4).max(1);
    let size = match unit {
        Unit::Share => input.size.map(|pixels| pixels as f64),
        Unit::Pixels => [1.0; 2],
    };
    let mut found = Vec::new();
    for (corners, scores) in boxes.chunks_exact(4).zip(scores.chunks_exact(classes.max(1))) {
        for (class, score) in scores.iter().enumerate() {
            if score.is_nan() {
                return Err(PerceiverError::Score { score: f64::NAN });
            }
            if *score >= LEAST {
                let numbers = [0, 1, 2, 3].map(|place| f64::from(corners[place]));
                let [left, top, right, bottom] = match form {
                    Form::Xyxy => numbers,
                    Form::Yxyx => [numbers[1], numbers[0], numbers[3], numbers[2]],
                    Form::Cxcywh => {
                        let [x, y, width, height] = numbers;
                        [x - 0.5 * width, y - 0.5 * height, x + 0.5 * width, y + 0.5 * height]
                    }
                };
                let on_image = |x: f64, y: f64| placed.on_image([x * size[0], y * size[1]]);
                // Some networks give the corners of tiny boxes in the wrong order.
                let (from, to) =
                    (on_image(left.min(right), top.min(bottom)), on_image(left.max(right), top.max(bottom)));
                found.push(Detection { class, score: f64::from(score.min(1.0)), rect: Rect::between(from, to) });
            }
        }
    }
    Ok(found)
}

/// Returns the mask of a segmentation network, with the pixels of the image. `scores` has a plane of the given width and
/// height for each class.
pub(super) fn mask(
    (scores, [width, height]): (&[f32], [usize; 2]),
    (positive, threshold): (&[bool], f64),
    input: &Input,
    (placed, picture): (&Placed, &Picture<'_>),
) -> Result<Mask, PerceiverError> {
    if scores.iter().any(|score| score.is_nan()) {
        return Err(PerceiverError::Pixel);
    }
    let plane = width * height;
    let is_positive = |pixel: usize| match positive {
        [_] => f64::from(scores[pixel]) >= threshold,
        several => {
            let score = |class: &usize| scores[class * plane + pixel];
            let best = (0..several.len()).rev().max_by(|a, b| score(a).total_cmp(&score(b)));
            best.is_some_and(|class| several[class])
        }
    };
    let of_input: Vec<bool> = (0..plane).map(is_positive).collect();
    let nearest =
        |place: f64, size: usize, count: usize| ((place / size as f64 * count as f64) as usize).min(count - 1);
    let mut pixels = Vec::with_capacity(picture.width as usize * picture.height as usize);
    for row in 0..picture.height {
        for column in 0..picture.width {
            let [x, y] = placed.on_input([f64::from(column) + 0.5, f64::from(row) + 0.5]);
            let (column, row) = (nearest(x, input.size[0], width), nearest(y, input.size[1], height));
            pixels.push(of_input[row * width + column]);
        }
    }
    Ok(Mask { width: picture.width, height: picture.height, pixels })
}
