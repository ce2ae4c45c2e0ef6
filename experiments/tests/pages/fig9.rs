//! Computes the numbers of both pages on Figure 9.

use crate::page::Page;
use crate::rows::{Row, count, number, numbers_of, range, rows};
use paracosm::analysis::statistics::{bootstrap_interval, median_and_quartiles, quantile, vargha_delaney};
use std::collections::BTreeMap;
use std::fmt::Write;

const STRATEGIES: [&str; 5] = ["random", "halton", "sobol-owen", "lhs", "greedy"];

/// Returns the recalls of the sets by strategy and number of tests, in the order of their seeds.
fn recalls(csv: &'static str) -> BTreeMap<(&'static str, usize), Vec<f64>> {
    let mut recalls: BTreeMap<(&str, usize), Vec<f64>> = BTreeMap::new();
    for line in csv.lines().skip(1) {
        let [strategy, tests, seed, recall] = line.split(',').collect::<Vec<_>>()[..] else { panic!("{line}") };
        let sets = recalls.entry((strategy, tests.parse().unwrap())).or_default();
        assert_eq!(seed, sets.len().to_string());
        sets.push(recall.parse().unwrap());
    }
    recalls
}

/// The table of medians with quartiles, and of the probability that a set of the strategy has a larger recall than a random set, with its
/// 95 % bootstrap interval over the sets.
fn recall_table(recalls: &BTreeMap<(&str, usize), Vec<f64>>, sizes: [usize; 3]) -> String {
    let mut text = String::from("| strategy |");
    sizes.iter().for_each(|size| write!(text, " {size} tests | P(better) |").unwrap());
    text += "\n| --- | --- | --- | --- | --- | --- | --- |\n";
    for strategy in STRATEGIES {
        write!(text, "| `{strategy}` |").unwrap();
        for size in sizes {
            let (own, random) = (&recalls[&(strategy, size)], &recalls[&("random", size)]);
            assert!(own.len() >= 200);
            let (median, [lower, upper]) = median_and_quartiles(own);
            let percent = |share: f64| format!("{:.0}", 100.0 * share);
            write!(text, " {} % ({} to {}) |", percent(median), percent(lower), percent(upper)).unwrap();
            if strategy == "random" {
                text += " |";
                continue;
            }
            let [low, high] = better_interval(own, random);
            write!(text, " {:.2} ({low:.2} to {high:.2}) |", vargha_delaney(own, random)).unwrap();
        }
        text.push('\n');
    }
    text
}

/// The 95 % bootstrap interval, over the sets, of the probability that a set of a strategy has a larger recall than a random set.
fn better_interval(own: &[f64], random: &[f64]) -> [f64; 2] {
    bootstrap_interval(own.len(), |drawn| {
        let of = |values: &[f64]| drawn.iter().map(|i| values[*i]).collect::<Vec<_>>();
        vargha_delaney(&of(own), &of(random))
    })
}

type Measure = (&'static str, &'static str, fn(f64) -> String);

/// The measures of a sample: the column of the file, the title in the table, and how a value is written.
const MEASURES: [Measure; 6] = [
    ("failures", "failing tests", whole),
    ("dispersion", "dispersion", |value| format!("{value:.4}")),
    ("star_discrepancy", "star discrepancy", |value| format!("{value:.4}")),
    ("map_accuracy", "map accuracy", percent),
    ("map_recall", "recall of failures", percent),
    ("map_precision", "precision of failures", percent),
];

fn whole(value: f64) -> String {
    format!("{value:.2}").trim_end_matches('0').trim_end_matches('.').to_owned()
}

fn percent(share: f64) -> String {
    if share.is_nan() { "none".to_owned() } else { format!("{:.1} %", 100.0 * share) }
}

/// Returns the numbers of a column, in ascending order, of the samples of a strategy and a size.
fn samples(panels: &[Row], column: &str, strategy: &str, size: usize) -> Vec<f64> {
    let mut values = numbers_of(panels, column, |row| row["strategy"] == strategy && row["tests"] == size.to_string());
    // A sample that predicts no failing place has no precision.
    values.retain(|value| !value.is_nan());
    values.sort_by(f64::total_cmp);
    values
}

/// The table of random samples beside the plain Halton points.
fn sample_table(panels: &[Row], sizes: [usize; 3]) -> String {
    let mut text = String::from("| | tests | random | halton |\n| --- | --- | --- | --- |\n");
    for (column, title, written) in MEASURES {
        for (i, size) in sizes.into_iter().enumerate() {
            let random = samples(panels, column, "random", size);
            let [median, low, high] = [0.5, 0.25, 0.75].map(|q| written(quantile(&random, q)));
            let halton = samples(panels, column, "halton", size);
            assert_eq!(halton.len(), 1);
            let title = if i == 0 { title } else { "" };
            writeln!(text, "| {title} | {size} | {median} ({low} to {high}) | {} |", written(halton[0])).unwrap();
        }
    }
    text
}

