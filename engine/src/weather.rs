//! The weather at one moment: light, fog, rain and the sun.

use std::ops::RangeInclusive;

/// The rate of the heaviest rain, in mm/h.
const CLOUDBURST: f64 = 50.0;

/// The light and weather at one moment, as cameras see them.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Weather {
    /// The brightness of the light, from 0 (night) to 1 (broad daylight).
    pub light: f64,
    /// The density of the fog, from 0 (no fog) to 1 (so thick that nothing can be seen).
    pub fog: f64,
    /// The intensity of the rain, from 0 (no rain) to 1 (a cloudburst of 50 mm/h).
    pub rain: f64,
    /// The elevation of the sun, in radians above the horizon.
    pub sun_elevation: f64,
    /// The direction of the sun, in radians counter-clockwise from x.
    pub sun_azimuth: f64,
}

/// A part of the weather whose value a stream gives.
#[derive(Debug, Clone)]
pub(crate) struct WeatherPart {
    pub name: &'static str,
    pub range: RangeInclusive<f64>,
    /// The range of the value in words, for messages.
    pub expected: &'static str,
    /// The function that returns the field of the weather for this part.
    pub of: fn(&mut Weather) -> &mut f64,
}

impl Default for Weather {
    /// Returns broad daylight without fog or rain. The sun is behind and to the left of a driver who drives along x.
    fn default() -> Self {
        Self { light: 1.0, fog: 0.0, rain: 0.0, sun_elevation: 0.9, sun_azimuth: 2.3 }
    }
}

impl Weather {
    /// Returns the rain, from 0 to 1, of a rate in mm/h; 1 above 50 mm/h.
    pub fn rain_of_rate(rate: f64) -> f64 {
        (rate / CLOUDBURST).min(1.0)
    }

    /// Returns the rate of the rain in mm/h.
    pub fn rain_rate(&self) -> f64 {
        CLOUDBURST * self.rain
    }
}
