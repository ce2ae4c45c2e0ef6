//! Computes the effect of the sun's height on daylight: low light is faint and warm, and after sunset the air goes dark
//! from above.
//!
//! The lower the sun, the more air its rays pass, and air scatters blue light out of them first. All results are
//! relative to the sun at [`USUAL`], for which they are 1 by construction.

/// The elevation for which colours are given, in radians: that of [`Atmosphere::default`](crate::Atmosphere::default).
const USUAL: f32 = 0.9;
/// The vertical optical depth of clear air for red, green and blue light, of 0.610, 0.550 and 0.465 micrometres:
/// 0.008735 wavelength^-4.08 (Leckner, The spectral distribution of solar radiation at the earth's surface, Solar
/// Energy 20, 1978).
const DEPTHS: [f64; 3] = [0.06564, 0.10014, 0.19862];
/// The radius of the earth (6371 km) divided by the height by which air thins to 1/e (8 km).
const EARTH: f64 = 6371.0 / 8.0;

/// The daylight of a clear sky, as shares of the daylight at the default elevation of the sun.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Daylight {
    /// The red, green and blue of the sun's rays, as shares of the light at the default elevation of the sun.
    pub sun: [f32; 3],
    /// The red, green and blue of the air at the horizon, as shares of the light at the default elevation of the sun.
    pub horizon: [f32; 3],
    /// The light of the sky straight above, as a share of the light at the default elevation of the sun. It dims and
    /// keeps its hue, because ozone absorbs the light that would make it grey (Hulburt 1953).
    pub zenith: f32,
    /// The red, green and blue of the light from all sides, as shares of the light at the default elevation of the sun.
    pub around: [f32; 3],
    /// The share of the air overhead that is not in the shadow of the earth, from 0 to 1. It is 1 until sunset.
    pub risen: f32,
}

impl Daylight {
    /// Returns the daylight of a clear sky when the sun is `elevation` radians above the horizon.
    pub fn of(elevation: f32) -> Self {
        let (air, usual) = (air_mass(elevation), air_mass(USUAL));
        let below = f64::from(-elevation).max(0.0);
        // If the sun is d below the horizon, it lights the air above the height R d^2 / 2; in the direction of the sun,
        // the air above R d^2 / 8.
        let lit = |part: f64| libm::exp(-EARTH * part * below * below);
        let (above, aside) = (lit(0.5), lit(0.125));
        let scattered = DEPTHS.map(|depth| column(depth * air) / column(depth * usual));
        let zenith = scattered[1] * above;
        let horizon = scattered.map(|share| share * aside);
        Self {
            sun: DEPTHS.map(|depth| libm::exp(-depth * (air - usual)) as f32),
            horizon: horizon.map(|share| share as f32),
            zenith: zenith as f32,
            around: horizon.map(|share| (0.5 * (share + zenith)) as f32),
            risen: above as f32,
        }
    }
}

/// Returns the air mass that the sun's rays pass, as a multiple of the air mass from the zenith (Kasten and Young,
/// Revised optical air mass tables and approximation formula, Applied Optics 28, 1989). The formula ends at the
/// horizon; below it, the value at the horizon is used.
fn air_mass(elevation: f32) -> f64 {
    let up = f64::from(elevation).max(0.0);
    1.0 / (libm::sin(up) + 0.50572 * libm::pow(up.to_degrees() + 6.07995, -1.6364))
}

/// Returns the mean share of the light rays that are left between the optical depths 0 and `depth`. It is the mean of
/// exp(-x) for x from 0 to `depth`.
fn column(depth: f64) -> f64 {
    -libm::expm1(-depth) / depth
}

#[cfg(test)]
mod tests {
    use super::*;

    const NOTHING_CHANGES: Daylight =
        Daylight { sun: [1.0; 3], horizon: [1.0; 3], zenith: 1.0, around: [1.0; 3], risen: 1.0 };

    #[test]
    fn under_the_usual_sun_nothing_changes_in_the_last_bit() {
        assert_eq!(Daylight::of(USUAL), NOTHING_CHANGES);
        assert_eq!(Daylight::of(crate::Atmosphere::default().sun_elevation), NOTHING_CHANGES);
        // What scenarios say in degrees.
        let weather = paracosm_engine::Weather::default().sun_elevation;
        assert_eq!(Daylight::of((weather.to_degrees() * (std::f64::consts::PI / 180.0)) as f32), NOTHING_CHANGES);
    }

    #[test]
    fn the_air_mass_is_that_of_the_tables_of_kasten_and_young() {
        for (degrees, mass) in [(90.0_f32, 1.0), (30.0, 1.9943), (10.0, 5.5841), (5.0, 10.3164), (0.0, 38.0868)] {
            let found = air_mass(degrees.to_radians());
            assert!((found / mass - 1.0).abs() < 5e-3, "{found} at {degrees} degrees, not {mass}");
        }
    }

    #[test]
    fn a_column_passes_the_mean_of_what_its_layers_pass() {
        for depth in [0.05, 0.4, 7.5] {
            let layers = (0..10_000).map(|i| libm::exp(-depth * (f64::from(i) + 0.5) / 10_000.0));
            assert!((column(depth) - layers.sum::<f64>() / 10_000.0).abs() < 1e-6, "{depth}");
        }
    }

    #[test]
    fn the_lower_the_sun_the_dimmer_and_warmer_is_the_light() {
        let all: Vec<Daylight> = (-180..=900).map(|i| Daylight::of((i as f32 * 0.1).to_radians())).collect();
        for pair in all.windows(2) {
            let [low, high] = pair else { unreachable!() };
            for colour in 0..3 {
                assert!(low.sun[colour] <= high.sun[colour] && low.horizon[colour] <= high.horizon[colour]);
                assert!(low.around[colour] <= high.around[colour]);
            }
            assert!(low.zenith <= high.zenith && low.risen <= high.risen);
            let blue = |part: [f32; 3]| part[2] / part[0];
            assert!(blue(low.sun) <= blue(high.sun) + 1e-6);
            assert!(blue(low.horizon) <= blue(high.horizon) + 1e-6);
        }
    }

    #[test]
    fn dusk_lasts_at_the_horizon_and_ends_with_the_night() {
        // About a hundredth of the light is left at the end of civil twilight, 6 degrees below.
        let civil = Daylight::of((-6.0_f32).to_radians());
        assert!((0.005..0.02).contains(&civil.risen), "{civil:?}");
        assert!(civil.horizon[1] > 5.0 * civil.zenith, "{civil:?}");
        // The earth's shadow begins without an edge.
        let (set, up) = (Daylight::of(-1e-4), Daylight::of(0.0));
        assert!((set.zenith - up.zenith).abs() < 1e-4, "{set:?} {up:?}");
        let night = Daylight::of((-25.0_f32).to_radians());
        assert!(night.horizon.iter().all(|share| *share < 1e-6), "{night:?}");
    }
}