/// The ratios of the median of the random samples to the value of the Halton points, by size.
fn ratios(panels: &[Row], column: &str, sizes: [usize; 3]) -> [f64; 3] {
    sizes.map(|size| {
        quantile(&samples(panels, column, "random", size), 0.5) / samples(panels, column, "halton", size)[0]
    })
}

fn sides_table(tests: &[Row]) -> String {
    let quarter = |row: &Row| (4.0 * (number(row, "speed") - 0.5) / 9.5).floor() as usize;
    let mut text = String::from(
        "| side | acceleration | 0.5 to 2.9 m/s | 2.9 to 5.3 m/s | 5.3 to 7.6 m/s | 7.6 to 10 m/s | all |\n\
         | --- | --- | --- | --- | --- | --- | --- |\n",
    );
    for acceleration in ["1000", "1.65", "0.96"] {
        for side in ["far", "near"] {
            let own = |row: &Row| row["side"] == side && row["acceleration"] == acceleration;
            let share = |within: &dyn Fn(&Row) -> bool| {
                let fails = count(tests, |row| own(row) && within(row) && row["fails"] == "1");
                percent(fails as f64 / count(tests, |row| own(row) && within(row)) as f64)
            };
            let written = if acceleration == "1000" { "at once".to_owned() } else { format!("{acceleration} m/s²") };
            assert_eq!(count(tests, own), 4096);
            write!(text, "| {side} | {written} |").unwrap();
            (0..4).for_each(|i| write!(text, " {} |", share(&|row| quarter(row) == i)).unwrap());
            writeln!(text, " {} |", share(&|_| true)).unwrap();
        }
    }
    text
}

/// Returns the strategies and sizes whose probability to be better than a random set has an interval above 0.5, and below 0.5.
fn decided(recalls: &BTreeMap<(&'static str, usize), Vec<f64>>, sizes: [usize; 3]) -> [Vec<(&'static str, usize)>; 2] {
    let mut decided = [Vec::new(), Vec::new()];
    for strategy in &STRATEGIES[1..] {
        for size in sizes {
            let [low, high] = better_interval(&recalls[&(*strategy, size)], &recalls[&("random", size)]);
            // As the table shows them, in two digits.
            let [low, high] = [low, high].map(|end| (100.0 * end).round());
            if low > 50.0 {
                decided[0].push((*strategy, size));
            }
            if high < 50.0 {
                decided[1].push((*strategy, size));
            }
        }
    }
    decided
}

