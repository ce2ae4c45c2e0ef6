//! Checks the tables of the page on searches for failures of a benchmark: they say what the CSV of all runs says. If a table is old, the test prints
//! it; UPDATE_GOLDEN=1 writes it into the page.

mod page;

use page::assert_tables;
use paracosm::analysis::statistics::{bootstrap_interval, vargha_delaney};
use std::collections::BTreeMap;
use std::fmt::Write;

const RUNS: &str = include_str!("../data/arch.csv");

/// The number of tests of a run, and the number of runs of each search on each requirement.
const BUDGET: f64 = 300.0;
const SEEDS: usize = 30;

const OURS: [&str; 3] = ["auto", "cmaes", "gp-cmaes"];
const CONTROLS: [&str; 2] = ["random", "random-corners"];
const OUTSIDE: [&str; 6] = ["optuna-tpe", "pycma", "scipy-de", "scipy-dual-annealing", "verifai-ce", "verifai-mab"];

/// The numbers of tests to the first failure, `None` without a failure, by requirement and search.
struct Runs {
    requirements: Vec<&'static str>,
    tests: BTreeMap<(&'static str, &'static str), Vec<Option<u32>>>,
}

impl Runs {
    fn read() -> Self {
        let mut runs = Self { requirements: Vec::new(), tests: BTreeMap::new() };
        for line in RUNS.lines().skip(1) {
            let [requirement, search, seed, budget, tests] = line.split(',').collect::<Vec<_>>()[..] else {
                panic!("{line}")
            };
            if runs.requirements.last() != Some(&requirement) {
                runs.requirements.push(requirement);
            }
            let of = runs.tests.entry((requirement, search)).or_default();
            assert_eq!((seed, budget), (&of.len().to_string()[..], "300"), "{line}");
            of.push((!tests.is_empty()).then(|| tests.parse().unwrap()));
        }
        runs
    }

    /// The numbers of tests; a run without a failure counts as its budget.
    fn counts(&self, requirement: &str, search: &str) -> Vec<f64> {
        self.tests[&(requirement, search)].iter().map(|tests| tests.map_or(BUDGET, f64::from)).collect()
    }

    /// The mean number of tests, and the number of runs with a failure.
    fn cell(&self, requirement: &str, search: &str) -> String {
        let found = self.tests[&(requirement, search)].iter().flatten().count();
        let mean = mean(&self.counts(requirement, search));
        if found == SEEDS { format!("{mean:.1}") } else { format!("{mean:.1} ({found})") }
    }

    fn means(&self, searches: &[&str]) -> String {
        let mut text = String::from("| requirement |");
        searches.iter().for_each(|search| write!(text, " `{search}` |").unwrap());
        text += "\n| --- |";
        searches.iter().for_each(|_| text += " --- |");
        for requirement in &self.requirements {
            write!(text, "\n| {requirement} |").unwrap();
            searches.iter().for_each(|search| write!(text, " {} |", self.cell(requirement, search)).unwrap());
        }
        text + "\n"
    }

    /// The search with the least mean.
    fn best(&self, requirement: &str, among: &[&'static str]) -> (&'static str, f64) {
        let of = |search: &&'static str| (*search, mean(&self.counts(requirement, search)));
        among.iter().map(of).min_by(|a, b| a.1.total_cmp(&b.1)).unwrap()
    }

    /// `true` if a control, or the opening of `auto`, needs less than ten tests in the mean.
    fn is_easy(&self, requirement: &str) -> bool {
        self.best(requirement, &["random", "random-corners", "auto"]).1 < 10.0
    }

    fn ratios(&self, search: &str) -> Vec<f64> {
        let ratio = |name: &&str| mean(&self.counts(name, search)) / self.best(name, &OUTSIDE).1;
        self.requirements.iter().map(ratio).collect()
    }

    fn against_the_best(&self) -> String {
        let mut text = String::from(
            "| requirement | best other search | its mean | `auto` | ratio | P(`auto` needs more tests) | best control |\n\
             | --- | --- | --- | --- | --- | --- | --- |\n",
        );
        for (requirement, ratio) in self.requirements.iter().zip(self.ratios("auto")) {
            let (search, best) = self.best(requirement, &OUTSIDE);
            let (control, least) = self.best(requirement, &CONTROLS);
            let (own, other) = (self.counts(requirement, "auto"), self.counts(requirement, search));
            // Runs are not paired: each of the numbers below SEEDS² stands for a run of each search.
            let [low, high] = bootstrap_interval(SEEDS * SEEDS, |drawn| {
                let of = |counts: &[f64], run: fn(usize) -> usize| -> Vec<f64> {
                    drawn[..SEEDS].iter().map(|pair| counts[run(*pair)]).collect()
                };
                vargha_delaney(&of(&own, |pair| pair / SEEDS), &of(&other, |pair| pair % SEEDS))
            });
            writeln!(
                text,
                "| {requirement} | `{search}` | {best:.1} | {:.1} | {ratio:.2} | {:.2} ({low:.2} to {high:.2}) | `{control}` {least:.1} |",
                mean(&own),
                vargha_delaney(&own, &other)
            )
            .unwrap();
        }
        text
    }

    /// The geometric means of the ratios to the best search of another package.
    fn geometric(&self) -> String {
        let hard: Vec<bool> = self.requirements.iter().map(|name| !self.is_easy(name)).collect();
        let count = hard.iter().filter(|hard| **hard).count();
        let mut text =
            format!("| search | all {} requirements | the {count} hard ones |\n| --- | --- | --- |\n", hard.len());
        for search in OURS.into_iter().chain(CONTROLS).chain(OUTSIDE) {
            let ratios = self.ratios(search);
            let of = |only_hard: bool| {
                let chosen = ratios.iter().zip(&hard).filter(|(_, hard)| !only_hard || **hard);
                let logs: Vec<f64> = chosen.map(|(ratio, _)| libm::log(*ratio)).collect();
                libm::exp(mean(&logs))
            };
            writeln!(text, "| `{search}` | {:.2} | {:.2} |", of(false), of(true)).unwrap();
        }
        text
    }
}

fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len() as f64
}

#[test]
fn the_tables_of_the_page_say_what_the_csv_says() {
    let runs = Runs::read();
    let ours: Vec<&str> = OURS.into_iter().chain(CONTROLS).collect();
    let tables = [
        ("ratios", runs.against_the_best()),
        ("geometric", runs.geometric()),
        ("ours", runs.means(&ours)),
        ("others", runs.means(&OUTSIDE)),
    ];
    assert_tables("arch.md", &tables);
}

#[test]
fn every_search_has_thirty_runs_on_every_requirement() {
    let runs = Runs::read();
    let text = include_str!("../systems/requirements.toml");
    let names = text.lines().filter_map(|line| line.strip_prefix("name = \"")?.strip_suffix('"'));
    assert_eq!(runs.requirements, names.collect::<Vec<_>>());
    for requirement in &runs.requirements {
        for search in OURS.into_iter().chain(CONTROLS).chain(OUTSIDE) {
            let tests = &runs.tests[&(*requirement, search)];
            assert_eq!(tests.len(), SEEDS, "{requirement} {search}");
            assert!(tests.iter().flatten().all(|tests| f64::from(*tests) <= BUDGET && *tests > 0));
        }
    }
}
