//! Drivers: the systems under test that come with the engine.
//!
//! The engine asks a driver for a control at the driver's own period. A driver gets only its briefing, observations and
//! readings of its sensors. Every driver has named settings with documented values, which a study can change.

mod aeb;
mod cruise;
mod default;
mod expert;
mod frenet;
mod lane_camera;
mod perception;
mod planner;
pub mod reference;

pub use perception::hidden;

use crate::observation::{Briefing, Control, Observation};
use crate::sensor::{Cameras, Image, Rig};
use paracosm_space::{did_you_mean, nearest};
use thiserror::Error;

/// A system under test that drives the ego vehicle.
pub trait Driver: Send {
    /// Returns the seconds between two questions to the driver.
    fn period(&self) -> f64;

    /// Returns the driver's sensors, made anew for every run before the driver is [reset](Self::reset). The equipment
    /// is empty if the driver needs only the observation.
    fn equipment(&mut self) -> Equipment {
        Equipment::default()
    }

    /// Returns the seconds from a question until its answer takes effect, rounded to whole ticks. Until then the
    /// previous answer stays in effect. Before the first answer the car rolls.
    fn latency(&self) -> f64 {
        0.0
    }

    /// Returns `true` if the driver takes the car over from a scenario that leads the car. If it is `false`, the scenario leads
    /// the car throughout, and no contact ends the run.
    fn takes_over(&self) -> bool {
        true
    }

    /// Resets the driver, because a new run begins. The driver forgets all earlier runs.
    ///
    /// # Errors
    /// The driver cannot drive such a car.
    fn reset(&mut self, briefing: &Briefing) -> Result<(), Fault>;

    /// Takes in the readings and images that have arrived since the last question. Every [`step`](Self::step) follows
    /// such a call. Images come camera by camera, in the order of the cameras' names, and the images of one camera come
    /// in the order of time. An image that was lost, or that was taken from inside a body, never comes.
    ///
    /// # Errors
    /// The driver cannot go on.
    fn perceive(&mut self, _rig: &Rig, _images: &[Image]) -> Result<(), Fault> {
        Ok(())
    }

    /// Returns the control of the car until the next question.
    ///
    /// # Errors
    /// The driver cannot go on: it has died, or does not answer.
    fn step(&mut self, observation: &Observation) -> Result<Control, Fault>;
}

/// The sensors of a driver.
#[derive(Debug, Default)]
pub struct Equipment {
    /// The sensors of the driver other than cameras.
    pub rig: Rig,
    /// The cameras of the driver. Their images come in the order of the cameras' names.
    pub cameras: Cameras,
}

/// The reason why a driver cannot go on. The fault ends the test with an error that gives the reason.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[error("{message}")]
pub struct Fault {
    /// The kind of the fault.
    pub kind: FaultKind,
    /// The description of the fault in words.
    pub message: String,
}

/// The kind of a driver's fault.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum FaultKind {
    /// The driver itself reports a fault.
    Stated,
    /// The driver asks for impossible sensors, or for cameras in a run that renders no images.
    Equipment,
    /// The driver's answer is of the wrong kind or has impossible values.
    Answer,
    /// The driver does not answer in time.
    TimedOut,
    /// The driver's process or the connection to the process is gone.
    Lost,
    /// The campaign was interrupted and no longer waits for the driver.
    Interrupted,
}

impl Fault {
    /// Makes a fault that the driver itself reports, in the words of the driver.
    pub fn new(message: impl Into<String>) -> Self {
        Self::of(FaultKind::Stated, message)
    }

    /// Makes a fault of the given kind, with a description of the fault in words.
    pub fn of(kind: FaultKind, message: impl Into<String>) -> Self {
        Self { kind, message: message.into() }
    }
}

/// The description of a driver's setting, which is a number that a study can change.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Setting {
    /// The name of the setting.
    pub name: &'static str,
    /// The default value of the setting.
    pub default: f64,
    /// The unit of the setting, empty if the setting has no unit.
    pub unit: &'static str,
    /// The least and the greatest value of the setting.
    pub range: (f64, f64),
    /// True if the setting takes only whole numbers, because it counts something.
    pub whole: bool,
    /// The meaning of the setting, in words.
    pub about: &'static str,
}

