//! The paper's first study (sections 2 and 4.2.2, Figure 9): a pedestrian steps onto the road in front of the ego
//! vehicle.
//!
//! The pedestrian waits on the far sidewalk, starts when the car is nearer than `distance`, crosses both lanes at
//! `speed`, and stops on the near sidewalk. With `side` = near the pedestrian walks the other way. As in the paper, the
//! pedestrian has the speed at once. `--open acceleration` varies realistic accelerations: in the protocols of Euro
//! NCAP, an adult reaches 5 km/h within 1 m, with 0.96 m/s², and 8 km/h within 1.5 m, with 1.65 m/s². A running adult of these
//! protocols has 8 km/h, and speeds up to 10 km/h (2.8 m/s) count as plausible; the paper's range ends at 10 m/s. The car comes at
//! 60 km/h. From the far side the driver has time to see the pedestrian. Whether it brakes early enough therefore depends
//! on both parameters, and a slow pedestrian can be as dangerous as a quick one. The run lasts 25 s: enough to stop, wait
//! and go on.
//!
//! Light and fog are the conditions for a camera; a driver without cameras drives as in broad daylight. Rain also makes
//! the road slippery. Features that should not matter, beside the road and on it, can be added with `roadside` and
//! `zebra`.

use crate::surroundings::{roadside, weather};
use paracosm_engine::{AutonomousVehicle, Pedestrian, Program, RoadSegment, Scenario, Side, eventually, never};

pub(crate) const PROGRAM: Program = Program::new(
    "pedestrian-crossing",
    "a pedestrian crosses the road when the ego vehicle is nearer than a distance",
    pedestrian_crossing,
);

fn pedestrian_crossing(s: &mut Scenario) {
    let speed = s.interval("speed", 0.5..=10.0).unit("m/s").default(1.4).plausible(0.5..=2.8);
    let distance = s.interval("distance", 5.0..=60.0).unit("m").default(30.0);
    let friction = s.nominal("friction", 0.2..=0.8, 0.8);
    let approach = s.nominal("approach_speed", 5.0..=30.0, 60.0 / 3.6).unit("m/s");
    let lanes = s.nominal_choice("lanes", [2, 4, 6], 2);
    let weather = weather(s);
    let zebra = s.nominal_choice("zebra", [0, 1], 0).incidental();
    let side = s.nominal_choice("side", ["far", "near"], "far");
    // With 1,000 m/s² every speed is reached within a tick.
    let acceleration = s.nominal("acceleration", 0.5..=1000.0, 1000.0).opens(0.96..=1.65).unit("m/s²");

    s.place(weather);
    let road = RoadSegment::new(800.0).lanes(lanes.value());
    let road = if zebra.value() == 1 { road.zebra(100.0) } else { road };
    let road = s.place(road.friction(friction));
    let car = s.place(AutonomousVehicle::at(road.on_lane(1, 10.0)).speed(approach.value()));
    let (from, to) = if side.value() == "far" { (Side::Left, Side::Right) } else { (Side::Right, Side::Left) };
    let pedestrian = Pedestrian::at(road.on_sidewalk(from, 100.0)).accelerating(acceleration.value());
    let walker = s.place(pedestrian);

    let near = car.gap_along(&road.crossing(100.0)).below(distance);
    walker.walk(road.on_sidewalk(to, 100.0), speed).skip_until(&near).take_until(&walker.arrived());
    roadside(s);

    s.duration(25.0);
    s.premise(&near);
    s.require("no-collision", never(car.collides()))
        .text("The car touches nobody. The robustness is the least clearance in metres, or minus the missing braking distance.")
        .unit("m")
        .scale(5.0);
    s.require("progress", eventually(car.travelled().at_least(100.0)))
        .text("The car drives at least 100 m, so that standing still for ever does not pass.")
        .unit("m")
        .scale(50.0);
}
