//! Computes the numbers of the pages on Figures 10a to 10c.

use crate::page::Page;
use crate::rows::{Row, count, mean, number, numbers_of, range, rows, visibility};
use std::fmt::Write;

/// The seeds of the networks.
const SEEDS: [&str; 5] = ["1", "2", "3", "4", "5"];

/// Returns how many of the 100 tests of the training conditions pass with a network.
fn exam(file: &[u8], seed: &str) -> usize {
    let tests = rows(file);
    assert_eq!(count(&tests, |row| row["seed"] == seed), 100);
    count(&tests, |row| row["seed"] == seed && row["verdict"] == "pass")
}

/// Returns the rows of a network.
fn of(all: &[Row], seed: &str) -> Vec<Row> {
    all.iter().filter(|row| row["seed"] == seed).cloned().collect()
}

/// Writes the least and the greatest of the values of the networks.
fn spread(values: impl IntoIterator<Item = f64>, digits: usize) -> String {
    let [low, high] = range(values).map(|value| format!("{value:.digits$}"));
    if low == high { low } else { format!("{low} to {high}") }
}

#[test]
fn the_numbers_of_the_page_on_figure_10a_follow_from_its_tests() {
    let all = rows(include_bytes!("../../data/fig10a.csv"));
    let passing = SEEDS.map(|seed| exam(include_bytes!("../../data/exam-follow.csv"), seed));
    let mut page = Page::open("fig10a.md");
    let fails = |row: &Row| row["verdict"] == "fail";
    let [thin, dense] = [|row: &Row| number(row, "fog") < 0.2, |row: &Row| number(row, "fog") >= 0.6];
    let [bright, dark] = [|row: &Row| number(row, "light") >= 0.8, |row: &Row| number(row, "light") < 0.2];
    let first = of(&all, "1");
    let mut table = format!(
        "| network | pass in training conditions (of 100) | fail (of {}) | collide | fail in fog below 0.2 (of {}) | fail in fog of 0.6 and \
         more (of {}) | mean distance, bright, fog below 0.2 (m) | bright, fog of 0.6 and more (m) | dark, fog below 0.2 (m) |\n\
         | --- | --- | --- | --- | --- | --- | --- | --- | --- |\n",
        first.len(),
        count(&first, thin),
        count(&first, dense),
    );
    for (seed, passing) in SEEDS.into_iter().zip(passing) {
        let own = of(&all, seed);
        let metres = |within: &dyn Fn(&Row) -> bool| format!("{:.0}", mean(&numbers_of(&own, "travelled", within)));
        writeln!(
            table,
            "| {seed} | {passing} | {} | {} | {} | {} | {} | {} | {} |",
            count(&own, fails),
            count(&own, |row| row["collided"] == "true"),
            count(&own, |row| thin(row) && fails(row)),
            count(&own, |row| dense(row) && fails(row)),
            metres(&|row| bright(row) && thin(row)),
            metres(&|row| bright(row) && dense(row)),
            metres(&|row| dark(row) && thin(row)),
        )
        .unwrap();
    }
    page.table("networks", &table);

    assert_eq!(count(&all, |row| row["collided"] == "true" || thin(row) && fails(row)), 0);
    let failing = count(&all, fails);
    assert_eq!(failing, count(&all, |row| row["violated"] == "lane-keeping"), "all failing tests leave the lane");
    page.says(format!("All {failing} failing tests fail because the car leaves its lane"));
    page.says(format!("there is no collision in {} tests", all.len()));
    page.says(format!("{} Halton tests over fog and light", first.len()));
    let within = count(&first, thin);
    page.says(format!(
        "in fog below 0.2 (a visibility above {}), no network fails in any of its {within} tests",
        visibility(0.2)
    ));
    let networks = SEEDS.map(|seed| of(&all, seed));
    let of_dense = count(&first, dense);
    let lost = networks.each_ref().map(|own| count(own, |row| dense(row) && fails(row)));
    let [least, most] = range(lost.map(|count| count as f64));
    page.says(format!("one network in {least}, another one in {most} of {of_dense} tests"));
    page.says(format!(
        "In fog of 0.6 and more ({} and less), the networks fail in {least} to {most} of {of_dense} tests",
        visibility(0.6)
    ));
    let begin = networks.each_ref().map(|own| range(numbers_of(own, "fog", fails))[0]);
    page.says(format!("The first failures come at a fog of {}", spread(begin, 2)));
    let metres = |within: &dyn Fn(&Row) -> bool| {
        spread(networks.each_ref().map(|own| mean(&numbers_of(own, "travelled", within))), 0)
    };
    let (clear, thick) = (metres(&|row| bright(row) && thin(row)), metres(&|row| bright(row) && dense(row)));
    page.says(format!("the mean distance is {clear} m in fog below 0.2, and {thick} m in fog of 0.6 and more"));
    page.says(format!("a little slower: {} m in fog below 0.2", metres(&|row| dark(row) && thin(row))));
    page.given(&["red leaders of 2 to 12 m/s", "for 15 s behind a leader of 6 m/s, which is 25 m ahead at first"]);
    page.given(&["by network 1 over", "a light of 0.8 and more; dark tests have a light below 0.2"]);
    page.given(&["Light 1 is our brightest light"]);
    page.close();
}

