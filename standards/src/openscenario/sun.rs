//! The place of the sun at a time of day, for scenarios that say the time and not where the sun is.
//!
//! A scenario has no place on the earth. The sun stands as it does at 50 degrees north, and the local time is the solar time.

use super::clock::Clock;
use std::f64::consts::{PI, TAU};

/// The latitude of Frankfurt and of Prague in radians.
const LATITUDE: f64 = 50.0 * PI / 180.0;
/// The angle in radians between the axis of the earth and the axis of its orbit.
const OBLIQUITY: f64 = 23.44 * PI / 180.0;
/// The days from the beginning of the year 1970 to the equinox of March, and the days of a tropical year.
const EQUINOX: f64 = 79.04;
const YEAR: f64 = 365.2422;
/// The seconds of a day.
const DAY: f64 = 86_400.0;
/// The depth of the sun below the horizon in radians at which the civil twilight ends, and nothing can be seen without lamps.
const TWILIGHT: f64 = 6.0 * PI / 180.0;

/// Returns the elevation of the sun above the horizon and its azimuth, counter-clockwise from the east, both in radians. `seconds`
/// have passed since the clock was set. The orbit of the earth counts as a circle, which moves the sun by at most 1 degree.
pub(super) fn place(clock: &Clock, seconds: f64) -> [f64; 2] {
    let now = clock.local() + seconds;
    let declination = libm::asin(libm::sin(OBLIQUITY) * libm::sin(TAU * (now / DAY - EQUINOX) / YEAR));
    // The angle that the earth has turned since noon.
    let (sin_hour, cos_hour) = libm::sincos(TAU * (now / DAY).rem_euclid(1.0) - PI);
    let (sin_place, cos_place) = libm::sincos(LATITUDE);
    let (sin_sun, cos_sun) = libm::sincos(declination);
    let (east, north) = (-cos_sun * sin_hour, cos_place * sin_sun - sin_place * cos_sun * cos_hour);
    let up = sin_place * sin_sun + cos_place * cos_sun * cos_hour;
    [libm::asin(up.clamp(-1.0, 1.0)), libm::atan2(north, east)]
}

/// Returns the daylight, from 0 to 1, under a sun at this elevation: broad daylight until sunset, and none after the twilight.
pub(super) fn daylight(elevation: f64) -> f64 {
    (1.0 + elevation / TWILIGHT).clamp(0.0, 1.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::FRAC_PI_2;

    #[test]
    fn the_sun_is_high_in_the_south_at_noon_in_june_and_low_in_december() {
        // 40 degrees are the zenith distance of the equator; the declination adds to it.
        for (text, elevation, azimuth) in [
            ("2026-06-21T12:00:00", 40.0 + 23.44, -FRAC_PI_2),
            ("2026-12-21T12:00:00+01:00", 40.0 - 23.44, -FRAC_PI_2),
            ("2026-03-20T12:00:00Z", 40.0, -FRAC_PI_2),
            ("2026-03-20T06:00:00-08:00", 0.0, 0.0),
            ("2026-03-20T18:00:00", 0.0, PI),
            ("2026-06-21T00:00:00", 23.44 - 40.0, FRAC_PI_2),
        ] {
            let [up, aside] = place(&Clock::at(text), 0.0);
            assert!((up.to_degrees() - elevation).abs() < 0.5, "{text}: {} degrees high", up.to_degrees());
            assert!((aside - azimuth).abs() < 0.01, "{text}: at {aside}");
        }
        let morning = Clock::at("2026-03-20T06:00:00");
        assert!((place(&morning, 6.0 * 3600.0)[0].to_degrees() - 40.0).abs() < 0.5);
    }

    #[test]
    fn daylight_ends_with_the_twilight() {
        let after = |degrees: f64| daylight(-degrees.to_radians());
        assert_eq!([after(-40.0), after(0.0), after(6.1)], [1.0, 1.0, 0.0]);
        assert!((after(3.0) - 0.5).abs() < 1e-12);
    }
}
