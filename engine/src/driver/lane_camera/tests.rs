use super::*;
use crate::driver::find;
use crate::vehicle::Vehicle;

/// An image of a dark road to the left of a bright edge, which is so many metres to the left of straight ahead at a
/// distance; `None` is an image of fog.
fn image(edge: impl Fn(f64) -> Option<f64>) -> Image {
    let [width, height] = RESOLUTION;
    let mut rgb = Vec::new();
    for row in 0..height {
        for column in 0..width {
            // The ray through the middle of the pixel, turned down with the camera, to the ground.
            let (right, down) = (f64::from(column) + 0.5 - 100.0, f64::from(row) + 0.5 - 33.0);
            let (sin, cos) = libm::sincos(PITCH.to_radians());
            let pixels = 200.0 * FOCAL / SENSOR;
            let (forward, fall) = (pixels * cos - down * sin, pixels * sin + down * cos);
            let metres = HEIGHT / fall;
            let bright = fall <= 0.0 || edge(forward * metres).is_none_or(|edge| -right * metres <= edge);
            rgb.extend([if bright { 140 } else { 70 }; 3]);
        }
    }
    Image { camera: 0, number: 0, time: 0.0, width, height, rgb }
}

fn driver(changes: &[(String, f64)]) -> Box<dyn Driver> {
    let mut driver = find("lane-camera").unwrap().build(changes).unwrap();
    driver.reset(&Briefing { cruise_speed: 10.0, vehicle: Vehicle::BMW_320I, navigation: None }).unwrap();
    driver
}

/// What it does at a time at which it was shown this.
fn control(driver: &mut dyn Driver, time: f64, images: &[Image]) -> Control {
    driver.perceive(&Rig::default(), images).unwrap();
    driver.step(&Observation { time, speed: 10.0, ..Observation::default() }).unwrap()
}

#[test]
fn the_lane_is_seen_where_it_is() {
    for (lateral, slope) in [(0.0, 0.0), (0.8, 0.0), (-0.6, 0.0), (0.0, 0.03), (0.3, -0.04)] {
        let mut camera = LaneCamera::new(&DESCRIPTOR.settings(&[]).unwrap());
        camera.look(&image(|distance| Some(lateral + slope * distance - 1.75)));
        for metres in [6.0, 10.0, 15.0] {
            let found = camera.target(metres).unwrap();
            let expected = lateral + slope * (found.x - AHEAD);
            assert!((found.x - metres).abs() < 2.0 && (found.y - expected).abs() < 0.15, "{found} for {expected}");
        }
    }
}

#[test]
fn it_steers_to_its_lane_and_holds_the_wheel_where_no_image_arrives() {
    let mut driver = driver(&[]);
    let left = control(driver.as_mut(), 0.0, &[image(|_| Some(-1.0))]);
    assert!(left.steering > 0.01, "{left:?}");
    assert_eq!(control(driver.as_mut(), 0.05, &[]).steering, left.steering);
    assert!(control(driver.as_mut(), 0.1, &[image(|_| Some(-2.5))]).steering < -0.01);
}

#[test]
fn it_brakes_when_it_has_not_seen_the_road_for_as_long_as_it_is_patient() {
    for patience in [0.5, 2.0] {
        let mut driver = driver(&[("patience".to_owned(), patience)]);
        let mut at = |time: f64| {
            let fog = Image { time, ..image(|_| None) };
            control(driver.as_mut(), time, &[fog]).throttle < 0.0
        };
        assert!(!at(0.0) && !at(patience - 0.05) && at(patience + 0.05));
    }
}

#[test]
fn its_camera_is_as_it_is_set() {
    let changes = [("rate", 20.0), ("latency", 0.3), ("dropped", 0.1), ("blur", 2.0)];
    let camera = driver(&changes.map(|(name, value)| (name.to_owned(), value))).equipment().cameras.all;
    let camera = &camera["front"];
    assert_eq!((camera.rate, camera.latency, camera.dropped, camera.lens.get("blur")), (20.0, 0.3, 0.1, Some(&2.0)));
    assert_eq!(camera.resolution, [200, 66]);
}
