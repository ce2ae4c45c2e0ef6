use super::*;
use crate::object::Class;
use crate::vehicle::Vehicle;
use proptest::prelude::*;

/// Returns the contact of the first body, which has moved within a tick.
fn touching(world: &mut World, bodies: &[BodyState]) -> Option<usize> {
    let clearance = world.clearance(bodies);
    world.contact(bodies, clearance)
}

const CAR: Vehicle = Vehicle::BMW_320I;
const WALKER_RADIUS: f64 = 0.25;

fn pose(x: f64, y: f64) -> Pose {
    Pose { position: Vector2::new(x, y), heading: 0.0 }
}

fn car(at: Pose) -> BodyState {
    BodyState::at_rest(Body::block(Class::Car, CAR.length, CAR.width, CAR.height), at)
}

/// A car and a walker.
fn pair(at: Pose, (x, y): (f64, f64)) -> [BodyState; 2] {
    [car(at), BodyState::at_rest(Body::adult(), pose(x, y))]
}

/// The contact of a car at the origin with a body that goes from one place to another within a tick.
fn contact_with(body: Body, from: (f64, f64), to: (f64, f64)) -> Option<Face> {
    let mut bodies = pair(pose(0.0, 0.0), from);
    bodies[1].body = body;
    let mut world = World::new(&bodies, &[]);
    let before = bodies;
    bodies[1].pose = pose(to.0, to.1);
    touching(&mut world, &bodies).map(|body| world.face(&before, &bodies, body))
}

/// The same with a walker.
fn contact(from: (f64, f64), to: (f64, f64)) -> Option<Face> {
    contact_with(Body::adult(), from, to)
}

#[test]
fn clearance_is_the_distance_between_box_and_circle() {
    let clearance = |to| {
        let bodies = pair(pose(100.0, -1.75), to);
        World::new(&bodies, &[]).clearance(&bodies)
    };
    let ahead = clearance((100.0 + 0.5 * CAR.length + WALKER_RADIUS + 3.0, -1.75));
    assert!((ahead - 3.0).abs() < 1e-6, "{ahead}");
    let corner = clearance((100.0 + 0.5 * CAR.length + 3.0, -1.75 + 0.5 * CAR.width + 4.0));
    assert!((corner - (5.0 - WALKER_RADIUS)).abs() < 1e-6, "{corner}");
    let alone = [car(pose(0.0, 0.0))];
    assert_eq!(World::new(&alone, &[]).clearance(&alone), f64::INFINITY);
}

proptest! {
    #[test]
    fn clearance_is_the_least_distance_of_the_bodies_that_are_present(
        others in prop::collection::vec((-30.0..30.0, -30.0..30.0, -3.1..3.1, 0..4, any::<bool>()), 0..12)
    ) {
        let others = others.into_iter().map(|(x, y, heading, kind, present)| {
            let body = match kind {
                0 => Body::adult(),
                1 => Body::truck(),
                // A long body can be nearest although its middle is far away.
                2 => Body::block(Class::Building, 40.0, 2.0, 3.0),
                _ => Body::car(),
            };
            BodyState { present, ..BodyState::at_rest(body, Pose { heading, ..pose(x, y) }) }
        });
        let bodies: Vec<BodyState> = [car(pose(0.0, 0.0))].into_iter().chain(others).collect();
        let present = bodies[1..].iter().filter(|other| other.present);
        let least = present.map(|other| distance(&bodies[0], other)).fold(f64::INFINITY, f64::min);
        prop_assert_eq!(World::new(&bodies, &[]).clearance(&bodies), least.max(TOUCH));
    }
}

#[test]
fn bodies_touch_when_they_overlap_and_not_a_millimetre_before() {
    let front = 0.5 * CAR.length + WALKER_RADIUS;
    assert_eq!(contact((front + 0.2, 0.0), (front + 0.001, 0.0)), None);
    assert!(contact((front + 0.2, 0.0), (front - 0.001, 0.0)).is_some());
}

#[test]
fn the_face_is_the_one_that_was_met_first() {
    let (front, side) = (0.5 * CAR.length + WALKER_RADIUS, 0.5 * CAR.width + WALKER_RADIUS);
    let face = |from, to| contact(from, to);
    assert_eq!(face((front + 0.1, 0.3), (front - 0.05, 0.3)), Some(Face::Front));
    assert_eq!(face((-front - 0.1, 0.3), (-front + 0.05, 0.3)), Some(Face::Rear));
    assert_eq!(face((0.5, side + 0.05), (0.4, side - 0.02)), Some(Face::Left));
    assert_eq!(face((0.5, -side - 0.05), (0.4, -side + 0.02)), Some(Face::Right));
    // A corner taken from the front: deep along the car, shallow across it.
    assert_eq!(face((front + 0.01, side - 0.3), (front - 0.15, side - 0.31)), Some(Face::Front));
}