#[test]
fn the_numbers_of_the_page_on_figure_10b_follow_from_its_tests() {
    let tests = rows(include_bytes!("../../data/fig10b.csv"));
    let mut page = Page::open("fig10b.md");
    let fog = |row: &Row| number(row, "fog");
    let reaches = |row: &Row, event: &str| number(row, event) < 200.0;
    assert_eq!(count(&tests, |row| reaches(row, "seconds_to_collision")), 0);
    page.says(format!("in {} densities of fog, for 200 s or until it runs into something", tests.len()));
    page.says(format!("There is no collision in {} tests", tests.len()));
    let passing: Vec<&Row> = tests.iter().take_while(|row| row["verdict"] == "pass").collect();
    assert_eq!(passing.len(), count(&tests, |row| row["verdict"] == "pass"), "all tests in thin fog pass");
    let last = passing[passing.len() - 1];
    page.says(format!(
        "In fog up to {} (a visibility of {}), the network drives all 200 s, but ever slower ({} m without fog, {:.0} m in fog of {0})",
        fog(last),
        visibility(fog(last)),
        thousands(number(&tests[0], "travelled")),
        number(last, "travelled"),
    ));
    let leaves: Vec<&Row> = tests.iter().filter(|row| reaches(row, "seconds_to_departure")).collect();
    let early = leaves[0];
    assert!(number(early, "seconds_to_departure") < number(early, "seconds_to_standstill"));
    page.says(format!(
        "in fog of {}, a visibility of {}, after it has left its way at {:.0} s",
        fog(early),
        visibility(fog(early)),
        number(early, "seconds_to_departure")
    ));
    let [from, to] = range(leaves[1..].iter().map(|row| fog(row)));
    assert_eq!(
        (to, leaves.len() - 1),
        (1.0, count(&tests, |row| fog(row) >= from)),
        "the network leaves its way from there on"
    );
    let [_, latest] = range(leaves[1..].iter().map(|row| number(row, "seconds_to_departure")));
    page.says(format!(
        "From {from} on ({}) it fails because it leaves its way within {:.0} s",
        visibility(from),
        latest.ceil()
    ));
    page.says(format!("{} of 100 tests pass", exam(include_bytes!("../../data/exam-loop.csv"), "1")));
    let steering = rows(include_bytes!("../../data/fig10b-steering.csv"));
    let turns = |fog: &str| {
        let turning = steering.iter().find(|row| row["fog"] == fog && number(row, "steering") < -0.15).unwrap();
        number(turning, "time")
    };
    let later = |fog: &str| format!("{:.1} s later", turns(fog) - turns("0"));
    page.says(format!(
        "in fog of 0.2 ({}), it reaches a steering of -0.15 only {} than without fog",
        visibility(0.2),
        later("0.2")
    ));
    page.says(format!("in fog of 0.35 ({}), it reaches this steering {}", visibility(0.35), later("0.35")));
    page.given(&["round the loop at 8 m/s", "about 100 s of driving, 10 images per second"]);
    page.given(&[
        "of 21 tests that last 200 s at most",
        "174 s: in 52 s the expert drives, and in 122 s the network drives",
    ]);
    page.close();
}

/// Writes a whole number with a comma before the last three digits.
fn thousands(value: f64) -> String {
    let whole = value.round() as u64;
    if whole < 1000 { whole.to_string() } else { format!("{},{:03}", whole / 1000, whole % 1000) }
}

/// The speeds of the leaders on the page on Figure 10c.
const LEADERS: [&str; 5] = ["4", "6", "8", "10", "12"];

/// The times and speeds of the car in a case.
fn speeds_over_time(all: &[Row], case: &str, leader: &str) -> Vec<(f64, f64)> {
    let own = all.iter().filter(|row| row["case"] == case && row["leader_speed"] == leader);
    own.map(|row| (number(row, "time"), number(row, "speed"))).collect()
}

