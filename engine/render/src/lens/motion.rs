//! Motion blur: the image moves while it is exposed.

use super::{FARTHEST, Kernel, LensEffect};
use paracosm_engine::sensor::CameraSetting;

pub(super) const EFFECT: LensEffect = LensEffect {
    name: "motion",
    about: "smears the image along a line",
    settings: &[
        CameraSetting::of_lens(
            "motion",
            "pixels",
            (0.0, FARTHEST),
            "the length in pixels of the motion blur, along `motion_angle`",
        ),
        CameraSetting::of_lens(
            "motion_angle",
            "degrees",
            (-360.0, 360.0),
            "the direction of the motion blur in degrees, counter-clockwise from the right",
        ),
    ],
    is_idle: |settings| settings[0] == 0.0,
    apply: |settings, light, _| light.spread(&Kernel::line(settings[0], settings[1].to_radians())),
};
