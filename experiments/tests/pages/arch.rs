//! Computes the numbers of the page on searches for failures of a benchmark.

use crate::page::Page;
use paracosm::analysis::statistics::{bootstrap_interval, vargha_delaney};
use std::collections::BTreeMap;
use std::fmt::Write;

const RUNS: &str = include_str!("../../data/arch.csv");

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

/// The geometric mean of the ratios of a search, over all requirements or over the hard ones.
fn geometric_mean(runs: &Runs, search: &str, only_hard: bool) -> f64 {
    let ratios = runs.requirements.iter().zip(runs.ratios(search));
    let logs: Vec<f64> =
        ratios.filter(|(name, _)| !only_hard || !runs.is_easy(name)).map(|(_, ratio)| libm::log(ratio)).collect();
    libm::exp(mean(&logs))
}

#[test]
fn the_numbers_of_the_page_follow_from_its_runs() {
    let runs = Runs::read();
    let ours: Vec<&str> = OURS.into_iter().chain(CONTROLS).collect();
    let mut page = Page::open("arch.md");
    page.table("ratios", &runs.against_the_best());
    page.table("geometric", &runs.geometric());
    page.table("ours", &runs.means(&ours));
    page.table("others", &runs.means(&OUTSIDE));

    let [all, hard] = [false, true].map(|only_hard| geometric_mean(&runs, "auto", only_hard));
    page.says(format!("Over {} requirements, `auto` needs {all:.2} times the tests", runs.requirements.len()));
    page.says(format!("On the ten hard requirements it needs {hard:.2} times the tests"));
    assert_eq!(runs.requirements.iter().filter(|name| !runs.is_easy(name)).count(), 10);
    let above: Vec<&str> = runs
        .requirements
        .iter()
        .zip(runs.ratios("auto"))
        .filter(|(_, ratio)| *ratio > 1.5)
        .map(|(name, _)| *name)
        .collect();
    assert_eq!(above, ["AT51", "AT52", "AT53", "AT54"]);
    page.says("`auto` is above 1.5 times the best other search on four requirements, AT51 to AT54");
    let random: Vec<f64> = above.iter().map(|name| mean(&runs.counts(name, "random"))).collect();
    let [least, most] = crate::rows::range(random);
    page.says(format!("random tests find a failure after {least:.0} to {most:.0} tests in the mean"));
    for name in ["CC5", "AFC29"] {
        let (own, control) = (mean(&runs.counts(name, "auto")), mean(&runs.counts(name, "random-corners")));
        assert!(own < runs.best(name, &OUTSIDE).1 && own > control);
    }
    let at6c = runs.tests[&("AT6c", "auto")].iter().map(|tests| tests.unwrap()).max().unwrap();
    page.says(format!("none of its runs takes more than {at6c} tests"));
    let best = runs.best("AT6c", &OUTSIDE).0;
    page.says(format!("(P is {:.2})", vargha_delaney(&runs.counts("AT6c", "auto"), &runs.counts("AT6c", best))));
    let found = |search: &str| runs.tests[&("CC4", search)].iter().flatten().count();
    assert!(OURS.into_iter().chain(CONTROLS).chain(OUTSIDE).all(|search| search == "gp-cmaes" || found(search) <= 1));
    page.says(format!("only `gp-cmaes` finds more than one failure in {SEEDS} runs, namely {}", found("gp-cmaes")));
    page.given_cells("| search | package | settings |", 3);
    page.given(&[
        "after 4,000 tests of two searches",
        "([decision 040]",
        "They took 44 minutes on two cores",
        "below 0.008 between 1 and 5 s after an edge of the pedal. In our model the greatest error there is 0.0036",
        "A run has at most 300 tests",
        "Each search has 30 runs, with the seeds 0 to 29. A run without a failure counts as 300",
    ]);
    page.given(&[
        "(bayesian-optimization 3.4.0)",
        "a proposal in 40 dimensions",
        "with its 95 % bootstrap interval",
        "so that 0.5 means no difference",
        "whether a gear stays for 2.5 s",
        "The ratio of the best one itself is 1",
        "Our aim was 0.7",
    ]);
    page.close();
}

#[test]
fn every_search_has_thirty_runs_on_every_requirement() {
    let runs = Runs::read();
    let text = include_str!("../../systems/requirements.toml");
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
