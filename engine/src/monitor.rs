//! Monitors: usual requirements of drives, ready to be stated.
//!
//! A [`Monitor`] is a statement about streams with an id, a text, a unit and a scale. [`Scenario::monitor`] states it
//! and returns a draft, with which the program can change text, unit and scale. The paper's `CollisionMonitor` and
//! `DistanceMonitor` are [`Monitor::no_collision`] and [`Monitor::progress`], its dynamic check for inactivity is
//! [`Monitor::activity`]. [`Monitor::new`] makes a monitor of any other statement:
//!
//! ```
//! use paracosm_engine::{AutonomousVehicle, Monitor, Program, RoadSegment, Scenario, never};
//!
//! fn quiet(s: &mut Scenario) {
//!     let road = s.place(RoadSegment::new(300.0));
//!     let car = s.place(AutonomousVehicle::at(road.on_lane(1, 10.0)).speed(10.0));
//!     s.monitor(Monitor::no_collision(&car));
//!     s.monitor(Monitor::lane_keeping(&car)).text("The car stays in its lane, even in the bend.");
//!     s.monitor(Monitor::new("quiet", never(car.speed().above(14.0)), "m/s", 5.0));
//! }
//! # Program::new("quiet", "a quiet street", quiet).declare().unwrap();
//! ```

use crate::scenario::Car;
use crate::scenario::{RequirementDraft, Scenario, Temporal, always, eventually, never};

/// A requirement that a program can state with [`Scenario::monitor`].
#[derive(Debug, Clone)]
pub struct Monitor {
    id: String,
    statement: Temporal,
    text: Option<String>,
    unit: &'static str,
    scale: f64,
}

impl Monitor {
    /// Makes a requirement that a statement holds in every run. `unit` is the unit of the robustness, and `scale` is
    /// the robustness that counts as large.
    pub fn new(id: &str, statement: Temporal, unit: &'static str, scale: f64) -> Self {
        Self { id: id.to_owned(), statement, text: None, unit, scale }
    }

    fn text(self, text: String) -> Self {
        Self { text: Some(text), ..self }
    }

    /// Requires that the car touches no other body. The robustness is the least clearance in metres, or minus the
    /// missing braking distance: [`Car::clearance`].
    pub fn no_collision(car: &Car) -> Self {
        let text = "The car touches nobody. The robustness is the least clearance in metres, or minus the missing braking distance.";
        Self::new("no-collision", never(car.collides()), "m", 5.0).text(text.to_owned())
    }

    /// Requires that the car travels at least a given number of metres. A car that stands still for ever fails.
    pub fn progress(car: &Car, metres: f64) -> Self {
        let text =
            format!("The car travels at least {metres} m, so that a car that stands still for ever does not pass.");
        Self::new("progress", eventually(car.travelled().at_least(metres)), "m", 0.5 * metres).text(text)
    }

    /// Requires that the car comes within the given number of metres of the end of its way. A car without a route,
    /// which just goes straight on, never passes.
    pub fn route_completion(car: &Car, metres: f64) -> Self {
        let text = format!("The car comes to within {metres} m of the end of its way.");
        Self::new("route-completion", eventually(car.remaining().at_most(metres)), "m", 50.0).text(text)
    }

    /// Requires that the car never stands still for the given number of seconds.
    pub fn activity(car: &Car, seconds: f64) -> Self {
        let text = format!("The car does not stand still for {seconds} s.");
        Self::new("activity", never(car.standing_time().at_least(seconds)), "s", seconds).text(text)
    }

    /// Requires that the car keeps at least the given number of metres away from all other bodies.
    pub fn clearance(car: &Car, metres: f64) -> Self {
        let text = format!("The car keeps at least {metres} m away from everything.");
        Self::new("clearance", always(car.clearance().at_least(metres)), "m", metres.max(1.0)).text(text)
    }

    /// Requires that the car never drives faster than the given speed in m/s.
    pub fn speed_limit(car: &Car, limit: f64) -> Self {
        let text = format!("The car never drives faster than {limit} m/s.");
        Self::new("speed-limit", always(car.speed().at_most(limit)), "m/s", 5.0).text(text)
    }

    /// Requires that the time to collision with other bodies is never below the given number of seconds.
    pub fn time_to_collision(car: &Car, seconds: f64) -> Self {
        let text = format!("The time to collision is never below {seconds} s.");
        Self::new("time-to-collision", always(car.time_to_collision().at_least(seconds)), "s", 2.0).text(text)
    }

    /// Requires that the time headway to the body straight ahead is never below the given number of seconds.
    pub fn headway(car: &Car, seconds: f64) -> Self {
        let text = format!("The time headway is never below {seconds} s.");
        Self::new("headway", always(car.headway().at_least(seconds)), "s", 2.0).text(text)
    }

    /// Requires that the whole car stays in a lane of its own direction. The robustness is the least free width in
    /// metres.
    pub fn lane_keeping(car: &Car) -> Self {
        let text = "The whole car stays in its lane. The robustness is the least room beside the car in metres.";
        Self::new("lane-keeping", always(car.lane_margin().at_least(0.0)), "m", 1.0).text(text.to_owned())
    }

    /// Requires that the car's middle stays within the given number of metres of the way that the car is to go.
    pub fn on_its_way(car: &Car, metres: f64) -> Self {
        let text = format!("The car stays within {metres} m of its way.");
        Self::new("on-its-way", always(car.way_offset().abs().at_most(metres)), "m", 1.0).text(text)
    }

    /// Requires that the acceleration of the car along its heading never changes faster than the given limit in m/s³.
    pub fn jerk(car: &Car, limit: f64) -> Self {
        let text = format!("The car's acceleration never changes faster than {limit} m/s³.");
        Self::new("jerk", always(car.jerk().abs().at_most(limit)), "m/s³", limit).text(text)
    }

    /// Requires that no road user with the right of way reaches the car's place in an intersection within `seconds`.
    pub fn right_of_way(car: &Car, seconds: f64) -> Self {
        let text = format!(
            "The car is never in an intersection at a place that somebody with the right of way reaches within {seconds} s."
        );
        Self::new("right-of-way", always(car.right_of_way().at_least(seconds)), "s", 2.0).text(text)
    }
}

impl Scenario {
    /// States a monitor as a requirement of every run. The returned draft can change its text, unit and scale.
    pub fn monitor(&mut self, monitor: Monitor) -> RequirementDraft {
        let Monitor { id, statement, text, unit, scale } = monitor;
        let draft = self.require(&id, statement).unit(unit).scale(scale);
        match text {
            Some(text) => draft.text(&text),
            None => draft,
        }
    }
}
