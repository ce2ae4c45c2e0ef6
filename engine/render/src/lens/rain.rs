//! Streaks of rain: drops that fall in front of the camera while it exposes an image.
//!
//! A drop gathers light from nearly all around, so that it is about as bright as the air. A pixel takes the colour of a
//! drop in proportion to the share of the exposure for which the drop covers it (Garg and Nayar, Vision and Rain, IJCV
//! 2007). Drops farther away than a few metres are too faint to be told apart;
//! [`sensor::Air`](paracosm_engine::sensor::Air) models them as a veil.

use crate::{Atmosphere, Camera, Frame};
use nalgebra::{Isometry3, Point2, Point3, Vector3};
use paracosm_engine::sensor::Chance;
use std::f64::consts::{FRAC_PI_4, PI};

/// The range of the drops that are visible, in metres along the camera's axis.
const NEAR: f64 = 0.3;
const FAR: f64 = 2.5;
/// The smallest diameter that is visible, in mm.
const SMALLEST: f64 = 1.0;
/// The time for which an image is exposed, in seconds.
const EXPOSURE: f64 = 0.004;

/// The falling rain in front of a camera.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Rain {
    /// The rate of rainfall, in mm/h.
    rate: f64,
    /// The upward direction, and the velocity of the camera in m/s, both in the camera's coordinates.
    up: Vector3<f64>,
    velocity: Vector3<f64>,
    /// The red, green and blue of a drop, in linear light.
    light: [f32; 3],
}

/// A drop as it moves during the exposure.
#[derive(Debug, Clone, Copy)]
struct Streak {
    from: Point2<f64>,
    to: Point2<f64>,
    /// The diameter of the drop in pixels.
    diameter: f64,
}

impl Rain {
    /// Makes the rain for a rate in mm/h, an atmosphere, and the pose and the velocity in m/s of a camera.
    pub fn new(rate: f64, air: &Atmosphere, camera: &Isometry3<f64>, velocity: &Vector3<f64>) -> Self {
        let turned = |direction: &Vector3<f64>| camera.rotation.inverse() * direction;
        Self { rate, up: turned(&Vector3::z()), velocity: turned(velocity), light: air.colour() }
    }

    /// Adds streaks of rain to the linear light of a frame; a frame without linear light stays unchanged. All drops are
    /// drawn from `chance`.
    pub fn fall(&self, frame: &mut Frame, chance: &mut Chance) {
        let camera = &frame.camera;
        let Some(light) = frame.linear.as_mut().filter(|_| self.rate > 0.0) else { return };
        for streak in self.streaks(camera, chance) {
            streak.cover(camera, |pixel, share| {
                for (value, drop) in light[3 * pixel..][..3].iter_mut().zip(&self.light) {
                    *value += share * (drop - *value);
                }
            });
        }
    }

    /// Draws random drops in front of the camera. A cubic metre has 8000 exp(-4.1 rate^-0.21 D) drops per millimetre of
    /// diameter `D` in mm (Marshall and Palmer 1948).
    fn streaks(&self, camera: &Camera, chance: &mut Chance) -> Vec<Streak> {
        let fewer = 4.1 * libm::pow(self.rate, -0.21);
        let dense = 8000.0 / fewer * libm::exp(-fewer * SMALLEST);
        let (width, height) = (f64::from(camera.width()), f64::from(camera.height()));
        let focal = camera.focal_pixels();
        let [near, far] = [NEAR, FAR].map(|depth| depth * depth * depth);
        let volume = width / focal * height / focal * (far - near) / 3.0;
        let drops = 0..chance.poisson(dense * volume);
        let streak = |_| {
            let depth = libm::cbrt(chance.between(near, far));
            let pixel = Point2::new(chance.between(0.0, width), chance.between(0.0, height));
            let diameter = SMALLEST + chance.exponential(1.0 / fewer);
            let way = (self.up * -falling(diameter) - self.velocity) * (EXPOSURE / 2.0);
            let middle = Point3::from(camera.ray(pixel) * depth);
            let (from, to) = (camera.project(&(middle - way))?, camera.project(&(middle + way))?);
            Some(Streak { from, to, diameter: diameter / 1000.0 / depth * focal })
        };
        drops.filter_map(streak).collect()
    }
}

/// Returns the speed at which a drop of this diameter in mm falls, in m/s (Atlas, Srivastava and Sekhon 1973).
fn falling(diameter: f64) -> f64 {
    9.65 - 10.3 * libm::exp(-0.6 * diameter)
}

impl Streak {
    /// Calls `covered` with the index of each pixel that the drop covers, and with the share of the exposure. The drop
    /// is drawn at least a pixel wide; a thinner drop is fainter in proportion.
    fn cover(&self, camera: &Camera, mut covered: impl FnMut(usize, f32)) {
        let along = self.to - self.from;
        let radius = self.diameter.max(1.0) / 2.0;
        // A line with round ends. Fading over a pixel adds to the ends as much as it takes from them, and a twelfth
        // more.
        let drawn = 2.0 * radius * along.norm() + PI * (radius * radius + 1.0 / 12.0);
        let share = FRAC_PI_4 * self.diameter * self.diameter / drawn;
        let reach = radius + 0.5;
        let within = |a: f64, b: f64, pixels: u32| {
            let [first, end] = [a.min(b) - reach, a.max(b) + reach].map(|at| at.clamp(0.0, f64::from(pixels)));
            libm::floor(first) as u32..libm::ceil(end) as u32
        };
        for row in within(self.from.y, self.to.y, camera.height()) {
            for column in within(self.from.x, self.to.x, camera.width()) {
                let middle = Point2::new(f64::from(column) + 0.5, f64::from(row) + 0.5) - self.from;
                let nearest = (middle.dot(&along) / along.norm_squared().max(f64::MIN_POSITIVE)).clamp(0.0, 1.0);
                let part = (reach - (middle - along * nearest).norm()).clamp(0.0, 1.0);
                if part > 0.0 {
                    covered((row * camera.width() + column) as usize, (share * part) as f32);
                }
            }
        }
    }
}

#[cfg(test)]
mod tests;
