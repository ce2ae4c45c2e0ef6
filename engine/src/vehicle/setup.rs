//! The choices of a study about the ego vehicle: the model of its motion, and the resistances that slow it down.

use super::{GRAVITY, Vehicle, VehicleModel};
use serde::{Deserialize, Serialize};
use thiserror::Error;

/// The density of air in kg/m³ at sea level and 15 degrees (ISO 2533, the standard atmosphere).
const AIR: f64 = 1.225;

/// The model of a car's motion, with the resistances against it.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct VehicleSetup {
    /// The model that moves the car.
    pub model: VehicleModel,
    /// The resistances; there are none by default.
    pub resistance: Resistance,
}

/// The resistances against the motion of a car. Without a setting, the car rolls on for ever.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields, expecting = "the resistances of a vehicle")]
pub struct Resistance {
    /// The force of the rolling tyres as a share of the weight of the car.
    pub rolling: f64,
    /// The drag coefficient multiplied by the frontal area, in m².
    pub drag_area: f64,
}

/// The description of a setting of the ego vehicle, which is a number that is 0 unless a study sets it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct VehicleSetting {
    /// The name of the setting.
    pub name: &'static str,
    /// The unit of the setting, empty if the setting has no unit.
    pub unit: &'static str,
    /// The least and the greatest value of the setting.
    pub range: (f64, f64),
    /// The meaning of the setting, in words, with usual values and their source.
    pub about: &'static str,
}

/// The error that a vehicle has no such setting, or that the value is out of range.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum VehicleSettingFlaw {
    /// There is no setting with this name.
    #[error("the vehicle has no setting `{name}`; it has {}", Resistance::SETTINGS.map(|setting| setting.name).join(", "))]
    Unknown {
        /// The unknown name.
        name: String,
    },
    /// The value is out of range.
    #[error("vehicle.{name} is {value}, expected a number from {} to {}", .range.0, .range.1)]
    Range {
        /// The name of the setting.
        name: &'static str,
        /// The value that was found.
        value: f64,
        /// The least and the greatest value.
        range: (f64, f64),
    },
}

impl Resistance {
    /// All settings of a vehicle.
    pub const SETTINGS: [VehicleSetting; 2] = [
        VehicleSetting {
            name: "rolling",
            unit: "",
            range: (0.0, 0.1),
            about: "rolling resistance as a share of the weight; 0.013 for car tyres on asphalt (Robert Bosch GmbH, \
                    Automotive Handbook)",
        },
        VehicleSetting {
            name: "drag_area",
            unit: "m²",
            range: (0.0, 10.0),
            about: "drag coefficient multiplied by the frontal area; 0.5 to 0.8 m² for cars (Hucho, Aerodynamics of Road \
                    Vehicles)",
        },
    ];

    /// Sets a setting by its name.
    ///
    /// # Errors
    /// There is no such setting, or the value is out of range.
    pub fn set(&mut self, name: &str, value: f64) -> Result<(), VehicleSettingFlaw> {
        let found = Self::SETTINGS.iter().find(|setting| setting.name == name);
        let setting = found.ok_or_else(|| VehicleSettingFlaw::Unknown { name: name.to_owned() })?;
        *self.value(setting.name) = value;
        self.check()
    }

    fn value(&mut self, name: &str) -> &mut f64 {
        if name == "rolling" { &mut self.rolling } else { &mut self.drag_area }
    }

    /// Checks that all values are in their ranges.
    ///
    /// # Errors
    /// A value is out of range.
    pub fn check(&self) -> Result<(), VehicleSettingFlaw> {
        let mut copy = *self;
        for VehicleSetting { name, range, .. } in Self::SETTINGS {
            let value = *copy.value(name);
            if !(range.0..=range.1).contains(&value) {
                return Err(VehicleSettingFlaw::Range { name, value, range });
            }
        }
        Ok(())
    }

    /// Returns `true` if nothing slows the car down.
    pub fn is_none(&self) -> bool {
        *self == Self::default()
    }

    /// Returns the deceleration in m/s² of a vehicle that rolls at a speed in m/s.
    pub(super) fn deceleration(&self, vehicle: &Vehicle, speed: f64) -> f64 {
        self.rolling * GRAVITY + 0.5 * AIR * self.drag_area * speed * speed / vehicle.mass
    }
}

impl From<VehicleModel> for VehicleSetup {
    fn from(model: VehicleModel) -> Self {
        Self { model, resistance: Resistance::default() }
    }
}
