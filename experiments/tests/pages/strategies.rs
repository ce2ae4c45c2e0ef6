//! Computes the numbers of the page on strategies: on problems that nothing was chosen on, and on random functions.

use crate::page::Page;
use crate::rows::{Row, different, mean, number, range, rows};
use paracosm::analysis::statistics::{bootstrap_interval, spearman};
use std::fmt::Write;

const RUNS: &str = include_str!("../../data/random-functions.csv");

/// The number of tests of a run without a failure.
const CENSORED: u32 = 301;

/// Returns the strategies in the order of the file, each with the tests to the failure of each function.
fn functions() -> Vec<(&'static str, Vec<(u32, u32)>)> {
    let mut strategies: Vec<(&str, Vec<(u32, u32)>)> = Vec::new();
    for line in RUNS.lines().skip(1) {
        let [strategy, function, tests] = line.split(',').collect::<Vec<_>>()[..] else { panic!("{line}") };
        let run = (function.parse().unwrap(), if tests.is_empty() { CENSORED } else { tests.parse().unwrap() });
        match strategies.last_mut().filter(|last| last.0 == strategy) {
            Some(last) => last.1.push(run),
            None => strategies.push((strategy, vec![run])),
        }
    }
    strategies
}

fn functions_table() -> String {
    let mut text = String::from(
        "| strategy | functions 1000 to 1059 | functions 1000 to 1299 | median |\n| --- | --- | --- | --- |\n",
    );
    for (strategy, runs) in functions() {
        let found = |last: u32| {
            let among: Vec<_> = runs.iter().filter(|run| run.0 <= last).collect();
            format!("{} of {}", among.iter().filter(|run| run.1 < CENSORED).count(), among.len())
        };
        let mut tests: Vec<u32> = runs.iter().map(|run| run.1).collect();
        tests.sort_unstable();
        let median = f64::from(tests[(tests.len() - 1) / 2] + tests[tests.len() / 2]) / 2.0;
        writeln!(text, "| `{strategy}` | {} | {} | {median} |", found(1059), found(1299)).unwrap();
    }
    text
}

/// The number of tests of a run on a problem.
const BUDGET: f64 = 150.0;
/// The strategies that do not look at results.
const OPEN_LOOP: [&str; 3] = ["random", "halton", "greedy"];
const CONTROL: &str = "random-corners";

/// The runs on all problems.
struct Runs {
    rows: Vec<Row>,
    problems: Vec<&'static str>,
    strategies: Vec<&'static str>,
    maps: Vec<Row>,
}

impl Runs {
    fn read() -> Self {
        let all = rows(include_bytes!("../../data/strategies.csv.gz"));
        let maps = rows(include_bytes!("../../data/strategies-maps.csv"));
        Self { problems: different(&all, "problem"), strategies: different(&all, "strategy"), rows: all, maps }
    }

    fn of(&self, problem: &str, strategy: &str) -> Vec<&Row> {
        self.rows.iter().filter(|row| row["problem"] == problem && row["strategy"] == strategy).collect()
    }

    /// The mean number of tests to the first failure; a run without a failure counts as all its tests.
    fn mean(&self, problem: &str, strategy: &str) -> f64 {
        mean(
            &self
                .of(problem, strategy)
                .iter()
                .map(|row| row["first_failure"].parse().unwrap_or(BUDGET))
                .collect::<Vec<_>>(),
        )
    }

    fn cell(&self, problem: &str, strategy: &str) -> String {
        let runs = self.of(problem, strategy);
        let found = runs.iter().filter(|row| !row["first_failure"].is_empty()).count();
        let mean = self.mean(problem, strategy);
        if found == runs.len() { format!("{mean:.1}") } else { format!("{mean:.1} ({found})") }
    }

