//! Rain against what is known of drops.

use super::*;

fn camera() -> Camera {
    Camera::new(160, 120, 24.0, 36.0).expect("a sound camera")
}

/// A frame without any light.
fn dark(camera: &Camera) -> Frame {
    let pixels = camera.width() as usize * camera.height() as usize;
    let nothing = Frame {
        camera: camera.clone(),
        rgb: None,
        linear: None,
        depth: None,
        semantic: None,
        instance: None,
        alone: None,
    };
    Frame { linear: Some(vec![0.0; 3 * pixels]), ..nothing }
}

fn rain(rate: f64, velocity: Vector3<f64>) -> Rain {
    Rain { light: [1.0; 3], ..Rain::new(rate, &Atmosphere::default(), &Isometry3::identity(), &velocity) }
}

/// What the rain of many images leaves on a dark one, in pixels as bright as a drop, in the mean.
fn brightness(rate: f64) -> f64 {
    let images = 20;
    let sum = |number| {
        let mut frame = dark(&camera());
        rain(rate, Vector3::zeros()).fall(&mut frame, &mut Chance::of(1, "rain", number));
        frame.linear.iter().flatten().map(|value| f64::from(*value)).sum::<f64>() / 3.0
    };
    (0..images).map(sum).sum::<f64>() / images as f64
}

#[test]
fn without_rain_nothing_changes_and_an_image_without_light_stays_without() {
    let mut frame = dark(&camera());
    let before = frame.clone();
    rain(0.0, Vector3::zeros()).fall(&mut frame, &mut Chance::of(1, "rain", 0));
    assert_eq!(frame, before);
    let mut frame = Frame { linear: None, ..before };
    rain(50.0, Vector3::zeros()).fall(&mut frame, &mut Chance::of(1, "rain", 0));
    assert_eq!(frame.linear, None);
}

#[test]
fn the_more_it_rains_the_more_of_the_image_is_drops_and_by_as_much_as_their_sizes_say() {
    let camera = camera();
    let mut before = 0.0;
    for rate in [2.0, 10.0, 25.0, 50.0] {
        // The squares of the diameters of all drops in a cubic metre, in square metres.
        let fewer = 4.1 * libm::pow(rate, -0.21);
        let step = 0.001;
        let sizes = (0..20_000).map(|i| SMALLEST + step * (f64::from(i) + 0.5));
        let squares: f64 = sizes.map(|size| 8000.0 * libm::exp(-fewer * size) * step * size * size * 1e-6).sum();
        // At any depth z the camera sees z² / focal² square metres for each pixel, and a drop covers pi/4 (size focal /
        // z)².
        let pixels = f64::from(camera.width() * camera.height());
        let expected = FRAC_PI_4 * squares * pixels * (FAR - NEAR);
        let found = brightness(rate);
        assert!(found > before, "{rate} mm/h: {found} after {before}");
        assert!((found / expected - 1.0).abs() < 0.1, "{rate} mm/h: {found} pixels for {expected}");
        before = found;
    }
}

#[test]
fn streaks_are_those_of_the_image_and_of_no_other() {
    let image = |seed, number| {
        let mut frame = dark(&camera());
        rain(20.0, Vector3::zeros()).fall(&mut frame, &mut Chance::of(seed, "rain", number));
        frame
    };
    assert_eq!(image(1, 4), image(1, 4));
    assert_ne!(image(1, 4), image(1, 5));
    assert_ne!(image(1, 4), image(2, 4));
}

#[test]
fn rain_falls_down_the_image_and_towards_who_drives() {
    let camera = camera();
    let streaks = |velocity| rain(50.0, velocity).streaks(&camera, &mut Chance::of(3, "rain", 0));
    let standing = streaks(Vector3::zeros());
    assert!(standing.len() > 100, "{}", standing.len());
    for Streak { from, to, .. } in standing {
        assert!((from.x - to.x).abs() < 1e-9 && to.y > from.y, "{from} to {to}");
    }
    let middle = Point2::new(80.0, 60.0);
    let mut apart = 0;
    for Streak { from, to, .. } in streaks(Vector3::new(30.0, 0.0, 0.0)) {
        // Fast enough, they come out of a point above the middle, and go apart.
        assert!((to.x - middle.x).abs() >= (from.x - middle.x).abs() - 1e-9, "{from} to {to}");
        apart += usize::from((to - middle).norm() > (from - middle).norm());
    }
    assert!(apart > 100, "{apart}");
}

#[test]
fn a_streak_covers_as_much_as_its_drop_wherever_it_runs() {
    let camera = camera();
    for (from, to, diameter) in [
        ((40.0, 40.0), (40.0, 40.0), 9.0),
        ((20.3, 30.1), (60.7, 80.2), 0.4),
        ((20.5, 30.5), (20.5, 30.6), 0.2),
        ((100.0, 20.0), (70.5, 20.0), 3.0),
    ] {
        let streak = Streak { from: Point2::new(from.0, from.1), to: Point2::new(to.0, to.1), diameter };
        let mut sum = 0.0;
        streak.cover(&camera, |_, share| sum += f64::from(share));
        let disc = FRAC_PI_4 * diameter * diameter;
        assert!((sum / disc - 1.0).abs() < 0.05, "{sum} pixels of a disc of {disc}");
    }
    let beside = Streak { from: Point2::new(-50.0, 10.0), to: Point2::new(-20.0, 90.0), diameter: 2.0 };
    beside.cover(&camera, |pixel, _| panic!("pixel {pixel} of an image that it is beside"));
}
