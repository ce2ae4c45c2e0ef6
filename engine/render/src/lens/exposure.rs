//! Vignetting and exposure: the share of the light that each pixel gets.
//!
//! The two are one effect, because a pixel's light is multiplied by both shares at once, and rounded once.

use super::{LensEffect, Light};
use nalgebra::Point2;
use paracosm_engine::sensor::CameraSetting;

pub(super) const EFFECT: LensEffect = LensEffect {
    name: "exposure",
    about: "dims the light towards the corners, and multiplies all of it",
    settings: &[
        CameraSetting::of_lens(
            "vignetting",
            "",
            (0.0, 1.0),
            "how much darker corners get: 0 not at all, 1 by the fourth power of the cosine of the angle from the axis",
        ),
        CameraSetting::of_lens(
            "exposure",
            "stops",
            (-20.0, 20.0),
            "how long the sensor is exposed, in stops: 1 doubles the light",
        ),
    ],
    is_idle: |settings| settings == [0.0; 2],
    apply: |settings, light, _| expose(settings[0], settings[1], light),
};

fn expose(vignetting: f64, stops: f64, light: &mut Light<'_>) {
    let exposed = libm::exp2(stops);
    let camera = light.camera;
    for (index, pixel) in light.values.chunks_exact_mut(3).enumerate() {
        let (column, row) = (index as u32 % camera.width(), index as u32 / camera.width());
        let ray = camera.ray(Point2::new(f64::from(column) + 0.5, f64::from(row) + 0.5));
        let cosine_squared = 1.0 / ray.norm_squared();
        let lost = vignetting * (1.0 - cosine_squared * cosine_squared);
        let share = (exposed * (1.0 - lost)) as f32;
        pixel.iter_mut().for_each(|value| *value *= share);
    }
}
