//! Training of a linear support vector machine: the weights with the least squared hinge loss and regularisation (Keerthi
//! and DeCoste, "A Modified Finite Newton Method for Fast Solution of Large Scale Linear SVMs", 2005), by L-BFGS.

use super::Failure;
use argmin::core::{CostFunction, Error, Executor, Gradient, State};
use argmin::solver::linesearch::MoreThuenteLineSearch;
use argmin::solver::quasinewton::LBFGS;

/// The weight of the loss of an example against the length of the weights.
const COST: f64 = 0.1;
/// The number of steps that L-BFGS remembers, and the greatest number of steps.
const MEMORY: usize = 10;
const STEPS: u64 = 200;

/// The examples: a descriptor, and whether it is of the class.
pub type Examples = Vec<(Vec<f32>, bool)>;

/// The loss of weights over examples. The last number of the weights is the bias.
struct Loss<'a>(&'a Examples);

impl Loss<'_> {
    /// Returns the margin that an example lacks, with the sign of its class; 0 if it lacks none.
    fn lacks(weights: &[f64], (descriptor, is_positive): &(Vec<f32>, bool)) -> f64 {
        let (bias, weights) = weights.split_last().expect("the bias is the last weight");
        let margin: f64 = bias + descriptor.iter().zip(weights).map(|(a, b)| f64::from(*a) * b).sum::<f64>();
        if *is_positive { (1.0 - margin).max(0.0) } else { -(1.0 + margin).max(0.0) }
    }
}

impl CostFunction for Loss<'_> {
    type Param = Vec<f64>;
    type Output = f64;

    fn cost(&self, weights: &Vec<f64>) -> Result<f64, Error> {
        let losses = self.0.iter().map(|example| {
            let lacks = Self::lacks(weights, example);
            lacks * lacks
        });
        Ok(0.5 * weights.iter().map(|weight| weight * weight).sum::<f64>() + COST * losses.sum::<f64>())
    }
}

impl Gradient for Loss<'_> {
    type Param = Vec<f64>;
    type Gradient = Vec<f64>;

    fn gradient(&self, weights: &Vec<f64>) -> Result<Vec<f64>, Error> {
        let mut gradient = weights.clone();
        for example in self.0 {
            let slope = -2.0 * COST * Self::lacks(weights, example);
            if slope != 0.0 {
                let (bias, rest) = gradient.split_last_mut().expect("the bias is the last weight");
                *bias += slope;
                rest.iter_mut().zip(&example.0).for_each(|(sum, number)| *sum += slope * f64::from(*number));
            }
        }
        Ok(gradient)
    }
}

/// Returns the weights and the bias that part the examples.
pub fn train(examples: &Examples) -> Result<(Vec<f32>, f32), Failure> {
    let length = examples.first().ok_or("a support vector machine needs examples")?.0.len();
    let solver = LBFGS::new(MoreThuenteLineSearch::new(), MEMORY).with_tolerance_grad(1e-4)?;
    let start = vec![0.0; length + 1];
    let found = Executor::new(Loss(examples), solver).configure(|state| state.param(start).max_iters(STEPS)).run()?;
    let weights = found.state().get_best_param().ok_or("the search found no weights")?;
    let (bias, weights) = weights.split_last().expect("the bias is the last weight");
    Ok((weights.iter().map(|weight| *weight as f32).collect(), *bias as f32))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_plane_parts_two_clouds_with_the_widest_margin() {
        // With many examples, the loss counts more than the length of the weights.
        let cloud = |x: f32, is_positive| (-300..=300).map(move |y| (vec![x, y as f32 / 300.0], is_positive));
        let examples = cloud(3.0, true).chain(cloud(-1.0, false)).collect();
        let (weights, bias) = train(&examples).unwrap();
        // The plane lies in the middle, at x = 1, and does not depend on y.
        assert!((-bias / weights[0] - 1.0).abs() < 0.05, "{weights:?}, {bias}");
        assert!(weights[0] > 0.2 && weights[1].abs() < 1e-3, "{weights:?}, {bias}");
    }
}
