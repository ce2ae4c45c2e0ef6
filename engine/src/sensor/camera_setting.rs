//! The table of the numbers that describe a camera. One row has all that readers of files, checks, messages and
//! documents need to know about a setting.
//!
//! The engine has the rows of the settings that it uses itself. The renderer adds those of its lens, which the engine
//! hands on without knowing them.

use super::CameraSpec;

/// The description of a numeric setting of cameras, such as the focal length.
#[derive(Debug, Clone, Copy)]
pub struct CameraSetting {
    /// The key of the setting in a file. Settings that share a key stand in the file as one list.
    pub key: &'static str,
    /// The name of the setting, which is the key unless the setting is part of a list.
    pub name: &'static str,
    /// The unit of the setting; empty if the setting has no unit.
    pub unit: &'static str,
    /// The least and the greatest value of the setting.
    pub range: (f64, f64),
    /// The default value of the setting; `None` if every camera has to give the value.
    pub default: Option<f64>,
    /// A common value of the setting, for messages and documents.
    pub example: f64,
    /// The meaning of the setting, in a few words with the unit.
    pub about: &'static str,
    place: Place,
}

/// The place of a setting in a camera.
#[derive(Debug, Clone, Copy)]
enum Place {
    /// A setting that is a field of the camera.
    Field { of: fn(&CameraSpec) -> f64, at: fn(&mut CameraSpec) -> &mut f64 },
    /// A setting among the named settings of the lens.
    Lens,
}

macro_rules! field {
    ($($path:tt)+) => {
        Place::Field { of: |camera| camera.$($path)+, at: |camera| &mut camera.$($path)+ }
    };
}

/// The camera settings that the engine itself uses, in the order in which files have the settings. The resolution is
/// not a single number, so it is not in the table.
pub const CORE_CAMERA_SETTINGS: [CameraSetting; 11] = [
    core("focal_mm", "mm", (0.1, 10_000.0), "the focal length in millimetres", field!(focal_mm)).required(24.0),
    core("sensor_mm", "mm", (0.1, 1000.0), "the width of the sensor in millimetres", field!(sensor_mm)).required(36.0),
    core("position", "m", SIDEWAYS, "metres ahead of the middle of the car", field!(position[0]))
        .part("ahead")
        .required(0.3),
    core("position", "m", SIDEWAYS, "metres to the left of the middle of the car", field!(position[1]))
        .part("left")
        .required(0.0),
    core("position", "m", UPWARDS, "metres above the ground", field!(position[2])).part("up").required(1.35),
    core("yaw_pitch_roll", "degrees", TURN, "degrees to the left", field!(yaw_pitch_roll[0])).part("yaw"),
    core("yaw_pitch_roll", "degrees", TURN, "then degrees downwards", field!(yaw_pitch_roll[1])).part("pitch"),
    core("yaw_pitch_roll", "degrees", TURN, "then degrees to the right", field!(yaw_pitch_roll[2])).part("roll"),
    core("rate", "Hz", (0.001, 1000.0), "images a second", field!(rate)).required(10.0),
    core("latency", "s", (0.0, 100.0), "the seconds from when an image is taken to when it arrives", field!(latency)),
    core("dropped", "", (0.0, 1.0), "the probability that an image is lost", field!(dropped)),
];

/// The greatest distance of a camera from the car, and its heights above ground, in metres. Below, it would see sky.
const SIDEWAYS: (f64, f64) = (-100.0, 100.0);
const UPWARDS: (f64, f64) = (0.05, 100.0);
/// A full turn in both directions, in degrees.
const TURN: (f64, f64) = (-360.0, 360.0);

const fn core(
    key: &'static str,
    unit: &'static str,
    range: (f64, f64),
    about: &'static str,
    place: Place,
) -> CameraSetting {
    CameraSetting { place, ..CameraSetting::of_lens(key, unit, range, about) }
}

impl CameraSetting {
    /// Makes a setting of a camera's lens or image sensor, with the default 0.
    pub const fn of_lens(key: &'static str, unit: &'static str, range: (f64, f64), about: &'static str) -> Self {
        Self { key, name: key, unit, range, default: Some(0.0), example: 0.0, about, place: Place::Lens }
    }

    /// Returns the setting with another default value.
    pub const fn with_default(self, default: f64) -> Self {
        Self { default: Some(default), example: default, ..self }
    }

    const fn part(self, name: &'static str) -> Self {
        Self { name, ..self }
    }

    const fn required(self, example: f64) -> Self {
        Self { default: None, example, ..self }
    }

    /// Returns `true` if the setting belongs to the lens or the image sensor ([`CameraSpec::lens`]).
    pub const fn is_of_lens(&self) -> bool {
        matches!(self.place, Place::Lens)
    }

    /// Returns the value of the setting in a camera; the default if the camera does not give the value.
    pub fn value(&self, camera: &CameraSpec) -> f64 {
        match self.place {
            Place::Field { of, .. } => of(camera),
            Place::Lens => camera.lens.get(self.name).copied().or(self.default).unwrap_or_default(),
        }
    }

    /// Sets the value of the setting in a camera.
    pub fn set(&self, camera: &mut CameraSpec, value: f64) {
        match self.place {
            Place::Field { at, .. } => *at(camera) = value,
            Place::Lens => camera.lens.set(self.name, value),
        }
    }

    /// Returns `true` if a number is in the setting's range.
    pub fn admits(&self, number: f64) -> bool {
        let (low, high) = self.range;
        (low..=high).contains(&number)
    }
}

/// Two settings are equal if they have the same key and the same name.
impl PartialEq for CameraSetting {
    fn eq(&self, other: &Self) -> bool {
        (self.key, self.name) == (other.key, other.name)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A camera whose numbers differ from each other and from all defaults.
    fn camera() -> CameraSpec {
        let mut camera = CameraSpec { resolution: [4, 3], ..CameraSpec::default() };
        let lens = CameraSetting::of_lens("blur", "pixels", (0.0, 16.0), "how blurred it is");
        for (number, setting) in CORE_CAMERA_SETTINGS.iter().chain([&lens]).enumerate() {
            setting.set(&mut camera, number as f64 + 0.5);
        }
        camera
    }

    #[test]
    fn every_setting_has_a_place_of_its_own() {
        let camera = camera();
        for (number, setting) in CORE_CAMERA_SETTINGS.iter().enumerate() {
            assert_eq!(setting.value(&camera), number as f64 + 0.5, "{}", setting.name);
            assert!(setting.admits(setting.example) && !setting.is_of_lens(), "{}", setting.name);
        }
        assert_eq!((camera.position, camera.rate, camera.lens.get("blur")), ([2.5, 3.5, 4.5], 8.5, Some(&11.5)));
        let lens = CameraSetting::of_lens("gain", "", (0.0, 9.0), "").with_default(2.0);
        assert_eq!((lens.value(&camera), lens.admits(f64::NAN), lens.admits(9.0)), (2.0, false, true));
    }
}
