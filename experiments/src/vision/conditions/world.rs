//! The world of the study: the car follows another car, and everything that may hide the other car is a parameter.

use paracosm::engine::object::{Body, Colour};
use paracosm::engine::vehicle::Vehicle;
use paracosm::engine::{
    AutonomousVehicle, Environment, Monitor, Mover, Program, RoadSegment, Scenario, Stream, Weather,
};
use std::f64::consts::PI;

/// The world as a program.
pub const PROGRAM: Program = Program::new("behind-a-car", "the car follows another car in traffic", behind);

/// The length of a test in seconds.
const DURATION: f64 = 2.0;
/// The speed of both cars, in m/s.
const SPEED: f64 = 14.0;
/// The place where the car starts, in metres along its lane.
const START: f64 = 50.0;
/// The length of the road in metres.
const LENGTH: f64 = 400.0;
/// The colours of the car ahead. White, black and grey are the most usual ones.
pub const COLOURS: [&str; 5] = ["white", "grey", "black", "red", "blue"];
const PAINTS: [Colour; 5] = [[235, 236, 238], [120, 123, 127], [20, 21, 23], [160, 24, 28], [28, 58, 120]];
/// The numbers of further cars.
pub const TRAFFIC: [f64; 3] = [0.0, 3.0, 8.0];

fn behind(s: &mut Scenario) {
    let gap = s.nominal("gap", 8.0..=35.0, 20.0).unit("m");
    let colour = s.nominal_choice("colour", COLOURS, COLOURS[0]);
    let traffic = s.nominal_choice("traffic", TRAFFIC, TRAFFIC[0]);
    let usual = Weather::default();
    let [light, fog, rain] = [("light", usual.light), ("fog", usual.fog), ("rain", usual.rain)]
        .map(|(name, nominal)| s.nominal(name, 0.0..=1.0, nominal).atmospheric());
    let elevation = s.nominal("sun_elevation", 0.0..=90.0, 50.0).unit("deg").atmospheric();

    // The sun is behind the car and to its left, so it shines on the back of the other car.
    let sun = Stream::from(elevation) * (PI / 180.0);
    s.place(Environment::new().light(light).fog(fog).rain(rain).sun(sun, usual.sun_azimuth));
    let road = s.place(RoadSegment::new(LENGTH).lanes(6));
    let car = s.place(AutonomousVehicle::along(road.path(2)).starting(START).speed(SPEED));
    let paint = COLOURS.into_iter().zip(PAINTS).find(|(name, _)| *name == colour.value());
    let painted = paint.map_or(Body::car(), |(_, paint)| Body::car().coloured(paint));
    let ahead = START + 0.5 * Vehicle::BMW_320I.length + gap.value() + painted.outline.half_extent().x;
    s.place(Mover::new("ahead", painted, road.path(2)).starting(ahead).speed(SPEED));
    for place in 0..traffic.value() as i32 {
        // Two lanes go the same way, a little faster and a little slower, and two come towards the car.
        let (lane, at, speed) = match place % 4 {
            0 => (1, 22.0, SPEED + 1.5),
            1 => (3, 30.0, SPEED - 1.5),
            2 => (-1, 60.0, SPEED),
            _ => (-2, 75.0, SPEED - 2.0),
        };
        let along = at + 16.0 * f64::from(place / 4);
        let start = if lane > 0 { START + along } else { LENGTH - START - along - 30.0 * f64::from(place / 4) };
        s.place(Mover::car(road.path(lane)).starting(start).speed(speed));
    }

    s.duration(DURATION);
    s.monitor(Monitor::no_collision(&car));
}
