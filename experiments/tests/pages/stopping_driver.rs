//! Checks what Figure 9 with a network shows, by the numbers in its tables.

use crate::rows::{Row, count, number, rows};
use std::ops::Range;

/// The share of the reference map's tests at some speeds and distances that violate a requirement.
fn failing(within: impl Fn(f64, f64) -> bool) -> f64 {
    let map = rows(include_bytes!("../../data/fig9-cnn-reference.csv"));
    assert_eq!(map.len(), 2500);
    let is_within = |row: &Row| within(number(row, "speed"), number(row, "distance"));
    count(&map, |row| is_within(row) && row["verdict"] == "fail") as f64 / count(&map, is_within) as f64
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
    let others = rows(include_bytes!("../../data/fig9-cnn-drivers.csv"));
    let fails = |driver: &str| count(&others, |row| row[driver] == "true");
    let network = (2500.0 * failing(|_, _| true)).round() as usize;
    let [expert, cruise] = ["expert", "cruise"].map(fails);
    // The expert who taught the network is better than it, and the network is far better than a driver that never
    // brakes.
    assert!(others.len() == 2500 && expert < network && 3 * network < cruise, "{expert}, {network}, {cruise}");
}
