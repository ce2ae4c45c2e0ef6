//! Adds to every scenario the parameters of its surroundings, closed until a study opens them: light, fog, rain, the
//! sun, and the objects beside the road.

use paracosm_engine::{Environment, Param, Roadside, Scenario, Stream, Weather};
use std::f64::consts::PI;

/// Returns the weather of a scenario that had light, fog and rain from the beginning.
pub(crate) fn weather(s: &mut Scenario) -> Environment {
    asked(s, Param::atmospheric)
}

/// Returns the weather of a scenario to which light, fog and rain were added later; its parameters leave the noise of
/// its tests unchanged.
pub(crate) fn later_weather(s: &mut Scenario) -> Environment {
    asked(s, |parameter| parameter.atmospheric().incidental())
}

fn asked(s: &mut Scenario, mark: fn(Param<f64>) -> Param<f64>) -> Environment {
    let usual = Weather::default();
    let air = [("fog", usual.fog), ("light", usual.light), ("rain", usual.rain)];
    let [fog, light, rain] = air.map(|(name, nominal)| mark(s.nominal(name, 0.0..=1.0, nominal)));
    let elevation = s.nominal("sun_elevation", 0.0..=90.0, usual.sun_elevation.to_degrees());
    let azimuth = s.nominal("sun_azimuth", -180.0..=180.0, usual.sun_azimuth.to_degrees());
    let [elevation, azimuth] =
        [elevation, azimuth].map(|degrees| Stream::from(degrees.unit("deg").atmospheric().incidental()) * (PI / 180.0));
    Environment::new().light(light).fog(fog).rain(rain).sun(elevation, azimuth)
}

/// Places objects beside the road. Call it after everything else is placed.
pub(crate) fn roadside(s: &mut Scenario) {
    let fullness = s.nominal("roadside", 0.0..=1.0, 0.0).incidental();
    s.place(Roadside::new(fullness.value()));
}
