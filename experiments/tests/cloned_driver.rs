//! What Figure 10a shows, as its numbers have it.

/// Fog, light, metres and whether the test passed.
fn tests() -> Vec<(f64, f64, f64, bool)> {
    let lines = include_str!("../data/fig10a.csv").lines().skip(1);
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
