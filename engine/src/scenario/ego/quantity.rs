//! Quantities of the ego vehicle that not every trace records. They are measured only if a program asks for them.

use super::Ego;
use super::right_of_way;
use crate::object::{BodyState, Class, Output, Outputs, Wiring, gap};
use crate::road::RoadNetwork;
use crate::signal::{Quantity, ROAD_USERS};
use crate::stream::Stream;
use crate::world::TOUCH;
use nalgebra::Vector2;
use std::cell::RefCell;

/// The quantities that a program has asked for, with the outputs that show them.
#[derive(Debug)]
pub(super) struct Asked {
    wiring: Wiring,
    outputs: RefCell<Vec<(Quantity, Output<f64>)>>,
}

impl Quantity {
    /// Measures the quantity now, with the car as the first of the bodies. `clearance` is the clearance from all bodies.
    fn measure(self, ego: &Ego, clearance: f64, bodies: &[BodyState], network: &RoadNetwork) -> f64 {
        let state = ego.dynamics().state();
        let wheels = || ego.dynamics().wheels().into_iter();
        match self {
            Quantity::LateralAcceleration => state.acceleration.y,
            Quantity::YawRate => state.yaw_rate,
            Quantity::Jerk => ego.jerk,
            Quantity::WheelSlip => wheels().map(|wheel| wheel.slip_ratio.abs()).fold(0.0, f64::max),
            Quantity::SlipAngle => wheels().map(|wheel| wheel.slip_angle.abs()).fold(0.0, f64::max),
            Quantity::WheelsOnRoad => wheels().filter(|wheel| wheel.contact).count() as f64,
            Quantity::StandingTime => ego.standing,
            Quantity::TimeToCollision => least(bodies, time_to_collision),
            Quantity::Headway => least(bodies, headway),
            Quantity::LaneMargin => lane_margin(&bodies[0], network),
            Quantity::RightOfWay => right_of_way::of(ego, bodies, network),
            Quantity::WayOffset => ego.way_offset(),
            Quantity::Remaining => ego.remaining(),
            Quantity::Clearance(index) => clearance_from(ROAD_USERS[index].0, clearance, bodies),
        }
    }
}

impl Asked {
    pub fn new(wiring: Wiring) -> Self {
        Self { wiring, outputs: RefCell::default() }
    }

    /// Returns the output of a quantity, which is measured from now on.
    pub fn output(&self, quantity: Quantity) -> Output<f64> {
        let mut outputs = self.outputs.borrow_mut();
        if let Some((_, output)) = outputs.iter().find(|(asked, _)| *asked == quantity) {
            return output.clone();
        }
        let output = self.wiring.output(quantity.name());
        outputs.push((quantity, output.clone()));
        output
    }

    /// Returns the stream of a quantity, which is measured from now on.
    pub fn stream(&self, quantity: Quantity) -> Stream<f64> {
        self.output(quantity).stream()
    }

    /// Sets the outputs of all quantities that a program has asked for.
    pub fn show(
        &self,
        ego: &Ego,
        clearance: f64,
        bodies: &[BodyState],
        network: &RoadNetwork,
        outputs: &mut Outputs<'_>,
    ) {
        for (quantity, output) in &*self.outputs.borrow() {
            outputs.set(output, quantity.measure(ego, clearance, bodies, network));
        }
    }
}

/// Returns the distance to the nearest body of a class, infinite without one. At a contact with a body of the class it is the clearance
/// from all bodies, which is minus the missing braking distance.
fn clearance_from(class: Class, clearance: f64, bodies: &[BodyState]) -> f64 {
    let others = bodies[1..].iter().filter(|other| other.present && other.body.class == class);
    let car = &bodies[0];
    let apart = |other: &BodyState| gap((&car.body.outline, &car.pose), (&other.body.outline, &other.pose));
    let nearest = others.map(apart).fold(f64::INFINITY, f64::min).max(TOUCH);
    if nearest == TOUCH { clearance.min(nearest) } else { nearest }
}

/// Returns the least value of `of` for the car and each other body; infinite if there is no other body.
fn least(bodies: &[BodyState], of: fn(&BodyState, &BodyState) -> f64) -> f64 {
    let others = bodies[1..].iter().filter(|other| other.present);
    others.map(|other| of(&bodies[0], other)).fold(f64::INFINITY, f64::min)
}

