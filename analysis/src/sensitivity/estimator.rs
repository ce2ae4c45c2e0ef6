//! Estimates Sobol indices from the values of pairs of tests and of their mixtures.

use super::{Explained, Index, Indices};
use crate::statistics::bootstrap_interval;

/// The values of a quantity at the tests of a design. All lists have a value for each pair of tests.
#[derive(Debug, Clone, Default)]
pub(super) struct Values {
    /// The values at the first tests of the pairs.
    pub first: Vec<f64>,
    /// The values at the second tests of the pairs.
    pub second: Vec<f64>,
    /// For each parameter, the values at the first tests with the parameter's value of the second tests.
    pub mixed: Vec<Vec<f64>>,
}

impl Values {
    /// Estimates the indices of the parameters with these names.
    ///
    /// The first-order index is estimated as by Saltelli et al. (Variance based sensitivity analysis of model output, Computer
    /// Physics Communications 181, 2010, table 2, row b). The total index is estimated as by Jansen (Analysis of variance
    /// designs for model output, Computer Physics Communications 117, 1999; row f of the table). The bootstrap draws pairs
    /// (Archer, Saltelli and Sobol', Sensitivity measures, ANOVA-like techniques and the use of bootstrap, 1997).
    pub fn explain(&self, names: &[&str]) -> Explained {
        let pairs = self.first.len();
        let both = || self.first.iter().chain(&self.second);
        let mean = both().sum::<f64>() / (2 * pairs) as f64;
        // A quantity that is the same everywhere has no variance, whatever rounding says.
        let is_constant = both().chain(self.mixed.iter().flatten()).all(|value| *value == self.first[0]);
        if is_constant {
            return Explained { mean, variance: 0.0, parameters: Vec::new() };
        }
        let centred = self.centred();
        let all: Vec<usize> = (0..pairs).collect();
        let mut parameters: Vec<Indices> = names
            .iter()
            .enumerate()
            .map(|(at, name)| Indices {
                name: (*name).to_owned(),
                first_order: index(pairs, &all, |pairs| centred.first_order(at, pairs)),
                total: index(pairs, &all, |pairs| centred.total(at, pairs)),
            })
            .collect();
        parameters.sort_by(|a, b| b.total.estimate.total_cmp(&a.total.estimate));
        Explained { mean, variance: self.variance(&all), parameters }
    }

    /// Returns the values less their mean, because products of values with a large mean have a large error.
    fn centred(&self) -> Self {
        let all = || self.first.iter().chain(&self.second).chain(self.mixed.iter().flatten());
        let mean = all().sum::<f64>() / all().count() as f64;
        let less = |values: &Vec<f64>| values.iter().map(|value| value - mean).collect();
        Self { first: less(&self.first), second: less(&self.second), mixed: self.mixed.iter().map(less).collect() }
    }

    /// Returns the variance of the independent tests of some pairs.
    fn variance(&self, pairs: &[usize]) -> f64 {
        let both = || pairs.iter().flat_map(|&pair| [self.first[pair], self.second[pair]]);
        let count = (2 * pairs.len()) as f64;
        let mean = both().sum::<f64>() / count;
        both().map(|value| (value - mean) * (value - mean)).sum::<f64>() / count
    }

    fn first_order(&self, parameter: usize, pairs: &[usize]) -> f64 {
        let mixed = &self.mixed[parameter];
        let part = |&pair: &usize| self.second[pair] * (mixed[pair] - self.first[pair]);
        share(pairs.iter().map(part).sum::<f64>() / pairs.len() as f64, self.variance(pairs))
    }

    fn total(&self, parameter: usize, pairs: &[usize]) -> f64 {
        let mixed = &self.mixed[parameter];
        let part = |&pair: &usize| {
            let change = self.first[pair] - mixed[pair];
            0.5 * change * change
        };
        share(pairs.iter().map(part).sum::<f64>() / pairs.len() as f64, self.variance(pairs))
    }
}

/// Returns a part of a variance as a share. Nothing is a share of no variance: a draw of the bootstrap can have none.
fn share(part: f64, variance: f64) -> f64 {
    if variance > 0.0 { part / variance } else { 0.0 }
}

fn index(pairs: usize, all: &[usize], statistic: impl Fn(&[usize]) -> f64) -> Index {
    let estimate = statistic(all);
    let [lower, upper] = bootstrap_interval(pairs, &statistic);
    Index { estimate, lower: lower.min(estimate), upper: upper.max(estimate) }
}
