//! Drivers: the systems under test that come with the engine.
//!
//! A driver is asked at its own period for a control and is told nothing but its briefing and what there is to
//! see. Every driver has named settings with documented values, which a study can change.

mod aeb;
mod cruise;
mod expert;
mod frenet;
mod lane_camera;
mod perception;
pub mod reference;

use crate::observation::{Briefing, Control, Observation};
use crate::sensor::{Cameras, Image, Rig};
use paracosm_space::{did_you_mean, nearest};
use thiserror::Error;

/// A system under test.
pub trait Driver: Send {
    /// Seconds between two questions.
    fn period(&self) -> f64;

    /// What it measures with, made anew for every run, before it is [reset](Self::reset): nothing, where it is content
    /// with the observation.
    fn equipment(&mut self) -> Equipment {
        Equipment::default()
    }

    /// Seconds from when it is asked to when its answer takes effect, rounded to whole ticks; until then the answer before
    /// that stays in effect, and before the first one the car rolls.
    fn latency(&self) -> f64 {
        0.0
    }

    /// Forgets everything: a new run begins.
    ///
    /// # Errors
    /// It cannot drive such a car.
    fn reset(&mut self, briefing: &Briefing) -> Result<(), Fault>;

    /// Takes in what its equipment has measured and what has arrived since it was last asked; comes before every
    /// [`step`](Self::step). Images come camera by camera, in the order of their names, and of each the earliest first; one
    /// that was lost, or that was taken from within something, never comes.
    ///
    /// # Errors
    /// It cannot go on.
    fn perceive(&mut self, _rig: &Rig, _images: &[Image]) -> Result<(), Fault> {
        Ok(())
    }

    /// What to do until the next question.
    ///
    /// # Errors
    /// It cannot go on: it has died, or does not answer.
    fn step(&mut self, observation: &Observation) -> Result<Control, Fault>;
}

/// What a driver measures with.
#[derive(Debug, Default)]
pub struct Equipment {
    /// Sensors other than cameras.
    pub rig: Rig,
    /// Cameras, whose images come in the order of their names.
    pub cameras: Cameras,
}

/// Why a driver cannot go on, which ends the test with an error that says so.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[error("{message}")]
pub struct Fault {
    /// What kind of fault it is.
    pub kind: FaultKind,
    /// What happened, in words.
    pub message: String,
}

/// The kinds of faults that drivers have.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum FaultKind {
    /// The driver says so itself.
    Stated,
    /// It measures with what cannot be, or with what nobody draws.
    Equipment,
    /// It answers what makes no sense.
    Answer,
    /// It does not answer in time.
    TimedOut,
    /// Its process is gone, or the connection to it.
    Lost,
    /// Nobody waits for it any more.
    Interrupted,
}

impl Fault {
    /// The fault that a driver states itself, in its own words.
    pub fn new(message: impl Into<String>) -> Self {
        Self::of(FaultKind::Stated, message)
    }

    /// A fault of some kind, in words.
    pub fn of(kind: FaultKind, message: impl Into<String>) -> Self {
        Self { kind, message: message.into() }
    }
}

/// A number that a driver can be set to.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Setting {
    /// Its name.
    pub name: &'static str,
    /// What it is where nothing else is said.
    pub default: f64,
    /// Its unit, empty where it has none.
    pub unit: &'static str,
    /// The least and the greatest value it can have.
    pub range: (f64, f64),
    /// Whether it counts something, so that only whole numbers make sense.
    pub whole: bool,
    /// What it means.
    pub about: &'static str,
}

/// A setting that can have any value in its range.
const fn setting(
    name: &'static str,
    default: f64,
    unit: &'static str,
    range: (f64, f64),
    about: &'static str,
) -> Setting {
    Setting { name, default, unit, range, whole: false, about }
}

/// A setting that counts something.
const fn whole(name: &'static str, default: f64, range: (f64, f64), about: &'static str) -> Setting {
    Setting { name, default, unit: "", range, whole: true, about }
}

