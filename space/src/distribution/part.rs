//! The distribution of a parameter that is narrowed to a part of its domain.

use super::Distribution;
use crate::Domain;

impl Distribution {
    /// Returns this distribution of a domain for a part of the domain.
    ///
    /// The values of a choice keep their weights. The numbers that are picked from an interval are equally probable. If the
    /// distribution gives the part almost no probability, the part has the uniform distribution.
    ///
    /// ```
    /// use paracosm_space::{Distribution, Domain};
    /// let (all, part) = ([1, 2, 3], [3, 2]);
    /// let choice = |levels: &[i32]| Domain::Choice(levels.iter().map(|level| f64::from(*level).into()).collect());
    /// let weights = Distribution::Weights(vec![0.5, 0.3, 0.2]);
    /// assert_eq!(weights.within(&choice(&all), &choice(&part)), Distribution::Weights(vec![0.2, 0.3]));
    /// ```
    pub fn within(&self, domain: &Domain, part: &Domain) -> Self {
        let kept = match (self, domain, part) {
            (Self::Weights(weights), Domain::Choice(all), Domain::Choice(levels)) => {
                let weight = |level| all.iter().position(|other| other == level).and_then(|at| weights.get(at));
                Self::Weights(levels.iter().map(|level| weight(level).copied().unwrap_or(0.0)).collect())
            }
            (_, Domain::Interval { .. }, Domain::Interval { .. }) => self.clone(),
            _ => Self::Uniform,
        };
        if kept.check(part).is_ok() { kept } else { Self::Uniform }
    }
}
