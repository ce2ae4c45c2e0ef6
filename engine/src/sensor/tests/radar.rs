use super::*;
use crate::sensor::{Chance, Detection, Mount, Radar, RadarSettings, Sensor};

/// Without noise and clutter, and sure of all that it may see.
fn exact() -> RadarSettings {
    RadarSettings {
        mount: Mount::ahead(2.0, 0.5),
        half_range: 10_000.0,
        range_noise: 0.0,
        range_rate_noise: 0.0,
        azimuth_noise: 0.0,
        clutter: 0.0,
        ..RadarSettings::default()
    }
}

fn sweep(settings: RadarSettings, world: &World, number: u64) -> Vec<Detection> {
    let mut sweep = Vec::new();
    Radar::new(settings).unwrap().sense(&world.view(0.0), &mut Chance::of(5, "radar", number), &mut sweep);
    sweep
}

#[test]
fn a_car_ahead_is_measured_at_its_rear() {
    let mut world =
        World::of(pose(100.0, 50.0, 0.0)).with(Body::car(), pose(132.25, 50.0, 0.0), Vector2::new(12.0, 0.0));
    world.car.velocity.x = 20.0;
    let sweep = sweep(exact(), &world, 0);
    assert_eq!(sweep.len(), 1);
    let Detection { range, range_rate, azimuth, body } = sweep[0];
    assert!((range - 28.0).abs() < 1e-9 && (range_rate + 8.0).abs() < 1e-9 && azimuth.abs() < 1e-9);
    assert_eq!(body, Some(1));
}

#[test]
fn only_what_is_in_the_field_and_not_hidden_is_detected() {
    let ahead = |x| (Body::adult(), pose(x, 0.0, 0.0));
    let seen = |around: &[(Body, Pose)]| {
        let world = around
            .iter()
            .fold(World::of(pose(0.0, 0.0, 0.0)), |world, (body, at)| world.with(*body, *at, Vector2::zeros()));
        sweep(exact(), &world, 0).iter().map(|detection| detection.body.unwrap()).collect::<Vec<_>>()
    };
    assert_eq!(seen(&[ahead(50.0)]), [1]);
    assert!(seen(&[ahead(-50.0)]).is_empty(), "behind the car");
    assert!(seen(&[ahead(250.0)]).is_empty(), "out of range");
    assert!(seen(&[(Body::adult(), pose(22.0, 13.0, 0.0))]).is_empty(), "more than 30 degrees to the left");
    assert_eq!(seen(&[(Body::adult(), pose(22.0, 10.0, 0.0))]), [1]);
    assert_eq!(seen(&[ahead(50.0), (Body::car(), pose(30.0, 0.0, 0.0))]), [2], "behind a car");
    assert_eq!(seen(&[ahead(50.0), ahead(30.0)]), [1, 2], "people hide nobody");
}

proptest! {
    #[test]
    fn the_range_rate_is_how_the_range_changes(
        car in poses(100.0), speed in -5.0..30.0, yaw_rate in -0.5..0.5,
        (x, y) in (10.0..80.0, -4.0..4.0), velocity in (-20.0..20.0, -20.0..20.0), radius in 0.1..2.0,
        (ahead, left, heading) in (-2.0..2.0, -1.0..1.0, -0.2..0.2),
    ) {
        let position = nalgebra::Vector3::new(ahead, left, 0.5);
        let settings = RadarSettings { mount: Mount { position, heading }, field_of_view: std::f64::consts::TAU, ..exact() };
        let velocity = Vector2::new(velocity.0, velocity.1);
        let at: Vector2<f64> = car.position + car.forward() * x + car.left() * y;
        // Half a microsecond earlier and later.
        let moment = |dt: f64| {
            let moved = pose(car.position.x, car.position.y, car.heading + yaw_rate * dt);
            let moved = Pose { position: moved.position + car.forward() * (speed * dt), ..moved };
            let target: Vector2<f64> = at + velocity * dt;
            let mut world = World::of(moved).with(Body::disc(Class::Car, radius, 1.0), pose(target.x, target.y, 0.0), velocity);
            (world.car.velocity, world.car.yaw_rate) = (Vector2::new(speed, 0.0), yaw_rate);
            sweep(settings, &world, 0)[0]
        };
        let (before, now, after) = (moment(-5e-7), moment(0.0), moment(5e-7));
        let rate = (after.range - before.range) / 1e-6;
        prop_assert!((now.range_rate - rate).abs() < 1e-5, "{} but {}", now.range_rate, rate);
        let place = pose(car.position.x, car.position.y, car.heading);
        let sensor = place.position + place.forward() * ahead + place.left() * left;
        let direction = place.heading + heading + now.azimuth;
        let found: Vector2<f64> = sensor + Pose { position: sensor, heading: direction }.forward() * (now.range + radius);
        let off: Vector2<f64> = found - at;
        prop_assert!(off.norm() < 1e-9, "{:?} but {:?}", found, at);
    }
}

