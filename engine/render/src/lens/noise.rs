//! Noise: a sensor counts electrons, and reads them out.
//!
//! A pixel of `n` electrons has a variance of `n` from counting (a Poisson distribution, approximated by a normal one)
//! and a variance of `read_noise` squared from reading.

use super::LensEffect;
use paracosm_engine::sensor::{CameraSetting, Chance};

const ELECTRONS: (f64, f64) = (0.0, 1e9);

pub(super) const EFFECT: LensEffect = LensEffect {
    name: "noise",
    about: "counts light as electrons, and adds the noise of counting and of reading",
    settings: &[
        CameraSetting::of_lens(
            "full_well",
            "electrons",
            ELECTRONS,
            "the electrons of a full pixel, which sees a white surface in full sun; 0 for no shot noise",
        ),
        CameraSetting::of_lens(
            "read_noise",
            "electrons",
            ELECTRONS,
            "the standard deviation of the noise of reading a pixel, in electrons; `full_well` 0 counts as 10,000",
        ),
    ],
    is_idle: |settings| settings == [0.0; 2],
    apply: |settings, light, chance| count(settings[0], settings[1], &mut light.values, chance),
};

/// The full well of a sensor without shot noise.
pub(super) const USUAL_WELL: f64 = 10_000.0;

fn count(full_well: f64, read_noise: f64, light: &mut [f32], chance: &mut Chance) {
    let well = if full_well > 0.0 { full_well } else { USUAL_WELL };
    for value in light {
        let electrons = f64::from(*value) * well;
        let shot = if full_well > 0.0 { electrons } else { 0.0 };
        let deviation = libm::sqrt(shot + read_noise * read_noise);
        *value = ((electrons + deviation * chance.normal()) / well) as f32;
    }
}