    fn adaptive(&self) -> Vec<&'static str> {
        self.strategies.iter().copied().filter(|name| !OPEN_LOOP.contains(name) && *name != CONTROL).collect()
    }

    /// The share of the map that fails, in percent.
    fn failing(&self, problem: &str) -> String {
        let row = self.maps.iter().find(|row| row["problem"] == problem).unwrap();
        format!("{:.1}", 100.0 * number(row, "failing") / number(row, "tests"))
    }

    /// A table with a row for each problem and a column for each strategy.
    fn table(&self, cell: impl Fn(&str, &str) -> String) -> String {
        let mut text = String::from("| problem | fails in % |");
        self.strategies.iter().for_each(|name| write!(text, " `{name}` |").unwrap());
        write!(text, "\n| --- | --- |{}\n", " --- |".repeat(self.strategies.len())).unwrap();
        for problem in &self.problems {
            let cells: Vec<String> = self.strategies.iter().map(|name| cell(problem, name)).collect();
            writeln!(text, "| {problem} | {} | {} |", self.failing(problem), cells.join(" | ")).unwrap();
        }
        text
    }

    /// The mean number of failure modes of a run.
    fn modes(&self, problem: &str, strategy: &str) -> f64 {
        mean(&self.of(problem, strategy).iter().map(|row| number(row, "modes")).collect::<Vec<_>>())
    }

    /// The rank correlation of dispersion and recall over the runs of some strategies, with its interval over the seeds.
    fn correlation(&self, problem: &str, strategies: &[&str]) -> [f64; 3] {
        let runs: Vec<Vec<&Row>> = strategies.iter().map(|name| self.of(problem, name)).collect();
        let of = |seeds: &[usize]| {
            let drawn = seeds.iter().flat_map(|seed| runs.iter().map(move |runs| runs[*seed]));
            let known = drawn.filter(|row| !row["recall"].is_empty());
            let (x, y): (Vec<f64>, Vec<f64>) =
                known.map(|row| (number(row, "dispersion"), number(row, "recall"))).unzip();
            spearman(&x, &y).unwrap_or(0.0)
        };
        let all: Vec<usize> = (0..runs[0].len()).collect();
        let [low, high] = bootstrap_interval(all.len(), of);
        // As the table shows them; a value that rounds to zero has no sign.
        [of(&all), low, high].map(|value| (100.0 * value).round() / 100.0 + 0.0)
    }

    /// The mean of a column over the runs of a strategy that have it.
    fn mean_of(&self, problem: &str, strategy: &str, column: &str) -> f64 {
        mean(&self.of(problem, strategy).iter().filter_map(|row| row[column].parse().ok()).collect::<Vec<_>>())
    }

    fn recall(&self, problem: &str, strategy: &str) -> f64 {
        self.mean_of(problem, strategy, "recall")
    }

    fn precision(&self, problem: &str, strategy: &str) -> f64 {
        self.mean_of(problem, strategy, "precision")
    }

    fn knowledge_table(&self) -> String {
        let mut text = String::from(
            "| problem | recall of `random` | `halton` | `greedy` | `auto` | precision of `random` | `auto` | correlation, `random` and `halton` | \
             open loop | all |\n| --- | --- | --- | --- | --- | --- | --- | --- | --- | --- |\n",
        );
        for problem in &self.problems {
            let recalls =
                ["random", "halton", "greedy", "auto"].map(|name| format!("{:.2}", self.recall(problem, name)));
            let precisions = ["random", "auto"].map(|name| format!("{:.2}", self.precision(problem, name)));
            let all: Vec<&str> = OPEN_LOOP.into_iter().chain(self.adaptive()).collect();
            let correlations = [&OPEN_LOOP[..2], &OPEN_LOOP, &all].map(|strategies| {
                let [value, low, high] = self.correlation(problem, strategies);
                format!("{value:.2} ({low:.2} to {high:.2})")
            });
            writeln!(
                text,
                "| {problem} | {} | {} | {} |",
                recalls.join(" | "),
                precisions.join(" | "),
                correlations.join(" | ")
            )
            .unwrap();
        }
        text
    }
}