/// Returns the middle of another body as seen from the car, and half the extent of the box along the car's axes that
/// encloses it, plus half the car's extent.
fn seen(car: &BodyState, other: &BodyState) -> (Vector2<f64>, Vector2<f64>) {
    let enclosing = other.body.outline.enclosing(other.pose.heading - car.pose.heading);
    (car.pose.to_local(other.pose.position), car.body.outline.half_extent() + enclosing)
}

/// Returns the seconds until the boxes of the car and of another body meet if both keep their velocities; infinite if
/// they will not meet, 0 if they overlap.
fn time_to_collision(car: &BodyState, other: &BodyState) -> f64 {
    let (middle, reach) = seen(car, other);
    let closing = car.pose.turn_to_local(other.velocity - car.velocity);
    let (mut from, mut to) = (0.0_f64, f64::INFINITY);
    for axis in 0..2 {
        let (x, v, reach) = (middle[axis], closing[axis], reach[axis]);
        if v == 0.0 {
            if x.abs() > reach {
                return f64::INFINITY;
            }
        } else {
            let (a, b) = ((-reach - x) / v, (reach - x) / v);
            (from, to) = (from.max(a.min(b)), to.min(a.max(b)));
        }
    }
    if from <= to { from } else { f64::INFINITY }
}

/// Returns the seconds that the car takes at its speed to the present place of a body ahead. A body is ahead if the
/// car's own box would run into it on a straight line.
fn headway(car: &BodyState, other: &BodyState) -> f64 {
    let (middle, reach) = seen(car, other);
    let gap = middle.x - reach.x;
    let in_the_way = middle.y.abs() < reach.y && gap >= 0.0;
    if in_the_way { gap / car.velocity.norm() } else { f64::INFINITY }
}

/// Returns the free width of the lane beside the car on the narrower side, in metres; negative if the car is over the
/// edge. The lane is the nearest in the car's direction; without one, it is minus the distance to the nearest lane.
fn lane_margin(car: &BodyState, network: &RoadNetwork) -> f64 {
    let Some(seen) = network.project_along(&car.pose) else {
        return -network.project(car.pose.position).distance;
    };
    let aside = car.body.outline.enclosing(car.pose.heading - seen.heading).y;
    0.5 * network.lane(seen.lane).width_at(seen.s) - seen.offset.abs() - aside
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::object::{Body, gap};
    use paracosm_road::Pose;
    use proptest::prelude::*;

    fn car(x: f64, y: f64, heading: f64, velocity: [f64; 2]) -> BodyState {
        let pose = Pose { position: Vector2::new(x, y), heading };
        BodyState { velocity: velocity.into(), ..BodyState::at_rest(Body::car(), pose) }
    }

    #[test]
    fn time_to_collision_is_the_gap_by_the_closing_speed() {
        let ego = car(0.0, 0.0, 0.0, [20.0, 0.0]);
        assert_eq!(time_to_collision(&ego, &car(54.5, 0.0, 0.0, [10.0, 0.0])), 5.0);
        assert_eq!(time_to_collision(&ego, &car(54.5, 3.5, 0.0, [10.0, 0.0])), f64::INFINITY);
        assert_eq!(time_to_collision(&ego, &car(54.5, 0.0, 0.0, [30.0, 0.0])), f64::INFINITY);
        assert_eq!(headway(&ego, &car(54.5, 0.0, 0.0, [30.0, 0.0])), 2.5);
        assert_eq!(headway(&ego, &car(-54.5, 0.0, 0.0, [30.0, 0.0])), f64::INFINITY);
    }

    proptest! {
        #[test]
        fn bodies_along_the_axes_meet_at_the_time_to_collision_and_not_before(
            x in -40.0..40.0, y in -10.0..10.0, v in prop::array::uniform2(-15.0..15.0), turned in 0..4
        ) {
            let heading = f64::from(turned) * std::f64::consts::FRAC_PI_2;
            let ego = car(0.0, 0.0, 0.0, [10.0, 0.0]);
            let other = car(x, y, heading, v);
            let apart = |time: f64| {
                let moved = |body: &BodyState| Pose { position: body.pose.position + body.velocity * time, ..body.pose };
                gap((&ego.body.outline, &moved(&ego)), (&other.body.outline, &moved(&other)))
            };
            let time = time_to_collision(&ego, &other);
            let end = time.min(20.0);
            for i in 0..200 {
                let at = end * f64::from(i) / 200.0;
                prop_assert!(apart(at) > 0.0 || time == 0.0, "they meet at {} already", at);
            }
            prop_assert!(time == f64::INFINITY || apart(time) < 1e-6);
        }
    }
}
