//! Reads files of cameras. What is wrong is said with its key and line, what was found and what was expected.

use super::VariedCameras;
use super::settings::{REQUIRED, RESOLUTION, SETTINGS, Setting, keys};
use super::varied::middle;
use crate::darkroom::check;
use paracosm_coverage::{Domain, Value, did_you_mean, nearest};
use paracosm_engine::sensor::{Cameras, Mounted};
use std::borrow::Cow;
use std::collections::BTreeMap;
use std::ops::Range;
use toml::Spanned;
use toml::de::{DeTable, DeValue};

/// What a file may say beside the settings of cameras.
const TOP: [&str; 2] = ["seed", "camera"];
/// What may be the same in all tests only: images of a set have one size, and times are those of ticks.
const ALWAYS_THE_SAME: [&str; 2] = [RESOLUTION, "rate"];

/// What is wrong with a file.
#[derive(Debug, PartialEq, Eq)]
pub(super) struct Flaw {
    /// In which line, from 1.
    pub line: Option<usize>,
    /// What was found and what was expected.
    pub message: String,
}

type Entry<'a> = Spanned<DeValue<'a>>;

/// Reads the text of a file.
pub(super) fn parse(text: &str) -> Result<VariedCameras, Flaw> {
    let reader = Reader { text };
    let root = DeTable::parse(text)
        .map_err(|error| Flaw { line: error.span().map(|span| reader.line(&span)), message: error.message().into() })?;
    let mut read = VariedCameras::from(Cameras::default());
    let mut found = Vec::new();
    for (key, value) in root.get_ref() {
        match (key.get_ref().as_ref(), value.get_ref()) {
            ("seed", _) => read.seed(reader.seed(value)?),
            ("camera", DeValue::Table(cameras)) => found.extend(cameras),
            ("camera", _) => return Err(reader.flaw(value, "`camera`", "tables [camera.NAME]")),
            (unknown, _) => {
                let meant = did_you_mean(&nearest(unknown, TOP));
                let message = format!("there is no key `{unknown}`, expected `seed` or tables [camera.NAME]{meant}");
                return Err(reader.at(&key.span(), message));
            }
        }
    }
    for (name, table) in found {
        reader.camera(&mut read, name, table)?;
    }
    if read.nominal().all.is_empty() {
        return Err(Flaw { line: None, message: "found no camera, expected a table [camera.NAME]".into() });
    }
    Ok(read)
}

/// What a file says of a setting.
enum Given {
    /// A number for all tests.
    Once(f64),
    /// What the tests vary it over.
    Varied(Domain),
}

/// A file that is being read.
struct Reader<'t> {
    text: &'t str,
}