#[test]
fn the_numbers_of_the_page_follow_from_its_samples() {
    let sizes = [25, 100, 500];
    let panels = rows(include_bytes!("../../data/fig9-panels.csv"));
    let recalls = recalls(include_str!("../../data/fig9-recalls.csv"));
    let shape = rows(include_bytes!("../../data/fig9-shape.csv"));
    let sides = rows(include_bytes!("../../data/fig9-sides.csv.gz"));
    let noise = rows(include_bytes!("../../data/fig9-noise.csv"));
    let mut page = Page::open("fig9.md");
    page.table("samples", &sample_table(&panels, sizes));
    page.table("recalls", &recall_table(&recalls, sizes));
    page.table("sides", &sides_table(&sides));

    let [best, worse] = decided(&recalls, sizes);
    let expected = [("halton", 100), ("halton", 500), ("sobol-owen", 25), ("sobol-owen", 100), ("sobol-owen", 500)];
    assert_eq!(best[..5], expected, "the page says so");
    assert_eq!(
        (&best[5..], worse.len()),
        (&[("greedy", 25), ("greedy", 100), ("greedy", 500)][..], 0),
        "the page says so"
    );
    let better = |strategy: &str, size: usize| vargha_delaney(&recalls[&(strategy, size)], &recalls[&("random", size)]);
    let halton = [100, 500].map(|size| format!("{:.1}", better("halton", size)));
    page.says(format!("with a probability of {} and {}", halton[0], halton[1]));
    let [low, high] = range(ratios(&panels, "dispersion", sizes));
    let [star_low, star_high] = range(ratios(&panels, "star_discrepancy", sizes));
    page.says(format!("The dispersion is {low:.1} to {high:.1} times smaller, and the star discrepancy {star_low:.1} to {star_high:.1} times"));
    let share = |of: &str, measure: &str| {
        let is_it = |row: &&Row| row["of"] == of && row["measure"] == measure;
        100.0 * number(shape.iter().find(is_it).unwrap(), "share")
    };
    let quarters = [1, 2, 3, 4].map(|i| share("reference map", &format!("failing in quarter {i} of the speeds")));
    page.says(format!(
        "{:.0} % of the tests fail in the slowest quarter of the speeds, and {:.0}, {:.0} and {:.0} % in the other quarters",
        quarters[0], quarters[1], quarters[2], quarters[3]
    ));
    let explained = ["best straight line", "nearest neighbour", "all passing"]
        .map(|by| share("halton, 500 tests", &format!("explained by {by}")));
    page.says(format!(
        "the best straight line predicts {:.1} % right, and the nearest neighbour {:.1} %. The prediction that all tests pass is right for {:.1} %",
        explained[0], explained[1], explained[2]
    ));
    let [least, most] = range(numbers_of(&noise, "failing", |_| true));
    page.says(format!(
        "With the seeds 1 to {}, {least} to {most} of the {} Halton tests fail",
        noise.len(),
        noise[0]["tests"]
    ));
    let seeds = samples(&panels, "dispersion", "random", 25).len();
    page.says(format!("the median and the quartiles over {seeds} seeds"));
    page.says(format!("{} randomised sets of each strategy", recalls[&("halton", 25)].len()));
    page.given(&[
        "with 25, 100 and 500 tests, over the cells",
        "With 100 and with 500 tests, they tell",
        "With 25 tests, this is not certain",
        "with 25, 100 and 500 tests: the walking speed (0.5 to 10 m/s)",
    ]);
    page.given(&[
        "when the pedestrian starts (5 to 60 m)",
        "a map of 10,000 tests on a grid",
        "from index 1",
        "whose dispersion at 25 tests is the median",
    ]);
    page.given(&[
        "with its 95 % bootstrap interval",
        "Halton with 100 and with 500 tests. With 25 tests, the interval of Halton begins at 0.50",
        "all intervals contain 0.50",
        "Of the 500 Halton tests",
    ]);
    page.given(&[
        "an adult reaches 5 km/h within 1 m (0.96 m/s²), and 8 km/h within 1.5 m (1.65 m/s²)",
        "the share of 4,096 Sobol tests",
        "walking speeds above 5.3 m/s make",
        "(`driver.seed` 1)",
    ]);
    page.close();
}

