//! Builds the generator of a strategy, and checks the request once for all strategies.

use crate::deal::Deal;
use crate::family::Family;
use crate::greedy::{GreedyRows, KwiseGreedy};
use crate::keeping::{RowPoints, Share, ValidRows, roomy};
use crate::mixed::Mixed;
use crate::seeded::{Purpose, seeded};
use crate::sequence::{MOST_SOBOL_DIMS, PerRow};
use crate::spread::Spread;
use crate::strategy::MethodKind;
use crate::{Generator, GeneratorError, Request, Strategy};
use paracosm_space::{Point, Space};

impl Strategy {
    /// Builds the generator that proposes the tests of a request by this strategy.
    ///
    /// In a space with discrete parameters the generator ends after the budget, or without continuous parameters
    /// after all rows of the family. In a continuous space a sequence goes on. An adaptive strategy goes on in every
    /// space; without continuous parameters it ends when every row that the constraints allow has been tested. (With
    /// more than 100,000 rows it ends when 1,000 random rows in turn had all been tested before.) It begins with the
    /// rows of the family.
    ///
    /// Tests that break a constraint on continuous parameters are left out.
    ///
    /// # Errors
    /// The space is empty, the budget is 0, `k` or `delta` is out of range, the family is too large, or an existing
    /// test does not belong to the space. Or hardly any test keeps the constraints. Or the strategy cannot serve the
    /// request: the number of points or dimensions, the skip, the existing tests, or the aim.
    pub fn build(self, request: &Request) -> Result<Box<dyn Generator>, GeneratorError> {
        self.build_valid(request)
    }

    /// Builds the generator, which may propose tests that break a constraint on continuous parameters.
    pub(crate) fn unchecked(self, request: &Request) -> Result<Box<dyn Generator>, GeneratorError> {
        self.assembled(request, None)
    }

    /// Builds the generator. With the share of valid tests, the tests of rows keep the constraints on continuous
    /// parameters; all others may break them.
    pub(crate) fn assembled(
        self,
        request: &Request,
        share: Option<&Share>,
    ) -> Result<Box<dyn Generator>, GeneratorError> {
        let &Request { space, budget, seed, skip, k, aim, existing, .. } = request;
        if space.parameters().is_empty() {
            return Err(GeneratorError::EmptySpace);
        }
        if budget == 0 {
            return Err(GeneratorError::NoBudget);
        }
        let first = match (self.first_index(), skip) {
            (None, Some(_)) => return Err(self.cannot_skip()),
            (default, skip) => skip.or(default).unwrap_or(0),
        };
        if aim.is_some() && !self.fills_holes() {
            return Err(GeneratorError::NoAim { strategy: self.name() });
        }
        let seed_or_0 = seed.unwrap_or(0);
        let dims = space.dims();
        let rules = space.rules()?;
        check_existing(space, existing)?;
        // A test that breaks a constraint covers nothing. The tests of a file were checked as they are written.
        let counts = |test: &&Point| self == Self::GIVEN || space.allows(test);
        let existing: &[Point] = &existing.iter().filter(counts).cloned().collect::<Vec<_>>();
        let request = &Request { existing, ..*request };
        match self.kind() {
            MethodKind::Search { build, .. } => return build(self.descriptor(), request, rules),
            MethodKind::Own(build) => return build(request),
            MethodKind::Given(sets) => return sets.generator(self.name(), request),
            MethodKind::Holes(make) if !self.has_rows(request) => {
                let k = k.unwrap_or(2.min(dims + rules.levels().len()));
                let rng = seeded(seed_or_0, Purpose::Greedy, 0);
                return Ok(Box::new(KwiseGreedy::new(make, dims, &rules, k, rng, existing)?));
            }
            MethodKind::Sequence(_) | MethodKind::Sets { .. } | MethodKind::Holes(_) => {}
        }
        let family = Family::new(&rules, request)?;
        if dims == 0 {
            // Each row once: a repeated row would be the same test again.
            return Ok(Box::new(Mixed::discrete(family.without(existing))));
        }
        if !self.dims().contains(&dims) {
            return Err(self.cannot_cover(dims));
        }
        if let Some(epsilon) = request.epsilon {
            return Ok(Box::new(Spread::new(self, request, &family.without(&[]), first, epsilon)?));
        }
        if !self.fills_holes() && !existing.is_empty() {
            return Err(GeneratorError::NoExtension { strategy: self.name() });
        }
        let deal = Deal::new(family.len(), budget as u64);
        // Holes are searched for when a point is asked for, so that room for points costs nothing.
        let room = if share.is_some() { roomy(deal, u64::MAX) } else { deal };
        let sequence = match self.kind() {
            MethodKind::Sequence(endless) => (endless.build)(dims, seed),
            MethodKind::Sets { build, .. } => build(dims, seed, deal)?,
            MethodKind::Holes(make) => {
                Box::new(PerRow::new(room, GreedyRows::new(make, dims, seed_or_0, family.points_of_rows(existing))))
            }
            MethodKind::Search { .. } | MethodKind::Own(_) | MethodKind::Given(_) => {
                unreachable!("such generators were built above")
            }
        };
        let (end, len) = (first.saturating_add(deal.indices()), sequence.len());
        if end > len {
            return Err(GeneratorError::IndexLimit { strategy: self.name(), len, last: end - 1 });
        }
        let Some(share) = share else { return Ok(Box::new(Mixed::new(family, sequence, deal, first))) };
        let (points, goes_on) = match self.kind() {
            MethodKind::Sets { build, .. } => (RowPoints::Sets { build, seed }, false),
            MethodKind::Sequence(endless) => {
                let block = roomy(deal, len - first).block;
                (RowPoints::Walked { sequence, first, block, fills: endless.fills }, deal.rows == 1)
            }
            _ => (RowPoints::Walked { sequence, first, block: room.block, fills: true }, false),
        };
        let tests = if goes_on { u64::MAX } else { deal.budget };
        Ok(Box::new(ValidRows::new(request, family, points, tests, share)?))
    }

    fn cannot_cover(self, dims: usize) -> GeneratorError {
        let (least, most) = self.dims().into_inner();
        let made_for = if least == most { format!("exactly {most}") } else { format!("at most {most}") };
        // A strategy with such a limit needs an alternative in few, in many, or in very many dimensions.
        let instead = match dims {
            ..10 => Self::KRONECKER,
            10..=MOST_SOBOL_DIMS => Self::SOBOL_OWEN,
            _ => Self::HALTON,
        };
        GeneratorError::Dimensions { strategy: self.name(), made_for, dims, instead: instead.name() }
    }

    fn cannot_skip(self) -> GeneratorError {
        let sequences = Self::all().filter(|s| s.first_index().is_some()).map(Self::name);
        GeneratorError::NoSequence { strategy: self.name(), sequences: sequences.collect::<Vec<_>>().join(", ") }
    }
}

/// Checks that tests belong to the space.
fn check_existing(space: &Space, existing: &[Point]) -> Result<(), GeneratorError> {
    let (dims, levels) = (space.dims(), space.levels());
    let belongs = |test: &Point| {
        test.continuous.len() == dims
            && test.continuous.iter().all(|x| (0.0..=1.0).contains(x))
            && test.discrete.len() == levels.len()
            && test.discrete.iter().zip(&levels).all(|(level, levels)| level < levels)
    };
    let foreign = existing.iter().position(|test| !belongs(test));
    foreign.map_or(Ok(()), |index| Err(GeneratorError::Foreign { index }))
}
