//! Labels that keep out of each other's way: one that finds no room is left out.

use super::drawing::{Anchor, Colour, Mark, Pixel};
use super::legend::{PAPER, text_width};

/// Where there are labels already.
#[derive(Debug, Default)]
pub(super) struct Labels {
    taken: Vec<[f64; 4]>,
}

/// The size of letters in pixels.
const SIZE: f64 = 13.0;

impl Labels {
    /// Keeps labels away from here: a square with sides of twice these pixels.
    pub fn keep_off(&mut self, [x, y]: Pixel, by: f64) {
        self.taken.push([x - by, y - by, x + by, y + by]);
    }

    /// The label, with its middle at the first of these places where there is room.
    pub fn place(&mut self, text: &str, colour: Colour, places: impl IntoIterator<Item = Pixel>) -> Option<Mark> {
        let (wide, high) = (0.5 * text_width(text, SIZE) + 3.0, 0.5 * SIZE + 1.0);
        let room = |[x, y]: Pixel| [x - wide, y - high, x + wide, y + high];
        let free = |room: &[f64; 4]| {
            let apart = |taken: &[f64; 4]| {
                taken[2] <= room[0] || room[2] <= taken[0] || taken[3] <= room[1] || room[3] <= taken[1]
            };
            self.taken.iter().all(apart)
        };
        let at = places.into_iter().find(|place| free(&room(*place)))?;
        self.taken.push(room(at));
        let at = [at[0], at[1] + 0.36 * SIZE];
        let halo = Some(PAPER);
        Some(Mark::Text { at, anchor: Anchor::Middle, size: SIZE, colour, halo, text: text.to_owned() })
    }
}