#[test]
fn noise_and_misses_are_as_the_settings_say() {
    let settings =
        RadarSettings { half_range: 100.0, range_noise: 0.3, range_rate_noise: 0.2, azimuth_noise: 0.01, ..exact() };
    let world = World::of(pose(0.0, 0.0, 0.0)).with(Body::car(), pose(104.25, 0.0, 0.0), Vector2::zeros());
    let sweeps: Vec<Vec<Detection>> = (0..20_000).map(|number| sweep(settings, &world, number)).collect();
    let detected: Vec<f64> = sweeps.iter().map(|sweep| sweep.len() as f64).collect();
    check_mean("detected at the half range", &detected, 0.5, 0.5);
    let of = |part: fn(&Detection) -> f64| sweeps.iter().flatten().map(part).collect::<Vec<f64>>();
    check_normal("range", &of(|detection| detection.range), 100.0, 0.3);
    check_normal("range rate", &of(|detection| detection.range_rate), 0.0, 0.2);
    check_normal("azimuth", &of(|detection| detection.azimuth), 0.0, 0.01);
}

#[test]
fn what_is_far_or_small_is_detected_more_seldom() {
    let radar = Radar::new(RadarSettings::default()).unwrap();
    let at = |class, range| radar.probability(class, range);
    assert!((at(Class::Car, 160.0) - 0.5).abs() < 1e-12);
    assert!(at(Class::Car, 20.0) > 0.999 && at(Class::Car, 1000.0) < 1e-4);
    assert!(at(Class::Truck, 100.0) > at(Class::Car, 100.0) && at(Class::Car, 100.0) > at(Class::Pedestrian, 100.0));
    // A twentieth of the cross-section answers alike from the fourth root of a twentieth of the distance.
    let nearer = 160.0 * (0.05_f64).sqrt().sqrt();
    assert!((at(Class::Pedestrian, nearer) - 0.5).abs() < 1e-12);
}

#[test]
fn clutter_is_everywhere_and_as_much_as_the_settings_say() {
    let settings = RadarSettings { clutter: 2.5, ..exact() };
    let world = World::of(pose(0.0, 0.0, 0.0));
    let sweeps: Vec<Vec<Detection>> = (0..10_000).map(|number| sweep(settings, &world, number)).collect();
    let counts: Vec<f64> = sweeps.iter().map(|sweep| sweep.len() as f64).collect();
    check_mean("clutter", &counts, 2.5, 2.5_f64.sqrt());
    let of = |part: fn(&Detection) -> f64| sweeps.iter().flatten().map(part).collect::<Vec<f64>>();
    let evenly = |width: f64| width / 12_f64.sqrt();
    check_mean("range", &of(|detection| detection.range), 100.0, evenly(200.0));
    check_mean("azimuth", &of(|detection| detection.azimuth), 0.0, evenly(settings.field_of_view));
    check_mean("range rate", &of(|detection| detection.range_rate), 0.0, evenly(60.0));
    assert!(sweeps.iter().flatten().all(|detection| detection.body.is_none()));
}

#[test]
fn what_is_out_of_sight_does_not_shift_the_noise_of_what_is_seen() {
    let settings = RadarSettings::default();
    let with = |y: f64| {
        let world = World::of(pose(0.0, 0.0, 0.0)).with(Body::adult(), pose(30.0, y, 0.0), Vector2::zeros());
        let world = world.with(Body::car(), pose(50.0, 0.0, 0.0), Vector2::zeros());
        sweep(settings, &world, 9).into_iter().find(|detection| detection.body == Some(2))
    };
    assert!(with(5.0).is_some());
    assert_eq!(with(5.0), with(500.0));
}

#[test]
fn a_radar_that_cannot_be_says_why() {
    let usual = RadarSettings::default();
    let message = |settings| refusal(Radar::new(settings));
    assert_eq!(message(RadarSettings { clutter: -1.0, ..usual }), "radar: `clutter` is -1, expected 0 to 10000");
    assert_eq!(message(RadarSettings { period: 0.0, ..usual }), "radar: `period` is 0 s, expected 0.0001 to 10000 s");
    assert_eq!(message(RadarSettings { range: f64::NAN, ..usual }), "radar: `range` is NaN m, expected 0.1 to 10000 m");
}
