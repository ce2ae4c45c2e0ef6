//! What is asked of tests beside all combinations of any k values, and the kinds of tests that answer it.
//!
//! A *negative* value is one that the system under test is to reject. A test with one asks for nothing but that, since
//! what else it contains may never be looked at; and of two of them one would hide the other. So a combination without
//! negative values counts only in tests without any, one with a negative value only in tests with no other (Czerwonka,
//! *Pairwise testing in the real world*, 2006). The tests fall into *kinds*, those without a negative value and those with
//! this one, and no kind helps another: the first has to show all combinations of k values that are not negative, each
//! other kind, where one of the k is its negative value already, all combinations of k - 1 values of the other parameters.

use crate::rules::{Clause, Literal, Rules, RulesError};
use crate::{Space, SpaceError};

/// What tests are to cover beside all combinations of any k values.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Demand {
    /// Groups of discrete parameters of which more are covered together: their positions among the discrete ones, and how
    /// many.
    pub groups: Vec<(Vec<usize>, usize)>,
    /// The negative values: positions among the discrete parameters, and levels.
    pub negatives: Vec<(usize, usize)>,
}

impl Demand {
    /// The kinds of tests that a space has, one where no value is negative.
    ///
    /// # Errors
    /// No test keeps the space's constraints, or none without two negative values.
    ///
    /// # Panics
    /// There is no such negative value.
    pub fn kinds(&self, space: &Space) -> Result<Vec<TestKind>, SpaceError> {
        let rules = space.rules()?;
        if self.negatives.is_empty() {
            return Ok(vec![TestKind::of(&rules)]);
        }
        TestKind::all(rules.levels(), &space.clauses(), &self.negatives).map_err(|error| space.explain(error))
    }
}

/// Tests that count for the same combinations: those with one negative value, or without any.
#[derive(Debug, Clone)]
pub struct TestKind {
    rules: Rules,
    negative: Option<(usize, usize)>,
}

impl TestKind {
    /// All tests as one kind: no value is negative.
    pub fn of(rules: &Rules) -> Self {
        Self { rules: rules.clone(), negative: None }
    }

    /// The kinds of tests of parameters with so many levels each, under constraints, where the (parameter, level) pairs
    /// are negative: those without one first, then one for each pair in order. Kinds without tests are left out.
    ///
    /// # Errors
    /// There is no kind with tests, or whether one has any cannot be decided.
    ///
    /// # Panics
    /// There is no such parameter or level.
    pub fn all(
        levels: &[usize],
        constraints: &[Vec<Clause>],
        negatives: &[(usize, usize)],
    ) -> Result<Vec<Self>, RulesError> {
        let kind = |negative: Option<(usize, usize)>| {
            let stays = |parameter: usize, level: usize| match negative {
                Some((own, only)) if own == parameter => level == only,
                _ => !negatives.contains(&(parameter, level)),
            };
            let signed = (0..levels.len()).filter(|&parameter| negatives.iter().any(|pair| pair.0 == parameter));
            let signs = signed.map(|parameter| {
                let levels = (0..levels[parameter]).filter(|&level| stays(parameter, level)).collect();
                vec![Clause { literals: vec![Literal { parameter, levels }] }]
            });
            let all: Vec<Vec<Clause>> = constraints.iter().cloned().chain(signs).collect();
            Rules::new(levels, &all).map(|rules| Self { rules, negative })
        };
        let mut kinds = Vec::new();
        let mut conflict = None;
        for negative in std::iter::once(None).chain(negatives.iter().copied().map(Some)) {
            match kind(negative) {
                Ok(kind) => kinds.push(kind),
                Err(RulesError::Conflict(found)) => conflict = conflict.or(Some(found)),
                Err(undecided) => return Err(undecided),
            }
        }
        match conflict {
            Some(mut conflict) if kinds.is_empty() => {
                conflict.constraints.retain(|&index| index < constraints.len());
                Err(RulesError::Conflict(conflict))
            }
            _ => Ok(kinds),
        }
    }

    /// What tests of this kind keep: the constraints, and which values are negative.
    pub fn rules(&self) -> &Rules {
        &self.rules
    }

    /// The negative value that all tests of this kind have: a parameter and its level.
    pub fn negative(&self) -> Option<(usize, usize)> {
        self.negative
    }

    /// What this kind has to show, where all combinations of `k` of some parameters are asked for: all combinations of
    /// how many of which parameters, beside the negative value. None where that value is of none of them.
    pub fn share(&self, parameters: &[usize], k: usize) -> Option<(Vec<usize>, usize)> {
        match self.negative {
            None => Some((parameters.to_vec(), k)),
            Some((own, _)) if !parameters.contains(&own) => None,
            Some((own, _)) => Some((parameters.iter().copied().filter(|&other| other != own).collect(), k - 1)),
        }
    }
}
