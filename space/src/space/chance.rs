//! Tests as chance has them: what a point of the unit cube is under the distributions of the parameters.

use super::{Point, Space};
use crate::{Distribution, Domain, Parameter, SpaceError};

impl Space {
    /// The same space with this parameter distributed so.
    ///
    /// # Errors
    /// There is no such parameter, or its values cannot be distributed so.
    pub fn with_distribution(mut self, name: &str, distribution: Distribution) -> Result<Self, SpaceError> {
        self.parameter(name)?;
        let named = self.parameters.iter_mut().filter(|parameter| parameter.name == name);
        for parameter in named {
            parameter.distribution = distribution.clone();
            parameter.validate()?;
        }
        Ok(self)
    }

    /// The test at these quantiles: a number in `[0,1]` for each of [`Space::coordinates`], in their order.
    ///
    /// Where the quantiles are uniform and independent, the test is distributed as the parameters say. Constraints are
    /// not looked at.
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
    /// There is another number of quantiles than of coordinates.
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
