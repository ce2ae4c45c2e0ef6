//! Pictures as they are to be. UPDATE_GOLDEN=1 writes them; look at what changed.

mod support;

use nalgebra::{Point3, Translation3, Vector3};
use paracosm_engine::{Weather, sensor::Chance};
use paracosm_render::lens::{Lens, Rain};
use paracosm_render::{Atmosphere, Frame, View, WantedImages};
use support::golden::compare;
use support::{camera, one, renderer, street};

const WIDTH: u32 = 240;
const HEIGHT: u32 = 160;
/// Where the car is.
const PLACE: Translation3<f64> = Translation3::new(0.0, -1.7, 0.0);

fn seen(air: Atmosphere) -> Option<Frame> {
    let mut renderer = renderer()?;
    let mut scene = street();
    scene.air = air;
    let camera = camera(WIDTH, HEIGHT);
    let mut view = View::new(&scene, &camera, PLACE.into());
    view.head_lamps = Some(Point3::new(2.0, 0.0, 0.65));
    let wanted = WantedImages { rgb: true, linear: true, semantic: true, shadows: true, ..support::NOTHING };
    Some(one(&mut renderer, &view, wanted))
}

#[test]
fn a_street_at_noon() {
    let Some(frame) = seen(Atmosphere::default()) else { return };
    compare("noon", WIDTH, frame.rgb.as_deref().expect("asked for"));
    compare("classes", WIDTH, &frame.semantic_colours().expect("asked for"));
}

#[test]
fn a_street_in_fog() {
    let Some(frame) = seen(Atmosphere { light: 0.8, extinction: 3.912 / 60.0, ..Atmosphere::default() }) else {
        return;
    };
    compare("fog", WIDTH, frame.rgb.as_deref().expect("asked for"));
}

#[test]
fn a_street_in_rain_from_a_car_of_10_m_s() {
    let weather = Weather { light: 0.6, rain: 1.0, ..Weather::default() };
    let air = Atmosphere::of(&weather);
    let Some(mut frame) = seen(air) else { return };
    let place = frame.camera.pose(&PLACE.into());
    let rain = Rain::new(weather.rain_rate(), &air, &place, &Vector3::new(10.0, 0.0, 0.0));
    rain.fall(&mut frame, &mut Chance::of(0, "rain", 0));
    let developed = Lens::default().develop(&frame, |effect| Chance::of(0, effect, 0));
    compare("rain", WIDTH, &developed.expect("asked for"));
}

#[test]
fn a_street_with_the_sun_low() {
    let air = Atmosphere { light: 0.5, sun_elevation: 0.15, sun_azimuth: 1.2, ..Atmosphere::default() };
    let Some(frame) = seen(air) else { return };
    compare("low-sun", WIDTH, frame.rgb.as_deref().expect("asked for"));
}

#[test]
fn a_street_at_night() {
    let Some(frame) = seen(Atmosphere { light: 0.0, sun_elevation: -0.5, ..Atmosphere::default() }) else { return };
    compare("night", WIDTH, frame.rgb.as_deref().expect("asked for"));
}
