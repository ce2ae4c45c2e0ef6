//! The environment of a scenario: the time of day, the sun, fog, rain, and the friction of the road.
//!
//! An `Environment` of a file changes the parts that it has. All others stay as they are.

use super::clock::Clock;
use super::names::Names;
use super::scope::Node;
use super::sun;
use crate::xml::ReadError;
use paracosm_engine::Weather;
use paracosm_engine::road::wrapped;
use std::f64::consts::FRAC_PI_2;

/// The illuminance of broad daylight in lux (OpenSCENARIO XML 1.3, class `Sun`).
const DAYLIGHT: f64 = 100_000.0;
/// The visibility in metres in the thickest fog, and the rate of the heaviest rain in mm/h.
const THICKEST: f64 = 10.0;
const HEAVIEST: f64 = 50.0;
const THICKER: &str = "the visibility is 10 m, which is that of the thickest fog here";
const HEAVIER: &str = "it rains 50 mm/h, which is the heaviest rain here";
const SNOW: &str = "there is no snow";

/// A change of the environment.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(super) struct Environment {
    clock: Option<Clock>,
    /// The elevation and the azimuth of the sun, as a world has them.
    sun: Option<[f64; 2]>,
    light: Option<f64>,
    fog: Option<f64>,
    rain: Option<f64>,
    /// The factor of the friction of the road.
    friction: Option<f64>,
}

/// The environment during a run.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Surroundings {
    /// The time of day, with the seconds from the beginning of the run to the moment at which it was set.
    clock: (Clock, f64),
    weather: Weather,
    friction: f64,
    sun: Sun,
}

/// The source of the place of the sun.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Sun {
    /// The sun stands where it stands in all worlds.
    Usual,
    /// The sun follows the clock.
    OfClock,
    /// An environment has said where the sun stands.
    Given,
}

/// The names of the numbers of [`Surroundings::parts`].
pub(super) const PARTS: [&str; 6] = ["light", "fog", "rain", "sun_elevation", "sun_azimuth", "friction"];

impl Environment {
    /// Reads an element `EnvironmentAction`.
    pub fn read(action: Node<'_>, names: Names<'_>) -> Result<Self, ReadError> {
        let given = action.choice("Environment or CatalogReference")?;
        names.catalogs.resolved(given, &["Environment"], |environment| {
            let mut read = Self::default();
            read.clock = environment.first("TimeOfDay").map(Clock::read).transpose()?;
            if let Some(weather) = environment.first("Weather") {
                read.weather(weather, names)?;
            }
            if let Some(road) = environment.first("RoadCondition") {
                read.friction = Some(road.length("frictionScaleFactor")?);
            }
            Ok(read)
        })
    }

    fn weather(&mut self, weather: Node<'_>, names: Names<'_>) -> Result<(), ReadError> {
        if let Some(sun) = weather.first("Sun") {
            let elevation = sun.number("elevation")?;
            if elevation.abs() > FRAC_PI_2 {
                return Err(sun.unexpected("elevation", &elevation.to_string(), "an angle of -pi/2 to pi/2 radians"));
            }
            // The azimuth of a file is 0 in the north, where y points, and pi/2 in the east, where x points.
            self.sun = Some([elevation, wrapped(FRAC_PI_2 - sun.number("azimuth")?)]);
            self.light = light(sun)?;
        }
        if let Some(fog) = weather.first("Fog") {
            let metres = fog.length("visualRange")?;
            if metres < THICKEST {
                names.catalogs.remark(fog, "visualRange", THICKER);
            }
            self.fog = Some(Weather::fog_of_visibility(metres));
        }
        if let Some(falling) = weather.first("Precipitation") {
            let kind = falling.one_of("precipitationType", &[("dry", 0.0), ("rain", 1.0), ("snow", -1.0)])?;
            let rain = rain(falling, names)?;
            if kind < 0.0 {
                names.catalogs.remark(falling, "precipitationType", SNOW);
            }
            self.rain = Some(if kind > 0.0 { rain } else { 0.0 });
        }
        Ok(())
    }
}

/// Returns the light of an element `Sun`, from 0 to 1; `None` if the element does not say it.
fn light(sun: Node<'_>) -> Result<Option<f64>, ReadError> {
    if sun.element.text("illuminance").is_some() {
        return Ok(Some((sun.length("illuminance")? / DAYLIGHT).min(1.0)));
    }
    // Files of version 1.0 have a share of the daylight, or lux.
    let given = sun.element.text("intensity").map(|_| sun.length("intensity")).transpose()?;
    Ok(given.map(|intensity| if intensity > 1.0 { (intensity / DAYLIGHT).min(1.0) } else { intensity }))
}

/// Returns the rain of an element `Precipitation`, from 0 to 1.
fn rain(falling: Node<'_>, names: Names<'_>) -> Result<f64, ReadError> {
    // Files of version 1.0 have a share of the heaviest rain.
    if falling.element.text("precipitationIntensity").is_none() && falling.element.text("intensity").is_some() {
        let share = falling.length("intensity")?;
        let wrong = || falling.unexpected("intensity", &share.to_string(), "a number from 0 to 1");
        return if share <= 1.0 { Ok(share) } else { Err(wrong()) };
    }
    let rate = falling.length("precipitationIntensity")?;
    if rate > HEAVIEST {
        names.catalogs.remark(falling, "precipitationIntensity", HEAVIER);
    }
    Ok(Weather::rain_of_rate(rate))
}

impl Default for Surroundings {
    /// Returns the weather of all worlds. The clock stands at the beginning of the year 1970.
    fn default() -> Self {
        Self { clock: (Clock::default(), 0.0), weather: Weather::default(), friction: 1.0, sun: Sun::Usual }
    }
}

impl Surroundings {
    /// Changes the environment, `time` seconds after the beginning of the run.
    pub fn change(&mut self, by: &Environment, time: f64) {
        if let Some(clock) = by.clock {
            self.clock = (clock, time);
            self.sun = if self.sun == Sun::Usual { Sun::OfClock } else { self.sun };
        }
        if let Some(sun) = by.sun {
            [self.weather.sun_elevation, self.weather.sun_azimuth] = sun;
            self.sun = Sun::Given;
        }
        let Weather { light, fog, rain, .. } = &mut self.weather;
        for (part, new) in [(light, by.light), (fog, by.fog), (rain, by.rain), (&mut self.friction, by.friction)] {
            *part = new.unwrap_or(*part);
        }
    }

    /// Returns the seconds since the beginning of the year 1970 that the clock shows, `time` seconds after the beginning of the
    /// run.
    pub fn seconds(&self, time: f64) -> f64 {
        self.clock.0.seconds + self.passed(time)
    }

    /// Returns `true` if the sun moves without a further change.
    pub fn moves(&self) -> bool {
        self.sun == Sun::OfClock && self.clock.0.runs
    }

    /// Returns the weather of the world and the factor of the friction, in the order of [`PARTS`].
    pub fn parts(&self, time: f64) -> [f64; 6] {
        let Weather { mut light, fog, rain, mut sun_elevation, mut sun_azimuth } = self.weather;
        if self.sun == Sun::OfClock {
            [sun_elevation, sun_azimuth] = sun::place(&self.clock.0, self.passed(time));
            light = sun::daylight(sun_elevation);
        }
        [light, fog, rain, sun_elevation, sun_azimuth, self.friction]
    }

    fn passed(&self, time: f64) -> f64 {
        let (clock, since) = self.clock;
        if clock.runs { time - since } else { 0.0 }
    }
}
