//! Random tests: converts uniform numbers into tests that follow the distributions of the parameters.

use super::{Point, Space};
use crate::{Distribution, Domain, Parameter, SpaceError};

impl Space {
    /// Returns the same space with another distribution for a parameter.
    ///
    /// # Errors
    /// The parameter does not exist, or the distribution does not fit its domain.
    pub fn with_distribution(mut self, name: &str, distribution: Distribution) -> Result<Self, SpaceError> {
        self.parameter(name)?;
        let named = self.parameters.iter_mut().filter(|parameter| parameter.name == name);
        for parameter in named {
            parameter.distribution = distribution.clone();
            parameter.validate()?;
        }
        Ok(self)
    }

    /// Returns the test whose coordinates lie at the given quantiles of their distributions. `quantiles` has a number
    /// in `[0,1]` for each of [`Space::coordinates`], in their order.
    ///
    /// If the quantiles are uniform and independent, the test follows the distributions of the parameters. Constraints
    /// are not checked.
    ///
    /// ```
    /// use paracosm_space::{Distribution, Space};
    /// let space = Space::unit_cube(2).with_distribution("x2", Distribution::Beta(2.0, 1.0))?;
    /// let point = space.at_quantiles(&[0.25, 0.25]);
    /// assert_eq!(point.continuous[0], 0.25);
    /// assert!((point.continuous[1] - 0.5).abs() < 1e-12);
    /// # Ok::<(), paracosm_space::SpaceError>(())
    /// ```
    ///
    /// # Panics
    /// The number of quantiles differs from the number of coordinates.
    pub fn at_quantiles(&self, quantiles: &[f64]) -> Point {
        assert_eq!(quantiles.len(), self.coordinates().count(), "a quantile for every coordinate");
        let mut point = Point::default();
        for (coordinate, u) in self.coordinates().zip(quantiles) {
            let Parameter { domain, distribution, .. } = coordinate.parameter;
            match domain {
                Domain::Interval { lo, hi } => point.continuous.push(distribution.quantile(*lo, *hi, *u)),
                Domain::Choice(levels) => point.discrete.push(distribution.level(levels.len(), *u)),
            }
        }
        point
    }
}