#[test]
fn the_numbers_of_the_page_follow_from_its_runs() {
    let runs = Runs::read();
    let mut page = Page::open("strategies.md");
    page.table("tests", &runs.table(|problem, strategy| runs.cell(problem, strategy)));
    page.table("modes", &runs.table(|problem, strategy| format!("{:.1}", runs.modes(problem, strategy))));
    page.table("knowledge", &runs.knowledge_table());
    page.table("random-functions", &functions_table());

    let problems = &runs.problems;
    assert_eq!(problems.len(), 10, "the page says ten problems");
    for problem in problems {
        assert!(
            runs.of(problem, CONTROL).iter().all(|row| !row["first_failure"].is_empty()),
            "the control finds a failure in every run"
        );
    }
    let [_, slowest] = range(problems.iter().map(|problem| runs.mean(problem, CONTROL)));
    page.says(format!("finds a failure after at most {slowest:.1} tests in the mean"));
    let roundabout = "roundabout-entry:fsm";
    page.says(format!(
        "`random` finds a failure after {:.1} tests, and `auto` after {:.1}",
        runs.mean(roundabout, "random"),
        runs.mean(roundabout, "auto")
    ));
    let nothing =
        problems.iter().filter(|problem| runs.of(problem, "greedy").iter().all(|row| row["first_failure"].is_empty()));
    page.says(format!("finds nothing at all in {} of the problems", nothing.count()));
    let is_more = |problem: &str, search: &str| runs.modes(problem, search) > runs.modes(problem, "random");
    let of_auto = problems.iter().filter(|problem| is_more(problem, "auto")).count();
    let not_all =
        problems.iter().filter(|problem| runs.adaptive().iter().any(|search| !is_more(problem, search))).count();
    page.says(format!("`auto` finds more kinds than `random` in {of_auto} of the problems. In {not_all} of them, another search does not"));
    for problem in problems.iter().filter(|problem| problem.starts_with("roundabout")) {
        assert!(runs.adaptive().iter().all(|search| runs.mean(problem, search) > runs.mean(problem, CONTROL)));
    }
    let intervals =
        |strategies: &[&str]| problems.iter().map(|problem| runs.correlation(problem, strategies)).collect::<Vec<_>>();
    let contains = intervals(&OPEN_LOOP[..2]).iter().filter(|[_, low, high]| *low <= 0.0 && 0.0 <= *high).count();
    page.says(format!("the interval of the correlation contains 0 in {contains} of the problems"));
    let open_loop = intervals(&OPEN_LOOP);
    let [helps, harms] =
        [open_loop.iter().filter(|one| one[2] < 0.0).count(), open_loop.iter().filter(|one| one[1] > 0.0).count()];
    page.says(format!(
        "a lower dispersion goes with a higher recall in {helps} problems, and with a lower recall in {harms}"
    ));
    for problem in problems {
        let holes = |name: &str| runs.mean_of(problem, name, "dispersion");
        assert!(runs.strategies.iter().all(|name| holes(name) >= holes("greedy")), "greedy has the smallest holes");
    }
    let lowest = problems.iter().filter(|problem| {
        let own = runs.recall(problem, "greedy");
        own < runs.recall(problem, "random") && own < runs.recall(problem, "halton")
    });
    page.says(format!("the lowest recall of the three strategies in open loop in {} of the problems", lowest.count()));
    let higher =
        problems.iter().filter(|problem| runs.recall(problem, "auto") > runs.recall(problem, "random")).count();
    let lower =
        problems.iter().filter(|problem| runs.precision(problem, "auto") < runs.precision(problem, "random")).count();
    page.says(format!(
        "`auto` has a higher recall than `random` in {higher} of the problems, and a lower precision in {lower}"
    ));
    let found = |first: u32, last: u32| {
        let (_, tests) = functions().into_iter().find(|(name, _)| *name == "auto").unwrap();
        let own: Vec<u32> = tests.iter().filter(|run| (first..=last).contains(&run.0)).map(|run| run.1).collect();
        own.iter().filter(|tests| **tests < CENSORED).count()
    };
    let missed = 300 - found(1000, 1299);
    page.says(format!(
        "`auto` does not find the failure of {missed} of the 300 functions. 22 of the {missed} have at least seven"
    ));
    page.given(&[
        "the random functions 0 to 199",
        "the random functions 1000 to 1299",
        "the 19 requirements of ARCH-COMP",
        "A problem is taken if 0.1 to 20 % of 1,000 random tests fail ([all 24]",
    ]);
    page.given(&[
        "Each strategy has 30 runs of 150 tests on each problem, in batches of 16",
        "counts as its 150 tests",
        "if it is not 30",
        "the share of 20,000 random tests",
        "among the 150 tests of a run",
        "compared with the 20,000 random tests",
        "Its 95 % bootstrap interval",
        "A value below 0 means",
        "Within 150 tests, `auto`",
    ]);
    page.given(&[
        "If 30 tests beyond the opening",
        "(decision 083)",
        "the volume of the failure (0.05 % to 0.5 %",
        "the functions 0 to 199. The table",
        "one run of 300 tests, in batches of 16",
        "a run without a failure as 301",
    ]);
    page.given(&["the `auto` of commit 7640a8d9, found the failure of 41 of the first 60 functions, and of 208 of the 300; the upper one of the two middle runs took 51 tests", "failures of 0.03 % to 0.3 %", "found 118 of 200 failures, and the second stage alone 176", "the functions from 1000 on were run", "functions from 1000 on"]);
    page.close();
}

#[test]
fn each_problem_was_taken_by_the_rule_and_each_strategy_has_thirty_runs_on_it() {
    let runs = Runs::read();
    let screened = rows(include_bytes!("../../data/strategies-screen.csv"));
    for row in &screened {
        let share = number(row, "failing") / number(row, "tests");
        assert_eq!(row["taken"] == "1", (0.001..=0.2).contains(&share), "{row:?}");
    }
    let taken: Vec<&str> = screened.iter().filter(|row| row["taken"] == "1").map(|row| row["problem"]).collect();
    assert_eq!(runs.problems, taken);
    for problem in &runs.problems {
        for strategy in &runs.strategies {
            let seeds: Vec<&str> = runs.of(problem, strategy).iter().map(|row| row["seed"]).collect();
            assert_eq!(seeds, (1..=30).map(|seed| seed.to_string()).collect::<Vec<_>>(), "{problem} {strategy}");
        }
    }
}

#[test]
fn each_strategy_has_a_run_of_each_function() {
    for (strategy, runs) in functions() {
        let functions: Vec<u32> = runs.iter().map(|run| run.0).collect();
        assert_eq!(functions, (1000..1300).collect::<Vec<_>>(), "{strategy}");
        assert!(runs.iter().all(|run| (1..=CENSORED).contains(&run.1)));
    }
}
