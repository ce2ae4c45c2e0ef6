//! Suites of one size by several strategies, on mutants that were fixed before: does an even suite kill more mutants?

use super::graded::Graded;
use super::{SCREEN, files, known_rows, name_of, statistics, study, write_rows};
use crate::{Done, print};
use indicatif::ProgressBar;
use paracosm::Study;
use paracosm::analysis::audit::{Runs, Score, Screen, Suite};
use paracosm::analysis::{Coverage, Limit};
use paracosm::campaign::TestSet;
use paracosm::coverage::{Bracket, Measure};
use paracosm::generators::Strategy;
use std::path::Path;
use std::time::Duration;

/// The strategies on trial. Random points are the baseline.
const STRATEGIES: [Strategy; 6] = [
    Strategy::RANDOM,
    Strategy::RANDOM_CORNERS,
    Strategy::LHS,
    Strategy::HALTON_SCRAMBLED,
    Strategy::SOBOL_OWEN,
    Strategy::GREEDY,
];
const SEEDS: u64 = 3;
/// The number of tests of a suite.
const TESTS: usize = 40;
const MUTANTS: usize = 64;
/// The time for the coverage of a suite. A measure that is not exact by then is left out, and the row says so.
const LIMIT: Limit = Limit::Time(Duration::from_secs(60));

/// Runs the study and writes `audit-strategies.csv` and `audit-statistics.csv` to a folder.
pub fn run(out: &Path, bar: &ProgressBar) -> Done {
    let table = out.join("audit-strategies.csv");
    let mut suites: Vec<Graded> = known_rows(&table)?;
    let catalogue = paracosm::catalogue();
    let own = catalogue.programs().iter().map(|program| (program.name().to_owned(), program.name().to_owned()));
    let of_files = files().into_iter().map(|file| (name_of(&file), file.to_string_lossy().into_owned()));
    for (name, source) in own.chain(of_files) {
        if suites.iter().any(|suite| suite.scenario == name) {
            continue;
        }
        let builder = study(&source)?;
        // The ranges of a distribution are open as a whole.
        let study = if name == source { builder.build()? } else { Suite::of_listed(&builder)?.0 };
        suites.extend(of_scenario(&name, &study, bar)?);
        write_rows(&table, &suites)?;
    }
    bar.finish_and_clear();
    write_rows(&out.join("audit-statistics.csv"), &statistics::of(&suites))
}

/// Returns a row for each suite of a scenario; none if no mutant is noticed.
fn of_scenario(
    name: &str,
    study: &Study,
    bar: &ProgressBar,
) -> Result<Vec<Graded>, Box<dyn std::error::Error + Send + Sync>> {
    let runs = Runs::default();
    // The mutants are fixed before any suite is made.
    let screen = Screen::of(study, MUTANTS, SCREEN, 0, &runs)?;
    let of_all = STRATEGIES.into_iter().flat_map(|strategy| (0..SEEDS).map(move |seed| (strategy, seed)));
    let of_all: Vec<(Strategy, u64)> = of_all.collect();
    bar.inc_length(of_all.len() as u64);
    if screen.mutants.is_empty() {
        bar.inc(of_all.len() as u64);
        print(&format!("{name}: no defect is noticed in {} random tests\n", screen.tests))?;
        return Ok(Vec::new());
    }
    let suites = of_all.iter().map(|(strategy, seed)| Suite::of_strategy(study, *strategy, TESTS, Some(*seed)));
    let suites = suites.collect::<Result<Vec<_>, _>>()?;
    let scores = screen.scores(study, &suites, &runs)?;
    let of_one = |(((strategy, seed), suite), score): (((&Strategy, &u64), &Suite), &Score)| {
        bar.inc(1);
        let [dispersion, pairs, pair_dispersion] = coverage(study, suite)?;
        let conditional = score.by_conditions.iter().skip(1);
        let (killed, conditional) = conditional.fold((0, 0), |sum, one| (sum.0 + one.killed, sum.1 + one.counted));
        Ok(Graded {
            scenario: name.to_owned(),
            strategy: strategy.to_string(),
            seed: *seed,
            tests: suite.points.len(),
            mutants: score.all.counted,
            conditional,
            dispersion,
            pairs,
            pair_dispersion,
            score: score.all.killed as f64 / score.all.counted as f64,
            score_conditional: (conditional > 0).then(|| killed as f64 / conditional as f64),
        })
    };
    of_all.iter().map(|(strategy, seed)| (strategy, seed)).zip(&suites).zip(&scores).map(of_one).collect()
}

/// Returns the dispersion, the share of covered pairs of values, and the dispersion in pairs of parameters. A number is `None` if the
/// space has no such measure, or if the measure is not exact.
fn coverage(study: &Study, suite: &Suite) -> Result<[Option<f64>; 3], paracosm::Error> {
    let tests = TestSet::new(study.space().clone(), suite.points.clone());
    let measures = [Measure::DISPERSION, Measure::K_WISE, Measure::K_WISE_DISPERSION];
    let found = Coverage::of(&tests, &measures, None, LIMIT)?;
    let exact = |of: Option<Bracket>| of.filter(Bracket::is_exact).map(|of| of.upper);
    let dispersion = exact(found.continuous.as_ref().and_then(|all| all.bracket(Measure::DISPERSION)));
    let discrete = found.discrete.flatten().filter(|pairs| pairs.k == 2);
    Ok([dispersion, discrete.map(|pairs| pairs.ratio), exact(found.k_wise_dispersion.map(|hole| hole.volume))])
}
