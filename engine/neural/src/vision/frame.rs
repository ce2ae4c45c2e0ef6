//! The way of an image into a network and of places back: resizing, and the order and the scale of the channels.

use super::{Colours, Input, Resize};
use paracosm_perception::Picture;

/// The grey of the field around an image that keeps its proportions.
const GREY: f32 = 114.0;

/// The place of an image on the input of a network, in pixels of the input.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Placed {
    /// The width and the height of the image.
    image: [f64; 2],
    /// The pixels of the input for a pixel of the image, along x and y.
    factor: [f64; 2],
    /// The left upper corner of the image on the input.
    corner: [f64; 2],
}

impl Placed {
    pub fn of(input: &Input, picture: &Picture<'_>) -> Self {
        let image = [f64::from(picture.width), f64::from(picture.height)];
        let size = input.size.map(|pixels| pixels as f64);
        let stretched = [size[0] / image[0], size[1] / image[1]];
        let factor = match input.resize {
            Resize::Stretch => stretched,
            Resize::Letterbox => [stretched[0].min(stretched[1]); 2],
        };
        let corner = [0, 1].map(|axis| 0.5 * (size[axis] - factor[axis] * image[axis]));
        Self { image, factor, corner }
    }

    /// Returns the place on the image of a place on the input.
    pub fn on_image(&self, place: [f64; 2]) -> [f64; 2] {
        [0, 1].map(|axis| (place[axis] - self.corner[axis]) / self.factor[axis])
    }

    /// Returns the place on the input of a place on the image.
    pub fn on_input(&self, place: [f64; 2]) -> [f64; 2] {
        [0, 1].map(|axis| place[axis] * self.factor[axis] + self.corner[axis])
    }
}

/// A weighted pair of neighbouring pixels; `None` outside of the image.
type Between = Option<(usize, usize, f32)>;

/// Returns the input of a network for an image: channel by channel, in rows from the top. Values between pixels are
/// interpolated linearly.
pub(super) fn tensor(input: &Input, picture: &Picture<'_>) -> Vec<f32> {
    let placed = Placed::of(input, picture);
    let [width, height] = input.size;
    let along = |axis: usize, count: usize| -> Vec<Between> {
        let between = |pixel: usize| {
            let place = (pixel as f64 + 0.5 - placed.corner[axis]) / placed.factor[axis];
            let last = placed.image[axis] - 1.0;
            if !(0.0..placed.image[axis]).contains(&place) {
                return None;
            }
            let place = (place - 0.5).clamp(0.0, last);
            let first = place as usize;
            Some((first, (first + 1).min(last as usize), (place - first as f64) as f32))
        };
        (0..count).map(between).collect()
    };
    let (columns, rows) = (along(0, width), along(1, height));
    let mut tensor = Vec::with_capacity(3 * width * height);
    for (channel, (mean, scale)) in input.mean.iter().zip(&input.scale).enumerate() {
        let colour = if input.colours == Colours::Bgr { 2 - channel } else { channel };
        let value =
            |column: usize, row: usize| f32::from(picture.rgb[3 * (row * picture.width as usize + column) + colour]);
        for row in &rows {
            for column in &columns {
                let value = match (row, column) {
                    (Some((top, bottom, down)), Some((left, right, aside))) => {
                        let upper = value(*left, *top) * (1.0 - aside) + value(*right, *top) * aside;
                        let lower = value(*left, *bottom) * (1.0 - aside) + value(*right, *bottom) * aside;
                        upper * (1.0 - down) + lower * down
                    }
                    _ => GREY,
                };
                tensor.push((value - mean) * scale);
            }
        }
    }
    tensor
}
