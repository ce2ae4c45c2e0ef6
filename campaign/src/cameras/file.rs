//! Reads files of cameras. An error names the key and the line, and says what was found and what was expected.

use super::VariedCameras;
use super::varied::middle;
use crate::Reason;
use paracosm_engine::sensor::{CameraSetting, CameraSpec, Cameras, Look, UnknownLook};
use paracosm_render::{CameraFlaw, NoCamera, RESOLUTION, camera_settings};
use paracosm_space::{Domain, Value, did_you_mean, nearest};
use std::borrow::Cow;
use std::collections::BTreeMap;
use std::ops::Range;
use thiserror::Error;
use toml::Spanned;
use toml::de::{DeTable, DeValue};

/// The keys that a file may have at its top level.
const TOP: [&str; 3] = ["seed", "look", "camera"];
/// The settings that cannot vary from test to test: all images of a data set have one size, and images come at ticks.
const ALWAYS_THE_SAME: [&str; 2] = [RESOLUTION, "rate"];

/// The reason why a file that describes cameras is not valid.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum CameraFileFlaw {
    /// The file is not valid TOML.
    #[error("{}", .0.message())]
    Syntax(toml::de::Error),
    /// The file does not describe any camera.
    #[error("the file describes no camera, expected at least one table [camera.NAME]")]
    NoCamera,
    /// The file has an unknown key at its top level.
    #[error("unknown key `{key}` in a file of cameras, expected `seed`, `look` or tables [camera.NAME]{}", did_you_mean(.nearest))]
    TopKey {
        /// The unknown key in the file.
        key: String,
        /// The most similar known key, if any key is similar.
        nearest: Option<&'static str>,
    },
    /// The name of a camera contains characters that the name of a folder cannot contain on every system.
    #[error("camera `{camera}`: expected a name of letters, digits, - and _, because a folder gets the same name")]
    Name {
        /// The name of the camera with the flaw.
        camera: String,
    },
    /// A camera does not have a key that every camera needs.
    #[error("camera `{camera}` has no `{key}`, expected {expected}")]
    Missing {
        /// The name of the camera with the flaw.
        camera: String,
        /// The key that the camera lacks.
        key: &'static str,
        /// A description of the missing key's value, with an example.
        expected: String,
    },
    /// The value of a key has the wrong type or the wrong form.
    #[error("{what} is {found}, expected {expected}")]
    Value {
        /// The key with the wrong value, with the name of its camera.
        what: String,
        /// The text of the wrong value in the file.
        found: String,
        /// A description of the expected value.
        expected: String,
    },
    /// No look has the name in the file.
    #[error(transparent)]
    Look(UnknownLook),
    /// A camera has an unknown key, or settings with which the camera cannot be built.
    #[error(transparent)]
    Camera(#[from] NoCamera),
}

impl Reason for CameraFileFlaw {}

/// The reason why a file that describes cameras is not valid, with the line of the file, counted from 1.
#[derive(Debug, PartialEq)]
pub(super) struct Flaw {
    pub line: Option<usize>,
    pub flaw: CameraFileFlaw,
}

type Entry<'a> = Spanned<DeValue<'a>>;

/// Reads the text of a file of cameras.
pub(super) fn parse(text: &str) -> Result<VariedCameras, Flaw> {
    let reader = Reader { text };
    let root = DeTable::parse(text).map_err(|error| Flaw {
        line: error.span().map(|span| reader.line(&span)),
        flaw: CameraFileFlaw::Syntax(error),
    })?;
    let mut read = VariedCameras::from(Cameras::default());
    let mut found = Vec::new();
    for (key, value) in root.get_ref() {
        match (key.get_ref().as_ref(), value.get_ref()) {
            ("seed", _) => read.seed(reader.seed(value)?),
            ("look", _) => read = read.in_look(reader.look(value)?),
            ("camera", DeValue::Table(cameras)) => found.extend(cameras),
            ("camera", _) => return Err(reader.flaw(value, "`camera`", "tables [camera.NAME]")),
            (unknown, _) => {
                let flaw = CameraFileFlaw::TopKey { key: unknown.to_owned(), nearest: nearest(unknown, TOP) };
                return Err(reader.at(&key.span(), flaw));
            }
        }
    }
    for (name, table) in found {
        reader.camera(&mut read, name, table)?;
    }
    if read.nominal().all.is_empty() {
        return Err(Flaw { line: None, flaw: CameraFileFlaw::NoCamera });
    }
    Ok(read)
}

