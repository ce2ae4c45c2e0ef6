//! Measures how well a small campaign knows where tests fail, in the pedestrian study with three parameters. It
//! compares `boundary` with sampling.
//!
//! A map of 20,000 random tests, none of which belongs to a campaign, is the reference. At every test of the map, the
//! campaign's prediction is compared with the verdict. A prediction is the verdict of the nearest test, or the answer
//! of a Gaussian-process model of the campaign's verdicts. The accuracy is the share of the map that is predicted
//! right. The accuracy of predicting "passes" everywhere is printed for comparison.

use crate::{Done, print, scenario, write};
use indicatif::ProgressBar;
use paracosm::analysis::statistics::quantile;
use paracosm::generators::{FailureModel, Strategy};
use paracosm::space::Point;
use paracosm::{Campaign, Error, Study};
use std::path::Path;

const SIZES: [usize; 5] = [25, 50, 100, 200, 400];
const SEEDS: u64 = 10;
const STRATEGIES: [Strategy; 3] = [Strategy::BOUNDARY, Strategy::HALTON, Strategy::RANDOM];
/// The number of tests of the map, and their seed.
const MAP: usize = 20_000;
const MAP_SEED: u64 = 1_000_000;
/// The probability from which on the model counts as sure.
const SURE: f64 = 0.95;

/// Tests with their robustness.
#[derive(Default)]
struct Tests {
    points: Vec<Point>,
    robustness: Vec<f64>,
}

/// The share of the map that a campaign predicts right, by each kind of prediction.
struct Sample {
    strategy: Strategy,
    seed: u64,
    tests: usize,
    failures: usize,
    nearest: f64,
    model: f64,
    /// The mean squared difference of probability and outcome (Brier 1950).
    brier: f64,
    /// The share of the map where the model is at least 95 % sure; `sure_right` is the share of that part that the
    /// model predicts correctly.
    sure: f64,
    sure_right: f64,
}

pub(crate) fn run(out: &Path, bar: &ProgressBar) -> Done {
    bar.set_length(1 + STRATEGIES.len() as u64 * SEEDS);
    let map = campaign(Strategy::RANDOM, MAP_SEED, MAP)?;
    bar.inc(1);
    let mut samples = Vec::new();
    for strategy in STRATEGIES {
        for seed in 0..SEEDS {
            let tests = campaign(strategy, seed, SIZES[SIZES.len() - 1])?;
            for size in SIZES {
                samples.push(sample(strategy, seed, &tests.first(size), &map)?);
            }
            bar.inc(1);
        }
    }
    bar.finish_and_clear();
    let passing = map.robustness.iter().filter(|robustness| !robustness.is_sign_negative()).count();
    write_samples(&out.join("boundary.csv"), &samples, passing as f64 / MAP as f64)?;
    print(&format!("{}always \"passes\": {:.3}\n", table(&samples), passing as f64 / MAP as f64))
}

fn study(strategy: Strategy, seed: u64, budget: usize) -> Result<Study, Error> {
    scenario("pedestrian-crossing")?.open("friction").strategy(strategy).seed(seed).budget(budget).build()
}

fn campaign(strategy: Strategy, seed: u64, budget: usize) -> Result<Tests, Error> {
    let study = study(strategy, seed, budget)?;
    let log = Campaign::new(&study)?.into_log()?;
    let objective = |trial| log.scales().objective(trial).unwrap_or(f64::NAN);
    let points = log.test_set()?.points;
    assert_eq!(points.len(), log.trials().len(), "every test of the pedestrian study ends with a verdict");
    Ok(Tests { points, robustness: log.trials().iter().map(objective).collect() })
}

impl Tests {
    fn first(&self, n: usize) -> Self {
        Self { points: self.points[..n].to_vec(), robustness: self.robustness[..n].to_vec() }
    }
}

