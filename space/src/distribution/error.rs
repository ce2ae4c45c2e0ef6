//! The errors of distributions.

use super::{Distribution, NAMES, SHAPES, WEIGHTS};
use crate::names::did_you_mean;
use crate::plural;
use thiserror::Error;

/// The reason why a text is not a distribution, or why a distribution does not fit a domain.
#[derive(Debug, Clone, Error, PartialEq)]
pub enum DistributionError {
    /// No distribution has the given name.
    #[error("no distribution is called `{name}`{}; the distributions are {}", did_you_mean(.nearest), NAMES.map(|(name, _)| name).join(", "))]
    Unknown {
        /// The given name, which is not the name of a distribution.
        name: String,
        /// The most similar name of a distribution, if a name is similar enough.
        nearest: Option<&'static str>,
    },
    /// A distribution is given too many or too few numbers.
    #[error("the distribution {name} takes {takes}, found {found}")]
    Numbers {
        /// The name of the distribution.
        name: &'static str,
        /// The numbers that the distribution takes, in words.
        takes: &'static str,
        /// The count of the numbers that are given to the distribution.
        found: usize,
    },
    /// A word stands in the place of a number.
    #[error("found `{found}` in {within}, expected a number")]
    NoNumber {
        /// The word that stands in the place of a number.
        found: String,
        /// The text or the entry that contains the word.
        within: String,
    },
    /// An entry of a file names no distribution, or several distributions.
    #[error("found no distribution or several, expected exactly one, such as {{ beta = [2.0, 5.0] }}")]
    NotOne,
    /// A distribution has a number that is not finite.
    #[error("distribution {distribution}: found {number}, expected finite numbers")]
    Infinite {
        /// The distribution that is refused.
        distribution: Distribution,
        /// The number that is not finite.
        number: f64,
    },
    /// The number of weights differs from the number of values of a choice.
    #[error("found {}, expected {expected}: a weight for each value", plural(*found, "weight"))]
    WeightCount {
        /// The number of weights that are given.
        found: usize,
        /// The number of values of the choice.
        expected: usize,
    },
    /// A weight is below 0, or no weight is above 0, or the sum of the weights is not finite.
    #[error("distribution {0}: expected weights of at least 0, with a finite sum above 0")]
    Weights(Distribution),
    /// The numbers of a histogram are not edges in ascending order with weights between them.
    #[error(
        "distribution {0}: expected edges in ascending order with a weight between each two edges, such as histogram:0,1,5,3,10"
    )]
    Edges(Distribution),
    /// A choice has a distribution that is only for intervals.
    #[error("found the distribution {0}, expected uniform or weights for the values of a choice")]
    ForInterval(Distribution),
    /// An interval has weights, which are only for choices.
    #[error("found weights for an interval, expected one of {}; weights are for a choice", names_for_intervals().join(", "))]
    ForChoice,
    /// A shape of a beta distribution is out of range.
    #[error("distribution {distribution}: expected shapes from {} to {}", SHAPES.start(), SHAPES.end())]
    Shapes {
        /// The distribution that is refused.
        distribution: Distribution,
    },
    /// The standard deviation of a normal distribution, or of the logarithm for a lognormal one, is out of range.
    #[error("distribution {distribution}: expected a standard deviation above 0 and at most {most}")]
    Deviation {
        /// The distribution that is refused.
        distribution: Distribution,
        /// The greatest standard deviation that is allowed.
        most: f64,
    },
    /// Nearly all of a distribution lies outside of the interval.
    #[error("distribution {distribution}: almost nothing of it lies in [{lo}, {hi}]; move it closer to the interval")]
    Outside {
        /// The distribution that is refused.
        distribution: Distribution,
        /// The lower end of the interval.
        lo: f64,
        /// The upper end of the interval.
        hi: f64,
    },
    /// The mode of a triangular distribution lies outside of the interval.
    #[error("distribution {distribution}: expected a mode in [{lo}, {hi}]")]
    Mode {
        /// The distribution that is refused.
        distribution: Distribution,
        /// The lower end of the interval.
        lo: f64,
        /// The upper end of the interval.
        hi: f64,
    },
}

/// Returns the names of the distributions that an interval can have.
fn names_for_intervals() -> Vec<&'static str> {
    NAMES.iter().map(|(name, _)| *name).filter(|name| *name != WEIGHTS).collect()
}
