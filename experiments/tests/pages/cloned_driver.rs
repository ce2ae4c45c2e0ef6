//! Checks what the figures of cloned drivers show, by the numbers in their tables.

/// Fog, light, metres and whether the test passed.
fn tests() -> Vec<(f64, f64, f64, bool)> {
    let lines = include_str!("../../data/fig10a.csv").lines().skip(1);
    let test = |line: &str| {
        let cells: Vec<&str> = line.split(',').collect();
        let number = |i: usize| cells[i].parse::<f64>().unwrap();
        (number(0), number(1), number(2), cells[4] == "pass")
    };
    lines.map(test).collect()
}

fn mean_distance(tests: &[(f64, f64, f64, bool)], of: impl Fn(f64, f64) -> bool) -> f64 {
    let within: Vec<f64> = tests.iter().filter(|test| of(test.0, test.1)).map(|test| test.2).collect();
    within.iter().sum::<f64>() / within.len() as f64
}

#[test]
fn the_cloned_driver_gets_less_far_and_fails_more_in_fog_than_where_it_was_trained() {
    let tests = tests();
    assert_eq!(tests.len(), 200);
    let (near, far) =
        (mean_distance(&tests, |fog, light| fog < 0.2 && light >= 0.8), mean_distance(&tests, |fog, _| fog >= 0.6));
    assert!(far < 0.85 * near, "{near} m near its training, {far} m in fog");
    let failing = |of: fn(f64) -> bool| {
        let within: Vec<bool> = tests.iter().filter(|test| of(test.0)).map(|test| test.3).collect();
        within.iter().filter(|passed| !**passed).count() as f64 / within.len() as f64
    };
    let (clear, fog) = (failing(|fog| fog < 0.2), failing(|fog| fog >= 0.6));
    assert!(fog > clear + 0.2, "{clear} fail in clear air, {fog} in fog");
}

/// How many tests of an examination each driver passes: the network, the expert, and the driver that never brakes.
fn passed(table: &str) -> [usize; 3] {
    ["cnn", "expert", "cruise"].map(|driver| {
        let rows: Vec<&str> = table.lines().filter(|line| line.split(',').any(|cell| cell == driver)).collect();
        assert_eq!(rows.len(), 100);
        rows.iter().filter(|line| line.split(',').any(|cell| cell == "pass")).count()
    })
}

#[test]
fn every_network_passes_where_it_was_trained_and_where_there_is_something_to_brake_for_that_says_something() {
    let follow = passed(include_str!("../../data/exam-follow.csv"));
    let stop = passed(include_str!("../../data/exam-stop.csv"));
    let turn = passed(include_str!("../../data/exam-loop.csv"));
    for [cnn, expert, _] in [follow, stop, turn] {
        assert!(cnn >= 95 && expert == 100, "{cnn} and {expert} of 100 pass");
    }
    assert!(follow[2] < 50 && stop[2] < 75, "who never brakes passes {} and {}", follow[2], stop[2]);
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
