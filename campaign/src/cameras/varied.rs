//! Cameras with settings that vary from test to test, so that a driver that learns from recordings does not depend on
//! them.

use crate::setting_names::setting_name;
use paracosm_engine::sensor::{CameraSetting, CameraSpec, Cameras, Look};
use paracosm_render::camera_settings;
use paracosm_space::{Domain, Parameter, Space, Value, Values};
use xxhash_rust::xxh3::xxh3_64;

/// A set of cameras with the settings that vary from test to test.
#[derive(Debug, Clone)]
pub struct VariedCameras {
    cameras: Cameras,
    varied: Vec<Varied>,
}

/// A setting of a camera that the tests vary.
#[derive(Debug, Clone)]
struct Varied {
    camera: String,
    setting: CameraSetting,
    parameter: Parameter,
}

impl From<Cameras> for VariedCameras {
    /// Makes a set of cameras whose settings are the same in all tests.
    fn from(cameras: Cameras) -> Self {
        Self { cameras, varied: Vec::new() }
    }
}

impl VariedCameras {
    /// Makes a set of cameras whose varied settings are those that a space has as parameters.
    pub fn of_space(cameras: Cameras, space: &Space) -> Self {
        let settings: Vec<CameraSetting> = camera_settings().iter().collect();
        let varied = |parameter: &Parameter| {
            let of =
                |(camera, setting): (&String, &CameraSetting)| setting_name(camera, setting.name) == parameter.name;
            let all = cameras.all.keys().flat_map(|camera| settings.iter().map(move |setting| (camera, setting)));
            let (camera, setting) = all.into_iter().find(|pair| of(*pair))?;
            Some(Varied { camera: camera.clone(), setting: *setting, parameter: parameter.clone() })
        };
        let varied = space.parameters().iter().filter_map(varied).collect();
        Self { cameras, varied }
    }

    /// Returns the cameras with each varied setting at the middle of its range, or at the first of its values.
    pub fn nominal(&self) -> &Cameras {
        &self.cameras
    }

    /// Returns `true` if a setting of a camera varies from test to test.
    pub fn vary(&self) -> bool {
        !self.varied.is_empty()
    }

    /// Returns the look of the images.
    pub fn look(&self) -> Look {
        self.cameras.look
    }

    /// Returns the cameras with images of another look.
    pub fn in_look(mut self, look: Look) -> Self {
        self.cameras.look = look;
        self
    }

    /// Sets the seed of all noise.
    pub(super) fn seed(&mut self, seed: u64) {
        self.cameras.seed = seed;
    }

    /// Adds a camera.
    pub(super) fn put(&mut self, name: &str, camera: CameraSpec) {
        self.cameras.all.insert(name.to_owned(), camera);
    }

    /// Adds a setting of a camera to the settings that the tests vary.
    pub(super) fn add(&mut self, camera: &str, setting: &CameraSetting, domain: Domain) {
        let parameter = Parameter {
            unit: Some(setting.unit.to_owned()).filter(|unit| !unit.is_empty()),
            default: Some(Value::Number(middle(&domain))),
            ..Parameter::new(setting_name(camera, setting.name), domain)
        };
        self.varied.push(Varied { camera: camera.to_owned(), setting: *setting, parameter });
    }

    /// Returns a camera with its varied settings at the ends of their ranges, or at each of their values. If all these
    /// cameras are possible, so are the cameras of all tests.
    pub(super) fn extremes(&self, camera: &str) -> Vec<CameraSpec> {
        let mine = self.varied.iter().filter(|varied| varied.camera == camera);
        let ends = mine.map(|Varied { setting, parameter, .. }| match &parameter.domain {
            Domain::Interval { lo, hi } => (setting, vec![*lo, *hi]),
            Domain::Choice(levels) => (setting, levels.iter().filter_map(Value::number).collect()),
        });
        let ends: Vec<_> = ends.collect();
        let most = ends.iter().map(|(_, numbers)| numbers.len()).max().unwrap_or(1);
        let at = |step: usize| {
            let mut spec = self.cameras.all.get(camera)?.clone();
            for (setting, numbers) in &ends {
                setting.set(&mut spec, *numbers.get(step).or(numbers.last())?);
            }
            Some(spec)
        };
        (0..most).filter_map(at).collect()
    }

    /// Returns the varied settings as parameters of the tests.
    pub fn parameters(&self) -> impl Iterator<Item = &Parameter> {
        self.varied.iter().map(|varied| &varied.parameter)
    }

    /// Returns the cameras with the settings of a test and with a noise seed for the test. A setting that the test does
    /// not contain is as in [`nominal`](Self::nominal).
    pub fn of_test(&self, test: &Values) -> Cameras {
        let mut cameras = self.cameras.clone();
        for Varied { camera, setting, parameter } in &self.varied {
            let number = test.get(&parameter.name).and_then(Value::number);
            let (Some(number), Some(spec)) = (number, cameras.all.get_mut(camera)) else { continue };
            setting.set(spec, number);
            let key = [&cameras.seed.to_le_bytes()[..], parameter.name.as_bytes(), &number.to_bits().to_le_bytes()];
            cameras.seed = xxh3_64(&key.concat());
        }
        cameras
    }

    /// Returns the varied settings of a camera in a test: their names, with their values.
    pub fn settings_of<'a>(
        &'a self,
        camera: &'a str,
        test: &'a Values,
    ) -> impl Iterator<Item = (&'static str, f64)> + use<'a> {
        let mine = self.varied.iter().filter(move |varied| varied.camera == camera);
        mine.filter_map(|varied| Some((varied.setting.name, test.get(&varied.parameter.name)?.number()?)))
    }
}

/// Returns the middle of an interval, or the first of several values.
pub(super) fn middle(domain: &Domain) -> f64 {
    match domain {
        Domain::Interval { lo, hi } => 0.5 * (lo + hi),
        Domain::Choice(levels) => levels.first().and_then(Value::number).unwrap_or(f64::NAN),
    }
}
