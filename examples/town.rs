//! Draws a town around a roundabout, with a route through it: `cargo run --release --example town > town.svg`.

use paracosm::engine::road::{Composite, RoadError, RoadSegment, Roundabout, RoutePosition, TIntersection};
use paracosm::report::birds_eye::RoadPicture;
use std::f64::consts::FRAC_PI_2;

/// Returns a town: four avenues lead from the roundabout to T-intersections, and a street around the town joins these.
fn town() -> Composite {
    const AVENUE: f64 = 60.0;
    const BEND: f64 = 30.0;
    let circus = Roundabout::new().named("circus");
    let tee = TIntersection::new();
    // `away` is the distance from the middle of the town to the middle of a T; `side` is the part left for straight
    // streets.
    let away = circus.reach() + AVENUE + tee.reach();
    let side = away - BEND - tee.reach();

    let mut town = Composite::from(circus);
    let arms = ["one", "two", "three", "four"];
    for (i, arm) in arms.iter().enumerate() {
        let avenue = RoadSegment::new(AVENUE).zebra(12.0).named(format!("avenue {arm}"));
        town = town.connect(&format!("circus.{arm}"), avenue, "one").connect(
            &format!("avenue {arm}.two"),
            tee.clone().named(format!("tee {arm}")),
            "two",
        );
        let street = RoadSegment::new(side)
            .named(format!("street {arm}"))
            .connect("two", RoadSegment::arc(BEND, -FRAC_PI_2).named(format!("bend {arm}")), "one")
            .connect(&format!("bend {arm}.two"), RoadSegment::new(side).named(format!("end {arm}")), "one");
        town = town.connect(&format!("tee {arm}.one"), street, "one");
        if i > 0 {
            town = town.close(&format!("end {}.two", arms[i - 1]), &format!("tee {arm}.three"));
        }
    }
    town.close("end four.two", "tee one.three")
}

fn main() -> Result<(), RoadError> {
    let town = town().build()?;
    let from = RoutePosition { lane: town.lane_of("end two", 1)?, s: 5.0 };
    let to = RoutePosition { lane: town.lane_of("street one", 1)?, s: 20.0 };
    let way = town.route(from, to, 20.0).expect("every street leads everywhere");
    let car = town.on_lane("end two", 1, 5.0)?;
    let other = town.on_lane("avenue four", -1, 25.0)?;
    let picture = RoadPicture::of(&town).route(&way, [0xee, 0x99, 0x33]);
    print!("{}", picture.body(car, 4.5, 1.6, [0xcc, 0x33, 0x11]).body(other, 4.5, 1.6, [0x00, 0x77, 0xbb]).svg());
    Ok(())
}
