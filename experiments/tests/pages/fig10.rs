//! Computes the numbers of the pages on Figures 10a to 10c.

use crate::page::Page;
use crate::rows::{Row, count, mean, number, numbers_of, range, rows, visibility};
use std::fmt::Write;

/// Says how many tests of the training conditions pass with the network.
fn exam(file: &[u8]) -> String {
    let tests = rows(file);
    let own = |row: &Row| row["driver"] == "cnn";
    format!("{} of {}", count(&tests, |row| own(row) && row["verdict"] == "pass"), count(&tests, own))
}

#[test]
fn the_numbers_of_the_page_on_figure_10a_follow_from_its_tests() {
    let tests = rows(include_bytes!("../../data/fig10a.csv"));
    let mut page = Page::open("fig10a.md");
    let fails = |row: &Row| row["verdict"] == "fail";
    let fog = |row: &Row| number(row, "fog");
    let is_light = |row: &Row| number(row, "light") >= 0.8;
    let failing = count(&tests, fails);
    assert_eq!(failing, count(&tests, |row| row["violated"] == "lane-keeping"), "all failing tests leave the lane");
    assert_eq!(count(&tests, |row| row["collided"] == "true"), 0);
    page.says(format!("{} Halton tests over fog and light", tests.len()));
    page.says(format!("all {failing} failing tests fail because the car leaves the lane"));
    page.says(format!("there is no collision in {} tests", tests.len()));
    page.says(format!("{} tests of the training conditions pass", exam(include_bytes!("../../data/exam-follow.csv"))));

    let thin = count(&tests, |row| fog(row) < 0.2);
    assert_eq!(count(&tests, |row| fog(row) < 0.2 && fails(row)), 0);
    page.says(format!("In fog below 0.2 (a visibility above {}), all {thin} tests pass", visibility(0.2)));
    let [dense, lost] = [count(&tests, |row| fog(row) >= 0.6), count(&tests, |row| fog(row) >= 0.6 && fails(row))];
    page.says(format!("In fog of 0.6 and more ({} and less), {lost} of {dense} tests fail", visibility(0.6)));
    let [clear, thick] = [
        numbers_of(&tests, "travelled", |row| is_light(row) && fog(row) < 0.2),
        numbers_of(&tests, "travelled", |row| is_light(row) && fog(row) >= 0.6),
    ];
    let drop =
        format!("drops from {:.0} m (fog below 0.2) to {:.0} m (fog of 0.6 and more)", mean(&clear), mean(&thick));
    page.says(format!("at light of 0.8 and more, the mean {drop}"));
    let dark = numbers_of(&tests, "travelled", |row| number(row, "light") < 0.2 && fog(row) < 0.2);
    page.says(format!("{:.0} m at light below 0.2 and fog below 0.2", mean(&dark)));
    page.given(&["red leaders of 2 to 12 m/s", "for 15 s behind a leader of 6 m/s, which is 25 m ahead at first"]);
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
    page.says(format!("{} tests pass", exam(include_bytes!("../../data/exam-loop.csv"))));
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

/// Returns by how much the car is slower at most, in the 3 s before another car passes, than without the other car.
pub fn slowed_by_a_red_car() -> f64 {
    let all = rows(include_bytes!("../../data/fig10c-speeds.csv"));
    let slower = LEADERS.map(|leader| {
        let [alone, with_car] =
            ["red leader", "red leader and a red car coming"].map(|case| speeds_over_time(&all, case, leader));
        let passes =
            |row: &&Row| row["leader_speed"] == leader && row["oncoming_gap"].parse().is_ok_and(|gap: f64| gap <= 0.0);
        let passing = number(all.iter().find(passes).unwrap(), "time");
        let before = alone.iter().zip(&with_car).filter(|((time, _), _)| (passing - 3.0..=passing).contains(time));
        range(before.map(|(alone, with_car)| alone.1 - with_car.1))[1]
    });
    range(slower)[1]
}

#[test]
fn the_numbers_of_the_page_on_figure_10c_follow_from_its_tests() {
    let tests = rows(include_bytes!("../../data/fig10c.csv"));
    let over_time = rows(include_bytes!("../../data/fig10c-speeds.csv"));
    let mut page = Page::open("fig10c.md");
    let least = |case: &str, leader: &str| {
        number(
            tests.iter().find(|row| row["case"] == case && row["leader_speed"] == leader).unwrap(),
            "least_speed_m_per_s",
        )
    };
    let change = |case: &str, leader: &str| {
        let speeds = speeds_over_time(&over_time, case, leader);
        assert!(speeds.windows(2).all(|pair| (pair[1].0 - pair[0].0 - 0.05).abs() < 1e-6));
        mean(&speeds.windows(2).map(|pair| (pair[1].1 - pair[0].1).abs()).collect::<Vec<_>>())
    };
    let mut table = String::from(
        "| leader's speed (m/s) | red leader: least speed (m/s) | white leader | red leader: change in 0.05 s (m/s) | white leader |\n\
         | --- | --- | --- | --- | --- |\n",
    );
    for leader in LEADERS {
        let [red, white] = ["red leader", "white leader"];
        assert!(change(white, leader) > change(red, leader), "the page says so of all speeds");
        let steady = [red, white].map(|case| format!("{:.3}", change(case, leader)));
        writeln!(
            table,
            "| {leader} | {:.2} | {:.2} | {} | {} |",
            least(red, leader),
            least(white, leader),
            steady[0],
            steady[1]
        )
        .unwrap();
    }
    page.table("speeds", &table);

    let alone = numbers_of(&tests, "clearance_or_missing_braking_m", |row| row["case"] == "red leader");
    let [near, far] = range(alone);
    page.says(format!("keeps a distance of {near:.0} to {far:.0} m"));
    page.says(format!(
        "in the 3 s before the other car passes, the car is at most {:.2} m/s slower",
        slowed_by_a_red_car()
    ));
    assert_eq!(count(&tests, |row| row["verdict"] == "fail"), 0);
    page.says("there is no collision in the five tests behind white leaders");
    page.says("At all five speeds, the speed changes more behind a white leader than behind a red leader");
    page.given(&[
        "changes in 0.05 s, in the mean",
        "for 15 s in three cases",
        "4 to 12 m/s; the figure shows 8 and 4 m/s",
        "behind leaders of 8 and of 4 m/s",
        "ran into the white leader of 4 m/s",
    ]);
    page.close();
}