/// The values of a driver's settings.
#[derive(Debug, Clone, PartialEq)]
pub struct Settings(Vec<(&'static str, f64)>);

impl Settings {
    /// The value of a setting that the driver has declared.
    ///
    /// # Panics
    /// The driver declares no such setting.
    pub fn get(&self, name: &str) -> f64 {
        let found = self.0.iter().find(|(key, _)| *key == name);
        found.unwrap_or_else(|| panic!("the driver declares no setting `{name}`")).1
    }
}

/// All that the software knows of a driver that comes with it: its name, its settings, and how a driver is made.
#[derive(Debug)]
pub struct Descriptor {
    /// The name by which it is chosen.
    pub name: &'static str,
    /// What it does, in one line.
    pub about: &'static str,
    /// What can be set.
    pub settings: &'static [Setting],
    /// A driver with these settings.
    pub make: fn(&Settings) -> Box<dyn Driver>,
}

/// Why there is no such driver.
#[derive(Debug, Error, PartialEq)]
pub enum DriverError {
    /// No driver has that name.
    #[error("no driver is called `{name}`{}", did_you_mean(.nearest))]
    Unknown {
        /// The name.
        name: String,
        /// A name that was perhaps meant.
        nearest: Option<&'static str>,
    },
    /// The driver has no such setting.
    #[error("driver `{driver}` has no setting `{name}`{}", did_you_mean(.nearest))]
    UnknownSetting {
        /// The driver.
        driver: &'static str,
        /// The setting's name.
        name: String,
        /// A name that was perhaps meant.
        nearest: Option<&'static str>,
    },
    /// The setting cannot have that value.
    #[error(
        "driver `{driver}`: setting `{name}` is {value}, expected a {}number from {} to {}",
        if *whole { "whole " } else { "" }, range.0, range.1
    )]
    OutOfRange {
        /// The driver.
        driver: &'static str,
        /// The setting.
        name: &'static str,
        /// The value asked for.
        value: f64,
        /// Least and greatest value.
        range: (f64, f64),
        /// Whether it has to be a whole number.
        whole: bool,
    },
}

/// The drivers that come with the engine, in the order in which they are shown.
pub const ALL: &[&Descriptor] = &[
    &aeb::DESCRIPTOR,
    &cruise::DESCRIPTOR,
    &expert::DESCRIPTOR,
    &lane_camera::DESCRIPTOR,
    &reference::CC,
    &reference::RSS,
    &reference::FSM,
    &reference::REG157,
    &reference::IDEAL,
];

/// The driver of that name.
///
/// # Errors
/// There is none; the error suggests the nearest name.
pub fn find(name: &str) -> Result<&'static Descriptor, DriverError> {
    ALL.iter().copied().find(|driver| driver.name == name).ok_or_else(|| DriverError::Unknown {
        name: name.to_owned(),
        nearest: nearest(name, ALL.iter().map(|driver| driver.name)),
    })
}

impl Descriptor {
    /// All settings: the defaults, but for what `changes` says.
    ///
    /// # Errors
    /// A change names no setting, or gives it a value out of its range.
    pub fn settings(&self, changes: &[(String, f64)]) -> Result<Settings, DriverError> {
        let mut settings = Settings(self.settings.iter().map(|setting| (setting.name, setting.default)).collect());
        for (name, value) in changes {
            let index = self.settings.iter().position(|setting| setting.name == name).ok_or_else(|| {
                let nearest = nearest(name, self.settings.iter().map(|setting| setting.name));
                DriverError::UnknownSetting { driver: self.name, name: name.clone(), nearest }
            })?;
            let Setting { name, range, whole, .. } = self.settings[index];
            if !(range.0..=range.1).contains(value) || whole && value.fract() != 0.0 {
                return Err(DriverError::OutOfRange { driver: self.name, name, value: *value, range, whole });
            }
            settings.0[index].1 = *value;
        }
        Ok(settings)
    }

    /// A driver with its settings changed so.
    ///
    /// # Errors
    /// As [`Descriptor::settings`].
    pub fn build(&self, changes: &[(String, f64)]) -> Result<Box<dyn Driver>, DriverError> {
        Ok((self.make)(&self.settings(changes)?))
    }
}

impl Settings {
    /// Names and values in the driver's order.
    pub fn iter(&self) -> impl Iterator<Item = (&'static str, f64)> + '_ {
        self.0.iter().copied()
    }
}

#[cfg(test)]
mod tests;
