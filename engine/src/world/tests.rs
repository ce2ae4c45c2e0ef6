use super::*;

const CAR: Vehicle = Vehicle::BMW_320I;

fn pose(x: f64, y: f64) -> Pose {
    Pose { position: Vector2::new(x, y), heading: 0.0 }
}

/// The contact of a car at the origin with a walker who goes from one place to another within a tick.
fn contact(from: (f64, f64), to: (f64, f64)) -> Option<Contact> {
    let mut world = World::new(&CAR, pose(0.0, 0.0), [pose(from.0, from.1)].into_iter());
    world.advance(pose(0.0, 0.0), [pose(to.0, to.1)].into_iter());
    world.contact()
}

#[test]
fn clearance_is_the_distance_between_box_and_circle() {
    let world = |x, y| World::new(&CAR, pose(100.0, -1.75), [pose(x, y)].into_iter());
    let ahead = world(100.0 + 0.5 * CAR.length + WALKER_RADIUS + 3.0, -1.75).clearance();
    assert!((ahead - 3.0).abs() < 1e-6, "{ahead}");
    let corner = world(100.0 + 0.5 * CAR.length + 3.0, -1.75 + 0.5 * CAR.width + 4.0).clearance();
    assert!((corner - (5.0 - WALKER_RADIUS)).abs() < 1e-6, "{corner}");
    let none = World::new(&CAR, pose(0.0, 0.0), std::iter::empty());
    assert_eq!(none.clearance(), f64::INFINITY);
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
    let face = |from, to| contact(from, to).map(|contact| contact.face);
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
    let mut world = World::new(&CAR, pose(0.0, 0.0), [pose(90.0, 0.0)].into_iter());
    let mut x = 0.0;
    while world.contact().is_none() {
        x += 0.17;
        assert!(x < 95.0, "the car drove through the walker");
        world.advance(pose(x, 0.0), [pose(90.0, 0.0)].into_iter());
    }
    assert!((x - (90.0 - front)).abs() < 0.17 + 1e-4, "{x}");
}

#[test]
fn a_turned_car_is_a_turned_box() {
    let turned = Pose { position: Vector2::new(10.0, 5.0), heading: std::f64::consts::FRAC_PI_2 };
    let beside = 10.0 + 0.5 * CAR.width + WALKER_RADIUS;
    let mut world = World::new(&CAR, turned, [pose(beside - 0.01, 5.0)].into_iter());
    assert_eq!(world.contact().map(|contact| contact.walker), Some(0));
    let mut world = World::new(&CAR, turned, [pose(beside + 0.01, 5.0)].into_iter());
    assert_eq!(world.contact(), None);
}
