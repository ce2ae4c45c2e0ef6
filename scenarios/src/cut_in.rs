//! The cut-in of UN Regulation No. 157: a slower vehicle changes into the lane of the ego vehicle, directly in front of it.
//!
//! The ranges are those of the public variations of the regulation's scenarios (OSC-ALKS-scenarios, 4.4_1). The lane
//! change begins at once; `gap` is the distance from bumper to bumper at that moment. From then on, the other vehicle
//! changes its speed at the rate `acceleration` until it stands or drives at 80 km/h. A test is invalid if the other
//! vehicle would drive backwards, or would move to the side faster than it drives.

use crate::surroundings::{later_weather, roadside};
use crate::{LANE, checked_lateral, kind, middles_to};
use paracosm_engine::object::Body;
use paracosm_engine::{AutonomousVehicle, Monitor, Mover, Program, RoadSegment, Scenario, Stream};

pub(crate) const PROGRAM: Program = Program::new(
    "cut-in",
    "a slower vehicle changes into the ego vehicle's lane, right in front of it (UN R157)",
    cut_in,
);

/// The greatest speed of the other vehicle in m/s, if it accelerates.
const FASTEST: f64 = 80.0 / 3.6;

fn cut_in(s: &mut Scenario) {
    let speed = s.interval("ego_speed", 20.0..=60.0).unit("km/h").default(50.0);
    let relative = s.interval("relative_speed", -50.0..=-10.0).unit("km/h").default(-20.0);
    let gap = s.interval("gap", 0.0..=60.0).unit("m").default(20.0);
    let lateral = s.interval("lateral_speed", 0.5..=3.0).unit("m/s").default(1.0);
    let acceleration = s.nominal("acceleration", -3.0..=3.0, 0.0).unit("m/s²").incidental();
    let side = s.nominal_choice("side", ["left", "right"], "left").incidental();
    let vehicle = s.nominal_choice("vehicle", ["car", "van", "truck", "bus", "motorcycle"], "car").incidental();
    let friction = s.nominal("friction", 0.2..=0.8, 0.8);
    let weather = later_weather(s);

    s.place(weather.friction(friction));
    let road = s.place(RoadSegment::new(800.0).lanes(6).lane_width(LANE));
    let car = s.place(AutonomousVehicle::along(road.path(2)).starting(10.0).speed(speed.value() / 3.6));
    let other_speed = (speed.value() + relative.value()) / 3.6;
    if other_speed < 0.0 {
        s.refuse("the other vehicle would drive backwards");
    } else {
        checked_lateral(s, lateral.value(), other_speed);
    }
    let other_speed = other_speed.max(0.0);
    let driven = match acceleration.value() {
        0.0 => Stream::constant(other_speed),
        rate => (Stream::time() * rate + other_speed).max(0.0).min(FASTEST),
    };
    let (lane, towards) = if side.value() == "left" { (1, -1.0) } else { (3, 1.0) };
    let aside = (Stream::time() * lateral.value()).min(LANE) * towards;
    let body = Body::of(kind(vehicle.value()));
    let start = 10.0 + middles_to(&body, gap.value());
    let other = Mover::new("other", body, road.path(lane)).starting(start).speed(driven).offset(aside);
    let y = s.place(other).position().y();
    roadside(s);

    s.duration(20.0);
    s.premise(&if lane == 1 { y.at_most(-LANE) } else { y.at_least(-2.0 * LANE) });
    s.monitor(Monitor::no_collision(&car));
    s.monitor(Monitor::lane_keeping(&car));
}
