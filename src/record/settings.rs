//! The settings of a camera as files name them: the one list behind reading, varying and explaining them.

use paracosm_engine::sensor::Mounted;

/// A number that a file says of a camera.
#[derive(Debug, Clone, Copy)]
pub(super) struct Setting {
    /// The key in a file; settings that share one are written as a list.
    pub key: &'static str,
    /// What it is called by itself.
    pub name: &'static str,
    /// Its unit.
    pub unit: &'static str,
    /// Where it is.
    pub place: fn(&mut Mounted) -> &mut f64,
}

const fn setting(key: &'static str, unit: &'static str, place: fn(&mut Mounted) -> &mut f64) -> Setting {
    Setting { key, name: key, unit, place }
}

const fn part(
    key: &'static str,
    name: &'static str,
    unit: &'static str,
    place: fn(&mut Mounted) -> &mut f64,
) -> Setting {
    Setting { key, name, unit, place }
}

/// All but the resolution, which is no single number.
pub(super) const SETTINGS: [Setting; 19] = [
    setting("focal_mm", "mm", |camera| &mut camera.focal_mm),
    setting("sensor_mm", "mm", |camera| &mut camera.sensor_mm),
    part("position", "ahead", "m", |camera| &mut camera.position[0]),
    part("position", "left", "m", |camera| &mut camera.position[1]),
    part("position", "up", "m", |camera| &mut camera.position[2]),
    part("yaw_pitch_roll", "yaw", "degrees", |camera| &mut camera.yaw_pitch_roll[0]),
    part("yaw_pitch_roll", "pitch", "degrees", |camera| &mut camera.yaw_pitch_roll[1]),
    part("yaw_pitch_roll", "roll", "degrees", |camera| &mut camera.yaw_pitch_roll[2]),
    setting("rate", "Hz", |camera| &mut camera.rate),
    setting("latency", "s", |camera| &mut camera.latency),
    setting("dropped", "", |camera| &mut camera.dropped),
    setting("motion", "pixels", |camera| &mut camera.motion),
    setting("motion_angle", "degrees", |camera| &mut camera.motion_angle),
    setting("defocus", "pixels", |camera| &mut camera.defocus),
    setting("blur", "pixels", |camera| &mut camera.blur),
    setting("vignetting", "", |camera| &mut camera.vignetting),
    setting("exposure", "stops", |camera| &mut camera.exposure),
    setting("full_well", "electrons", |camera| &mut camera.full_well),
    setting("read_noise", "electrons", |camera| &mut camera.read_noise),
];

/// The key of the resolution.
pub(super) const RESOLUTION: &str = "resolution";

/// What every camera has to say.
pub(super) const REQUIRED: [(&str, &str); 5] = [
    (RESOLUTION, "pixels across and down, such as `resolution = [640, 480]`"),
    ("focal_mm", "millimetres, such as `focal_mm = 24.0`"),
    ("sensor_mm", "the width of the sensor in millimetres, such as `sensor_mm = 36.0`"),
    ("position", "metres ahead, to the left and up, such as `position = [0.3, 0.0, 1.35]`"),
    ("rate", "images a second, such as `rate = 10.0`"),
];

/// All keys.
pub(super) fn keys() -> Vec<&'static str> {
    let mut keys: Vec<_> = std::iter::once(RESOLUTION).chain(SETTINGS.iter().map(|setting| setting.key)).collect();
    keys.dedup();
    keys
}
