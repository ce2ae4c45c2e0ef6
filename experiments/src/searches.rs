//! Compares strategies on problems that no choice was made on: scenarios of the catalogue, each with several drivers.
//!
//! The problems follow from a rule, so that nobody picks them by their results. Each scenario takes a few
//! milliseconds a test, and no choice about a strategy used it. Each is tried with each driver, with the friction open besides
//! its usual open parameters. A problem is one in which some but not many random tests fail.

use crate::sampling::write_csv;
use crate::{Done, logged, print, scenario};
use indicatif::ProgressBar;
use paracosm::StudyBuilder;
use paracosm::analysis::bench::{Bench, ReferenceMap, Row, Target};
use paracosm::generators::Strategy;
use std::collections::BTreeMap;
use std::error::Error;
use std::num::NonZeroUsize;
use std::path::Path;
use std::sync::atomic::AtomicBool;
use std::thread;

const SCENARIOS: [&str; 4] = ["ncap-ccrb", "ncap-cpna", "ncap-cpnco", "roundabout-entry"];
const DRIVERS: [&str; 6] = ["aeb", "planner", "cc", "rss", "fsm", "reg157"];
const OPENED: &str = "friction";

/// The number of random tests that decide whether a problem is taken, and the least and the greatest share that fails.
const SCREENED: usize = 1000;
const SHARE: [f64; 2] = [0.001, 0.2];

const STRATEGIES: [Strategy; 12] = [
    Strategy::RANDOM,
    Strategy::HALTON,
    Strategy::GREEDY,
    Strategy::RANDOM_CORNERS,
    Strategy::ANNEAL,
    Strategy::PSO,
    Strategy::NELDER_MEAD,
    Strategy::CMAES,
    Strategy::GP_CMAES,
    Strategy::BAYES,
    Strategy::BOUNDARY,
    Strategy::AUTO,
];
/// The number of tests of a run, and of a reference map. A strategy has 30 runs on each problem.
const BUDGET: usize = 150;
const MAP: usize = 20_000;

type Failure = Box<dyn Error + Send + Sync>;

/// Runs the study and writes it to a folder.
pub fn run(out: &Path, bar: &ProgressBar) -> Done {
    bar.set_length((SCENARIOS.len() * DRIVERS.len() * SCREENED) as u64);
    let targets = problems(out, bar)?;
    let (jobs, stop) = (thread::available_parallelism().unwrap_or(NonZeroUsize::MIN), AtomicBool::new(false));
    let bench = Bench { budget: BUDGET, ..Bench::of(&STRATEGIES, targets)? };
    bench.check()?;
    bar.reset();
    bar.set_length((bench.targets.len() * MAP) as u64);
    let mut maps = BTreeMap::new();
    let mut counts = vec![["problem", "tests", "failing"].map(str::to_owned).to_vec()];
    for target in &bench.targets {
        let study = target.as_study().expect("all problems are studies");
        let map = ReferenceMap::make(study, MAP, jobs, &stop, |_| bar.inc(1))?;
        let (tests, failing) = map.counts();
        counts.push(vec![target.name().to_owned(), tests.to_string(), failing.to_string()]);
        maps.insert(target.name().to_owned(), map);
    }
    write_csv(&out.join("strategies-maps.csv"), &counts)?;
    bar.reset();
    bar.set_length(bench.runs() as u64);
    let benched = bench.run(jobs, &maps, Vec::new(), &stop, |_| {
        bar.inc(1);
        Ok(())
    })?;
    bar.finish_and_clear();
    let mut rows = vec![COLUMNS.map(str::to_owned).to_vec()];
    rows.extend(benched.rows.iter().map(fields));
    write_csv(&out.join("strategies.csv"), &rows)?;
    print(&counts.iter().map(|row| row.join(",") + "\n").collect::<String>())
}

/// Runs the random tests of all candidates, writes how many of them fail, and returns the candidates that are problems.
fn problems(out: &Path, bar: &ProgressBar) -> Result<Vec<Target>, Failure> {
    let mut rows = vec![["problem", "tests", "failing", "taken"].map(str::to_owned).to_vec()];
    let mut targets = Vec::new();
    for name in SCENARIOS {
        for driver in DRIVERS {
            let begun = || Ok::<StudyBuilder, paracosm::Error>(scenario(name)?.driver(driver).open(OPENED));
            let random = begun()?.strategy(Strategy::RANDOM).budget(SCREENED).build()?;
            let failing = logged(&random, bar)?.trials().iter().filter(|trial| trial.is_failure()).count();
            let is_taken = (SHARE[0]..=SHARE[1]).contains(&(failing as f64 / SCREENED as f64));
            let problem = format!("{name}:{driver}");
            let numbers = [SCREENED, failing, usize::from(is_taken)].map(|number| number.to_string());
            rows.push([problem.clone()].into_iter().chain(numbers).collect());
            if is_taken {
                targets.push(Target::study(problem, begun()?.build()?));
            }
        }
    }
    write_csv(&out.join("strategies-screen.csv"), &rows)?;
    Ok(targets)
}

const COLUMNS: [&str; 8] =
    ["problem", "strategy", "seed", "first_failure", "modes", "recall", "precision", "dispersion"];

fn fields(row: &Row) -> Vec<String> {
    let share = |share: Option<f64>| share.map_or(String::new(), |share| format!("{share:.6}"));
    let count = |count: Option<usize>| count.map_or(String::new(), |count| count.to_string());
    let of = [row.scenario.clone(), row.strategy.to_string(), row.seed.to_string()];
    let found = [count(row.first_failure), count(row.modes)];
    of.into_iter().chain(found).chain([row.recall, row.precision, row.dispersion].map(share)).collect()
}