/// The value that a file gives to a setting.
enum Given {
    /// The fixed number of the setting in all tests.
    Once(f64),
    /// The range or the list of the values of a setting that varies from test to test.
    Varied(Domain),
}

/// The reader of a file.
struct Reader<'t> {
    text: &'t str,
}

impl Reader<'_> {
    fn line(&self, span: &Range<usize>) -> usize {
        self.text[..span.start].matches('\n').count() + 1
    }

    fn at(&self, span: &Range<usize>, flaw: CameraFileFlaw) -> Flaw {
        Flaw { line: Some(self.line(span)), flaw }
    }

    /// Returns the error for a value that has the wrong type or form.
    fn flaw(&self, value: &Entry<'_>, what: &str, expected: &str) -> Flaw {
        let found = self.text[value.span()].trim().to_owned();
        let (what, expected) = (what.to_owned(), expected.to_owned());
        self.at(&value.span(), CameraFileFlaw::Value { what, found, expected })
    }

    fn seed(&self, value: &Entry<'_>) -> Result<u64, Flaw> {
        let number =
            value.get_ref().as_integer().and_then(|number| u64::from_str_radix(number.as_str(), number.radix()).ok());
        number.ok_or_else(|| self.flaw(value, "`seed`", "a whole number from 0 on"))
    }

    fn look(&self, value: &Entry<'_>) -> Result<Look, Flaw> {
        let names = Look::ALL.map(|look| format!("\"{look}\"")).join(" or ");
        let name = value.get_ref().as_str().ok_or_else(|| self.flaw(value, "`look`", &names))?;
        name.parse().map_err(|flaw| self.at(&value.span(), CameraFileFlaw::Look(flaw)))
    }

    fn camera(&self, read: &mut VariedCameras, name: &Spanned<Cow<'_, str>>, table: &Entry<'_>) -> Result<(), Flaw> {
        let (span, name) = (name.span(), name.get_ref().as_ref());
        let plain = |c: char| c.is_ascii_alphanumeric() || c == '-' || c == '_';
        if name.is_empty() || !name.chars().all(plain) {
            return Err(self.at(&span, CameraFileFlaw::Name { camera: name.to_owned() }));
        }
        let DeValue::Table(entries) = table.get_ref() else {
            let what = format!("camera `{name}`");
            return Err(self.flaw(table, &what, &format!("a table [camera.{name}]")));
        };
        let (mut spec, mut lines) = (CameraSpec::default(), BTreeMap::new());
        let mut varied = Vec::new();
        for (key, value) in entries {
            let (key_span, key) = (key.span(), key.get_ref().as_ref());
            lines.insert(key, key_span.clone());
            if key == RESOLUTION {
                spec.resolution = self.resolution(name, value)?;
                continue;
            }
            let settings = camera_settings().of_key(key);
            let settings = settings.map_err(|flaw| self.at(&key_span, no_camera(name, flaw)))?;
            for (setting, value) in self.parts(name, value, settings)? {
                let nominal = match self.given(name, &setting, value)? {
                    Given::Once(number) => number,
                    Given::Varied(domain) => {
                        let nominal = middle(&domain);
                        varied.push((setting, domain));
                        nominal
                    }
                };
                setting.set(&mut spec, nominal);
            }
        }
        if let Some(key) = camera_settings().keys().into_iter().find(|key| is_required(key) && !lines.contains_key(key))
        {
            let flaw = CameraFileFlaw::Missing { camera: name.to_owned(), key, expected: expected(key) };
            return Err(self.at(&span, flaw));
        }
        read.put(name, spec);
        varied.into_iter().for_each(|(setting, domain)| read.add(name, &setting, domain));
        for spec in read.extremes(name) {
            camera_settings().check(&spec).map_err(|flaw| {
                let span = flaw.key().and_then(|key| lines.get(key)).unwrap_or(&span);
                self.at(span, no_camera(name, flaw))
            })?;
        }
        Ok(())
    }

    /// Splits the value of a key into the values of the settings that the key sets.
    fn parts<'a>(
        &self,
        camera: &str,
        value: &'a Entry<'a>,
        settings: Vec<CameraSetting>,
    ) -> Result<Vec<(CameraSetting, &'a Entry<'a>)>, Flaw> {
        match (settings.as_slice(), value.get_ref()) {
            ([alone], _) => Ok(vec![(*alone, value)]),
            (several, DeValue::Array(values)) if values.len() == several.len() => {
                Ok(several.iter().copied().zip(values.iter()).collect())
            }
            (several, _) => {
                let names: Vec<_> = several.iter().map(|setting| setting.name).collect();
                let expected = format!("a list of {} numbers: {}", names.len(), names.join(", "));
                let key = several.first().map_or_else(String::new, |setting| format!(": `{}`", setting.key));
                Err(self.flaw(value, &format!("camera `{camera}`{key}"), &expected))
            }
        }
    }

    fn given(&self, camera: &str, setting: &CameraSetting, value: &Entry<'_>) -> Result<Given, Flaw> {
        let what = match setting {
            CameraSetting { key, name, .. } if key == name => format!("camera `{camera}`: `{key}`"),
            CameraSetting { key, name, .. } => format!("camera `{camera}`: {name} in `{key}`"),
        };
        let unit = if setting.unit.is_empty() { String::new() } else { format!(" of {}", setting.unit) };
        if let Some(number) = number(value.get_ref()) {
            return Ok(Given::Once(number));
        }
        let Some(range) = value.get_ref().as_str() else {
            return Err(self.flaw(value, &what, &format!("a number{unit}, or a range such as \"1..2\"")));
        };
        if ALWAYS_THE_SAME.contains(&setting.key) {
            return Err(self.flaw(
                value,
                &what,
                &format!("one number{unit}, because this setting cannot vary from test to test"),
            ));
        }
        domain(range).map(Given::Varied).ok_or_else(|| {
            let expected = format!(
                "\"LO..HI\" with the lower number first, or \"A,B,C\" with no number twice; all are numbers{unit}"
            );
            self.flaw(value, &what, &expected)
        })
    }

    fn resolution(&self, camera: &str, value: &Entry<'_>) -> Result<[u32; 2], Flaw> {
        let pixels = value.get_ref().as_array().and_then(|pixels| match pixels.iter().collect::<Vec<_>>().as_slice() {
            [width, height] => Some([whole(width.get_ref())?, whole(height.get_ref())?]),
            _ => None,
        });
        pixels.ok_or_else(|| {
            self.flaw(
                value,
                &format!("camera `{camera}`: `{RESOLUTION}`"),
                "two whole numbers, the width and the height in pixels, such as [640, 480]",
            )
        })
    }
}

