use super::*;
use crate::sensor::{Chance, Fix, Gnss, GnssSettings, Imu, ImuSettings, Inaccuracy, Inertia, Mount, Sensor};

const INACCURACY: Inaccuracy = Inaccuracy { noise: 0.5, bias: 2.0, walk: 0.3 };

/// The readings of a sensor at these times, with this seed.
fn readings<S: Sensor>(sensor: &mut S, world: &World, times: &[f64], seed: u64) -> Vec<S::Reading> {
    sensor.reset();
    let reading = |(number, time): (usize, &f64)| {
        let mut reading = S::Reading::default();
        sensor.sense(&world.view(*time), &mut Chance::of(seed, "sensor", number as u64), &mut reading);
        reading
    };
    times.iter().enumerate().map(reading).collect()
}

fn moving() -> World {
    let mut world = World::of(pose(30.0, -7.0, 0.5));
    (world.car.velocity, world.car.yaw_rate) = (Vector2::new(10.0, 0.5), 0.2);
    world.car.acceleration = Vector2::new(-3.0, 1.0);
    world
}

#[test]
fn without_errors_position_and_motion_are_the_true_ones() {
    let (world, settings) = (moving(), GnssSettings::default());
    let mount = Mount::ahead(1.0, 1.5);
    let settings = GnssSettings { mount, position: Inaccuracy::NONE, velocity_noise: 0.0, ..settings };
    let fixes = readings(&mut Gnss::new(settings).unwrap(), &world, &[0.0, 0.1], 1);
    let (sin, cos) = libm::sincos(0.5);
    for fix in fixes {
        let Fix { position, velocity } = fix.unwrap();
        assert!((position - Vector2::new(30.0 + cos, -7.0 + sin)).norm() < 1e-12);
        // The antenna is a metre ahead, and the car turns to the left.
        let ahead = Vector2::new(cos, sin) * 10.0 + Vector2::new(-sin, cos) * (0.5 + 0.2);
        assert!((velocity - ahead).norm() < 1e-12);
    }
    let settings = ImuSettings { acceleration: Inaccuracy::NONE, yaw_rate: Inaccuracy::NONE, ..ImuSettings::default() };
    let felt = readings(&mut Imu::new(settings).unwrap(), &world, &[0.0], 1);
    assert_eq!(felt, [Inertia { acceleration: Vector2::new(-3.0, 1.0), yaw_rate: 0.2 }]);
}

/// Holds what many seeds say of one coordinate at 0 s, 4 s and 4 s later against the model of its error.
fn check_errors(what: &str, errors: &[[f64; 3]], Inaccuracy { noise, bias, walk }: Inaccuracy) {
    let of = |part: fn(&[f64; 3]) -> f64| errors.iter().map(part).collect::<Vec<f64>>();
    let square = |x: f64| x * x;
    check_normal(&format!("{what} at first"), &of(|e| e[0]), 0.0, (square(bias) + square(noise)).sqrt());
    let change = (4.0 * square(walk) + 2.0 * square(noise)).sqrt();
    check_normal(&format!("{what}, first change"), &of(|e| e[1] - e[0]), 0.0, change);
    check_normal(&format!("{what}, second change"), &of(|e| e[2] - e[1]), 0.0, change);
}

#[test]
fn a_receiver_is_off_by_noise_and_by_a_bias_that_walks() {
    let world = moving();
    let truth = GnssSettings::default().mount.pose(&world.car).position;
    let settings = GnssSettings { position: INACCURACY, velocity_noise: 0.4, ..GnssSettings::default() };
    let mut gnss = Gnss::new(settings).unwrap();
    let runs: Vec<_> = (0..5000).map(|seed| readings(&mut gnss, &world, &[0.0, 4.0, 8.0], seed)).collect();
    for axis in 0..2 {
        let errors = |run: &Vec<Option<Fix>>| [0, 1, 2].map(|i| (run[i].unwrap().position - truth)[axis]);
        check_errors("position", &runs.iter().map(errors).collect::<Vec<_>>(), INACCURACY);
        let mean = settings.mount.velocity(&world.car)[axis];
        let velocities: Vec<f64> = runs.iter().flatten().map(|fix| fix.unwrap().velocity[axis]).collect();
        check_normal("velocity", &velocities, mean, 0.4);
    }
}

#[test]
fn an_inertial_unit_is_off_by_noise_and_by_a_bias_that_walks() {
    let world = moving();
    let small = Inaccuracy { noise: 0.01, bias: 0.03, walk: 0.002 };
    let settings = ImuSettings { acceleration: INACCURACY, yaw_rate: small, ..ImuSettings::default() };
    let mut imu = Imu::new(settings).unwrap();
    let runs: Vec<_> = (0..5000).map(|seed| readings(&mut imu, &world, &[0.0, 4.0, 8.0], seed)).collect();
    for axis in 0..2 {
        let errors = |run: &Vec<Inertia>| [0, 1, 2].map(|i| (run[i].acceleration - world.car.acceleration)[axis]);
        check_errors("acceleration", &runs.iter().map(errors).collect::<Vec<_>>(), INACCURACY);
    }
    let errors = |run: &Vec<Inertia>| [0, 1, 2].map(|i| run[i].yaw_rate - 0.2);
    check_errors("yaw rate", &runs.iter().map(errors).collect::<Vec<_>>(), small);
}

#[test]
fn a_receiver_is_without_satellites_as_often_and_as_long_as_it_says() {
    let settings = GnssSettings { outages: 0.2, outage_duration: 3.0, ..GnssSettings::default() };
    let times: Vec<f64> = (0..200_000).map(|k| k as f64 * 0.1).collect();
    let fixes = readings(&mut Gnss::new(settings).unwrap(), &moving(), &times, 2);
    // An outage begins after 5 s in the mean, both lengths exponential but for the steps of 0.1 s; half of a step is
    // added to either on average. A share of n cycles of two exponential lengths spreads by p (1 - p) sqrt(2 / n).
    let share = fixes.iter().filter(|fix| fix.is_none()).count() as f64 / fixes.len() as f64;
    let expected = 3.05 / (5.05 + 3.05);
    let cycles = 20_000.0 / 8.1;
    let most = 5.0 * expected * (1.0 - expected) * (2.0_f64 / cycles).sqrt();
    assert!((share - expected).abs() < most, "{share}, expected {expected} within {most}");

    let (gaps, whole) = (fixes, readings(&mut Gnss::new(GnssSettings::default()).unwrap(), &moving(), &times, 2));
    let same = gaps.iter().zip(&whole).all(|(gap, whole)| whole.is_some() && (gap.is_none() || gap == whole));
    assert!(same, "outages move no noise, and without them there is always a fix");
}

#[test]
fn what_cannot_be_says_why() {
    let off = Inaccuracy { walk: -1.0, ..Inaccuracy::NONE };
    let gnss = refusal(Gnss::new(GnssSettings { position: off, ..GnssSettings::default() }));
    assert_eq!(gnss, "gnss: `position.walk` is -1 m, expected 0 to 1000 m");
    let imu =
        refusal(Imu::new(ImuSettings { yaw_rate: Inaccuracy { noise: f64::NAN, ..off }, ..ImuSettings::default() }));
    assert_eq!(imu, "imu: `yaw_rate.noise` is NaN rad/s, expected 0 to 1000 rad/s");
}
