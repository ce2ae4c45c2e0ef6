//! The textures of the look `textured`, computed from noise when they are first needed.
//!
//! A texel has a shade and a tint: a surface of the colour c looks `2 shade c + tint`. Both are linear, so the mean of
//! texels is the look of the surface from afar, and mipmaps are exact means. A surface has a texture of its own kind, and
//! on top of it the shade of a second, larger texture, so that the eye does not find the repetition.

mod built;
mod grown;
mod noise;
mod paved;

use crate::SurfaceKind;
use rayon::prelude::*;
use std::sync::LazyLock;

/// The number of texels of a texture each way.
pub(crate) const TEXELS: u32 = 512;
/// The number of mipmaps of a texture, from 512 texels to 1.
pub(crate) const LEVELS: u32 = TEXELS.ilog2() + 1;

/// The look of a small piece of a surface.
#[derive(Debug, Clone, Copy)]
struct Texel {
    /// The factor for the colour of the surface, from 0 to 2; 1 on average.
    shade: f32,
    /// The red, green and blue that do not depend on the colour of the surface, in linear light.
    tint: [f32; 3],
}

impl Texel {
    fn shade(shade: f32) -> Self {
        Self { shade, tint: [0.0; 3] }
    }

    fn bytes(self) -> [u8; 4] {
        let [red, green, blue] = self.tint;
        [red, green, blue, 0.5 * self.shade].map(|part| (part.clamp(0.0, 1.0) * 255.0).round() as u8)
    }
}

/// A texture of the surfaces of one kind.
pub(crate) struct Texture {
    /// The kind of the surfaces that have the texture; `None` for the second textures that lie over others.
    pub surface: Option<SurfaceKind>,
    /// The length after which the texture repeats, in units of texture coordinates (metres, mostly).
    pub period: f32,
    /// The look of the surface at a place, whose coordinates are shares of the period.
    texel: fn([f32; 2]) -> Texel,
}

const fn over(texel: fn([f32; 2]) -> Texel) -> Texture {
    Texture { surface: None, period: 1.0, texel }
}

const fn of(surface: SurfaceKind, period: f32, texel: fn([f32; 2]) -> Texel) -> Texture {
    Texture { surface: Some(surface), period, texel }
}

/// All textures, in the order of their layers on the adapter. The first lies over asphalt, the second over all others.
pub(crate) const ALL: [Texture; 12] = [
    over(paved::mended),
    over(paved::stained),
    of(SurfaceKind::Asphalt, 7.0, paved::asphalt),
    of(SurfaceKind::Grown, 1.0, grown::leaves),
    of(SurfaceKind::Slabs, 4.0, paved::slabs),
    of(SurfaceKind::Concrete, 5.0, paved::concrete),
    of(SurfaceKind::Marking, 3.0, paved::marking),
    of(SurfaceKind::Grass, 5.0, grown::grass),
    of(SurfaceKind::Brick, 3.84, built::brick),
    of(SurfaceKind::Plaster, 6.0, built::plaster),
    of(SurfaceKind::Tiles, 4.2, built::tiles),
    of(SurfaceKind::Bark, 1.0, grown::bark),
];

/// Returns all levels of all textures, computed once for the process: for each texture its levels, from the finest to a
/// single texel, with the red, green and blue of the tint and half of the shade as bytes.
pub(crate) fn levels() -> &'static [Vec<Vec<u8>>] {
    static LEVELS: LazyLock<Vec<Vec<Vec<u8>>>> = LazyLock::new(|| ALL.par_iter().map(Texture::levels).collect());
    &LEVELS
}

impl Texture {
    fn levels(&self) -> Vec<Vec<u8>> {
        let middle = |at: u32| (at as f32 + 0.5) / TEXELS as f32;
        let row = |y: u32| (0..TEXELS).flat_map(move |x| (self.texel)([middle(x), middle(y)]).bytes());
        let mut levels = vec![(0..TEXELS).flat_map(row).collect::<Vec<u8>>()];
        for level in 1..LEVELS {
            levels.push(halved(&levels[level as usize - 1], (TEXELS >> level) as usize));
        }
        levels
    }
}

/// Returns the level with `size` texels each way, whose texels are the means of four texels of the finer level.
fn halved(finer: &[u8], size: usize) -> Vec<u8> {
    let part = |x: usize, y: usize, part: usize| u16::from(finer[4 * (2 * size * y + x) + part]);
    let mean = |x: usize, y: usize, of: usize| {
        let sum = part(2 * x, 2 * y, of) + part(2 * x + 1, 2 * y, of);
        ((sum + part(2 * x, 2 * y + 1, of) + part(2 * x + 1, 2 * y + 1, of) + 2) / 4) as u8
    };
    (0..size).flat_map(|y| (0..size).flat_map(move |x| (0..4).map(move |of| mean(x, y, of)))).collect()
}

#[cfg(test)]
mod tests;
