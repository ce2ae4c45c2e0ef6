use super::*;
use proptest::prelude::*;

/// Brakes with a constant deceleration from some tick on.
#[derive(Debug, Clone)]
struct Brakes {
    from: u32,
    deceleration: f64,
    tick: u32,
}

impl Brakes {
    fn from(from: u32, deceleration: f64) -> Self {
        Self { from, deceleration, tick: 0 }
    }
}

impl BrakingModel for Brakes {
    fn brake(&mut self, _: &Situation, _: f64) -> f64 {
        self.tick += 1;
        if self.tick > self.from { self.deceleration } else { 0.0 }
    }
}

/// Where the bodies of a cut-in are, written anew: the front of the ego vehicle (braking from `onset` on), rear of
/// the other, and the room between their sides.
fn naive(cut_in: &CutIn, onset: f64, deceleration: f64, time: f64) -> (f64, f64, f64) {
    let braked = (time - onset).max(0.0).min(cut_in.speed / deceleration);
    let front = cut_in.speed * (time.min(onset) + braked) - 0.5 * deceleration * braked * braked;
    let middles = (3.5 - cut_in.lateral_speed * time).max(0.0);
    (front, cut_in.gap + cut_in.other_speed * time, middles - 1.61)
}

const LENGTHS: f64 = 2.0 * 4.508;

fn cut_ins() -> impl Strategy<Value = CutIn> {
    let unit = || 0.0..=1.0;
    let valid = |(a, b, c, d)| CutIn::from_unit([a, b, c, d]);
    (unit(), unit(), unit(), unit()).prop_filter_map("the other would drive backwards", valid)
}

fn standing(speed: f64, gap: f64) -> Encounter {
    LeaderBrakes { speed: 0.0, gap, deceleration: 0.0 }.encounter().at_speed(speed)
}

impl Encounter {
    fn at_speed(self, speed: f64) -> Self {
        Self { speed, ..self }
    }
}

proptest! {
    #[test]
    fn without_brakes_a_cut_in_ends_at_the_exact_moment_at_which_the_two_rectangles_meet(cut_in in cut_ins()) {
        let closing = cut_in.speed - cut_in.other_speed;
        let beside = (3.5 - 1.61) / cut_in.lateral_speed;
        let (reached, passed) = (cut_in.gap / closing, (cut_in.gap + LENGTHS) / closing);
        // Whether the two touch at a hair's breadth is a matter of rounding.
        prop_assume!((beside - passed).abs() > 1e-9 && (beside - reached).abs() > 1e-9);
        let collision = cut_in.encounter().run(&Unbraked).collision;
        if beside > passed {
            prop_assert_eq!(collision, None);
        } else {
            let collision = collision.unwrap();
            prop_assert!((collision.time - beside.max(reached)).abs() < 1e-9, "{:?}", collision);
            prop_assert!((collision.speed - closing).abs() < 1e-9);
            prop_assert_eq!(collision.face, if beside > reached { Impact::Side } else { Impact::Front });
        }
    }

    #[test]
    fn a_braked_cut_in_goes_as_in_steps_of_a_millisecond(
        cut_in in cut_ins(),
        from in 0..30_u32,
        deceleration in 1.0..10.0,
    ) {
        let onset = f64::from(from) * 0.1;
        // How far the two are apart, or, where negative, how deep they would be in each other.
        let apart = |time: f64| {
            let (front, rear, room) = naive(&cut_in, onset, deceleration, time);
            (rear - front).max(front - rear - LENGTHS).max(room)
        };
        // A step of braking is a chord of its parabola, at most 1.25 cm away from it.
        let tolerance = 0.0125;
        let ended = cut_in.encounter().run(&Brakes::from(from, deceleration));
        let until = ended.collision.map_or(30.0, |collision| collision.time);
        for i in 0..(until * 1000.0) as u32 {
            let time = f64::from(i) * 0.001;
            prop_assert!(apart(time) > -tolerance, "{} at {time}, {ended:?}", apart(time));
        }
        if let Some(collision) = ended.collision {
            prop_assert!(apart(collision.time).abs() < tolerance, "{} at {collision:?}", apart(collision.time));
        }
    }

    #[test]
    fn full_brakes_spare_a_standing_car_from_the_braking_distance_on(speed in 5.0..40.0, deceleration in 2.0..10.0) {
        let distance = speed * speed / (2.0 * deceleration);
        let spared = standing(speed, distance + 1e-6).run(&Brakes::from(0, deceleration));
        prop_assert_eq!(spared.collision, None);
        prop_assert!((spared.least_gap - 1e-6).abs() < 1e-9, "{}", spared.least_gap);
        let hit = standing(speed, distance * 0.9).run(&Brakes::from(0, deceleration)).collision.unwrap();
        // v² = 2 b s over the tenth of the distance that is missing; speed and way are straight lines within a step.
        let expected = (0.2 * deceleration * distance).sqrt();
        prop_assert!((hit.speed - expected).abs() < 0.1 * deceleration, "{} {expected}", hit.speed);
    }

    #[test]
    fn braking_harder_from_the_same_tick_on_never_comes_nearer_to_a_car_ahead(
        speed in 5.0..40.0, gap in 0.0..100.0, slower in 0.0..1.0, b in 0.0..10.0, more in 0.0..5.0, from in 0..30_u32,
    ) {
        let mut encounter = standing(speed, gap);
        encounter.others[0].speed = slower * speed;
        let [gentle, hard] = [b, b + more].map(|b| encounter.run(&Brakes::from(from, b)));
        prop_assert!(hard.least_gap >= gentle.least_gap - 1e-9, "{gentle:?}, {hard:?}");
        if let (Some(gentle), Some(hard)) = (gentle.collision, hard.collision) {
            prop_assert!(hard.time >= gentle.time - 1e-9);
        }
    }

    #[test]
    fn two_cars_that_brake_alike_keep_their_gap(speed in 1.0..40.0, gap in 0.1..100.0, deceleration in 0.5..10.0) {
        let encounter = LeaderBrakes { speed, gap, deceleration }.encounter();
        let ended = encounter.run(&Brakes::from(0, deceleration));
        prop_assert_eq!(ended.collision, None);
        prop_assert!((ended.least_gap - gap).abs() < 1e-2, "{}", ended.least_gap);
    }
}