fn sample(strategy: Strategy, seed: u64, tests: &Tests, map: &Tests) -> Result<Sample, Error> {
    let study = study(strategy, seed, tests.points.len())?;
    let model = FailureModel::fit(study.space(), &tests.points, &tests.robustness).expect("there are tests");
    let probabilities = model.probabilities(&map.points);
    let fails = |robustness: &f64| robustness.is_sign_negative();
    let share = |right: usize| right as f64 / map.points.len() as f64;
    let told = map.robustness.iter().zip(&probabilities);
    let model = share(told.clone().filter(|(robustness, p)| fails(robustness) == (**p > 0.5)).count());
    let square =
        |(robustness, p): (&f64, &f64)| (p - f64::from(fails(robustness))) * (p - f64::from(fails(robustness)));
    let brier = told.clone().map(square).sum::<f64>() / map.points.len() as f64;
    let sure = told.clone().filter(|(_, p)| (**p - 0.5).abs() >= SURE - 0.5);
    let sure_right = sure.clone().filter(|(robustness, p)| fails(robustness) == (**p > 0.5)).count();
    let (sure, sure_right) = (share(sure.clone().count()), sure_right as f64 / sure.count().max(1) as f64);
    let nearest = |at: &Point| {
        let square =
            |other: &Point| at.continuous.iter().zip(&other.continuous).map(|(a, b)| (a - b) * (a - b)).sum::<f64>();
        let nearest =
            (0..tests.points.len()).min_by(|&a, &b| square(&tests.points[a]).total_cmp(&square(&tests.points[b])));
        fails(&tests.robustness[nearest.expect("there are tests")])
    };
    let nearest = share(map.points.iter().zip(&map.robustness).filter(|(at, r)| nearest(at) == fails(r)).count());
    let failures = tests.robustness.iter().filter(|robustness| fails(robustness)).count();
    Ok(Sample { strategy, seed, tests: tests.points.len(), failures, nearest, model, brier, sure, sure_right })
}

/// Writes a row for each sample, after a row for the prediction that all tests pass.
fn write_samples(path: &Path, samples: &[Sample], passing: f64) -> Done {
    let mut text = "strategy,seed,tests,failures,nearest,model,brier,sure,sure_right\n".to_owned();
    text += &format!("none,,0,0,{passing},{passing},,,\n");
    for Sample { strategy, seed, tests, failures, nearest, model, brier, sure, sure_right } in samples {
        text += &format!("{strategy},{seed},{tests},{failures},{nearest},{model},{brier},{sure},{sure_right}\n");
    }
    write(path, text)
}

/// Returns a table of medians, with the worst and the best value over the seeds.
fn table(samples: &[Sample]) -> String {
    let mut text = format!(
        "{:<10}{:>6}{:>10}{:>24}{:>24}{:>8}{:>8}{:>8}\n",
        "strategy", "tests", "failures", "nearest test right", "model right", "Brier", "sure", "right"
    );
    for strategy in STRATEGIES {
        for size in SIZES {
            let of = |measure: fn(&Sample) -> f64| {
                let those = samples.iter().filter(|sample| sample.strategy == strategy && sample.tests == size);
                let mut values: Vec<f64> = those.map(measure).collect();
                values.sort_by(f64::total_cmp);
                [0.5, 0.0, 1.0].map(|q| quantile(&values, q))
            };
            let range = |[median, worst, best]: [f64; 3]| format!("{median:.3} ({worst:.3}..{best:.3})");
            text += &format!(
                "{strategy:<10}{size:>6}{:>10}{:>24}{:>24}{:>8.4}{:>8.3}{:>8.3}\n",
                of(|sample| sample.failures as f64)[0],
                range(of(|sample| sample.nearest)),
                range(of(|sample| sample.model)),
                of(|sample| sample.brier)[0],
                of(|sample| sample.sure)[0],
                of(|sample| sample.sure_right)[0]
            );
        }
    }
    text
}
