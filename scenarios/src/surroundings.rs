//! What every scenario has around it, closed until a study opens it: light, fog, rain, the sun, and what stands
//! beside the road.

use paracosm_engine::{Environment, Param, Roadside, Scenario, Stream, Weather};
use std::f64::consts::PI;

/// The weather of a scenario that has asked for light, fog and rain from the beginning.
pub(crate) fn weather(s: &mut Scenario) -> Environment {
    asked(s, |parameter| parameter)
}

/// The weather of a scenario that did without at first, so that the noise of its tests is still the same.
pub(crate) fn later_weather(s: &mut Scenario) -> Environment {
    asked(s, Param::incidental)
}

fn asked(s: &mut Scenario, mark: fn(Param<f64>) -> Param<f64>) -> Environment {
    let usual = Weather::default();
    let air = [("fog", usual.fog), ("light", usual.light), ("rain", usual.rain)];
    let [fog, light, rain] = air.map(|(name, nominal)| mark(s.nominal(name, 0.0..=1.0, nominal)));
    let elevation = s.nominal("sun_elevation", 0.0..=90.0, usual.sun_elevation.to_degrees());
    let azimuth = s.nominal("sun_azimuth", -180.0..=180.0, usual.sun_azimuth.to_degrees());
    let [elevation, azimuth] =
        [elevation, azimuth].map(|degrees| Stream::from(degrees.unit("deg").incidental()) * (PI / 180.0));
    Environment::new().light(light).fog(fog).rain(rain).sun(elevation, azimuth)
}

/// What stands beside the road, once all else is placed.
pub(crate) fn roadside(s: &mut Scenario) {
    let fullness = s.nominal("roadside", 0.0..=1.0, 0.0).incidental();
    s.place(Roadside::new(fullness.value()));
}
