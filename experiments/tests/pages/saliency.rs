//! Computes the numbers of the page on the pixels that decide what the cloned driver does.

use crate::page::Page;
use crate::rows::{Row, count, number, numbers_of, range, rows};
use std::fmt::Write;

#[test]
fn the_numbers_of_the_page_follow_from_its_images() {
    let frames = rows(include_bytes!("../../data/saliency.csv"));
    let gaps = rows(include_bytes!("../../data/saliency-gap.csv"));
    let maps = rows(include_bytes!("../../data/saliency-maps.csv.gz"));
    let mut page = Page::open("saliency.md");
    let mut table = String::from(
        "| leader, 8 m ahead | throttle | share of places where the patch covers a part of it | share of all change of the throttle at these \
         places | share of all change of the steering at these places |\n| --- | --- | --- | --- | --- |\n",
    );
    for (row, name) in frames.iter().zip(["red", "white", "nobody, the same places"]) {
        let share = |column: &str| 100.0 * number(row, column);
        let [throttle, steering] = ["share_of_throttle", "share_of_steering"].map(share);
        let places = share("share_of_places");
        writeln!(
            table,
            "| {name} | {:.2} | {places:.1} % | {throttle:.0} % | {steering:.0} % |",
            number(row, "throttle")
        )
        .unwrap();
    }
    page.table("frames", &table);

    let at = |gap: &str, column: &str| number(gaps.iter().find(|row| row["gap"] == gap).unwrap(), column);
    page.says(format!("takes the throttle from {:.2} to {:.2}", at("8", "nobody"), at("8", "bare_red_rectangle")));
    page.says(format!(
        "at 3 m not at all (throttle {:.2}; behind a red car {:.2})",
        at("3", "white_leader"),
        at("3", "red_leader")
    ));
    let beside = gaps.iter().flat_map(|row| {
        ["red_other_lane", "red_on_the_grass"].map(|column| (number(row, column) - number(row, "nobody")).abs())
    });
    let [_, most] = range(beside);
    page.says(format!("the throttle stays within {most:.2} of its value on the empty road, at every distance"));
    let rectangle = |row: &Row| row["what"] == "red rectangle";
    let moved = count(&maps, |row| rectangle(row) && number(row, "throttle").abs() > 0.1);
    let share = 100.0 * moved as f64 / count(&maps, rectangle) as f64;
    page.says(format!("changes the throttle by more than 0.1 at {share:.0} % of the places"));
    let brakes_to = |column: &str| {
        let braking = gaps.iter().filter(|row| number(row, column) < 0.0).map(|row| number(row, "gap"));
        range(braking)[1]
    };
    page.says(format!("a leader at {} m and more is not enough", brakes_to("bare_red_rectangle") + 1.0));
    page.says(format!(
        "it brakes for the red car up to {} m and for the white car up to {} m",
        brakes_to("red_leader"),
        brakes_to("white_leader")
    ));
    let steering = |of: &dyn Fn(&Row) -> bool| {
        let [low, high] = range(numbers_of(&maps, "steering", of));
        format!("{:.3}", high.max(-low))
    };
    page.says(format!(
        "at most by {} for a grey patch, and by {} for the red rectangle",
        steering(&|row| !rectangle(row)),
        steering(&rectangle)
    ));
    let most = gaps.iter().min_by(|a, b| number(a, "white_leader").total_cmp(&number(b, "white_leader"))).unwrap();
    page.says(format!("For a white car, the network brakes most at {} m", most["gap"]));
    page.given(&[
        "A change of more than 0.4 has the colour of 0.4",
        "at 8 m/s: behind a red leader",
        "every 5 x 5 pixels",
        "(occlusion: Zeiler and Fergus 2014)",
        "a leader 8 m ahead, without wheels",
        "the size of a leader 8 m ahead",
        "road at light 1 without fog",
        "This is network 1 of five",
    ]);
    page.close();
}
