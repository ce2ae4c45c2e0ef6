//! Pictures as they are to be. UPDATE_GOLDEN=1 writes them; look at what changed.

mod support;

use nalgebra::{Point3, Translation3, Vector3};
use paracosm_engine::{Weather, sensor::Chance};
use paracosm_render::lens::{Effects, Rain};
use paracosm_render::{Air, Frame, Outputs, View};
use std::fs::File;
use std::io::BufReader;
use std::path::PathBuf;
use support::{camera, one, renderer, street};

const WIDTH: u32 = 240;
const HEIGHT: u32 = 160;
/// Where the car is.
const PLACE: Translation3<f64> = Translation3::new(0.0, -1.7, 0.0);

fn path(name: &str) -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("tests/golden").join(format!("{name}.png"))
}

fn write(name: &str, rgb: &[u8]) {
    let file = File::create(path(name)).expect("it can be written");
    let mut encoder = png::Encoder::new(file, WIDTH, HEIGHT);
    encoder.set_color(png::ColorType::Rgb);
    encoder.set_compression(png::Compression::High);
    let mut writer = encoder.write_header().expect("it can be written");
    writer.write_image_data(rgb).expect("it can be written");
}

fn read(name: &str) -> Vec<u8> {
    let file = File::open(path(name)).unwrap_or_else(|error| panic!("{name}: {error}; UPDATE_GOLDEN=1 writes it"));
    let mut reader = png::Decoder::new(BufReader::new(file)).read_info().expect("a PNG");
    let mut rgb = vec![0; reader.output_buffer_size().expect("a small one")];
    reader.next_frame(&mut rgb).expect("a PNG");
    rgb
}

/// Holds an image against the one of this name: at most 1/255 between them on average, as on another adapter.
fn compare(name: &str, rgb: &[u8]) {
    if std::env::var_os("UPDATE_GOLDEN").is_some() {
        write(name, rgb);
    }
    let golden = read(name);
    assert_eq!(rgb.len(), golden.len(), "{name}");
    let apart: u64 = rgb.iter().zip(&golden).map(|(found, expected)| u64::from(found.abs_diff(*expected))).sum();
    let mean = apart as f64 / rgb.len() as f64;
    eprintln!("{name}: {mean:.4} / 255 on average");
    assert!(mean < 1.0, "{name} is {mean} / 255 off on average");
}

fn seen(air: Air) -> Option<Frame> {
    let mut renderer = renderer()?;
    let mut scene = street();
    scene.air = air;
    let camera = camera(WIDTH, HEIGHT);
    let mut view = View::new(&scene, &camera, PLACE.into());
    view.head_lamps = Some(Point3::new(2.0, 0.0, 0.65));
    let wanted = Outputs { rgb: true, linear: true, semantic: true, shadows: true, ..support::NOTHING };
    Some(one(&mut renderer, &view, wanted))
}

#[test]
fn a_street_at_noon() {
    let Some(frame) = seen(Air::default()) else { return };
    compare("noon", frame.rgb.as_deref().expect("asked for"));
    compare("classes", &frame.semantic_colours().expect("asked for"));
}

#[test]
fn a_street_in_fog() {
    let Some(frame) = seen(Air { light: 0.8, extinction: 3.912 / 60.0, ..Air::default() }) else { return };
    compare("fog", frame.rgb.as_deref().expect("asked for"));
}

#[test]
fn a_street_in_rain_from_a_car_of_10_m_s() {
    let weather = Weather { light: 0.6, rain: 1.0, ..Weather::default() };
    let air = Air::of(&weather);
    let Some(mut frame) = seen(air) else { return };
    let place = frame.camera.pose(&PLACE.into());
    let rain = Rain::new(weather.rain_rate(), &air, &place, &Vector3::new(10.0, 0.0, 0.0));
    rain.fall(&mut frame, &mut Chance::of(0, "rain", 0));
    let developed = Effects::default().develop(&frame, &mut Chance::of(0, "noise", 0));
    compare("rain", &developed.expect("asked for"));
}

#[test]
fn a_street_with_the_sun_low() {
    let air = Air { light: 0.5, sun_elevation: 0.15, sun_azimuth: 1.2, ..Air::default() };
    let Some(frame) = seen(air) else { return };
    compare("low-sun", frame.rgb.as_deref().expect("asked for"));
}

#[test]
fn a_street_at_night() {
    let Some(frame) = seen(Air { light: 0.0, sun_elevation: -0.5, ..Air::default() }) else { return };
    compare("night", frame.rgb.as_deref().expect("asked for"));
}