/// Makes a setting that can have any value in its range.
const fn setting(
    name: &'static str,
    default: f64,
    unit: &'static str,
    range: (f64, f64),
    about: &'static str,
) -> Setting {
    Setting { name, default, unit, range, whole: false, about }
}

/// Makes a setting that counts something.
const fn whole(name: &'static str, default: f64, range: (f64, f64), about: &'static str) -> Setting {
    Setting { name, default, unit: "", range, whole: true, about }
}

/// The values of a driver's settings.
#[derive(Debug, Clone, PartialEq)]
pub struct Settings(Vec<(&'static str, f64)>);

impl Settings {
    /// Returns the value of a setting that the driver has declared.
    ///
    /// # Panics
    /// The driver declares no such setting.
    pub fn get(&self, name: &str) -> f64 {
        let found = self.0.iter().find(|(key, _)| *key == name);
        found.unwrap_or_else(|| panic!("the driver declares no setting `{name}`")).1
    }
}

/// The description of a driver that comes with the engine, with the function that makes the driver.
#[derive(Debug)]
pub struct Descriptor {
    /// The name by which a study chooses the driver.
    pub name: &'static str,
    /// A description of the driver in one line.
    pub about: &'static str,
    /// The settings that the driver declares.
    pub settings: &'static [Setting],
    /// The function that makes the driver from the values of its settings.
    pub make: fn(&Settings) -> Box<dyn Driver>,
}

/// An error in the name or the settings of a driver.
#[derive(Debug, Error, PartialEq)]
pub enum DriverError {
    /// No driver has the given name.
    #[error("no driver is called `{name}`{}", did_you_mean(.nearest))]
    Unknown {
        /// The name that no driver has.
        name: String,
        /// A known name that the user perhaps meant.
        nearest: Option<&'static str>,
    },
    /// The driver has no setting with the given name.
    #[error("driver `{driver}` has no setting `{name}`{}", did_you_mean(.nearest))]
    UnknownSetting {
        /// The name of the driver.
        driver: &'static str,
        /// The unknown name of the setting.
        name: String,
        /// A known name that the user perhaps meant.
        nearest: Option<&'static str>,
    },
    /// The given value is not in the range of the setting, or the setting takes only whole numbers.
    #[error(
        "the setting `{name}` of driver `{driver}` is {value}, expected a {}number from {} to {}",
        if *whole { "whole " } else { "" }, range.0, range.1
    )]
    OutOfRange {
        /// The name of the driver.
        driver: &'static str,
        /// The name of the setting.
        name: &'static str,
        /// The value that the user gave.
        value: f64,
        /// The least and the greatest value of the setting.
        range: (f64, f64),
        /// True if the value has to be a whole number.
        whole: bool,
    },
}

/// The descriptions of all drivers that come with the engine. Lists show the drivers in this order.
pub const ALL: &[&Descriptor] = &[
    &aeb::DESCRIPTOR,
    &cruise::DESCRIPTOR,
    &default::DESCRIPTOR,
    &expert::DESCRIPTOR,
    &lane_camera::DESCRIPTOR,
    &planner::DESCRIPTOR,
    &reference::CC,
    &reference::RSS,
    &reference::FSM,
    &reference::REG157,
    &reference::IDEAL,
];

/// Finds the driver with the given name.
///
/// # Errors
/// No driver has the given name. The error suggests the nearest name.
pub fn find(name: &str) -> Result<&'static Descriptor, DriverError> {
    ALL.iter().copied().find(|driver| driver.name == name).ok_or_else(|| DriverError::Unknown {
        name: name.to_owned(),
        nearest: nearest(name, ALL.iter().map(|driver| driver.name)),
    })
}

impl Descriptor {
    /// Returns the values of all settings of the driver, which are the defaults unless `changes` gives another value.
    ///
    /// # Errors
    /// A change names an unknown setting, or its value is out of the setting's range.
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

    /// Makes a driver with the default settings, except for the given changes.
    ///
    /// # Errors
    /// Returns the errors of [`Descriptor::settings`].
    pub fn build(&self, changes: &[(String, f64)]) -> Result<Box<dyn Driver>, DriverError> {
        Ok((self.make)(&self.settings(changes)?))
    }
}

impl Settings {
    /// Returns the names and values of the settings, in the order in which the driver declares the settings.
    pub fn iter(&self) -> impl Iterator<Item = (&'static str, f64)> + '_ {
        self.0.iter().copied()
    }
}

#[cfg(test)]
mod tests;
