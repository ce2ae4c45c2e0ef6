//! Defocus: a point becomes a disc.

use super::{FARTHEST, Kernel, LensEffect};
use paracosm_engine::sensor::CameraSetting;

pub(super) const EFFECT: LensEffect = LensEffect {
    name: "defocus",
    about: "turns every point into an evenly bright disc",
    settings: &[CameraSetting::of_lens(
        "defocus",
        "pixels",
        (0.0, FARTHEST),
        "the radius in pixels of the disc that a point becomes out of focus",
    )],
    is_idle: |settings| settings[0] == 0.0,
    apply: |settings, light, _| light.spread(&Kernel::disc(settings[0])),
};
