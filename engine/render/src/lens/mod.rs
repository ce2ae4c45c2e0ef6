//! The effects of a lens and a sensor on light: from the linear light of a [`Frame`] to the image that a camera gives.
//!
//! Rain falls into the light first. Then it passes the [`EFFECTS`] in their order. At last it is cut off where the sensor is
//! full, and written in sRGB. All is computed on the processor, so that an image is the same whatever it was drawn beside.
//!
//! An effect is a file of this folder and a line of [`EFFECTS`]. Its settings are then part of
//! [`camera_settings`](crate::camera_settings), and with it of files, checks, variation from test to test and messages.

mod blur;
mod defocus;
mod exposure;
mod kernel;
mod motion;
mod noise;
mod rain;

pub use kernel::Kernel;
pub use rain::Rain;

use crate::{Camera, Frame};
use paracosm_engine::sensor::{CameraSetting, CameraSpec, Chance};

/// All effects, in the order in which light passes them.
pub const EFFECTS: &[&LensEffect] =
    &[&motion::EFFECT, &defocus::EFFECT, &blur::EFFECT, &exposure::EFFECT, &noise::EFFECT];

/// Kernels reach no further than this, in pixels.
const FARTHEST: f64 = 64.0;

/// Something that a lens or a sensor does to light.
#[derive(Debug)]
pub struct LensEffect {
    /// Its name; its noise is drawn under this name.
    pub name: &'static str,
    /// What it does to light, in a few words.
    pub about: &'static str,
    /// Its settings.
    pub settings: &'static [CameraSetting],
    /// Whether it leaves light as it is, with these values of its settings, in their order.
    pub is_idle: fn(&[f64]) -> bool,
    /// Changes the light of an image. All its noise comes from the chance, which is its own in every image.
    pub apply: fn(&[f64], &mut Light<'_>, &mut Chance),
}

/// The light of an image on its way through a lens.
#[derive(Debug)]
pub struct Light<'a> {
    /// Linear red, green and blue of each pixel, row by row; 1 is a white surface in full sun.
    pub values: Vec<f32>,
    /// The camera.
    pub camera: &'a Camera,
}

impl Light<'_> {
    /// Spreads every point by a kernel.
    pub fn spread(&mut self, kernel: &Kernel) {
        self.values = kernel.apply(&self.values, self.camera.width() as usize);
    }
}

/// A lens with its sensor: the effects that it has, with the values of their settings. By default it has none.
#[derive(Debug, Clone, Default)]
pub struct Lens {
    effects: Vec<(&'static LensEffect, Vec<f64>)>,
}

impl Lens {
    /// The lens of a camera, whose settings are in their ranges; see [`CameraSettings::check`](crate::CameraSettings::check).
    pub fn of(camera: &CameraSpec) -> Self {
        Self::with(EFFECTS, camera)
    }

    /// A lens of these effects instead of [`EFFECTS`].
    pub fn with(effects: &[&'static LensEffect], camera: &CameraSpec) -> Self {
        let values = |effect: &&'static LensEffect| {
            let values: Vec<_> = effect.settings.iter().map(|setting| setting.value(camera)).collect();
            (*effect, values)
        };
        let effects = effects.iter().map(values).filter(|(effect, values)| !(effect.is_idle)(values));
        Self { effects: effects.collect() }
    }

    /// Whether light goes through as it is.
    pub fn is_plain(&self) -> bool {
        self.effects.is_empty()
    }

    /// The image in sRGB, 8 bits a colour, that a camera with this lens gives of a frame; `None` where the frame has no
    /// linear light. `chance` gives each effect, by its name, the noise of this image.
    pub fn develop(&self, frame: &Frame, chance: impl Fn(&str) -> Chance) -> Option<Vec<u8>> {
        let mut light = Light { values: frame.linear.clone()?, camera: &frame.camera };
        for (effect, values) in &self.effects {
            (effect.apply)(values, &mut light, &mut chance(effect.name));
        }
        Some(light.values.into_iter().map(srgb).collect())
    }
}

/// A linear value, cut to 0 to 1, in sRGB (IEC 61966-2-1).
fn srgb(linear: f32) -> u8 {
    let linear = linear.clamp(0.0, 1.0);
    let encoded = if linear <= 0.003_130_8 { 12.92 * linear } else { 1.055 * libm::powf(linear, 1.0 / 2.4) - 0.055 };
    (255.0 * encoded).round() as u8
}

#[cfg(test)]
mod tests;
