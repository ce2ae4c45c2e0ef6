//! The air between a sensor and what it measures.

use crate::weather::Weather;

/// Extinction times visibility (Koschmieder, at a contrast of 2 %).
const KOSCHMIEDER: f64 = 3.912;
/// How far one sees in the thickest fog, in metres, and how many times as far in the thinnest.
const THICKEST: f64 = 10.0;
const THINNEST: f64 = 1000.0;
/// Rain of 1 mm/h takes so many decibels of light in a kilometre, and more of it takes more to this power
/// (Carbonneau and Wisely 1998; recommendation ITU-R P.1814, table 2).
const RAIN_LOSS: f64 = 1.076;
const RAIN_POWER: f64 = 0.67;

/// What light passes through on its way.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Air {
    /// From 0, night, to 1, broad daylight.
    pub light: f64,
    /// The extinction coefficient of fog and rain in 1/m, 0 without any: 3.912 / visibility.
    pub extinction: f64,
}

impl Default for Air {
    /// Broad daylight, no fog, no rain.
    fn default() -> Self {
        Self { light: 1.0, extinction: 0.0 }
    }
}

impl Air {
    /// The air of a weather. Fog from 0 to 1 is extinction from 0 to that of a visibility of 10 m, exponentially in between:
    /// 3.912 / 10 m · (1000^fog - 1) / 999, so that one sees 326 m in a fog of 0.5, and 3.4 km in one of 0.2.
    ///
    /// Rain of `R` mm/h adds 1.076 · R^0.67 dB/km, so that one sees 1.1 km in the heaviest, of 50 mm/h, and 1.8 km in half of it.
    pub fn of(weather: &Weather) -> Self {
        let thickness = (libm::pow(THINNEST, weather.fog.clamp(0.0, 1.0)) - 1.0) / (THINNEST - 1.0);
        let rain = RAIN_LOSS * libm::pow(weather.rain_rate(), RAIN_POWER);
        // Decibels are tenths of powers of ten, extinction is powers of e; kilometres are a thousand metres.
        let rain = rain * std::f64::consts::LN_10 / 10.0 / 1000.0;
        Self { light: weather.light, extinction: KOSCHMIEDER / THICKEST * thickness + rain }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn fog_takes_the_sight_from_all_to_ten_metres_and_rain_some_of_it() {
        let extinction = |fog| Air::of(&Weather { fog, ..Weather::default() }).extinction;
        assert_eq!(extinction(0.0), 0.0);
        for (fog, visibility) in [(0.2, 3350.0), (0.5, 326.23), (1.0, 10.0)] {
            let found = KOSCHMIEDER / extinction(fog);
            assert!((found / visibility - 1.0).abs() < 1e-3, "{found} m in {fog}");
        }
        let pouring = Air::of(&Weather { rain: 1.0, ..Weather::default() });
        assert!((KOSCHMIEDER / pouring.extinction / 1148.0 - 1.0).abs() < 1e-3, "{pouring:?}");
        let both = Air::of(&Weather { rain: 1.0, fog: 0.5, ..Weather::default() });
        assert!((both.extinction - pouring.extinction - extinction(0.5)).abs() < 1e-15);
        assert_eq!(Air::of(&Weather { light: 0.3, ..Weather::default() }), Air { light: 0.3, extinction: 0.0 });
    }
}
