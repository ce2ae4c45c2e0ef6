//! The colours of the surfaces that do not have the colour of the instance, in linear light; and the light of colours.

use paracosm_engine::object::Colour;

pub(super) const BLACK: [f32; 3] = [0.012, 0.012, 0.014];
pub(super) const RUBBER: [f32; 3] = [0.018, 0.018, 0.020];
pub(super) const GLASS: [f32; 3] = [0.030, 0.040, 0.050];
pub(super) const STEEL: [f32; 3] = [0.35, 0.36, 0.38];
pub(super) const GREY: [f32; 3] = [0.14, 0.14, 0.15];
pub(super) const WHITE: [f32; 3] = [0.85, 0.85, 0.83];
pub(super) const LAMP: [f32; 3] = [0.95, 0.93, 0.85];
pub(super) const RED: [f32; 3] = [0.55, 0.01, 0.01];
pub(super) const ORANGE: [f32; 3] = [0.80, 0.18, 0.01];
pub(super) const SKIN: [f32; 3] = [0.62, 0.36, 0.24];
pub(super) const HAIR: [f32; 3] = [0.06, 0.035, 0.02];
pub(super) const TROUSERS: [f32; 3] = [0.03, 0.04, 0.07];
pub(super) const BARK: [f32; 3] = [0.10, 0.065, 0.04];
pub(super) const TILES: [f32; 3] = [0.26, 0.07, 0.04];
pub(super) const WOOD: [f32; 3] = [0.16, 0.07, 0.03];

/// Converts a colour from sRGB to linear light (IEC 61966-2-1).
pub(crate) fn linear(colour: Colour) -> [f32; 3] {
    colour.map(|level| {
        let share = f32::from(level) / 255.0;
        if share <= 0.04045 { share / 12.92 } else { libm::powf((share + 0.055) / 1.055, 2.4) }
    })
}
