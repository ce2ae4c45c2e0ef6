//! When the driver `cc` sees a risk: by the other's way across the lane.

use super::*;

/// A car that is 1 m beside the path of the ego vehicle and comes over with 2 m/s.
const COMES_OVER: Situation = Situation { lateral: 2.8, approach: 2.0, ..AHEAD };

const FULL: f64 = 0.774 * 9.80665;

#[test]
fn cc_lets_go_of_the_pedal_at_once_for_a_body_in_its_lane_and_brakes_three_quarters_of_a_second_later() {
    // The time to collision is 5 s.
    let demands = demands(Cc::default(), AHEAD, 20);
    assert!(demands[..8].iter().all(|demand| *demand == 0.4), "0.75 s, at the next tenth of a second");
    assert_eq!(first(&demands, 0.4), Some(8));
    // 12.65 m/s³ make 0.774 g in 0.6 s.
    assert_eq!(first(&demands, FULL - 1e-9), Some(13));
    assert!(demands.iter().all(|demand| *demand <= FULL));
}

#[test]
fn cc_waits_for_the_time_to_collision_of_2_s_while_somebody_comes_over() {
    // The time to collision is 2 s after 1.3 s.
    let near = Situation { gap: 33.0, lateral: 4.75, ..COMES_OVER };
    assert_eq!(first(&demands(Cc::default(), near, 20), 0.0), Some(15), "1.475 s until it is in the path");
    let far = Situation { gap: 33.0, lateral: 2.8, approach: 0.8, ..AHEAD };
    assert_eq!(first(&demands(Cc::default(), far, 20), 0.0), Some(13), "in the path after 1.25 s");
    let farther = Situation { gap: 38.0, ..far };
    assert_eq!(first(&demands(Cc::default(), farther, 25), 0.0), Some(18), "2 s at 1.8 s");
}

#[test]
fn cc_takes_somebody_who_has_come_over_for_a_leader() {
    // It has come to the middle of the lane after 1.4 s, 3.6 s before a collision.
    assert_eq!(first(&demands(Cc::default(), COMES_OVER, 20), 0.0), Some(14));
    // A leader that wanders in its lane remains one.
    let wanders = Situation { lateral: 0.3, approach: 0.1, ..AHEAD };
    assert_eq!(first(&demands(Cc::default(), wanders, 5), 0.0), Some(0));
}

#[test]
fn cc_counts_a_lane_and_evaluates_a_cut_in_if_it_is_set_so() {
    let mut cc = Cc::default();
    cc.lane_width = 3.5;
    cc.evaluation = 0.4;
    let cut_in = Situation { gap: 15.0, lateral: 3.5, approach: 0.5, ..AHEAD };
    // 0.375 m at 0.5 m/s are left behind at 0.8 s, seen until 1.2 s.
    assert_eq!(first(&demands(cc, cut_in, 14), 0.0), Some(12));
    assert_eq!(first(&demands(Cc::default(), cut_in, 14), 0.0), None);
    let wandering = Situation { approach: 0.0, lateral: 3.2, ..cut_in };
    assert_eq!(first(&demands(cc, wandering, 14), 0.0), None);
}

#[test]
fn cc_reacts_at_once_to_a_leader_that_brakes_but_not_to_one_that_rolls() {
    let alike = Situation { speed: 10.0, gap: 20.0, ..AHEAD };
    let onset = |cc: Cc, other_acceleration| first(&demands(cc, Situation { other_acceleration, ..alike }, 10), 0.0);
    assert_eq!(onset(Cc::default(), -6.0), Some(0));
    assert_eq!(onset(Cc::default(), -0.5), Some(0));
    assert_eq!(onset(Cc::default(), -0.3), None);
    let mut regulation = Cc::default();
    regulation.leader_deceleration = 5.0;
    assert_eq!((onset(regulation, -6.0), onset(regulation, -4.0)), (Some(0), None));
}

#[test]
fn cc_sees_no_risk_in_a_collision_that_is_more_than_ten_seconds_ahead() {
    let at = |gap| Situation { gap, ..AHEAD };
    assert_eq!(first(&demands(Cc::default(), at(101.5), 5), 0.0), Some(2));
    // 100 m at 0.5 m/s² take 20 s.
    let brakes = Situation { speed: 10.0, other_acceleration: -0.5, ..at(100.0) };
    assert_eq!(first(&demands(Cc::default(), brakes, 5), 0.0), None);
}

#[test]
fn cc_collides_in_few_cut_outs_and_in_no_following_at_two_seconds_also_with_the_cars_of_this_engine() {
    let (mut cases, mut collisions) = (0, 0);
    for speed in (60..=130).step_by(10).map(|kph: u32| f64::from(kph) / 3.6) {
        for distance in (2..=147).step_by(5).map(f64::from) {
            for lateral_speed in (1..30).step_by(2).map(|tenths| f64::from(tenths) * 0.1) {
                // The leader is out of the way of the standing car before it reaches it.
                if distance / speed < 1.61 / lateral_speed {
                    continue;
                }
                cases += 1;
                let cut_out = CutOut { speed, gap: 2.0 * speed, distance, lateral_speed };
                collisions += u32::from(cut_out.encounter().run(&Cc::default()).collision.is_some());
            }
        }
        for deceleration in (1..20).map(|share| f64::from(share) * 0.05 * 9.81) {
            let leader = LeaderBrakes { speed, gap: 2.0 * speed, deceleration };
            assert_eq!(leader.encounter().run(&Cc::default()).collision, None, "{leader:?}");
        }
    }
    assert!(cases > 2000 && collisions * 20 < cases, "{collisions} of {cases}");
}
