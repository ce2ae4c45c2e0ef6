//! The drivers that lists show: those of the engine, networks, and drivers in an external process.

use super::network::CLONED;
use paracosm_engine::driver::{self, Descriptor, Setting};

/// The settings that every driver in an external process has, and that are not passed on to the driver. Networks have
/// only the first of them.
pub(super) const LATENCY: Setting = Setting {
    name: "latency",
    default: 0.0,
    unit: "s",
    range: (0.0, 100.0),
    whole: false,
    about: "the time from a question to the driver until its answer takes effect",
};
pub(super) const SEED: Setting = Setting {
    name: "seed",
    default: 0.0,
    unit: "",
    // Up to this limit, every whole number is exact as a float.
    range: (0.0, 9_007_199_254_740_992.0),
    whole: true,
    about: "the seed of the driver's randomness and of its sensors' noise",
};

/// An entry in the list of drivers that a user can choose.
#[derive(Debug, Clone, Copy)]
pub struct ListedDriver {
    /// The name by which the driver is chosen.
    pub name: &'static str,
    /// The description of the driver, in one line.
    pub about: &'static str,
    /// The settings of the driver.
    pub settings: &'static [Setting],
}

impl ListedDriver {
    /// Returns the list entry of a driver that comes with the engine.
    pub const fn of(driver: &Descriptor) -> Self {
        Self { name: driver.name, about: driver.about, settings: driver.settings }
    }

    /// Returns the list entries of all drivers that a user can choose, which are drivers of the engine, neural
    /// networks, and drivers in an external process.
    pub fn all() -> impl Iterator<Item = Self> {
        driver::ALL.iter().map(|driver| Self::of(driver)).chain(ELSEWHERE)
    }
}

/// The drivers that the engine does not make.
const ELSEWHERE: [ListedDriver; 3] = [
    ListedDriver {
        name: CLONED,
        about: "a network that comes with the software and drives by a camera (feature `neural`)",
        settings: &[LATENCY],
    },
    ListedDriver {
        name: "MODEL.onnx",
        about: "a network of your own in a file (feature `neural`)",
        settings: &[LATENCY],
    },
    ListedDriver {
        name: "grpc://HOST:PORT",
        about: "a driver of your own that listens at this address; --driver-command COMMAND starts a driver",
        settings: &[LATENCY, SEED],
    },
];
