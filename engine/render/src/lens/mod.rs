//! What a lens and a sensor do to light: from the linear light of a [`Frame`] to the image that a camera gives.
//!
//! Light passes in this order: rain falls into it, it is smeared by motion, spread by defocus and by blur, dimmed towards the corners, exposed,
//! counted as electrons with their noise, cut off where the sensor is full, and written in sRGB. All is computed on the
//! processor, so that an image is the same whatever it was drawn beside.

mod kernel;
mod rain;

pub use kernel::Kernel;
pub use rain::Rain;

use crate::{Camera, CameraError, Frame};
use nalgebra::Point2;
use paracosm_engine::sensor::Chance;

/// Kernels reach no further than this, in pixels.
const FARTHEST: f64 = 64.0;

/// What a camera's lens and sensor do. By default they do nothing.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Effects {
    /// The length of the way in pixels over which motion smears the image.
    pub motion: f64,
    /// Which way that is, in radians counter-clockwise from the right.
    pub motion_angle: f64,
    /// The radius in pixels of the disc that a point becomes out of focus.
    pub defocus: f64,
    /// The standard deviation in pixels of the Gaussian that the lens makes of a point.
    pub blur: f64,
    /// How much darker it gets towards the corners: from 0, not at all, to 1, with the fourth power of the cosine of the
    /// angle from the axis.
    pub vignetting: f64,
    /// How long it is exposed, in stops: with 1 the sensor gets twice as much light.
    pub exposure: f64,
    /// How many electrons a pixel takes of a white surface in full sun before it is full; 0 for a sensor without shot noise.
    pub full_well: f64,
    /// The standard deviation of the noise of reading a pixel out, in electrons of the full well, or of 10,000 where that
    /// is 0.
    pub read_noise: f64,
}

/// What the full well is taken for where there is no shot noise.
const USUAL_WELL: f64 = 10_000.0;

impl Effects {
    /// Whether an image goes through as it is.
    pub fn are_none(&self) -> bool {
        Self { motion_angle: 0.0, ..*self } == Self::default()
    }

    /// Checks that all numbers are such as there are.
    ///
    /// # Errors
    /// The first that is not.
    pub fn check(&self) -> Result<(), CameraError> {
        let pixels = ((0.0, FARTHEST), "0 to 64 pixels");
        let electrons = ((0.0, 1e9), "0 to 1e9 electrons");
        let numbers = [
            ("motion", self.motion, pixels),
            ("motion_angle", self.motion_angle, ((-1e3, 1e3), "an angle")),
            ("defocus", self.defocus, pixels),
            ("blur", self.blur, ((0.0, FARTHEST / 4.0), "0 to 16 pixels")),
            ("vignetting", self.vignetting, ((0.0, 1.0), "0 to 1")),
            ("exposure", self.exposure, ((-20.0, 20.0), "-20 to 20 stops")),
            ("full_well", self.full_well, electrons),
            ("read_noise", self.read_noise, electrons),
        ];
        let wrong = numbers.into_iter().find(|(_, found, ((low, high), _))| !(*low..=*high).contains(found));
        wrong.map_or(Ok(()), |(what, found, (_, expected))| Err(CameraError::Effect { what, found, expected }))
    }

    /// The image in sRGB, 8 bits a colour, that a camera with these effects gives of a frame; `None` where the frame has
    /// no linear light. All noise is drawn from `chance`, pixel by pixel, so that it is that of the frame alone.
    pub fn develop(&self, frame: &Frame, chance: &mut Chance) -> Option<Vec<u8>> {
        let mut light = frame.linear.clone()?;
        for kernel in self.kernels() {
            light = kernel.apply(&light, frame.width() as usize);
        }
        self.expose(&mut light, &frame.camera);
        self.count(&mut light, chance);
        Some(light.into_iter().map(srgb).collect())
    }

    fn kernels(&self) -> Vec<Kernel> {
        let mut kernels = Vec::new();
        if self.motion > 0.0 {
            kernels.push(Kernel::line(self.motion, self.motion_angle));
        }
        if self.defocus > 0.0 {
            kernels.push(Kernel::disc(self.defocus));
        }
        if self.blur > 0.0 {
            kernels.extend(Kernel::gaussian(self.blur));
        }
        kernels
    }

    /// Vignetting and exposure: how much of the light each pixel gets.
    fn expose(&self, light: &mut [f32], camera: &Camera) {
        let exposed = libm::exp2(self.exposure);
        for (index, pixel) in light.chunks_exact_mut(3).enumerate() {
            let (column, row) = (index as u32 % camera.width(), index as u32 / camera.width());
            let ray = camera.ray(Point2::new(f64::from(column) + 0.5, f64::from(row) + 0.5));
            let cosine_squared = 1.0 / ray.norm_squared();
            let lost = self.vignetting * (1.0 - cosine_squared * cosine_squared);
            let share = (exposed * (1.0 - lost)) as f32;
            pixel.iter_mut().for_each(|value| *value *= share);
        }
    }

    /// Noise: a pixel of `n` electrons has a variance of `n` from counting (Poisson's, taken for a normal one) and one of
    /// `read_noise` squared from reading.
    fn count(&self, light: &mut [f32], chance: &mut Chance) {
        if self.full_well == 0.0 && self.read_noise == 0.0 {
            return;
        }
        let well = if self.full_well > 0.0 { self.full_well } else { USUAL_WELL };
        for value in light {
            let electrons = f64::from(*value) * well;
            let shot = if self.full_well > 0.0 { electrons } else { 0.0 };
            let deviation = libm::sqrt(shot + self.read_noise * self.read_noise);
            *value = ((electrons + deviation * chance.normal()) / well) as f32;
        }
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
