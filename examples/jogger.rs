//! Shows how to write a scenario and run it as a campaign: `cargo run --release --example jogger`.

use paracosm::engine::{AutonomousVehicle, Pedestrian, Program, RoadSegment, Scenario, Side, eventually, never};
use paracosm::{Campaign, Error, Study};

fn jogger(s: &mut Scenario) {
    let speed = s.interval("speed", 1.0..=6.0).unit("m/s");
    let gap = s.interval("gap", 5.0..=40.0).unit("m");
    let friction = s.nominal("friction", 0.2..=0.8, 0.8); // closed: it is 0.8 unless a campaign opens it

    let road = s.place(RoadSegment::new(500.0).lanes(2).friction(friction));
    let car = s.place(AutonomousVehicle::at(road.on_lane(1, 10.0)).speed(13.9));
    let walker = s.place(Pedestrian::at(road.on_sidewalk(Side::Right, 80.0)));

    let near = car.gap_along(&road.crossing(80.0)).below(gap);
    walker.walk(road.on_sidewalk(Side::Left, 80.0), speed).skip_until(&near).take_until(&walker.arrived());

    s.duration(20.0);
    s.premise(&near); // if this never happens and no requirement is violated, the test is inconclusive
    s.require("no-collision", never(car.collides())).unit("m").scale(5.0);
    s.require("progress", eventually(car.travelled().at_least(100.0))).unit("m").scale(50.0);
}

fn main() -> Result<(), Error> {
    let study = Study::of(Program::new("jogger", "a jogger crosses the road", jogger)).budget(100).build()?;
    for failure in Campaign::new(&study)?.into_log()?.trials().iter().filter(|trial| trial.is_failure()) {
        let values: Vec<String> = failure.test.iter().map(|(name, value)| format!("{name} = {value}")).collect();
        println!("{}", values.join(", "));
    }
    Ok(())
}
