//! Places labels so that they do not overlap. A label that finds no room is left out.

use super::drawing::{Anchor, PictureItem, Pixel};
use super::legend::{INK, PAPER, text_width};
use nalgebra::Vector2;

/// The places of a picture where no further label may be.
#[derive(Debug)]
pub(super) struct Labels {
    /// The width and the height of the picture in pixels.
    size: [f64; 2],
    taken: Vec<[f64; 4]>,
}

/// The size of the letters in pixels.
const SIZE: f64 = 13.0;

impl Labels {
    /// Makes an empty set of labels for a picture with a width and a height in pixels.
    pub fn on(size: [f64; 2]) -> Self {
        Self { size, taken: Vec::new() }
    }

    /// Reserves a square around a position, so that no label covers it; the square extends `by` pixels to each side.
    pub fn keep_off(&mut self, [x, y]: Pixel, by: f64) {
        self.taken.push([x - by, y - by, x + by, y + by]);
    }

    /// Returns a label `gap` pixels beside a position, in the first of the given directions that has room. `None` if
    /// no direction has room.
    pub fn place(
        &mut self,
        text: &str,
        [x, y]: Pixel,
        gap: f64,
        directions: impl IntoIterator<Item = Vector2<f64>>,
    ) -> Option<PictureItem> {
        let (wide, high) = (0.5 * text_width(text, SIZE) + 3.0, 0.5 * SIZE + 1.0);
        let room = |[x, y]: Pixel| [x - wide, y - high, x + wide, y + high];
        let free = |room: &[f64; 4]| {
            let inside = room[0] >= 0.0 && room[1] >= 0.0 && room[2] <= self.size[0] && room[3] <= self.size[1];
            let apart = |taken: &[f64; 4]| {
                taken[2] <= room[0] || room[2] <= taken[0] || taken[3] <= room[1] || room[3] <= taken[1]
            };
            inside && self.taken.iter().all(apart)
        };
        let place = |way: Vector2<f64>| {
            let away = gap + wide * way.x.abs() + high * way.y.abs();
            [x + away * way.x, y + away * way.y]
        };
        let at = directions.into_iter().map(place).find(|place| free(&room(*place)))?;
        self.taken.push(room(at));
        let at = [at[0], at[1] + 0.36 * SIZE];
        let halo = Some(PAPER);
        Some(PictureItem::Text { at, anchor: Anchor::Middle, size: SIZE, colour: INK, halo, text: text.to_owned() })
    }
}
