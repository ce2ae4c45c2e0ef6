//! Draws a hundred cars in a city after two minutes: `cargo run --release --example traffic > traffic.svg`.
//!
//! Blue cars drive, red cars brake or stand, yellow cars change lanes.

use paracosm::engine::road::grid_city;
use paracosm::engine::traffic::{CarState, Traffic, TrafficCar};
use paracosm::report::birds_eye::{Colour, RoadPicture};

const BLUE: Colour = [0x00, 0x77, 0xbb];
const RED: Colour = [0xcc, 0x33, 0x11];
const YELLOW: Colour = [0xee, 0xbb, 0x22];

fn colour(car: &CarState) -> Colour {
    match car.indicator {
        Some(_) => YELLOW,
        None if car.acceleration < -0.5 || car.speed < 0.5 => RED,
        None => BLUE,
    }
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let city = grid_city(4, 4, 80.0, 4).build()?;
    let cars = TrafficCar::scattered(&city, 100, 1).into_iter().map(TrafficCar::changing_lanes).collect();
    let mut traffic = Traffic::new(city.clone(), cars, 1)?;
    for _ in 0..6000 {
        traffic.step(0.02, &[]);
    }
    let picture = RoadPicture::of(&city);
    let picture =
        traffic.cars().fold(picture, |picture, car| picture.body(car.pose, car.length, car.width, colour(&car)));
    print!("{}", picture.svg());
    Ok(())
}