impl Reader<'_> {
    fn line(&self, span: &Range<usize>) -> usize {
        self.text[..span.start].matches('\n').count() + 1
    }

    fn at(&self, span: &Range<usize>, message: String) -> Flaw {
        Flaw { line: Some(self.line(span)), message }
    }

    /// That something has the wrong value.
    fn flaw(&self, value: &Entry<'_>, what: &str, expected: &str) -> Flaw {
        let found = self.text[value.span()].trim();
        self.at(&value.span(), format!("{what} is {found}, expected {expected}"))
    }

    fn seed(&self, value: &Entry<'_>) -> Result<u64, Flaw> {
        let number =
            value.get_ref().as_integer().and_then(|number| u64::from_str_radix(number.as_str(), number.radix()).ok());
        number.ok_or_else(|| self.flaw(value, "`seed`", "a whole number from 0 on"))
    }

    fn camera(&self, read: &mut VariedCameras, name: &Spanned<Cow<'_, str>>, table: &Entry<'_>) -> Result<(), Flaw> {
        let (span, name) = (name.span(), name.get_ref().as_ref());
        let plain = |c: char| c.is_ascii_alphanumeric() || c == '-' || c == '_';
        if name.is_empty() || !name.chars().all(plain) {
            let message =
                format!("camera `{name}`: expected a name of letters, digits, - and _, which becomes that of a folder");
            return Err(self.at(&span, message));
        }
        let DeValue::Table(entries) = table.get_ref() else {
            let what = format!("camera `{name}`");
            return Err(self.flaw(table, &what, &format!("a table [camera.{name}]")));
        };
        let (mut mounted, mut lines) = (Mounted::default(), BTreeMap::new());
        let mut varied = Vec::new();
        for (key, value) in entries {
            let (key_span, key) = (key.span(), key.get_ref().as_ref());
            lines.insert(key, key_span.clone());
            if key == RESOLUTION {
                mounted.resolution = self.resolution(name, value)?;
                continue;
            }
            let parts: Vec<&Setting> = SETTINGS.iter().filter(|setting| setting.key == key).collect();
            for (setting, value) in self.parts(name, (key, &key_span), value, &parts)? {
                *(setting.place)(&mut mounted) = match self.given(name, setting, value)? {
                    Given::Once(number) => number,
                    Given::Varied(domain) => {
                        let nominal = middle(&domain);
                        varied.push((setting, domain));
                        nominal
                    }
                };
            }
        }
        for (key, expected) in REQUIRED {
            if !lines.contains_key(key) {
                return Err(self.at(&span, format!("camera `{name}` has no `{key}`, expected {expected}")));
            }
        }
        read.put(name, mounted);
        varied.into_iter().for_each(|(setting, domain)| read.add(name, setting, domain));
        for mounted in read.extremes(name) {
            check(&mounted).map_err(|message| {
                let culprit = lines.iter().find(|(key, _)| message.contains(&format!("`{key}`")));
                let span = culprit.map_or(&span, |(_, span)| span);
                self.at(span, format!("camera `{name}`: {message}"))
            })?;
        }
        Ok(())
    }

    /// The values of the settings that share a key.
    fn parts<'a>(
        &self,
        camera: &str,
        (key, span): (&str, &Range<usize>),
        value: &'a Entry<'a>,
        parts: &[&'static Setting],
    ) -> Result<Vec<(&'static Setting, &'a Entry<'a>)>, Flaw> {
        match (parts, value.get_ref()) {
            ([], _) => {
                let keys = keys();
                let (meant, known) = (did_you_mean(&nearest(key, keys.iter().copied())), keys.join(", "));
                let message = format!("camera `{camera}`: there is no key `{key}`{meant}, expected some of {known}");
                Err(self.at(span, message))
            }
            ([alone], _) => Ok(vec![(*alone, value)]),
            (several, DeValue::Array(values)) if values.len() == several.len() => {
                Ok(several.iter().copied().zip(values.iter()).collect())
            }
            (several, _) => {
                let names: Vec<_> = several.iter().map(|setting| setting.name).collect();
                let expected = format!("a list of {} numbers: {}", names.len(), names.join(", "));
                Err(self.flaw(value, &format!("camera `{camera}`: `{key}`"), &expected))
            }
        }
    }

    fn given(&self, camera: &str, setting: &Setting, value: &Entry<'_>) -> Result<Given, Flaw> {
        let what = match setting {
            Setting { key, name, .. } if key == name => format!("camera `{camera}`: `{key}`"),
            Setting { key, name, .. } => format!("camera `{camera}`: {name} in `{key}`"),
        };
        let unit = if setting.unit.is_empty() { String::new() } else { format!(" of {}", setting.unit) };
        if let Some(number) = number(value.get_ref()) {
            return Ok(Given::Once(number));
        }
        let Some(range) = value.get_ref().as_str() else {
            return Err(self.flaw(value, &what, &format!("a number{unit}, or a range such as \"1..2\"")));
        };
        if ALWAYS_THE_SAME.contains(&setting.key) {
            return Err(self.flaw(value, &what, &format!("a number{unit}: it cannot vary from test to test")));
        }
        domain(range).map(Given::Varied).ok_or_else(|| {
            let expected = format!("\"LO..HI\" or \"A,B,C\", numbers{unit}, the lower end first and no number twice");
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
                "whole numbers of pixels across and down, such as [640, 480]",
            )
        })
    }
}

/// What the tests vary a setting over: `LO..HI` or `A,B,C`.
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