/// Returns for each network by how much another car changes the speed in the 3 s before it passes, as the mean of the
/// leaders.
pub fn changed_by_a_red_car() -> [f64; 5] {
    let all = rows(include_bytes!("../../data/fig10c-speeds.csv.gz"));
    SEEDS.map(|seed| {
        let all = of(&all, seed);
        let changes = LEADERS.map(|leader| {
            let [alone, with_car] =
                ["red leader", "red leader and a red car coming"].map(|case| speeds_over_time(&all, case, leader));
            let passes = |row: &&Row| {
                row["leader_speed"] == leader && row["oncoming_gap"].parse().is_ok_and(|gap: f64| gap <= 0.0)
            };
            let passing = number(all.iter().find(passes).unwrap(), "time");
            let before = alone.iter().zip(&with_car).filter(|((time, _), _)| (passing - 3.0..=passing).contains(time));
            mean(&before.map(|(alone, with_car)| with_car.1 - alone.1).collect::<Vec<_>>())
        });
        mean(&changes)
    })
}

#[test]
fn the_numbers_of_the_page_on_figure_10c_follow_from_its_tests() {
    let tests = rows(include_bytes!("../../data/fig10c.csv"));
    let over_time = rows(include_bytes!("../../data/fig10c-speeds.csv.gz"));
    let mut page = Page::open("fig10c.md");
    let change = |all: &[Row], case: &str, leader: &str| {
        let speeds = speeds_over_time(all, case, leader);
        assert!(speeds.windows(2).all(|pair| (pair[1].0 - pair[0].0 - 0.05).abs() < 1e-6));
        mean(&speeds.windows(2).map(|pair| (pair[1].1 - pair[0].1).abs()).collect::<Vec<_>>())
    };
    let mut table = String::from(
        "| network | collide behind a red leader (of 5) | with a red car coming (of 5) | behind a white leader (of 5) | distance to the red \
         leader (m) | change of the speed by the red car (m/s) | change of the speed in 0.05 s, red leader (m/s) | white leader (m/s) |\n\
         | --- | --- | --- | --- | --- | --- | --- | --- |\n",
    );
    for (seed, changed) in SEEDS.into_iter().zip(changed_by_a_red_car()) {
        let (own, over_time) = (of(&tests, seed), of(&over_time, seed));
        let collide = |case: &str| count(&own, |row| row["case"] == case && row["verdict"] == "fail");
        let distances = numbers_of(&own, "clearance_or_missing_braking_m", |row| row["case"] == "red leader");
        let unsteady = |case: &str| format!("{:.3}", mean(&LEADERS.map(|leader| change(&over_time, case, leader))));
        writeln!(
            table,
            "| {seed} | {} | {} | {} | {} | {changed:.2} | {} | {} |",
            collide("red leader"),
            collide("red leader and a red car coming"),
            collide("white leader"),
            spread(distances, 0),
            unsteady("red leader"),
            unsteady("white leader"),
        )
        .unwrap();
    }
    page.table("networks", &table);
    let distances = numbers_of(&tests, "clearance_or_missing_braking_m", |row| row["case"] == "red leader");
    page.says(format!("keeps a distance of {} m", spread(distances, 0)));
    page.says(format!("the mean speed of the networks changes by {} m/s", spread(changed_by_a_red_car(), 2)));
    for row in &tests {
        let is_slow_and_white = row["case"] == "white leader" && ["4", "6"].contains(&row["leader_speed"]);
        assert_eq!(row["verdict"] == "fail", is_slow_and_white, "the page says which tests fail: {row:?}");
    }
    let least = |case: &str| {
        spread(numbers_of(&tests, "least_speed_m_per_s", |row| row["case"] == case && row["leader_speed"] == "4"), 1)
    };
    page.says(format!(
        "Behind the white leader of 4 m/s, the speed never falls below {} m/s; behind the red leader of 4 m/s, it falls to {} m/s",
        least("white leader"),
        least("red leader")
    ));
    page.given(&[
        "each network drives for 15 s",
        "speed is 4, 6, 8, 10 or 12 m/s; the figure shows 8 and 4 m/s",
        "leaders of 8 and of 4 m/s: of network 1",
        "in the 3 s before the red car passes",
        "in the 3 s before the other car passes",
        "how much the speed changes in 0.05 s",
        "the white leaders of 4 and 6 m/s",
        "mean to network 1",
    ]);
    page.close();
}
