//! Compares the estimates of `paracosm::analysis::likelihood` with known probabilities, and counts how often the
//! confidence intervals hold the true probability, in 100 runs of each case.
//!
//!     cargo run --release --example likelihood

use paracosm::analysis::likelihood::{Likelihood, Method, Question, estimate};
use paracosm::space::distribution::normal_quantile;

type System = (&'static str, usize, f64, fn(&[f64]) -> f64);

const RARE: [System; 7] = [
    ("plane", 2, 1e-6, plane),
    ("plane", 10, 1e-6, plane),
    ("plane", 100, 1e-6, plane),
    ("two sides", 2, 1e-6, |x| 4.891_638_475_698_59 - normal_quantile(x[0]).abs()),
    ("corner", 2, 1e-6, |x| x[0].max(x[1]) - 1e-3),
    ("ring", 2, 1e-6, |x| {
        let square: f64 = x.iter().map(|u| normal_quantile(*u) * normal_quantile(*u)).sum();
        5.256_521_769_756_932 - square.sqrt()
    }),
    ("waiting times", 2, 1e-6, |x| 16.688_420_790_859_92 + (libm::log(x[0]) + libm::log(x[1]))),
];

const COMMON: [System; 2] =
    [("triangle", 2, 0.08, |x| x[0] + x[1] - 0.4), ("corner", 2, 0.01, |x| x[0].max(x[1]) - 0.1)];

fn plane(x: &[f64]) -> f64 {
    4.753_424_308_822_899 - x.iter().map(|u| normal_quantile(*u)).sum::<f64>() / (x.len() as f64).sqrt()
}

fn main() {
    println!(
        "method,system,dims,truth,budget,median error of 20,median/truth,mean/truth,covered of 100,median width/truth"
    );
    for system in COMMON {
        show(Method::MonteCarlo, 5_000, system);
        show(Method::Qmc, 5_000, system);
    }
    for system in RARE {
        show(Method::Subset, 100_000, system);
    }
    show(Method::Subset, 10_000, RARE[0]);
    show(Method::Subset, 3_000, RARE[0]);
}

fn show(method: Method, budget: usize, (name, dims, truth, robustness): System) {
    let run = |seed| {
        let question = Question { method, budget, confidence: 0.95, seed };
        let mut evaluate = |points: &[Vec<f64>]| Ok(points.iter().map(|x| Some(robustness(x))).collect());
        estimate(&question, dims, &mut evaluate).expect("the question is one")
    };
    let found: Vec<Likelihood> = (0..100).map(run).collect();
    let errors = found[..20].iter().map(|found| (found.probability / truth - 1.0).abs());
    let shares = found.iter().map(|found| found.probability / truth);
    let mean = shares.clone().sum::<f64>() / 100.0;
    let covered = found.iter().filter(|found| found.lower <= truth && truth <= found.upper).count();
    let width = found.iter().map(|found| (found.upper - found.lower) / truth);
    println!(
        "{method},{name},{dims},{truth:e},{budget},{:.3},{:.3},{mean:.3},{covered},{:.2}",
        median(errors),
        median(shares),
        median(width)
    );
}

fn median(values: impl Iterator<Item = f64>) -> f64 {
    let mut values: Vec<f64> = values.collect();
    values.sort_by(f64::total_cmp);
    paracosm::analysis::statistics::quantile(&values, 0.5)
}
