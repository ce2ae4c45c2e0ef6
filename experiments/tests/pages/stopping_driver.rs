//! Checks what Figure 9 with a network shows, by the numbers in its tables.

use std::ops::Range;

/// The rows of a table, cell by cell, without its header.
fn rows(table: &str) -> Vec<Vec<&str>> {
    table.lines().skip(1).map(|line| line.split(',').collect()).collect()
}

/// The share of the reference map's tests at some speeds and distances that violate a requirement.
fn failing(within: impl Fn(f64, f64) -> bool) -> f64 {
    let map = rows(include_str!("../../data/fig9-cnn-reference.csv"));
    assert_eq!(map.len(), 2500);
    let of_part: Vec<bool> = map
        .iter()
        .filter(|row| within(row[0].parse().unwrap(), row[1].parse().unwrap()))
        .map(|row| row[2] == "fail")
        .collect();
    of_part.iter().filter(|fails| **fails).count() as f64 / of_part.len() as f64
}

#[test]
fn the_cloned_driver_fails_more_before_slower_walkers_than_it_was_taught_with_and_before_fast_ones_who_are_near() {
    let near = |distance: f64| distance < 9.0;
    let taught = failing(|speed, _| (0.9..1.1).contains(&speed));
    let slower = failing(|speed, _| speed < 0.9);
    assert!(slower > 1.3 * taught, "{slower} of the slower ones, {taught} at 1 m/s");
    let [taught, faster] =
        [0.9..1.1, 4.0..9.0].map(|speeds: Range<f64>| failing(|v, d| speeds.contains(&v) && near(d)));
    assert!(faster > taught + 0.2, "near the car {faster} of the fast ones, {taught} at 1 m/s");
}

#[test]
fn what_the_cloned_driver_cannot_do_others_can() {
    let others = rows(include_str!("../../data/fig9-cnn-drivers.csv"));
    let count = |column: usize| others.iter().filter(|row| row[column] == "true").count();
    let network = (2500.0 * failing(|_, _| true)).round() as usize;
    let [expert, cruise] = [2, 4].map(count);
    // The expert who taught the network is better than it, and the network is far better than a driver that never
    // brakes.
    assert!(others.len() == 2500 && expert < network && 3 * network < cruise, "{expert}, {network}, {cruise}");
}
