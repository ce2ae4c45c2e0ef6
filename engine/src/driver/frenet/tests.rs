use super::*;
use crate::object::{Class, Outline};
use crate::observation::Ahead;
use proptest::prelude::*;

fn body(position: Vector2<f64>, velocity: Vector2<f64>, heading: f64) -> Other {
    let outline = Outline::Rectangle { length: 4.0, width: 2.0 };
    Other { id: 0, class: Class::Car, position, velocity, heading, outline }
}

fn seen(way: Way) -> Frenet {
    Frenet::of(&Observation { way, ..Observation::default() })
}

/// The pose of a point so far along an arc and to its left, from its beginning at the origin along x.
fn on_arc(curvature: f64, along: f64, left: f64) -> (Vector2<f64>, f64) {
    let (radius, angle) = (1.0 / curvature, curvature * along);
    let (sin, cos) = libm::sincos(angle);
    (Vector2::new((radius - left) * sin, radius - (radius - left) * cos), angle)
}

/// A pose of the plane as seen by a car that is to the left of the origin by `offset` and points to the left by
/// `heading`.
fn from_car((position, angle): (Vector2<f64>, f64), offset: f64, heading: f64) -> (Vector2<f64>, f64) {
    let (sin, cos) = libm::sincos(heading);
    let (x, y) = (position.x, position.y - offset);
    (Vector2::new(cos * x + sin * y, cos * y - sin * x), angle - heading)
}

proptest! {
    #[test]
    fn a_body_beside_an_arc_is_where_it_would_be_beside_a_straight_line(
        radius in 15.0..200.0_f64,
        right in any::<bool>(),
        share in 0.0..1.0,
        left in -4.0..4.0_f64,
        offset in -1.0..1.0_f64,
        heading in -0.3..0.3,
        speed in -15.0..15.0_f64,
    ) {
        let curvature = if right { -1.0 / radius } else { 1.0 / radius };
        let along = 40.0 * share;
        let at = |along, left| from_car(on_arc(curvature, along, left), offset, heading);
        let ahead = std::array::from_fn(|i| Ahead { position: at(2.5 * (i + 1) as f64, 0.0).0, curvature });
        let (position, angle) = at(along, left);
        let (sin, cos) = libm::sincos(angle);
        let seen = seen(Way { offset, heading, ahead });
        let straight = seen.straightened(&body(position, Vector2::new(cos, sin) * speed, angle), 0.0);
        // An arc is off its chord by 2.5²/8 of its curvature, and a body beside a vertex of chords within a wedge.
        let off = 1.3 / radius;
        prop_assert!((straight.position - Vector2::new(along, left - offset)).norm() < off * (1.0 + left.abs()));
        prop_assert!((straight.velocity.x - speed).abs() < 0.02, "{}", straight.velocity);
        prop_assert!(straight.velocity.y.abs() < 0.02 + 1.3 * speed.abs() * left.abs() / (radius * radius), "{}", straight.velocity);
        prop_assert!((straight.heading).abs() < 0.01 + 1.3 * left.abs() / (radius * radius));
    }

    #[test]
    fn on_a_straight_way_nothing_is_changed_in_any_bit(
        x in -50.0..100.0, y in -20.0..20.0, vx in -20.0..20.0, vy in -5.0..5.0, angle in -3.0..3.0, offset in -1.0..1.0_f64,
        age in 0.0..1.0,
    ) {
        let ahead = std::array::from_fn(|i| Ahead { position: Vector2::new(2.5 * (i + 1) as f64, -offset), curvature: 0.0 });
        let body = body(Vector2::new(x, y), Vector2::new(vx, vy), angle);
        for way in [Way { offset, heading: 0.0, ahead }, Way::default()] {
            prop_assert_eq!(seen(way).straightened(&body, age), body);
        }
    }

    #[test]
    fn a_car_that_points_aside_of_a_straight_way_sees_along_the_way(
        x in -50.0..100.0, y in -20.0..20.0, angle in -3.0..3.0, offset in -1.0..1.0_f64, heading in -0.5..0.5,
    ) {
        let at = |x, y, angle| from_car((Vector2::new(x, y), angle), offset, heading);
        let ahead = std::array::from_fn(|i| Ahead { position: at(2.5 * (i + 1) as f64, 0.0, 0.0).0, curvature: 0.0 });
        let (position, turned) = at(x, y, angle);
        let straight = seen(Way { offset, heading, ahead }).straightened(&body(position, Vector2::zeros(), turned), 0.0);
        prop_assert!((straight.position - Vector2::new(x, y - offset)).norm() < 1e-9);
        prop_assert!((straight.heading - angle).abs() < 1e-9);
    }
}

#[test]
fn a_body_that_was_seen_a_while_ago_has_gone_along_the_way_since() {
    let curvature = 1.0 / 50.0;
    let ahead = std::array::from_fn(|i| Ahead { position: on_arc(curvature, 2.5 * (i + 1) as f64, 0.0).0, curvature });
    // At 10 m/s along the arc it was 20 m ahead 0.7 s ago; straight on from there it would be elsewhere.
    let (position, angle) = on_arc(curvature, 20.0, 0.0);
    let (sin, cos) = libm::sincos(angle);
    let velocity = Vector2::new(cos, sin) * 10.0;
    let straight =
        seen(Way { ahead, ..Way::default() }).straightened(&body(position + velocity * 0.7, velocity, angle), 0.7);
    assert!((straight.position - Vector2::new(27.0, 0.0)).norm() < 0.02, "{}", straight.position);
}

#[test]
fn a_bend_goes_on_straight_beyond_its_last_point() {
    let curvature = 1.0 / 50.0;
    let ahead = std::array::from_fn(|i| Ahead { position: on_arc(curvature, 2.5 * (i + 1) as f64, 0.0).0, curvature });
    let (end, angle) = on_arc(curvature, 40.0, 0.0);
    let (sin, cos) = libm::sincos(angle);
    let (forward, left) = (Vector2::new(cos, sin), Vector2::new(-sin, cos));
    let seen = seen(Way { ahead, ..Way::default() });
    let straight = seen.straightened(&body(end + forward * 30.0 + left * 3.0, left, angle), 0.0);
    assert!((straight.position - Vector2::new(70.0, 3.0)).norm() < 0.02, "{}", straight.position);
    assert!((straight.velocity - Vector2::new(0.0, 1.0)).norm() < 1e-3, "{}", straight.velocity);
    let behind = seen.straightened(&body(Vector2::new(-10.0, 1.0), Vector2::zeros(), 0.0), 0.0);
    assert_eq!(behind.position, Vector2::new(-10.0, 1.0));
}

#[test]
fn points_of_a_way_that_all_lie_in_one_place_do_no_harm() {
    let mut ahead = [Ahead { position: Vector2::new(5.0, 3.0), curvature: 0.0 }; 16];
    ahead[0].position = Vector2::new(2.5, 0.0);
    let straight =
        seen(Way { ahead, ..Way::default() }).straightened(&body(Vector2::new(1.0, 2.0), Vector2::x(), 0.5), 0.5);
    assert!(straight.position.iter().chain(&straight.velocity).all(|x| x.is_finite()));
}
