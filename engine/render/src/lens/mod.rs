//! Models the effects of a lens and a sensor on light: turns the linear light of a [`Frame`] into the image that a
//! camera gives.
//!
//! Rain falls into the light first. Then the light passes the [`EFFECTS`] in their order. At last it is cut off where
//! the sensor is full, and is written in sRGB. Everything is computed on the processor, so that an image does not
//! depend on the images that are drawn with it.
//!
//! To add an effect, add a file to this folder and a line to [`EFFECTS`]. The effect's settings are then part of
//! [`camera_settings`](crate::camera_settings), and so of files, checks, variation from test to test and messages.

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

/// All effects of lenses and sensors, in the order in which light passes them.
pub const EFFECTS: &[&LensEffect] =
    &[&motion::EFFECT, &defocus::EFFECT, &blur::EFFECT, &exposure::EFFECT, &noise::EFFECT];

/// The greatest reach of a kernel, in pixels.
const FARTHEST: f64 = 64.0;

/// An effect of a lens or a sensor on the light of an image, for example a blur.
#[derive(Debug)]
pub struct LensEffect {
    /// The name of the effect, which also determines the seed of the effect's noise.
    pub name: &'static str,
    /// A description of the effect in a few words.
    pub about: &'static str,
    /// The camera settings that control the effect.
    pub settings: &'static [CameraSetting],
    /// The function that returns `true` if the effect leaves the light unchanged with the given values of its settings.
    pub is_idle: fn(&[f64]) -> bool,
    /// The function that changes the light of an image, given the values of the effect's settings and a source of
    /// randomness. All noise comes from the [`Chance`], which differs from image to image.
    pub apply: fn(&[f64], &mut Light<'_>, &mut Chance),
}

/// The linear light of an image, which the effects of a lens change one after another.
#[derive(Debug)]
pub struct Light<'a> {
    /// The linear red, green and blue of each pixel, row by row; 1 is a white surface in full sun.
    pub values: Vec<f32>,
    /// The pinhole camera that takes the image.
    pub camera: &'a Camera,
}

impl Light<'_> {
    /// Spreads the light of every pixel by a point spread function.
    pub fn spread(&mut self, kernel: &Kernel) {
        self.values = kernel.apply(&self.values, self.camera.width() as usize);
    }
}

/// The effects of a camera's lens and sensor, with the values of their settings. The default has no effects.
#[derive(Debug, Clone, Default)]
pub struct Lens {
    effects: Vec<(&'static LensEffect, Vec<f64>)>,
}

impl Lens {
    /// Makes the lens and sensor of a camera whose settings are in their ranges; see
    /// [`CameraSettings::check`](crate::CameraSettings::check).
    pub fn of(camera: &CameraSpec) -> Self {
        Self::with(EFFECTS, camera)
    }

    /// Makes the lens and sensor of a camera from the given effects instead of [`EFFECTS`].
    pub fn with(effects: &[&'static LensEffect], camera: &CameraSpec) -> Self {
        let values = |effect: &&'static LensEffect| {
            let values: Vec<_> = effect.settings.iter().map(|setting| setting.value(camera)).collect();
            (*effect, values)
        };
        let effects = effects.iter().map(values).filter(|(effect, values)| !(effect.is_idle)(values));
        Self { effects: effects.collect() }
    }

    /// Returns `true` if the lens leaves all light unchanged.
    pub fn is_plain(&self) -> bool {
        self.effects.is_empty()
    }

    /// Applies the effects to the linear light of a frame and returns the image in sRGB with 8 bits a colour; `None` if
    /// the frame has no linear light. `chance` returns the source of noise in this image for the name of an effect.
    pub fn develop(&self, frame: &Frame, chance: impl Fn(&str) -> Chance) -> Option<Vec<u8>> {
        let mut light = Light { values: frame.linear.clone()?, camera: &frame.camera };
        for (effect, values) in &self.effects {
            (effect.apply)(values, &mut light, &mut chance(effect.name));
        }
        Some(light.values.into_iter().map(srgb).collect())
    }
}

/// Converts a linear value to sRGB after limiting it to 0 to 1 (IEC 61966-2-1).
fn srgb(linear: f32) -> u8 {
    let linear = linear.clamp(0.0, 1.0);
    let encoded = if linear <= 0.003_130_8 { 12.92 * linear } else { 1.055 * libm::powf(linear, 1.0 / 2.4) - 0.055 };
    (255.0 * encoded).round() as u8
}

#[cfg(test)]
mod tests;