fn no_camera(name: &str, flaw: CameraFlaw) -> CameraFileFlaw {
    NoCamera { camera: name.to_owned(), flaw }.into()
}

/// Returns `true` if every camera needs the given key.
fn is_required(key: &str) -> bool {
    key == RESOLUTION || camera_settings().iter().any(|setting| setting.key == key && setting.default.is_none())
}

/// Returns a description of a key's value, with an example.
fn expected(key: &str) -> String {
    if key == RESOLUTION {
        return format!("width and height in pixels, such as `{RESOLUTION} = [640, 480]`");
    }
    let settings: Vec<_> = camera_settings().iter().filter(|setting| setting.key == key).collect();
    let about: Vec<_> = settings.iter().map(|setting| setting.about).collect();
    let examples: Vec<_> = settings.iter().map(|setting| format!("{:?}", setting.example)).collect();
    let example = if settings.len() == 1 { examples.concat() } else { format!("[{}]", examples.join(", ")) };
    format!("{}, such as `{key} = {example}`", about.join(", "))
}

/// Reads the range `LO..HI` or the list `A,B,C` of the values of a setting that varies from test to test.
fn domain(text: &str) -> Option<Domain> {
    let number = |text: &str| text.trim().parse().ok().filter(|number: &f64| number.is_finite());
    if let Some((lo, hi)) = text.split_once("..") {
        let (lo, hi) = (number(lo)?, number(hi)?);
        return (lo < hi).then_some(Domain::Interval { lo, hi });
    }
    let numbers = text.split(',').map(number).collect::<Option<Vec<f64>>>()?;
    let alike = numbers.iter().enumerate().any(|(i, number)| numbers[..i].contains(number));
    (!alike).then(|| Domain::Choice(numbers.into_iter().map(Value::Number).collect()))
}

fn number(value: &DeValue<'_>) -> Option<f64> {
    match value {
        DeValue::Float(number) => number.as_str().parse().ok(),
        DeValue::Integer(number) => {
            i64::from_str_radix(number.as_str(), number.radix()).ok().map(|number| number as f64)
        }
        _ => None,
    }
}

fn whole(value: &DeValue<'_>) -> Option<u32> {
    let number = value.as_integer()?;
    u32::from_str_radix(number.as_str(), number.radix()).ok()
}
