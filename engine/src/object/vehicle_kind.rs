//! The kinds of vehicles on a road, with their dimensions and the sources of the dimensions.

use super::{Body, Class};

/// A kind of vehicle: its class and its dimensions. A bicycle and a motorcycle include their rider.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct VehicleKind {
    /// The name of the kind.
    pub name: &'static str,
    /// The class to which vehicles of the kind belong.
    pub class: Class,
    /// The length, the width without mirrors, and the height, in metres.
    pub size: [f64; 3],
    /// The source of the dimensions.
    pub source: &'static str,
}

impl VehicleKind {
    /// A passenger car.
    pub const CAR: Self = Self {
        name: "car",
        class: Class::Car,
        size: [4.5, 1.8, 1.45],
        source: "between a VW Golf VIII (4.284 m, 1.789 m, 1.456 m) and a BMW 3 Series G20 (4.709 m, 1.827 m, 1.442 m)",
    };
    /// A panel van.
    pub const VAN: Self = Self {
        name: "van",
        class: Class::Van,
        size: [5.986, 2.04, 2.59],
        source: "VW Crafter (2017), panel van with medium wheelbase and high roof",
    };
    /// A lorry with three axles.
    pub const TRUCK: Self = Self {
        name: "truck",
        class: Class::Truck,
        size: [10.1, 2.5, 3.8],
        source: "German design vehicle for roads, large lorry with three axles (FGSV, Bemessungsfahrzeuge, 2001)",
    };
    /// A city bus with two axles.
    pub const BUS: Self = Self {
        name: "bus",
        class: Class::Bus,
        size: [12.135, 2.55, 3.12],
        source: "Mercedes-Benz Citaro (2011), solo bus with two axles",
    };
    /// A motorcycle with its rider.
    pub const MOTORCYCLE: Self = Self {
        name: "motorcycle",
        class: Class::Motorcycle,
        size: [2.08, 0.79, 1.7],
        source: "length and width: motorcycle of the Euro NCAP 2023 scenarios (OSC-NCAP-scenarios, `NCAP_Motorcycle`); \
                 height with the rider: motorbike of the vehicle catalogue of esmini 3.6",
    };
    /// A bicycle with its rider.
    pub const BICYCLE: Self = Self {
        name: "bicycle",
        class: Class::Bicycle,
        size: [1.89, 0.5, 1.865],
        source: "bicyclist target of Euro NCAP (ACEA, Bicyclist Target Specifications, 2018), with the width of \
                 `NCAP_Bicycle` in OSC-NCAP-scenarios",
    };
    /// A bicycle without a rider.
    pub const PARKED_BICYCLE: Self = Self {
        name: "parked bicycle",
        class: Class::Bicycle,
        size: [1.89, 0.5, 1.2],
        source: "bicycle of the Euro NCAP 2023 scenarios (OSC-NCAP-scenarios, `NCAP_Bicycle`)",
    };

    /// All kinds of vehicles.
    pub const ALL: [Self; 7] =
        [Self::CAR, Self::VAN, Self::TRUCK, Self::BUS, Self::MOTORCYCLE, Self::BICYCLE, Self::PARKED_BICYCLE];
}

impl Body {
    /// Makes the body of a kind of vehicle.
    pub fn of(kind: &VehicleKind) -> Self {
        let [length, width, height] = kind.size;
        Self::block(kind.class, length, width, height)
    }

    /// Makes the body of a passenger car of middle size.
    pub fn car() -> Self {
        Self::of(&VehicleKind::CAR)
    }

    /// Makes the body of a panel van.
    pub fn van() -> Self {
        Self::of(&VehicleKind::VAN)
    }

    /// Makes the body of a lorry.
    pub fn truck() -> Self {
        Self::of(&VehicleKind::TRUCK)
    }

    /// Makes the body of a city bus.
    pub fn bus() -> Self {
        Self::of(&VehicleKind::BUS)
    }

    /// Makes the body of a motorcycle with its rider.
    pub fn motorcycle() -> Self {
        Self::of(&VehicleKind::MOTORCYCLE)
    }

    /// Makes the body of a bicycle with its rider.
    pub fn bicycle() -> Self {
        Self::of(&VehicleKind::BICYCLE)
    }

    /// Makes the body of a bicycle without a rider. Sensors recognise it by its lower height.
    pub fn parked_bicycle() -> Self {
        Self::of(&VehicleKind::PARKED_BICYCLE)
    }
}