#[test]
fn a_world_that_was_left_alone_for_a_while_still_finds_the_contact() {
    let front = 0.5 * CAR.length + WALKER_RADIUS;
    let mut bodies = pair(pose(0.0, 0.0), (90.0, 0.0));
    let mut world = World::new(&bodies, &[]);
    let mut x = 0.0;
    while touching(&mut world, &bodies).is_none() {
        x += 0.17;
        assert!(x < 95.0, "the car drove through the walker");
        bodies[0].pose = pose(x, 0.0);
    }
    assert!((x - (90.0 - front)).abs() < 0.17 + 1e-4, "{x}");
}

#[test]
fn a_turned_car_is_a_turned_box() {
    let turned = Pose { position: Vector2::new(10.0, 5.0), heading: std::f64::consts::FRAC_PI_2 };
    let beside = 10.0 + 0.5 * CAR.width + WALKER_RADIUS;
    let touches = |x| {
        let bodies = pair(turned, (x, 5.0));
        touching(&mut World::new(&bodies, &[]), &bodies)
    };
    assert_eq!(touches(beside - 0.01), Some(1));
    assert_eq!(touches(beside + 0.01), None);
}

#[test]
fn another_car_is_met_with_the_side_that_it_comes_upon() {
    let other = Body::car();
    let (front, side) = (0.5 * (CAR.length + 4.5), 0.5 * (CAR.width + 1.8));
    let face = |from, to| contact_with(other, from, to);
    assert_eq!(face((front + 0.2, 1.0), (front + 0.01, 1.0)), None);
    assert_eq!(face((front + 0.2, 1.0), (front - 0.05, 1.0)), Some(Face::Front));
    assert_eq!(face((0.0, -side - 0.05), (0.5, -side + 0.02)), Some(Face::Right));
    assert_eq!(face((-front - 0.1, 0.0), (-front + 0.05, 0.0)), Some(Face::Rear));
}

#[test]
fn bodies_that_cover_the_same_ground_are_found() {
    let others = [(20.0, 0.0), (20.4, 0.3), (40.0, 0.0)];
    let mut bodies = vec![car(pose(0.0, 0.0))];
    bodies.extend(others.map(|(x, y)| BodyState::at_rest(Body::adult(), pose(x, y))));
    assert_eq!(overlapping(&bodies, 4, &[false; 4]), Some((1, 2)));
    assert_eq!(overlapping(&bodies, 4, &[false, false, true, true]), Some((1, 2)));
    assert_eq!(overlapping(&bodies, 4, &[false, true, true, false]), None);
    // A body of the scenery is in the way of the car alone.
    assert_eq!(overlapping(&bodies, 2, &[false; 4]), None);
    bodies[2].pose = pose(1.0, 0.3);
    assert_eq!(overlapping(&bodies, 2, &[false; 4]), Some((0, 2)));
    bodies[2].pose = pose(20.6, 0.3);
    assert_eq!(overlapping(&bodies, 4, &[false; 4]), None);
}

#[test]
fn a_pushed_box_slides_as_far_as_friction_lets_it() {
    // A box of 1 kg with 10 m/s on ground of friction 0.5 slides v²/(2 mu g), pushed by nobody.
    let mut bodies =
        vec![car(pose(0.0, 50.0)), BodyState::at_rest(Body::block(Class::Prop, 0.6, 0.6, 0.2), pose(0.0, 0.0))];
    let mut world = World::new(&bodies, &[(1, 1.0)]);
    let (dt, friction, push) = (0.01, 0.5, 20.0);
    for tick in 0..400 {
        let force = if tick < 50 { Vector2::new(push, 0.0) } else { Vector2::zeros() };
        world.advance(&mut bodies, &[force], friction, dt);
        assert!(bodies[1].altitude.abs() < 0.01, "{}", bodies[1].altitude);
    }
    // 0.5 s of (20 - mu g) m/s², then mu g back to rest.
    let (gain, loss) = (push - friction * crate::vehicle::GRAVITY, friction * crate::vehicle::GRAVITY);
    let speed = 0.5 * gain;
    let expected = 0.5 * gain * 0.25 + speed * speed / (2.0 * loss);
    let x = bodies[1].pose.position.x;
    assert!((x / expected - 1.0).abs() < 0.03, "{x}, expected {expected}");
    assert!(bodies[1].velocity.norm() < 1e-3);
}
