//! The pictures on the surfaces of users' models, all of one size, so that an adapter keeps them as layers of one array.

use rayon::prelude::*;
use std::sync::LazyLock;

/// The number of texels of a picture each way.
pub(crate) const SIDE: u32 = 1024;
/// The number of mipmaps of a picture.
pub(crate) const LEVELS: u32 = SIDE.ilog2() + 1;
/// The most pictures of a model.
pub(crate) const MOST: usize = 16;

/// A picture with its mipmaps, from the finest to a single texel: red, green, blue in sRGB, and 255.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Picture {
    pub levels: Vec<Vec<u8>>,
}

/// The pictures of a mesh.
#[derive(Debug)]
pub(crate) struct Pictures {
    pub all: Vec<Picture>,
    /// For each triangle of the mesh the place of its picture in `all`, if it has one.
    pub of: Vec<Option<u8>>,
}

/// Returns the linear light of every level of sRGB (IEC 61966-2-1).
fn linear() -> &'static [f32; 256] {
    static LINEAR: LazyLock<[f32; 256]> =
        LazyLock::new(|| std::array::from_fn(|i| super::colours::linear([i as u8; 3])[0]));
    &LINEAR
}

/// Returns the level of sRGB that is nearest to a linear light.
fn level(light: f32) -> u8 {
    let table = linear();
    let above = table.partition_point(|of| *of < light).clamp(1, 255);
    let nearer = light - table[above - 1] < table[above] - light;
    (above - usize::from(nearer)) as u8
}

impl Picture {
    /// Makes a picture of an image of any size, given by the red, green and blue of its pixels. Texels are means of linear
    /// light over the pixels that they cover.
    pub fn new(width: usize, height: usize, rgb: &[u8]) -> Self {
        let side = SIDE as usize;
        let covered = |texel: usize, pixels: usize| {
            let from = texel * pixels / side;
            from..((texel + 1) * pixels / side).max(from + 1)
        };
        let texel = |x: usize, y: usize| {
            let (columns, rows) = (covered(x, width), covered(y, height));
            let count = (columns.len() * rows.len()) as f32;
            let sum = |part: usize| {
                let pixels = rows.clone().flat_map(|row| columns.clone().map(move |column| 3 * (width * row + column)));
                pixels.map(|at| linear()[usize::from(rgb[at + part])]).sum::<f32>()
            };
            [0, 1, 2].map(|part| sum(part) / count)
        };
        let mut light: Vec<[f32; 3]> = (0..side * side).into_par_iter().map(|at| texel(at % side, at / side)).collect();
        let mut levels = Vec::new();
        for size in (0..LEVELS).map(|level| side >> level) {
            levels.push(light.iter().flat_map(|[r, g, b]| [level(*r), level(*g), level(*b), 255]).collect());
            let half = size / 2;
            let mean = |at: usize| {
                let first = 2 * size * (at / half) + 2 * (at % half);
                let four = [first, first + 1, first + size, first + size + 1];
                [0, 1, 2].map(|part| 0.25 * four.iter().map(|at| light[*at][part]).sum::<f32>())
            };
            light = (0..half * half).map(mean).collect();
        }
        Self { levels }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_level_of_srgb_is_its_own_nearest() {
        (0..=255).for_each(|of: u8| assert_eq!(level(linear()[usize::from(of)]), of));
        assert_eq!((level(-1.0), level(2.0)), (0, 255));
    }

    #[test]
    fn a_picture_keeps_its_corners_and_its_last_level_is_the_mean_of_its_light() {
        // Black and white in equal parts are half the light, which is 188 in sRGB.
        let picture = Picture::new(2, 1, &[0, 0, 0, 255, 255, 255]);
        assert_eq!(picture.levels.len(), LEVELS as usize);
        let side = SIDE as usize;
        assert_eq!(picture.levels[0][..4], [0, 0, 0, 255]);
        assert_eq!(picture.levels[0][4 * (side - 1)..4 * side], [255; 4]);
        assert_eq!(picture.levels[LEVELS as usize - 1], [188, 188, 188, 255]);
    }

    #[test]
    fn a_large_image_is_reduced_without_losing_pixels() {
        let (width, height) = (3000, 1500);
        let rgb: Vec<u8> = (0..width * height).flat_map(|at| if at % 2 == 0 { [255; 3] } else { [0; 3] }).collect();
        let picture = Picture::new(width, height, &rgb);
        assert_eq!(picture.levels[LEVELS as usize - 1], [188, 188, 188, 255]);
    }
}
