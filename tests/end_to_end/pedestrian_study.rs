//! The default study is worth looking at: its map has failures, the driver makes a difference, and no straight
//! line explains it. The analysis is written here, apart from the code that draws the maps.

use paracosm::space::Domain;
use paracosm::{Campaign, Study, Trial};

/// A test in the unit square with whether it failed.
type Mark = ([f64; 2], bool);

fn halton_map(driver: &str) -> Vec<Mark> {
    let program = paracosm::catalogue().find("pedestrian-crossing").unwrap();
    let study = Study::of(program).driver(driver).build().unwrap();
    let log = Campaign::new(&study).unwrap().into_log().unwrap();
    let mark = |trial: &Trial| {
        let point = study.space().encode(&trial.test).unwrap().continuous;
        ([point[0], point[1]], trial.is_failure())
    };
    let marks: Vec<Mark> = log.trials().iter().map(mark).collect();
    assert_eq!(marks.len(), 500);
    marks
}

fn failing(marks: &[Mark]) -> f64 {
    marks.iter().filter(|mark| mark.1).count() as f64 / marks.len() as f64
}

/// Share of the tests that the verdict of their nearest neighbour explains.
fn nearest_neighbour(marks: &[Mark]) -> f64 {
    let explained = marks.iter().enumerate().filter(|(i, (at, fails))| {
        let others = marks.iter().enumerate().filter(|(j, _)| i != j).map(|(_, mark)| mark);
        let square = |x: f64| x * x;
        let distance = |mark: &&Mark| square(mark.0[0] - at[0]) + square(mark.0[1] - at[1]);
        others.min_by(|a, b| distance(a).total_cmp(&distance(b))).unwrap().1 == *fails
    });
    explained.count() as f64 / marks.len() as f64
}

/// The largest share of the tests that any straight line separates rightly, the failing ones on one side.
///
/// A best line can be turned and shifted until it touches two tests, so that trying the directions of all pairs,
/// each turned a little both ways, misses none.
fn straight_line(marks: &[Mark]) -> f64 {
    let mut best = 0;
    let mut along: Vec<(f64, bool)> = Vec::with_capacity(marks.len());
    for (i, (a, _)) in marks.iter().enumerate() {
        for (b, _) in &marks[..i] {
            for turn in [-1e-9, 1e-9] {
                let (x, y) = (b[0] - a[0], b[1] - a[1]);
                let normal = [y + turn * x, -x + turn * y];
                along.clear();
                along.extend(marks.iter().map(|(at, fails)| (at[0] * normal[0] + at[1] * normal[1], *fails)));
                best = best.max(threshold(&mut along));
            }
        }
    }
    best as f64 / marks.len() as f64
}

/// How many marks the best threshold tells rightly, in either direction.
fn threshold(along: &mut [(f64, bool)]) -> usize {
    along.sort_unstable_by(|a, b| a.0.total_cmp(&b.0));
    // Failing above the threshold; it starts below all of them.
    let mut right = along.iter().filter(|mark| mark.1).count();
    let mut best = right.max(along.len() - right);
    for (_, fails) in along.iter() {
        right = if *fails { right - 1 } else { right + 1 };
        best = best.max(right).max(along.len() - right);
    }
    best
}

#[test]
fn the_default_map_has_failures_that_the_driver_lessens_and_no_straight_line_explains() {
    let aeb = halton_map("aeb");
    let cruise = halton_map("cruise");
    assert!((0.10..=0.25).contains(&failing(&aeb)), "{} fail", failing(&aeb));
    assert!(failing(&aeb) < failing(&cruise), "aeb {}, cruise {}", failing(&aeb), failing(&cruise));
    let (neighbour, line) = (nearest_neighbour(&aeb), straight_line(&aeb));
    assert!(neighbour >= line + 0.05, "nearest neighbour {neighbour}, straight line {line}");
}

#[test]
fn an_opened_acceleration_has_the_realistic_values_and_a_named_range_wins() {
    let study = || Study::of(paracosm::catalogue().find("pedestrian-crossing").unwrap());
    let opened = |study: paracosm::StudyBuilder| {
        let study = study.build().unwrap();
        let parameter = study.space().find("acceleration").unwrap().clone();
        (parameter.domain, parameter.default)
    };
    assert_eq!(opened(study().open("acceleration")), (Domain::Interval { lo: 0.96, hi: 1.65 }, None));
    let named = study().open_over("acceleration", Domain::Interval { lo: 1.0, hi: 1000.0 });
    assert_eq!(opened(named), (Domain::Interval { lo: 1.0, hi: 1000.0 }, Some(1000.0.into())));
}
