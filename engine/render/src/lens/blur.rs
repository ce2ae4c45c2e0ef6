//! Blur: the lens turns a point into a Gaussian.

use super::{FARTHEST, Kernel, LensEffect};
use paracosm_engine::sensor::CameraSetting;

pub(super) const EFFECT: LensEffect = LensEffect {
    name: "blur",
    about: "blurs every point to a Gaussian",
    settings: &[CameraSetting::of_lens(
        "blur",
        "pixels",
        // A Gaussian is cut off at four standard deviations.
        (0.0, FARTHEST / 4.0),
        "the standard deviation in pixels of the Gaussian that the lens makes of a point",
    )],
    is_idle: |settings| settings[0] == 0.0,
    apply: |settings, light, _| Kernel::gaussian(settings[0]).iter().for_each(|kernel| light.spread(kernel)),
};
