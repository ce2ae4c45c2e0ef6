//! The conditions of the whole world: light, fog, rain, the sun, and the friction of the roads (the paper's `World`).

use super::{Place, Scenario};
use crate::stream::{Node, Stream};
use crate::weather::{Weather, WeatherPart};
use std::f64::consts::{FRAC_PI_2, TAU};
use std::rc::Rc;

/// The friction coefficient of dry asphalt.
const DRY_ASPHALT: f64 = 0.8;
/// The share of its friction that a road loses in the heaviest rain. Mean peak adhesion of tyres is 0.8 to 0.9 on dry
/// and 0.5 to 0.7 on wet asphalt (Wong, Theory of Ground Vehicles, table 1.3, after Taborek 1957): 0.6 of 0.85.
const LOST_IN_RAIN: f64 = 0.3;

/// The light, weather and friction of a world, not placed yet. Default: broad daylight, no fog, no rain, dry asphalt.
#[derive(Debug, Clone)]
pub struct Environment {
    light: Stream<f64>,
    fog: Stream<f64>,
    rain: Option<Stream<f64>>,
    sun: Option<[Stream<f64>; 2]>,
    friction: Option<Stream<f64>>,
}

/// The light, weather and friction of a world, as streams that the program can read.
#[derive(Debug, Clone)]
pub struct Conditions {
    /// The amount of daylight, from 0 (night) to 1 (broad daylight).
    pub light: Stream<f64>,
    /// The density of the fog, from 0 (no fog) to 1 (a visibility of 10 m).
    pub fog: Stream<f64>,
    /// The strength of the rain, from 0 (no rain) to 1 (a cloudburst of 50 mm/h).
    pub rain: Stream<f64>,
    /// The elevation of the sun, in radians above the horizon.
    pub sun_elevation: Stream<f64>,
    /// The azimuth of the sun, in radians counter-clockwise from x.
    pub sun_azimuth: Stream<f64>,
    /// The friction coefficient between tyre and road, reduced by the rain.
    pub friction: Stream<f64>,
}

impl Environment {
    /// Makes the default conditions, which are broad daylight, no fog, no rain and dry asphalt.
    #[expect(clippy::new_without_default, reason = "as every other object it is made by its name")]
    pub fn new() -> Self {
        let Weather { light, fog, .. } = Weather::default();
        Self { light: Stream::constant(light), fog: Stream::constant(fog), rain: None, sun: None, friction: None }
    }

    /// Sets the amount of daylight, from 0 (night) to 1 (broad daylight).
    pub fn light(mut self, light: impl Into<Stream<f64>>) -> Self {
        self.light = light.into();
        self
    }

    /// Sets the density of the fog, from 0 (no fog) to 1 (a visibility of 10 m).
    pub fn fog(mut self, fog: impl Into<Stream<f64>>) -> Self {
        self.fog = fog.into();
        self
    }

    /// Sets the strength of the rain, from 0 (no rain) to 1 (a cloudburst of 50 mm/h). Rain takes 0.3 times its value
    /// as a share of the friction of all roads, and reduces the sight of all sensors but radars.
    pub fn rain(mut self, rain: impl Into<Stream<f64>>) -> Self {
        self.rain = Some(rain.into());
        self
    }

    /// Sets the sun's elevation above the horizon and its azimuth, counter-clockwise from x, both in radians.
    pub fn sun(mut self, elevation: impl Into<Stream<f64>>, azimuth: impl Into<Stream<f64>>) -> Self {
        self.sun = Some([elevation.into(), azimuth.into()]);
        self
    }

    /// Sets the friction coefficient between tyre and dry road.
    pub fn friction(mut self, friction: impl Into<Stream<f64>>) -> Self {
        self.friction = Some(friction.into());
        self
    }
}

impl Default for Conditions {
    fn default() -> Self {
        let Weather { light, fog, rain, sun_elevation, sun_azimuth } = Weather::default();
        let [light, fog, rain] = [light, fog, rain].map(Stream::constant);
        let [sun_elevation, sun_azimuth] = [sun_elevation, sun_azimuth].map(Stream::constant);
        Self { light, fog, rain, sun_elevation, sun_azimuth, friction: Stream::constant(DRY_ASPHALT) }
    }
}

impl Conditions {
    /// Returns the friction that remains in the rain.
    pub(super) fn wet(&self, friction: Stream<f64>) -> Stream<f64> {
        friction * (1.0 - LOST_IN_RAIN * &self.rain)
    }

    /// Returns the streams of the weather in three groups: light and fog, the rain, and the position of the sun.
    pub(super) fn weather(&self) -> [Vec<(WeatherPart, Rc<Node>)>; 3] {
        let part = |name, range, expected, of, stream: &Stream<f64>| {
            (WeatherPart { name, range, expected, of }, stream.node.clone())
        };
        [
            vec![
                part("light", 0.0..=1.0, "0 to 1", |weather| &mut weather.light, &self.light),
                part("fog", 0.0..=1.0, "0 to 1", |weather| &mut weather.fog, &self.fog),
            ],
            vec![part("rain", 0.0..=1.0, "0 to 1", |weather| &mut weather.rain, &self.rain)],
            vec![
                part(
                    "sun's elevation",
                    -FRAC_PI_2..=FRAC_PI_2,
                    "-pi/2 to pi/2",
                    |weather| &mut weather.sun_elevation,
                    &self.sun_elevation,
                ),
                part(
                    "sun's azimuth",
                    -TAU..=TAU,
                    "-2 pi to 2 pi",
                    |weather| &mut weather.sun_azimuth,
                    &self.sun_azimuth,
                ),
            ],
        ]
    }
}

impl Place for Environment {
    type Handle = Conditions;

    fn place(self, scenario: &mut Scenario) -> Conditions {
        if let Some(friction) = self.friction {
            scenario.say_friction(friction);
        }
        scenario.say_weather(self.light, self.fog, self.sun);
        if let Some(rain) = self.rain {
            scenario.say_rain(rain);
        }
        scenario.conditions.clone()
    }
}
