//! Checks what the figures of cloned drivers show, by the numbers in their tables.

use crate::rows::{Row, count, different, number, rows};

#[test]
fn each_cloned_driver_fails_more_in_fog_than_where_it_was_trained() {
    let all = rows(include_bytes!("../../data/fig10a.csv"));
    let seeds = different(&all, "seed");
    assert_eq!(seeds.len(), 5);
    for seed in seeds {
        let tests: Vec<Row> = all.iter().filter(|row| row["seed"] == seed).cloned().collect();
        assert_eq!(tests.len(), 200);
        let fog = |row: &Row| number(row, "fog");
        let failing = |of: fn(f64) -> bool| {
            let fails = count(&tests, |row| of(fog(row)) && row["verdict"] == "fail");
            fails as f64 / count(&tests, |row| of(fog(row))) as f64
        };
        let (clear, dense) = (failing(|fog| fog < 0.2), failing(|fog| fog >= 0.6));
        assert!(dense > clear + 0.2, "network {seed}: {clear} fail in clear air, {dense} in fog");
    }
}

#[test]
fn every_network_passes_where_it_was_trained_and_where_there_is_something_to_brake_for_that_says_something() {
    let exams: [&[u8]; 3] = [
        include_bytes!("../../data/exam-follow.csv"),
        include_bytes!("../../data/exam-stop.csv"),
        include_bytes!("../../data/exam-loop.csv"),
    ];
    let braking = [50, 75, 101];
    for (exam, most) in exams.into_iter().zip(braking) {
        let tests = rows(exam);
        let passed = |driver: &str, seed: &str| {
            let own = |row: &Row| row["driver"] == driver && row["seed"] == seed;
            assert_eq!(count(&tests, own), 100);
            count(&tests, |row| own(row) && row["verdict"] == "pass")
        };
        for seed in different(&tests, "seed").into_iter().filter(|seed| !seed.is_empty()) {
            assert!(passed("cnn", seed) >= 95, "network {seed}: {} of 100 pass", passed("cnn", seed));
        }
        let cruise = passed("cruise", "");
        assert!(passed("expert", "") == 100 && cruise < most, "who never brakes passes {cruise}");
    }
}

/// The columns of a table by their names.
fn column(table: &str, name: &str) -> Vec<f64> {
    let place = table.lines().next().unwrap().split(',').position(|column| column == name).expect("a column");
    table.lines().skip(1).map(|line| line.split(',').nth(place).unwrap().parse().unwrap()).collect()
}

#[test]
fn covering_the_leader_changes_the_throttle_far_more_than_its_share_of_the_image() {
    let table = include_str!("../../data/saliency.csv");
    let (places, throttle) = (column(table, "share_of_places"), column(table, "share_of_throttle"));
    // The rows are: red leader, white leader, no leader.
    assert!(throttle[0] > 5.0 * places[0] && throttle[1] > 5.0 * places[1], "{throttle:?} of {places:?}");
    assert!(throttle[2] < throttle[1], "{throttle:?}");
}

#[test]
fn red_makes_the_cloned_driver_brake_in_its_lane_near_by_and_nowhere_else() {
    let table = include_str!("../../data/saliency-gap.csv");
    let [gap, red, white, oncoming, grass, rectangle, nobody] =
        ["gap", "red_leader", "white_leader", "red_other_lane", "red_on_the_grass", "bare_red_rectangle", "nobody"]
            .map(|name| column(table, name));
    for (i, gap) in gap.iter().enumerate() {
        assert!((oncoming[i] - nobody[i]).abs() < 0.1 && (grass[i] - nobody[i]).abs() < 0.1, "at {gap} m");
        if *gap <= 8.0 {
            assert!(red[i] < -0.5 && rectangle[i] < -0.3, "at {gap} m");
            assert!(white[i] > red[i] + 0.2, "at {gap} m");
        }
    }
}

#[test]
fn the_driver_goes_round_the_loop_in_thin_fog_and_gets_nowhere_in_thick_fog() {
    let table = include_str!("../../data/fig10b.csv");
    let [fog, collision, departure, standstill, travelled] =
        ["fog", "seconds_to_collision", "seconds_to_departure", "seconds_to_standstill", "travelled"]
            .map(|name| column(table, name));
    for (i, fog) in fog.iter().enumerate() {
        let failure = collision[i].min(departure[i]).min(standstill[i]);
        if *fog <= 0.2 {
            assert!(failure >= 200.0 && travelled[i] > 800.0, "in fog of {fog}: {failure} s, {} m", travelled[i]);
        } else if *fog >= 0.4 {
            assert!(failure < 60.0 && travelled[i] < 100.0, "in fog of {fog}: {failure} s, {} m", travelled[i]);
        }
    }
}
