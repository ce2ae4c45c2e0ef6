//! Checks the tables of the page on the paper's claims: they say what the CSV of all sets says. If a table is old, the test prints it;
//! UPDATE_GOLDEN=1 writes it into the page.

mod page;

use page::assert_tables;
use paracosm::analysis::statistics::median_and_quartiles;
use paracosm::coverage::theory::rows::proposition_3_2;
use std::collections::BTreeMap;
use std::fmt::Write;

/// The table of random families: how many of 1,000 sets cover.
fn families() -> String {
    let mut sets: BTreeMap<(usize, usize, usize), Vec<bool>> = BTreeMap::new();
    for line in include_str!("../data/propositions-families.csv").lines().skip(1) {
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
    for line in include_str!("../data/propositions-dispersion.csv").lines().skip(1) {
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
fn the_tables_of_the_page_say_what_the_csv_says() {
    assert_tables("paper.md", &[("families", families()), ("dispersion", dispersions())]);
}
