//! What Figure 9 with a network shows, as its numbers have it.

/// The rows of a table, cell by cell, without its header.
fn rows(table: &str) -> Vec<Vec<&str>> {
    table.lines().skip(1).map(|line| line.split(',').collect()).collect()
}

/// The share of the reference map's tests in a part of its speeds that violate a requirement.
fn failing(within: impl Fn(f64) -> bool) -> f64 {
    let map = rows(include_str!("../data/fig9-cnn-reference.csv"));
    assert_eq!(map.len(), 2500);
    let of_part: Vec<bool> =
        map.iter().filter(|row| within(row[0].parse().unwrap())).map(|row| row[2] == "fail").collect();
    of_part.iter().filter(|fails| **fails).count() as f64 / of_part.len() as f64
}

#[test]
fn the_cloned_driver_passes_where_it_was_trained_and_fails_more_before_faster_walkers() {
    let training = rows(include_str!("../data/fig9-cnn-training.csv"));
    let passed = training.iter().filter(|row| row[1] == "pass").count();
    assert!(training.len() == 100 && passed >= 95, "{passed} of {} pass", training.len());
    // It was taught nothing of walkers who are a little faster, for whom a car has to stop further away.
    let (taught, faster) = (failing(|speed| speed < 1.1), failing(|speed| (1.3..2.3).contains(&speed)));
    assert!(taught <= 0.05 && faster > taught + 0.2, "{taught} fail below 1.1 m/s, {faster} from 1.3 to 2.3 m/s");
}

#[test]
fn halton_leaves_smaller_gaps_than_random_at_every_size() {
    let summary = rows(include_str!("../data/fig9-cnn-summary.csv"));
    let dispersion = |row: &Vec<&str>| row[6].parse::<f64>().unwrap();
    let (random, halton): (Vec<_>, Vec<_>) = summary.iter().partition(|row| row[0] == "random");
    assert_eq!((random.len(), halton.len()), (3, 3));
    for (random, halton) in random.iter().zip(&halton) {
        assert_eq!(random[1], halton[1]);
        assert!(dispersion(halton) < 0.75 * dispersion(random), "{random:?} {halton:?}");
    }
}
