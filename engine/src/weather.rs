//! Light, fog, rain and the sun, at one moment.

use std::ops::RangeInclusive;

/// What the heaviest rain brings, in mm/h.
const CLOUDBURST: f64 = 50.0;

/// What of the conditions cameras see, at one moment.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Weather {
    /// From 0, night, to 1, broad daylight.
    pub light: f64,
    /// From 0, none, to 1, so thick that nothing is seen.
    pub fog: f64,
    /// From 0, none, to 1, a cloudburst of 50 mm/h.
    pub rain: f64,
    /// How high the sun stands, in radians above the horizon.
    pub sun_elevation: f64,
    /// Where the sun stands, in radians counter-clockwise from x.
    pub sun_azimuth: f64,
}

/// A part of the weather that a stream says.
#[derive(Debug, Clone)]
pub(crate) struct WeatherPart {
    pub name: &'static str,
    pub range: RangeInclusive<f64>,
    /// The range in words.
    pub expected: &'static str,
    /// Its place in the weather.
    pub of: fn(&mut Weather) -> &mut f64,
}

impl Default for Weather {
    /// Broad daylight from behind and the left of who drives along x, without fog or rain.
    fn default() -> Self {
        Self { light: 1.0, fog: 0.0, rain: 0.0, sun_elevation: 0.9, sun_azimuth: 2.3 }
    }
}

impl Weather {
    /// How much rain falls, in mm/h.
    pub fn rain_rate(&self) -> f64 {
        CLOUDBURST * self.rain
    }
}
