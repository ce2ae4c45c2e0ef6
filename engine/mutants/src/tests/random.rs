//! Random worlds: no defect makes a number that is none, or a control that no car takes.

use super::*;
use crate::ALL;
use proptest::prelude::*;

fn number() -> impl Strategy<Value = f64> {
    prop_oneof![4 => -150.0..150.0_f64, 1 => Just(0.0), 1 => Just(-0.0)]
}

fn bodies() -> impl Strategy<Value = Vec<Other>> {
    let one = (prop::sample::select(&Class::ALL[..]), (number(), number()), (number(), number()), -4.0..4.0_f64);
    prop::collection::vec(one, 0..5).prop_map(|all| {
        let all = all.into_iter().enumerate();
        // Some numbers are missing, since bodies leave the world.
        all.map(|(id, (class, place, speed, heading))| Other { heading, ..body(2 * id, class, place, speed) }).collect()
    })
}

fn world() -> impl Strategy<Value = Vec<(Observation, Control)>> {
    let step = (bodies(), 0.0..60.0_f64, -4.0..4.0_f64, 0.01..0.3_f64, (-1.0..=1.0_f64, -1.0..=1.0_f64));
    prop::collection::vec(step, 1..40).prop_map(|steps| {
        let mut time = 0.0;
        let steps = steps.into_iter().map(|(others, speed, heading, after, (throttle, steering))| {
            let mut observation = Observation { speed, ..moment(time, others) };
            observation.odometry.heading = heading;
            time += after;
            (observation, Control { throttle, steering })
        });
        steps.collect()
    })
}

fn is_finite(observation: &Observation) -> bool {
    let body = |body: &Other| {
        let numbers = [body.position.x, body.position.y, body.velocity.x, body.velocity.y, body.heading];
        numbers.iter().all(|number| number.is_finite()) && body.half_extent().min() >= 0.0
    };
    observation.speed.is_finite() && observation.way.offset.is_finite() && observation.others.iter().all(body)
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 40, ..ProptestConfig::default() })]

    #[test]
    fn observations_stay_finite_ordered_and_repeatable_and_controls_possible(world in world()) {
        let (world, plays): (Vec<Observation>, Vec<Control>) = world.into_iter().unzip();
        for kind in ALL {
            for &size in kind.sizes {
                let defect = defect(kind.name, size);
                let seen_now = seen(defect, &world);
                prop_assert!(seen_now.iter().all(is_finite), "{defect}");
                let ordered = |moment: &Observation| moment.others.is_sorted_by(|a, b| a.id < b.id);
                prop_assert!(seen_now.iter().all(ordered), "{}", defect);
                prop_assert!(seen(defect, &world) == seen_now, "{}", defect);
                let done_now = done(defect, &world, &plays);
                let possible = |value: f64| (-1.0..=1.0).contains(&value);
                let can = |control: &Control| possible(control.throttle) && possible(control.steering);
                prop_assert!(done_now.iter().all(can), "{}: {:?}", defect, done_now);
                prop_assert!(done(defect, &world, &plays) == done_now, "{}", defect);
            }
        }
    }
}
