//! The air between a sensor and the bodies that it measures.

use crate::weather::Weather;

/// The extinction times the visibility (Koschmieder, at a contrast of 2 %).
const KOSCHMIEDER: f64 = 3.912;
/// The visibility in the thickest fog in metres, and the factor between the visibilities in thinnest and thickest fog.
const THICKEST: f64 = 10.0;
const THINNEST: f64 = 1000.0;
/// The loss of light in rain of 1 mm/h, in dB/km, and the power with which the loss grows with the rain rate
/// (Carbonneau and Wisely 1998; recommendation ITU-R P.1814, table 2).
const RAIN_LOSS: f64 = 1.076;
const RAIN_POWER: f64 = 0.67;

/// The amount of daylight, and the loss of light by fog and rain.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Air {
    /// The amount of daylight, from 0 (night) to 1 (broad daylight).
    pub light: f64,
    /// The extinction coefficient of fog and rain, 3.912 / visibility, in 1/m; 0 without fog and rain.
    pub extinction: f64,
}

impl Default for Air {
    /// Returns the air of broad daylight without fog and rain.
    fn default() -> Self {
        Self { light: 1.0, extinction: 0.0 }
    }
}

impl Air {
    /// Returns the daylight and the extinction in a weather. Fog from 0 to 1 gives the extinction 3.912 / 10 m ·
    /// (1000^fog - 1) / 999. The visibility is 10 m in a fog of 1, 326 m in a fog of 0.5, and 3.4 km in a fog of 0.2.
    ///
    /// Rain of `R` mm/h adds 1.076 · R^0.67 dB/km: the visibility is 1.1 km in rain of 50 mm/h and 1.8 km in 25 mm/h.
    pub fn of(weather: &Weather) -> Self {
        let thickness = (libm::pow(THINNEST, weather.fog.clamp(0.0, 1.0)) - 1.0) / (THINNEST - 1.0);
        let rain = RAIN_LOSS * libm::pow(weather.rain_rate(), RAIN_POWER);
        // A decibel is a tenth of a power of ten, extinction is in powers of e; a kilometre is a thousand metres.
        let rain = rain * std::f64::consts::LN_10 / 10.0 / 1000.0;
        Self { light: weather.light, extinction: KOSCHMIEDER / THICKEST * thickness + rain }
    }
}

impl Weather {
    /// Returns the fog, from 0 to 1, in which the visibility is this number of metres; 1 below 10 m, which is the visibility in
    /// the thickest fog.
    pub fn fog_of_visibility(metres: f64) -> f64 {
        let thickness = THICKEST / metres;
        if thickness < 1.0 { libm::log1p(thickness * (THINNEST - 1.0)) / libm::log(THINNEST) } else { 1.0 }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn fog_has_the_visibility_from_which_it_was_computed() {
        for metres in [10.0, 50.0, 326.0, 5000.0, 1e6] {
            let fog = Weather::fog_of_visibility(metres);
            let found = KOSCHMIEDER / Air::of(&Weather { fog, ..Weather::default() }).extinction;
            assert!((found / metres - 1.0).abs() < 1e-9, "{found} m instead of {metres} m");
        }
        assert_eq!([0.0, 3.0, f64::INFINITY].map(Weather::fog_of_visibility), [1.0, 1.0, 0.0]);
    }

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