/// A part of the map: its name, and whether a speed and a distance belong to it.
type Region = (&'static str, fn(f64, f64) -> bool);

/// The tests of the map with a network as the driver.
struct Map {
    tests: Vec<Row>,
    /// The verdicts of the other drivers, in the same order.
    others: Vec<Row>,
}

impl Map {
    fn fails(&self, test: usize, driver: &str) -> bool {
        if driver == "network" { self.tests[test]["verdict"] == "fail" } else { self.others[test][driver] == "true" }
    }

    /// Counts the failing tests of a driver, and all tests, among the tests whose speed and distance satisfy a condition.
    fn failing(&self, driver: &str, within: impl Fn(f64, f64) -> bool) -> [usize; 2] {
        let is_within =
            |test: &usize| within(number(&self.tests[*test], "speed"), number(&self.tests[*test], "distance"));
        let all: Vec<usize> = (0..self.tests.len()).filter(is_within).collect();
        [all.iter().filter(|test| self.fails(**test, driver)).count(), all.len()]
    }

    fn regions(&self) -> String {
        let regions: [Region; 6] = [
            ("0.5 to 0.9 m/s, slower than in training", |speed, _| speed < 0.9),
            ("0.9 to 1.1 m/s", |speed, _| (0.9..1.1).contains(&speed)),
            ("1.1 to 4 m/s", |speed, _| (1.1..4.0).contains(&speed)),
            ("4 to 9 m/s that set out within 9 m", |speed, distance| (4.0..9.0).contains(&speed) && distance < 9.0),
            ("4 to 9 m/s that set out further away", |speed, distance| (4.0..9.0).contains(&speed) && distance >= 9.0),
            ("9 m/s and more", |speed, _| speed >= 9.0),
        ];
        let mut text = String::from(
            "| tests with walkers of | tests | fail with the network | with `expert` | with `cruise` |\n| --- | --- | --- | --- | --- |\n",
        );
        for (name, within) in regions {
            let [[network, all], [expert, _], [cruise, _]] =
                ["network", "expert", "cruise"].map(|driver| self.failing(driver, within));
            writeln!(
                text,
                "| {name} | {all} | {network} ({}) | {expert} | {cruise} |",
                percent(network as f64 / all as f64)
            )
            .unwrap();
        }
        text
    }
}

/// The tests that fail with the network and not with `cruise`.
fn says_why_braking_fails(page: &mut Page, map: &Map, only_braking: usize) {
    let braked = rows(include_bytes!("../../data/fig9-cnn-braked.csv"));
    let is_one = |test: &usize| map.fails(*test, "network") && !map.fails(*test, "cruise");
    let tests: Vec<usize> = (0..map.tests.len()).filter(is_one).collect();
    let place = |row: &Row| ["speed", "distance"].map(|column| format!("{:.2}", number(row, column)));
    assert!(
        tests.iter().map(|test| place(&map.tests[*test])).eq(braked.iter().map(place)),
        "the file has the tests of the map"
    );
    assert!(tests.iter().all(|test| !map.fails(*test, "expert")));
    page.says(format!("Why do {only_braking} tests fail only because the network brakes?** We looked at each of them ([all {only_braking}]"));
    let at = number;
    let before = count(&braked, |row| at(row, "cruise_passes_s") < at(row, "cruise_walker_in_the_way_s"));
    let others = only_braking - before;
    page.says(format!("In {before} tests, a car that goes on has passed the walker before the walker comes into its way, and in the other {others} at nearly"));
    let late = braked.iter().map(|row| at(row, "cruise_passes_s") - at(row, "cruise_walker_in_the_way_s"));
    assert!(range(late)[1] < 0.05);
    let [first, last] = range(numbers_of(&braked, "network_brakes_s", |_| true));
    let early = count(&braked, |row| at(row, "network_brakes_s") < at(row, "network_walker_sets_out_s"));
    page.says(format!(
        "The network brakes after {first:.1} to {last:.1} s, more than 2 s before a car that goes on has passed, and in {early} tests before the walker"
    ));
    assert!(braked.iter().all(|row| at(row, "network_brakes_s") + 2.0 < at(row, "cruise_passes_s")));
    let [slow, fast] = range(numbers_of(&braked, "collision_m_per_s", |_| true));
    page.says(format!("hits the walker at {slow:.1} to {fast:.1} m/s, within 0.5 s after"));
    assert!(braked.iter().all(|row| at(row, "collision_s") - at(row, "network_walker_in_the_way_s") < 0.5));
    let hardly = count(&braked, |row| at(row, "collision_m_per_s") > 7.0);
    page.says(format!("In {hardly} tests it is faster than 7 m/s then"));
    page.says(format!("The expert passes all {only_braking} tests"));
}

#[test]
fn the_numbers_of_the_page_with_a_network_follow_from_its_map() {
    let sizes = [25, 50, 100];
    let panels = rows(include_bytes!("../../data/fig9-cnn-panels.csv"));
    let recalls = recalls(include_str!("../../data/fig9-cnn-recalls.csv"));
    let shape = rows(include_bytes!("../../data/fig9-cnn-shape.csv"));
    let exams = rows(include_bytes!("../../data/exam-stop.csv"));
    let map = Map {
        tests: rows(include_bytes!("../../data/fig9-cnn-reference.csv")),
        others: rows(include_bytes!("../../data/fig9-cnn-drivers.csv")),
    };
    let mut page = Page::open("fig9-cnn.md");
    page.table("samples", &sample_table(&panels, sizes));
    page.table("recalls", &recall_table(&recalls, sizes));
    page.table("regions", &map.regions());

    let [best, worse] = decided(&recalls, sizes);
    assert_eq!(best, [("halton", 100), ("sobol-owen", 100), ("greedy", 100)], "the page says so");
    assert_eq!(worse, [("greedy", 25), ("greedy", 50)], "the page says so");
    let passes = |driver: &str| count(&exams, |row| row["driver"] == driver && row["verdict"] == "pass");
    let [network, expert, cruise] = ["cnn", "expert", "cruise"].map(passes);
    assert_eq!(expert, 100);
    page.says(format!("{network} of 100 tests pass that no lesson came from"));
    page.says(format!("All {expert} pass with the expert as the driver, and {cruise} pass with `cruise`, which never brakes. So in {} tests", 100 - cruise));

    let total = map.tests.len();
    let fails = |driver: &str| map.failing(driver, |_, _| true)[0];
    let failing = fails("network");
    assert_eq!(failing, count(&map.tests, |row| row["violated"] == "no-collision"), "all failures are collisions");
    page.says(format!("{failing} of these tests fail, all by a collision"));
    page.says(format!(
        "{} fail with the expert, {} with `aeb` and {} with `cruise`",
        fails("expert"),
        fails("aeb"),
        fails("cruise")
    ));
    let both = (0..total).filter(|test| map.fails(*test, "network") && map.fails(*test, "cruise")).count();
    page.says(format!("{both} tests fail with both the network and `cruise`, so that the other {} would not have failed if the car had not braked", failing - both));
    says_why_braking_fails(&mut page, &map, failing - both);
    let near_one = map.failing("network", |speed, _| (0.9..1.1).contains(&speed));
    let share = |[fails, of]: [usize; 2]| 100.0 * fails as f64 / of as f64;
    page.says(format!(
        "{:.0} % of the {} places near 1 m/s fail, and {:.1} % of the map",
        share(near_one),
        near_one[1],
        share([failing, total])
    ));
    let is_near_one = |test: &usize| (0.9..1.1).contains(&number(&map.tests[*test], "speed"));
    let stops = |near: bool| {
        let there: Vec<usize> =
            (0..total).filter(|test| map.fails(*test, "cruise") && is_near_one(test) == near).collect();
        format!("{} of ", there.iter().filter(|test| map.fails(**test, "network")).count()) + &there.len().to_string()
    };
    page.says(format!(
        "the network fails in {} tests that fail with `cruise`. Elsewhere it fails in {}",
        stops(true).replace("of ", "of the "),
        stops(false)
    ));
    let within = map.failing("network", |_, distance| distance < 9.0)[0];
    page.says(format!("{within} of the {failing} failing tests of the map set out within 9 m"));
    page.says(format!("{failing} of {} tests fail", thousands(total)));
    let quarters =
        [0, 1, 2, 3].map(|i| share(map.failing("network", |speed, _| ((speed - 0.5) / 2.375).floor() as usize == i)));
    page.says(format!(
        "{:.1}, {:.1}, {:.1} and {:.1} % of the tests fail",
        quarters[0], quarters[1], quarters[2], quarters[3]
    ));
    let is_line = |row: &&Row| row["of"] == "reference map" && row["measure"] == "explained by best straight line";
    let line = 100.0 * number(shape.iter().find(is_line).unwrap(), "share");
    page.says(format!("on the map, the best straight line predicts {line:.1} % right"));
    let dispersion = ratios(&panels, "dispersion", sizes).map(|ratio| format!("{:.2}", 1.0 / ratio));
    page.says(format!(
        "Halton's dispersion is {}, {} and {} of the dispersion of the median random set",
        dispersion[0], dispersion[1], dispersion[2]
    ));
    let plain = sizes.map(|size| format!("{:.0}", 100.0 * samples(&panels, "map_recall", "halton", size)[0]));
    page.says(format!("The recall of {}, {} and {} % belongs to one Halton set", plain[0], plain[1], plain[2]));
    page.says(format!("the prediction that all tests pass is right for {:.1} %", share([total - failing, total])));
    let better = vargha_delaney(&recalls[&("halton", 100)], &recalls[&("random", 100)]);
    page.says(format!("a shifted Halton set is better than a random set with a probability of {better:.2}"));
    page.says(format!(
        "the medians and quartiles of {} random seeds",
        samples(&panels, "dispersion", "random", 25).len()
    ));
    page.says(format!("{} randomised sets of each strategy", recalls[&("halton", 25)].len()));
    page.given(&[
        "a driver taught with walkers of 1 m/s meets other speeds",
        "Near 1 m/s, the",
        "Shifted Halton sets of 100 tests",
    ]);
    page.given(&[
        "with pedestrians that walk at 1 m/s and set out when the car, at 30 km/h, is 5 to 60 m away",
        "at 0.5 to 10 m/s. Every image",
        "The car begins 70 m before",
        "A test lasts 10 s, plus",
    ]);
    page.given(&[
        "walks 8.5 m, and 25 s at most",
        "asks for 40 m",
        "each of 50 x 50 cells",
        "with its 95 % bootstrap interval",
        "With 100 tests, `halton`",
        "With 25 and with 50 tests, `greedy`",
        "All other intervals contain 0.50",
    ]);
    page.given(&[
        "slow walkers 40 m away",
        "with 25, 50 and 100 tests, over the cells",
        "with 100 tests, a shifted",
        "up to 500 tests, 50 seeds",
        "taught at 60 km/h, passed 96 of its 100 tests, and `cruise` passed all 100",
        "no walker of 1 m/s that sets out within 60 m",
    ]);
    page.close();
}

fn thousands(number: usize) -> String {
    if number < 1000 { number.to_string() } else { format!("{},{:03}", number / 1000, number % 1000) }
}