#[test]
fn a_car_that_brakes_to_the_others_speed_comes_as_near_as_the_parabola_says() {
    let (speed, other_speed, gap) = (20.0, 10.0, 30.0);
    let mut encounter = standing(speed, gap);
    encounter.others[0].speed = other_speed;
    let ended = encounter.run(&Brakes::from(0, 5.0));
    // 10 m/s of difference are gone after 2 s and 10 m.
    assert!((ended.least_gap - 20.0).abs() < 1e-9, "{}", ended.least_gap);
    // (30 - 10 t + 2.5 t²) / (10 - 5 t) at t = 0 is 3; it is least where its derivative vanishes, past that it grows.
    let ttc = |t: f64| (30.0 - 10.0 * t + 2.5 * t * t) / (10.0 - 5.0 * t);
    let least = (0..20).map(|i| ttc(f64::from(i) * 0.1)).fold(f64::INFINITY, f64::min);
    assert!((ended.least_ttc - least).abs() < 1e-9, "{} {least}", ended.least_ttc);
}

#[test]
fn who_is_not_in_the_path_has_no_least_gap() {
    let mut encounter = standing(20.0, 10.0);
    encounter.others[0].lateral = 3.5;
    let ended = encounter.run(&Unbraked);
    assert_eq!(ended, Ended { collision: None, least_ttc: f64::INFINITY, least_gap: f64::INFINITY });
}

#[test]
fn a_car_that_was_passed_and_comes_over_runs_into_the_rear_of_one_that_brakes() {
    // Passed after 1.2 s; at 2 s the ego vehicle puts on the brakes in front of it.
    let cut_in = CutIn { speed: 20.0, other_speed: 10.0, gap: 2.0, lateral_speed: 1.0 };
    let collision = cut_in.encounter().run(&Brakes::from(20, 10.0)).collision.unwrap();
    assert_eq!(collision.face, Impact::Rear);
    assert_eq!(cut_in.encounter().run(&Unbraked).collision, None);
}

#[test]
fn the_standing_car_of_a_cut_out_is_seen_when_the_one_ahead_has_left_its_wandering_zone() {
    /// Brakes for what stands, as soon as it is told of it.
    #[derive(Clone)]
    struct ForStanding;
    impl BrakingModel for ForStanding {
        fn brake(&mut self, situation: &Situation, _: f64) -> f64 {
            if situation.other_speed == 0.0 { 10.0 } else { 0.0 }
        }
    }
    let least_gap = |lateral_speed: f64| {
        let cut_out = CutOut { speed: 20.0, gap: 40.0, distance: 60.0, lateral_speed };
        cut_out.encounter().run(&ForStanding).least_gap
    };
    // 104.508 m to the standing car, 20 m of braking distance; unseen for 0.3 s and for 0.8 s (0.75 s, at the next
    // tick). Until it has left the path, the one ahead is 40 m away and comes no nearer.
    for (lateral_speed, unseen) in [(1.25, 0.3), (0.5, 0.8)] {
        let expected: f64 = 104.508 - 20.0 - 20.0 * unseen;
        let gap = least_gap(lateral_speed);
        assert!((gap - expected.min(40.0)).abs() < 1e-6, "{gap} {expected}");
    }
}

#[test]
fn the_ranges_of_the_regulation_are_met_at_their_corners() {
    let slowest = CutIn::from_unit([1.0, 1.0, 0.0, 0.0]).unwrap();
    assert!((slowest.speed * 3.6 - 60.0).abs() < 1e-9 && (slowest.other_speed * 3.6 - 50.0).abs() < 1e-9);
    assert_eq!((slowest.gap, slowest.lateral_speed), (0.0, 0.5));
    assert_eq!(CutIn::from_unit([0.0, 0.0, 0.5, 0.5]), None);
}
