//! Paired statistics over scenarios: does a strategy kill more mutants than random tests, and does better coverage go with a higher score?

use super::graded::Graded;
use paracosm::analysis::statistics::{bootstrap_interval, holm, signed_rank_p, spearman};
use paracosm::generators::Strategy;
use serde::Serialize;

/// A quantity with one value for each scenario, and its mean.
#[derive(Debug, Clone, Serialize)]
pub(super) struct Finding {
    /// The comparison, such as `lhs - random` or `dispersion ~ score`.
    comparison: String,
    /// The score that it is about: of all mutants, or of those that conditions turn on.
    mutants: &'static str,
    scenarios: usize,
    mean: f64,
    /// The 95 % bootstrap interval of the mean.
    lower: f64,
    upper: f64,
    /// The p-value of Wilcoxon's signed-rank test, corrected for all comparisons of the same mutants (Holm).
    p: f64,
}

/// A score of a suite.
type ScoreOf = fn(&Graded) -> Option<f64>;
/// A question whether a suite is among those that are compared.
type IsAmong = fn(&Graded) -> bool;
/// A measure of the coverage of a suite. A larger number means better coverage.
type CoverageOf = fn(&Graded) -> Option<f64>;

const SCORES: [(&str, ScoreOf); 2] =
    [("all", |suite| Some(suite.score)), ("conditional", |suite| suite.score_conditional)];
const MEASURES: [(&str, CoverageOf); 3] = [
    ("low dispersion", |suite| suite.dispersion.map(|hole| -hole)),
    ("low dispersion of pairs", |suite| suite.pair_dispersion.map(|hole| -hole)),
    ("covered pairs", |suite| suite.pairs),
];

/// The suites whose measures are compared with their scores. Suites of corners have by far the largest holes and the lowest scores, so that they
/// alone could make a correlation.
const AMONG: [(&str, IsAmong); 2] =
    [("", |_| true), (", without random-corners", |suite| suite.strategy != Strategy::RANDOM_CORNERS.name())];

/// Returns all findings: the strategies against random tests, then the measures.
pub(super) fn of(suites: &[Graded]) -> Vec<Finding> {
    let scenarios: Vec<Vec<&Graded>> =
        suites.chunk_by(|a, b| a.scenario == b.scenario).map(|of| of.iter().collect()).collect();
    let mut names: Vec<&str> = suites.iter().map(|suite| suite.strategy.as_str()).collect();
    names.sort_unstable();
    names.dedup();
    let mut all = Vec::new();
    for (mutants, score) in SCORES {
        let against = names.iter().filter(|name| **name != Strategy::RANDOM.name()).map(|name| {
            let difference =
                |of: &Vec<&Graded>| Some(mean(of, name, score)? - mean(of, Strategy::RANDOM.name(), score)?);
            (format!("{name} - random"), scenarios.iter().filter_map(difference).collect::<Vec<f64>>())
        });
        let measured = MEASURES.iter().flat_map(|(measure, coverage)| AMONG.map(|among| (measure, coverage, among)));
        let measured = measured.map(|(measure, coverage, (words, is_among))| {
            let correlation = |of: &Vec<&Graded>| {
                let of = of.iter().filter(|suite| is_among(suite));
                let pairs: Vec<(f64, f64)> = of.filter_map(|suite| Some((coverage(suite)?, score(suite)?))).collect();
                let (x, y): (Vec<f64>, Vec<f64>) = pairs.into_iter().unzip();
                spearman(&x, &y)
            };
            (format!("{measure} ~ score{words}"), scenarios.iter().filter_map(correlation).collect())
        });
        let found: Vec<(String, Vec<f64>)> = against.chain(measured).filter(|(_, values)| !values.is_empty()).collect();
        let p = holm(&found.iter().map(|(_, values)| signed_rank_p(values)).collect::<Vec<_>>());
        all.extend(found.into_iter().zip(p).map(|((comparison, values), p)| finding(comparison, mutants, &values, p)));
    }
    all
}

/// Returns the mean score of a strategy's suites in a scenario.
fn mean(of: &[&Graded], strategy: &str, score: ScoreOf) -> Option<f64> {
    let scores: Vec<f64> =
        of.iter().filter(|suite| suite.strategy == strategy).filter_map(|suite| score(suite)).collect();
    (!scores.is_empty()).then(|| scores.iter().sum::<f64>() / scores.len() as f64)
}

fn finding(comparison: String, mutants: &'static str, values: &[f64], p: f64) -> Finding {
    let mean_of = |indices: &[usize]| indices.iter().map(|index| values[*index]).sum::<f64>() / indices.len() as f64;
    let all: Vec<usize> = (0..values.len()).collect();
    let [lower, upper] = bootstrap_interval(values.len(), mean_of);
    Finding { comparison, mutants, scenarios: values.len(), mean: mean_of(&all), lower, upper, p }
}

#[cfg(test)]
mod tests {
    use super::super::{as_csv, known_rows};
    use super::*;
    use std::path::Path;

    fn suite(scenario: usize, strategy: &str, dispersion: f64, score: f64) -> Graded {
        Graded {
            scenario: scenario.to_string(),
            strategy: strategy.to_owned(),
            seed: 0,
            tests: 40,
            mutants: 100,
            conditional: 0,
            dispersion: Some(dispersion),
            pairs: None,
            pair_dispersion: None,
            score,
            score_conditional: None,
        }
    }

    #[test]
    fn strategies_are_paired_by_scenario_and_measures_are_ranked_within_each() {
        // In each of six scenarios, `lhs` has the smaller hole and kills more.
        let of = |scenario| {
            let base = 0.1 * scenario as f64;
            let random =
                [(0.30, base + 0.1), (0.25, base + 0.2)].map(|(hole, score)| suite(scenario, "random", hole, score));
            let lhs = [(0.20, base + 0.3), (0.15, base + 0.4)].map(|(hole, score)| suite(scenario, "lhs", hole, score));
            random.into_iter().chain(lhs)
        };
        let found = super::of(&(0..6).flat_map(of).collect::<Vec<_>>());
        let words: Vec<&str> = found.iter().map(|one| one.comparison.as_str()).collect();
        let expected = ["lhs - random", "low dispersion ~ score", "low dispersion ~ score, without random-corners"];
        assert_eq!(words, expected);
        let [lhs, dispersion, _] = &found[..] else { panic!("{found:?}") };
        assert!(lhs.scenarios == 6 && (lhs.mean - 0.2).abs() < 1e-12 && (dispersion.mean - 1.0).abs() < 1e-12);
        // All six of one sign have p = 2 / 2^6, and three comparisons multiply it by three (Holm).
        assert!([lhs, dispersion].iter().all(|one| (one.p - 6.0 / 64.0).abs() < 1e-12), "{found:?}");
    }

    /// `UPDATE_GOLDEN=1` writes the statistics anew.
    #[test]
    fn the_statistics_in_the_repository_are_those_of_the_suites_in_the_repository() {
        let data = Path::new(env!("CARGO_MANIFEST_DIR")).join("data");
        let suites: Vec<Graded> = known_rows(&data.join("audit-strategies.csv")).unwrap();
        let file = data.join("audit-statistics.csv");
        let fresh = as_csv(&super::of(&suites)).unwrap();
        if std::env::var_os("UPDATE_GOLDEN").is_some() {
            std::fs::write(&file, &fresh).unwrap();
        }
        assert!(std::fs::read(file).unwrap() == fresh, "the statistics are not those of the suites");
    }
}
