//! Computes the numbers of the page on the claims of the paper.

use crate::fig10::changed_by_a_red_car;
use crate::page::Page;
use crate::rows::{Row, count, different, number, numbers_of, range, rows};
use paracosm::analysis::statistics::{median_and_quartiles, vargha_delaney};
use paracosm::coverage::theory::rows::proposition_3_2;
use std::collections::BTreeMap;
use std::fmt::Write;

/// The table of random families: how many of 1,000 sets cover.
fn families() -> String {
    let mut sets: BTreeMap<(usize, usize, usize), Vec<bool>> = BTreeMap::new();
    for line in include_str!("../../data/propositions-families.csv").lines().skip(1) {
        let numbers: Vec<usize> = line.split(',').map(|cell| cell.parse().unwrap()).collect();
        let [coordinates, k, tests, seed, covers] = numbers[..] else { panic!("{line}") };
        let of = sets.entry((k, coordinates, tests)).or_default();
        assert_eq!(seed, of.len());
        of.push(covers == 1);
    }
    let mut text = String::from("| coordinates | k | tests | sets that cover |\n| --- | --- | --- | --- |\n");
    for ((k, coordinates, tests), covers) in sets {
        assert_eq!(covers.len(), 1000);
        assert_eq!(tests as f64, proposition_3_2(coordinates, k, 0.05).ceil());
        let share = 100.0 * covers.iter().filter(|covers| **covers).count() as f64 / covers.len() as f64;
        writeln!(text, "| {coordinates} | {k} | {tests} | {share:.1} % |").unwrap();
    }
    text
}

/// The table of the number of tests times the dispersion.
fn dispersions() -> String {
    let mut sets: BTreeMap<(usize, &str), Vec<f64>> = BTreeMap::new();
    for line in include_str!("../../data/propositions-dispersion.csv").lines().skip(1) {
        let [strategy, tests, _, dispersion] = line.split(',').collect::<Vec<_>>()[..] else { panic!("{line}") };
        let tests: usize = tests.parse().unwrap();
        let product = tests as f64 * dispersion.parse::<f64>().unwrap();
        sets.entry((tests, strategy)).or_default().push(product);
    }
    let mut text = String::from("| tests | Halton: n times dispersion | random, median |\n| --- | --- | --- |\n");
    let sizes: Vec<usize> = sets.keys().filter(|key| key.1 == "halton").map(|key| key.0).collect();
    for tests in sizes {
        let (halton, random) = (&sets[&(tests, "halton")], &sets[&(tests, "random")]);
        assert_eq!((halton.len(), random.len()), (1, 20));
        writeln!(text, "| {tests} | {:.2} | {:.2} |", halton[0], median_and_quartiles(random).0).unwrap();
    }
    text
}

#[test]
fn the_numbers_of_the_page_follow_from_the_studies() {
    let mut page = Page::open("paper.md");
    page.table("families", &families());
    page.table("dispersion", &dispersions());
    page.given_cells("| section | the paper | here |", 2);

    let images = rows(include_bytes!("../../data/fig8.csv"));
    let trucks: Vec<[usize; 2]> = different(&images, "detector")
        .iter()
        .map(|name| {
            ["", "found"].map(|word| {
                count(&images, |row| {
                    row["detector"] == *name && !row["truck"].is_empty() && (word.is_empty() || row["truck"] == word)
                })
            })
        })
        .collect();
    let found: Vec<String> = trucks.iter().map(|[_, found]| found.to_string()).collect();
    let (last, first) = found.split_last().unwrap();
    page.says(format!("six detectors find it in {} and {last} of {} images", first.join(", "), trucks[0][0]));

    let map = rows(include_bytes!("../../data/fig9-cnn-reference.csv"));
    let fails = |row: &Row| row["verdict"] == "fail";
    page.says(format!("Agrees: {} of 2,500 tests with our network fail", count(&map, fails)));
    assert_eq!(map.len(), 2500);
    let quarter = |i: usize| {
        let own = |row: &Row| ((number(row, "speed") - 0.5) / 2.375).floor() as usize == i;
        format!("{:.1}", 100.0 * count(&map, |row| own(row) && fails(row)) as f64 / count(&map, own) as f64)
    };
    page.says(format!("the share falls from {} to {} % over the quarters of the speeds", quarter(0), quarter(3)));
    let sets = rows(include_bytes!("../../data/fig9-recalls.csv"));
    let better = |tests: &str| {
        let of =
            |strategy: &str| numbers_of(&sets, "recall", |row| row["strategy"] == strategy && row["tests"] == tests);
        format!("{:.2}", vargha_delaney(&of("halton"), &of("random")))
    };
    page.says(format!(
        "with a probability of {}, {} and {} with 25, 100 and 500 tests",
        better("25"),
        better("100"),
        better("500")
    ));
    let fog = rows(include_bytes!("../../data/fig10a.csv"));
    assert_eq!(count(&fog, |row| row["collided"] == "true"), 0);
    page.says(format!("Does not agree: no collision in {} tests of five networks", fog.len()));
    page.given(&["in fog of 0.6 and more the five networks leave their lanes"]);
    let leaders = rows(include_bytes!("../../data/fig10c.csv"));
    let slow = count(&leaders, |row| row["verdict"] == "fail" && ["4", "6"].contains(&row["leader_speed"]));
    assert_eq!([count(&leaders, |row| row["verdict"] == "fail"), slow], [10, 10]);
    page.says("each of five networks runs into the white leaders of 4 and 6 m/s");
    let [least, most] = range(changed_by_a_red_car());
    page.says(format!("changes by {least:.2} to {most:.2} m/s in the 3 s before that car passes"));
    page.given(&[
        "([arXiv 1902.01084]",
        "with a 20 x 20 grid",
        "Agrees: 84 of 84 pairs",
        "(Katona 1973)",
        "For three cars this is 42, and there are 84 pairs",
    ]);
    page.given(&[
        "with N = k = 1 and δ = 0.9 it asks for 0.21 tests",
        "Partly: false positives grow below 20 mm",
        "Proposition 3.2, with δ = 0.05: 1,000 random sets",
    ]);
    page.given(&[
        "at least 95 %",
        "(1 - 2^-k)^n by the larger e^(-n 2^-k)",
        "Proposition 3.3, in two dimensions: if the dispersion is O(1/n)",
        "the median of 20 sets",
        "from 500 to 100,000 tests. A proved bound for all numbers of tests is 24",
    ]);
    page.close();
}
