//! Demands on a set of tests beyond all combinations of any k values, and the kinds of tests that meet these demands.
//!
//! A *negative* value is a value that the system under test should reject. It may then never look at the other values
//! of the test, and one negative value may hide another. So a combination without negative values counts only in tests
//! without any, and a combination with a negative value only in tests with no other (Czerwonka, *Pairwise testing in
//! the real world*, 2006). The tests therefore fall into *kinds*: one kind without negative values, and one kind for
//! each negative value. No kind covers anything for another kind. The kind without negative values has to show all
//! combinations of k values that are not negative. In each other kind the negative value is one of the k values, so
//! the kind has to show all combinations of k - 1 values of the other parameters.

use crate::rules::{Clause, Literal, Rules, RulesError};
use crate::{Space, SpaceError};

/// The combinations of values that tests have to cover besides all combinations of the values of any k parameters.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Demand {
    /// The groups of discrete parameters that need a higher strength of coverage. Each group has the positions of its
    /// parameters among the discrete parameters, and the strength within the group.
    pub groups: Vec<(Vec<usize>, usize)>,
    /// The negative values, which the system under test should reject, each as a parameter and a level. The parameter
    /// is given by its position among the discrete parameters.
    pub negatives: Vec<(usize, usize)>,
}

impl Demand {
    /// Returns the kinds of tests of `space`, one without negative values and one for each negative value. Every
    /// negative value has to be a level of the space. This is not checked.
    ///
    /// # Errors
    /// No test keeps the constraints of the space, or every test that keeps them has two negative values or more. Or
    /// the search for such a test exceeds its bounds.
    pub fn kinds(&self, space: &Space) -> Result<Vec<TestKind>, SpaceError> {
        let rules = space.rules()?;
        if self.negatives.is_empty() {
            return Ok(vec![TestKind::of(&rules)]);
        }
        TestKind::all(rules.levels(), &space.clauses(), &self.negatives).map_err(|error| space.explain(error))
    }
}

/// A kind of tests, which all have the same negative (invalid) value or all have no negative value. The tests of a kind
/// count for the same combinations.
#[derive(Debug, Clone)]
pub struct TestKind {
    rules: Rules,
    negative: Option<(usize, usize)>,
}

impl TestKind {
    /// Makes the single kind of tests that a space without negative values has.
    pub fn of(rules: &Rules) -> Self {
        Self { rules: rules.clone(), negative: None }
    }

    /// Returns the kinds of tests for parameters with the given numbers of levels, constraints and negative values.
    ///
    /// The tests keep the constraints. The (parameter, level) pairs in `negatives` are the negative values; they have
    /// to exist, which is not checked. The kind without negative values comes first, then one kind for each pair, in
    /// order. A kind without tests is left out.
    ///
    /// # Errors
    /// No kind has tests, or it cannot be decided whether a kind has tests.
    ///
    /// # Panics
    /// A constraint names a parameter or a level that does not exist.
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

    /// Returns the rules that all tests of this kind keep. They come from the constraints and from the negative values.
    pub fn rules(&self) -> &Rules {
        &self.rules
    }

    /// Returns the parameter and the level of the negative value in all tests of this kind, if the kind has such a
    /// value.
    pub fn negative(&self) -> Option<(usize, usize)> {
        self.negative
    }

    /// Returns the combinations of levels that tests of this kind have to cover so that all kinds together cover all
    /// combinations of `k` of `parameters`. The result has parameters and a number: tests of this kind have to cover
    /// all combinations of that number of these parameters, beside the negative value. `None` if the negative value
    /// belongs to none of `parameters`.
    pub fn share(&self, parameters: &[usize], k: usize) -> Option<(Vec<usize>, usize)> {
        match self.negative {
            None => Some((parameters.to_vec(), k)),
            Some((own, _)) if !parameters.contains(&own) => None,
            Some((own, _)) => Some((parameters.iter().copied().filter(|&other| other != own).collect(), k - 1)),
        }
    }
}
