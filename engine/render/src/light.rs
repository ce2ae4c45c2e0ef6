//! Computes the light that surfaces receive from the few numbers of an [`Atmosphere`].
//!
//! Light is linear, and 1 is about the light that a white surface reflects in full sun. Nothing adapts to the dark.
//! Adaptation, like all other effects of lenses and sensors, is left to the code that makes a sensor's image of a
//! frame.

use crate::atmosphere::Daylight;
use crate::{Atmosphere, ViewError};

/// A colour, or light of three colours: red, green and blue, linear.
type Rgb = [f32; 3];

const SUN: Rgb = [0.86, 0.82, 0.75];
const SKY: Rgb = [0.34, 0.38, 0.44];
const GROUND: Rgb = [0.17, 0.16, 0.15];
const HAZE: Rgb = [0.70, 0.75, 0.80];
const ZENITH: Rgb = [0.17, 0.34, 0.68];
/// The light of the sky that is left at night.
const NIGHT: Rgb = [0.010, 0.011, 0.014];

/// The light that surfaces receive.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Light {
    /// The light of the sun on a surface that faces the sun.
    pub sun: Rgb,
    /// The light of the sky on a surface that faces up.
    pub sky: Rgb,
    /// The light from the surroundings on a surface that faces down.
    pub ground: Rgb,
    /// The colour of the sky straight above.
    pub zenith: Rgb,
    /// The brightness of head lamps and street lamps, from 0 to 1.
    pub lamps: f32,
}

impl Atmosphere {
    /// Returns the colour in linear light of the horizon and of dense fog. Fog turns the light `l` of a point at `d`
    /// metres into `l t + colour (1 - t)` with `t = exp(-extinction d)` (Koschmieder). The colour is pale and warm
    /// under a low sun, and goes dark after sunset.
    pub fn colour(&self) -> [f32; 3] {
        dimmed(times(HAZE, Daylight::of(self.sun_elevation).horizon), self.light, 0.5)
    }

    pub(crate) fn lit(&self) -> Light {
        let daylight = Daylight::of(self.sun_elevation);
        // There is no sun below the horizon; it comes up within 3 degrees. Shadows on level ground fade with it: even
        // the full sun at 3 degrees adds only a few hundredths to the light of the sky there.
        let risen = (libm::sinf(self.sun_elevation) * 20.0).clamp(0.0, 1.0) * self.light;
        Light {
            sun: times(SUN, daylight.sun).map(|colour| risen * colour),
            sky: dimmed(times(SKY, daylight.around), self.light, 1.0),
            ground: dimmed(times(GROUND, daylight.around), self.light, 0.4),
            zenith: dimmed(ZENITH.map(|colour| colour * daylight.zenith), self.light, 0.2),
            lamps: (1.0 - self.light * daylight.risen / 0.6).clamp(0.0, 1.0),
        }
    }

    pub(crate) fn check(&self) -> Result<(), ViewError> {
        let numbers = [
            ("a light", self.light, (0.0..=1.0).contains(&self.light), "0 to 1"),
            (
                "an elevation of the sun",
                self.sun_elevation,
                self.sun_elevation.is_finite(),
                "a finite angle in radians",
            ),
            ("an azimuth of the sun", self.sun_azimuth, self.sun_azimuth.is_finite(), "a finite angle in radians"),
            (
                "an extinction",
                self.extinction,
                self.extinction >= 0.0 && self.extinction.is_finite(),
                "a finite number from 0 on",
            ),
        ];
        match numbers.into_iter().find(|(_, _, fine, _)| !fine) {
            Some((what, found, _, expected)) => Err(ViewError::Air { what, found, expected }),
            None => Ok(()),
        }
    }
}

fn times(colour: Rgb, shares: [f32; 3]) -> Rgb {
    std::array::from_fn(|part| colour[part] * shares[part])
}

/// Returns a colour by day multiplied by the brightness of the light, plus the share `night` of [`NIGHT`].
fn dimmed(day: Rgb, light: f32, night: f32) -> Rgb {
    std::array::from_fn(|colour| day[colour] * light + NIGHT[colour] * night)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_sun_of_three_degrees_hardly_lights_level_ground_but_does_light_walls() {
        let level = |degrees: f32| {
            let air = Atmosphere { sun_elevation: degrees.to_radians(), ..Atmosphere::default() };
            let Light { sun, sky, .. } = air.lit();
            (sun[0] * libm::sinf(air.sun_elevation) / sky[0], sun[0] / sky[0])
        };
        let (ground, wall) = level(3.0);
        assert!((0.03..0.1).contains(&ground), "shadows on the ground are {ground} darker");
        assert!(wall > 1.0, "shadows on walls are {wall} darker");
        assert!(level(20.0).0 > 0.5, "{:?}", level(20.0));
        assert_eq!(level(-1.0), (0.0, 0.0));
    }

    #[test]
    fn lamps_come_on_at_dusk_as_in_little_light() {
        let lamps = |degrees: f32, light: f32| {
            Atmosphere { sun_elevation: degrees.to_radians(), light, ..Atmosphere::default() }.lit().lamps
        };
        assert_eq!([lamps(51.6, 1.0), lamps(0.0, 1.0), lamps(0.0, 0.0)], [0.0, 0.0, 1.0]);
        assert!(lamps(-3.0, 1.0) > 0.0 && lamps(-6.0, 1.0) > 0.9);
    }
}
